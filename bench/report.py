"""Every quick figure of this tree in one table, before and after in the same run where another tree is given.

    python -m bench.report [--against TREE] [--rounds 3] [--latency] [--json FILE]

Steps of the methods, plans, start-up of the command line, of the library and of the server; with --latency the live
source's, the E-stop's and the loop's as well, by each tree's own bench. Each is measured in processes of its own, the
trees in turns, so that a machine's mood meets both; the figure is the best of the rounds, and "spread" how far the
rounds of this tree lay apart: a difference within it says nothing. Then the figures of the house (`tools/house.py`).
Trees from before the packages were called fullpose and fullpose_server are understood. Warm caches: a round before the
first compiles, and is thrown away.
"""

import argparse
import json
import math
import os
import re
import resource
import subprocess
import sys
import tempfile
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

from bench.machine import machine
from tools.house import figures

HERE = Path(__file__).resolve().parents[1]
FLIGHT = HERE / "examples" / "flights" / "loop.csv"
METHODS = (
    "exact,alm:mode=closed_loop,alm:mode=open_loop,dwln,lagrange,weighted,gradient_projection,fixed_joint,clamped,"
    "follow_up,three_axis,preview"
)
REPEATS = 3
WORSE = 1.05  # what a figure may grow to


@dataclass(frozen=True)
class Tree:
    """A checkout, and what its packages are called."""

    root: Path

    @property
    def renamed(self) -> bool:
        """Whether the packages have our own names."""
        return (self.root / "solver" / "fullpose").is_dir()

    @property
    def library(self) -> str:
        return "fullpose" if self.renamed else "solver"

    @property
    def server(self) -> str:
        return "fullpose_server" if self.renamed else "server"

    @property
    def environment(self) -> dict[str, str]:
        """The environment of a process that imports from this tree."""
        roots = [self.root / "solver", self.root / "server", self.root] if self.renamed else [self.root]
        return {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, roots))}

    def run(self, *command: str) -> str:
        """What Python prints for `command`, with this tree's packages."""
        done = subprocess.run(
            [sys.executable, "-P", *command], cwd=self.root, env=self.environment, capture_output=True, text=True
        )
        if done.returncode != 0:
            raise RuntimeError(f"{self.root}: {' '.join(command)}\n{done.stderr}")
        return done.stdout

    def bench(self, name: str, *arguments: str) -> str:
        """What one of this tree's own real-time benches prints."""
        folder = "bench.realtime" if (self.root / "bench" / "realtime").is_dir() else "bench"
        return self.run("-m", f"{folder}.{name}", *arguments)


def start_up(tree: Tree) -> dict[str, float]:
    """Processor seconds of whole processes, the least of a few: other work on the machine disturbs them little."""
    main = f"from {tree.server}.cli import main; import sys; sys.argv = ['fullpose', *sys.argv[1:]]; main()"
    with tempfile.TemporaryDirectory() as folder:
        solve = ["solve", str(FLIGHT), "--convention", "ned", "--rig", "vertical-4", "--out", f"{folder}/out.csv"]
        commands = {
            "start-up: import the library [s]": ["-c", f"import {tree.library}.solve"],
            "start-up: import the server [s]": ["-c", f"import {tree.server}.app"],
            "start-up: fullpose --help [s]": ["-c", main, "--help"],
            "start-up: fullpose rigs [s]": ["-c", main, "rigs"],
            "fullpose solve --method plan, whole process [s]": ["-c", main, *solve, "--method", "plan"],
            "fullpose solve --method exact, whole process [s]": ["-c", main, *solve, "--method", "exact"],
        }
        return {name: min(processor_s(tree, command) for _ in range(REPEATS)) for name, command in commands.items()}


def processor_s(tree: Tree, command: list[str]) -> float:
    """Processor seconds of one process."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    tree.run(*command)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def latency(tree: Tree) -> dict[str, float]:
    """Of the live source and of the E-stop, from the tables of the tree's benches."""
    live = tree.bench("live_latency", "--seconds", "15", "--way", "udp")
    stop = tree.bench("estop_latency", "--times", "10", "--viewers", "20")
    found = {}
    for name, p50, p99 in re.findall(
        r"^(round trip|latency in the rig process) \[us\] +p50 +(\S+) +p99 +(\S+)", live, re.M
    ):
        found |= {f"live: {name}, p50 [us]": float(p50), f"live: {name}, p99 [us]": float(p99)}
    late = tree.bench("loop_lateness", "--seconds", "10", "--viewers", "20")
    for p50, p99 in re.findall(r"^rig process, flying +(\S+) +(\S+)", late, re.M):
        found |= {"loop: lateness, p50 [us]": float(p50), "loop: lateness, p99 [us]": float(p99)}
    for way, p50 in re.findall(r"^(flag|HTTP|WebSocket) +(\d\S*) ", stop, re.M):
        found[f"E-stop by {way}, p50 [ms]"] = float(p50)
    return found


def measure(tree: Tree, with_latency: bool) -> dict[str, float]:
    """One round of everything."""
    printed = tree.run(str(HERE / "bench" / "probe.py"), tree.library, str(FLIGHT), "--methods", METHODS)
    found: dict[str, float] = json.loads(printed)
    return found | start_up(tree) | (latency(tree) if with_latency else {})


def row(name: str, after: list[float], before: list[float]) -> str:
    """One line of the table."""
    now, spread = min(after), max(after) / min(after) - 1.0
    line = f"{name:52s} {now:10.3f} {100 * spread:7.1f} %"
    if not before:
        return line
    ratio = now / min(before)
    mark = "" if ratio <= WORSE else "  within the spread" if ratio <= WORSE + spread else "  WORSE"
    return f"{line} {min(before):10.3f} {ratio:7.3f}{mark}"


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--against", type=Path, help="another checkout: before")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--latency", action="store_true")
    parser.add_argument("--json", type=Path)
    given = parser.parse_args()
    trees = {"after": Tree(HERE)} | ({"before": Tree(given.against.resolve())} if given.against else {})
    rounds: dict[str, dict[str, list[float]]] = {label: defaultdict(list) for label in trees}
    for k in range(given.rounds + 1):
        for label, tree in trees.items():
            for name, value in measure(tree, given.latency and k > 0).items():
                if k > 0:
                    rounds[label][name].append(value)
        print(f"# round {k} of {given.rounds} done", file=sys.stderr, flush=True)
    before = rounds.get("before", {})
    print(machine())
    print(f"{'':52s} {'after':>10s} {'spread':>9s}" + (f" {'before':>10s} {'ratio':>7s}" if before else ""))
    for name, values in rounds["after"].items():
        print(row(name, values, before.get(name, [])))
    shapes = {label: figures(tree.root) for label, tree in trees.items()}
    for name, count in shapes["after"].items():
        print(f"{name:62s} {count:6d}" + (f"  before {shapes['before'][name]:6d}" if before else ""))
    if given.json:
        shares = {
            name: min(v) / min(before[name]) if before.get(name) else math.nan for name, v in rounds["after"].items()
        }
        report = {"machine": machine(), "rounds": rounds, "ratio": shares if before else None, "house": shapes}
        given.json.write_text(json.dumps(report, indent=1) + "\n")


if __name__ == "__main__":
    main()
