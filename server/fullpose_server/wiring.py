"""The composition root: from a server's settings to its services, which live as long as it does."""

import asyncio
import fcntl
import logging
import os
import shutil
import time
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from fullpose_server.api.deps import Services
from fullpose_server.api.lapsing import lapse_leases
from fullpose_server.api.offload.curves import CurvesMaker
from fullpose_server.api.offload.evidence import EvidenceMaker
from fullpose_server.api.offload.pool import Offload
from fullpose_server.api.people import People
from fullpose_server.api.provider import Provider
from fullpose_server.errors import DamagedError, ServerError
from fullpose_server.formats.plan_folder import rig_hash
from fullpose_server.formats.rig_file import RigStore
from fullpose_server.formats.saved_profiles import SavedProfiles
from fullpose_server.location import DATABASE, PostgresqlUrl
from fullpose_server.operating import GuardConfig, OperatingConfig, Tolerance
from fullpose_server.planning.comparisons import Comparisons
from fullpose_server.planning.plan_queue import PlanQueue
from fullpose_server.planning.plan_request import PlanRequest
from fullpose_server.planning.scrub import scrub, scrub_rigs
from fullpose_server.planning.upkeep import Upkeep
from fullpose_server.runtime.contract.config import LiveConfig, RigConfig
from fullpose_server.runtime.recording.retention import Retention, sweep
from fullpose_server.runtime.recording.run_index import RunFiles
from fullpose_server.runtime.supervisor.alarm_watch import AlarmWatch
from fullpose_server.runtime.supervisor.registry import RigHosts
from fullpose_server.runtime.supervisor.spare import Spare
from fullpose_server.scene.on_demand import ScenesOnDemand
from fullpose_server.scene.scenes import SceneServer
from fullpose_server.session.alarms import Shelf
from fullpose_server.settings import Settings
from fullpose_server.store.alarm_trail import AlarmTrail
from fullpose_server.store.alarms import AlarmHistory
from fullpose_server.store.audit import AuditLog
from fullpose_server.store.audit_trail import AuditTrail
from fullpose_server.store.belonging import bind
from fullpose_server.store.database import Database
from fullpose_server.store.disk import Disk
from fullpose_server.store.people import PeopleStore
from fullpose_server.store.people_known import had_people
from fullpose_server.store.plans import PlanStore
from fullpose_server.store.quarantine import Quarantine
from fullpose_server.store.trajectories import TrajectoryStore

log = logging.getLogger(__name__)


class DataDirInUseError(ServerError):
    """Another server works on this data folder."""

    def __init__(self, folder: Path) -> None:
        super().__init__(
            f"data folder {folder} is in use by another Fullpose server: stop it, or give another --data-dir"
        )


@dataclass(frozen=True)
class Served:
    """What a server is made of: the services of its routes, and the scenes that are started when looked at."""

    services: Services
    scenes: ScenesOnDemand


@asynccontextmanager
async def serving(settings: Settings, scenes: SceneServer) -> AsyncIterator[Served]:
    """The services, started, and ended in the opposite order. Raises `DataDirInUseError`."""
    async with AsyncExitStack() as stack:
        folder = settings.data_dir.resolve()
        stack.callback(os.close, await asyncio.to_thread(_lock, folder))
        quarantine = Quarantine(folder / "quarantine")
        database = await asyncio.to_thread(_opened, settings, folder, quarantine)
        stack.callback(database.close)
        served = await asyncio.to_thread(_build, settings, folder, database, scenes, quarantine)
        services = served.services
        stack.push_async_callback(asyncio.to_thread, services.trail.close)
        stack.push_async_callback(asyncio.to_thread, services.alarm_trail.close)
        stack.push_async_callback(services.alarm_watch.close)
        stack.callback(scenes.close)
        services.offload.start()
        stack.push_async_callback(services.offload.close)
        stack.push_async_callback(services.curves.close)
        await services.queue.start()
        stack.push_async_callback(services.queue.close)
        services.comparisons.start()
        stack.push_async_callback(services.comparisons.close)
        stack.push_async_callback(services.hosts.close, stop_rigs=settings.stop_rigs_on_exit)
        await services.hosts.adopt()
        stack.push_async_callback(services.upkeep.close)
        stack.callback(services.runs.close)
        services.upkeep.start()
        stack.push_async_callback(services.people.close)
        services.people.after(partial(lapse_leases, services))
        services.people.start()
        yield served


def _opened(settings: Settings, folder: Path, quarantine: Quarantine) -> Database:
    """The database; a file that is damaged is moved aside, and a new one made in its place: a rig must be operable."""
    if isinstance(settings.database, PostgresqlUrl):
        database = Database(settings.database)
        try:
            bind(database, settings.database, folder)
        except BaseException:
            database.close()
            raise
        return database
    path = folder / DATABASE
    try:
        return Database(path)
    except DamagedError as error:
        files = [path, *(path.with_name(f"{path.name}{end}") for end in ("-wal", "-shm"))]
        why = f"{error}; to restore: stop, put a backup in the place of {path.name}"
        quarantine.take("database", path.stem, files, why)
        return Database(path)


def _had_people(quarantine: Quarantine) -> bool:
    """Whether a database that was moved aside, now or at an earlier start, had people: they are not nobody since."""
    had = any(had_people(file) for file in quarantine.folder.glob(f"*-database-*/{DATABASE}"))
    if had:
        log.warning("a damaged database had users: where no others are known, nobody is let in but to stop a rig")
    return had


