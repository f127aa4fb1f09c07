"""A plan as files: what the planner's side writes and the rig process flies.

A folder holds `plan.json` and three arrays at the rig's uniform rate, lead-in and lead-out included:
`angles.npy` (n, 4) [rad], `target.npy` (n, 4) the flight's attitude as quaternion w, x, y, z (nan in the leads) and
`error.npy` (n,) the solve error [rad] (nan in the leads). It is written whole or not at all, and sealed: whatever of it
is changed later is noticed where it is read to be flown (`plan_seal`).
"""

import hashlib
import json
import math
import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np

from fullpose._typing import Array
from fullpose.rig import FRAMES, Rig
from fullpose_server.errors import DamagedError
from fullpose_server.formats import durable
from fullpose_server.formats.mapped import map_doubles
from fullpose_server.formats.plan_seal import arrays_sealed, facts_sealed, seal_hash, unlike

FORMAT = 2  # 1: no such key, and a hash of the arrays alone
MAKE_AGAIN = "make the plan again"
EARLIER_FORMAT = f"made by an earlier Fullpose, whose hash does not cover all that moves the rig: {MAKE_AGAIN}"
_ARRAYS = ("angles", "target", "error")
_SEAL = ("plan_hash", "sealed")


class PlanFolderError(Exception):
    """A folder that is not a sound plan: which file, and what is wrong with it."""

    def __init__(self, path: Path, problem: str) -> None:
        super().__init__(f"{path}: {problem}")
        self.path = path
        self.problem = problem

    @property
    def told(self) -> str:
        """The same without the folder, for who is not on this machine."""
        return f"{self.path.name}: {self.problem}"


@dataclass(frozen=True)
class PlanInfo:
    """What `plan.json` says."""

    plan_id: str
    rig: str
    rig_hash: str
    plan_hash: str  # sha-256 of the seal
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
    tolerance_deg: float | None = None  # by which the attitude may differ from the flight's
    format: int = 1  # of the folder
    sealed: dict[str, str] = field(default_factory=dict)  # digests of every other key and of the three arrays

    @property
    def facts(self) -> dict[str, Any]:
        """What the seal is of, beside the arrays. A plan without a tolerance says nothing of it, as all did once."""
        said = {key: value for key, value in asdict(self).items() if key not in _SEAL}
        return said if self.tolerance_deg is not None else {k: v for k, v in said.items() if k != "tolerance_deg"}


@dataclass(frozen=True)
class PlanOrigin:
    """What a plan is a plan of, and how it was made."""

    plan_id: str
    trajectory_sha256: str
    method: str
    name: str = ""  # of the trajectory, for people
    start_s: float = 0.0  # the flight's own time at its first sample
    tolerance_deg: float | None = None


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
    # A key that came later counts only where it is given: plans of before stay those of their rigs.
    limits = {
        name: {
            key: repr(float(value)) for key, value in asdict(frame).items() if key != "max_jerk" or math.isfinite(value)
        }
        for name, frame in zip(FRAMES, rig.frames, strict=True)
    }
    text = json.dumps({"geometry": str(rig.geometry), "frames": limits}, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


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
        plan_hash="",
        trajectory_sha256=origin.trajectory_sha256,
        method=origin.method,
        rate_hz=float(rate_hz),
        samples=n,
        lead_in_samples=lead_in_samples,
        lead_out_samples=lead_out_samples,
        duration_s=(n - lead_in_samples - lead_out_samples - 1) / rate_hz,
        feasible=feasible,
        name=origin.name,
        start_s=float(origin.start_s),
        tolerance_deg=origin.tolerance_deg,
        format=FORMAT,
    )
    return sealed_plan(PlanFolder(info, x, q, e))


def sealed_plan(plan: PlanFolder) -> PlanFolder:
    """The plan with the seal of what it says."""
    sealed = _seal_of(plan)
    return replace(plan, info=replace(plan.info, plan_hash=seal_hash(sealed), sealed=sealed))


