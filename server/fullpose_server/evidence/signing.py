"""Who signs: an Ed25519 key of the data folder, made once; whoever can read it can sign as this server.

The signature is of the manifest, which has the hash of every other file, and of the time of signing.
"""

import json
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from uuid import uuid4

from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey

from fullpose_server.errors import FileError
from fullpose_server.formats import durable
from fullpose_server.location import EVIDENCE_KEY

FORMAT = 1
ALGORITHM = "Ed25519"
_SIGNED = b"fullpose.evidence/1\n"  # so that it is the signature of nothing else
_RAW = serialization.Encoding.Raw, serialization.PublicFormat.Raw
_PUBLIC = re.compile(r"[0-9a-f]{64}")


class SignatureError(Exception):
    """A signature that does not hold: why."""


def signing_key(folder: Path) -> Ed25519PrivateKey:
    """The key of a data folder, made where there is none. Raises `FileError` where its file is no key."""
    path = folder / EVIDENCE_KEY
    if not path.exists():
        _make(path)
    try:
        key = serialization.load_pem_private_key(path.read_bytes(), password=None)
    except ValueError:
        raise FileError(
            str(path), "an Ed25519 key as PEM (put a backup in its place, or remove it: one is made)"
        ) from None
    if not isinstance(key, Ed25519PrivateKey):
        raise FileError(str(path), "an Ed25519 key, this is another kind")
    return key


def public_key(key: Ed25519PrivateKey) -> str:
    """By which others verify: 64 hexadecimal digits."""
    return key.public_key().public_bytes(*_RAW).hex()


def read_public_key(text: str) -> str:
    """A public key as it was given: its digits, or the path of a file with them. Raises `FileError`."""
    given = text.strip().lower()
    if _PUBLIC.fullmatch(given):
        return given
    try:
        given = Path(text).read_text("ascii").strip().lower()
    except (OSError, UnicodeDecodeError, ValueError):
        given = ""
    if not _PUBLIC.fullmatch(given):
        raise FileError(
            text, "a public key, 64 hexadecimal digits as `fullpose evidence key` prints, or a file of them"
        )
    return given


def signature(key: Ed25519PrivateKey, manifest: bytes, signed_at: str) -> bytes:
    """The signature's file."""
    signed = key.sign(_message(manifest, signed_at)).hex()
    return _encoded({"public_key": public_key(key), "signed_at": signed_at, "signature": signed})


def check_signature(document: bytes, manifest: bytes) -> tuple[str, str]:
    """(public key, time of signing) of a signature that holds. Raises `SignatureError`."""
    try:
        found: dict[str, Any] = json.loads(document)
        told = {name: str(found[name]) for name in ("public_key", "signed_at", "signature")}
    except (ValueError, TypeError, KeyError, RecursionError):
        raise SignatureError("the signature is damaged") from None
    if _encoded(told) != document:
        raise SignatureError("the signature is not as it was written")
    try:
        key = Ed25519PublicKey.from_public_bytes(bytes.fromhex(told["public_key"]))
        key.verify(bytes.fromhex(told["signature"]), _message(manifest, told["signed_at"]))
    except (InvalidSignature, ValueError):
        raise SignatureError("the signature is not of this manifest: one or the other was changed") from None
    return told["public_key"], told["signed_at"]


def _message(manifest: bytes, signed_at: str) -> bytes:
    return _SIGNED + signed_at.encode() + b"\n" + manifest


def _encoded(told: Mapping[str, str]) -> bytes:
    document = {"format": FORMAT, "algorithm": ALGORITHM, **told}
    return (json.dumps(document, indent=1) + "\n").encode()


def _make(path: Path) -> None:
    """Make a key that only the server's user can read; where another program makes one meanwhile, that one stays."""
    pem = Ed25519PrivateKey.generate().private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    draft = path.with_name(f".{path.name}.{uuid4().hex}")
    descriptor = os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(pem)
        if os.geteuid() == 0:  # made by root for a server of another user, which could not read it
            owner = path.parent.stat()
            os.chown(draft, owner.st_uid, owner.st_gid)
        durable.sync(draft)
        try:
            os.link(draft, path)
        except FileExistsError:
            return
        durable.sync(path.parent)
    finally:
        draft.unlink(missing_ok=True)
