"""Every method's step beside mink's and pink's, on the same flights in the same run; and the limits on many flights.

    python -m bench.numerics.methods [--scenarios small_angles,...] [--methods exact,alm,...] [--peers mink,pink]
    python -m bench.numerics.methods --random 1000            # the methods that claim limits, on seeded random flights

The first prints, for each scenario: median and 99th percentile of the step, its ratio to mink's with the quickest
solver, share of exact samples, largest error, samples beyond a limit, iterations (of a peer: steps without a solution),
peak acceleration. A method may carry one option: alm:mode=open_loop. The second prints the largest excess over each
kind of limit and how many flights were flown exactly. Steps are timed in blocks of 16 samples, peers
(`bench.numerics.peers`) one by one; `bench.numerics.step_time` has ours one by one too.
"""

import argparse
import math
import time
from dataclasses import replace
from typing import Any

import numpy as np

from bench.machine import machine
from bench.numerics.peers import PEERS, race
from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion
from fullpose.compare import EXACT_WITHIN
from fullpose.errors import SolverError
from fullpose.methods import METHODS
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import DEG, SCENARIOS, random_flight
from fullpose.solve import solve
from fullpose.verify import attitude_errors, differences, payload_attitudes, verify

DEFAULT = "small_angles,large_no_limit,over_limit,both_beyond_90"
HEAD = ("median us", "p99 us", "x of mink", "exact %", "error deg", "matrix", "beyond", "iterations", "peak deg/s2")
PEER_SAMPLES = 3000  # of each flight: a peer's step takes a hundred of ours


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenarios", default=DEFAULT)
    parser.add_argument("--methods", default=",".join(METHODS))
    parser.add_argument("--peers", default=",".join(PEERS), help="none: leave it empty")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--random", type=int, default=0, metavar="FLIGHTS")
    arguments = parser.parse_args()
    print(machine())
    if arguments.random:
        keep_limits(arguments.random, [m for m in arguments.methods.split(",") if METHODS[m].claims_limits])
        return
    peers = [name for name in arguments.peers.split(",") if name]
    for name in arguments.scenarios.split(","):
        compare(name, arguments.methods.split(","), peers, arguments.repeats)


def compare(name: str, methods: list[str], peers: list[str], repeats: int) -> None:
    """One table: a scenario, ours and theirs."""
    scenario = SCENARIOS[name]
    rig = builtin_rigs()[scenario.rig]
    at, C = scenario.time, dcm_from_quaternion(scenario.quaternion)
    start = None if scenario.start is None else np.array(scenario.start)
    first = solve(at, C, rig, "exact", start=start).angles[0]
    print(f"\n{name} on {rig.name}, {len(at)} samples at {scenario.rate:g} Hz")
    theirs = dict(race(peers, rig, scenario.rate, C[:PEER_SAMPLES], first, repeats))
    minks = [float(np.nanmedian(run[0])) for peer, run in theirs.items() if peer.startswith("mink")]
    mink_median = min(minks, default=math.nan)
    print(f"{'':24}" + "".join(f"{word:>12}" for word in HEAD))
    for method in methods:
        key, options = variant(method)
        try:
            runs = [
                solve(at, C, rig, key, options=options, start=start, clock=time.perf_counter)
                for _ in range(repeats + 1)
            ][1:]
        except SolverError as error:
            print(f"{method:24}{error}")
            continue
        count = f"{np.median(runs[0].iterations):g}/{runs[0].iterations.max()}"
        times = np.concatenate([run.step_time for run in runs])
        _row(method, times, mink_median, rig, at, runs[0].angles, C, count)
    for peer, (times, angles, failed) in theirs.items():
        short = slice(0, PEER_SAMPLES)
        note = f"{failed} failed" if failed else "-"
        _row(peer, times, mink_median, rig, at[short], angles, C[short], note)


def variant(text: str) -> tuple[str, Any]:
    """(name, options or None) of "name" or "name:option=value"."""
    name, _, setting = text.partition(":")
    if not setting:
        return name, None
    key, _, value = setting.partition("=")
    defaults = METHODS[name].options()
    return name, replace(defaults, **{key: type(getattr(defaults, key))(value)})


