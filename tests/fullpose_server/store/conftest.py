"""The store's tests run on both databases: `location` is a new one of each kind, already brought up."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from fullpose_server.location import Location
from fullpose_server.store.database import Database
from fullpose_server.store.plans import PlanStore
from fullpose_server.store.trajectories import TrajectoryStore
from tests.support.postgresql import Server
from tests.support.stores import Stores


@pytest.fixture(params=["sqlite", "postgresql"])
def location(request: pytest.FixtureRequest, tmp_path: Path) -> Location:
    if request.param == "sqlite":
        return tmp_path / "fullpose.db"
    server: Server = request.getfixturevalue("postgresql")
    return server.made()


@pytest.fixture
def database(location: Location) -> Iterator[Database]:
    made = Database(location)
    yield made
    made.close()


@pytest.fixture
def stores(database: Database, tmp_path: Path) -> Stores:
    flights, plans = tmp_path / "trajectories", tmp_path / "plans"
    return Stores(database, TrajectoryStore(database, flights), PlanStore(database, plans), tmp_path)
