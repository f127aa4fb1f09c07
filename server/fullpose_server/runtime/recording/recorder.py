"""The recorder: a process of its own, at ordinary priority, that writes every run as it happens.

`python -m fullpose_server.runtime.recording.recorder --memory FILE --runs DIR`: reads ring and events, and keeps
the last second before a run too. A fault while no run is recorded is an incident: a record of its own, of the last
second and of what follows until rest. Ends when its parent does, after the record is complete;
and as the one process that lives exactly as long, it ends a parent that hangs for good where no server does.
"""

import argparse
import contextlib
import os
import shutil
import signal
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from fullpose_server.runtime.contract.hung import Hung
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.contract.telemetry import Samples
from fullpose_server.runtime.recording.mcap_writer import RunRecord
from fullpose_server.runtime.recording.record_names import RECORD
from fullpose_server.session.run_end import RunEnd

CYCLE_S = 0.05
CHUNK_S = 0.1
_BATCH = 4096
_SYNC_S = 1.0
_STATISTICS_S = 1.0
# An incident is recorded until rest, between so long and so long after its last alarm.
_AFTER_S = 1.0
_LONGEST_S = 10.0
_AT_REST_DEG_S = 0.5
_HUNG_LOOKS, _PATIENT_LOOKS = 100, 600  # five seconds and more: a server is there before


class Recorder:
    """Follows one rig's shared memory."""

    def __init__(self, shared: Shared, runs: Path) -> None:
        self._shared = shared
        self._header = shared.header
        self._runs = runs
        self._record: RunRecord | None = None
        self._next = shared.ring.head  # last sequence that was taken
        self._events = int(self._header["recorder_event"][0])
        self._header["recorder_run"] = b""  # what one before us was killed over is not ours to go on with
        self._until: int | None = None  # last sequence of a run that has ended
        self._alarm_ns: int | None = None  # of an incident: when its last alarm came
        self._cut_at = self._statistics_at = self._space_at = 0.0

    def cycle(self, now: float) -> None:
        """Take what is new; `now` [s, monotonic]."""
        self._header["recorder_beat_ns"] = time.monotonic_ns()
        if now - self._space_at > 1.0:
            self._space_at = now
            with contextlib.suppress(OSError):
                self._header["recorder_free_bytes"] = shutil.disk_usage(self._runs).free
        events, self._events = self._shared.events_since(self._events)
        for event in events:
            if event["kind"] == "run_begin":
                self._begin(event)
            elif event["kind"] == "incident":
                self._incident(event)
            if self._record is not None:
                self._record.add_event(event)
            if event["kind"] == "run_end":
                self._until = int(event["head"])
        self._header["recorder_event"] = self._events
        if self._record is None:
            self._next = self._shared.ring.head
            self._header["recorder_seq"] = self._next  # nothing is owed
        else:
            self._take(self._record)
            self._write(self._record, now)

    def end(self) -> None:
        """The rig process is gone: complete the record with all there is."""
        self.cycle(time.monotonic())
        if self._record is not None and self._until is None and self._alarm_ns is None:
            now_ns, wall_ns = time.monotonic_ns(), time.time_ns()
            times = {"time_ns": now_ns, "wall_ns": wall_ns, "head": self._shared.ring.head}
            self._record.add_event({"kind": "run_end", **times, "how": RunEnd.PROCESS_LOST})
        self._finish()

    def _begin(self, event: dict[str, Any]) -> None:
        if self._record is not None:
            # It is owed its last samples; one whose end was not told (an incident) ends here.
            self._until = int(event["head"]) if self._until is None else self._until
            self._take(self._record)
            self._finish()
        self._until = self._alarm_ns = None
        name = str(event["run_id"])
        try:
            self._runs.mkdir(parents=True, exist_ok=True)
            run = {key: event[key] for key in ("run_id", "rig", "who", "plan")}
            if event["kind"] == "incident":
                run["incident"] = event["code"]
            self._record = RunRecord(self._runs / f"{name}{RECORD}", run, event["wall_ns"], event["time_ns"])
        except OSError as cause:
            self._complain(f"{name} is not recorded: {cause.strerror}")
            return
        before = round(1e9 / int(self._header["period_ns"][0]))
        self._next = max(0, int(event["head"]) - before)
        self._header["recorder_run"] = name.encode()
        self._header["recorder_error"] = b""

    def _incident(self, event: dict[str, Any]) -> None:
        if self._record is None or self._until is not None:
            self._begin(event)
        elif self._alarm_ns is None:
            return  # it is in a run's record already
        self._alarm_ns = int(event["time_ns"])

    def _take(self, record: RunRecord) -> None:
        while True:
            wanted = _BATCH if self._until is None else min(_BATCH, self._until - self._next)
            rows, lost = self._shared.ring.since(self._next, wanted)
            if lost:
                self._header["recorder_lost"] += lost
                self._next += lost
            if not len(rows):
                break
            record.add_samples(rows)
            self._next = int(rows["seq"][-1])
            if self._alarm_ns is not None and self._until is None:
                self._until = _rest(rows, self._alarm_ns)
        self._header["recorder_seq"] = self._next

    def _write(self, record: RunRecord, now: float) -> None:
        if now - self._statistics_at >= _STATISTICS_S:
            self._statistics_at = now
            header = self._header
            statistics = {
                "ticks": int(header["ticks"][0]),
                "deadline_misses": int(header["misses"][0]),
                "busy_us": int(header["busy_ns"][0]) / 1e3,
                "lateness_us": self._shared.lateness_us(),
                "free_bytes": int(header["recorder_free_bytes"][0]),
            }
            record.add_statistics(time.monotonic_ns(), statistics)
        ended = self._until is not None and self._next >= self._until
        if ended or now - self._cut_at >= CHUNK_S:
            self._cut_at = now
            try:
                record.cut()
                self._header["recorder_error"] = b""
            except OSError as cause:
                self._complain(f"the record waits: {cause.strerror}")
            except BufferError as cause:
                self._complain(f"the record ends early, readable as far as it is: {cause}")
                record.file.close()
                self._record = None
                return
            self._header["recorder_bytes"] = record.file.length
            self._header["recorder_chunks"] = record.chunks
        if ended:
            self._finish()

    def _finish(self) -> None:
        if self._record is None:
            return
        record, self._record = self._record, None
        try:
            record.finish()
        except OSError as cause:
            self._complain(f"the record has no index: {cause.strerror}")
        self._header["recorder_bytes"] = record.file.length
        self._header["recorder_run"] = b""

    def _complain(self, text: str) -> None:
        self._header["recorder_error"] = text.encode()[:191]


