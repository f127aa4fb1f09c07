"""What every way to command a session shares: the priority channel of stop and E-stop, and the audit that follows."""

import time
from collections.abc import Coroutine
from typing import Any

from fullpose_server.api.deps import Services
from fullpose_server.api.schemas.session import LeaseToken
from fullpose_server.api.stopping import NOTHING_RUNS
from fullpose_server.runtime.contract.messages import ErrorBody, Reply
from fullpose_server.session.errors import IllegalCommandError
from fullpose_server.session.states import Command, State
from fullpose_server.store.audit import AuditEntry


def by_priority(services: Services, rig: str, command: Command, who: str) -> Coroutine[Any, Any, Reply]:
    """Stop or E-stop, now: the flag is set in here. The coroutine, which is to be awaited, replies and audits."""
    host = services.hosts.get(rig)
    done = None if host is None else host.by_priority(command, who)

    async def replied() -> Reply:
        reply = NOTHING_RUNS if done is None else await done
        audit(services, rig, who, command, {}, None, reply)
        return reply

    return replied()


def without_process(command: Command) -> Reply:
    """The refusal of a rig that no process runs for: it can be connected, and nothing else."""
    state, can = State.DISCONNECTED, (Command.CONNECT,)
    error = IllegalCommandError(state, command, can)
    return Reply(False, state, state, 0, ErrorBody(error.code, str(error), state, command, list(can)))


def audit(
    services: Services,
    rig: str,
    who: str,
    word: str,
    args: dict[str, Any],
    token: LeaseToken | None,
    reply: Reply,
) -> None:
    """Have written down who commanded what, and what came of it; nobody waits for that."""
    error = reply.error
    services.trail.follow(
        AuditEntry(
            at=time.time(),
            who=who,
            rig=rig,
            command=word,
            args=args,
            lease=None if token is None else (token.epoch, token.sequence),
            states=(reply.state_before, reply.state_after),
            accepted=reply.ok,
            detail=reply.unknown if error is None else f"{error.code}: {error.message}",
        )
    )
