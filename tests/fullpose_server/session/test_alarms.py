"""Alarms: first-out, counting, acknowledging, history."""

from fullpose_server.session.alarms import HISTORY, AlarmBook, Severity


def test_the_first_fault_of_a_chain_is_marked_and_warnings_are_not() -> None:
    book = AlarmBook().raised("slow", Severity.WARNING, "", 0.0)
    book = book.raised("cause", Severity.FAULT, "", 1.0, frame="base", value=3.0, limit=2.0, unit="deg")
    book = book.raised("effect", Severity.EMERGENCY, "", 2.0)
    assert [(a.code, a.first) for a in book.standing] == [("slow", False), ("cause", True), ("effect", False)]


def test_a_chain_after_the_link_was_made_anew_has_a_first_of_its_own() -> None:
    lost = AlarmBook().raised("link_lost", Severity.FAULT, "", 0.0)
    book = lost.first_awaited().raised("drive_failed", Severity.FAULT, "", 1.0).raised("late", Severity.FAULT, "", 2.0)
    assert [(a.code, a.first) for a in book.standing] == [("link_lost", True), ("drive_failed", True), ("late", False)]
    again = AlarmBook().raised("a", Severity.FAULT, "", 0.0).raised("b", Severity.FAULT, "", 0.0)
    again = again.first_awaited().raised("b", Severity.FAULT, "", 1.0).raised("a", Severity.FAULT, "", 1.0)
    assert [(a.code, a.count, a.first) for a in again.standing] == [("a", 2, True), ("b", 2, True)]


def test_the_same_again_only_counts() -> None:
    book = AlarmBook().raised("a", Severity.FAULT, "", 0.0, frame="base").raised("a", Severity.FAULT, "", 1.0, "base")
    assert [(a.count, a.time_s, a.last_time_s) for a in book.standing] == [(2, 0.0, 1.0)]
    assert book.history == book.standing
    assert len(book.raised("a", Severity.FAULT, "", 1.0, frame="outer").standing) == 2
    # A warning that turns into a fault is a new alarm: it latches.
    warned = AlarmBook().raised("a", Severity.WARNING, "", 0.0).raised("a", Severity.FAULT, "", 1.0)
    assert [a.first for a in warned.standing] == [False, True]


def test_acknowledged_warnings_leave_and_faults_wait_for_the_reset() -> None:
    book = AlarmBook().raised("w", Severity.WARNING, "", 0.0).raised("f", Severity.FAULT, "", 0.0)
    seen = book.acknowledged("anna")
    assert [a.code for a in seen.standing] == ["f"]
    assert seen.unacknowledged == ()
    assert [a.acknowledged_by for a in seen.history] == ["anna", "anna"]
    assert seen.cleared().standing == ()
    assert book.cleared().standing == book.standing  # what nobody saw stays


def test_an_alarm_after_its_acknowledgement_is_a_new_one() -> None:
    book = AlarmBook().raised("f", Severity.FAULT, "", 0.0).acknowledged("anna").raised("f", Severity.FAULT, "", 9.0)
    assert len(book.standing) == 2
    assert len(book.unacknowledged) == 1


def test_history_is_bounded() -> None:
    book = AlarmBook()
    for n in range(HISTORY + 10):
        book = book.raised(f"c{n}", Severity.WARNING, "", float(n)).acknowledged("anna")
    assert len(book.history) == HISTORY
    assert book.history[-1].code == f"c{HISTORY + 9}"
