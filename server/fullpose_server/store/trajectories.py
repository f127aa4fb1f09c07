"""Stored flights: rows in the database, arrays and the source file in trajectories/<sha256>/."""

import shutil
import threading
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
from sqlalchemy import func, select

from fullpose._typing import Array
from fullpose_server.errors import InUseError, NotFoundError
from fullpose_server.formats.trajectory import Convention, Trajectory
from fullpose_server.store.database import Database
from fullpose_server.store.tables import PlanRow, TrajectoryRow


class TrajectoryStore:
    """Adds, lists and removes flights. Either all of a flight is stored or nothing of it."""

    def __init__(self, database: Database, root: Path) -> None:
        self._database = database
        self._root = root
        self._changing = threading.Lock()  # row and folder of a flight come and go together
        root.mkdir(parents=True, exist_ok=True)
        for left in root.glob(".new-*"):  # an add that a crash cut off
            shutil.rmtree(left)

    def add(
        self, trajectory: Trajectory, name: str, source: Path, source_sha256: str, source_format: str
    ) -> tuple[TrajectoryRow, bool]:
        """Store a flight and its source file, which is moved away. Returns its row and whether it is new."""
        draft = self._root / f".new-{uuid4().hex}"
        source_bytes = source.stat().st_size
        facts = _facts(trajectory)
        draft.mkdir()
        try:
            np.save(draft / "time.npy", trajectory.time)
            np.save(draft / "q.npy", trajectory.q)
            with self._changing, self._database.begin() as session:
                row = session.get(TrajectoryRow, trajectory.sha256)
                if row is not None:
                    return row, False
                row = TrajectoryRow(
                    sha256=trajectory.sha256,
                    source_sha256=source_sha256,
                    name=name,
                    convention=trajectory.convention.value,
                    source_format=source_format,
                    source_bytes=source_bytes,
                    warnings=[asdict(caution) for caution in trajectory.warnings],
                    created=time.time(),
                    **facts,
                )
                session.add(row)
                shutil.move(source, draft / f"source.{source_format}")
                target = self.folder(trajectory.sha256)
                shutil.rmtree(target, ignore_errors=True)  # without a row it is what a crash left
                draft.rename(target)
            return row, True
        finally:
            shutil.rmtree(draft, ignore_errors=True)

    def get(self, sha256: str) -> TrajectoryRow:
        """The row. Raises `NotFoundError`."""
        with self._database.begin() as session:
            row = session.get(TrajectoryRow, sha256)
        if row is None:
            raise NotFoundError("trajectory", sha256)
        return row

    def all(self) -> list[TrajectoryRow]:
        """All rows, newest first."""
        with self._database.begin() as session:
            return list(session.scalars(select(TrajectoryRow).order_by(TrajectoryRow.created.desc())))

    def arrays(self, sha256: str) -> tuple[Array, Array]:
        """time (n,) [s] and q (n, 4), mapped from disk. Raises `NotFoundError`."""
        self.get(sha256)
        return read_arrays(self._root / sha256)

    def folder(self, sha256: str) -> Path:
        """Where the arrays are."""
        return self._root / sha256

    def remove(self, sha256: str) -> None:
        """Remove a flight. Raises `NotFoundError`, or `InUseError` where a plan is made from it."""
        with self._changing:
            with self._database.begin() as session:
                row = session.get(TrajectoryRow, sha256)
                if row is None:
                    raise NotFoundError("trajectory", sha256)
                plans = session.scalar(select(func.count()).where(PlanRow.trajectory == sha256)) or 0
                if plans:
                    raise InUseError("trajectory", sha256, f"{plans} plan(s)")
                session.delete(row)
            shutil.rmtree(self.folder(sha256))


def read_arrays(folder: Path) -> tuple[Array, Array]:
    """time (n,) [s] and q (n, 4) of a stored flight, mapped from disk."""
    return np.load(folder / "time.npy", mmap_mode="r"), np.load(folder / "q.npy", mmap_mode="r")


def stored(row: TrajectoryRow, folder: Path) -> Trajectory:
    """The flight of a row and its folder."""
    time_s, q = read_arrays(folder)
    return Trajectory(np.array(time_s), np.array(q), Convention(row.convention))


def _facts(trajectory: Trajectory) -> dict[str, Any]:
    step = np.diff(trajectory.time)
    peak = None
    if step.size:
        turn = np.clip(np.abs(np.sum(trajectory.q[1:] * trajectory.q[:-1], axis=-1)), 0.0, 1.0)
        sine = np.sqrt(np.maximum(0.0, 1.0 - turn * turn))
        peak = float(np.rad2deg(np.max(2.0 * np.arctan2(sine, turn) / step)))
    return {
        "samples": int(trajectory.time.size),
        "start_s": float(trajectory.time[0]),
        "duration_s": float(trajectory.time[-1] - trajectory.time[0]),
        "rate_hz": float(1.0 / np.median(step)) if step.size else None,
        "uniform": bool(step.size == 0 or np.ptp(step) <= 1e-6 * float(np.median(step)) + 1e-9),
        "peak_body_rate_deg_s": peak,
    }
