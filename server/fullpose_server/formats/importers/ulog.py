"""PX4's ULog: the estimator's attitude, and by request the others that a log has."""

from dataclasses import replace
from pathlib import Path

from pyulog import ULog

from fullpose_server.errors import FileError
from fullpose_server.formats.caution import Caution
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds, check_rows
from fullpose_server.formats.importers.parsing import parsing
from fullpose_server.formats.importers.table import Table, table_of

ABOUT = "PX4 ULog"
ATTITUDE = "vehicle_attitude"
# Each with q[0] to q[3], w first, body to NED: what the simulator knows, what came from outside, the odometry.
OTHERS = ("vehicle_attitude_groundtruth", "vehicle_odometry", "vehicle_visual_odometry", "vehicle_mocap_odometry")
_COLUMNS = ("timestamp", "q[0]", "q[1]", "q[2]", "q[3]")
_CUT = Caution("truncated", "the log is damaged or was cut off: what could be read of it is taken")


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """A table each attitude and instance. Raises `FileError`, `TooLargeError`."""
    with parsing(file, ABOUT):
        log = ULog(str(path), [ATTITUDE, *OTHERS], disable_str_exceptions=True)
        found = {(data.name, data.multi_id): data.data for data in log.data_list}
    tables = []
    for name, instance in sorted(found, key=lambda key: (key[0] != ATTITUDE, key)):
        data = found[name, instance]
        if not set(_COLUMNS) <= data.keys() or not len(data["timestamp"]):
            continue
        check_rows(len(data["timestamp"]), bounds, file)
        made = table_of(
            file,
            "ulog",
            {column: data[column] for column in _COLUMNS},
            name=f"{name}/{instance}" if instance else name,
            row_word="message",
            profile="px4",
            cautions=(_CUT,) if log.file_corruption else (),
        )
        tables.append(replace(made, on_request=name != ATTITUDE))
    if not tables:
        raise FileError(file, f"{ATTITUDE} in the log; it has no attitude")
    return tuple(tables)
