"""Rigs: the built-in ones and TOML files (DESIGN: a rig file). Degrees in the file, radians in `solver`.

What a file may say is declared in `rig_document`; how the rig is operated is put together in `rig_operating`.
"""

import math
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fullpose.errors import RigError
from fullpose.rig import FRAMES, Rig, builtin_rigs
from fullpose_server.errors import FileError, NotFoundError
from fullpose_server.formats.rig_document import FRAME_KEYS, document, frame_limits
from fullpose_server.formats.rig_keys import bad, only
from fullpose_server.formats.rig_operating import operating_of
from fullpose_server.operating import OperatingConfig

DEFAULT_SIZE_M = (0.3, 0.2, 0.2)
_DEFAULTS = OperatingConfig()


@dataclass(frozen=True)
class Payload:
    """What the rig carries: a box, or a mesh file beside the rig file."""

    size_m: tuple[float, float, float] | None = DEFAULT_SIZE_M
    mesh: str | None = None


@dataclass(frozen=True)
class RigEntry:
    """A rig, its payload, whether it comes with Fullpose, and how it is operated."""

    rig: Rig
    payload: Payload
    builtin: bool
    operating: OperatingConfig = _DEFAULTS


def read_rig(path: Path, defaults: OperatingConfig = _DEFAULTS) -> RigEntry:
    """The rig in a TOML file; it is operated by `defaults` but for what the file says.

    Raises `FileError` naming key, value and what was expected.
    """
    file = str(path)
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise FileError(file, f"TOML ({error})") from None
    except UnicodeDecodeError:
        raise FileError(file, "TOML text in UTF-8, this is a binary file") from None
    return parse_rig(table, file, defaults)


def parse_rig(table: dict[str, Any], file: str, defaults: OperatingConfig = _DEFAULTS) -> RigEntry:
    """The rig of a parsed file; `file` is for messages."""
    read = document(table, file)
    frames = table.get("frames", {})
    only(frames, {FRAMES[index] for index in read.geometry.frames}, "frames.", file)
    base, outer, middle, inner = (frame_limits(getattr(read.frames, name)) for name in FRAMES)
    try:
        rig = Rig(read.name, read.geometry, (base, outer, middle, inner))
    except RigError as error:
        raise _in_degrees(error, frames, file) from None
    size, mesh = read.payload.size_m, read.payload.mesh
    payload = Payload(DEFAULT_SIZE_M if size is None and not mesh else size, mesh)
    return RigEntry(rig, payload, builtin=False, operating=operating_of(read, file, defaults))


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
    """The rigs of a server: built in, and the TOML files of its data folder, read again at every use.

    They are operated by `defaults` but for what a file says. A file that is no rig costs the others nothing.
    """

    def __init__(self, folder: Path, defaults: OperatingConfig = _DEFAULTS) -> None:
        self.folder = folder
        self._defaults = defaults
        folder.mkdir(parents=True, exist_ok=True)

    def all(self) -> list[RigEntry]:
        """All rigs, the built-in ones first; files that are no rigs are left out (see `broken`)."""
        return self._builtin() + [found for found in self._read() if isinstance(found, RigEntry)]

    def broken(self) -> list[FileError]:
        """What is wrong with the files that are no rigs."""
        return [found for found in self._read() if isinstance(found, FileError)]

    def get(self, name: str) -> RigEntry:
        """One rig. Raises `NotFoundError`, and `FileError` where its own file is no rig."""
        for entry in self._builtin():
            if entry.rig.name == name:
                return entry
        for path in self.folder.glob("*.toml"):
            if path.stem == name:
                return self._checked(path)
        raise NotFoundError("rig", name)

    def _builtin(self) -> list[RigEntry]:
        return [RigEntry(rig, Payload(), builtin=True, operating=self._defaults) for rig in builtin_rigs().values()]

    def _read(self) -> list[RigEntry | FileError]:
        found: list[RigEntry | FileError] = []
        for path in sorted(self.folder.glob("*.toml")):
            try:
                found.append(self._checked(path))
            except FileError as error:
                found.append(error)
        return found

    def _checked(self, path: Path) -> RigEntry:
        entry = read_rig(path, self._defaults)
        if entry.rig.name != path.stem:
            raise bad(str(path), "name", entry.rig.name, f"{path.stem!r}, as the file is called")
        if entry.rig.name in builtin_rigs():
            raise bad(str(path), "name", entry.rig.name, "a name that no built-in rig has")
        return entry


def _in_degrees(error: RigError, frames: dict[str, Any], file: str) -> FileError:
    """What is wrong with a frame, in the keys and degrees of the file."""
    _, frame, *field = error.field.split(".")
    where, table = f"frames.{frame}", frames.get(frame, {})
    if field:
        key = next(key for key, name in FRAME_KEYS.items() if name == field[0])
        low, high = table.get("min_deg", -math.inf), table.get("max_deg", math.inf)
        expected = f"a position inside the range, {low:g} to {high:g} deg" if key == "home_deg" else error.expected
        return bad(file, f"{where}.{key}", table.get(key, 0.0), expected)
    if "min_deg" in table and "max_deg" in table:
        return bad(file, f"{where}.max_deg", table["max_deg"], f"at least min_deg, {table['min_deg']:g}")
    given, other = ("min_deg", "max_deg") if "min_deg" in table else ("max_deg", "min_deg")
    hint = "a single stop: give the other one as far as the frame may ever turn, in degrees"
    return bad(file, f"{where}.{given}", table[given], f"{other} beside it ({hint})")
