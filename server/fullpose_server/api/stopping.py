"""Stop and E-stop on the wire, alike in the server and in the stop gate: who asks, and the answer. No web framework."""

import re
import time
from typing import Any

from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.base import CLIENT_NAME
from fullpose_server.api.schemas.session import CommandOut
from fullpose_server.runtime.contract.messages import Reply
from fullpose_server.session.states import STOP_CATEGORY, State
from fullpose_server.store.audit_entry import AuditEntry

# Codes of the session's refusals that are not about its state.
_STATUS = {"lease_needed": 403, "lease_lost": 403, "live_key": 403, "rig_unreachable": 503}
_WHO = re.compile(CLIENT_NAME)
_NOT_A_NAME = re.compile(r"[^\w.@:+-]")
_LONGEST = 64
CLIENT_HEADER = "x-fullpose-client"
_NO_PROCESS = (
    "no rig process runs for this rig: nothing here commands its drive, and whether its frames rest is not known"
)
NOTHING_RUNS = Reply(True, State.DISCONNECTED.value, State.DISCONNECTED.value, 0, unknown=_NO_PROCESS)


def is_name(given: str) -> bool:
    """Whether it may be the name of who commands."""
    return _WHO.fullmatch(given) is not None


def who_stops(given: str | None, address: str | None) -> str:
    """Who stops a rig: a name that is none is written down as one, for no stop is refused for a name."""
    if given:
        return given if is_name(given) else _NOT_A_NAME.sub("_", given)[:_LONGEST]
    return "anonymous" if address is None else f"anonymous@{address}"[:_LONGEST]


def answer(word: str, reply: Reply) -> CommandOut:
    """The reply on the wire. Raises `ApiError` for a refusal."""
    if not reply.ok:
        raise refusal(reply)
    stop = {str(command): category for command, category in STOP_CATEGORY.items()}.get(word)
    said: dict[str, Any] = {"command": word, "state_before": reply.state_before, "state_after": reply.state_after}
    return CommandOut.model_validate(
        said | {"revision": reply.revision, "stop_category": stop, "unknown": reply.unknown}
    )


def status_of(done: CommandOut) -> int:
    """202 where not all is known of what came of it."""
    return 200 if done.unknown is None else 202


def refusal(reply: Reply) -> ApiError:
    """A refusal as a problem: what was asked in which state, and what is allowed instead."""
    error = reply.error
    if error is None:
        return ApiError(503, "rig-unreachable", "the rig process refused without a reason")
    return ApiError(
        _STATUS.get(error.code, 409),
        error.code.replace("_", "-"),
        error.message,
        state=error.state,
        command=error.command,
        allowed=error.allowed,
    )


def audit_entry(
    rig: str,
    who: str,
    word: str,
    reply: Reply,
    args: dict[str, Any] | None = None,
    lease: tuple[int, int] | None = None,
    address: str | None = None,
) -> AuditEntry:
    """Who commanded what, from which address, and what came of it, as of now; `lease` is (epoch, sequence)."""
    error = reply.error
    return AuditEntry(
        at=time.time(),
        who=who,
        rig=rig,
        command=word,
        args=args or {},
        lease=lease,
        states=(reply.state_before, reply.state_after),
        accepted=reply.ok,
        detail=reply.unknown if error is None else f"{error.code}: {error.message}",
        address=address,
    )
