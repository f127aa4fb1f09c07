"""How commands end: exit statuses, and one clear line on stderr."""

import sys
from typing import NoReturn

DONE = 0
BAD_INPUT = 2
NOT_FEASIBLE = 3


class CommandError(Exception):
    """Why a command that serves cannot go on: one line for the person at the terminal."""


def fail(message: str, status: int = BAD_INPUT) -> NoReturn:
    """Say why on one line of stderr and exit."""
    say(message)
    sys.exit(status)


def say(message: str) -> None:
    """One line on stderr."""
    sys.stderr.write("fullpose: " + " ".join(message.split()) + "\n")
