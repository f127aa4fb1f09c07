"""The dynamics of a simulated table: four second-order servos with saturation. One kernel; radians."""

import math
from typing import Any, Protocol

import numpy as np

from fullpose._jit import inlined, kernel
from fullpose._typing import Array, Flags

DISABLED, ENABLED, BRAKING = range(3)
SUBSTEPS = 2


class Table(Protocol):
    """A simulated table, as `TABLE` lays it out. Arrays (4,), by frame."""

    dt: float  # [s] of a tick
    mode: int  # `DISABLED`, `ENABLED` or `BRAKING`
    quiet: int  # ticks since the last write:
    watchdog: int  # beyond so many the servos brake by themselves
    # State: the load is what lies behind the backlash.
    motor: Array  # [rad]
    rate: Array  # [rad/s]
    load: Array  # [rad]
    # The servos
    present: Flags
    omega: Array  # [rad/s] bandwidth
    damping: Array
    max_rate: Array  # [rad/s]
    max_acceleration: Array  # [rad/s^2]
    backlash: Array  # [rad]
    feed_forward: Array  # share of the acceleration
    # Disturbances
    stuck: Flags
    runaway: Flags
    # The demand: the position due at the start of the first tick, and what is due at its end
    due: Array  # [rad]
    demand: Array  # (3, 4) position, rate and acceleration


TABLE = np.dtype(
    (
        np.record,
        np.dtype(
            [
                ("dt", "f8"), ("mode", "i8"), ("quiet", "i8"), ("watchdog", "i8"),
                ("motor", "f8", 4), ("rate", "f8", 4), ("load", "f8", 4),
                ("present", "u1", 4), ("omega", "f8", 4), ("damping", "f8", 4), ("max_rate", "f8", 4),
                ("max_acceleration", "f8", 4), ("backlash", "f8", 4), ("feed_forward", "f8", 4),
                ("stuck", "u1", 4), ("runaway", "u1", 4), ("due", "f8", 4), ("demand", "f8", (3, 4)),
            ],
            align=True,
        ),
    )
)  # fmt: skip


@inlined
def acceleration(table: Table, i: int, share: float, h: float) -> float:
    """Of frame i [rad/s^2], a `share` of the tick after its start; h [s] is the substep."""
    v = table.rate[i]
    most = table.max_acceleration[i]
    if table.runaway[i]:
        return float(most)
    if table.mode != ENABLED:
        return -math.copysign(min(most, abs(v) / h), v)
    w = table.omega[i]
    reference = table.due[i] + share * (table.demand[0, i] - table.due[i])
    a = (
        w * w * (reference - table.motor[i])
        + 2.0 * table.damping[i] * w * (table.demand[1, i] - v)
        + table.feed_forward[i] * table.demand[2, i]
    )
    return float(min(max(a, -most), most))


@kernel
def advance(tables: Any, ticks: int) -> None:
    """Advance the servos of `tables[0]`, (1,) `TABLE`, by `ticks`; the watchdog may change its mode."""
    table = tables[0]
    h = table.dt / SUBSTEPS
    for tick in range(ticks):
        if table.mode == ENABLED and table.quiet + tick > table.watchdog:
            table.mode = BRAKING
        for sub in range(SUBSTEPS):
            # The reference now, not at the substep's end: the servo would lead by half a tick.
            share = float(sub) / SUBSTEPS if tick == 0 else 1.0
            for i in range(4):
                if not table.present[i]:
                    continue
                v = table.rate[i] + acceleration(table, i, share, h) * h
                if abs(v) > table.max_rate[i]:
                    v = math.copysign(table.max_rate[i], v)
                if table.stuck[i]:
                    v = 0.0
                table.rate[i] = v
                table.motor[i] += v * h
                # Backlash: the load moves only while the motor pushes it.
                half = 0.5 * table.backlash[i]
                gap = table.motor[i] - table.load[i]
                if gap > half:
                    table.load[i] = table.motor[i] - half
                elif gap < -half:
                    table.load[i] = table.motor[i] + half
