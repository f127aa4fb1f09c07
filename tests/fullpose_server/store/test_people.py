"""People and credentials as rows."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier

import pytest

from fullpose_server.errors import NotFoundError
from fullpose_server.location import Location
from fullpose_server.people.admitted import Shown
from fullpose_server.people.roles import Role
from fullpose_server.store import people as rows
from fullpose_server.store.database import Database
from fullpose_server.store.people import PeopleStore, PersonError
from fullpose_server.store.people_known import has_people

LATER = 4e9
PASSWORD = "correct horse battery"


@pytest.fixture
def people(database: Database) -> PeopleStore:
    return PeopleStore(database)


def with_ann(people: PeopleStore, role: Role = Role.ADMIN) -> None:
    people.add("ann", role, None)


def test_nobody_is_asked_to_sign_in_until_there_is_somebody(people: PeopleStore, location: Location) -> None:
    assert not people.admitted().people
    assert not has_people(location)
    with_ann(people)
    assert people.admitted().people
    assert has_people(location)


def test_a_folder_that_is_none_or_damaged_has_nobody(tmp_path: Path) -> None:
    assert not has_people(tmp_path / "nowhere")
    (tmp_path / "fullpose.db").write_bytes(b"no database")
    assert not has_people(tmp_path / "fullpose.db")


def test_a_name_is_one_persons_however_it_is_spelled(people: PeopleStore) -> None:
    with_ann(people)
    with pytest.raises(PersonError, match="already"):
        people.add("Ann", Role.VIEWER, None)
    row = people.get("ANN")
    assert row is not None
    assert row.name == "ann"


@pytest.mark.parametrize("location", ["sqlite"], indirect=True)
def test_neither_secrets_nor_passwords_are_in_the_file(people: PeopleStore, tmp_path: Path) -> None:
    people.add("ann", Role.ADMIN, PASSWORD)
    token = people.make_token("ann", "for a test", None, None)
    session = people.open_session("ann", 1.0, "a browser", None)
    stored = b"".join(file.read_bytes() for file in tmp_path.iterdir())
    assert b"for a test" in stored
    for secret in (PASSWORD, token.secret, session.secret):
        assert secret.encode() not in stored
    assert (tmp_path / "fullpose.db").stat().st_mode & 0o077 == 0


def test_a_token_is_let_in_with_the_lesser_role_of_the_two(people: PeopleStore) -> None:
    with_ann(people)
    people.add("eve", Role.ADMIN, None)
    less = people.make_token("ann", "less", Role.OPERATOR, None)
    whole = people.make_token("ann", "whole", None, None)
    roles = lambda: {each.id: each.role for each in people.admitted().all()}  # noqa: E731
    assert roles() == {less.id: Role.OPERATOR, whole.id: Role.ADMIN}
    people.change("ann", role=Role.VIEWER)
    assert roles() == {less.id: Role.VIEWER, whole.id: Role.VIEWER}
    with pytest.raises(PersonError, match="cannot be admin"):
        people.make_token("ann", "more", Role.ADMIN, None)


def test_who_is_disabled_is_let_in_by_nothing(people: PeopleStore) -> None:
    with_ann(people)
    people.add("bob", Role.OPERATOR, None)
    given = people.make_token("bob", "a token", None, None)
    people.change("bob", disabled=True)
    assert people.admitted().find(Shown(given.secret, cookie=False), 0.0) is None
    people.change("bob", disabled=False)
    assert people.admitted().find(Shown(given.secret, cookie=False), 0.0) is not None


def test_an_admin_is_left(people: PeopleStore) -> None:
    with_ann(people)
    for change in ({"role": Role.OPERATOR}, {"disabled": True}):
        with pytest.raises(PersonError, match="last admin"):
            people.change("ann", **change)  # type: ignore[arg-type]
    people.add("eve", Role.ADMIN, None)
    people.change("eve", disabled=True)
    with pytest.raises(PersonError, match="last admin"):
        people.change("ann", role=Role.VIEWER)
    people.change("eve", disabled=False)
    people.change("ann", role=Role.VIEWER)


def test_another_password_ends_every_other_session(people: PeopleStore) -> None:
    people.add("ann", Role.ADMIN, PASSWORD)
    kept, ended = (people.open_session("ann", 1.0, "a browser", None) for _ in range(2))
    token = people.make_token("ann", "a token", None, None)
    people.set_password("ann", "another long sentence", keep=kept.id)
    assert {each.id for each in people.admitted().all()} == {kept.id, token.id}
    assert ended.id not in {each.id for each in people.admitted().all()}


def test_the_oldest_of_too_many_sessions_ends(people: PeopleStore) -> None:
    with_ann(people)
    opened = [people.open_session("ann", 1.0, "a browser", None).id for _ in range(rows.MOST_SESSIONS + 3)]
    assert {each.id for each in people.admitted().all()} == set(opened[3:])


def test_every_change_is_seen_by_whoever_looks(people: PeopleStore) -> None:
    seen = [people.revision()]
    with_ann(people)
    seen.append(people.revision())
    given = people.make_token("ann", "a token", None, None)
    seen.append(people.revision())
    people.revoke(given.id)
    seen.append(people.revision())
    people.add("eve", Role.ADMIN, None)
    people.change("ann", disabled=True)
    seen.append(people.revision())
    assert seen == sorted(set(seen))


def test_what_is_revoked_is_gone_and_nobody_elses_is_revoked(people: PeopleStore) -> None:
    with_ann(people)
    given = people.make_token("ann", "a token", None, 1.0)
    with pytest.raises(NotFoundError):
        people.revoke(given.id, of="bob")
    people.revoke(given.id, of="ann")
    with pytest.raises(NotFoundError):
        people.revoke(given.id)
    assert people.tokens() == []


def test_an_expired_session_is_let_in_by_nothing(people: PeopleStore) -> None:
    with_ann(people)
    given = people.open_session("ann", 1.0, "a browser", None)
    assert people.admitted().find(Shown(given.secret, cookie=True), LATER) is None


def at_once(one: Callable[[], object], other: Callable[[], object]) -> list[object]:
    """What two threads come back with that begin together: a result or an exception."""
    begin = Barrier(2)

    def run(what: Callable[[], object]) -> object:
        begin.wait()
        try:
            return what()
        except PersonError as error:
            return error

    with ThreadPoolExecutor(2) as threads:
        return [each.result() for each in [threads.submit(run, what) for what in (one, other)]]


def test_two_who_lower_each_other_leave_an_admin(people: PeopleStore, location: Location) -> None:
    other = Database(location)  # the command line, say
    elsewhere = PeopleStore(other)
    for name in ("ann", "bob"):
        people.add(name, Role.ADMIN, None)
    for _ in range(40):
        at_once(lambda: people.change("ann", role=Role.VIEWER), lambda: elsewhere.change("bob", role=Role.VIEWER))
        assert sum(row.role == Role.ADMIN for row in people.all()) == 1
        for name in ("ann", "bob"):
            people.change(name, role=Role.ADMIN)
    other.close()


def test_no_two_changes_have_one_number(people: PeopleStore, location: Location) -> None:
    """Or a server that has seen the first would not look for the second: a revoked token would hold on."""
    other = Database(location)
    elsewhere = PeopleStore(other)
    with_ann(people)
    for _ in range(40):
        at_once(lambda: people.make_token("ann", "a", None, 1), lambda: elsewhere.make_token("ann", "b", None, 1))
    numbers = [row.changed for row in people.tokens()]
    assert len(set(numbers)) == len(numbers) == 80
    other.close()


def test_a_person_has_so_many_tokens(people: PeopleStore, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rows, "MOST_TOKENS", 3)
    with_ann(people)
    made = [people.make_token("ann", "a", None, None).id for _ in range(3)]
    with pytest.raises(PersonError, match="3 tokens"):
        people.make_token("ann", "a", None, None)
    people.revoke(made[0])
    people.make_token("ann", "a", None, None)


def test_a_database_of_before_there_were_people_is_its_owners_alone(tmp_path: Path) -> None:
    Database(tmp_path / "fullpose.db").close()
    (tmp_path / "fullpose.db").chmod(0o644)
    Database(tmp_path / "fullpose.db").close()
    assert (tmp_path / "fullpose.db").stat().st_mode & 0o777 == 0o600


@pytest.mark.parametrize("revoke_tokens", [False, True])
def test_another_password_ends_the_sessions_and_the_tokens_where_they_are_to_end(
    people: PeopleStore, revoke_tokens: bool
) -> None:
    with_ann(people)
    people.add("eve", Role.VIEWER, PASSWORD)
    made = {
        "session": people.open_session("ann", 1.0, "a browser", None).id,
        "kept": people.open_session("ann", 1.0, "this browser", None).id,
        "token": people.make_token("ann", "a script", None, None).id,
        "other's": people.open_session("eve", 1.0, "a browser", None).id,
    }
    people.set_password("ann", f"{PASSWORD} anew", keep=made["kept"], revoke_tokens=revoke_tokens)
    held = {each.id for each in people.admitted().all()}
    stay = {"kept", "other's"} if revoke_tokens else {"kept", "other's", "token"}
    assert {name for name, id_ in made.items() if id_ in held} == stay


def test_tokens_are_revoked_without_another_password_too(people: PeopleStore) -> None:
    with_ann(people)
    session = people.open_session("ann", 1.0, "a browser", None)
    people.make_token("ann", "a script", None, None)
    people.change("ann", revoke_tokens=True)
    assert [each.id for each in people.admitted().all()] == [session.id]


def test_who_may_command_is_known_whether_they_are_signed_in_or_not(people: PeopleStore) -> None:
    assert people.admitted().commanders is None
    with_ann(people)
    people.add("otto", Role.OPERATOR, None)
    people.add("vic", Role.VIEWER, None)
    assert people.admitted().commanders == {"ann", "otto"}
    people.change("otto", disabled=True)
    assert people.admitted().commanders == {"ann"}
