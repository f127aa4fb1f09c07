"""Runs `make demo`, and `make test` where asked, on bare roots by debootstrap that have python3 and make alone.

    sudo python3 -m tools.fresh [--test] [--as user,root] [NAME ...]

NAME is debian12, debian13, jammy or noble; all by default. Each run is in a copy of its root, in a folder with blanks
in its name, with the committed files of this tree. What `make` says is missing is installed as it says and `make` is
run again: the line is right when that does it. Mounts and processes are in namespaces that end with them. Packages come
from the mirror that apt uses here; those of Ubuntu from the folder beside it, where it has one, checked by the keyring
that Debian 13 has of Ubuntu.
"""

import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from tools.bare_roots import RELEASES, USER, FreshError, copy_of, entered, make_root

RIG = "vertical-limited"
ANSWERS_S, FLIES_S, ENDS_S, TESTED_S = 900.0, 300.0, 60.0, 7200.0
ADVICE = re.compile(r"apt-get install ((?:[a-z0-9.+-]+ ?)+)")


@dataclass(frozen=True)
class Row:
    """One line of the table."""

    machine: str
    who: str
    what: str
    result: str
    seconds: float

    def __str__(self) -> str:
        return f"{self.machine:10} {self.who:9} {self.what:24} {self.seconds:7.1f} s  {self.result}"


class Watched:
    """A command whose lines are read as they come, with when."""

    def __init__(self, command: list[str], log: Path) -> None:
        self.begun = time.monotonic()
        self.lines: list[tuple[float, str]] = []
        self._log = log
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stdout is not None  # noqa: S101
        with self._log.open("a") as log:
            for line in self.process.stdout:
                self.lines.append((time.monotonic() - self.begun, line.rstrip()))
                log.write(f"{self.lines[-1][0]:8.1f} {line}")
                log.flush()

    def until(self, seconds: float, wanted: re.Pattern[str]) -> tuple[float, str] | None:
        """The first line that matches, and when; None where the command ended, or said nothing of it in time."""
        while True:
            ended = self.process.poll() is not None
            if ended:
                self._reader.join(10.0)
            for when, line in list(self.lines):
                found = wanted.search(line)
                if found:
                    return when, found.group()
            if ended or time.monotonic() - self.begun > seconds:
                return None
            time.sleep(0.1)

    def end(self, seconds: float, sign: signal.Signals | None = None) -> int | None:
        """Its exit status, after a signal as a terminal sends it; None where it had to be killed."""
        if sign is not None and self.process.poll() is None:
            os.killpg(self.process.pid, sign)
        try:
            return self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()
            return None
        finally:
            self._reader.join(10.0)

    def silence(self, until: float) -> float:
        """The longest that it said nothing, up to then [s]."""
        times = [0.0, *(when for when, _ in self.lines if when < until), until]
        return max(after - before for before, after in pairwise(times))


def state(address: str) -> str:
    """The session's state of the demo's rig, or why it does not answer."""
    try:
        with urllib.request.urlopen(f"{address}/api/v1/rigs/{RIG}/session", timeout=20) as answer:
            found = re.search(r'"state": ?"(\w+)"', answer.read().decode())
            return found.group(1) if found else "no state"
    except (urllib.error.URLError, TimeoutError) as cause:
        return str(cause)


def demo(run: Watched) -> Iterator[tuple[str, str, float]]:
    """What happened, how, and after how many seconds: address, flight, end."""
    told = run.until(ANSWERS_S, re.compile(r"^http://\S+"))
    if told is None:
        status = run.end(1.0)
        yield "make demo", advice(run) or f"FAILED, status {status}: {last(run)}", time.monotonic() - run.begun
        return
    when, address = told
    try:
        with urllib.request.urlopen(address, timeout=30) as page:
            answer = f"{page.status}, {len(page.read())} bytes; longest silence before {run.silence(when):.0f} s"
    except (urllib.error.URLError, TimeoutError) as cause:
        answer = f"FAILED: {cause}"
    yield "demo: address answers", answer, when
    seen = ""
    while time.monotonic() - run.begun < when + FLIES_S and seen not in ("running", "faulted"):
        seen = state(address)
        time.sleep(0.2)
    flown = time.monotonic() - run.begun
    if seen == "running":
        time.sleep(10.0)  # and goes on
        seen = f"{seen}, 10 s later {state(address)}"
    yield "demo: rig flies", seen if seen.startswith("running") else f"FAILED: {seen}", flown
    ending = time.monotonic()
    status = run.end(ENDS_S, signal.SIGINT)
    yield "demo: ended by Ctrl-C", f"status {status}", time.monotonic() - ending


