"""Whatever is done to a bundle is found: any bit, any file, any name; and a bundle of another signer is told apart."""

import hashlib
import io
import json
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from fullpose_server.cli import build
from fullpose_server.evidence.archive import ArchiveWriter
from fullpose_server.evidence.bundle import make_bundle
from fullpose_server.evidence.errors import BundleError
from fullpose_server.evidence.signing import public_key, signature, signing_key
from fullpose_server.evidence.verification import verify_bundle
from tests.support.flown import RUN, flown

MANY = settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("flown") / "data"
    flown(folder, seconds=0.1)
    return folder


@pytest.fixture(scope="module")
def bundle(data: Path) -> bytes:
    target = data.parent / "bundle.zip"
    make_bundle(data, RUN, target)
    verify_bundle(target)
    return target.read_bytes()


def refused(path: Path, content: bytes) -> str:
    path.write_bytes(content)
    with pytest.raises(BundleError) as told:
        verify_bundle(path)
    assert "\n" not in str(told.value)
    return told.value.problem


def members(bundle: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(bundle)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def again(path: Path, files: dict[str, bytes]) -> bytes:
    """A bundle of these files, laid out as one is."""
    with ArchiveWriter(path) as archive:
        for name, content in files.items():
            archive.add(name, content)
    return path.read_bytes()


@MANY
@given(at=st.floats(0.0, 1.0, exclude_max=True), bit=st.integers(0, 7))
def test_any_bit_of_the_file(bundle: bytes, tmp_path: Path, at: float, bit: int) -> None:
    place = int(at * len(bundle))
    refused(tmp_path / "b.zip", bundle[:place] + bytes([bundle[place] ^ 1 << bit]) + bundle[place + 1 :])


@MANY
@given(data=st.data())
def test_any_bit_of_any_member_and_of_every_header(bundle: bytes, tmp_path: Path, data: st.DataObject) -> None:
    """Small members and what is between them as often as large ones."""
    with zipfile.ZipFile(io.BytesIO(bundle)) as archive:
        infos = archive.infolist()
    places = [info.header_offset for info in infos] + [archive.start_dir, len(bundle)]
    number = data.draw(st.integers(0, len(places) - 2))
    at = data.draw(st.integers(places[number], places[number + 1] - 1))
    flipped = bundle[:at] + bytes([bundle[at] ^ 1 << data.draw(st.integers(0, 7))]) + bundle[at + 1 :]
    refused(tmp_path / "b.zip", flipped)


@MANY
@given(at=st.floats(0.0, 1.0, exclude_max=True), name=st.integers(0, 100))
def test_a_member_that_was_changed_and_laid_out_anew(bundle: bytes, tmp_path: Path, at: float, name: int) -> None:
    """With checksums of the zip's own that fit: only the signed hashes can tell."""
    files = members(bundle)
    chosen = list(files)[name % len(files)]
    content = files[chosen]
    place = int(at * len(content))
    files[chosen] = content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :]
    refused(tmp_path / "c.zip", again(tmp_path / "b.zip", files))


@MANY
@given(cut=st.floats(0.0, 1.0, exclude_max=True))
def test_a_file_that_was_cut_off(bundle: bytes, tmp_path: Path, cut: float) -> None:
    refused(tmp_path / "b.zip", bundle[: int(cut * len(bundle))])


@pytest.mark.parametrize("name", ["alarms.json", "record.mcap", "plan/angles.npy", "manifest.json", "signature.json"])
def test_a_missing_file(bundle: bytes, tmp_path: Path, name: str) -> None:
    files = members(bundle)
    del files[name]
    assert name in refused(tmp_path / "c.zip", again(tmp_path / "b.zip", files))


@pytest.mark.parametrize("name", ["more.txt", "../../etc/passwd", "/etc/passwd", "plan/../x", "C:\\x", "a/b/c", "."])
def test_a_file_too_many(bundle: bytes, tmp_path: Path, name: str) -> None:
    told = refused(tmp_path / "c.zip", again(tmp_path / "b.zip", members(bundle) | {name: b"x"}))
    assert "not the name of a file" in told or "not in the manifest: more.txt" in told
    assert sorted(path.name for path in tmp_path.iterdir()) == ["b.zip", "c.zip"]


