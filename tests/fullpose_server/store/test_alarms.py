"""The alarm history: one row an alarm over all restarts, pages, filters, retention, and a database that is locked."""

from collections.abc import Iterator
from dataclasses import replace

import pytest

from fullpose_server.location import Location
from fullpose_server.session.alarms import Alarm, AlarmBook, Severity, Shelf
from fullpose_server.store.alarm_trail import AlarmTrail
from fullpose_server.store.alarms import AlarmFilter, AlarmHistory, RaisedAlarm, RigShelves, alarm_id
from fullpose_server.store.database import Database
from fullpose_server.store.keyset import Key
from tests.support.locked import held
from tests.support.waiting import until

EVERYTHING = AlarmFilter()
DAY_S = 86_400.0


@pytest.fixture
def database(location: Location) -> Iterator[Database]:
    made = Database(location, busy_s=0.05)
    yield made
    made.close()


@pytest.fixture
def history(database: Database) -> AlarmHistory:
    return AlarmHistory(database)


def alarm(number: int, time_s: float, **changes: object) -> Alarm:
    plain = Alarm(number, "late", Severity.WARNING, "late by 3 ms", time_s, "base", 3.0, 2.0, "ms")
    return replace(plain, **changes)  # type: ignore[arg-type]


def ids(history: AlarmHistory, wanted: AlarmFilter = EVERYTHING, before: Key | None = None) -> list[str]:
    return [row.id for row in history.all(wanted, before, 100)]


def test_an_alarm_that_changes_is_one_row_and_another_life_s_number_is_another(history: AlarmHistory) -> None:
    book = AlarmBook().raised("late", Severity.FAULT, "late", 10.0, "base", 3.0, 2.0, "ms")
    history.write([RaisedAlarm("one", "a", book.standing[0])])
    book = book.raised("late", Severity.FAULT, "late", 20.0, "base").acknowledged("anna", None, 30.0)
    history.write([RaisedAlarm("one", "a", book.standing[0]), RaisedAlarm("one", "b", alarm(1, 40.0))])
    newer, older = history.all(EVERYTHING, None, 10)
    assert newer.id == alarm_id("b", 1)
    assert (older.count, older.time_s, older.last_time_s) == (2, 10.0, 20.0)
    assert (older.acknowledged_by, older.acknowledged_s, older.first) == ("anna", 30.0, True)
    assert (older.frame, older.value, older.limit, older.unit) == ("base", 3.0, 2.0, "ms")


def test_filters_and_pages(history: AlarmHistory) -> None:
    history.write(
        [
            RaisedAlarm("one", "a", alarm(1, 10.0)),
            RaisedAlarm("two", "b", alarm(1, 10.0, severity=Severity.FAULT)),
            RaisedAlarm("one", "a", alarm(2, 30.0, code="stale")),
        ]
    )
    assert ids(history) == ["a-2", "b-1", "a-1"]
    assert ids(history, before=Key(10.0, "b-1")) == ["a-1"]
    assert ids(history, AlarmFilter(rig="one")) == ["a-2", "a-1"]
    assert ids(history, AlarmFilter(severity="fault")) == ["b-1"]
    assert ids(history, AlarmFilter(code="stale")) == ["a-2"]
    assert ids(history, AlarmFilter(since_s=10.0, until_s=30.0)) == ["b-1", "a-1"]
    assert ids(history, AlarmFilter(ids={"a-1", "a-2"}, rig="one", until_s=20.0)) == ["a-1"]
    assert ids(history, AlarmFilter(but={"a-1", "b-1"})) == ["a-2"]


def test_retention_by_age_and_by_number(history: AlarmHistory) -> None:
    history.write([RaisedAlarm("one", "a", alarm(number, number * DAY_S)) for number in range(1, 11)])
    assert history.sweep(None, None, 10 * DAY_S) == 0
    assert history.sweep(4.5, None, 10 * DAY_S) == 5
    assert history.sweep(4.5, 2, 10 * DAY_S) == 3
    assert ids(history) == ["a-10", "a-9"]
    assert history.sweep(None, 2, 10 * DAY_S) == 0


def test_shelves_of_a_rig_are_those_told_last_until_their_end(history: AlarmHistory) -> None:
    long, short = Shelf("late", None, 0.0, 100.0, "anna", "known"), Shelf("stale", "base", 0.0, 50.0, "anna")
    history.write([RigShelves("one", (long, short)), RigShelves("two", (short,))])
    assert history.shelves("one", 10.0) == (long, short)
    assert history.shelves("one", 60.0) == (long,)
    history.write([RigShelves("one", (short,))])
    assert history.shelves("one", 10.0) == (short,)
    assert history.shelves("two", 10.0) == (short,)


def test_a_locked_database_loses_no_alarm_and_the_last_of_each_is_written(
    location: Location, history: AlarmHistory
) -> None:
    trail = AlarmTrail(history)
    with held(location):
        _told_while_it_is_locked(trail)
    assert trail.written(60.0)
    assert trail.faults() == []
    trail.close()
    assert [(row.id, row.count) for row in history.all(EVERYTHING, None, 10)] == [("a-2", 1), ("a-1", 7)]


def _told_while_it_is_locked(trail: AlarmTrail) -> None:
    trail.raised("one", "a", [alarm(1, 1.0), alarm(2, 2.0)])
    trail.shelved("one", [])
    trail.raised("one", "a", [alarm(1, 1.0, count=7)])
    told = until(trail.faults)
    assert "3 lines wait to be written to the alarm history" in told[0]
