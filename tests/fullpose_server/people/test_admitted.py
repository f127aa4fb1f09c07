"""Roles, and the credentials that hold."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fullpose_server.people.admitted import COOKIE, Admitted, Credential, Shown, shown_by
from fullpose_server.people.roles import Role
from fullpose_server.secret import proof_of

TOKEN, SESSION = f"fp_{'t' * 43}", "s" * 43  # as they look, and the same in every process that collects the tests
KNOWN = Admitted(
    True,
    [
        Credential("t", proof_of(TOKEN), "ann", Role.ADMIN, None, session=False),
        Credential("s", proof_of(SESSION), "bob", Role.VIEWER, 100.0, session=True),
    ],
)


def test_each_role_may_what_the_one_before_it_may() -> None:
    may = {(one, other) for one in Role for other in Role if one.may(other)}
    order = [Role.VIEWER, Role.OPERATOR, Role.ADMIN]
    assert may == {(one, other) for one in Role for other in Role if order.index(one) >= order.index(other)}
    assert {one.at_most(other) for one in Role for other in [Role.VIEWER]} == {Role.VIEWER}


def test_a_secret_is_known_by_its_proof_and_in_its_own_place() -> None:
    found = KNOWN.find(Shown(TOKEN, cookie=False), 0.0)
    assert found is not None
    assert (found.who, found.role) == ("ann", Role.ADMIN)
    assert KNOWN.find(Shown(TOKEN, cookie=True), 0.0) is None
    assert KNOWN.find(Shown(SESSION, cookie=False), 0.0) is None
    assert KNOWN.find(Shown(proof_of(TOKEN), cookie=False), 0.0) is None
    assert KNOWN.find(None, 0.0) is None


def test_a_session_holds_until_its_end() -> None:
    assert KNOWN.find(Shown(SESSION, cookie=True), 99.9) is not None
    assert KNOWN.find(Shown(SESSION, cookie=True), 100.0) is None
    assert (KNOWN.still("s", Role.VIEWER, 99.9), KNOWN.still("s", Role.VIEWER, 100.0)) == (True, False)
    assert not KNOWN.still("gone", Role.VIEWER, 0.0)
    assert not KNOWN.still("s", Role.ADMIN, 99.9)


@given(st.text(max_size=40) | st.just(TOKEN[:-1]), st.text(max_size=40))
def test_headers_of_any_kind_show_nothing_that_is_known(authorization: str, cookie: str) -> None:
    for shown in (shown_by(authorization, cookie), shown_by(f"Bearer {authorization}", None), shown_by(None, cookie)):
        assert KNOWN.find(shown, 0.0) is None


@pytest.mark.parametrize(
    ("authorization", "cookie", "shown"),
    [
        (f"Bearer {TOKEN}", None, Shown(TOKEN, cookie=False)),
        (f"bearer  {TOKEN} ", None, Shown(TOKEN, cookie=False)),
        (f"Basic {TOKEN}", f"{COOKIE}={SESSION}", None),  # another way to sign in, which there is not
        (None, f"other=1; {COOKIE}={SESSION}; more=2", Shown(SESSION, cookie=True)),
        (
            None,
            f'theirs={{"a": [1, 2]}}; {COOKIE}={SESSION}; [x]=y z',
            Shown(SESSION, cookie=True),
        ),  # of another program
        (None, f"{COOKIE}=tossed; {COOKIE}={SESSION}", Shown(SESSION, cookie=True)),  # the longest path comes first
        (None, "other=1", None),
        (None, None, None),
    ],
)
def test_a_header_comes_before_a_cookie(authorization: str | None, cookie: str | None, shown: Shown | None) -> None:
    assert shown_by(authorization, cookie) == shown
