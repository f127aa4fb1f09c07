"""A plan as files: what the planner's side writes and the rig process flies.

A folder holds `plan.json` and three arrays at the rig's uniform rate, lead-in and lead-out included:
`angles.npy` (n, 4) [rad], `target.npy` (n, 4) the flight's attitude as quaternion w, x, y, z (nan in the leads) and
`error.npy` (n,) the solve error [rad] (nan in the leads). It is written whole or not at all.
"""

import hashlib
import json
import math
import shutil
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np

from fullpose._typing import Array
from fullpose.rig import FRAMES, Rig
from fullpose_server.errors import DamagedError
from fullpose_server.formats import durable
from fullpose_server.formats.mapped import map_doubles

_ARRAYS = ("angles", "target", "error")


class PlanFolderError(Exception):
    """A folder that is not a sound plan: which file, and what is wrong with it."""

    def __init__(self, path: Path, problem: str) -> None:
        super().__init__(f"{path}: {problem}")
        self.path = path
        self.problem = problem


@dataclass(frozen=True)
class PlanInfo:
    """What `plan.json` says."""

    plan_id: str
    rig: str
    rig_hash: str
    plan_hash: str  # sha-256 of the three arrays
    trajectory_sha256: str
    method: str
    rate_hz: float
    samples: int  # leads included
    lead_in_samples: int  # rows before the flight's first sample
    lead_out_samples: int  # rows after the flight's last sample
    duration_s: float  # of the flight, without leads
    feasible: bool
    name: str = ""  # of the trajectory, for people
    start_s: float = 0.0  # the flight's own time at its first sample


@dataclass(frozen=True)
class PlanOrigin:
    """What a plan is a plan of, and how it was made."""

    plan_id: str
    trajectory_sha256: str
    method: str
    name: str = ""  # of the trajectory, for people
    start_s: float = 0.0  # the flight's own time at its first sample


class PlanPath(NamedTuple):
    """What is flown, leads included; target and error count in the flight between the leads only."""

    angles: Array  # (n, 4) [rad]
    target: Array  # (n, 4) w, x, y, z
    error: Array  # (n,) [rad]
    lead_in_samples: int  # rows before the flight's first sample
    lead_out_samples: int  # rows after the flight's last sample


@dataclass(frozen=True)
class PlanFolder:
    """A plan in memory or mapped from its folder. Arrays are read-only."""

    info: PlanInfo
    angles: Array  # (n, 4) [rad]
    target: Array  # (n, 4) w, x, y, z
    error: Array  # (n,) [rad]


