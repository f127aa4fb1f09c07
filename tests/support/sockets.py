"""WebSockets of tests: no proxy, any size, and the patience of `waiting`, for a slow machine is no failure."""

from typing import Any

from websockets.sync import client
from websockets.sync.client import ClientConnection

PATIENCE_S = 120.0


def connect(url: str, **options: Any) -> ClientConnection:
    """A connection; `options` as websockets has them."""
    return client.connect(url, **({"proxy": None, "max_size": None, "open_timeout": PATIENCE_S} | options))
