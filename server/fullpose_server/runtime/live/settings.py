"""How a live source is flown: what `load` says of it."""

import hashlib
import ipaddress
from dataclasses import dataclass, field
from typing import Any

import msgspec

from fullpose_server.runtime.live.provenance import Address

_LAST_PORT = 65535


@dataclass(frozen=True)
class LiveSettings:
    """How a live source is flown: the step method and its options."""

    method: str = "exact"
    options: dict[str, Any] = field(default_factory=dict)
    first_sample_s: float = 5.0  # to wait for the source to begin
    udp_from: str | None = None  # address:port that the source sends from by UDP, without a key

    @property
    def hash(self) -> str:
        """sha-256 of the settings: what `arm` is held to."""
        content = [self.method, sorted(self.options.items()), self.first_sample_s, self.udp_from]
        return hashlib.sha256(msgspec.json.encode(content)).hexdigest()

    @property
    def address(self) -> Address | None:
        """Of `udp_from`. Raises `LiveError` where it is none."""
        if self.udp_from is None:
            return None
        host, _, port = self.udp_from.rpartition(":")
        try:
            address = Address(str(ipaddress.IPv4Address(host)), int(port))
            if not 0 < address.port <= _LAST_PORT:
                raise ValueError(address.port)
        except ValueError:
            expected = "expected an IPv4 address and a port, 127.0.0.1:7461"
            raise LiveError(f"udp_from {self.udp_from!r}: {expected}") from None
        return address


class LiveError(Exception):
    """Live settings that cannot be flown: which, and why."""
