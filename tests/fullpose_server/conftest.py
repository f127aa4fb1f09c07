"""Stores in a folder of their own."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from fullpose_server.store.database import Database
from fullpose_server.store.plans import PlanStore
from fullpose_server.store.trajectories import TrajectoryStore
from tests.support.postgresql import Server, programs, running_postgresql
from tests.support.stores import Stores


@pytest.fixture(scope="session")
def postgresql() -> Iterator[Server]:
    """A PostgreSQL of the tests' own; one for each of their processes that asks for it."""
    if programs() is None:
        pytest.skip("PostgreSQL is not installed (Debian's package: postgresql)")
    with running_postgresql() as server:
        yield server


@pytest.fixture
def stores(tmp_path: Path) -> Iterator[Stores]:
    database = Database(tmp_path / "fullpose.db")
    yield Stores(
        database,
        TrajectoryStore(database, tmp_path / "trajectories"),
        PlanStore(database, tmp_path / "plans"),
        tmp_path,
    )
    database.close()
