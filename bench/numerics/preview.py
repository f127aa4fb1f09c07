"""Share of random full-attitude flights that `preview` flies exactly inside every limit, against the preview it has.

    python -m bench.numerics.preview --flights 40 [--rates 60] [--previews 0,0.1,0.5,1,2] [--rigs vertical-limited,...]
    python -m bench.numerics.preview --flights 10 --delay 0.05 --plan 1
    python -m bench.numerics.preview --timing

Seeded flights of 20 s (`fullpose.scenarios.random_flight`); a flight counts where no sample is limited, the error of
every sample is below 1e-9 deg and the independent check finds no violation. Beside it `exact` and, with --plan 1,
`plan`. Also: limited samples, flights of which a limit was exceeded (must be none), the longest time to regain the
attitude, and the processor time of a re-plan. horizontal-limited has the frames of vertical-limited. Rates in deg/s,
previews in seconds.
"""

import argparse
import time as clock
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bench.machine import machine
from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion
from fullpose.compare import EXACT_WITHIN
from fullpose.plan import PreviewFlight, PreviewOptions, PreviewStepper
from fullpose.rig import Rig, builtin_rigs
from fullpose.scenarios import DEG, random_flight
from fullpose.solve import solve
from fullpose.verify import attitude_errors, payload_attitudes, verify

SECONDS = 20.0


@dataclass(frozen=True)
class Flown:
    """One flight: whether all of it was exact and inside, samples limited, longest run of them [s], limits exceeded."""

    exact: bool
    limited: float
    longest: float
    broken: bool
    replan_ms: float


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flights", type=int, default=10)
    parser.add_argument("--rates", default="60")
    parser.add_argument("--previews", default="0,0.1,0.5,1,2")
    parser.add_argument("--rigs", default="vertical-limited,horizontal-limited")
    parser.add_argument("--hz", type=float, default=1000.0)
    parser.add_argument("--delay", type=float, default=0.0, help="flight time until a re-plan is there [s]")
    parser.add_argument("--plan", type=int, default=0, metavar="0|1", help="fly them with plan too")
    parser.add_argument("--timing", action="store_true", help="only the time of a step and of a re-plan")
    arguments = parser.parse_args()
    print(machine())
    if arguments.timing:
        timing()
        return
    print(f"{arguments.flights} flights of {SECONDS:g} s at {arguments.hz:g} Hz, re-plans {arguments.delay:g} s late")
    rigs = builtin_rigs()
    rigs["horizontal-limited"] = replace(rigs["horizontal-4"], frames=rigs["vertical-limited"].frames)
    head = ("flown", "share", "limited %", "longest s", "broken", "re-plan ms")
    print(f"{'rig':18}{'deg/s':>7}{'':>15}" + "".join(f"{word:>12}" for word in head))
    for name in arguments.rigs.split(","):
        for rate in (float(word) for word in arguments.rates.split(",")):
            flights = [_flight(seed, arguments.hz, rate) for seed in range(arguments.flights)]
            rig = rigs[name]
            _row(name, rate, "exact", [_solved(rig, *each, "exact") for each in flights])
            if arguments.plan:
                _row(name, rate, "plan", [_solved(rig, *each, "plan") for each in flights])
            for preview in (float(word) for word in arguments.previews.split(",")):
                options = PreviewOptions(preview_s=preview, delay_s=arguments.delay)
                _row(name, rate, f"preview {preview:g} s", [_previewed(rig, *each, options) for each in flights])


def _flight(seed: int, hz: float, rate: float) -> tuple[Array, Array]:
    at, q = random_flight(seed, SECONDS, hz, rate * DEG)
    return at, dcm_from_quaternion(q)


def _solved(rig: Rig, at: Array, attitude: Array, method: str) -> Flown:
    solution = solve(at, attitude, rig, method)
    return _judged(rig, at, attitude, solution.angles, solution.limited, np.nan)


def _previewed(rig: Rig, at: Array, attitude: Array, options: PreviewOptions) -> Flown:
    flight = PreviewFlight(rig, options, None, at, attitude)
    begin = clock.process_time()
    block = flight.block(at, attitude)
    spent = clock.process_time() - begin
    # The steps' own share is small and counted in.
    return _judged(rig, at, attitude, block.angles, block.limited, 1e3 * spent / max(1, flight.replans))


def _judged(rig: Rig, at: Array, attitude: Array, angles: Array, limited: NDArray[np.int16], replan_ms: float) -> Flown:
    error, _ = attitude_errors(payload_attitudes(rig, angles), attitude)
    broken = bool(verify(at, angles, rig).violations)
    marks = np.flatnonzero(np.diff(np.r_[0, (limited != 0).astype(np.int8), 0]))
    longest = max((float(end - begin) for begin, end in zip(marks[::2], marks[1::2], strict=True)), default=0.0)
    exact = not broken and not limited.any() and bool(error.max() <= EXACT_WITHIN)
    return Flown(exact, float(np.mean(limited != 0)), longest * float(at[1] - at[0]), broken, replan_ms)


def _row(rig: str, rate: float, method: str, flown: list[Flown]) -> None:
    exact = sum(each.exact for each in flown)
    cells = [
        f"{exact}/{len(flown)}",
        f"{exact / len(flown):.3f}",
        f"{100 * np.mean([each.limited for each in flown]):.2f}",
        f"{max(each.longest for each in flown):.2f}",
        str(sum(each.broken for each in flown)),
        f"{np.mean([each.replan_ms for each in flown]):.1f}",
    ]
    print(f"{rig:18}{rate:7g}{method:>15}" + "".join(f"{cell:>12}" for cell in cells), flush=True)


def timing() -> None:
    """Wall time of a live sample and of asking for a re-plan, processor time of its run."""
    rig = builtin_rigs()["vertical-limited"]
    at, attitude = _flight(2, 1000.0, 60.0)
    print(f"{'':14}{'step us':>10}{'p99':>8}{'ask us':>10}{'p99':>8}{'run ms':>10}{'p99':>8}")
    for preview in (0.0, 0.5, 1.0, 2.0):
        stepper = PreviewStepper(rig, replace(PreviewOptions(), preview_s=preview), rig.home, attitude[0])
        steps, asks, runs = [], [], []
        for k in range(5000):
            until = k + round(1000 * preview)
            begin = clock.perf_counter()
            if preview:
                stepper.offer(at[until : until + 1], attitude[until : until + 1])
            stepper.block(at[k : k + 1], attitude[k : k + 1])
            steps.append(clock.perf_counter() - begin)
            if stepper.due:
                begin = clock.perf_counter()
                job = stepper.replan()
                asks.append(clock.perf_counter() - begin)
                begin = clock.thread_time()
                way = job.run()
                runs.append(clock.thread_time() - begin)
                stepper.adopt(way)
        cells = [np.percentile(v, (50, 99)) * s for v, s in ((steps[10:], 1e6), (asks[2:], 1e6), (runs[2:], 1e3))]
        print(f"preview {preview:3g} s" + "".join(f"{low:10.1f}{high:8.1f}" for low, high in cells))


if __name__ == "__main__":
    main()
