"""The lease, apart from the machine."""

import pytest

from fullpose_server.session.errors import LeaseError
from fullpose_server.session.lease import LeaseBook, LeaseToken

EMPTY = LeaseBook(silent_s=5.0)


def refusal(call: object, *arguments: object) -> str:
    with pytest.raises(LeaseError) as refused:
        call(*arguments)  # type: ignore[operator]
    return refused.value.code


def test_every_change_of_hands_is_a_new_epoch() -> None:
    anna = EMPTY.take("anna", 0.0)
    assert anna.take("anna", 1.0).epoch == anna.epoch
    bert = anna.take("bert", 1.0, force=True)
    assert bert.epoch == anna.epoch + 1
    assert bert.release("bert", 2.0).epoch == bert.epoch + 1


def test_a_lease_in_use_is_taken_only_by_force_or_from_the_silent() -> None:
    anna = EMPTY.take("anna", 0.0)
    assert refusal(anna.take, "bert", 4.9) == "lease_held"
    assert anna.take("bert", 5.1).holder == "bert"
    assert anna.renew("anna", 4.0).holder == "anna"
    assert refusal(anna.renew("anna", 4.0).take, "bert", 8.9) == "lease_held"


def test_a_request_is_granted_to_who_asked() -> None:
    anna = EMPTY.take("anna", 0.0)
    assert refusal(anna.grant, "anna", 0.0) == "lease_not_requested"
    asked = anna.request("bert").request("carl").request("bert")
    assert asked.requested_by == ("bert", "carl")
    assert asked.grant("anna", 1.0).holder == "bert"
    granted = asked.grant("anna", 1.0, "carl")
    assert (granted.holder, granted.requested_by) == ("carl", ("bert",))
    assert refusal(asked.grant, "bert", 1.0) == "lease_lost"
    assert refusal(EMPTY.request, "bert") == "lease_free"


def test_sequences_only_grow() -> None:
    book = EMPTY.take("anna", 0.0)
    book = book.checked("anna", LeaseToken(book.epoch, 3), 1.0)
    for sequence in (3, 2, 0, -1):
        assert refusal(book.checked, "anna", LeaseToken(book.epoch, sequence), 1.0) == "stale_command"
    assert refusal(book.checked, "anna", LeaseToken(book.epoch - 1, 9), 1.0) == "lease_lost"
    assert refusal(book.checked, "bert", LeaseToken(book.epoch, 9), 1.0) == "lease_lost"
    assert refusal(book.checked, "anna", None, 1.0) == "lease_needed"


def test_the_view_counts_down() -> None:
    book = EMPTY.take("anna", 10.0)
    assert book.view(12.0).expires_s == 3.0
    assert book.view(99.0).expires_s == 0.0
    assert EMPTY.view(0.0).expires_s is None
