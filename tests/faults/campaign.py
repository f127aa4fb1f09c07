"""A campaign of faults: random kills, stops, full disks and damaged files, in random states of a real rig and server.

    python -m tests.faults.campaign [--count 300] [--seed 1] [--only ROUND] [--json FILE]

After each: the server is up, the rig can be flown again, every row that was recorded is inside the limits, and what was
recorded lacks no more than the last chunk. A round that fails is named, and the others go on;
`--only` repeats its fault in its state.
"""

import argparse
import json
import os
import random
import signal
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from enum import StrEnum
from pathlib import Path

import httpx

from tests.faults.laboratory import NAME, RATE_HZ, Laboratory, suspended
from tests.support.disks import fill, small_disk
from tests.support.waiting import until

DISK_KB = 400_000
CHUNK_S = 0.3  # of the recorder: what it holds, and what it may be late by
STATES = ("idle", "ready", "armed", "positioning", "running", "running", "running", "held", "stopping", "estopped")


class Fault(StrEnum):
    """What is done to the laboratory."""

    SERVER_KILLED = "server killed"
    SERVER_SUSPENDED = "server suspended"
    GATE_KILLED = "gate killed"
    RIG_KILLED = "rig process killed"
    RIG_SUSPENDED = "rig process suspended"
    RECORDER_KILLED = "recorder killed"
    DISK_FULL = "disk full"
    DATABASE_DAMAGED = "database damaged"
    PLAN_DAMAGED = "plan damaged"
    RUN_DAMAGED = "run damaged"
    RIG_FILE_DAMAGED = "rig file damaged"
    STOP = "stop"
    ESTOP = "estop"


def damage(path: Path, chance: random.Random) -> None:
    """Cut a file short, or write over some of it, as a failing disk does."""
    content = bytearray(path.read_bytes())
    if chance.random() < 0.5:
        path.write_bytes(bytes(content[: chance.randrange(len(content) + 1)]))
        return
    for _ in range(64):
        if content:
            content[chance.randrange(len(content))] = chance.randrange(256)
    path.write_bytes(bytes(content))


def stopped(lab: Laboratory, word: str) -> None:
    """Stop and E-stop are answered, whatever else is not."""
    answer = lab.server.http.post(f"/rigs/{NAME}/{word}")
    assert answer.status_code in (200, 202, 409), answer.text  # 409: a stop where there is nothing to stop


class Round:
    """One fault in one state."""

    def __init__(self, lab: Laboratory, seed: int, number: int) -> None:
        self._lab = lab
        self.number = number
        self._chance = random.Random(f"{seed}/{number}")
        self.fault = self._chance.choice(list(Fault))
        self.state = self._chance.choice(STATES)
        self._moment_s = self._chance.uniform(0.0, 1.5)
        self._spoiled: Path | None = None

    def __str__(self) -> str:
        return f"round {self.number}: {self.fault} after {self._moment_s:.2f} s of {self.state}"

    def run(self) -> None:
        """Bring the rig to its state, do it, and look at what is left."""
        lab = self._lab
        lab.serve()  # a round that failed may have left none
        before = lab.records()
        lab.bring(self.state)
        time.sleep(self._moment_s)
        shared = lab.shared()
        recording = shared is not None and self.state in ("running", "held") and self.fault not in (Fault.RUN_DAMAGED,)
        taken = int(shared.header["recorder_seq"][0]) if shared is not None else 0
        self._inject()
        lab.serve()
        lab.to_idle()
        newest = lab.judge(before, self._spoiled)
        if recording and self.fault is not Fault.DISK_FULL:
            held = CHUNK_S * RATE_HZ
            assert newest, "nothing was recorded"
            assert max(newest.values()) >= taken - held, f"recorded up to {newest}, taken were {taken}"

    def _inject(self) -> None:
        lab, process = self._lab, self._lab.process
        assert process is not None
        match self.fault:
            case Fault.SERVER_KILLED:
                lab.kill_server()
                time.sleep(self._chance.uniform(0.0, 2.0))
            case Fault.SERVER_SUSPENDED:
                word = self._chance.choice(["stop", "estop"])
                suspended(process.pid, self._chance.uniform(0.1, 2.0), lambda: stopped(lab, word))
            case Fault.GATE_KILLED:
                gate = lab.gate()
                assert gate is not None
                os.kill(gate, signal.SIGKILL)
            case Fault.RIG_KILLED:
                self._kill("rig_pid")
            case Fault.RECORDER_KILLED:
                self._kill("recorder_pid")
            case Fault.RIG_SUSPENDED:
                shared = lab.shared()
                if shared is not None:
                    suspended(int(shared.header["rig_pid"][0]), self._chance.uniform(0.05, 1.0))
            case Fault.DISK_FULL:
                self._fill()
            case Fault.STOP | Fault.ESTOP:
                stopped(lab, self.fault.value)
            case _:
                self._damage()

    def _kill(self, whose: str) -> None:
        shared = self._lab.shared()
        if shared is not None:
            os.kill(int(shared.header[whose][0]), signal.SIGKILL)

    def _fill(self) -> None:
        ballast = fill(self._lab.data)
        try:
            time.sleep(self._chance.uniform(0.0, 1.5))
            stopped(self._lab, self._chance.choice(["stop", "estop"]))
        finally:
            ballast.unlink()
            (self._lab.data / "one more").unlink(missing_ok=True)

    def _damage(self) -> None:
        lab = self._lab
        where = {
            Fault.DATABASE_DAMAGED: "fullpose.db*",
            Fault.PLAN_DAMAGED: "plans/*/*",
            Fault.RUN_DAMAGED: "runs/*.mcap",
            Fault.RIG_FILE_DAMAGED: f"rigs/{NAME}.toml",
        }[self.fault]
        lab.kill_server()
        files = sorted(path for path in lab.data.glob(where) if path.is_file())
        if not files:
            assert self.fault in (Fault.PLAN_DAMAGED, Fault.RUN_DAMAGED), f"{where}: nothing to damage"
            return  # none was made yet
        path = self._chance.choice(files)
        whole = path.read_bytes()
        damage(path, self._chance)
        if self.fault is Fault.RUN_DAMAGED:
            self._spoiled = path
        lab.serve()
        if self.fault is Fault.RIG_FILE_DAMAGED:  # a person's own file: told, and left for that person to mend
            until(lambda: lab.server.http.get("/rigs").status_code == 200)
            path.write_bytes(whole)
            until(lambda: lab.server.http.get(f"/rigs/{NAME}").status_code == 200)


