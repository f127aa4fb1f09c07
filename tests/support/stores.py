"""Stores in a folder of their own."""

import shutil
from dataclasses import dataclass
from pathlib import Path

from fullpose._typing import Array
from fullpose.rig import builtin_rigs
from fullpose_server.formats.flight_folder import read_arrays, write_flight
from fullpose_server.formats.plan_folder import rig_hash
from fullpose_server.formats.trajectory import Convention, Trajectory
from fullpose_server.formats.trajectory_file import read_trajectory
from fullpose_server.planning.plan_request import PlanRequest
from fullpose_server.store.database import Database
from fullpose_server.store.plans import PlanAsked, PlanStore
from fullpose_server.store.tables import TrajectoryRow
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
        return self.keep(read_trajectory(path, Convention.NUE), path, name)[0].sha256

    def keep(self, flight: Trajectory, source: Path, name: str = "flight") -> tuple[TrajectoryRow, bool]:
        """Store a flight as the server does: its arrays written first, then taken in."""
        draft = self.trajectories.draft()
        try:
            return self.trajectories.adopt(draft, write_flight(draft, flight), name, source, "0" * 64, "csv")
        finally:
            shutil.rmtree(draft, ignore_errors=True)

    def arrays(self, sha256: str) -> tuple[Array, Array]:
        return read_arrays(self.trajectories.folder(sha256), self.trajectories.get(sha256).samples)

    def add_plan(
        self, trajectory: str, method: str = "exact", rate_hz: float = 200.0, tolerance_deg: float | None = None
    ) -> str:
        row = self.plans.add(
            PlanAsked(
                trajectory=trajectory,
                rig=RIG.name,
                rig_hash=rig_hash(RIG),
                method=method,
                options={},
                start_deg=None,
                rate_hz=rate_hz,
                tolerance_deg=tolerance_deg,
            )
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
            tolerance_deg=row.tolerance_deg,
        )
