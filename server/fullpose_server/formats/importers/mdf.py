"""MDF 3 and 4 (ASAM): a table each channel group, with its master channel as a column; read when it is wanted."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from asammdf import MDF

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds, check_columns, check_rows
from fullpose_server.formats.importers.parsing import parsing
from fullpose_server.formats.importers.table import Columns, Table, first_rows

ABOUT = "MDF measurement file"
_HEAD = 8


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """A table each channel group with records. Raises `FileError`, `TooLargeError`."""
    tables = []
    with parsing(file, ABOUT), MDF(path) as opened:
        groups: list[Any] = list(opened.groups)
        for index, group in enumerate(groups):
            rows = group.channel_group.cycles_nr
            if not rows:
                continue
            check_rows(rows, bounds, file)
            check_columns(len(group.channels), bounds, file)
            tables.append(_table(path, file, opened, index))
    if not tables:
        raise FileError(file, "a channel group with records")
    return tuple(tables)


def _table(path: Path, file: str, opened: Any, index: int) -> Table:
    group = opened.groups[index]
    master = opened.masters_db.get(index)
    names = [channel.name for channel in group.channels]
    stamp = names[master] if master is not None else ""
    units = {channel.name: channel.unit for channel in group.channels if channel.unit}
    if stamp:
        units[stamp] = "s"  # of a time master, always
    channels = {name: number for number, name in enumerate(names)}

    def read(source: Any, wanted: Sequence[str], **part: Any) -> Columns:
        return {name: _numbers(source, index, channels[name], name == stamp, part) for name in wanted}

    def load(wanted: Sequence[str]) -> Columns:
        with parsing(file, ABOUT), MDF(path) as again:
            return read(again, wanted)

    head = read(opened, names, record_offset=0, record_count=_HEAD)
    return Table(
        file=file,
        format="mdf",
        names=tuple(names),
        load=load,
        name=str(getattr(group.channel_group, "acq_name", "") or f"group {index}"),
        units=units,
        head=first_rows(head),
    )


def _numbers(opened: Any, group: int, channel: int, is_master: bool, part: dict[str, Any]) -> Any:
    if is_master:
        return np.asarray(opened.get_master(group, **part), np.float64)
    values = opened.get(group=group, index=channel, **part).samples
    if values.dtype.kind not in "iufb":
        return np.full(len(values), np.nan)
    return values.astype(np.int64 if values.dtype.kind in "iu" and values.dtype.itemsize == 8 else np.float64)
