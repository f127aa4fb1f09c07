"""Sessions: the snapshot, commands, the lease, stop and E-stop on the priority channel, alarms."""

import asyncio
from dataclasses import replace
from typing import Annotated, Any

from fastapi import APIRouter, Body, Response

from fullpose_server.api.admission import forbidden
from fullpose_server.api.commanding import audit, by_priority, with_rig_file, without_process
from fullpose_server.api.deps import AddressDep, PersonDep, Services, ServicesDep, WhoDep, WhoStopsDep
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.lease import LeaseGiven, LeaseIn, proof_by
from fullpose_server.api.schemas.session import (
    AlarmOut,
    CommandDone,
    CommandIn,
    CommandOut,
    LoadArgs,
    SessionOut,
)
from fullpose_server.api.session_view import lease_out, session_out
from fullpose_server.api.stopping import answer, refusal, status_of
from fullpose_server.people.admitted import Credential
from fullpose_server.people.roles import Role
from fullpose_server.planning.plan_result import refusal_of
from fullpose_server.runtime.contract.messages import ErrorBody, Reply
from fullpose_server.runtime.supervisor.errors import HostError, RefusedError, RequestTooLargeError
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.secret import new_secret
from fullpose_server.session.lease import GIVES_SECRET, LEASE_NEEDED, LeaseAction
from fullpose_server.session.states import NEEDS_NO_LEASE, Command

router = APIRouter(prefix="/rigs/{rig}", tags=["session"])

REFUSED: dict[int | str, dict[str, Any]] = {
    409: {"description": "The session refuses; nothing has changed. Names state, command and what is allowed"},
    503: {"description": "The rig process does not answer"},
}
STOPPED = REFUSED | {
    202: {
        "model": CommandOut,
        "description": "A stop was given to a rig process that is not there, or does not answer: `unknown` tells",
    }
}


@router.get("/session")
async def get_session(rig: str, services: ServicesDep) -> SessionOut:
    """The session as of now."""
    await _known(services, rig)
    return session_out(services.hosts, rig, services.settings.rig_rate_hz)


@router.get("/alarms")
async def get_alarms(rig: str, services: ServicesDep) -> list[AlarmOut]:
    """The rig's alarms, standing and past, the newest last."""
    await _known(services, rig)
    return session_out(services.hosts, rig, services.settings.rig_rate_hz).history


@router.post("/commands", responses=STOPPED)
async def command(
    rig: str,
    body: Annotated[CommandIn, Body()],
    services: ServicesDep,
    person: PersonDep,
    who: WhoStopsDep,
    address: AddressDep,
    response: Response,
) -> CommandDone:
    """Command the session. Needs the lease and an operator, but for stop and estop."""
    if body.command in NEEDS_NO_LEASE:
        done = await _by_priority(services, rig, Command(body.command), who, address, response)
        return CommandDone(**done.model_dump())
    if person is not None and not person.role.may(Role.OPERATOR):
        raise forbidden(person, Role.OPERATOR)
    host = services.hosts.get(rig)
    if host is None:
        raise await _refused_without_process(services, rig, body, who, address)
    args: dict[str, Any] = body.args.model_dump(exclude_none=True)
    if isinstance(body.args, LoadArgs):
        args = await _load_args(services, rig, body.args)
    key = new_secret() if "live" in args else None
    if body.command in (Command.LOAD, Command.ARM):
        args = await with_rig_file(services, rig, args)
    shown = None if body.lease is None else body.lease.shown(person)
    try:
        reply = await host.command(body.command, args, who, shown, key)
    except RequestTooLargeError as error:
        raise ApiError(413, "too-large", str(error), command=body.command) from None
    audit(services, rig, who, body.command, body.args.model_dump(exclude_none=True), _numbers(body), reply, address)
    return CommandDone(**answer(body.command, reply).model_dump(), live_key=key)


@router.post("/stop", responses=STOPPED)
async def stop(
    rig: str, services: ServicesDep, who: WhoStopsDep, address: AddressDep, response: Response
) -> CommandOut:
    """Brake every frame inside its limits (IEC 60204-1 category 2). Needs no lease and waits for no other command."""
    return await _by_priority(services, rig, Command.STOP, who, address, response)