def _rest(rows: Samples, alarm_ns: int) -> int | None:
    """The sequence that an incident ends with; None where it is not among `rows`."""
    after_s = (rows["time_ns"] - alarm_ns) / 1e9
    # False where an encoder is lost: whether that frame rests is not known.
    still = np.abs(rows["measured_rate"]).max(axis=1) < _AT_REST_DEG_S
    ends = np.flatnonzero((still & (after_s >= _AFTER_S)) | (after_s >= _LONGEST_S))
    return int(rows["seq"][ends[0]]) if len(ends) else None


def main() -> None:
    """Record until the parent process ends."""
    arguments = argparse.ArgumentParser(description="Records the runs of one rig.")
    arguments.add_argument("--memory", type=Path, help="with --runs; without: both are read from stdin, a line each")
    arguments.add_argument("--runs", type=Path)
    arguments.add_argument("--parent", type=int, required=True)
    given = arguments.parse_args()
    os.nice(5)
    os.sched_setaffinity(0, range(os.cpu_count() or 1))  # not where the loop was put, should it start us anew
    if given.memory is None:
        memory, runs = (sys.stdin.readline().strip() for _ in range(2))
        if not runs or os.getppid() != given.parent:
            return  # who started us ended before there was anything to record
        given.memory, given.runs = Path(memory), Path(runs)
    shared = Shared(given.memory)
    shared.header["recorder_pid"] = os.getpid()
    recorder = Recorder(shared, given.runs)
    hung = Hung(_HUNG_LOOKS, _PATIENT_LOOKS)
    while os.getppid() == given.parent:
        recorder.cycle(time.monotonic())
        newest = shared.ring.latest()
        state = None if newest is None else int(newest["state"][0])
        if hung.look(shared.header, given.parent, state, time.monotonic_ns()):
            os.kill(given.parent, signal.SIGKILL)  # our parent: its number is nobody else's while we live
        time.sleep(CYCLE_S)
    recorder.end()


if __name__ == "__main__":
    main()
