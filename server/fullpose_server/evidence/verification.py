"""Verifies a bundle, with nothing but the bundle: every byte, the signature, and what its parts say of each other."""

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fullpose.errors import SolverError
from fullpose_server.errors import DamagedError, FileError
from fullpose_server.evidence.archive import ArchiveReader, Member
from fullpose_server.evidence.bundle import AUDIT, FORMAT, MANIFEST, RIG, RIG_VALUES, SIGNATURE
from fullpose_server.evidence.errors import BundleError
from fullpose_server.evidence.signing import SignatureError, check_signature
from fullpose_server.evidence.sources import PLAN_FILES
from fullpose_server.formats.flight_folder import read_arrays
from fullpose_server.formats.plan_folder import PlanFolderError, read_sealed_plan, rig_hash
from fullpose_server.formats.rig_codec import rig_from_values
from fullpose_server.formats.rig_file import read_rig
from fullpose_server.formats.trajectory import Convention, Trajectory
from fullpose_server.store.hash_chain import is_as_written

MOST_MANIFEST = 16 << 20
MOST_SIGNATURE = 4096


@dataclass(frozen=True)
class Verified:
    """A bundle that is sound. `trusted`: by a key that whoever verifies has named, not by the bundle's own word."""

    public_key: str
    signed_at: str
    trusted: bool
    run: str
    rig: str
    sentence: str  # what the run came to
    files: int
    missing: dict[str, str]  # parts that are not in it, and why
    fits: tuple[str, ...]  # what was compared beyond the hashes, in words


def verify_bundle(path: Path, key: str | None = None) -> Verified:
    """Read the bundle whole; `key`: the public key that it has to be signed with. Raises `BundleError`."""
    with ArchiveReader(path) as archive:
        document = archive.read(MANIFEST, MOST_MANIFEST)
        try:
            signer, signed_at = check_signature(archive.read(SIGNATURE, MOST_SIGNATURE), document)
        except SignatureError as error:
            raise BundleError(path, str(error)) from None
        if key is not None and signer != key:
            raise BundleError(path, f"signed with the key {signer}, not with {key}")
        manifest = _manifest(path, document)
        with tempfile.TemporaryDirectory(prefix="fullpose-evidence-") as work:
            _check_files(path, archive, manifest["files"], Path(work))
            fits = _check_parts(path, manifest, Path(work))
    run, missing = manifest["run"], {str(part): str(why) for part, why in manifest["missing"].items()}
    told = str(run["id"]), str(run["rig"]), str(manifest["outcome"]["sentence"])
    return Verified(signer, signed_at, key is not None, *told, len(manifest["files"]), missing, fits)


def _manifest(path: Path, document: bytes) -> dict[str, Any]:
    try:
        manifest = json.loads(document)
        if manifest["format"] != FORMAT:
            raise BundleError(path, f"format {manifest['format']}: this Fullpose verifies format {FORMAT}")
        for name, member in manifest["files"].items():
            manifest["files"][str(name)] = Member(int(member["size"]), str(member["sha256"]))
        for name, keys in (("run", {"id", "rig", "plan_hash"}), ("outcome", {"sentence"}), ("rig", {"hash"})):
            if keys - set(manifest[name]):
                raise KeyError(name)
        manifest["missing"].items()
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError) as error:
        raise BundleError(path, f"{MANIFEST} is none ({error!r})") from None
    found: dict[str, Any] = manifest
    return found


def _check_files(path: Path, archive: ArchiveReader, files: dict[str, Member], work: Path) -> None:
    """Compare every file with the manifest; those that are looked into are copied to `work`."""
    there = set(archive.names) - {MANIFEST, SIGNATURE}
    for told, names in (("missing", files.keys() - there), ("not in the manifest", there - files.keys())):
        if names:
            raise BundleError(path, f"{told}: {', '.join(sorted(names))}")
    for name, member in files.items():
        copied = name in (RIG, RIG_VALUES, AUDIT) or name.startswith(("plan/", "flight/"))
        copy = work / name if copied else None
        if copy is not None:
            copy.parent.mkdir(exist_ok=True)
        if archive.member(name, copy) != member:
            raise BundleError(path, f"{name} is not as it was signed")


