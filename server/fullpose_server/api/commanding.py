"""What every way to command a session shares: the priority channel of stop and E-stop, the answer, the audit."""

import asyncio
from collections.abc import Coroutine
from typing import Any

from fullpose_server.api.deps import Services
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.session import CommandOut, LeaseToken
from fullpose_server.runtime.contract.messages import ErrorBody, Reply
from fullpose_server.session.errors import IllegalCommandError
from fullpose_server.session.states import Command, State

# Codes of the session's refusals that are not about its state.
_STATUS = {"lease_needed": 403, "lease_lost": 403, "rig_unreachable": 503}


def by_priority(services: Services, rig: str, command: Command, who: str) -> Coroutine[Any, Any, CommandOut]:
    """Stop or E-stop, now: the flag is set in here. The coroutine, which is to be awaited, answers and audits.

    Raises `ApiError` where no rig process runs.
    """
    host = services.hosts.get(rig)
    if host is None:
        raise refusal(without_process(command))
    done = host.by_priority(command, who)

    async def answered() -> CommandOut:
        reply = await done
        await audit(services, rig, who, command, {}, None, reply)
        return answer(command, reply)

    return answered()


def without_process(command: Command) -> Reply:
    """The refusal of a rig that no process runs for: it can be connected, and nothing else."""
    state, can = State.DISCONNECTED, (Command.CONNECT,)
    error = IllegalCommandError(state, command, can)
    return Reply(False, state, state, 0, ErrorBody(error.code, str(error), state, command, list(can)))


def answer(word: str, reply: Reply) -> CommandOut:
    """The reply on the wire. Raises `ApiError` for a refusal."""
    if not reply.ok:
        raise refusal(reply)
    return CommandOut.model_validate(
        {
            "command": word,
            "state_before": reply.state_before,
            "state_after": reply.state_after,
            "revision": reply.revision,
        }
    )


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


async def audit(
    services: Services,
    rig: str,
    who: str,
    word: str,
    args: dict[str, Any],
    token: LeaseToken | None,
    reply: Reply,
) -> None:
    """Write down who commanded what, and what came of it."""
    await asyncio.to_thread(
        services.audit.write,
        who=who,
        rig=rig,
        command=word,
        args=args,
        lease=None if token is None else (token.epoch, token.sequence),
        states=(reply.state_before, reply.state_after),
        accepted=reply.ok,
        detail=None if reply.error is None else f"{reply.error.code}: {reply.error.message}",
    )
