"""Rigs: the built-in ones and TOML files (DESIGN: a rig file). Degrees in the file, radians in `solver`."""

import math
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from server.store.errors import FileError, NotFoundError
from solver.errors import RigError
from solver.rig import FRAMES, FrameLimits, Geometry, Rig, builtin_rigs

# Key in the file -> field of `FrameLimits`; all in degrees but the weight.
FRAME_KEYS = {
    "min_deg": "min",
    "max_deg": "max",
    "max_rate_deg_s": "max_rate",
    "max_acceleration_deg_s2": "max_acceleration",
    "weight": "weight",
    "home_deg": "home",
}
DEFAULT_SIZE_M = (0.3, 0.2, 0.2)


@dataclass(frozen=True)
class Payload:
    """What the rig carries: a box, or a mesh file beside the rig file."""

    size_m: tuple[float, float, float] | None = DEFAULT_SIZE_M
    mesh: str | None = None


@dataclass(frozen=True)
class RigEntry:
    """A rig, its payload, and whether it comes with Fullpose."""

    rig: Rig
    payload: Payload
    builtin: bool


def read_rig(path: Path) -> RigEntry:
    """The rig in a TOML file. Raises `FileError` naming key, value and what was expected."""
    file = str(path)
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise FileError(file, f"TOML ({error})") from None
    except UnicodeDecodeError:
        raise FileError(file, "TOML text in UTF-8, this is a binary file") from None
    return parse_rig(table, file)


def parse_rig(table: dict[str, Any], file: str) -> RigEntry:
    """The rig of a parsed file; `file` is for messages."""
    _only(table, {"name", "geometry", "frames", "payload"}, "", file)
    name, geometry = table.get("name"), table.get("geometry")
    if not isinstance(name, str) or not name:
        raise _bad(file, "name", name, "a name")
    if geometry not in [kind.value for kind in Geometry]:
        raise _bad(file, "geometry", geometry, "one of " + ", ".join(Geometry))
    frames = table.get("frames", {})
    if not isinstance(frames, dict):
        raise _bad(file, "frames", frames, "tables such as [frames.outer]")
    real = [FRAMES[index] for index in Geometry(geometry).frames]
    _only(frames, set(real), "frames.", file)
    try:
        rig = Rig(name, Geometry(geometry), _limits(frames, file))
    except RigError as error:
        raise FileError(file, error.expected, column=error.field, value=repr(error.value), column_word="key") from None
    return RigEntry(rig, _payload(table.get("payload", {}), file), builtin=False)


def find_rig(name_or_file: str, folder: Path | None = None) -> RigEntry:
    """A rig by name, built-in or in `folder`, or by the path of a TOML file. Raises `NotFoundError`, `FileError`."""
    rigs = builtin_rigs()
    if name_or_file in rigs:
        return RigEntry(rigs[name_or_file], Payload(), builtin=True)
    if folder is not None and (path := folder / f"{name_or_file}.toml").is_file():
        return read_rig(path)
    path = Path(name_or_file)
    if path.is_file():
        return read_rig(path)
    raise NotFoundError("rig", name_or_file, f"expected the path of a rig file or one of {', '.join(rigs)}")


class RigStore:
    """The rigs of a server: built in, and the TOML files of its data folder, read again at every use."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)

    def all(self) -> list[RigEntry]:
        """All rigs, the built-in ones first. Raises `FileError` for a file that is no rig."""
        files = sorted(self.folder.glob("*.toml"))
        return [RigEntry(rig, Payload(), builtin=True) for rig in builtin_rigs().values()] + [
            self._checked(path) for path in files
        ]

    def get(self, name: str) -> RigEntry:
        """One rig. Raises `NotFoundError`."""
        for entry in self.all():
            if entry.rig.name == name:
                return entry
        raise NotFoundError("rig", name)

    def _checked(self, path: Path) -> RigEntry:
        entry = read_rig(path)
        if entry.rig.name != path.stem:
            raise _bad(str(path), "name", entry.rig.name, f"{path.stem!r}, as the file is called")
        if entry.rig.name in builtin_rigs():
            raise _bad(str(path), "name", entry.rig.name, "a name that no built-in rig has")
        return entry


def _limits(frames: dict[str, Any], file: str) -> tuple[FrameLimits, FrameLimits, FrameLimits, FrameLimits]:
    base, outer, middle, inner = (_frame(frames.get(name, {}), f"frames.{name}", file) for name in FRAMES)
    return base, outer, middle, inner


def _frame(table: Any, where: str, file: str) -> FrameLimits:
    if not isinstance(table, dict):
        raise _bad(file, where, table, "a table")
    _only(table, set(FRAME_KEYS), f"{where}.", file)
    values = {}
    for key, field in FRAME_KEYS.items():
        if key in table:
            number = _number(table[key], f"{where}.{key}", file)
            values[field] = number if key == "weight" else math.radians(number)
    return FrameLimits(**values)


def _payload(table: Any, file: str) -> Payload:
    if not isinstance(table, dict):
        raise _bad(file, "payload", table, "a table")
    _only(table, {"size_m", "mesh"}, "payload.", file)
    mesh, size = table.get("mesh"), table.get("size_m")
    if mesh is not None and not isinstance(mesh, str):
        raise _bad(file, "payload.mesh", mesh, "a file name")
    if size is None:
        return Payload(None if mesh else DEFAULT_SIZE_M, mesh)
    if not isinstance(size, list) or len(size) != 3:
        raise _bad(file, "payload.size_m", size, "three lengths [m]")
    x, y, z = (_number(value, "payload.size_m", file) for value in size)
    if not min(x, y, z) > 0.0:
        raise _bad(file, "payload.size_m", size, "lengths above zero [m]")
    return Payload((x, y, z), mesh)


def _number(value: Any, where: str, file: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise _bad(file, where, value, "a finite number; leave the key out for no limit")
    return float(value)


def _only(table: dict[str, Any], known: set[str], prefix: str, file: str) -> None:
    for key in table:
        if key not in known:
            raise _bad(file, prefix + key, key, "one of " + ", ".join(sorted(known)))


def _bad(file: str, key: str, value: Any, expected: str) -> FileError:
    return FileError(file, expected, column=key, value=repr(value), column_word="key")