def _build(settings: Settings, folder: Path, database: Database, scenes: SceneServer, quarantine: Quarantine) -> Served:
    scrub_rigs(folder / "rigs", quarantine)
    rigs = RigStore(folder / "rigs", _operating(settings))
    trajectories = TrajectoryStore(database, folder / "trajectories")
    plans = PlanStore(database, folder / "plans")
    run_folder = folder / "runs"
    run_folder.mkdir(exist_ok=True)
    alarms = AlarmHistory(database)
    process_of = _RigProcess(settings, rigs, run_folder, alarms)
    hosts = RigHosts(rigs, process_of.config, process_of.directory, Spare() if settings.spare_rig_process else None)

    def latest(rig: str) -> Any:
        host = hosts.get(rig)
        rows = None if host is None else host.latest()
        return None if rows is None else rows[0]

    audit = AuditLog(database)
    alarm_trail = AlarmTrail(alarms)
    runs, comparisons = RunFiles(run_folder), Comparisons(folder / "comparisons", quarantine)
    on_demand = ScenesOnDemand(scenes, rigs, latest)
    services = Services(
        settings=settings,
        database=database,
        rigs=rigs,
        profiles=SavedProfiles(folder / "profiles"),
        trajectories=trajectories,
        plans=plans,
        queue=PlanQueue(plans, _PlanRequests(rigs, trajectories, plans).request),
        comparisons=comparisons,
        audit=audit,
        trail=AuditTrail(audit),
        alarms=alarms,
        alarm_trail=alarm_trail,
        alarm_watch=AlarmWatch(hosts, alarm_trail),
        hosts=hosts,
        runs=runs,
        scenes=on_demand,
        offload=Offload(settings),
        evidence=EvidenceMaker(folder, settings.database),
        curves=CurvesMaker(folder / "curves", run_folder, folder / "plans"),
        disk=Disk(folder, settings.disk_alarm_bytes, settings.disk_reserve_bytes),
        quarantine=quarantine,
        upkeep=Upkeep(
            partial(scrub, plans, trajectories, comparisons, runs, quarantine),
            partial(_retain, settings, runs, alarms),
        ),
        people=People(PeopleStore(database), asked=settings.oidc_issuer is not None, lost=_had_people(quarantine)),
        provider=Provider.of(settings),
        uploads=_emptied(folder / "uploads"),
    )
    return Served(services, on_demand)


def _retain(settings: Settings, runs: RunFiles, alarms: AlarmHistory) -> None:
    """Let go of what is not to be kept any longer, and look at what has been recorded."""
    rule = Retention(settings.keep_runs_days, settings.keep_runs_bytes)
    if rule.on:
        sweep(runs, rule)
    alarms.sweep(settings.keep_alarms_days, settings.keep_alarms, time.time())
    runs.read_ahead()


def _emptied(folder: Path) -> Path:
    """A folder for what is being received, without what an earlier server was receiving when it ended."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(exist_ok=True)
    return folder


def _operating(settings: Settings) -> OperatingConfig:
    """How a rig is operated whose file does not say."""
    bridged_ms = settings.live_extrapolate_ms
    # It warns before the source is let go, and trips where it is not.
    return OperatingConfig(guard=GuardConfig(stale_ms=Tolerance(0.4 * bridged_ms, 2.0 * bridged_ms)))


@dataclass(frozen=True)
class _RigProcess:
    """What the process of a rig is told, by the rig's name."""

    settings: Settings
    rigs: RigStore
    runs: Path
    alarms: AlarmHistory

    def directory(self, rig: str) -> Path:
        """Where the process has its own files."""
        return self.rigs.folder / rig

    def config(self, rig: str) -> RigConfig:
        """How it runs."""
        entry, settings = self.rigs.get(rig), self.settings
        return RigConfig(
            rig,
            entry.rig,
            self.directory(rig),
            self.runs,
            rate_hz=settings.rig_rate_hz,
            live=LiveConfig(
                udp_port=settings.live_udp_ports.get(rig),
                delay_ms=settings.live_delay_ms,
                extrapolate_ms=settings.live_extrapolate_ms,
                max_rate_deg_s=settings.live_max_rate_deg_s,
            ),
            shelves=self._shelves(rig),
            **vars(entry.operating),
        )

    def _shelves(self, rig: str) -> tuple[Shelf, ...]:
        """Those that were put up in an earlier process; none where they cannot be read: a rig must be operable."""
        try:
            return self.alarms.shelves(rig, time.time())
        except ServerError as error:
            log.warning("rig %s starts without the shelves of before: %s", rig, error)
            return ()


@dataclass(frozen=True)
class _PlanRequests:
    """What the planning process is told, by the plan's id."""

    rigs: RigStore
    trajectories: TrajectoryStore
    plans: PlanStore

    def request(self, plan: str) -> PlanRequest:
        """Raises `ServerError` where the rig is not the one any more that the plan was asked for."""
        row = self.plans.get(plan)
        rig = self.rigs.get(row.rig).rig
        if rig_hash(rig) != row.rig_hash:
            raise ServerError(f"rig {row.rig} has been changed since this plan was asked for: ask again")
        start = None if row.start_deg is None else np.deg2rad(row.start_deg)
        return PlanRequest(
            plan_id=plan,
            folder=self.plans.folder(plan),
            trajectory=self.trajectories.folder(row.trajectory),
            trajectory_sha256=row.trajectory,
            name=self.trajectories.get(row.trajectory).name,
            rig=rig,
            rate_hz=row.rate_hz,
            method=row.method,
            options=row.options,
            start=None if start is None else (float(start[0]), float(start[1]), float(start[2]), float(start[3])),
            tolerance_deg=row.tolerance_deg,
            remedy=row.remedy,
        )


def _lock(folder: Path) -> int:
    """Lock the data folder for the life of the returned file descriptor."""
    folder.mkdir(parents=True, exist_ok=True)
    descriptor = os.open(folder / "server.lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        raise DataDirInUseError(folder) from None
    return descriptor