def _row(
    name: str, times: Array, mink_median: float, rig: Rig, at: Array, angles: Array, C: Array, iterations: str
) -> None:
    median, p99 = np.nanpercentile(times, [50, 99]) * 1e6
    error, matrix_error = attitude_errors(payload_attitudes(rig, angles), C)
    result = verify(at, angles, rig)
    cells = [
        f"{median:.2f}",
        f"{p99:.2f}",
        f"{mink_median * 1e6 / median:.0f}",
        f"{100 * np.mean(error <= EXACT_WITHIN):.2f}",
        f"{np.degrees(error.max()):.1e}",
        f"{matrix_error.max():.1e}",
        str(sum(v.samples for v in result.violations)),
        iterations,
        f"{np.degrees(result.peaks[:, 2].max()):.4g}",
    ]
    print(f"{name:24}" + "".join(f"{cell:>12}" for cell in cells))


def narrow(geometry: Geometry) -> Rig:
    """Every kind of limit on every frame, tight enough to bind often; the base turns without end."""
    return Rig(
        f"{geometry.value}, narrow",
        geometry,
        (
            FrameLimits(max_rate=120 * DEG, max_acceleration=300 * DEG),
            FrameLimits(-100 * DEG, 100 * DEG, 150 * DEG, 500 * DEG),
            FrameLimits(-80 * DEG, 70 * DEG, 150 * DEG, 700 * DEG),
            FrameLimits(-60 * DEG, 60 * DEG, 300 * DEG, 2000 * DEG),
        ),
    )


def keep_limits(flights: int, methods: list[str]) -> None:
    """Largest excess over each kind of limit over seeded flights of 2 s at 1 kHz, 20 to 400 deg/s of body rate."""
    rigs = [builtin_rigs()["vertical-limited"], narrow(Geometry.VERTICAL_4), narrow(Geometry.HORIZONTAL_4)]
    print(f"\n{flights} random flights, over {len(rigs)} rigs by turns")
    head = ("exact flights", "limited %", "position deg", "rate deg/s", "accel deg/s2", "rate %", "accel %", "nan")
    print(f"{'':12}" + "".join(f"{word:>15}" for word in head))
    for method in methods:
        exact = limited = samples = broken = 0
        worst = np.full(3, -np.inf)
        share = np.full(3, -np.inf)
        for seed in range(flights):
            rig = rigs[seed % len(rigs)]
            speed = math.radians(20.0 * 20.0 ** ((seed * 0.6180339887) % 1.0))
            at, q = random_flight(seed, 2.0, 1000.0, speed)
            solution = solve(at, dcm_from_quaternion(q), rig, method)
            broken += int(not np.isfinite(solution.angles).all())
            excess, relative = _excess(rig, at, solution.angles)
            worst, share = np.maximum(worst, excess), np.maximum(share, relative)
            exact += int(solution.error.max() <= EXACT_WITHIN)
            limited += solution.limited_samples
            samples += at.size
        cells = [f"{exact}", f"{100 * limited / samples:.2f}", *(f"{np.degrees(v):.1e}" for v in worst)]
        cells += [f"{100 * share[1]:.1e}", f"{100 * share[2]:.1e}", str(broken)]
        print(f"{method:12}" + "".join(f"{cell:>15}" for cell in cells))


def _excess(rig: Rig, at: Array, angles: Array) -> tuple[Array, Array]:
    """How far beyond the limits (negative: inside): absolute and relative, of position, rate, acceleration. (3,)"""
    rate, acceleration = differences(at, angles)
    position = np.maximum(rig.position_min - angles, angles - rig.position_max).max()
    over_rate, over_acceleration = np.abs(rate) - rig.max_rate, np.abs(acceleration) - rig.max_acceleration
    absolute = np.array([position, over_rate.max(), over_acceleration.max()])
    relative = [0.0, (over_rate / rig.max_rate).max(), (over_acceleration / rig.max_acceleration).max()]
    return absolute, np.array(relative)


if __name__ == "__main__":
    main()
