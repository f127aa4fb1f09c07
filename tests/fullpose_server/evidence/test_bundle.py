"""Bundles: the same for the same run, whole or not at all, and honest about what is not there any more."""

import json
import os
import shutil
import subprocess
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pypdfium2
import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.errors import FileError, NotFoundError
from fullpose_server.evidence.bundle import make_bundle
from fullpose_server.evidence.errors import NoEvidenceError
from fullpose_server.evidence.signing import public_key, signing_key
from fullpose_server.evidence.verification import verify_bundle
from fullpose_server.formats.plan_folder import rig_hash
from fullpose_server.formats.rig_toml import rig_toml
from fullpose_server.location import EVIDENCE_KEY
from fullpose_server.runtime.recording.mcap_reader import read_samples
from fullpose_server.store.alarms import AlarmHistory
from fullpose_server.store.audit import newest_hash
from fullpose_server.store.database import Database
from fullpose_server.store.reading import reading
from tests.support.disks import fill, small_disk
from tests.support.flown import RUN, Flown, alarms, flown, samples, write_record

MEMBERS = {
    "record.mcap",
    "plan/plan.json",
    "plan/angles.npy",
    "plan/target.npy",
    "plan/error.npy",
    "flight/time.npy",
    "flight/q.npy",
    "flight/source.csv",
    "rig.toml",
    "rig.json",
    "alarms.json",
    "audit.jsonl",
    "report.pdf",
    "manifest.json",
    "signature.json",
}


@pytest.fixture
def run(tmp_path: Path) -> Flown:
    return flown(tmp_path / "data")


def made(run: Flown) -> tuple[Path, dict[str, Any]]:
    target = run.folder.parent / "bundle.zip"
    return target, make_bundle(run.folder, RUN, target)


def member(bundle: Path, name: str) -> bytes:
    with zipfile.ZipFile(bundle) as archive:
        return archive.read(name)


def text_of(pdf: bytes) -> str:
    document = pypdfium2.PdfDocument(pdf)
    assert len(document) == 1
    width, height = document[0].get_size()
    assert (round(width), round(height)) == (595, 842)  # A4
    text = document[0].get_textpage().get_text_range()
    document.close()
    return " ".join(str(text).split())


def test_everything_of_the_run_is_in_it(run: Flown) -> None:
    bundle, manifest = made(run)
    with zipfile.ZipFile(bundle) as archive:
        assert set(archive.namelist()) == MEMBERS
    assert manifest["missing"] == {}
    assert set(manifest["files"]) == MEMBERS - {"manifest.json", "signature.json"}
    assert member(bundle, "record.mcap") == run.record.read_bytes()
    assert member(bundle, "rig.toml") == (run.folder / "rigs" / "bench.toml").read_bytes()
    told = [json.loads(line) for line in member(bundle, "audit.jsonl").splitlines()]
    assert [line["command"] for line in told] == ["load", "arm", "start", "disarm"]  # the next load is another run's
    assert [alarm["code"] for alarm in json.loads(member(bundle, "alarms.json"))] == ["late"]
    with reading(run.folder / "fullpose.db") as session:
        assert manifest["audit"] == {"lines": 4, "newest_hash": newest_hash(session)}
    assert manifest["outcome"]["limits_kept"] is True
    assert manifest["outcome"]["sentence"] == (
        "Flown to its end; largest solve error 1e-12 deg; largest tracking error 0.002 deg; "
        "every limit of the rig was kept."
    )
    found = verify_bundle(bundle)
    assert (found.run, found.rig, found.trusted, len(found.fits)) == (RUN, "bench", False, 4)


def test_the_page_is_one_and_says_what_it_was(run: Flown) -> None:
    bundle, manifest = made(run)
    told = text_of(member(bundle, "report.pdf"))
    for expected in (
        RUN,
        "bench",
        "ann",
        "a flight",
        "every limit of the rig was kept",
        "late",
        "2027-01-15 08:00:00.000 UTC",
    ):
        assert expected in told, expected
    for hashed in (
        manifest["files"]["record.mcap"]["sha256"],
        manifest["plan"]["hash"],
        manifest["rig"]["hash"],
        manifest["flight"]["sha256"],
        manifest["audit"]["newest_hash"],
        public_key(signing_key(run.folder)),
    ):
        assert hashed in told


def test_the_same_run_gives_the_same_bytes_but_for_the_signature(run: Flown) -> None:
    first, _ = made(run)
    kept = first.read_bytes()
    again, _ = made(run)
    with zipfile.ZipFile(again) as archive:
        at = archive.getinfo("signature.json").header_offset
    assert kept[:at] == again.read_bytes()[:at]


@pytest.mark.parametrize(
    "message", ["x" * 3000, '#import "secret" *bold* $x$ @label', "‮\x1b[31m\x00\n\ttext", "</svg>&<script>"]
)
def test_no_words_of_others_change_the_page(run: Flown, message: str) -> None:
    database = Database(run.folder / "fullpose.db")
    AlarmHistory(database).write(alarms(40, message))
    database.close()
    bundle, manifest = made(run)
    assert manifest["alarms"] == 41
    told = text_of(member(bundle, "report.pdf"))
    assert "41 alarms, the first 6 here" in told
    assert len(json.loads(member(bundle, "alarms.json"))) == 41


