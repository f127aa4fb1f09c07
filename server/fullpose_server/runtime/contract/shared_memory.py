"""The memory that a rig process shares: with its recorder, and with the server.

One mapped file a rig (under /dev/shm where there is one): a header of single numbers, the lateness histogram, the
session's snapshot as JSON, a ring of events as JSON, and the ring of samples. Everything has one writer; the E-stop and
stop requests are times that the server writes and the loop compares, so they need no queue and no lock. A number that
tells of something else is written after it, and read before it, as `memory_order` has it.
"""

import mmap
import os
import time
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from fullpose_server.runtime.contract.memory_order import acquire, release
from fullpose_server.runtime.contract.telemetry import SAMPLE, Ring, Samples

MAGIC = 0x46504C5053523033
SAMPLES = 32768
EVENTS = 1024
EVENT_BYTES = 2032
SNAPSHOT_BYTES = 262144 - 16
BUCKETS = 4096  # of lateness, one a microsecond; the last holds everything above

HEADER = np.dtype(
    [
        ("magic", "<u8"),
        ("head", "<u8"),
        ("event_head", "<u8"),
        ("revision", "<u8"),
        ("period_ns", "<i8"),
        # Written by the loop.
        ("rig_pid", "<i8"),
        ("rig_beat_ns", "<i8"),
        ("ticks", "<u8"),
        ("misses", "<u8"),
        ("max_lateness_ns", "<i8"),
        ("busy_ns", "<i8"),  # smoothed work of a tick
        ("drive_call", "<i8"),  # a `DriveCall`: the one that the loop is in
        ("drive_call_ns", "<i8"),  # since when
        ("read_ns", "<i8"),  # smoothed time in the drive's `read`, and the longest
        ("read_max_ns", "<i8"),
        ("write_ns", "<i8"),
        ("write_max_ns", "<i8"),
        ("estop_done_ns", "<i8"),  # the request that was handled last
        ("estop_wrote_ns", "<i8"),  # when its first braking command was written
        ("stop_done_ns", "<i8"),
        ("stop_wrote_ns", "<i8"),
        # Written by the server.
        ("server_pid", "<i8"),
        ("server_beat_ns", "<i8"),
        ("revision_offset", "<u8"),  # what the server adds to `revision`: it rises over restarts of the process
        ("estop_request_ns", "<i8"),
        ("stop_request_ns", "<i8"),
        ("estop_who", "S64"),
        ("stop_who", "S64"),
        # Written by the recorder.
        ("recorder_pid", "<i8"),
        ("recorder_beat_ns", "<i8"),
        ("recorder_seq", "<u8"),
        ("recorder_event", "<u8"),  # the last event that was taken: one started anew goes on from there
        ("recorder_lost", "<u8"),
        ("recorder_bytes", "<u8"),
        ("recorder_chunks", "<u8"),
        ("recorder_free_bytes", "<i8"),
        ("recorder_run", "S96"),
        ("recorder_error", "S192"),
    ]
)
EVENT = np.dtype([("seq", "<u8"), ("length", "<u8"), ("data", f"V{EVENT_BYTES}")])
TEXT = np.dtype([("version", "<u8"), ("length", "<u8"), ("data", f"V{SNAPSHOT_BYTES}")])
_PAGE = 4096
_HISTOGRAM_AT = _PAGE
_TEXT_AT = _HISTOGRAM_AT + BUCKETS * 8
_EVENTS_AT = _TEXT_AT + TEXT.itemsize
_SAMPLES_AT = _EVENTS_AT + EVENTS * EVENT.itemsize
SIZE = _SAMPLES_AT + SAMPLES * SAMPLE.itemsize


class SharedError(Exception):
    """The file is not the shared memory of a rig process of this version."""


