"""Why a session refuses: one root; each child carries its evidence and a code for machines to read."""

from fullpose_server.session.states import Command, State


class SessionError(Exception):
    """Root of the refusals. `code` is stable; the message says what to do next. A refusal changes nothing."""

    code = "refused"


class IllegalCommandError(SessionError):
    """A command that the table has no row for in this state."""

    code = "illegal_command"

    def __init__(self, state: State, command: Command, allowed: tuple[Command, ...]) -> None:
        options = ", ".join(allowed)
        super().__init__(f"{command} is not possible while {state}; allowed now: {options}")
        self.state = state
        self.command = command
        self.allowed = allowed


class CodedError(SessionError):
    """A refusal of many kinds: each has its code."""

    def __init__(self, code: str, message: str) -> None:
        super().__init__(message)
        self.code = code


class LeaseError(CodedError):
    """The lease is not the caller's, or the token is old."""


class BindingError(SessionError):
    """Plan and rig are not the pair that was loaded."""

    code = "wrong_pair"

    def __init__(self, field: str, bound: str, given: str) -> None:
        super().__init__(f"{field} is {given[:16]}, but {bound[:16]} was loaded: unload, and load the pair again")
        self.field = field
        self.bound = bound
        self.given = given


class NotReadyError(CodedError):
    """Something must happen first: which, is in the message."""