def test(run: Watched) -> Iterator[tuple[str, str, float]]:
    """How `make test` ended, and what it said last of each gate."""
    status = run.end(TESTED_S)
    gates = [line for _, line in run.lines if re.match(r"== .* (ok in|FAILED)", line)]
    yield "make test", advice(run) or (f"status {status}: " + "; ".join(gates)), time.monotonic() - run.begun


def advice(run: Watched) -> str:
    """The line that says what to install; empty where there is none."""
    return next((line for _, line in reversed(run.lines) if ADVICE.search(line) and "missing" in line), "")


def last(run: Watched) -> str:
    """Its last lines."""
    return " | ".join(line for _, line in run.lines[-4:])


def machine(name: str, root: Path, who: str, *, tests: bool, logs: Path) -> Iterator[Row]:
    """`make demo` and what was asked for beside it, on one fresh machine; what it says is missing is then installed."""
    with copy_of(root) as copy:
        python = subprocess.run(["chroot", copy, "python3", "--version"], capture_output=True, text=True).stdout.split()
        for target, judged in (("demo", demo), ("test", test)) if tests else (("demo", demo),):
            for _ in range(2):
                log = logs / f"{name}-{who}-{target}.log"
                run = Watched(entered(copy, who, "nice", "-n", "15", "make", target), log)
                for what, result, seconds in judged(run):
                    yield Row(f"{name} {python[-1]}", who, what, result, seconds)
                missing = ADVICE.search(advice(run))
                if missing is None:
                    break
                packages = missing.group(1).split()
                begun = time.monotonic()
                apt = f"apt-get update -q && apt-get install -q -y --no-install-recommends {' '.join(packages)}"
                done = subprocess.run(entered(copy, "root", "sh", "-c", apt), capture_output=True, text=True)
                result = f"status {done.returncode}" + (f": {done.stderr[-300:]}" if done.returncode else "")
                yield Row(name, "root", "installed as it said", result, time.monotonic() - begun)


def main() -> int:
    """Print the table as it grows; 1 where anything failed."""
    parser = argparse.ArgumentParser(description="Runs make demo and make test on bare roots made by debootstrap.")
    parser.add_argument("names", nargs="*", default=list(RELEASES), choices=[*RELEASES, []], metavar="NAME")
    parser.add_argument("--test", action="store_true", help="run make test as well")
    parser.add_argument("--as", dest="people", default="user,root", help="user, root or both")
    parser.add_argument("--roots", type=Path, default=Path("/var/tmp/fullpose-fresh"), help="where the roots are kept")
    asked = parser.parse_args()
    if os.geteuid() != 0:
        parser.exit(2, "fresh: run this as root: sudo python3 -m tools.fresh\n")
    if shutil.which("debootstrap") is None:
        parser.exit(2, "fresh: debootstrap is missing: apt-get install debootstrap\n")
    asked.roots.mkdir(parents=True, exist_ok=True)
    rows: list[Row] = []
    for name in asked.names:
        root = asked.roots / name
        begun = time.monotonic()
        if not root.exists():
            try:
                make_root(name, root)
                rows.append(Row(name, "root", "root made", "done", time.monotonic() - begun))
            except FreshError as cause:
                rows.append(Row(name, "root", "root made", f"SKIPPED: {cause}", time.monotonic() - begun))
            print(rows[-1], flush=True)
        if root.exists():
            for who in asked.people.split(","):
                for row in machine(name, root, USER if who == "user" else who, tests=asked.test, logs=asked.roots):
                    rows.append(row)
                    print(row, flush=True)
    return int(any("FAILED" in row.result for row in rows))


if __name__ == "__main__":
    sys.exit(main())
