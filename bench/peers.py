"""The peers on the rigs: mink (MuJoCo) and pink (Pinocchio), each stepping after the same attitudes.

Both solve a quadratic programme a step: an orientation task on the payload under position and rate limits, then
integrate; what their own examples do. Neither has an acceleration limit or an exact end.
"""

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.mjcf import mjcf
from solver.rig import FRAMES, Rig

Array = NDArray[np.float64]
SOLVER = "daqp"  # the quickest for both here

# (rig, rate [Hz], attitude (n, 3, 3), start (4,) [rad]) -> (seconds of each step (n,), angles (n, 4) [rad], how many
# steps had no solution: the pose was kept)
Peer = Callable[[Rig, float, Array, Array], tuple[Array, Array, int]]


def run_mink(rig: Rig, rate_hz: float, C: Array, start: Array) -> tuple[Array, Array, int]:
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
            rate = mink.solve_ik(configuration, [task], dt, SOLVER, limits=limits)
        except mink.NoSolutionFound:
            return None
        configuration.integrate_inplace(rate, dt)
        return np.asarray(configuration.q)

    return _timed(step, targets, start)


def run_pink(rig: Rig, rate_hz: float, C: Array, start: Array) -> tuple[Array, Array, int]:
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
            rate = solve_ik(configuration, [task], dt, solver=SOLVER, safety_break=False)
        except NoSolutionFound:
            return None
        configuration.integrate_inplace(rate, dt)
        return np.asarray(configuration.q)

    return _timed(step, targets, start)


PEERS: dict[str, Peer] = {"mink": run_mink, "pink": run_pink}


def _timed(step: Callable[[Any], Array | None], targets: list[Any], start: Array) -> tuple[Array, Array, int]:
    times, angles = np.empty(len(targets)), np.empty((len(targets), 4))
    failed = 0
    for k, target in enumerate(targets):
        begin = time.perf_counter()
        pose = step(target)
        times[k] = time.perf_counter() - begin
        if pose is None:
            failed += 1
            angles[k] = angles[k - 1] if k else start
        else:
            angles[k] = pose
    return times, angles, failed
