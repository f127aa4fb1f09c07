"""The peers on the rigs: mink (MuJoCo) and pink (Pinocchio), each stepping after the same attitudes.

Both solve a quadratic programme a step, then integrate; what their own examples do. They are given an orientation task
on the payload of gain 1, the rig's position limits where a frame has stops, and its rate limits. Neither has an
acceleration limit or an exact end. Timed: the target taken over, `solve_ik`, the integration, where there was a
solution; the targets are made before, and warnings are off, for printing them would be timed too. `solve_ik` of both
asks for a solver and has no default: see `DOCUMENTED`.
"""

import logging
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from bench.numerics.mjcf import mjcf
from fullpose._typing import Array
from fullpose.rig import FRAMES, Rig

# (seconds of each step (n,), nan where it had no solution, angles (n, 4) [rad], how many had none: the pose was kept)
Run = tuple[Array, Array, int]
# (rig, rate [Hz], attitude (n, 3, 3), start (4,) [rad], solver as qpsolvers names it)
Peer = Callable[[Rig, float, Array, Array, str], Run]

# mink requires `qpsolvers[daqp]`; its quickstart and its own benchmark take daqp. pink's README takes quadprog.
DOCUMENTED = {"mink": "daqp", "pink": "quadprog"}
TRIAL = 300  # samples that the quickest solver is chosen on


def run_mink(rig: Rig, rate_hz: float, C: Array, start: Array, solver: str) -> Run:
    """mink's `solve_ik`."""
    import mink
    import mujoco

    model = mujoco.MjModel.from_xml_string(mjcf(rig))
    configuration = mink.Configuration(model, q=start.copy())
    task = mink.FrameTask(FRAMES[3], "body", position_cost=0.0, orientation_cost=1.0, gain=1.0)
    limits: list[Any] = [
        mink.ConfigurationLimit(model),
        mink.VelocityLimit(model, {FRAMES[i]: float(rig.max_rate[i]) for i in range(4)}),
    ]
    dt = 1.0 / rate_hz
    targets = [mink.SE3.from_rotation(mink.SO3.from_matrix(np.ascontiguousarray(F.T))) for F in C]

    def step(target: Any) -> Array | None:
        task.set_target(target)
        try:
            rate = mink.solve_ik(configuration, [task], dt, solver, limits=limits)
        except mink.NoSolutionFound:
            return None
        configuration.integrate_inplace(rate, dt)
        return np.asarray(configuration.q)

    return _timed(step, targets, start)


def run_pink(rig: Rig, rate_hz: float, C: Array, start: Array, solver: str) -> Run:
    """pink's `solve_ik`."""
    import pinocchio as pin
    from pink import Configuration, solve_ik
    from pink.exceptions import NoSolutionFound
    from pink.tasks import FrameTask

    model = pin.Model()
    joint = 0
    kinds = (pin.JointModelRX, pin.JointModelRY, pin.JointModelRZ)
    for i in range(4):
        joint = model.addJoint(joint, kinds[rig.geometry.axes[i]](), pin.SE3.Identity(), FRAMES[i])
        model.appendBodyToJoint(joint, pin.Inertia.Random(), pin.SE3.Identity())
    model.addFrame(pin.Frame("payload", joint, pin.SE3.Identity(), pin.FrameType.OP_FRAME))
    model.lowerPositionLimit = rig.position_min.copy()
    model.upperPositionLimit = rig.position_max.copy()
    model.velocityLimit = rig.max_rate.copy()
    configuration = Configuration(model, model.createData(), start.copy())
    task = FrameTask("payload", position_cost=0.0, orientation_cost=1.0, gain=1.0)
    dt = 1.0 / rate_hz
    targets = [pin.SE3(np.ascontiguousarray(F.T), np.zeros(3)) for F in C]

    def step(target: Any) -> Array | None:
        task.set_target(target)
        try:
            # A solution that rounding puts a hair beyond a limit is no reason to stop the race.
            rate = solve_ik(configuration, [task], dt, solver=solver, safety_break=False)
        except NoSolutionFound:
            return None
        configuration.integrate_inplace(rate, dt)
        return np.asarray(configuration.q)

    return _timed(step, targets, start)


PEERS: dict[str, Peer] = {"mink": run_mink, "pink": run_pink}


def solvers(name: str, rig: Rig, rate_hz: float, C: Array, start: Array) -> dict[str, str]:
    """{solver: why it is in the race} of a peer: the quickest of those installed first, then the documented one."""
    from qpsolvers import dense_solvers

    medians = {s: float(np.nanmedian(PEERS[name](rig, rate_hz, C[:TRIAL], start, s)[0])) for s in dense_solvers}
    quickest = min(medians, key=medians.__getitem__)
    chosen = {quickest: f"quickest of the dense solvers here ({', '.join(sorted(medians))})"}
    documented = DOCUMENTED[name]
    if documented == quickest:
        chosen[quickest] += "; the documented one"
    elif documented in medians:
        chosen[documented] = "the documented one"
    else:
        chosen[quickest] += f"; the documented one, {documented}, is not installed"
    return chosen


def race(names: list[str], rig: Rig, rate_hz: float, C: Array, start: Array, repeats: int) -> Iterator[tuple[str, Run]]:
    """("peer solver", its run) of every peer and solver, the steps of all repeats timed; says why each solver."""
    for name in names:
        for solver, why in solvers(name, rig, rate_hz, C, start).items():
            runs = [PEERS[name](rig, rate_hz, C, start, solver) for _ in range(repeats)]
            print(f"{name} with {solver}: {why}")
            yield f"{name} {solver}", (np.concatenate([run[0] for run in runs]), *runs[0][1:])


def _timed(step: Callable[[Any], Array | None], targets: list[Any], start: Array) -> Run:
    times, angles = np.empty(len(targets)), np.empty((len(targets), 4))
    failed = 0
    logging.disable(logging.WARNING)
    for k, target in enumerate(targets):
        begin = time.perf_counter()
        pose = step(target)
        times[k] = time.perf_counter() - begin
        if pose is None:
            failed += 1
            times[k] = np.nan
            angles[k] = angles[k - 1] if k else start
        else:
            angles[k] = pose
    logging.disable(logging.NOTSET)
    return times, angles, failed