def test_a_file_twice(bundle: bytes, tmp_path: Path) -> None:
    with ArchiveWriter(tmp_path / "b.zip") as archive:
        for name, content in members(bundle).items():
            archive.add(name, content)
        with pytest.warns(UserWarning, match="Duplicate"):
            archive.add("alarms.json", b"[]")
    assert refused(tmp_path / "c.zip", (tmp_path / "b.zip").read_bytes()) == "two files of one name"


def test_what_unpacks_to_more_than_it_is(bundle: bytes, tmp_path: Path) -> None:
    path = tmp_path / "bomb.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, content in members(bundle).items():
            archive.writestr(name, content if name != "alarms.json" else bytes(50 << 20))
    assert "compressed" in refused(path, path.read_bytes())


def test_sizes_that_are_not_there(bundle: bytes, tmp_path: Path) -> None:
    """A directory that says that a member has four gigabytes, or starts elsewhere."""
    at = bundle.rindex(b"PK\x01\x02")
    for offset, value in ((20, 2**32 - 2), (24, 2**32 - 2), (42, 7)):
        refused(tmp_path / "b.zip", bundle[: at + offset] + struct.pack("<L", value) + bundle[at + offset + 4 :])


@pytest.mark.parametrize("content", [b"", b"PK\x05\x06" + bytes(18), b"no zip", b"PK" * 100])
def test_what_is_no_bundle(tmp_path: Path, content: bytes) -> None:
    refused(tmp_path / "b.zip", content)


def test_what_is_before_and_after(bundle: bytes, tmp_path: Path) -> None:
    for content in (b"#!/bin/sh\n" + bundle, bundle + b"\0", bundle + bundle):
        refused(tmp_path / "b.zip", content)


def signed(files: dict[str, bytes], manifest: Any, key: Ed25519PrivateKey) -> dict[str, bytes]:
    """The files with a manifest of somebody's own, which names them as they are."""
    rest = {name: each for name, each in files.items() if name not in ("manifest.json", "signature.json")}
    if isinstance(manifest, dict):
        listed = {name: {"size": len(c), "sha256": hashlib.sha256(c).hexdigest()} for name, c in rest.items()}
        manifest = manifest | {"files": listed}
    document = manifest if isinstance(manifest, bytes) else json.dumps(manifest).encode()
    return {**rest, "manifest.json": document, "signature.json": signature(key, document, "2027-01-01T00:00:00Z")}


def test_another_signer_is_told_apart(data: Path, bundle: bytes, tmp_path: Path) -> None:
    """Anybody can sign what he likes with a key of his own: that it is his is all that it proves."""
    files, key = members(bundle), Ed25519PrivateKey.generate()
    manifest = json.loads(files["manifest.json"])
    manifest["outcome"]["sentence"] = "All was well."
    path = tmp_path / "b.zip"
    again(path, signed(files, manifest, key))
    found = verify_bundle(path)
    assert (found.public_key, found.trusted, found.sentence) == (public_key(key), False, "All was well.")
    ours = public_key(signing_key(data))
    with pytest.raises(BundleError, match=f"signed with the key {public_key(key)}, not with {ours}"):
        verify_bundle(path, ours)
    assert verify_bundle(path, public_key(key)).trusted


