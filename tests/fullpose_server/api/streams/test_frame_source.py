"""What the clients of a stream share: one reading for many, and turns."""

import asyncio

import numpy as np

from fullpose_server.api.streams.frame_source import AT_ONCE, SESSION_FRESH_S, FrameSource, RoundRobin
from fullpose_server.runtime.contract.telemetry import SAMPLE, Samples


class Ticking:
    """A source with a newer sample at every look."""

    def __init__(self) -> None:
        self.looks = 0

    def latest(self) -> Samples | None:
        self.looks += 1
        rows = np.zeros(1, SAMPLE)
        rows["seq"] = self.looks
        rows["margin"] = np.nan
        return rows

    def samples(self, since_seq: int, limit: int) -> tuple[Samples, int]:
        raise AssertionError(f"only the newest was asked for, not {limit} after {since_seq}")


def test_clients_within_a_moment_share_a_reading_and_nobody_gets_one_twice() -> None:
    now = 0.0
    ticking = Ticking()
    source = FrameSource(ticking, fresh_s=0.004, clock=lambda: now)
    first = source.newest("json", 0)
    assert first is not None
    assert source.newest("json", 0) is not None
    assert source.newest("binary", 0) == (1, ticking_bytes(1))
    assert ticking.looks == 1
    assert b'"margin":[null]' in first[1]
    again = source.newest("json", first[0])  # who has had it is given a newer one
    assert again is not None
    assert again[0] == 2
    now = 0.004
    later = source.newest("json", 0)
    assert later is not None
    assert later[0] == 3


def test_a_session_is_encoded_once_for_many_and_anew_when_it_changes() -> None:
    now = 0.0
    made: list[int] = []

    def make(revision: int) -> str:
        made.append(revision)
        return f"message {len(made)}"

    source = FrameSource(Ticking(), clock=lambda: now)
    assert [source.session(7, make) for _ in range(3)] == ["message 1"] * 3
    assert source.session(8, make) == "message 2"
    now = SESSION_FRESH_S
    assert source.session(8, make) == "message 3"  # of the same revision: lease and health go on
    assert made == [7, 8, 8]


def ticking_bytes(seq: int) -> bytes:
    rows = np.zeros(1, SAMPLE)
    rows["seq"] = seq
    rows["margin"] = np.nan
    return rows.tobytes()


def test_a_request_waits_for_a_few_clients_and_not_for_all() -> None:
    async def crowd() -> None:
        turns = RoundRobin()
        served: list[int] = []

        async def client(number: int) -> None:
            await turns.turn()
            served.append(number)

        clients = [asyncio.create_task(client(n)) for n in range(50)]
        clients[3].cancel()
        rounds = []
        while len(served) < 49:
            before = len(served)
            await asyncio.sleep(0)  # one round of the loop
            rounds.append(len(served) - before)
        assert max(rounds) <= AT_ONCE
        assert served == [n for n in range(50) if n != 3]

    asyncio.run(crowd())