def rig_hash(rig: Rig) -> str:
    """sha-256 of everything about a rig that a plan depends on: geometry, limits, weights and home [rad]."""
    limits = {
        name: {key: repr(float(value)) for key, value in asdict(frame).items()}
        for name, frame in zip(FRAMES, rig.frames, strict=True)
    }
    text = json.dumps({"geometry": str(rig.geometry), "frames": limits}, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def plan_hash(angles: Array, target: Array, error: Array) -> str:
    """sha-256 of the arrays' shapes and little-endian values."""
    digest = hashlib.sha256()
    for array in (angles, target, error):
        digest.update(repr(array.shape).encode())
        digest.update(np.ascontiguousarray(array, dtype="<f8").tobytes())
    return digest.hexdigest()


def make_plan(origin: PlanOrigin, rig: Rig, rate_hz: float, path: PlanPath, *, feasible: bool) -> PlanFolder:
    """A plan from its arrays (shapes as in `PlanPath`). Target quaternions are made continuous in sign.

    Raises ValueError where shapes disagree, a flight's row is not finite, or the leads leave no flight.
    """
    angles, target, error, lead_in_samples, lead_out_samples = path
    n = len(angles)
    flight = slice(lead_in_samples, n - lead_out_samples)
    if angles.shape != (n, 4) or target.shape != (n, 4) or error.shape != (n,):
        raise ValueError(f"plan arrays {angles.shape}, {target.shape}, {error.shape}: expected (n, 4), (n, 4), (n,)")
    if min(lead_in_samples, lead_out_samples) < 0 or lead_in_samples + lead_out_samples + 2 > n:
        raise ValueError(f"leads of {lead_in_samples} and {lead_out_samples} in {n} samples: expected a flight between")
    if not (np.isfinite(angles).all() and np.isfinite(target[flight]).all() and np.isfinite(error[flight]).all()):
        raise ValueError("plan arrays: expected finite angles, and finite target and error in the flight")
    x = np.ascontiguousarray(angles, dtype="<f8")
    q = np.full((n, 4), math.nan)
    q[flight] = _continuous(target[flight])
    e = np.full(n, math.nan)
    e[flight] = error[flight]
    for array in (x, q, e):
        array.setflags(write=False)
    info = PlanInfo(
        plan_id=origin.plan_id,
        rig=rig.name,
        rig_hash=rig_hash(rig),
        plan_hash=plan_hash(x, q, e),
        trajectory_sha256=origin.trajectory_sha256,
        method=origin.method,
        rate_hz=float(rate_hz),
        samples=n,
        lead_in_samples=lead_in_samples,
        lead_out_samples=lead_out_samples,
        duration_s=(n - lead_in_samples - lead_out_samples - 1) / rate_hz,
        feasible=feasible,
        name=origin.name,
        start_s=origin.start_s,
    )
    return PlanFolder(info, x, q, e)


def _continuous(q: Array) -> Array:
    """The same rotations with signs such that neighbours are on the same half of the sphere, unit length. (n, 4)"""
    unit = q / np.linalg.norm(q, axis=1, keepdims=True)
    flips = np.sign(np.sum(unit[1:] * unit[:-1], axis=1))
    signs = np.concatenate([[1.0], np.cumprod(np.where(flips < 0.0, -1.0, 1.0))])
    return np.asarray(unit * signs[:, None])


def write_plan(folder: Path, plan: PlanFolder) -> None:
    """Write `plan` as `folder`, replacing it; a reader sees the old folder or the whole new one."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    draft = Path(tempfile.mkdtemp(prefix=f".{folder.name}.", dir=folder.parent))
    try:
        for name in _ARRAYS:
            np.save(draft / f"{name}.npy", getattr(plan, name), allow_pickle=False)
        (draft / "plan.json").write_text(json.dumps(asdict(plan.info), indent=2), "utf-8")
        draft.chmod(0o755)
        if folder.exists():
            shutil.rmtree(folder)
        durable.rename(draft, folder)
    except BaseException:
        shutil.rmtree(draft, ignore_errors=True)
        raise


def read_plan(folder: Path, *, verify: bool = True) -> PlanFolder:
    """The plan in `folder`, arrays mapped read-only; `verify` recomputes the hash.

    Raises `PlanFolderError` where a file is missing, the arrays are not what plan.json says, or the hash differs.
    """
    info = _read_info(folder)
    arrays: dict[str, Any] = {}
    for name, shape in (("angles", (info.samples, 4)), ("target", (info.samples, 4)), ("error", (info.samples,))):
        path = folder / f"{name}.npy"
        try:
            arrays[name] = map_doubles(path, shape)
        except DamagedError as error:
            raise PlanFolderError(path, str(error).removeprefix(f"{path}: ")) from error
    plan = PlanFolder(info, **arrays)
    if verify and plan_hash(plan.angles, plan.target, plan.error) != info.plan_hash:
        raise PlanFolderError(folder, "the arrays are not those that plan.json's hash was taken of")
    return plan


def _read_info(folder: Path) -> PlanInfo:
    path = folder / "plan.json"
    try:
        # Keys may be added by whoever stores plans; those that the rig needs must be there, and be what they are.
        info = msgspec.json.decode(path.read_bytes(), type=PlanInfo)
    except (OSError, ValueError, msgspec.MsgspecError) as cause:
        raise PlanFolderError(path, f"not a plan ({cause})") from cause
    leads = (info.lead_in_samples, info.lead_out_samples)
    if min(leads) < 0 or sum(leads) + 2 > info.samples or not 0.0 < info.rate_hz < math.inf:
        raise PlanFolderError(path, f"{info.samples} samples, leads of {leads}, {info.rate_hz} Hz: expected a flight")
    return info
