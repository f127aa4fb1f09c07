"""An independent check of frame angles: plain NumPy, no kernel of the solver. Angles [rad], one row a sample.

Rates and accelerations are the samples' differences: v_k = (x_k - x_{k-1}) / (t_k - t_{k-1}),
a_k = (v_{k+1} - v_k) / ((t_{k+1} - t_{k-1}) / 2). Jerks likewise: j_k = (a_k - a_{k-1}) / ((t_{k+1} - t_{k-2}) / 3).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fullpose._typing import Array
from fullpose.bounds import JERK_ROUNDING, POSITION_TOLERANCE, TOLERANCE
from fullpose.errors import InputError
from fullpose.rig import FRAMES, LIMITS, Frame, Limit, Rig


@dataclass(frozen=True)
class Violation:
    """A limit exceeded: when [s], which frame, which limit, the value [rad, rad/s, rad/s^2, rad/s^3].

    One for each run of samples without a break, at its worst sample; `samples` is the run's length.
    """

    time: float
    frame: Frame
    limit: Limit
    value: float
    samples: int


@dataclass(frozen=True)
class Verification:
    """What the angles do. `peaks` (4, 4): largest magnitude a frame of position, rate, acceleration, jerk."""

    max_error: float  # [rad] geodesic; nan where no attitude was given
    max_matrix_error: float  # largest entry of F - C; nan likewise
    peaks: Array
    violations: tuple[Violation, ...]


def payload_attitudes(rig: Rig, angles: ArrayLike) -> Array:
    """F (n, 3, 3), body from reference, from the frames' angles (n, 4) [rad], by products of elementary rotations."""
    d = np.asarray(angles, float)
    F = np.broadcast_to(np.eye(3), (len(d), 3, 3))
    for column, axis in enumerate(rig.geometry.axes):
        if axis < 0:
            continue
        c, s = np.cos(d[:, column]), np.sin(d[:, column])
        i, j = (axis + 1) % 3, (axis + 2) % 3
        R = np.zeros((len(d), 3, 3))
        R[:, axis, axis] = 1.0
        R[:, i, i] = R[:, j, j] = c
        R[:, i, j], R[:, j, i] = s, -s
        F = R @ F
    return F


def attitude_errors(F: Array, C: Array) -> tuple[Array, Array]:
    """(geodesic error (n,) [rad], largest entry of F - C (n,)) of F against C (n, 3, 3)."""
    E = F @ np.swapaxes(C, -1, -2)
    axial = 0.5 * np.stack([E[:, 1, 2] - E[:, 2, 1], E[:, 2, 0] - E[:, 0, 2], E[:, 0, 1] - E[:, 1, 0]], axis=-1)
    angle = np.arctan2(np.linalg.norm(axial, axis=-1), 0.5 * (np.trace(E, axis1=-2, axis2=-1) - 1.0))
    return angle, np.abs(F - C).max(axis=(-2, -1))


def differences(time: ArrayLike, angles: ArrayLike) -> tuple[Array, Array]:
    """(rates (n - 1, 4) of samples 1.., accelerations (n - 2, 4) of samples 1..n-2) [rad/s, rad/s^2]."""
    t, x = np.asarray(time, float), np.asarray(angles, float)
    rate = np.diff(x, axis=0) / np.diff(t)[:, None]
    return rate, np.diff(rate, axis=0) / (0.5 * (t[2:] - t[:-2]))[:, None]


def jerks(time: ArrayLike, acceleration: ArrayLike) -> Array:
    """Jerks (n - 3, 4) [rad/s^3] of samples 2..n-2 at time (n,) [s], from the `differences` accelerations (n - 2, 4).

    Six times the third divided difference: a mean of the third derivative over four samples, however they are spaced,
    so that a curve whose jerk is inside a limit is inside it at every rate of sampling.
    """
    t, a = np.asarray(time, float), np.asarray(acceleration, float)
    return np.asarray(np.diff(a, axis=0) / ((t[3:] - t[:-3]) / 3.0)[:, None])


def verify(time: ArrayLike, angles: ArrayLike, rig: Rig, attitude: ArrayLike | None = None) -> Verification:
    """Check angles (n, 4) [rad] at time (n,) [s] against the rig's limits and the attitude (n, 3, 3).

    Raises `InputError` where shapes do not fit or a number is not finite.
    """
    t, x = np.asarray(time, float), np.asarray(angles, float)
    if t.ndim != 1 or x.shape != (len(t), 4):
        raise InputError("angles", None, x.shape, f"({len(t)}, 4), one row a sample")
    bad = np.flatnonzero(~np.isfinite(x).all(axis=1) | ~np.isfinite(t))
    if bad.size:
        raise InputError("angles", int(bad[0]), x[bad[0]].tolist(), "finite numbers")
    rate, acceleration = differences(t, x)
    max_error = max_matrix_error = np.nan
    if attitude is not None:
        C = np.asarray(attitude, float)
        if C.shape != (len(t), 3, 3):
            raise InputError("attitude", None, C.shape, f"({len(t)}, 3, 3)")
        error, matrix_error = attitude_errors(payload_attitudes(rig, x), C)
        max_error, max_matrix_error = float(error.max()), float(matrix_error.max())

    jerk = jerks(t, acceleration) if len(t) > 3 else np.empty((0, 4))
    peaks = np.zeros((4, 4))
    violations: list[Violation] = []
    for frame in rig.geometry.frames:
        limits = rig.frames[frame]
        for limit, (when, value) in enumerate(
            (
                (t, x[:, frame]),
                (t[1:], rate[:, frame]),
                (t[1:-1], acceleration[:, frame]),
                (t[2:-1], jerk[:, frame]),
            )
        ):
            if not value.size:
                continue
            peaks[frame, limit] = np.abs(value).max()
            if limit == 0:
                violation = np.maximum(limits.min - value, value - limits.max) - POSITION_TOLERANCE
            else:
                most = (limits.max_rate, limits.max_acceleration, limits.max_jerk)[limit - 1]
                violation = np.abs(value) - most * (1.0 + TOLERANCE)
                if limit == 3:  # the rounding of a position is no jerk
                    violation -= JERK_ROUNDING * (1.0 + np.abs(x[2:-1, frame])) / ((t[3:] - t[:-3]) / 3.0) ** 3
            violations += _runs(when, value, violation, FRAMES[frame], LIMITS[limit])
    violations.sort(key=lambda violation: violation.time)
    return Verification(max_error, max_matrix_error, peaks, tuple(violations))


def _runs(time: Array, value: Array, violation: Array, frame: Frame, limit: Limit) -> list[Violation]:
    outside = np.flatnonzero(violation > 0.0)
    runs = np.split(outside, np.flatnonzero(np.diff(outside) > 1) + 1) if outside.size else []
    peaks = [int(run[np.argmax(violation[run])]) for run in runs]
    return [
        Violation(float(time[k]), frame, limit, float(value[k]), len(run)) for k, run in zip(peaks, runs, strict=True)
    ]
