"""`fullpose demo`: serve, with a rig flying a real flight over and over, by the same API that a person uses."""

import asyncio
import sys
from contextlib import suppress
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fullpose_server.cli._arguments import Config
from fullpose_server.cli._exit import CommandError

if TYPE_CHECKING:
    from fullpose_server.client import Client

RIG, METHOD = "vertical-limited", "plan"
FLIGHT, CONVENTION, NAME = "loop_and_roll.csv", "ned", "Loop and roll, A-4 Skyhawk"
PAUSE_S, LONGEST_PAUSE_S = 3.0, 60.0
RENEW_S = 1.0
LATCHED = ("estopped", "faulted")


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("demo", help="Serve, with a rig that flies a real flight; the first line printed is the address.")(demo)


def demo(
    host: Annotated[str | None, typer.Option(help="Address to listen on (127.0.0.1).")] = None,
    port: Annotated[int | None, typer.Option(help="Port to listen on (8642); 0 takes a free one.")] = None,
    data_dir: Annotated[
        Path | None, typer.Option(help="Where everything is kept (~/.local/share/fullpose/demo).")
    ] = None,
    config: Config = None,
) -> None:
    """Serve until Ctrl-C; open the address in a browser."""
    from fullpose_server.cli._configuration import configured, to_serve
    from fullpose_server.cli._serving import run
    from fullpose_server.settings import default_data_dir

    run(to_serve(configured(host, port, data_dir or default_data_dir() / "demo", config)).settings, fly)


async def fly(url: str) -> None:
    """Upload, plan, load, arm, and fly until cancelled. Lets an operator who takes the lease have the rig.

    Raises `CommandError` where the server refuses for good.
    """
    from fullpose_server.client import Client, ClientError

    try:
        async with Client(url, name="demo") as client:
            _tell(f"{NAME} on {RIG}: planning it")
            pilot = Pilot(client, await prepare(client))
            while True:
                await pilot.turn()
                await asyncio.sleep(pilot.pause_s)
    except ClientError as error:
        raise CommandError(str(error)) from error


async def prepare(client: "Client") -> dict[str, Any]:
    """The flight, uploaded and planned; the plan of an earlier demo is used again."""
    from fullpose_server.client import ClientError

    with resources.as_file(resources.files("fullpose_server") / "demo_flights" / FLIGHT) as file:
        flight = await client.upload(file, CONVENTION, NAME)
    for plan in await client.plans(flight["sha256"], RIG):
        if plan["flyable"] and plan["method"] == METHOD:
            return plan
    plan = await client.plan(flight["sha256"], RIG, METHOD)
    if not plan["flyable"]:
        why = plan["refusal"] or (plan["error"] or {}).get("message")
        raise ClientError(f"the demo's flight cannot be flown: {why}")
    return plan


class Pilot:
    """Flies the plan as an operator would: one command a turn, and what keeps it from flying is said."""

    def __init__(self, client: "Client", plan: dict[str, Any]) -> None:
        self._client = client
        self._plan = plan
        self._said = ""
        self.pause_s = PAUSE_S  # until the next turn; longer where fault follows fault

    async def turn(self) -> None:
        """Bring the session to its next step, where it is ours to bring."""
        from fullpose_server.client import ClientError

        session = await self._client.session(RIG)
        if session["lease"]["holder"] not in (None, self._client.name):
            self._say(f"{session['lease']['holder']} has the rig")
            return
        if session["state"] == "estopped":
            self._say(f"{RIG} is E-stopped: look at it, acknowledge and reset")
            return
        try:
            await self._client.take_lease(RIG)
            await self._step(session)
        except ClientError as error:
            if error.status not in (403, 409, 503):
                raise
            if session["state"] != "faulted":  # where it is, a reset is refused until the rig is at rest
                self._say(str(error))

    async def _step(self, session: dict[str, Any]) -> None:
        match session["state"]:
            case "faulted":
                await self._reset(session["alarms"])
            case "disconnected":
                await self._command("connect")
            case "idle":
                await self._command("load", plan=self._plan["id"])
            case "ready":
                await self._command("arm")
            case "armed":
                await self._command("start")
                self._say(f"{NAME} on {RIG}: flying, planned with {self._plan['method']}. Ctrl-C ends.")
                if await watch(self._client) == "armed":
                    self.pause_s = PAUSE_S

    async def _reset(self, alarms: list[dict[str, Any]]) -> None:
        cause = next((alarm for alarm in alarms if alarm["first"]), {"message": "no alarm says why"})
        self._say(f"{RIG} is faulted: {cause['message']}. It goes on once at rest")
        await self._command("acknowledge")
        await self._command("reset")
        self.pause_s = min(2.0 * self.pause_s, LONGEST_PAUSE_S)

    async def _command(self, command: str, **args: Any) -> None:
        await self._client.command(RIG, command, **args)

    def _say(self, text: str) -> None:
        """Once, while nothing else is to be said."""
        if text != self._said:
            self._said = text
            _tell(text)


def _tell(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


async def watch(client: "Client") -> str:
    """Renew the lease until the run has ended, or an operator has taken over; the state then."""
    from fullpose_server.client import ClientError

    renewing = asyncio.create_task(_renew(client))
    try:
        ended = await client.wait_state(RIG, "armed", "ready", "idle", "disconnected", *LATCHED)
        return str(ended["state"])
    finally:
        renewing.cancel()
        with suppress(asyncio.CancelledError, ClientError):
            await renewing


async def _renew(client: "Client") -> None:
    while True:
        await asyncio.sleep(RENEW_S)
        await client.take_lease(RIG, "renew")
