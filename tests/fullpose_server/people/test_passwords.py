"""Passwords, and how often one may try."""

import pytest

from fullpose_server.people import attempts as trying
from fullpose_server.people.attempts import Attempts
from fullpose_server.people.passwords import PasswordError, hashed, matches

RIGHT = "correct horse battery"


def test_the_right_password_and_no_other_is_that_of_the_hash() -> None:
    kept = hashed(RIGHT, "ann")
    assert RIGHT not in kept
    assert kept.startswith("$argon2id$")
    assert kept != hashed(RIGHT, "ann")
    assert matches(RIGHT, kept) == (True, None)
    assert matches(RIGHT + " ", kept)[0] is False
    assert matches(RIGHT.title(), kept)[0] is False
    assert matches(RIGHT, None) == (False, None)
    assert matches("nobody's password", None) == (False, None)
    assert matches("\ud800 is no text", kept) == (False, None)
    assert matches("x" * 1_000_000, kept) == (False, None)


def test_a_hash_that_costs_too_little_is_made_anew() -> None:
    from argon2 import PasswordHasher

    cheap = PasswordHasher(time_cost=1, memory_cost=1024, parallelism=1).hash(RIGHT)
    right, anew = matches(RIGHT, cheap)
    assert right
    assert anew is not None
    assert matches(RIGHT, anew) == (True, None)


@pytest.mark.parametrize(
    "password", ["", "eleven char", "x" * 257, "aaaaaaaaaaaaaaaaaaa", "annika-1234567", "\udcff\udcfe is no text"]
)
def test_what_can_be_guessed_is_no_password(password: str) -> None:
    with pytest.raises(PasswordError, match="expected"):
        hashed(password, "annika")


def test_one_name_is_tried_five_times_a_minute_from_one_address() -> None:
    attempts = Attempts()
    assert [attempts.begin("ann", "a") for _ in range(5)] == [0] * 5
    assert 1 <= attempts.begin("ANN", "a") <= 61
    assert attempts.begin("bob", "a") == 0
    assert attempts.begin("ann", "b") == 0


def test_an_address_tries_many_names_only_for_so_long() -> None:
    attempts = Attempts()
    waits = [attempts.begin(f"name{k}", "a") for k in range(40)]
    assert waits[:30] == [0] * 30
    assert all(wait > 0 for wait in waits[30:])
    assert attempts.begin("name0", "b") == 0


def test_one_name_is_not_tried_from_everywhere() -> None:
    attempts = Attempts()
    waits = [attempts.begin("ann", f"address{k}") for k in range(70)]
    assert waits[:60] == [0] * 60
    assert all(wait > 60 for wait in waits[60:])


def test_who_knows_the_password_may_have_mistyped_it() -> None:
    attempts = Attempts()
    for _ in range(4):
        attempts.begin("ann", "a")
    attempts.succeeded("ann", "a")
    assert [attempts.begin("ann", "a") for _ in range(5)] == [0] * 5


def test_a_network_of_one_subscriber_is_one_address() -> None:
    attempts = Attempts()
    assert [attempts.begin("ann", f"2001:db8::{k:x}") for k in range(5)] == [0] * 5
    assert attempts.begin("ann", "2001:db8::ffff:1") > 0
    assert attempts.begin("ann", "2001:db8:0:1::1") == 0


def test_a_flood_of_names_is_kept_in_so_much_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trying, "_NAMES", 3)
    attempts = Attempts()
    waits = [attempts.begin(f"name{k}", f"address{k}") for k in range(181)]
    assert any(waits)
