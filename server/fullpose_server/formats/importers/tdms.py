"""TDMS (LabVIEW, VeriStand, DIAdem): a table each group, read channel by channel when it is wanted."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from nptdms import TdmsFile

from fullpose_server.errors import FileError
from fullpose_server.formats.caution import Caution
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds, check_columns, check_rows
from fullpose_server.formats.importers.parsing import parsing
from fullpose_server.formats.importers.table import Columns, Table, first_rows

ABOUT = "TDMS file"
WAVEFORM = "time_s"  # the column that a waveform's increment stands for
_UNITS = ("unit_string", "NI_UnitDescription")
_HEAD = 8
_CUT = Caution("truncated", "the file was cut off: its last segment is left out as far as it is not whole")


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """A table each group whose channels have samples. Raises `FileError`, `TooLargeError`."""
    with parsing(file, ABOUT), TdmsFile.open(path) as opened:
        cut = bool(opened.file_status.incomplete_final_segment)
        found = [_table(path, file, group, bounds, cut) for group in opened.groups()]
        groups = [group.name for group in opened.groups()]
    tables = tuple(table for table in found if table is not None)
    if not tables:
        raise FileError(file, f"a group with channels of numbers among {', '.join(groups[:8]) or 'no groups'}")
    return tables


def _table(path: Path, file: str, group: Any, bounds: Bounds, cut: bool) -> Table | None:
    channels = [each for each in group.channels() if len(each) and np.dtype(each.dtype).kind in "iufM"]
    if not channels:
        return None
    rows = max(len(each) for each in channels)
    if cut and any(len(each) != rows for each in group.channels()):
        raise FileError(file, f"a whole {ABOUT}, its last segment is cut off", column=group.name, column_word="group")
    channels = [each for each in channels if len(each) == rows]
    check_rows(rows, bounds, file)
    check_columns(len(channels), bounds, file)
    names = tuple(each.name for each in channels)
    waved = WAVEFORM not in names and "wf_increment" in channels[0].properties
    units = {each.name: str(each.properties[key]) for each in channels for key in _UNITS if each.properties.get(key)}
    head = {each.name: _numbers(each[:_HEAD]) for each in channels}
    if waved:
        head = {WAVEFORM: channels[0].time_track()[:_HEAD], **head}
    units |= {each.name: "ns" for each in channels if np.dtype(each.dtype).kind == "M"}
    group_name = group.name

    def load(wanted: Sequence[str]) -> Columns:
        with parsing(file, ABOUT), TdmsFile.open(path) as opened:
            each = opened[group_name]
            first = each[names[0]]
            return {
                name: first.time_track() if waved and name == WAVEFORM else _numbers(each[name][:]) for name in wanted
            }

    return Table(
        file=file,
        format="tdms",
        names=(WAVEFORM, *names) if waved else names,
        load=load,
        name=group_name,
        units=units,
        head=first_rows(head),
        cautions=(_CUT,) if cut else (),
    )


def _numbers(values: Any) -> Any:
    """Doubles; whole stamps stay whole, dates become nanoseconds since 1970."""
    values = np.asarray(values)
    if values.dtype.kind == "M":
        return values.astype("datetime64[ns]").astype(np.int64)
    return values.astype(np.int64 if values.dtype.kind in "iu" and values.dtype.itemsize == 8 else np.float64)
