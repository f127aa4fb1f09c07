"""A run of an hour at 1 kHz in the console: how long its curves take to make, what a window of them costs, and memory.

Writes a synthetic record, as the recorder does, with a step of a single sample that no drawing may lose:
`python -m bench.realtime.long_run --minutes 60 --folder DIR`. The record takes 0.4 GB.
"""

import argparse
import json
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from fullpose_server.runtime.contract.telemetry import SAMPLE, Flag, Samples
from fullpose_server.runtime.recording.curves import COLUMNS, TIME, Curves, make_curves
from fullpose_server.runtime.recording.mcap_writer import RunRecord
from fullpose_server.session.states import State

RATE_HZ = 1000
CHUNK = 100  # rows, as the recorder cuts them
BEGUN_NS, WALL_NS = 5_000_000_000, 1_790_000_000_000_000_000
SPIKE_DEG = 77.0


def samples(first: int, count: int, of: int) -> Samples:
    """Rows of a made-up flight: smooth, noisy as an encoder is, with one sample aside in the middle of the run."""
    number = np.arange(first, first + count)
    time_s = number / RATE_HZ
    rows = np.zeros(count, SAMPLE)
    rows["seq"] = number + 1
    rows["tick"] = number + 1
    rows["time_ns"] = BEGUN_NS + number * (1_000_000_000 // RATE_HZ)
    rows["wall_ns"] = WALL_NS + number * (1_000_000_000 // RATE_HZ)
    rows["state"] = State.RUNNING.code
    rows["flags"] = Flag.ENABLED
    rows["path_time_s"] = time_s
    rows["path_scale"] = 1.0
    phase = 2 * np.pi * time_s[:, None] * np.array([0.05, 0.11, 0.23, 0.31])
    rows["demand"] = 40 * np.sin(phase)
    rows["demand_rate"] = 80 * np.pi * np.array([0.05, 0.11, 0.23, 0.31]) * np.cos(phase)
    noise = np.random.default_rng(first).normal(size=(count, 4))
    rows["measured"] = rows["demand"] + 1e-3 * noise
    rows["measured"][number == of // 2, 1] = SPIKE_DEG
    rows["measured_rate"] = rows["demand_rate"] + 0.05 * noise
    rows["target"] = (1.0, 0.0, 0.0, 0.0)
    rows["solve_error_deg"] = 1e-12 * (1 + noise[:, 0] ** 2)
    rows["tracking_error_deg"] = 1e-3 * np.abs(noise[:, 1])
    rows["following_error_deg"] = 1e-3 * noise
    rows["margin"] = 0.4 + 0.1 * np.sin(phase[:, 0])
    rows["lateness_us"] = 20 + 5 * np.abs(noise[:, 2])
    return rows


def write_record(path: Path, rows: int) -> None:
    """A record of so many rows, with alarms and transitions, as the recorder writes one."""
    record = RunRecord(path, {"run_id": path.stem, "rig": "vertical-4", "who": "bench", "plan": {}}, WALL_NS, BEGUN_NS)
    record.add_event({"kind": "run_begin", "time_ns": BEGUN_NS, "head": 0, "run_id": path.stem})
    for first in range(0, rows, CHUNK):
        record.add_samples(samples(first, min(CHUNK, rows - first), rows))
        if first % (60 * RATE_HZ) == 0:
            at = BEGUN_NS + first * (1_000_000_000 // RATE_HZ)
            wall_s = (WALL_NS + at - BEGUN_NS) / 1e9
            told = {"code": "tracking", "severity": "warning", "message": "tracking error 0.02 deg", "count": 1}
            number = first // (60 * RATE_HZ) + 1
            record.add_event(
                {"kind": "alarm", "time_ns": at, "time_s": wall_s, "number": number, "first": False, **told}
            )
        record.cut()
    record.add_event({"kind": "run_end", "time_ns": BEGUN_NS + rows * 1_000_000, "head": rows, "how": "completed"})
    record.finish()


def main() -> None:
    """Print what was measured, as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--folder", type=Path, required=True, help="where the record is written, and stays")
    parser.add_argument("--width", type=int, default=1200)
    parser.add_argument("--measure", help=argparse.SUPPRESS)
    given = parser.parse_args()
    record = given.folder / "runs" / f"20260921T000000-vertical-4-{round(given.minutes):06d}.mcap"
    target = given.folder / "curves" / record.stem
    if given.measure is not None:
        print(json.dumps({"build": _build, "look": _look}[given.measure](record, target, given.width)))
        return
    record.parent.mkdir(parents=True, exist_ok=True)
    if not record.exists():
        write_record(record, round(given.minutes * 60 * RATE_HZ))
    shutil.rmtree(target, ignore_errors=True)
    told: dict[str, object] = {"rows": round(given.minutes * 60 * RATE_HZ), "record_mb": record.stat().st_size / 1e6}
    for part in ("build", "look"):  # each in a process of its own: the most memory it had is its alone
        command = [sys.executable, "-m", "bench.realtime.long_run", "--measure", part, "--folder", str(given.folder)]
        command += ["--minutes", str(given.minutes), "--width", str(given.width)]
        told[part] = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    told["curves_mb"] = sum(file.stat().st_size for file in target.iterdir()) / 1e6
    print(json.dumps(told, indent=1))


def _build(record: Path, target: Path, _width: int) -> dict[str, float]:
    began = _memory_mb()
    started, cpu = time.monotonic(), time.process_time()
    make_curves(record, target, lambda _part: None)
    return {
        "seconds": time.monotonic() - started,
        "cpu_s": time.process_time() - cpu,
        "memory_mb": _memory_mb(),
        "more_than_before_mb": _memory_mb() - began,
    }


def _look(record: Path, target: Path, width: int) -> dict[str, float]:
    started = time.monotonic()
    curves = Curves(target, record)
    opened = time.monotonic() - started
    middle, rows = curves.about.duration_s / 2, curves.about.rows
    spike = COLUMNS.index("measured_outer_deg")
    times = {}
    for name, half in (("all", middle), ("minute", 30.0), ("ten_seconds", 5.0), ("second", 0.5)):
        started = time.monotonic()
        found = curves.window(middle - half, middle + half, width)
        times[f"{name}_ms"] = 1e3 * (time.monotonic() - started)
        if found.greatest[:, spike].max() != SPIKE_DEG:
            raise SystemExit(f"{name}: the sample aside is not in what is drawn")
    if curves.window(0.0, 2 * middle, width).edges[-1] != rows or COLUMNS[0] != TIME:
        raise SystemExit("all of it is not all of it")
    return {"open_ms": 1e3 * opened, **times, "memory_mb": _memory_mb()}


def _memory_mb() -> float:
    """The most that this process has had; `ru_maxrss` counts the parent's before the exec, too."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmHWM:")) / 1024


if __name__ == "__main__":
    main()
