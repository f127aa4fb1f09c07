"""Maps of plans that were asked for lately, by a plan's hash, which covers all of it, and the size of the map."""

from collections import OrderedDict


class Planes:
    """Bodies of answers, the ones asked for last; `most` bytes of them in all. Use it from one event loop."""

    def __init__(self, most: int = 16 * 1024 * 1024) -> None:
        self._most = most
        self._kept: OrderedDict[str, bytes] = OrderedDict()
        self._bytes = 0

    def get(self, key: str) -> bytes | None:
        """The body, None where it is not kept."""
        body = self._kept.get(key)
        if body is not None:
            self._kept.move_to_end(key)
        return body

    def put(self, key: str, body: bytes) -> None:
        """Keep a body; those that were not asked for the longest go."""
        self._bytes += len(body) - len(self._kept.pop(key, b""))
        self._kept[key] = body
        while self._bytes > self._most:
            _, gone = self._kept.popitem(last=False)
            self._bytes -= len(gone)
