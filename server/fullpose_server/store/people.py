"""People and their credentials, as rows. What a server lets in is read from here (`admitted`), also while it runs."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from uuid import uuid4

from sqlalchemy import Select, delete, func, select
from sqlalchemy.orm import Session

from fullpose_server.errors import NotFoundError, ServerError
from fullpose_server.people.admitted import TOKEN_PREFIX, Admitted, Credential
from fullpose_server.people.passwords import hashed
from fullpose_server.people.roles import Role
from fullpose_server.secret import new_secret, proof_of
from fullpose_server.store.database import Database
from fullpose_server.store.tables import CredentialRow, UserRow

MOST_SESSIONS = 20  # of one person: of more the oldest ends
MOST_TOKENS = 100  # of one person, that hold: every one is kept in memory, and told to the stop gate
LONGEST_LABEL = 200
KEPT_S = 30 * 86400.0  # so long what has run out or was revoked can still be looked up


class PersonError(ServerError):
    """A change to people that may not be: the reason, in a sentence."""


@dataclass(frozen=True)
class Given:
    """A credential that was made, and its secret: told once, kept nowhere."""

    id: str
    secret: str


class PeopleStore:
    """Synchronous, as the database is."""

    def __init__(self, database: Database) -> None:
        self._database = database

    @contextmanager
    def _changing(self) -> Iterator[Session]:
        """A transaction that has people to itself from its first look on.

        Two that looked before either wrote would both leave one admin, or give two changes one number.
        """
        with self._database.begin_alone(UserRow, CredentialRow) as session:
            yield session

    # --- people ---

    def add(self, name: str, role: Role, password: str | None, subject: str | None = None) -> UserRow:
        """A new person. Raises `PersonError` where there is one of that name, `PasswordError`."""
        kept = None if password is None else hashed(password, name)
        with self._changing() as session:
            if _find(session, name) is not None:
                raise PersonError(f"there is a user {name} already")
            # The number is the next before the row is there.
            row = UserRow(name=name, role=role, password=kept, subject=subject, disabled=False, created=time.time())
            row.changed = _next(session)
            session.add(row)
            return row

    def change(
        self,
        name: str,
        *,
        role: Role | None = None,
        disabled: bool | None = None,
        password: str | None = None,
        keep: str | None = None,
        revoke_tokens: bool = False,
    ) -> UserRow:
        """Another role, shut out or let in again, another password: all of it or nothing.

        With another password every session ends, and with `revoke_tokens` every token, but what has the id `keep`.
        Raises `NotFoundError`, `PasswordError`, `PersonError` for the last admin.
        """
        kept = None if password is None else hashed(password, name)
        with self._changing() as session:
            row = _known(session, name)
            after = (role or Role(row.role), row.disabled if disabled is None else disabled)
            if _is_admin(row) and after != (Role.ADMIN, False) and _admins(session) == 1:
                raise PersonError(f"{name} is the last admin: make another one first")
            row.role, row.disabled = after
            row.changed = _next(session)
            if kept is not None:
                row.password = kept
            for held in session.scalars(_of(row.name).where(CredentialRow.id != (keep or ""))):
                ends = kept is not None if held.session else revoke_tokens
                if ends:
                    _revoke(session, held)
            return row

    def set_password(self, name: str, password: str, *, keep: str | None = None, revoke_tokens: bool = False) -> None:
        """As `change` does it."""
        self.change(name, password=password, keep=keep, revoke_tokens=revoke_tokens)

    def rehash(self, name: str, kept: str) -> None:
        """The same password, by a hash that costs more."""
        with self._changing() as session:
            _known(session, name).password = kept

    def get(self, name: str) -> UserRow | None:
        """The person of that name, however it is spelled in capitals."""
        with self._database.begin() as session:
            return _find(session, name)

    def by_subject(self, subject: str) -> UserRow | None:
        """The person who is this one to the provider that they sign in at."""
        with self._database.begin() as session:
            return session.scalars(select(UserRow).where(UserRow.subject == subject)).one_or_none()

    def sign_in_from(self, subject: str, name: str, role: Role) -> UserRow:
        """The person who is `subject` to the provider: made at the first sign-in, their role as the provider has it.

        Raises `PersonError` where the name is another's, or the last admin would be none.
        """
        known = self.by_subject(subject)
        if known is not None:
            return known if known.role == role else self.change(known.name, role=role)
        return self.add(name, role, None, subject)

    def all(self) -> list[UserRow]:
        """By name."""
        with self._database.begin() as session:
            return list(session.scalars(select(UserRow).order_by(UserRow.name)))

    # --- credentials ---

    def open_session(self, name: str, hours: float, label: str, address: str | None) -> Given:
        """A browser's session. Raises `NotFoundError`."""
        with self._changing() as session:
            name, now = _known(session, name).name, time.time()
            forgotten = (CredentialRow.until < now - KEPT_S) | (CredentialRow.revoked < now - KEPT_S)
            session.execute(delete(CredentialRow).where(forgotten))
            newest = _of(name).where(CredentialRow.session).order_by(CredentialRow.created.desc())
            for old in session.scalars(newest.offset(MOST_SESSIONS - 1)):
                _revoke(session, old)
            return _give(session, CredentialRow(user=name, session=True, until=now + 3600.0 * hours), label, address)

    def make_token(self, name: str, label: str, role: Role | None, days: float | None) -> Given:
        """A token of a person, of at most their role. Raises `NotFoundError`, `PersonError`."""
        if not 1 <= len(label) <= LONGEST_LABEL or not label.isprintable():
            raise PersonError(f"label {label[:40]!r}: expected 1 to {LONGEST_LABEL} characters on one line")
        with self._changing() as session:
            row = _known(session, name)
            if role is not None and not Role(row.role).may(role):
                raise PersonError(f"{row.name} is {row.role}: a token of theirs cannot be {role}")
            if _tokens_held(session, row.name) >= MOST_TOKENS:
                raise PersonError(f"{row.name} has {MOST_TOKENS} tokens: revoke one first")
            until = None if days is None else time.time() + 86400.0 * days
            made = CredentialRow(user=row.name, role=role, session=False, until=until)
            return _give(session, made, label, None)

    def revoke(self, credential: str, of: str | None = None) -> CredentialRow:
        """End a token or session, `of` this person where one is named. Raises `NotFoundError`."""
        with self._changing() as session:
            row = session.get(CredentialRow, credential)
            if row is None or row.revoked is not None or (of is not None and row.user != of):
                raise NotFoundError("token", credential)
            _revoke(session, row)
            return row

    def tokens(self, of: str | None = None) -> list[CredentialRow]:
        """Those that were not revoked, newest first; of one person or of all."""
        wanted = select(CredentialRow).where(~CredentialRow.session, CredentialRow.revoked.is_(None))
        if of is not None:
            wanted = wanted.where(CredentialRow.user == of)
        with self._database.begin() as session:
            return list(session.scalars(wanted.order_by(CredentialRow.created.desc(), CredentialRow.id)))

    # --- who is let in ---

    def revision(self) -> int:
        """Grows with every change, whichever process made it."""
        with self._database.begin() as session:
            return _next(session) - 1

    def admitted(self, *, asked: bool = False) -> Admitted:
        """The credentials that hold now; `asked`: one must sign in though there is nobody yet."""
        with self._database.begin_snapshot() as session:  # one look: both tables as of one moment
            people = {row.name: row for row in session.scalars(select(UserRow))}
            rows = session.scalars(select(CredentialRow).where(CredentialRow.revoked.is_(None)))
            held = [
                Credential(row.id, row.proof, row.user, _role(row, people[row.user]), row.until, row.session)
                for row in rows
                if not people[row.user].disabled
            ]
            may = (row.name for row in people.values() if not row.disabled and Role(row.role).may(Role.OPERATOR))
            commanders = frozenset(may) if people else None
        return Admitted(asked or bool(people), held, commanders)


