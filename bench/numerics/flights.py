"""Share of flights flown exactly inside all limits, by every method: python -m bench.numerics.flights [options]

    python -m bench.numerics.flights --seeds 24 --previews 5 --out docs/guide/flights.md
        --plot docs/guide/figures/flights.svg

Random flights through all attitudes, 20 s at 500 Hz, at three body rates on three rigs (`--seeds` of each: 24 make
216), and the flights of examples/flights. A flight is flown when every sample is exact (1e-9 deg) and `fullpose.verify`
finds no limit exceeded. Live previews, which simulate their re-planning as well, take the first `--previews` seeds.
"""

import argparse
import time as clock
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from bench.machine import machine
from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion
from fullpose.errors import SolverError
from fullpose.methods import METHODS
from fullpose.plan import PlanOptions, plan
from fullpose.preview.flight import PreviewFlight
from fullpose.preview.options import PreviewOptions
from fullpose.rig import FRAMES, FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.solve import solve
from fullpose.verify import verify
from fullpose_server.formats.trajectory import Convention
from fullpose_server.formats.trajectory_file import read_trajectory

EXACT = np.radians(1e-9)
RATES = (30.0, 60.0, 120.0)  # [deg/s] of the body, root mean square
PREVIEWS = (0.0, 0.1, 0.5, 1.0, 2.0)  # [s]
DURATION, SAMPLE_RATE = 20.0, 500.0
EXAMPLES = Path(__file__).parents[2] / "examples" / "flights"


def rigs() -> dict[str, Rig]:
    """The limit set of mathematics, section 8 on both geometries; one with cut ranges, half the accelerations."""
    limited = builtin_rigs()["vertical-limited"]
    spans = (300.0, 170.0, 120.0, 60.0)
    narrow = tuple(
        FrameLimits(-np.radians(s), np.radians(s), f.max_rate, 0.5 * f.max_acceleration)
        for s, f in zip(spans, limited.frames, strict=True)
    )
    return {
        "vertical": limited,
        "horizontal": replace(limited, name="horizontal", geometry=Geometry.HORIZONTAL_4),
        "narrow": Rig("narrow", Geometry.VERTICAL_4, (narrow[0], narrow[1], narrow[2], narrow[3])),
    }


@dataclass(frozen=True)
class Outcome:
    """One method on one flight: flown, the seconds it took, the largest shares of rate and acceleration limits."""

    flown: bool
    seconds: float
    rate_share: float
    acceleration_share: float
    decided_by: str = ""


def outcome(time: Array, attitude: Array, rig: Rig, run: Callable[[], tuple[Array, str]]) -> Outcome:
    """Run a method and mark it by the independent check."""
    begin = clock.perf_counter()
    try:
        angles, decided_by = run()
    except SolverError as error:
        return Outcome(False, clock.perf_counter() - begin, np.nan, np.nan, str(error))
    seconds = clock.perf_counter() - begin
    found = verify(time, angles, rig, attitude)
    flown = not found.violations and found.max_error <= EXACT
    return Outcome(
        flown, seconds, float((found.peaks[:, 1] / rig.max_rate).max()),
        float((found.peaks[:, 2] / rig.max_acceleration).max()), decided_by,
    )  # fmt: skip


def runners(time: Array, attitude: Array, rig: Rig, previews: bool) -> dict[str, Callable[[], tuple[Array, str]]]:
    """What is run on a flight, by name."""

    def step(name: str) -> Callable[[], tuple[Array, str]]:
        return lambda: (solve(time, attitude, rig, name).angles, "")

    def planned() -> tuple[Array, str]:
        made = plan(time, attitude, rig, options=PlanOptions(best_effort=False))
        return made.solution.angles, made.verdict.decided_by

    def live(seconds: float) -> Callable[[], tuple[Array, str]]:
        options = PreviewOptions(preview_s=seconds)
        return lambda: (PreviewFlight(rig, options, None, time, attitude).block(time, attitude).angles, "")

    chosen = {name: step(name) for name in METHODS}
    if previews:
        chosen |= {f"preview {seconds:g} s": live(seconds) for seconds in PREVIEWS}
    return chosen | {"plan": planned}


def example(path: Path) -> tuple[Array, Array]:
    """(time (n,), attitude (n, 3, 3)) of an example flight."""
    flight = read_trajectory(path, Convention.NED)
    return np.array(flight.time), dcm_from_quaternion(np.array(flight.q))


def bench(
    seeds: int, previews: int
) -> tuple[dict[tuple[str, str, float], list[Outcome]], dict[tuple[str, str], Outcome]]:
    """(outcomes by (method, rig, body rate), outcomes by (method, example flight))."""
    results: dict[tuple[str, str, float], list[Outcome]] = defaultdict(list)
    for rig_name, rig in rigs().items():
        for rate in RATES:
            for seed in range(seeds):
                time, q = random_flight(1000 + seed, DURATION, SAMPLE_RATE, np.radians(rate))
                attitude = dcm_from_quaternion(q)
                for name, run in runners(time, attitude, rig, seed < previews).items():
                    results[name, rig_name, rate].append(outcome(time, attitude, rig, run))
            print(f"{rig_name} {rate:g} deg/s done", flush=True)
    examples: dict[tuple[str, str], Outcome] = {}
    for path in sorted(EXAMPLES.glob("*.csv")):
        time, attitude = example(path)
        rig = rigs()["vertical"]
        for name, run in runners(time, attitude, rig, previews > 0).items():
            examples[name, path.stem] = outcome(time, attitude, rig, run)
    return results, examples


