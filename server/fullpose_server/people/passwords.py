"""Passwords: argon2id by pwdlib, at its recommended cost (RFC 9106): some 50 ms of a core and 64 MiB a call."""

from functools import cache

from pwdlib import PasswordHash

from fullpose_server.errors import ServerError

SHORTEST, LONGEST = 12, 256  # characters (NIST SP 800-63B, 3.1.1.2: length, no rules about kinds of characters)


class PasswordError(ServerError):
    """A password that may not be one."""


def hashed(password: str, name: str) -> str:
    """The hash of a new password of `name`. Raises `PasswordError`."""
    if not SHORTEST <= len(password) <= LONGEST:
        raise PasswordError(
            f"the password has {len(password)} characters: expected {SHORTEST} to {LONGEST}, a sentence will do"
        )
    if not _is_text(password):
        raise PasswordError("the password is not text in UTF-8: expected characters")
    if name.casefold() in password.casefold() and len(password) < len(name) + SHORTEST:
        raise PasswordError("the password is little more than the name: expected one that nobody guesses")
    if len(set(password)) < 5:
        raise PasswordError("the password repeats a few characters: expected one that nobody guesses")
    return _hasher().hash(password)


def matches(password: str, known: str | None) -> tuple[bool, str | None]:
    """Whether it is the password of the hash, and its hash anew where the old one costs too little by now.

    Without a hash (nobody of that name, or no password) the answer takes as long, and is no.
    """
    if len(password) > LONGEST or not _is_text(password):
        return False, None
    right, anew = _hasher().verify_and_update(password, known or _nobody())
    return (right, anew) if known else (False, None)


def _is_text(password: str) -> bool:
    """Whether it can be written as UTF-8: what a terminal gives need not be."""
    return not any("\ud800" <= character <= "\udfff" for character in password)


@cache
def _hasher() -> PasswordHash:
    return PasswordHash.recommended()


@cache
def _nobody() -> str:
    return _hasher().hash("nobody's password")
