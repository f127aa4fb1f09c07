"""A gate that hangs is told from one that the machine keeps from running."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fullpose_server.gate.hanging import BLOCKED, SPINS_S, Looks, Thread

STATES = st.sampled_from("RSDTtZ")


@pytest.mark.parametrize(
    ("state", "per_look_s", "hangs"),
    [
        ("S", 0.0, True),  # in a call that does not return
        ("R", 0.05, True),  # in a loop of its own
        ("R", 0.0, False),  # starved: it would run and cannot
        ("D", 0.0, False),  # the disk is slow, or memory is read back from it
        ("T", 0.0, False),  # suspended: it is woken
    ],
)
def test_it_hangs_where_it_waits_or_computes_and_its_loop_does_not_run(
    state: str, per_look_s: float, *, hangs: bool
) -> None:
    looks = Looks()
    found = [looks.hangs(1, Thread(state, per_look_s * k)) for k in range(100)]
    assert any(found) == hangs


@given(st.lists(st.tuples(STATES, st.floats(0.0, SPINS_S / 2.0)), max_size=60))
def test_one_whose_loop_runs_between_looks_never_hangs(seen: list[tuple[str, float]]) -> None:
    looks, used_s = Looks(), 0.0
    for beat, (state, more_s) in enumerate(seen, 1):
        used_s += more_s
        assert looks.hangs(beat, Thread(state, used_s)) is None


@given(st.lists(st.tuples(STATES, st.floats(0.0, 10.0)), max_size=60))
def test_one_that_has_not_begun_is_waited_for(seen: list[tuple[str, float]]) -> None:
    looks, used_s = Looks(), 0.0
    for state, more_s in seen:
        used_s += more_s
        assert looks.hangs(0, Thread(state, used_s)) is None


@given(st.lists(st.integers(0, BLOCKED - 1), max_size=20))
def test_it_has_so_many_looks_anew_after_each_sign_of_life(asleep: list[int]) -> None:
    looks = Looks()
    for beat, times in enumerate(asleep, 1):
        for _ in range(times + 1):
            assert looks.hangs(beat, Thread("S", 0.0)) is None
