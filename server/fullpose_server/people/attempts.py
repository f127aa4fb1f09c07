"""How often somebody may try to sign in: by name and address, by address, and by name from wherever it comes."""

import ipaddress
import time

from limits import RateLimitItemPerHour, RateLimitItemPerMinute, storage, strategies

# So many names are told apart, or a flood of made-up ones would fill the memory; a flood as fast as hashes are made
# comes to some ten for each in an hour. Which share one, nobody outside can tell: Python's hash differs each time.
_NAMES = 16_384
_OWN_NETWORK = 64  # bits of an IPv6 address that are one subscriber's
# From one address: a person who mistypes goes on, one who tries words does not.
_ONE = RateLimitItemPerMinute(5)
_ADDRESS = RateLimitItemPerMinute(30)
# One name from everywhere. It can shut a person out for a while: never from a session that is open, nor a token.
_NAME = RateLimitItemPerHour(60)


class Attempts:
    """In memory: a server that starts anew has forgotten them."""

    def __init__(self) -> None:
        self._window = strategies.MovingWindowRateLimiter(storage.MemoryStorage())

    def begin(self, name: str, address: str) -> int:
        """One more try of this name from this address: 0, or how long to wait instead [s].

        It counts before its outcome is known, or a hundred at once would all be tried.
        """
        keys = _keys(name, address)
        waits = [
            self._window.get_window_stats(limit, *key).reset_time - time.time()
            for limit, key in keys
            if not self._window.test(limit, *key)
        ]
        if waits:
            return max(1, int(max(waits)) + 1)
        for limit, key in keys:
            self._window.hit(limit, *key)
        return 0

    def succeeded(self, name: str, address: str) -> None:
        """Who knows the password may have mistyped it before."""
        self._window.clear(_ONE, *_keys(name, address)[0][1])


def _keys(name: str, address: str) -> list[tuple[RateLimitItemPerMinute | RateLimitItemPerHour, tuple[str, ...]]]:
    known, address = name.casefold(), _subscriber(address)
    some = str(hash(known) % _NAMES)
    return [(_ONE, ("one", known, address)), (_ADDRESS, ("address", address)), (_NAME, ("name", some))]


def _subscriber(address: str) -> str:
    """Who has 2^64 addresses is one all the same. What a proxy tells need not be an address."""
    try:
        known = ipaddress.ip_address(address)
    except ValueError:
        return address[:64]
    if known.version == 4:
        return str(known)
    return str(ipaddress.ip_network((known, _OWN_NETWORK), strict=False))
