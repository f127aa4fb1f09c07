"""Makes the bundle of a run: one zip, whole or not at all, the same for the same run but for when it was signed."""

import json
import math
import platform
import time
from collections.abc import Mapping
from dataclasses import asdict
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from fullpose_server.evidence.archive import ArchiveWriter
from fullpose_server.evidence.outcome import Outcome, outcome_of
from fullpose_server.evidence.report import Hashes, report
from fullpose_server.evidence.signing import public_key, signature, signing_key
from fullpose_server.evidence.sources import PLAN_FILES, Sources, sources_of
from fullpose_server.formats.output_file import replacing
from fullpose_server.formats.rig_codec import rig_values
from fullpose_server.location import Location
from fullpose_server.version import VERSION

FORMAT = 1
MANIFEST, SIGNATURE = "manifest.json", "signature.json"
RECORD, ALARMS, AUDIT, REPORT = "record.mcap", "alarms.json", "audit.jsonl", "report.pdf"
RIG, RIG_VALUES = "rig.toml", "rig.json"  # as people write it, and as it is hashed
_LIBRARIES = ("numpy", "scipy", "numba", "piqp", "mcap", "msgspec", "pyarrow", "sqlalchemy", "cryptography", "typst")


def make_bundle(folder: Path, run: str, target: Path, database: Location | None = None) -> dict[str, Any]:
    """Write the bundle of a run of the data folder, whose rows are in `database` (its own file); returns its manifest.

    Raises as `sources_of`, and OSError where it cannot be written: then nothing is there.
    """
    found = sources_of(folder, run, database)
    outcome = outcome_of(found.run, found.rows, found.rig)
    key = signing_key(folder)
    with replacing(target) as draft, ArchiveWriter(draft) as archive:
        _add_sources(archive, found)
        page = report(found, outcome, Hashes(archive.members[RECORD].sha256, public_key(key)))
        archive.add(REPORT, page)
        manifest = _manifest(found, outcome, archive)
        document = _json(manifest)
        archive.add(MANIFEST, document)
        signed_at = datetime.fromtimestamp(time.time(), UTC).isoformat(timespec="seconds").replace("+00:00", "Z")
        archive.add(SIGNATURE, signature(key, document, signed_at))
    return manifest


def _add_sources(archive: ArchiveWriter, found: Sources) -> None:
    archive.add_file(RECORD, found.record)
    if found.plan_folder is not None:
        for name in PLAN_FILES:
            archive.add_file(f"plan/{name}", found.plan_folder / name)
    if found.flight_folder is not None and found.flight is not None:
        source = f"source.{found.flight['source_format']}"
        for name in ("time.npy", "q.npy", source):
            archive.add_file(f"flight/{name}", found.flight_folder / name)
    if found.rig is not None and found.rig_text is not None:
        archive.add(RIG, found.rig_text.encode())
        archive.add(RIG_VALUES, _json(rig_values(found.rig)))
    archive.add(ALARMS, _json(found.alarms))
    archive.add(AUDIT, "".join(json.dumps(row, sort_keys=True) + "\n" for row in found.audit).encode())


def _manifest(found: Sources, outcome: Outcome, archive: ArchiveWriter) -> dict[str, Any]:
    return {
        "format": FORMAT,
        "made_with": {"fullpose": VERSION, "python": platform.python_version(), "libraries": _versions()},
        "run": asdict(found.run),
        "outcome": outcome.to_json(),
        "plan": None
        if found.plan is None
        else {"hash": found.plan.plan_hash, "id": found.plan.plan_id, **found.method},
        "flight": found.flight,
        "rig": {"name": found.run.rig, "hash": found.bound.get("rig_hash")},
        "alarms": len(found.alarms),
        "audit": {"lines": len(found.audit), "newest_hash": found.newest_hash},
        "missing": found.missing,
        "files": {name: asdict(member) for name, member in archive.members.items()},
    }


def _versions() -> dict[str, str]:
    """Of the libraries that had a part in it."""
    found = {}
    for name in _LIBRARIES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def _json(document: Mapping[str, Any] | list[Any]) -> bytes:
    return (json.dumps(_finite(document), indent=1, sort_keys=True, allow_nan=False) + "\n").encode()


def _finite(value: Any) -> Any:
    """What is not a number is null: JSON has none."""
    if isinstance(value, Mapping):
        return {str(key): _finite(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
