"""The telemetry sample, and the ring of samples in shared memory.

One writer (the rig's loop), any number of readers, no locks: each slot carries the sequence of the sample in it,
written after the sample, and readers check it again after they have copied, in an order that `memory_order` keeps. A
slow reader costs the loop nothing; it is told how many samples it missed.

A row says what was commanded in this tick and is due at the next one; `measured` is what the drive reported at the
start of this tick, so `tracking_error_deg` and `following_error_deg` compare it with what the tick before commanded.
"""

from enum import IntFlag
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fullpose.rig import FRAMES
from fullpose_server.runtime.contract.memory_order import acquire, release

QUATERNION = ("qw", "qx", "qy", "qz")


class TelemetryField(NamedTuple):
    """One field of a sample."""

    name: str
    type: str = "<f8"  # NumPy's, little-endian; a float is nan where there is no value
    parts: tuple[str, ...] = ()  # the names of its numbers, where it has more than one
    unit: str = ""  # as names of columns have it; empty where the field's own name has it, or there is none

    @property
    def integer(self) -> bool:
        """Whether its numbers are whole."""
        return np.dtype(self.type).kind in "iu"

    @property
    def part_names(self) -> list[str]:
        """A name for each of its numbers: `measured_rate_outer_deg_s`, `target_qw`."""
        stem = self.name.removesuffix(f"_{self.unit}")
        return ["_".join(filter(None, (stem, part, self.unit))) for part in self.parts]

    @property
    def column(self) -> str:
        """The name of its column in a message of many samples, whose own `seq` is the newest one's."""
        return "sample_seq" if self.name == "seq" else self.name


# The one list of them: the record in memory and on the wire and in files, its schemas and its tables come from it.
FIELDS = (
    TelemetryField("seq", "<u8"),
    TelemetryField("time_ns", "<i8"),  # monotonic
    TelemetryField("wall_ns", "<i8"),  # since the Unix epoch
    TelemetryField("state", "u1"),  # `State.code`
    TelemetryField("flags", "u1"),  # bits of `Flag`
    TelemetryField("revision", "<u4"),  # the session's
    TelemetryField("path_time_s"),  # the flight's own time
    TelemetryField("path_scale"),  # 1 at full speed, 0 held
    TelemetryField("demand", parts=FRAMES, unit="deg"),
    TelemetryField("demand_rate", parts=FRAMES, unit="deg_s"),
    TelemetryField("demand_acceleration", parts=FRAMES, unit="deg_s2"),
    TelemetryField("measured", parts=FRAMES, unit="deg"),
    TelemetryField("measured_rate", parts=FRAMES, unit="deg_s"),
    TelemetryField("target", parts=QUATERNION),  # the attitude that is followed
    TelemetryField("solve_error_deg"),  # of the demand against the target
    TelemetryField("tracking_error_deg"),  # of what was measured against the target
    TelemetryField("following_error_deg", parts=FRAMES, unit="deg"),
    TelemetryField("margin"),  # the smallest relative distance of any frame to any of its limits, 0..1
    TelemetryField("lateness_us"),  # of the tick
    TelemetryField("tick", "<u8"),
    TelemetryField("read_us"),  # of the tick, in the drive's `read`
    TelemetryField("write_us"),  # in its `write`; nan where nothing was written
)
SAMPLE = np.dtype([(f.name, f.type, len(f.parts)) if f.parts else (f.name, f.type) for f in FIELDS], align=True)


class Flag(IntFlag):
    """Bits of `flags`."""

    LATE = 1  # the deadline of this tick was missed
    LIMITED = 2  # the path's sample could not hold the attitude inside the limits
    LEAD = 4  # in the lead-in or lead-out: no flight attitude to follow
    ENABLED = 8  # the drive is enabled and follows what is commanded
    BRAKING = 16  # the rig brakes, by command or by itself
    STALE = 32  # the live source is late; the target is extrapolated


Samples = NDArray[np.void]


class Ring:
    """A ring of samples: `head` (1,) u8 counts the samples ever written, `slots` (capacity,) holds the newest.

    Sequences start at 1, so an untouched slot (0) is never taken for a sample.
    """

    def __init__(self, head: NDArray[np.uint64], slots: Samples) -> None:
        self._head = head
        self._slots = slots
        self._seq = slots["seq"]
        self.capacity = len(slots)

    @property
    def head(self) -> int:
        """Sequence of the newest sample; 0 before the first. What is read next is no older."""
        head = int(self._head[0])
        acquire()
        return head

    def append(self, row: Samples) -> int:
        """Writer only: add `row` (1,), whose seq this sets; returns the sequence."""
        sequence = int(self._head[0]) + 1
        index = sequence % self.capacity
        # Readers that copy meanwhile see a sequence that fits no slot and drop the copy.
        self._seq[index] = 0
        release()
        row["seq"] = 0
        self._slots[index] = row[0]
        release()
        self._seq[index] = sequence
        release()
        self._head[0] = sequence
        return sequence

    def since(self, sequence: int, limit: int) -> tuple[Samples, int]:
        """The samples after `sequence`, oldest first, at most `limit` of them, and how many are lost for good.

        A `sequence` above the head (a ring that was made anew) starts over from the oldest sample.
        """
        head = self.head
        if sequence > head:
            sequence = 0
        first = max(sequence + 1, head - self.capacity + 2)
        count = min(head - first + 1, limit)
        if count <= 0:
            return np.empty(0, SAMPLE), max(0, first - 1 - sequence)
        wanted = np.arange(first, first + count, dtype=np.uint64)
        rows = self._copy(first, count)
        acquire()
        complete = rows["seq"] == wanted
        # What the writer overtook while we copied: the head tells how far it came, the sequence whether a row is torn.
        complete &= wanted > max(0, self.head - self.capacity + 1)
        kept = rows[complete]
        return kept, int(first - 1 - sequence + count - len(kept))

    def latest(self) -> Samples | None:
        """The newest sample (1,), or None before the first."""
        for _ in range(8):
            rows, _lost = self.since(max(0, self.head - 1), 1)
            if len(rows):
                return rows
            if self.head == 0:
                return None
        return None

    def _copy(self, first: int, count: int) -> Samples:
        start = first % self.capacity
        end = start + count
        if end <= self.capacity:
            return self._slots[start:end].copy()
        return np.concatenate([self._slots[start:], self._slots[: end - self.capacity]])


def dtype_description() -> list[dict[str, Any]]:
    """`SAMPLE` for clients in other languages: name, type, count and byte offset of each field."""
    offsets = {name: offset for name, (_, offset, *_) in (SAMPLE.fields or {}).items()}
    return [
        {
            "name": field.name,
            "type": np.dtype(field.type).str,
            "count": len(field.parts) or 1,
            "offset": offsets[field.name],
        }
        for field in FIELDS
    ]
