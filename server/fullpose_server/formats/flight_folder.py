"""A stored flight as a folder: its samples as arrays that can be mapped, and what is known of them."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fullpose._typing import Array
from fullpose_server.formats.caution import Caution
from fullpose_server.formats.input_report import input_of
from fullpose_server.formats.mapped import map_doubles
from fullpose_server.formats.trajectory import Trajectory


@dataclass(frozen=True)
class FlightFacts:
    """What a flight's row says of its samples."""

    sha256: str
    convention: str  # of the source
    samples: int
    start_s: float
    duration_s: float
    rate_hz: float | None  # from the median step; None for one sample
    uniform: bool
    peak_body_rate_deg_s: float | None
    warnings: tuple[Caution, ...]
    input: dict[str, Any]  # what was taken of the file

    def to_json(self) -> dict[str, Any]:
        """Values for `json`."""
        return asdict(self) | {"warnings": [caution.to_json() for caution in self.warnings]}

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> "FlightFacts":
        """The inverse of `to_json`."""
        return cls(**{**values, "warnings": tuple(Caution(**caution) for caution in values["warnings"])})


def write_flight(folder: Path, trajectory: Trajectory) -> FlightFacts:
    """Write the arrays into `folder`, which is there."""
    np.save(folder / "time.npy", trajectory.time)
    np.save(folder / "q.npy", trajectory.q)
    return facts_of(trajectory)


def read_arrays(folder: Path, samples: int = -1) -> tuple[Array, Array]:
    """time (n,) [s] and q (n, 4) of a stored flight, mapped from disk. Raises `DamagedError`; -1: of any length."""
    at = map_doubles(folder / "time.npy", (samples,))
    return at, map_doubles(folder / "q.npy", (at.size, 4))


def facts_of(trajectory: Trajectory) -> FlightFacts:
    """What is known of a flight's samples."""
    step = np.diff(trajectory.time)
    peak = None
    if step.size:
        turn = np.clip(np.abs(np.einsum("ij,ij->i", trajectory.q[1:], trajectory.q[:-1])), 0.0, 1.0)
        sine = np.sqrt(np.maximum(0.0, 1.0 - turn * turn))
        peak = float(np.rad2deg(np.max(2.0 * np.arctan2(sine, turn) / step)))
    return FlightFacts(
        sha256=trajectory.sha256,
        convention=trajectory.convention.value,
        samples=int(trajectory.time.size),
        start_s=float(trajectory.time[0]),
        duration_s=float(trajectory.time[-1] - trajectory.time[0]),
        rate_hz=float(1.0 / np.median(step)) if step.size else None,
        uniform=bool(step.size == 0 or np.ptp(step) <= 1e-6 * float(np.median(step)) + 1e-9),
        peak_body_rate_deg_s=peak,
        warnings=trajectory.warnings,
        input=input_of(trajectory),
    )