@dataclass(frozen=True)
class Done:
    """What became of a round."""

    number: int
    fault: str
    state: str
    took_s: float
    failed: str | None


def rounds(lab: Laboratory, seed: int, numbers: range | list[int]) -> Iterator[Done]:
    """Run them one after the other; one that fails says so, and the next begins with what it has left."""
    for number in numbers:
        one, began = Round(lab, seed, number), time.monotonic()
        failed = None
        try:
            one.run()
        except (AssertionError, httpx.HTTPError, OSError) as error:
            failed = f"{one} (seed {seed}): {type(error).__name__}: {error}"
        took_s = time.monotonic() - began
        print(f"{one}: {took_s:.1f} s{'' if failed is None else ', FAILED: ' + failed}", file=sys.stderr, flush=True)
        yield Done(number, one.fault.value, one.state, took_s, failed)


def table(done: Sequence[Done]) -> str:
    """A line a fault, and what failed."""
    lines = [f"{'fault':24s} {'times':>6s} {'failed':>7s} {'median s':>9s} {'longest s':>10s}"]
    for fault in Fault:
        of = [one for one in done if one.fault == fault]
        if of:
            took = sorted(one.took_s for one in of)
            failed = sum(one.failed is not None for one in of)
            lines.append(f"{fault:24s} {len(of):6d} {failed:7d} {took[len(took) // 2]:9.1f} {took[-1]:10.1f}")
    failures = [one.failed for one in done if one.failed is not None]
    lines.append(f"{'in all':24s} {len(done):6d} {len(failures):7d}")
    if not failures:
        lines.append(
            "limits kept in every recorded row, the server up again, nothing recorded lost beyond the last chunk"
        )
    return "\n".join([*lines, *failures])


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, help="the number of one round")
    parser.add_argument("--json", type=Path)
    asked = parser.parse_args()
    numbers = range(asked.count) if asked.only is None else [asked.only]
    with (
        tempfile.TemporaryDirectory() as folder,
        small_disk(Path(folder) / "disk", DISK_KB) as data,
        Laboratory(data) as lab,
    ):
        done = []
        for one in rounds(lab, asked.seed, numbers):
            done.append(one)
            if asked.json is not None:
                told = {"seed": asked.seed, "asked": len(numbers), "rounds": [asdict(each) for each in done]}
                asked.json.write_text(json.dumps(told, indent=1), encoding="utf-8")
    print(table(done))
    sys.exit(any(one.failed is not None for one in done))


if __name__ == "__main__":
    main()
