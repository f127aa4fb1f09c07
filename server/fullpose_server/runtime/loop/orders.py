"""From a command's words to what the loop can do: all that can fail is read and checked before anything changes."""

import math
import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from fullpose.rig import FRAMES, Limit, Rig
from fullpose.verify import verify
from fullpose_server.formats.plan_folder import (
    PlanFolder,
    PlanFolderError,
    PlanInfo,
    changed_since,
    read_sealed_plan,
    rig_hash,
)
from fullpose_server.runtime.live.settings import LiveError, LiveSettings
from fullpose_server.runtime.live.source import LiveSource, ReadyLive
from fullpose_server.runtime.motion.generator import Motion
from fullpose_server.runtime.motion.path_player import PathPlayer
from fullpose_server.runtime.motion.point_to_point import MoveError, PointMove
from fullpose_server.session.alarms import Shelf
from fullpose_server.session.binding import Binding
from fullpose_server.session.errors import CodedError
from fullpose_server.session.states import Command
from fullpose_server.session.warning_codes import WarningCode


class OrderError(CodedError):
    """A command whose arguments cannot be done. `code` and message say which and why."""


@dataclass(frozen=True)
class Load:
    """What `load` brings, made ready: a plan with its player, or a live source's settings with their step."""

    plan: PlanFolder | None = None
    folder: Path | None = None  # of the plan
    player: PathPlayer | None = None
    live: ReadyLive | None = None

    def close(self) -> None:
        """Throw it away: it was not bound."""
        if self.live is not None:
            self.live.step.close()


def load_of(
    args: dict[str, Any], rig: Rig, motion: Motion, live: LiveSource, key: str | None = None
) -> tuple[Binding, Load]:
    """The plan of `args["plan_folder"]`, or the live settings of `args["live"]`, of a source that has `key`.

    Raises `OrderError`.
    """
    if "live" in args:
        try:
            settings = msgspec.convert(args["live"], LiveSettings)
            ready = live.ready(settings, key)
        except (msgspec.ValidationError, ValueError) as cause:
            raise OrderError("bad_arguments", f"live: {cause}") from cause
        except LiveError as cause:
            raise OrderError("bad_arguments", str(cause)) from cause
        return Binding("live", settings.hash, rig.name, rig_hash(rig), live=True), Load(live=ready)
    folder = args.get("plan_folder")
    if not isinstance(folder, str):
        raise OrderError("bad_arguments", "load needs plan_folder (a path), or live (settings)")
    plan = _flyable(Path(folder))
    info = plan.info
    if args.get("plan_hash", info.plan_hash) != info.plan_hash:
        text = f"plan.json: plan_hash is {info.plan_hash[:16]}, not that of the plan that was made"
        raise OrderError("bad_plan", f"{text} ({args['plan_hash'][:16]}): make it again")
    _check_path(plan, rig)
    if rig.jerk_limited:
        _check_jerk(plan, rig, motion.rate_hz)
    binding = Binding(info.plan_id, info.plan_hash, info.rig, info.rig_hash)
    return binding, Load(plan, Path(folder), motion.ready(plan))


def _flyable(folder: Path) -> PlanFolder:
    try:
        plan = read_sealed_plan(folder)
    except PlanFolderError as cause:
        raise OrderError("bad_plan", cause.told) from cause
    if not plan.info.feasible:
        raise OrderError("bad_plan", "plan.json: feasible is false: it cannot be flown")
    return plan


def check_stored(folder: Path | None, loaded: PlanInfo | None) -> None:
    """Raise `OrderError` where the plan in `folder` is not as it was when it was loaded."""
    if folder is None or loaded is None:
        return  # a live source
    changed = changed_since(loaded, _flyable(folder).info)
    if changed:
        text = f"plan.json: {', '.join(changed)} since the plan was loaded"
        raise OrderError("bad_plan", f"{text}: unload it, and load it again")


def check_rig(args: dict[str, Any], rig: Rig) -> None:
    """Raise `OrderError` where the rig's file, by its hash, no longer says the rig that is flown."""
    if args.get("rig_file_hash", rig_hash(rig)) != rig_hash(rig):
        text = f"the file of rig {rig.name} says another geometry or other limits than when its process started"
        raise OrderError("rig_changed", f"{text}: put it back, or restart the server to fly by it")


def _check_path(plan: PlanFolder, rig: Rig) -> None:
    """A path is finite, and entered and left at rest: no step there is faster than one tick of acceleration."""
    if not np.isfinite(plan.angles).all():
        raise OrderError("bad_plan", "the plan's angles are not all finite")
    rate = plan.info.rate_hz
    for where, step in (("begin", plan.angles[1] - plan.angles[0]), ("end", plan.angles[-1] - plan.angles[-2])):
        allowed = np.where(np.isfinite(rig.max_acceleration), rig.max_acceleration, math.inf) / rate
        fast = np.abs(step) * rate > allowed * (1.0 + 1e-6)
        if fast.any():
            name = FRAMES[int(np.argmax(fast))]
            raise OrderError("bad_plan", f"the plan does not {where} at rest ({name} frame): it needs a lead to rest")


def _check_jerk(plan: PlanFolder, rig: Rig, rate_hz: float) -> None:
    """A path keeps the jerk limits, rest before and after it included, at the rate at which it is flown."""
    if abs(plan.info.rate_hz / rate_hz - 1.0) > 1e-9:
        told = f"made at {plan.info.rate_hz:g} Hz, and flown at {rate_hz:g} Hz, where its jerk is another"
        raise OrderError("bad_plan", f"the plan was {told}: make it again")
    path = np.concatenate([np.repeat(plan.angles[:1], 3, axis=0), plan.angles, np.repeat(plan.angles[-1:], 3, axis=0)])
    found = [v for v in verify(np.arange(len(path)) / rate_hz, path, rig).violations if v.limit is Limit.JERK]
    if found:
        first = found[0]
        at = first.time - 3.0 / rate_hz - plan.info.lead_in_samples / rate_hz + plan.info.start_s
        raise OrderError(
            "bad_plan", f"at {at:.3f} s the {first.frame} frame exceeds its jerk limit: make the plan again"
        )