def _seal_of(plan: PlanFolder) -> dict[str, str]:
    return facts_sealed(plan.info.facts) | arrays_sealed({name: getattr(plan, name) for name in _ARRAYS})


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


def read_plan(folder: Path) -> PlanFolder:
    """The plan in `folder` as it can be looked at: arrays mapped read-only, and not compared with the seal.

    Raises `PlanFolderError` where a file is missing, or the arrays are not of the shape that plan.json says.
    """
    return _mapped(folder, _read_info(folder))


def read_sealed_plan(folder: Path) -> PlanFolder:
    """The plan in `folder` as it can be flown: in memory, and just as it was made.

    Raises `PlanFolderError` as `read_plan`, and where something is not what was sealed: which file, and what of it.
    """
    info, path = _read_info(folder), folder / "plan.json"
    if info.format != FORMAT:
        raise PlanFolderError(path, f"format {info.format}, {EARLIER_FORMAT}")
    _check_seal(path, facts_sealed(info.facts), {k: v for k, v in info.sealed.items() if k not in _ARRAYS})
    if seal_hash(info.sealed) != info.plan_hash:
        raise PlanFolderError(path, f"plan_hash: not that of what is sealed: {MAKE_AGAIN}")
    mapped = _mapped(folder, info)
    # First into memory: what is compared is what is flown, whoever writes to the files meanwhile.
    arrays = {name: np.array(getattr(mapped, name)) for name in _ARRAYS}
    for name, digest in arrays_sealed(arrays).items():
        _check_seal(folder / f"{name}.npy", {name: digest}, {name: info.sealed.get(name, "")})
        arrays[name].setflags(write=False)
    return PlanFolder(info, **arrays)


def _mapped(folder: Path, info: PlanInfo) -> PlanFolder:
    arrays: dict[str, Any] = {}
    for name, shape in (("angles", (info.samples, 4)), ("target", (info.samples, 4)), ("error", (info.samples,))):
        path = folder / f"{name}.npy"
        try:
            arrays[name] = map_doubles(path, shape)
        except DamagedError as error:
            raise PlanFolderError(path, str(error).removeprefix(f"{path.name}: ")) from error
    return PlanFolder(info, **arrays)


def _check_seal(path: Path, found: Mapping[str, str], sealed: Mapping[str, str]) -> None:
    other = unlike(found, sealed)
    if other:
        raise PlanFolderError(path, f"{', '.join(other)}: not as the plan was made: {MAKE_AGAIN}")


def changed_since(was: PlanInfo, now: PlanInfo) -> list[str]:
    """What of a sealed plan is not what it was: the keys of plan.json, with both values, and the arrays."""
    facts = was.facts, now.facts
    keys = [key for key in {**facts[0], **facts[1]} if facts[0].get(key) != facts[1].get(key)]
    told = [f"{key} was {facts[0].get(key)!r}, is {facts[1].get(key)!r}" for key in keys]
    return told + [f"{name}.npy is another" for name in unlike(was.sealed, now.sealed) if name in _ARRAYS]


def _read_info(folder: Path) -> PlanInfo:
    path = folder / "plan.json"
    try:
        raw = msgspec.json.decode(path.read_bytes(), type=dict[str, Any])
        _check_keys(raw, path)
        info = msgspec.convert(raw, PlanInfo)
    except (OSError, ValueError, msgspec.MsgspecError) as cause:
        raise PlanFolderError(path, f"not a plan ({cause})") from cause
    leads = (info.lead_in_samples, info.lead_out_samples)
    if min(leads) < 0 or sum(leads) + 2 > info.samples or not 0.0 < info.rate_hz < math.inf:
        raise PlanFolderError(path, f"{info.samples} samples, leads of {leads}, {info.rate_hz} Hz: expected a flight")
    return info


def _check_keys(raw: Mapping[str, Any], path: Path) -> None:
    """Refuse what no seal covers."""
    unknown = sorted(raw.keys() - {each.name for each in fields(PlanInfo)})
    if unknown:
        raise PlanFolderError(path, f"{', '.join(unknown)}: not a key of a plan; {MAKE_AGAIN}")
