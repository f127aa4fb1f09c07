"""Stored flights: one address a flight, whole or not at all."""

import threading
from pathlib import Path

import numpy as np
import pytest

from fullpose_server.errors import InUseError, NotFoundError
from fullpose_server.formats.trajectory import Convention
from fullpose_server.formats.trajectory_file import read_trajectory
from fullpose_server.store.trajectories import TrajectoryStore
from tests.support.stores import Stores

FLIGHT = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(f"{k / 100},{k / 10},{k / 20},0\n" for k in range(101))


def test_a_flight_comes_back_bit_by_bit(stores: Stores) -> None:
    sha256 = stores.add_flight(FLIGHT)
    time, q = stores.arrays(sha256)
    np.testing.assert_array_equal(time, np.arange(101) / 100)
    assert q.shape == (101, 4)
    row = stores.trajectories.get(sha256)
    assert (row.samples, row.duration_s, row.uniform) == (101, 1.0, True)
    assert row.rate_hz == pytest.approx(100.0)
    # 0.1 deg of yaw and 0.05 deg of pitch, at right angles while roll is zero, in 10 ms.
    assert row.peak_body_rate_deg_s == pytest.approx(np.hypot(10.0, 5.0), rel=1e-3)
    assert (stores.folder / "trajectories" / sha256 / "source.csv").read_text() == FLIGHT


def test_the_same_flight_is_stored_once(stores: Stores) -> None:
    assert stores.add_flight(FLIGHT, "one") == stores.add_flight(FLIGHT.replace("\n", "\r\n"), "two")
    assert [row.name for row in stores.trajectories.all()] == ["one"]


def test_a_flight_that_a_plan_needs_stays(stores: Stores) -> None:
    sha256 = stores.add_flight(FLIGHT)
    plan = stores.add_plan(sha256)
    with pytest.raises(InUseError):
        stores.trajectories.remove(sha256)
    stores.plans.finish(plan, "cancelled")
    stores.plans.remove(plan)
    stores.trajectories.remove(sha256)
    with pytest.raises(NotFoundError):
        stores.trajectories.get(sha256)
    assert not (stores.folder / "trajectories" / sha256).exists()


def test_what_a_crash_left_is_cleared_at_the_next_start(stores: Stores, tmp_path: Path) -> None:
    left = tmp_path / "trajectories" / ".new-1234"
    left.mkdir()
    (left / "time.npy").write_bytes(b"half")
    TrajectoryStore(stores.database, tmp_path / "trajectories")
    assert not left.exists()


def test_one_flight_added_by_many_at_once_is_new_once(stores: Stores) -> None:
    for turn in range(5):
        text = FLIGHT.replace(",0\n", f",{turn}\n")
        together = threading.Barrier(6)
        news: list[bool] = []

        def add(number: int, text: str = text, together: threading.Barrier = together, news: list[bool] = news) -> None:
            path = stores.folder / f"upload-{number}"
            path.write_text(text, encoding="utf-8")
            flight = read_trajectory(path, Convention.NUE)
            together.wait()
            news.append(stores.keep(flight, path)[1])

        threads = [threading.Thread(target=add, args=(number,)) for number in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert sorted(news) == [False] * 5 + [True]
    names = sorted(path.name for path in (stores.folder / "trajectories").iterdir())
    assert names == sorted(row.sha256 for row in stores.trajectories.all())


def test_a_folder_without_its_row_is_what_a_crash_left_and_is_replaced(stores: Stores) -> None:
    sha256 = stores.add_flight(FLIGHT)
    stores.trajectories.remove(sha256)
    left = stores.folder / "trajectories" / sha256
    left.mkdir()
    (left / "time.npy").write_bytes(b"half")
    assert stores.add_flight(FLIGHT) == sha256
    assert stores.arrays(sha256)[0].size == 101
    assert (left / "source.csv").read_text() == FLIGHT
