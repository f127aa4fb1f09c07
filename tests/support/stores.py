"""Stores in a folder of their own."""

from dataclasses import dataclass
from pathlib import Path

from fullpose.rig import builtin_rigs
from fullpose_server.formats.plan_folder import rig_hash
from fullpose_server.formats.trajectory import Convention
from fullpose_server.formats.trajectory_file import read_trajectory
from fullpose_server.planning.plan_request import PlanRequest
from fullpose_server.store.database import Database
from fullpose_server.store.plans import PlanStore
from fullpose_server.store.trajectories import TrajectoryStore

RIG = builtin_rigs()["vertical-4"]


@dataclass
class Stores:
    database: Database
    trajectories: TrajectoryStore
    plans: PlanStore
    folder: Path

    def add_flight(self, text: str, name: str = "flight") -> str:
        path = self.folder / "upload"
        path.write_text(text, encoding="utf-8")
        flight = read_trajectory(path, Convention.NUE)
        row, _ = self.trajectories.add(flight, name, path, "0" * 64, "csv")
        return row.sha256

    def add_plan(self, trajectory: str, method: str = "exact", rate_hz: float = 200.0) -> str:
        row = self.plans.add(
            trajectory=trajectory,
            rig=RIG.name,
            rig_hash=rig_hash(RIG),
            method=method,
            options={},
            start_deg=None,
            rate_hz=rate_hz,
        )
        return row.id

    def request(self, plan: str) -> PlanRequest:
        row = self.plans.get(plan)
        return PlanRequest(
            plan_id=plan,
            folder=self.plans.folder(plan),
            trajectory=self.trajectories.folder(row.trajectory),
            trajectory_sha256=row.trajectory,
            name="flight",
            rig=RIG,
            rate_hz=row.rate_hz,
            method=row.method,
            options={},
            start=None,
        )