def test_a_limit_that_was_not_kept_is_told(run: Flown) -> None:
    rows = read_samples(run.record)
    rows["demand_rate"][40:50, 2] = 1e4
    rows["demand"][60, 3] = -100.0
    run.record.unlink()
    bound = {"plan_id": "gone", "plan_hash": "0" * 64, "rig": "bench", "rig_hash": hash_of(run)}
    write_record(run.record, rows, bound, how="fault")
    bundle, manifest = made(run)
    outcome = manifest["outcome"]
    assert outcome["limits_kept"] is False
    found = [(one["frame"], one["limit"], one["value"], one["samples"]) for one in outcome["exceeded"]]
    assert found == [("middle", "max_rate_deg_s", 1e4, 10), ("inner", "min_deg", -100.0, 1)]
    assert "limits were exceeded: middle max_rate_deg_s 10000" in text_of(member(bundle, "report.pdf"))
    verify_bundle(bundle)


def hash_of(run: Flown) -> str:
    return rig_hash(run.rig)


def test_what_was_removed_or_changed_since_is_said(run: Flown) -> None:
    limits = replace(run.rig.frames[0], max_rate=1.0)
    (run.folder / "rigs" / "bench.toml").write_text(rig_toml(replace(run.rig, frames=(limits, *run.rig.frames[1:]))))
    plan = run.folder / "plans" / run.plan / "angles.npy"
    plan.write_bytes(plan.read_bytes()[:-8] + b"\0" * 8)
    bundle, manifest = made(run)
    assert set(manifest["missing"]) == {"rig", "plan", "flight"}
    assert "has been changed since" in manifest["missing"]["rig"]
    assert "angles: not as the plan was made" in manifest["missing"]["plan"]
    assert manifest["outcome"]["limits_kept"] is None
    found = verify_bundle(bundle)
    assert found.fits == ("the hashes of 4 lines of the audit",)
    shutil.rmtree(run.folder / "plans" / run.plan)
    assert "has been removed" in made(run)[1]["missing"]["plan"]


def test_an_incident_and_a_live_run_have_evidence_too(run: Flown) -> None:
    rows = samples(np.zeros((50, 4)))
    rows["flags"] = 0
    run.record.unlink()
    write_record(run.record, rows, {"live": True, "plan_id": "live", "rig_hash": hash_of(run)}, how="source_lost")
    bundle, manifest = made(run)
    assert manifest["missing"]["plan"] == "a live source was followed: there was no plan"
    assert manifest["outcome"]["sentence"].startswith("Ended as the live source was lost;")
    assert manifest["outcome"]["limits_kept"] is None  # nothing was commanded
    verify_bundle(bundle)
    run.record.unlink()
    write_record(run.record, rows[:1], {})
    assert verify_bundle(made(run)[0]).missing["rig"].startswith("nothing was loaded")


def test_a_record_that_was_cut_off_is_evidence_of_what_is_left(run: Flown) -> None:
    data = run.record.read_bytes()
    run.record.write_bytes(data[: len(data) - 200])
    os.utime(run.record, (1.0, 1.0))  # nobody writes it
    bundle, manifest = made(run)
    assert manifest["run"]["complete"] is False
    assert "the record was cut off or is damaged" in text_of(member(bundle, "report.pdf"))
    verify_bundle(bundle)


def test_what_there_is_no_evidence_of(run: Flown) -> None:
    target = run.folder.parent / "none.zip"
    for name in ("nothing", "../fullpose", "a/b"):
        with pytest.raises(NotFoundError):
            make_bundle(run.folder, name, target)
    data = run.record.read_bytes()
    run.record.write_bytes(data[: len(data) // 2])
    with pytest.raises(NoEvidenceError, match="is being written"):
        make_bundle(run.folder, RUN, target)
    run.record.write_bytes(data)
    (run.folder / "fullpose.db").unlink()
    with pytest.raises(FileError, match="database of a server"):
        make_bundle(run.folder, RUN, target)
    assert not target.exists()


def test_a_full_disk_leaves_nothing(run: Flown, tmp_path: Path) -> None:
    signing_key(run.folder)
    with small_disk(tmp_path / "disk", 1024) as disk:
        target = disk / "bundle.zip"
        target.write_bytes(b"of before")
        fill(disk)
        with pytest.raises(OSError, match="No space left"):
            make_bundle(run.folder, RUN, target)
        assert target.read_bytes() == b"of before"
        assert {path.name for path in disk.iterdir()} <= {"bundle.zip", "ballast", "one more"}


def test_the_key_is_the_server_s_alone_and_made_once(run: Flown) -> None:
    path = run.folder / EVIDENCE_KEY
    first = public_key(signing_key(run.folder))
    assert path.stat().st_mode & 0o777 == 0o600
    assert public_key(signing_key(run.folder)) == first
    assert [each.name for each in run.folder.glob(".*")] == []
    path.write_bytes(b"no key")
    with pytest.raises(FileError, match="Ed25519 key as PEM"):
        signing_key(run.folder)


def test_making_it_changes_nothing_else(run: Flown) -> None:
    def all_of() -> dict[str, bytes]:
        return {str(p.relative_to(run.folder)): p.read_bytes() for p in sorted(run.folder.rglob("*")) if p.is_file()}

    before = all_of()
    made(run)
    after = all_of()
    assert after.pop(EVIDENCE_KEY)
    assert after == before


def test_other_programs_can_read_it(run: Flown, tmp_path: Path) -> None:
    bundle, _ = made(run)
    if shutil.which("unzip") is not None:
        assert subprocess.run(["unzip", "-tq", bundle], capture_output=True, check=False).returncode == 0
    with zipfile.ZipFile(bundle) as archive:
        assert archive.testzip() is None


@pytest.mark.parametrize("name", builtin_rigs())
def test_rigs_that_come_with_fullpose(tmp_path: Path, name: str) -> None:
    """Also of three axes, whose hash has a frame in it that no file of theirs has."""
    run = flown(tmp_path / "data", rig=builtin_rigs()[name])
    bundle, manifest = made(run)
    assert manifest["missing"] == {}
    assert len(verify_bundle(bundle).fits) == 4
