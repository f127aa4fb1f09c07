"""The telemetry sample, and the ring of samples in shared memory.

One writer (the rig's loop), any number of readers, no locks: each slot carries the sequence of the sample in it,
written after the sample, and readers check it again after they have copied. A slow reader costs the loop nothing; it is
told how many samples it missed.

A row says what was commanded in this tick and is due at the next one; `measured` is what the drive reported at the
start of this tick, so `tracking_error_deg` and `following_error_deg` compare it with what the tick before commanded.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

SAMPLE = np.dtype(
    {
        "names": [
            "seq",
            "time_ns",
            "wall_ns",
            "state",
            "flags",
            "revision",
            "path_time_s",
            "path_scale",
            "demand",
            "demand_rate",
            "demand_acceleration",
            "measured",
            "measured_rate",
            "target",
            "solve_error_deg",
            "tracking_error_deg",
            "following_error_deg",
            "margin",
            "lateness_us",
            "tick",
        ],
        "formats": [
            "<u8",
            "<i8",
            "<i8",
            "u1",
            "u1",
            "<u4",
            "<f8",
            "<f8",
            ("<f8", 4),
            ("<f8", 4),
            ("<f8", 4),
            ("<f8", 4),
            ("<f8", 4),
            ("<f8", 4),
            "<f8",
            "<f8",
            ("<f8", 4),
            "<f8",
            "<f8",
            "<u8",
        ],
        "offsets": [0, 8, 16, 24, 25, 28, 32, 40, 48, 80, 112, 144, 176, 208, 240, 248, 256, 288, 296, 304],
        "itemsize": 312,
    }
)

# Bits of `flags`.
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
        """Sequence of the newest sample; 0 before the first."""
        return int(self._head[0])

    def append(self, row: Samples) -> int:
        """Writer only: add `row` (1,), whose seq this sets; returns the sequence."""
        sequence = int(self._head[0]) + 1
        index = sequence % self.capacity
        # Readers that copy meanwhile see a sequence that fits no slot and drop the copy.
        self._seq[index] = 0
        row["seq"] = 0
        self._slots[index] = row[0]
        self._seq[index] = sequence
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
        whole = rows["seq"] == wanted
        # What the writer overtook while we copied: the head tells how far it came, the sequence whether a row is torn.
        whole &= wanted > max(0, self.head - self.capacity + 1)
        kept = rows[whole]
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
    described = []
    assert SAMPLE.fields is not None
    for name in SAMPLE.names or ():
        field, offset = SAMPLE.fields[name][:2]
        base, shape = field.subdtype or (field, ())
        described.append({"name": name, "type": base.str, "count": int(np.prod(shape)), "offset": offset})
    return described