class Shared:
    """A view of the mapped file. `header` fields are numpy views: read `int(h["x"][0])`, write `h["x"][0] = n`."""

    def __init__(self, path: Path, *, create: bool = False) -> None:
        self.path = path
        flags = os.O_RDWR | (os.O_CREAT | os.O_EXCL if create else 0) | os.O_CLOEXEC
        fd = os.open(path, flags, 0o600)
        try:
            if create:
                # Blocks are taken now: a full /dev/shm must fail here, not as SIGBUS in the loop.
                os.posix_fallocate(fd, 0, SIZE)
            elif os.fstat(fd).st_size != SIZE:
                raise SharedError(f"{path}: {os.fstat(fd).st_size} bytes: expected {SIZE}")
            self._map = mmap.mmap(fd, SIZE)
        finally:
            os.close(fd)
        self.header: NDArray[np.void] = np.frombuffer(self._map, HEADER, 1, 0)
        self.histogram: NDArray[np.uint64] = np.frombuffer(self._map, "<u8", BUCKETS, _HISTOGRAM_AT)
        self._text: NDArray[np.void] = np.frombuffer(self._map, TEXT, 1, _TEXT_AT)
        self._events: NDArray[np.void] = np.frombuffer(self._map, EVENT, EVENTS, _EVENTS_AT)
        slots: Samples = np.frombuffer(self._map, SAMPLE, SAMPLES, _SAMPLES_AT)
        if create:
            self.header["magic"] = MAGIC
        elif int(self.header["magic"][0]) != MAGIC:
            raise SharedError(f"{path}: not the memory of a rig process of this version")
        self.ring = Ring(self.header["head"], slots)

    # --- snapshot: one writer, seqlock ---

    def publish(self, snapshot: bytes, revision: int) -> None:
        """Loop only: replace the snapshot. Raises `SharedError` where it does not fit."""
        if len(snapshot) > SNAPSHOT_BYTES:
            raise SharedError(f"snapshot of {len(snapshot)} bytes: at most {SNAPSHOT_BYTES}")
        version = int(self._text["version"][0])
        self._text["version"] = version + 1
        release()
        start = _TEXT_AT + 16
        self._map[start : start + len(snapshot)] = snapshot
        self._text["length"] = len(snapshot)
        release()
        self._text["version"] = version + 2
        release()
        self.header["revision"] = revision

    def snapshot(self, *, wait: bool = True) -> bytes | None:
        """The newest snapshot; None before the first, or where the writer died inside `publish`.

        It is no older than what was read of the header before (a revision, an answer to a stop).
        It waits for a writer that was put aside in the middle of it, some milliseconds at most; or not at all.
        """
        for attempt in range(64 if wait else 16):
            if attempt >= 16:
                time.sleep(2e-4)
            acquire()
            before = int(self._text["version"][0])
            acquire()
            if before and before % 2 == 0:
                start = _TEXT_AT + 16
                data = bytes(self._map[start : start + int(self._text["length"][0])])
                acquire()
                if int(self._text["version"][0]) == before:
                    return data
        return None

    # --- events: one writer, a ring of JSON texts ---

    def add_event(self, event: dict[str, Any]) -> None:
        """Loop only: append an event. What does not fit a slot is replaced by its kind and a note of its size."""
        data = msgspec.json.encode(event)
        if len(data) > EVENT_BYTES:
            kept = {key: event[key] for key in ("kind", "time_ns", "wall_ns") if key in event}
            data = msgspec.json.encode(kept | {"too_long_bytes": len(data)})
        sequence = int(self.header["event_head"][0]) + 1
        index = sequence % EVENTS
        slot = _EVENTS_AT + index * EVENT.itemsize
        self._events["seq"][index] = 0
        release()
        self._events["length"][index] = len(data)
        self._map[slot + 16 : slot + 16 + len(data)] = data
        release()
        self._events["seq"][index] = sequence
        release()
        self.header["event_head"] = sequence

    def events_since(self, sequence: int) -> tuple[list[dict[str, Any]], int]:
        """The events after `sequence`, oldest first, and the sequence to ask from next time."""
        head = int(self.header["event_head"][0])
        acquire()
        if sequence > head:
            sequence = 0
        events = []
        for number in range(max(sequence + 1, head - EVENTS + 2), head + 1):
            index = number % EVENTS
            slot = _EVENTS_AT + index * EVENT.itemsize + 16
            data = bytes(self._map[slot : slot + int(self._events["length"][index])])
            acquire()
            if int(self._events["seq"][index]) == number:
                events.append(msgspec.json.decode(data))
        return events, head

    def lateness_us(self) -> dict[str, float]:
        """Percentiles of the loop's lateness so far [us], from the histogram; zeros before the first tick."""
        counts = self.histogram.astype(np.int64)
        total = int(counts.sum())
        largest = int(self.header["max_lateness_ns"][0]) / 1000.0
        if total == 0:
            return {"p50": 0.0, "p99": 0.0, "p999": 0.0, "max": 0.0}
        running = np.cumsum(counts)
        shares = {"p50": 0.5, "p99": 0.99, "p999": 0.999}
        # A bucket's upper edge, so that no figure is flattered.
        found = {name: float(np.searchsorted(running, share * total) + 1) for name, share in shares.items()}
        return {name: min(value, largest) for name, value in found.items()} | {"max": largest}


def shared_directory() -> Path | None:
    """Where memory files live; None where the system has no /dev/shm (the data folder serves then)."""
    directory = Path("/dev/shm")
    return directory if os.access(directory, os.W_OK) else None
