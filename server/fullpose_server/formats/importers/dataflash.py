"""ArduPilot's DataFlash logs (.bin): attitudes in degrees, at their own stamps.

The library indexes the log and knows its formats; the columns are then read out at the index, a thousand times as fast
as message by message.
"""

from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from pymavlink.DFReader import FORMAT_TO_STRUCT, DFReader_binary

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds, check_rows
from fullpose_server.formats.importers.parsing import parsing
from fullpose_server.formats.importers.table import Columns, Table, table_of

ABOUT = "ArduPilot DataFlash log"
ATTITUDE = "ATT"
OTHERS = ("AHR2", "SIM", "SIM2")  # the second estimator, and what the simulator knows
_HEADER = 3  # bytes before a message's fields
_WANTED = ("TimeUS", "TimeMS", "Roll", "Pitch", "Yaw")


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """A table each message that has roll, pitch and yaw. Raises `FileError`, `TooLargeError`."""
    with parsing(file, ABOUT), closing(DFReader_binary(str(path))) as log:
        data = np.memmap(path, np.uint8, "r")
        found = [_table(file, log, data, name, bounds) for name in (ATTITUDE, *OTHERS)]
    tables = tuple(table for table in found if table is not None)
    if not tables:
        raise FileError(file, f"{ATTITUDE} messages in the log; it has no attitude")
    return tables


def _table(file: str, log: Any, data: np.ndarray[Any, Any], name: str, bounds: Bounds) -> Table | None:
    """Of the messages of a name; None where the log has none, or they are no attitude."""
    kind = log.name_to_id.get(name)
    if kind is None or not len(log.offsets[kind]):
        return None
    check_rows(len(log.offsets[kind]), bounds, file)
    columns = _columns(data, np.asarray(log.offsets[kind], np.int64), log.formats[kind])
    stamp = next((each for each in ("TimeUS", "TimeMS") if each in columns), None)
    if stamp is None or not {"Roll", "Pitch", "Yaw"} <= columns.keys():
        return None
    profile = "ardupilot" if stamp == "TimeUS" else "ardupilot-ms"
    made = table_of(file, "dataflash", columns, name=name, row_word="message", profile=profile)
    return replace(made, on_request=name != ATTITUDE)


def _columns(data: np.ndarray[Any, Any], at: np.ndarray[Any, Any], form: Any) -> Columns:
    """The wanted fields of the messages that begin at `at` (n,), scaled as the format says; a cut one is left out."""
    kinds = [_dtype(FORMAT_TO_STRUCT[letter][0]) for letter in form.format]
    starts = np.concatenate([[0], np.cumsum([kind.itemsize for kind in kinds])]) + _HEADER
    at = at[at + starts[-1] <= len(data)]
    found = {}
    for name, kind, start, scale in zip(form.columns, kinds, starts, form.msg_mults, strict=False):
        if name not in _WANTED:
            continue
        raw = data[at[:, None] + np.arange(start, start + kind.itemsize)]
        values = np.ascontiguousarray(raw).view(kind)[:, 0]
        integers = name.startswith("Time") and kind.kind in "iu"
        found[name] = values.astype(np.int64) if integers else values.astype(float) * (scale or 1.0)
    return found


def _dtype(code: str) -> np.dtype[Any]:
    """Of a letter of `struct`: `64s` is text of 64 bytes, `f` a float."""
    return np.dtype(f"S{code[:-1]}") if code.endswith("s") else np.dtype(f"<{code}")
