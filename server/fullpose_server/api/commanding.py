"""What every way to command a session shares: its secrets, the priority channel of stop and E-stop, the audit."""

import asyncio
from collections.abc import Coroutine
from typing import Any

from fullpose_server.api.deps import Services
from fullpose_server.api.stopping import NOTHING_RUNS, audit_entry
from fullpose_server.errors import FileError, NotFoundError
from fullpose_server.formats.plan_folder import rig_hash
from fullpose_server.runtime.contract.messages import ErrorBody, Reply
from fullpose_server.session.errors import IllegalCommandError
from fullpose_server.session.states import Command, State
from fullpose_server.store.audit_entry import of_no_rig

_LONGEST_NAME = 64


def by_priority(
    services: Services, rig: str, command: Command, who: str, address: str | None
) -> Coroutine[Any, Any, Reply]:
    """Stop or E-stop, now: the flag is set in here. The coroutine, which is to be awaited, replies and audits."""
    host = services.hosts.get(rig)
    done = None if host is None else host.by_priority(command, who)

    async def replied() -> Reply:
        reply = NOTHING_RUNS if done is None else await done
        audit(services, rig, who, command, {}, None, reply, address)
        return reply

    return replied()


async def with_rig_file(services: Services, rig: str, args: dict[str, Any]) -> dict[str, Any]:
    """The arguments of a load or an arm, and which rig the rig's file says by now, where it says one."""
    try:
        entry = await asyncio.to_thread(services.rigs.get, rig)
    except (NotFoundError, FileError):
        return args  # a rig that runs is known, whatever has become of its file
    return args | {"rig_file_hash": rig_hash(entry.rig)}


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
    lease: tuple[int, int] | None,
    reply: Reply,
    address: str | None,
) -> None:
    """Have written down who commanded what, from where, and what came of it; nobody waits for that.

    `lease`: epoch, sequence.
    """
    services.trail.follow(audit_entry(rig, who, word, reply, args, lease, address))


def audit_of_people(
    services: Services,
    who: str,
    word: str,
    address: str | None,
    *,
    about: str | None = None,
    refused: str | None = None,
) -> None:
    """Have written down who signed in, or changed what about whom; it is no rig's."""
    told: dict[str, Any] = {} if about is None else {"about": about}
    services.trail.follow(of_no_rig(who[:_LONGEST_NAME], word, told, address, refused))