def _role(row: CredentialRow, person: UserRow) -> Role:
    """A token keeps the role it was given, until its person's is less."""
    role = Role(person.role)
    return role if row.role is None else Role(row.role).at_most(role)


def _give(session: Session, row: CredentialRow, label: str, address: str | None) -> Given:
    given = Given(uuid4().hex[:12], new_secret("" if row.session else TOKEN_PREFIX))
    row.id, row.proof, row.label, row.address = given.id, proof_of(given.secret), label, address
    row.created, row.changed = time.time(), _next(session)
    session.add(row)
    return given


def _revoke(session: Session, row: CredentialRow) -> None:
    row.revoked, row.changed = time.time(), _next(session)


def _of(name: str) -> Select[CredentialRow]:
    return select(CredentialRow).where(CredentialRow.user == name, CredentialRow.revoked.is_(None))


def _tokens_held(session: Session, name: str) -> int:
    held = CredentialRow.until.is_(None) | (CredentialRow.until > time.time())
    wanted = select(func.count()).select_from(CredentialRow)
    mine = (CredentialRow.user == name, CredentialRow.revoked.is_(None), ~CredentialRow.session)
    return session.scalar(wanted.where(*mine, held)) or 0


def _find(session: Session, name: str) -> UserRow | None:
    # Not in SQL: SQLite's lower() knows the letters of ASCII alone.
    wanted = name.casefold()
    return next((row for row in session.scalars(select(UserRow)) if row.name.casefold() == wanted), None)


def _known(session: Session, name: str) -> UserRow:
    row = _find(session, name)
    if row is None:
        raise NotFoundError("user", name)
    return row


def _is_admin(row: UserRow) -> bool:
    return row.role == Role.ADMIN and not row.disabled


def _admins(session: Session) -> int:
    wanted = select(func.count()).select_from(UserRow).where(UserRow.role == Role.ADMIN, ~UserRow.disabled)
    return session.scalar(wanted) or 0


def _next(session: Session) -> int:
    """The number of the next change."""
    newest = [session.scalar(select(func.max(table.changed))) or 0 for table in (UserRow, CredentialRow)]
    return max(newest) + 1
