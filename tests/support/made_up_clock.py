"""A clock that a test moves: it sleeps exactly, and can be held up by `now += ...`."""


class MadeUpClock:
    """As `fullpose_server.runtime.loop.clock.Clock`; `now` in [ns]."""

    def __init__(self) -> None:
        self.now = 1_000_000_000_000

    def monotonic_ns(self) -> int:
        return self.now

    def wall_ns(self) -> int:
        return 1_700_000_000_000_000_000 + self.now

    def sleep(self, seconds: float) -> None:
        self.now += round(seconds * 1e9)
