"""Compile (or load from the cache) every kernel of the loop before the loop begins."""

import math
from pathlib import Path

import numpy as np

from fullpose.rig import builtin_rigs
from fullpose_server.drives import registry
from fullpose_server.formats.plan_folder import PlanOrigin, PlanPath, make_plan
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.live.buffer import LiveBuffer
from fullpose_server.runtime.live.factory import compile_steps
from fullpose_server.runtime.live.packets import LiveSample
from fullpose_server.runtime.motion.generator import Motion
from fullpose_server.runtime.motion.limit_guard import Guard
from fullpose_server.session.states import Event


def any_rig() -> None:
    """What every rig needs, before it is known which: imports, and the kernels for a built-in one."""
    rig = builtin_rigs()["vertical-limited"]
    config = RigConfig(rig.name, rig, directory=Path(), runs=Path())  # nothing is read or written there
    registry.make(config.drive, rig, config.rate_hz, config.drive_options)
    kernels(config)


def kernels(config: RigConfig) -> None:
    """Fly a path of a few samples, a live source's buffer and each live method's step, and throw them away.

    A kernel that is first called in mid-flight would be compiled there, on a fresh machine for seconds; one that is
    first called at `load` would hold up the loop of a rig at rest, and whoever wants it stopped.
    """
    _path(config)
    buffer = LiveBuffer(0.0)
    q = np.empty(4)
    for k in range(2):
        buffer.add(LiveSample(k, 0.1 * k, (1.0, 0.0, 0.0, 0.0), None), 0.1 * k)
    for now in (0.05, 0.15):  # interpolated, extrapolated
        buffer.at(now, q)
    compile_steps(config.rig, 1.0 / config.rate_hz)


def _path(config: RigConfig) -> None:
    rig = config.rig
    n = 8
    angles = np.tile(rig.home, (n, 1))
    target = np.tile([1.0, 0.0, 0.0, 0.0], (n, 1))
    path = PlanPath(angles, target, np.zeros(n), lead_in_samples=1, lead_out_samples=1)
    plan = make_plan(PlanOrigin("prewarm", "", ""), rig, config.rate_hz, path, feasible=True)
    motion = Motion(rig, config.motion, config.rate_hz)
    guard = Guard(rig, config.guard, 1.0 / config.rate_hz)
    motion.rest_at(rig.home)
    motion.load(plan)
    motion.go(motion.plan_start(), Event.AT_START)
    motion.tick()
    motion.run()
    for wanted in (True, False):
        motion.hold(wanted)
        for _ in range(4):
            motion.tick()
            motion.solve_error(rig.axes)
            guard.command(motion.x, motion.x1, motion.v1, motion.v, motion.a, motion.jerk_from)
            motion.commit()
            guard.measured(motion.x, motion.x1, motion.q1)
    motion.v1[:] = math.radians(1.0)
    motion.brake(fastest=True)
    motion.tick()
