"""The lease, apart from the machine."""

import pytest

from fullpose_server.secret import proof_of
from fullpose_server.session.errors import LeaseError
from fullpose_server.session.lease import LeaseBook, LeaseToken

EMPTY = LeaseBook(silent_s=5.0)
ANNA, BERT, CARL, GUESSED = (proof_of(secret) for secret in ("anna's", "bert's", "carl's", "guessed"))


def refusal(call: object, *arguments: object) -> str:
    with pytest.raises(LeaseError) as refused:
        call(*arguments)  # type: ignore[operator]
    return refused.value.code


def test_every_change_of_hands_is_a_new_epoch() -> None:
    anna = EMPTY.take("anna", ANNA, 0.0)
    bert = anna.take("bert", BERT, 1.0, force=True)
    assert bert.epoch == anna.epoch + 1
    assert bert.release(BERT, 2.0).epoch == bert.epoch + 1


def test_a_lease_in_use_is_taken_only_by_force_or_from_the_silent() -> None:
    anna = EMPTY.take("anna", ANNA, 0.0)
    assert refusal(anna.take, "bert", BERT, 4.9) == "lease_held"
    assert anna.take("bert", BERT, 5.1).holder == "bert"
    assert anna.renew(ANNA, 4.0).holder == "anna"
    assert refusal(anna.renew(ANNA, 4.0).take, "bert", BERT, 8.9) == "lease_held"


def test_who_knows_the_holder_s_name_and_epoch_and_not_the_secret_holds_nothing() -> None:
    anna = EMPTY.take("anna", ANNA, 0.0).request("bert", BERT)
    assert refusal(anna.take, "anna", GUESSED, 1.0) == "lease_held"
    for proof in (GUESSED, BERT, "", "\u00e4", ANNA[:-1]):
        assert refusal(anna.renew, proof, 1.0) == "lease_lost"
        assert refusal(anna.release, proof, 1.0) == "lease_lost"
        assert refusal(anna.grant, proof, 1.0) == "lease_lost"
        assert refusal(anna.checked, LeaseToken(anna.epoch, 1, proof), 1.0) == "lease_lost"
    assert refusal(anna.renew, None, 1.0) == "lease_needed"
    free = anna.release(ANNA, 1.0)
    for proof in ("", ANNA):
        assert refusal(free.renew, proof, 1.0) == "lease_needed"
        assert refusal(free.checked, LeaseToken(free.epoch, 1, proof), 1.0) == "lease_needed"


def test_the_secret_of_a_former_holder_is_worth_nothing() -> None:
    bert = EMPTY.take("anna", ANNA, 0.0).take("bert", BERT, 1.0, force=True)
    assert refusal(bert.renew, ANNA, 2.0) == "lease_lost"
    assert refusal(bert.checked, LeaseToken(bert.epoch, 9, ANNA), 2.0) == "lease_lost"


def test_a_request_is_granted_to_who_asked_and_held_by_the_secret_of_the_request() -> None:
    anna = EMPTY.take("anna", ANNA, 0.0)
    assert refusal(anna.grant, ANNA, 0.0) == "lease_not_requested"
    asked = anna.request("bert", BERT).request("carl", CARL)
    assert asked.view(0.0).requested_by == ("bert", "carl")
    bert = asked.grant(ANNA, 1.0)
    assert (bert.holder, bert.renew(BERT, 1.0).holder) == ("bert", "bert")
    assert refusal(bert.renew, ANNA, 1.0) == "lease_lost"
    granted = asked.grant(ANNA, 1.0, "carl")
    assert (granted.holder, granted.view(1.0).requested_by) == ("carl", ("bert",))
    assert granted.renew(CARL, 1.0).holder == "carl"
    assert refusal(asked.grant, ANNA, 1.0, "dora") == "lease_not_requested"
    assert refusal(asked.grant, BERT, 1.0) == "lease_lost"
    assert refusal(EMPTY.request, "bert", BERT) == "lease_free"


def test_who_asks_again_asks_by_the_newer_secret() -> None:
    asked = EMPTY.take("anna", ANNA, 0.0).request("bert", GUESSED).request("carl", CARL).request("bert", BERT)
    assert asked.view(0.0).requested_by == ("bert", "carl")
    assert asked.grant(ANNA, 1.0).renew(BERT, 1.0).holder == "bert"


def test_sequences_only_grow() -> None:
    book = EMPTY.take("anna", ANNA, 0.0)
    book = book.checked(LeaseToken(book.epoch, 3, ANNA), 1.0)
    for sequence in (3, 2, 0, -1):
        assert refusal(book.checked, LeaseToken(book.epoch, sequence, ANNA), 1.0) == "stale_command"
    assert refusal(book.checked, LeaseToken(book.epoch - 1, 9, ANNA), 1.0) == "lease_lost"
    assert refusal(book.checked, None, 1.0) == "lease_needed"


def test_the_view_counts_down_and_shows_no_proof() -> None:
    book = EMPTY.take("anna", ANNA, 10.0).request("bert", BERT)
    assert book.view(12.0).expires_s == 3.0
    assert book.view(99.0).expires_s == 0.0
    assert EMPTY.view(0.0).expires_s is None
    for shown in (repr(book), repr(book.view(12.0)), repr(LeaseToken(1, 1, ANNA))):
        assert not any(proof in shown for proof in (ANNA, BERT))


def test_the_lease_of_who_may_command_no_longer_is_nobodys_and_silent_already() -> None:
    anna = EMPTY.take("anna", ANNA, 100.0).request("bert", BERT).request("anna", CARL)
    free = anna.lapse("anna", 101.0)
    assert (free.holder, free.epoch, free.silence(101.0)) == (None, anna.epoch + 1, 5.0)
    assert free.view(101.0).requested_by == ("bert",)
    assert refusal(free.renew, ANNA, 101.0) == "lease_needed"
    bert = free.take("bert", BERT, 102.0)
    assert (bert.holder, bert.lapsed, bert.silence(102.0)) == ("bert", False, 0.0)
    # Silence that is longer already is not made shorter, and a lease that is another's by now stays theirs.
    assert anna.lapse("anna", 170.0).silence(170.0) == 70.0
    assert bert.lapse("anna", 103.0) is bert