def _check_parts(path: Path, manifest: dict[str, Any], work: Path) -> tuple[str, ...]:
    fits = []
    try:
        if (work / "plan").is_dir():
            fits.append(_plan(path, manifest, work))
        if (work / "flight").is_dir():
            fits.append(_flight(path, manifest, work))
        if (work / RIG).is_file() or (work / RIG_VALUES).is_file():
            fits.append(_rig(path, manifest, work))
        fits.append(_audit(path, work))
    except (KeyError, TypeError, ValueError, OSError, RecursionError, SolverError) as error:
        raise BundleError(path, f"{MANIFEST} and its files do not fit each other ({error!r})") from None
    return tuple(fits)


def _plan(path: Path, manifest: dict[str, Any], work: Path) -> str:
    folder = work / "plan"
    if {each.name for each in folder.iterdir()} != set(PLAN_FILES):
        raise BundleError(path, f"plan: expected {', '.join(PLAN_FILES)}")
    try:
        info = read_sealed_plan(folder).info
    except PlanFolderError as error:
        raise BundleError(path, f"plan/{error.path.name}: {error.problem}") from None
    if not info.plan_hash == manifest["plan"]["hash"] == manifest["run"]["plan_hash"]:
        raise BundleError(path, "the plan is not the one that was flown: its hash is another")
    if manifest["flight"] is not None and info.trajectory_sha256 != manifest["flight"]["sha256"]:
        raise BundleError(path, "the flight is not the plan's")
    if info.rig_hash != manifest["rig"]["hash"]:
        raise BundleError(path, "the plan is another rig's")
    return "the plan's seal"


def _flight(path: Path, manifest: dict[str, Any], work: Path) -> str:
    flight = manifest["flight"]
    try:
        time_s, q = read_arrays(work / "flight", flight["samples"])
    except DamagedError as error:
        raise BundleError(path, f"flight: {error}") from None
    found = Trajectory(np.array(time_s), np.array(q), Convention(flight["convention"])).sha256
    if found != flight["sha256"]:
        raise BundleError(path, "flight: its samples are not those of its sha-256")
    return "the flight's sha-256"


def _rig(path: Path, manifest: dict[str, Any], work: Path) -> str:
    try:
        entry = read_rig(work / RIG)
    except FileError as error:
        raise BundleError(path, f"{RIG}: {error}") from None
    rig = rig_from_values(json.loads((work / RIG_VALUES).read_text("utf-8")))
    if rig_hash(rig) != manifest["rig"]["hash"]:
        raise BundleError(path, f"{RIG_VALUES} is not the rig that was flown: its hash is another")
    # A frame that the geometry has not is in the hash, and in no file.
    frames = rig.geometry.frames
    same = [entry.rig.frames[index] for index in frames] == [rig.frames[index] for index in frames]
    if (entry.rig.name, entry.rig.geometry) != (rig.name, rig.geometry) or not same:
        raise BundleError(path, f"{RIG} is not the rig that was flown")
    return "the rig's hash"


def _audit(path: Path, work: Path) -> str:
    """Each line is what its hash is of, and follows the one before where that is here."""
    count, last = 0, None
    for number, text in enumerate((work / AUDIT).read_text("utf-8").splitlines(), start=1):
        row = json.loads(text)
        if not is_as_written(row):
            raise BundleError(path, f"{AUDIT}, line {number}: not as it was written")
        if last is not None and (
            row["id"] <= last["id"] or (row["id"] == last["id"] + 1) != (row["previous"] == last["hash"])
        ):
            raise BundleError(path, f"{AUDIT}, line {number}: it does not follow the one before")
        count, last = count + 1, row
    return f"the hashes of {count} lines of the audit"
