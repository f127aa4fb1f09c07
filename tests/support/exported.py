"""Exported files as other programs read them: by libraries, not by our own code."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pyarrow.csv as pacsv
import pyarrow.parquet as pq
from asammdf import MDF
from mcap.reader import make_reader
from nptdms import TdmsFile
from scipy.io import loadmat

Columns = dict[str, Any]


def _arrow(table: Any) -> Columns:
    return {name: table.column(name).to_numpy() for name in table.column_names}


def _mcap(path: Path) -> Columns:
    with path.open("rb") as stream:
        rows = [msgspec.json.decode(message.data) for _, _, message in make_reader(stream).iter_messages()]
    names = max(rows, key=len)
    return {name: np.array([row.get(name, np.nan) for row in rows]) for name in names}


def _matlab(path: Path) -> Columns:
    variables = loadmat(path, squeeze_me=False)
    found = {name: values[:, 0] for name, values in variables.items() if not name.startswith("__") and name != "about"}
    return {n: np.array([str(cell[0]) for cell in v]) if v.dtype == object else v for n, v in found.items()}


def _tdms(path: Path) -> Columns:
    (group,) = TdmsFile.read(path).groups()
    return {channel.name: channel[:] for channel in group.channels()}


def _mdf(path: Path) -> Columns:
    with MDF(path) as file:
        names = [channel.name for channel in file.groups[0].channels]
        signals = {name: file.get(name, group=0) for name in names}
        found = {name: signal.samples for name, signal in signals.items() if name not in ("time", "time_s")}
        text = {n: np.char.decode(v, "utf-8") if v.dtype.kind == "S" else v for n, v in found.items()}
        return text | {"time_s": next(iter(signals.values())).timestamps}


def _playback(path: Path) -> Columns:
    rows = np.fromfile(path, "<f8").reshape(-1, 13)
    names = [
        f"{frame}{part}"
        for frame in ("base", "outer", "middle", "inner")
        for part in ("_deg", "_rate_deg_s", "_acceleration_deg_s2")
    ]
    return {"time_s": rows[:, 0], **{name: rows[:, 1 + k] for k, name in enumerate(names)}}


READERS: dict[str, Callable[[Path], Columns]] = {
    "csv": lambda path: _arrow(pacsv.read_csv(path)),
    "parquet": lambda path: _arrow(pq.read_table(path)),
    "mcap": _mcap,
    "mat": _matlab,
    "tdms": _tdms,
    "mf4": _mdf,
    "f64": _playback,
}
