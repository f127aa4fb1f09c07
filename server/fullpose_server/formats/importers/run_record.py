"""Our own runs: the attitude that was to be followed, that was commanded, or that was measured, of each sample.

The last two are those of the frames' angles on an ideal rig of the run's geometry.
"""

from array import array
from collections.abc import Mapping
from typing import Any

import msgspec
import numpy as np

from fullpose._typing import Array
from fullpose.attitude import quaternion_from_dcm
from fullpose.rig import Geometry, builtin_rigs
from fullpose.verify import payload_attitudes
from fullpose_server.formats.importers.columns import Bounds, check_rows
from fullpose_server.formats.importers.table import Table, table_of

SCHEMA = "fullpose.Sample"
_SOURCES = {"target": "target", "commanded": "demand", "measured": "measured"}  # a table's name, and its field
_QUATERNION = ("qw", "qx", "qy", "qz")
_NONE = (float("nan"),) * 4
_DECODE = msgspec.json.Decoder(dict[str, Any]).decode


class RunSamples:
    """The samples of a run, as they are read."""

    def __init__(self, file: str, bounds: Bounds) -> None:
        self._file, self._bounds = file, bounds
        self._time = array("q")
        self._values = {field: array("d") for field in _SOURCES.values()}

    def add(self, data: bytes) -> None:
        """One message. Raises `TooLargeError`, and what msgspec raises on a damaged one."""
        sample = _DECODE(data)
        self._time.append(sample["time_ns"])
        for field, values in self._values.items():
            four = sample.get(field) or _NONE
            values.extend([_NONE[0] if each is None else each for each in four])
        check_rows(len(self._time), self._bounds, self._file)

    def tables(self, run: Mapping[str, str]) -> tuple[Table, ...]:
        """Those that there are, of the run that its metadata tells."""
        if not self._time:
            return ()
        time = (np.array(self._time, np.int64) - self._time[0]) / 1e9
        geometry = _geometry(run)
        tables = []
        for name, field in _SOURCES.items():
            values = np.array(self._values[field]).reshape(-1, 4)
            there = np.isfinite(values).all(axis=1)
            if not there.any() or (field != "target" and geometry is None):
                continue
            q = values[there] if field == "target" else _attitudes(geometry, values[there])
            columns = {
                "time_s": time[there],
                **{part: np.ascontiguousarray(q[:, k]) for k, part in enumerate(_QUATERNION)},
            }
            tables.append(table_of(self._file, "run", columns, name=name, profile="fullpose-quaternion"))
        return tuple(tables)


def _geometry(run: Mapping[str, str]) -> Geometry | None:
    """Of a record that does not say it, that of the built-in rig of its name; None: not known."""
    if run.get("geometry") in frozenset(Geometry):
        return Geometry(run["geometry"])
    rig = builtin_rigs().get(run.get("rig", ""))
    return None if rig is None else rig.geometry


def _attitudes(geometry: Geometry | None, angles_deg: Array) -> Array:
    """Quaternions (n, 4) of frame angles (n, 4) [deg]."""
    rig = next(each for each in builtin_rigs().values() if each.geometry is geometry)
    return np.asarray(quaternion_from_dcm(payload_attitudes(rig, np.deg2rad(angles_deg))))
