"""What the routes work with: one object, built by the app's lifespan, reached through `Annotated` dependencies."""

import re
import threading
import time
from dataclasses import dataclass, field
from typing import Annotated

from fastapi import Depends, Header
from starlette.requests import HTTPConnection

from server.api.hosts import RigHosts
from server.api.problems import ApiError
from server.api.run_files import RunFiles
from server.settings import Settings
from server.store.audit import AuditLog
from server.store.comparisons import Comparisons
from server.store.database import Database
from server.store.plan_queue import PlanQueue
from server.store.plans import PlanStore
from server.store.rig_file import RigStore
from server.store.trajectories import TrajectoryStore


@dataclass
class Services:
    """Stores, queue and rigs of one server."""

    settings: Settings
    database: Database
    rigs: RigStore
    trajectories: TrajectoryStore
    plans: PlanStore
    queue: PlanQueue
    comparisons: Comparisons
    audit: AuditLog
    hosts: RigHosts
    runs: RunFiles
    started: float = field(default_factory=time.time)
    scene_lock: threading.Lock = field(default_factory=threading.Lock)


def _services(connection: HTTPConnection) -> Services:
    services = connection.app.state.services
    assert isinstance(services, Services)
    return services


_WHO = re.compile(r"[\w.@:+-]{1,64}")


def _who(
    connection: HTTPConnection,
    x_fullpose_client: Annotated[
        str | None,
        Header(description="Who commands, while no users are configured: a name for the lease and the audit"),
    ] = None,
) -> str:
    if x_fullpose_client is not None:
        if not _WHO.fullmatch(x_fullpose_client):
            raise ApiError(422, "validation", "X-Fullpose-Client: expected up to 64 letters, digits or . @ : + - _")
        return x_fullpose_client
    return "anonymous" if connection.client is None else f"anonymous@{connection.client.host}"


ServicesDep = Annotated[Services, Depends(_services)]
WhoDep = Annotated[str, Depends(_who)]
