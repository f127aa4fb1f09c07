"""The profiles that people have saved on a server: TOML files of its data folder, such as `--profile FILE` reads."""

from pathlib import Path

from fullpose_server.errors import FileError, InUseError, NotFoundError
from fullpose_server.formats import durable
from fullpose_server.formats.column_map import ColumnMap
from fullpose_server.formats.profile import (
    EulerProfile,
    Profile,
    QuaternionProfile,
    TimeProfile,
    find_profile,
    shipped,
)
from fullpose_server.formats.toml_text import toml

MOST = 500


class SavedProfiles:
    """Lists, saves and removes profiles. A file that is none costs the others nothing."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)

    def all(self) -> dict[str, Profile]:
        """By name."""
        found = {}
        for path in sorted(self.folder.glob("*.toml")):
            try:
                found[path.stem] = find_profile(str(path))
            except (FileError, OSError):
                continue
        return found

    def path(self, name: str) -> Path | None:
        """The file of a saved profile; None where there is none of that name."""
        return next((path for path in self.folder.glob("*.toml") if path.stem == name), None)

    def save(self, name: str, about: str, columns: ColumnMap) -> Profile:
        """Save a column map, in the place of what had the name before.

        Raises `InUseError`: a profile that ships has it, or there are too many.
        """
        if name in shipped():
            raise InUseError("profile", name, "Fullpose: it ships with it")
        if self.path(name) is None and len(list(self.folder.glob("*.toml"))) >= MOST:
            raise InUseError("profile", name, f"none: there are {MOST} saved ones, remove one first")
        profile = profile_of(about, columns)
        with durable.replacing(self.folder / f"{name}.toml") as draft:
            draft.write_text(toml(profile), encoding="utf-8")
        return profile.model_copy(update={"name": name})

    def remove(self, name: str) -> None:
        """Remove one. Raises `NotFoundError`, or `InUseError` where it ships."""
        if name in shipped():
            raise InUseError("profile", name, "Fullpose: it ships with it")
        path = self.path(name)
        if path is None:
            raise NotFoundError("profile", name)
        path.unlink(missing_ok=True)


def profile_of(about: str, columns: ColumnMap) -> Profile:
    """A column map as a profile: each column by its one name, everything said."""
    time = TimeProfile(column=(columns.time.column,), unit=columns.time.unit, epoch=columns.time.epoch)
    euler = quaternion = None
    if columns.euler is not None:
        first, second, third = ((name,) for name in columns.euler.columns)
        euler = EulerProfile(columns=(first, second, third), order=columns.euler.order, unit=columns.euler.unit)
    if columns.quaternion is not None:
        w, x, y, z = ((name,) for name in columns.quaternion.columns)
        quaternion = QuaternionProfile(columns=(w, x, y, z), sense=columns.quaternion.sense)
    return Profile(about=about, axes=columns.axes, time=time, euler=euler, quaternion=quaternion)
