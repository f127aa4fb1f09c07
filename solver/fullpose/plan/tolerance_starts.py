"""Where the least tolerance is looked for: paths, far apart, that an optimisation which is local begins from.

None needs to be inside the limits. A four-axis rig's are the exact paths of both charts at a constant angle, which lie
in different homotopy classes; every rig's are those of the beam search over all frames, forward in time and
backward.
"""

import math
from collections.abc import Iterator

import numpy as np
from scipy.interpolate import CubicSpline

from fullpose._jit import kernel
from fullpose._typing import Array, Integers
from fullpose.charts import TURN, base_chart, inner_chart
from fullpose.kinematics import jacobian, payload_attitude, rotation_error
from fullpose.limits import RATE, limit_table
from fullpose.plan.three_axis import turns_into_range
from fullpose.rig import Rig
from fullpose.trajectory.attitude_beam import AttitudeStages, Search, attitude_search
from fullpose.trajectory.curve import null_vectors
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.windows import stage_samples

CONSTANTS = 8  # angles a turn that a chart's angle is held at
STAGE = 0.1  # [s]
FEWEST = 3  # stages of a search
SEARCHES = ((500, False), (500, True))  # states kept a stage, and whether backward in time
WIDER = ((2000, False),)  # where those lead far away
PATHS = 5  # of each search
POWER = 6.0  # of the attitude error that a path costs: the largest decides
LEVELS = 6  # of each frame that first poses are tried from, at most
APART = math.radians(60.0)  # between two of them
DESCENTS = 20
NO_FARTHER = math.radians(20.0)  # than the nearest first pose from the attitude
SAME = math.radians(4.0)  # first poses as near are one
ALONG = (0.0, 0.3, -0.3)  # [rad/s] along the self-motion, at first
SWEEPS = 8
TURNS_APART = 1.5  # from home on either side


def starts(problem: Problem, first: Array | None) -> Iterator[Array]:
    """Paths (n, 4) [rad]. first (1.., 4): a pose [rad] that is fixed, its rates [rad/s] where they are; None: free."""
    if problem.rig.geometry.redundant:
        yield from _constant_angles(problem)
    yield from _beams(problem, first, SEARCHES)


def more_starts(problem: Problem, first: Array | None) -> Iterator[Array]:
    """More of them, from wider searches."""
    yield from _beams(problem, first, WIDER)


def _beams(problem: Problem, first: Array | None, searches: tuple[tuple[int, bool], ...]) -> Iterator[Array]:
    time, rig = problem.time, problem.rig
    samples = stage_samples(time, STAGE)
    if len(samples) < FEWEST:
        return
    stages, attitude = time[samples], np.ascontiguousarray(problem.attitude[samples])
    for beam, backward in searches:
        if backward:
            reverse = np.ascontiguousarray(attitude[::-1])
            found = _searched(stages[-1] - stages[::-1], reverse, rig, None, beam)[:, ::-1]
        else:
            found = _searched(stages, attitude, rig, first, beam)
        for poses in found:
            yield np.asarray(CubicSpline(stages, poses)(time))


def _constant_angles(problem: Problem) -> Iterator[Array]:
    rig = problem.rig
    low, high = rig.position_min, rig.position_max
    for base in (True, False):
        for branch in (1.0, -1.0):
            for angle in (np.arange(CONSTANTS) + 0.5) * TURN / CONSTANTS - math.pi:
                path = np.empty((len(problem), 4))
                chart_path(rig.geometry.horizontal, base, problem.attitude, float(angle), branch, path)
                path = np.unwrap(path, axis=0)
                yield path + turns_into_range(path, low, high)


@kernel
def chart_path(horizontal: bool, base: bool, attitude: Array, angle: float, branch: float, path: Array) -> None:
    """path (n, 4) [rad] <- the exact poses of attitude (n, 3, 3) with the base, or the inner frame, at `angle`."""
    for k in range(attitude.shape[0]):
        if base:
            base_chart(horizontal, attitude[k], angle, branch, path[k])
        else:
            inner_chart(horizontal, attitude[k], angle, branch, path[k])


def _searched(time: Array, attitude: Array, rig: Rig, first: Array | None, beam: int) -> Array:
    """Up to `PATHS` paths (w, k, 4) [rad] at the stages' time (k,) [s], attitude (k, 3, 3)."""
    table, body = limit_table(rig), body_rates(time, attitude)
    poses = first_poses(attitude[0], rig) if first is None else first[:1].copy()
    if first is not None and len(first) > 1:
        rates = first[1:2].copy()
    else:
        poses, rates = _in_motion(rig, body[0], poses)
    paths = np.empty((PATHS, len(time), 4))
    count = attitude_search(
        Search(rig.axes, table, POWER), AttitudeStages(time, attitude, body), poses, rates, beam, paths
    )
    return paths[:count]


