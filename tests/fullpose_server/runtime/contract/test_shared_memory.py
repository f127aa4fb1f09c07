"""The shared memory: snapshot, events, lateness figures, and files that are something else."""

import threading
from pathlib import Path

import pytest

from fullpose_server.runtime.contract.shared_memory import (
    BUCKETS,
    EVENT_BYTES,
    EVENTS,
    SIZE,
    SNAPSHOT_BYTES,
    Shared,
    SharedError,
)


def test_a_snapshot_is_read_whole_beside_its_writer(tmp_path: Path) -> None:
    writer = Shared(tmp_path / "memory", create=True)
    reader = Shared(tmp_path / "memory")
    assert reader.snapshot() is None
    enough = threading.Event()
    written = []

    def write() -> None:
        n = 0
        while not enough.is_set():
            n += 1
            writer.publish(bytes([n % 251]) * (1000 + n % 3000), n)
        written.append(bytes([n % 251]) * (1000 + n % 3000))

    thread = threading.Thread(target=write)
    thread.start()
    seen: set[bytes] = set()
    try:
        while len(seen) < 100:
            data = reader.snapshot()
            if data is not None:
                assert len(set(data)) == 1
                seen.add(data)
    finally:
        enough.set()
        thread.join()
    assert [reader.snapshot()] == written


def test_what_does_not_fit_is_refused_or_marked(tmp_path: Path) -> None:
    shared = Shared(tmp_path / "memory", create=True)
    with pytest.raises(SharedError, match="at most"):
        shared.publish(b"x" * (SNAPSHOT_BYTES + 1), 1)
    shared.add_event({"kind": "big", "time_ns": 5, "wall_ns": 6, "text": "x" * EVENT_BYTES})
    (event,), head = shared.events_since(0)
    assert (event["kind"], event["time_ns"], head) == ("big", 5, 1)
    assert event["too_long_bytes"] > EVENT_BYTES


def test_events_come_once_and_in_order_and_the_oldest_give_way(tmp_path: Path) -> None:
    shared = Shared(tmp_path / "memory", create=True)
    for n in range(EVENTS + 50):
        shared.add_event({"kind": "n", "n": n})
    events, at = shared.events_since(0)
    assert [e["n"] for e in events] == list(range(EVENTS + 50 - len(events), EVENTS + 50))
    assert len(events) >= EVENTS - 1
    assert shared.events_since(at) == ([], at)


def test_lateness_is_never_flattered(tmp_path: Path) -> None:
    shared = Shared(tmp_path / "memory", create=True)
    assert shared.lateness_us()["p99"] == 0.0
    shared.histogram[10] = 990
    shared.histogram[300] = 9
    shared.histogram[BUCKETS - 1] = 1
    shared.header["max_lateness_ns"] = 7_000_000
    assert shared.lateness_us() == {"p50": 11.0, "p99": 11.0, "p999": 301.0, "max": 7000.0}


def test_another_file_is_not_believed(tmp_path: Path) -> None:
    (tmp_path / "short").write_bytes(b"x")
    with pytest.raises(SharedError, match="expected"):
        Shared(tmp_path / "short")
    (tmp_path / "zero").write_bytes(b"\0" * SIZE)
    with pytest.raises(SharedError, match="not the memory"):
        Shared(tmp_path / "zero")