def check_hold(rig: Rig) -> None:
    """Raise `OrderError` where a hold on the path would not keep the rig's limits."""
    if rig.jerk_limited:
        raise OrderError("jerk_limits", f"{rig.name} has max_jerk_deg_s3, which a hold on the path does not keep: stop")


def asked_pair(args: dict[str, Any], bound: Binding | None) -> Binding | None:
    """The pair that the caller of `arm` names; None where it names none."""
    if bound is None or not {"plan_hash", "rig_hash"} & set(args):
        return None
    return Binding(
        bound.plan_id,
        str(args.get("plan_hash", bound.plan_hash)),
        bound.rig,
        str(args.get("rig_hash", bound.rig_hash)),
        bound.live,
    )


def check_record(runs: Path, min_free_mb: float, *, recorder: bool) -> None:
    """Raise `OrderError` where a run could not be recorded; `recorder`: whether there is one, and it runs."""
    if not recorder:
        raise OrderError(
            "no_record", "the recorder does not run: it is started anew while the rig is at rest, try again"
        )
    try:
        runs.mkdir(parents=True, exist_ok=True)
        free = shutil.disk_usage(runs).free / 1e6
    except OSError as cause:
        raise OrderError("no_record", f"{runs} cannot be written: {cause.strerror}") from cause
    if free < min_free_mb:
        raise OrderError("disk_full", f"{free:.0f} MB free in {runs}: arming needs {min_free_mb:.0f} MB for the record")
    try:
        with tempfile.TemporaryFile(dir=runs):
            pass  # nothing else tells of a file system that is read only to one whom no rights bind
    except OSError as cause:
        raise OrderError("no_record", f"{runs} cannot be written: {cause.strerror}") from cause


def check_inside(rig: Rig, motion: Motion) -> None:
    """Raise `OrderError` where a frame stands outside its range: a step method begins inside."""
    for name, value, low, high in zip(FRAMES, motion.x1, rig.position_min, rig.position_max, strict=True):
        if not low <= value <= high:
            low_deg, high_deg, deg = (math.degrees(v) for v in (low, high, value))
            text = f"{name} stands at {deg:.6g} deg, outside {low_deg:.6g} to {high_deg:.6g} deg: move it inside first"
            raise OrderError("outside_limits", text)


def move_of(command: Command, args: dict[str, Any], rig: Rig, motion: Motion) -> PointMove:
    """The move that move, home, jog or start asks for. Raises `OrderError`."""
    try:
        if command is Command.START:
            return motion.plan_start()
        return motion.plan_move(_target(command, args, rig, motion))
    except MoveError as cause:
        raise OrderError("outside_limits", str(cause)) from cause


def _target(command: Command, args: dict[str, Any], rig: Rig, motion: Motion) -> np.ndarray[Any, np.dtype[np.float64]]:
    if command is Command.HOME:
        # The nearest turn of a frame that turns without end: home is a pose, not a count of turns.
        turns = np.where(np.isinf(rig.position_max), np.round((motion.x1 - rig.home) / math.tau), 0.0)
        return np.asarray(rig.home + turns * math.tau)
    if command is Command.MOVE:
        return np.asarray(np.radians(_four(args, "target_deg")))
    if "frame" in args:
        if args["frame"] not in FRAMES or not isinstance(args.get("step_deg"), int | float):
            raise OrderError("bad_arguments", f"jog needs frame (one of {', '.join(FRAMES)}) and step_deg (a number)")
        step = np.zeros(4)
        step[FRAMES.index(args["frame"])] = math.radians(args["step_deg"])
        return np.asarray(motion.x1 + step)
    return np.asarray(motion.x1 + np.radians(_four(args, "step_deg")))


def _four(args: dict[str, Any], name: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    value = args.get(name)
    if not isinstance(value, list) or len(value) != 4 or not all(isinstance(v, int | float) for v in value):
        raise OrderError("bad_arguments", f"{name} must be four numbers [deg], base first")
    return np.array(value, float)


def shelf_of(args: dict[str, Any], who: str, now_s: float) -> Shelf:
    """What `shelve` puts up, from `now_s` [s, Unix] on, and `unshelve` takes away. Raises `OrderError`."""
    code, frame, minutes = args.get("code"), args.get("frame"), args.get("minutes", 1.0)
    if code not in list(WarningCode):
        raise OrderError("bad_arguments", f"code {code!r}: expected that of a warning, one of {', '.join(WarningCode)}")
    if frame is not None and frame not in FRAMES:
        raise OrderError("bad_arguments", f"frame must be one of {', '.join(FRAMES)}, or left out for all")
    try:
        return Shelf(str(code), frame, now_s, now_s + 60.0 * float(minutes), who, str(args.get("reason", "")))
    except (TypeError, ValueError) as cause:
        raise OrderError("bad_arguments", f"minutes = {minutes!r}: {cause}") from cause


def alarms_of(args: dict[str, Any]) -> frozenset[int] | None:
    """The numbers that `acknowledge` is about; None for all. Raises `OrderError`."""
    raw = args.get("numbers")
    if raw is None:
        return None
    if not (isinstance(raw, list) and all(isinstance(n, int) for n in raw)):
        raise OrderError("bad_arguments", "numbers must be a list of alarm numbers, or left out for all")
    return frozenset(raw)
