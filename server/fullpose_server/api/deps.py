"""What the routes work with: one object, built by the app's lifespan, reached through `Annotated` dependencies."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Protocol

from fastapi import Depends, Header
from numpy.typing import ArrayLike
from starlette.requests import HTTPConnection

from fullpose_server.api.front import FrontStatus
from fullpose_server.api.hashing import Hashing
from fullpose_server.api.offload.curves import CurvesMaker
from fullpose_server.api.offload.evidence import EvidenceMaker
from fullpose_server.api.offload.pool import Offload
from fullpose_server.api.people import People
from fullpose_server.api.planes import Planes
from fullpose_server.api.problems import ApiError
from fullpose_server.api.provider import Provider
from fullpose_server.api.stopping import is_name, who_stops
from fullpose_server.api.streams.frame_source import FrameSource
from fullpose_server.formats.rig_file import RigStore
from fullpose_server.formats.saved_profiles import SavedProfiles
from fullpose_server.people.admitted import Credential
from fullpose_server.people.attempts import Attempts
from fullpose_server.planning.comparisons import Comparisons
from fullpose_server.planning.plan_queue import PlanQueue
from fullpose_server.planning.upkeep import Upkeep
from fullpose_server.runtime.recording.run_index import RunFiles
from fullpose_server.runtime.supervisor.alarm_watch import AlarmWatch
from fullpose_server.runtime.supervisor.registry import RigHosts
from fullpose_server.settings import Settings
from fullpose_server.store.alarm_trail import AlarmTrail
from fullpose_server.store.alarms import AlarmHistory
from fullpose_server.store.audit import AuditLog
from fullpose_server.store.audit_trail import AuditTrail
from fullpose_server.store.database import Database
from fullpose_server.store.disk import Disk
from fullpose_server.store.plans import PlanStore
from fullpose_server.store.quarantine import Quarantine
from fullpose_server.store.trajectories import TrajectoryStore


class Scenes(Protocol):
    """What the routes need of the scenes, which are another layer's (`scene.on_demand`); blocking."""

    def show_pose(self, rig: str, angles: ArrayLike | None, target: ArrayLike | None = None) -> None:
        """Show a planned pose (4,) [rad] with its attitude (4,) beside the rig; None takes it away."""

    def add(self, name: str, rig: str, latest: Callable[[], Any]) -> None:
        """Give the samples of `latest` a scene called `name`."""

    def remove(self, name: str) -> None:
        """Take an added scene away."""


@dataclass
class Services:
    """Stores, queue and rigs of one server."""

    settings: Settings
    database: Database
    rigs: RigStore
    profiles: SavedProfiles
    trajectories: TrajectoryStore
    plans: PlanStore
    queue: PlanQueue
    comparisons: Comparisons
    audit: AuditLog
    trail: AuditTrail
    alarms: AlarmHistory
    alarm_trail: AlarmTrail
    alarm_watch: AlarmWatch
    hosts: RigHosts
    runs: RunFiles
    scenes: Scenes
    offload: Offload
    evidence: EvidenceMaker
    curves: CurvesMaker
    disk: Disk
    quarantine: Quarantine
    upkeep: Upkeep
    people: People
    provider: Provider | None
    uploads: Path  # where what is being received goes
    attempts: Attempts = field(default_factory=Attempts)
    hashing: Hashing = field(default_factory=Hashing)
    planes: Planes = field(default_factory=Planes)
    front: FrontStatus = field(default_factory=FrontStatus)
    frames: dict[str, FrameSource] = field(default_factory=dict)
    live_sources: set[str] = field(default_factory=set)  # rigs that have one connected
    replays: set[str] = field(default_factory=set)  # scenes of the records that are played
    started: float = field(default_factory=time.time)


# Async, though they wait for nothing: FastAPI hands what is not to a thread, and an E-stop would wait for that.
async def _services(connection: HTTPConnection) -> Services:
    services: Services = connection.app.state.services
    return services


_CLIENT = Header(description="Who commands, while no users are configured: a name for the lease and the audit")


async def _person(connection: HTTPConnection) -> Credential | None:
    person: Credential | None = getattr(connection.state, "person", None)
    return person


PersonDep = Annotated[Credential | None, Depends(_person)]  # None: nobody known, and nobody need be


async def _who(
    connection: HTTPConnection, person: PersonDep, x_fullpose_client: Annotated[str | None, _CLIENT] = None
) -> str:
    if person is not None:
        return person.who
    if x_fullpose_client is not None and not is_name(x_fullpose_client):
        raise ApiError(422, "validation", "X-Fullpose-Client: expected up to 64 letters, digits or . @ : + - _")
    return who_stops(x_fullpose_client, address_of(connection))


async def _who_stops(
    connection: HTTPConnection, person: PersonDep, x_fullpose_client: Annotated[str | None, _CLIENT] = None
) -> str:
    return who_stops(x_fullpose_client, address_of(connection)) if person is None else person.who


def address_of(connection: HTTPConnection) -> str | None:
    """Where it comes from."""
    return None if connection.client is None else connection.client.host


async def _from_where(connection: HTTPConnection) -> str | None:
    return address_of(connection)


ServicesDep = Annotated[Services, Depends(_services)]
WhoDep = Annotated[str, Depends(_who)]
AddressDep = Annotated[str | None, Depends(_from_where)]  # of the client, for the audit
WhoStopsDep = Annotated[str, Depends(_who_stops)]  # for no stop is refused for a name