@router.post("/estop", responses=STOPPED)
async def estop(
    rig: str, services: ServicesDep, who: WhoStopsDep, address: AddressDep, response: Response
) -> CommandOut:
    """Brake as fast as the limits allow, then disable the drive (IEC 60204-1 category 1). No lease; waits for nothing.

    It is no safety function: the hardware chain beside the rig is.
    """
    return await _by_priority(services, rig, Command.ESTOP, who, address, response)


@router.post("/lease", responses=REFUSED)
async def lease(
    rig: str, services: ServicesDep, person: PersonDep, who: WhoDep, address: AddressDep, body: LeaseIn | None = None
) -> LeaseGiven:
    """Take, request, grant, renew or release the lease. Who has its secret holds it, and where people sign in it is
    that person's alone."""
    body = body or LeaseIn()
    if body.action == LeaseAction.TAKEOVER and person is not None and not (body.reason or "").strip():
        raise ApiError(422, "reason", "reason: expected why the lease is taken over from its holder, for the audit")
    return await _lease(services, await _host(services, rig), person, who, address, body)


async def _by_priority(
    services: Services, rig: str, command: Command, who: str, address: str | None, response: Response
) -> CommandOut:
    if services.hosts.get(rig) is None:  # otherwise nothing is waited for before the flag is set
        await _known(services, rig)
    done = answer(command, await by_priority(services, rig, command, who, address))
    response.status_code = status_of(done)
    return done


async def _lease(
    services: Services, host: RigHost, person: Credential | None, who: str, address: str | None, body: LeaseIn
) -> LeaseGiven:
    before, action = host.snapshot().state, LeaseAction(body.action)
    given = new_secret() if action in GIVES_SECRET else None
    args = body.model_dump(include={"to", "reason"}, exclude_none=True)
    try:
        held = await host.lease(action, who, proof_by(given or body.secret or "", person), body.to)
    except RefusedError as refused:
        audit(services, host.name, who, f"lease {action}", args, None, refused.reply, address)
        raise refusal(refused.reply) from None
    if action is not LeaseAction.RENEW:  # every few seconds; it says nothing that the next command does not
        reply = Reply(ok=True, state_before=before, state_after=host.snapshot().state, revision=host.revision)
        audit(services, host.name, who, f"lease {action}", args, (held.epoch, held.sequence), reply, address)
    return LeaseGiven(**lease_out(held).model_dump(), secret=given)


def _numbers(body: CommandIn) -> tuple[int, int] | None:
    """What the audit keeps of the lease that a command shows."""
    return None if body.lease is None else (body.lease.epoch, body.lease.sequence)


async def _refused_without_process(
    services: Services, rig: str, body: CommandIn, who: str, address: str | None
) -> ApiError:
    """Nobody holds the lease of a rig without a process: no command is started one for, taking the lease does that."""
    await _known(services, rig)
    reply = without_process(Command(body.command))
    if body.command == Command.CONNECT:
        lease_needed = ErrorBody("lease_needed", LEASE_NEEDED, reply.state_before, body.command, [body.command])
        reply = replace(reply, error=lease_needed)
    audit(services, rig, who, body.command, body.args.model_dump(exclude_none=True), _numbers(body), reply, address)
    return refusal(reply)


async def _known(services: Services, rig: str) -> None:
    """Raises `NotFoundError`; a rig that runs is known, whatever has become of its file."""
    if services.hosts.get(rig) is None:
        await asyncio.to_thread(services.rigs.get, rig)


async def _host(services: Services, rig: str) -> RigHost:
    try:
        return await services.hosts.ensure(rig)
    except HostError as error:
        raise ApiError(503, "rig-process", str(error)) from None


async def _load_args(services: Services, rig: str, args: LoadArgs) -> dict[str, Any]:
    if args.live is not None:
        return {"live": args.live.model_dump()}
    plan = args.plan or ""
    row = await asyncio.to_thread(services.plans.get, plan)
    result = row.result or {}
    why = None
    if row.rig != rig:
        why = f"plan {plan} is for rig {row.rig}, not {rig}"
    elif row.status != "done":
        why = f"plan {plan} is {row.status}"
    elif (refused := refusal_of(result)) is not None:
        why = f"plan {plan} cannot be flown: {refused}"
    if why is not None:
        raise ApiError(409, "not-flyable", why, state=services.hosts.state(rig), command="load")
    return {"plan_folder": str(services.plans.folder(plan).resolve()), "plan_hash": result["plan_hash"]}