def table(results: dict[tuple[str, str, float], list[Outcome]], examples: dict[tuple[str, str], Outcome]) -> str:
    """The tables, Markdown."""
    methods = list(dict.fromkeys(name for name, _, _ in results))
    lines = ["| method | " + " | ".join(f"{rig} {rate:g}" for rig in rigs() for rate in RATES) + " | all | median s |"]
    lines.append("|---|" + "---:|" * (len(rigs()) * len(RATES) + 2))
    for name in methods:
        cells, flown, total, seconds = [], 0, 0, []
        for rig in rigs():
            for rate in RATES:
                cell = results[name, rig, rate]
                cells.append(f"{sum(o.flown for o in cell)}/{len(cell)}")
                flown += sum(o.flown for o in cell)
                total += len(cell)
                seconds += [o.seconds for o in cell]
        lines.append(
            f"| {name} | " + " | ".join(cells) + f" | {100 * flown / total:.0f} % | {np.median(seconds):.2f} |"
        )
    planned = [o for (name, _, _), cell in results.items() if name == "plan" for o in cell]
    decided: dict[str, int] = defaultdict(int)
    for o in planned:
        decided["flown" if o.flown else o.decided_by] += 1
    lines += ["", "What decided for `plan`: " + ", ".join(f"{k} {v}" for k, v in sorted(decided.items())) + "."]
    good = [o for o in planned if o.flown]
    lines.append(
        f"Of the {len(good)} plans flown: planning time median {np.median([o.seconds for o in good]):.2f} s, largest "
        f"{max(o.seconds for o in good):.2f} s for {DURATION:g} s at {SAMPLE_RATE:g} Hz; largest share of a rate limit "
        f"median {np.median([o.rate_share for o in good]):.2f}, of an acceleration limit "
        f"{np.median([o.acceleration_share for o in good]):.2f}."
    )
    flights = list(dict.fromkeys(flight for _, flight in examples))
    lines += ["", "The example flights on `vertical-limited`:", "", "| method | " + " | ".join(flights) + " |"]
    lines.append("|---|" + "---|" * len(flights))
    for name in methods:
        cells = ["flown" if examples[name, f].flown else "no" for f in flights]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def plot(results: dict[tuple[str, str, float], list[Outcome]], path: Path) -> None:
    """Share flown by method and body rate, all rigs together."""
    import matplotlib as mpl

    mpl.use("svg")
    mpl.rcParams.update({"svg.hashsalt": "fullpose", "font.size": 8, "legend.frameon": False})
    from matplotlib import pyplot as plt

    methods = list(dict.fromkeys(name for name, _, _ in results))
    figure, axes = plt.subplots(figsize=(7.2, 0.26 * len(methods) + 0.9))
    for number, (rate, colour) in enumerate(zip(RATES, ("#56b4e9", "#0072b2", "#d55e00"), strict=True)):
        shares = []
        for name in methods:
            cell = [o for rig in rigs() for o in results[name, rig, rate]]
            shares.append(100.0 * sum(o.flown for o in cell) / len(cell))
        axes.barh(np.arange(len(methods)) + 0.27 * (number - 1), shares, 0.25, color=colour, label=f"{rate:g} deg/s")
    axes.set_yticks(np.arange(len(methods)), methods)
    axes.invert_yaxis()
    axes.set_xlim(0, 100)
    axes.set_xlabel("flights flown exactly inside all limits, %")
    axes.legend(loc="lower right")
    figure.tight_layout()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Date": None})


def main() -> None:
    """Run, print, and write the table and the plot where asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--previews", type=int, default=1)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--plot", type=Path)
    chosen = parser.parse_args()
    begin = clock.perf_counter()
    results, examples = bench(chosen.seeds, chosen.previews)
    text = table(results, examples)
    print(text)
    print(f"{machine()}, {clock.perf_counter() - begin:.0f} s")
    if chosen.out:
        command = f"python -m bench.numerics.flights --seeds {chosen.seeds} --previews {chosen.previews}"
        chosen.out.write_text(HEAD.format(command=command, machine=machine(), limits=limits_text()) + text)
    if chosen.plot:
        plot(results, chosen.plot)


def limits_text() -> str:
    """The limit sets in words."""
    lines = []
    for name, rig in rigs().items():
        parts = []
        for frame, f in zip(FRAMES, rig.frames, strict=True):
            span = "free" if f.continuous else f"+-{np.degrees(f.max):.0f} deg"
            parts.append(
                f"{frame} {span}, {np.degrees(f.max_rate):.0f} deg/s, {np.degrees(f.max_acceleration):.0f} deg/s^2"
            )
        lines.append(f"- `{name}` ({rig.geometry}): " + "; ".join(parts))
    return "\n".join(lines)


HEAD = """# Flights flown, by method

Written by `{command}` on {machine}.
A flight counts as flown when every sample is exact (1e-9 deg) and the independent check finds no limit exceeded.
Random flights through all attitudes, 20 s at 500 Hz; the columns are rig and body
rate in deg/s. The previews were simulated on the first seeds of each column only.

{limits}

![share flown](figures/flights.svg)

"""


if __name__ == "__main__":
    main()
