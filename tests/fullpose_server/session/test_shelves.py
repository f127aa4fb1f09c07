"""Shelving: a warning is kept out of sight for a time that ends; what brakes a rig is not."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fullpose_server.session.alarms import MAX_SHELF_S, MAX_SHELVES, AlarmBook, Severity, Shelf

WARNING, FAULT = Severity.WARNING, Severity.FAULT


def test_a_shelved_warning_is_history_and_does_not_stand_until_the_shelf_ends() -> None:
    book = AlarmBook().raised("late", WARNING, "", 0.0).shelve(Shelf("late", None, 1.0, 100.0, "anna"))
    assert book.standing == ()
    for time_s in (2.0, 3.0, 99.9):
        book = book.raised("late", WARNING, "", time_s)
    assert book.standing == ()
    assert [(a.shelved, a.count, a.time_s, a.last_time_s) for a in book.history] == [
        (False, 1, 0.0, None),
        (True, 3, 2.0, 99.9),
    ]
    back = book.ended(100.0).raised("late", WARNING, "", 100.0)
    assert [a.code for a in back.standing] == ["late"]
    assert back.shelves == ()
    assert book.ended(99.0) is book
    assert book.ended(0.9).shelves == ()  # the clock was set back behind its beginning: more alarms, never fewer


def test_a_shelf_is_of_one_frame_or_of_all() -> None:
    book = AlarmBook().shelve(Shelf("slow", "base", 0.0, 10.0, "anna"))
    assert book.raised("slow", WARNING, "", 1.0, frame="base").standing == ()
    assert len(book.raised("slow", WARNING, "", 1.0, frame="outer").standing) == 1
    every = book.shelve(Shelf("slow", None, 0.0, 10.0, "anna"))
    assert every.raised("slow", WARNING, "", 1.0, frame="outer").standing == ()
    assert len(every.unshelved("slow", None).raised("slow", WARNING, "", 1.0, frame="outer").standing) == 1


def test_what_brakes_a_rig_stands_on_any_shelf() -> None:
    book = AlarmBook().raised("late", FAULT, "", 0.0).shelve(Shelf("late", None, 0.0, 10.0, "anna"))
    assert len(book.standing) == 1
    assert len(book.raised("late", Severity.EMERGENCY, "", 1.0).standing) == 2


@pytest.mark.parametrize("lasts", [0.0, -1.0, MAX_SHELF_S * 1.001])
def test_a_shelf_has_an_end_in_sight(lasts: float) -> None:
    with pytest.raises(ValueError, match="expected above 0"):
        Shelf("late", None, 50.0, 50.0 + lasts, "anna")


def test_shelves_are_bounded_and_replaced() -> None:
    book = AlarmBook()
    for k in range(MAX_SHELVES + 1):
        book = book.shelve(Shelf(f"c{k}", None, 0.0, 10.0 + k, "anna"))
    assert [s.code for s in book.shelves] == [f"c{k}" for k in range(1, MAX_SHELVES + 1)]  # the first to end has gone
    again = book.shelve(Shelf("c3", None, 0.0, 20.0, "ben"))
    assert [s.by for s in again.shelves if s.code == "c3"] == ["ben"]
    later = Shelf("more", None, 1000.0, 1030.0, "anna")
    assert book.shelve(later).shelves == (later,)


@given(st.lists(st.tuples(st.sampled_from("ab"), st.sampled_from(list(Severity)), st.booleans()), max_size=40))
def test_nothing_that_is_raised_is_lost(raised: list[tuple[str, Severity, bool]]) -> None:
    """Counts add up to what was raised, shelved or not, acknowledged or not."""
    book = AlarmBook().shelve(Shelf("a", None, 0.0, 20.0, "anna"))
    for k, (code, severity, seen) in enumerate(raised):
        book = book.ended(float(k)).raised(code, severity, "", float(k))
        if seen:
            book = book.acknowledged("ben")
    assert sum(a.count for a in book.history) == len(raised)
    assert all(a.code != "a" or a.severity is not WARNING or a.time_s >= 20.0 for a in book.standing)