FORGERIES: dict[str, tuple[str, Callable[[bytes], bytes]]] = {
    "plan": ("plan/angles.npy", lambda content: content[:-1] + bytes([content[-1] ^ 1])),
    "plan's facts": ("plan/plan.json", lambda content: content.replace(b'"feasible": true', b'"feasible": false')),
    "flight": ("flight/q.npy", lambda content: content[:-1] + bytes([content[-1] ^ 1])),
    "rig": ("rig.toml", lambda content: content.replace(b"max_rate_deg_s = ", b"max_rate_deg_s = 1")),
    "rig's values": ("rig.json", lambda content: content.replace(b'"weight": 1.0', b'"weight": 2.0', 1)),
    "rig's values that are none": ("rig.json", lambda _: b'{"name": "x", "geometry": "y", "frames": {}}'),
    "rig that is none": ("rig.toml", lambda _: b"\xff"),
    "audit": ("audit.jsonl", lambda content: content.replace(b'"who": "ann"', b'"who": "bob"', 1)),
    "audit without a line": ("audit.jsonl", lambda content: b"".join(content.splitlines(True)[::2]) + content),
    "audit that is none": ("audit.jsonl", lambda _: b"[" * 100_000),
}


@pytest.mark.parametrize("what", FORGERIES)
def test_parts_that_do_not_fit_each_other_are_found_whoever_signed(bundle: bytes, tmp_path: Path, what: str) -> None:
    files = members(bundle)
    name, forge = FORGERIES[what]
    changed = forge(files[name])
    assert changed != files[name]
    manifest = json.loads(files["manifest.json"])
    content = again(tmp_path / "b.zip", signed(files | {name: changed}, manifest, Ed25519PrivateKey.generate()))
    refused(tmp_path / "c.zip", content)


@pytest.mark.parametrize(
    "manifest",
    [b"", b"[]", b"{", b"[" * 100_000, b"\xff", {"format": 2}, {"format": 1}, {"format": 1, "run": 3}, {"format": []}],
    ids=str,
)
def test_manifests_that_are_none(bundle: bytes, tmp_path: Path, manifest: Any) -> None:
    key = Ed25519PrivateKey.generate()
    refused(tmp_path / "c.zip", again(tmp_path / "b.zip", signed(members(bundle), manifest, key)))


@pytest.mark.parametrize("field", ["plan", "flight", "rig", "missing", "outcome", "run", "files"])
@pytest.mark.parametrize("value", [None, 3, [], {}, {"samples": 10**15}])
def test_fields_of_another_kind(bundle: bytes, tmp_path: Path, field: str, value: Any) -> None:
    """One clear refusal, or nothing is wrong with it; never a traceback."""
    files, key = members(bundle), Ed25519PrivateKey.generate()
    manifest = json.loads(files["manifest.json"]) | {field: value}
    document = json.dumps(manifest).encode()
    again(tmp_path / "b.zip", files | {"manifest.json": document, "signature.json": signature(key, document, "now")})
    try:
        verify_bundle(tmp_path / "b.zip")
    except BundleError:
        return
    assert field == "missing"
    assert isinstance(value, dict)


def test_the_command_line(data: Path, tmp_path: Path) -> None:
    def call(*arguments: str) -> tuple[int, str, BaseException | None]:
        done = CliRunner().invoke(build(), ["evidence", *arguments])
        return done.exit_code, done.output, done.exception

    out = tmp_path / "f.zip"
    status, told, _ = call(RUN, "--data-dir", str(data), "--out", str(out))
    assert (status, told.splitlines()[0]) == (0, str(out))
    assert call("run", "latest", "--data-dir", str(data), "--out", str(out))[0] == 0
    assert call("--data-dir", str(data), "--out", str(out), RUN)[0] == 0
    status, told, _ = call("verify", str(out))
    assert status == 0
    assert "Whose key that is, is the bundle's own word" in told
    status, key, _ = call("key", "--data-dir", str(data))
    status, told, _ = call("verify", str(out), "--key", key.strip())
    assert (status, "the key that was asked for" in told) == (0, True)
    (tmp_path / "key").write_text(key)
    assert call("verify", str(out), "--key", str(tmp_path / "key"))[0] == 0
    other = key.strip()[::-1]
    assert isinstance(call("verify", str(out), "--key", other)[2], BundleError)
    assert "64 hexadecimal digits" in str(call("verify", str(out), "--key", "nonsense")[2])
    assert "there is no such data folder" in call("key", "--data-dir", str(tmp_path / "none"))[1]
