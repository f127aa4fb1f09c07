"""Whether a datagram is of the source that was loaded: by its key, or by the address that was named with it.

The key is told once, where the source is loaded. A datagram by UDP ends with a code made with it (HMAC, RFC 2104), or
comes from the named address; one by the local socket, which the server hands on, ends with the digest of the key that
its client has shown to the server.
"""

import hashlib
import hmac
from typing import Any, NamedTuple

from fullpose_server.runtime.live.packets import SAMPLE_SIZE

CODE_SIZE = 16  # of SHA-256, truncated
DIGEST_SIZE = hashlib.sha256().digest_size
SIZES = frozenset({SAMPLE_SIZE, SAMPLE_SIZE + CODE_SIZE, SAMPLE_SIZE + DIGEST_SIZE})
LARGEST = max(SIZES)
_SEQUENCE = slice(8, 16)  # of a sample


class Address(NamedTuple):
    """Where a source sends from by UDP."""

    host: str
    port: int


def digest_of(key: str) -> bytes:
    """What the local socket carries of a key."""
    return hashlib.sha256(key.encode()).digest()


def coded(sample: bytes, key: str) -> bytes:
    """A sample as a source sends it by UDP that has the key."""
    return sample + hmac.digest(key.encode(), sample, "sha256")[:CODE_SIZE]


class Provenance:
    """What the samples of one loaded source prove themselves by; without key and address nothing does."""

    def __init__(self, key: str | None = None, address: Address | None = None) -> None:
        self._key = key
        self._digest = None if key is None else digest_of(key)
        self._address = address
        self._sequence = -1  # the greatest that was coded: what was heard once is heard no more

    def has(self, digest: bytes) -> bool:
        """Whether it is that of the key."""
        return self._digest is not None and hmac.compare_digest(digest, self._digest)

    def proves(self, datagram: bytes, sender: Any) -> bool:
        """Whether a datagram of one of `SIZES` is of the source. A coded one proves itself once."""
        ending = datagram[SAMPLE_SIZE:]
        if not isinstance(sender, tuple):  # by the local socket
            return self.has(ending)
        if not ending:
            return sender[:2] == self._address
        return self._is_coded(datagram[:SAMPLE_SIZE], ending)

    def _is_coded(self, sample: bytes, code: bytes) -> bool:
        if self._key is None or len(code) != CODE_SIZE:
            return False
        if not hmac.compare_digest(coded(sample, self._key)[SAMPLE_SIZE:], code):
            return False
        sequence = int.from_bytes(sample[_SEQUENCE], "little")
        if sequence <= self._sequence:
            return False
        self._sequence = sequence
        return True
