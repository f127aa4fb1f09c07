"""The ring: order, loss, wrapping, and a reader beside a running writer."""

import threading

import numpy as np
import pytest

from fullpose_server.runtime.contract.telemetry import SAMPLE, Ring, dtype_description


def ring_of(capacity: int) -> Ring:
    return Ring(np.zeros(1, "<u8"), np.zeros(capacity, SAMPLE))


def filled(ring: Ring, count: int) -> Ring:
    row = np.zeros(1, SAMPLE)
    for _ in range(count):
        row["margin"] = ring.head + 1
        ring.append(row)
    return ring


def test_an_empty_ring_has_nothing() -> None:
    ring = ring_of(8)
    assert ring.latest() is None
    rows, lost = ring.since(0, 10)
    assert (len(rows), lost) == (0, 0)


def test_samples_come_in_order_and_once() -> None:
    ring = filled(ring_of(64), 10)
    rows, lost = ring.since(0, 4)
    assert (rows["seq"].tolist(), lost) == ([1, 2, 3, 4], 0)
    rows, lost = ring.since(4, 100)
    assert (rows["seq"].tolist(), lost) == ([5, 6, 7, 8, 9, 10], 0)
    assert ring.since(10, 100)[0].size == 0
    np.testing.assert_array_equal(rows["margin"], rows["seq"])


@pytest.mark.parametrize("count", range(1, 40))
def test_what_was_overwritten_is_counted(count: int) -> None:
    ring = filled(ring_of(8), count)
    rows, lost = ring.since(0, 100)
    assert len(rows) + lost == count
    assert rows["seq"].tolist() == list(range(count - len(rows) + 1, count + 1))
    assert len(rows) >= min(count, 7)


def test_a_ring_made_anew_starts_over() -> None:
    rows, lost = filled(ring_of(8), 3).since(1000, 10)
    assert (rows["seq"].tolist(), lost) == ([1, 2, 3], 0)


def test_latest_is_the_newest() -> None:
    latest = filled(ring_of(8), 21).latest()
    assert latest is not None
    assert latest["seq"][0] == 21


def test_a_reader_beside_a_writer_sees_whole_samples_in_order() -> None:
    ring = ring_of(64)
    done = threading.Event()

    def write() -> None:
        filled(ring, 30_000)
        done.set()

    writer = threading.Thread(target=write)
    writer.start()
    at, taken, missed = 0, 0, 0
    while not done.is_set() or at < ring.head:
        rows, lost = ring.since(at, 32)
        taken += len(rows)
        missed += lost
        if len(rows):
            assert (np.diff(rows["seq"].astype(int)) > 0).all()
            assert rows["seq"][0] > at
            np.testing.assert_array_equal(rows["margin"], rows["seq"])
            at = int(rows["seq"][-1])
        elif lost:
            at += lost
    writer.join()
    assert taken + missed == 30_000


def test_the_description_places_every_field() -> None:
    raw = filled(ring_of(8), 3).latest()
    assert raw is not None
    blob = raw.tobytes()
    fields = {f["name"]: f for f in dtype_description()}
    assert np.frombuffer(blob, fields["seq"]["type"], 1, fields["seq"]["offset"])[0] == 3
    assert np.frombuffer(blob, fields["margin"]["type"], 1, fields["margin"]["offset"])[0] == 3.0
    assert fields["demand"]["count"] == 4
    assert all(f["offset"] % 8 == 0 for f in fields.values() if f["type"].endswith("8"))