def _in_motion(rig: Rig, body: Array, poses: Array) -> tuple[Array, Array]:
    """Poses (m, 4) [rad] with rates (m, 4) [rad/s] that come near to the body's (3,), and differ by what is free."""
    alongs = np.array(ALONG if rig.geometry.redundant else ALONG[:1])
    null = np.zeros_like(poses)
    if rig.geometry.redundant:
        null_vectors(rig.geometry.horizontal, poses, null)
    rates = (alongs[:, None, None] * null).reshape(-1, 4)
    poses = np.tile(poses, (len(alongs), 1))
    toward_body_rate(rig.axes, limit_table(rig), body, poses, rates)
    return poses, rates


def first_poses(attitude: Array, rig: Rig) -> Array:
    """Poses (m, 4) [rad] inside the ranges that come near to attitude (3, 3), from a grid over all frames."""
    levels = []
    for i in range(4):
        if i not in rig.geometry.frames:
            levels.append(np.zeros(1))
            continue
        low, high = -math.pi, math.pi
        if np.isfinite(rig.position_max[i]):
            low = max(rig.position_min[i], rig.home[i] - TURNS_APART * TURN)
            high = max(min(rig.position_max[i], rig.home[i] + TURNS_APART * TURN), low)
        count = int(np.clip(math.ceil((high - low) / APART), 2, LEVELS))
        levels.append(low + (high - low) * (np.arange(count) + 0.5) / count)
    d = np.stack(np.meshgrid(*levels, indexing="ij"), axis=-1).reshape(-1, 4)
    error = np.empty(len(d))
    descend(rig.axes, rig.position_min, rig.position_max, attitude, d, error)
    order = np.argsort(error, kind="stable")
    d = d[order][error[order] <= error.min() + NO_FARTHER]
    _, kept = np.unique(np.round(d / SAME), axis=0, return_index=True)
    return np.ascontiguousarray(d[np.sort(kept)])


@kernel
def descend(axes: Integers, low: Array, high: Array, attitude: Array, d: Array, error: Array) -> None:
    """d (m, 4) [rad] <- poses inside low..high (4,) nearer to attitude (3, 3), frame by frame; error (m,) [rad]."""
    F = np.empty((3, 3))
    J = np.empty((3, 4))
    e = np.empty(3)
    for k in range(d.shape[0]):
        for _ in range(DESCENTS):
            payload_attitude(axes, d[k], F)
            if rotation_error(F, attitude, e) < 1e-9:
                break
            jacobian(axes, d[k], J)
            for i in range(4):
                if axes[i] < 0:
                    continue
                slope = J[0, i] * e[0] + J[1, i] * e[1] + J[2, i] * e[2]
                to = min(max(d[k, i] - slope, low[i]), high[i])
                for r in range(3):
                    e[r] += J[r, i] * (to - d[k, i])
                d[k, i] = to
        payload_attitude(axes, d[k], F)
        error[k] = rotation_error(F, attitude, e)


@kernel
def toward_body_rate(axes: Integers, table: Array, body: Array, d: Array, v: Array) -> None:
    """v (m, 4) [rad/s] <- rates inside the limits nearer to the body's (3,) at d (m, 4) [rad], frame by frame."""
    J = np.empty((3, 4))
    off = np.empty(3)
    for k in range(d.shape[0]):
        jacobian(axes, d[k], J)
        for r in range(3):
            off[r] = -body[r]
            for i in range(4):
                off[r] += J[r, i] * v[k, i]
        for _ in range(SWEEPS):
            for i in range(4):
                if axes[i] < 0:
                    continue
                to = v[k, i] - (J[0, i] * off[0] + J[1, i] * off[1] + J[2, i] * off[2])
                to = min(max(to, -table[RATE, i]), table[RATE, i])
                for r in range(3):
                    off[r] += J[r, i] * (to - v[k, i])
                v[k, i] = to


def body_rates(time: Array, attitude: Array) -> Array:
    """The body's rates (k, 3) [rad/s] over the interval before each of attitude (k, 3, 3); the first is the second."""
    k = len(time)
    turned = np.empty((k, 3))
    rotation_vectors(attitude, turned)
    turned[1:] /= np.diff(time)[:, None]
    turned[0] = turned[1]
    return turned


@kernel
def rotation_vectors(attitude: Array, turned: Array) -> None:
    """turned (k, 3) [rad] <- the rotation vector from each of attitude (k, 3, 3) to the next; the first is left."""
    for k in range(1, attitude.shape[0]):
        rotation_error(attitude[k], attitude[k - 1], turned[k])
