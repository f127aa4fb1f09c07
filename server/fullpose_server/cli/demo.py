"""`fullpose demo`: serve, with a rig flying a real flight over and over, by the same API that a person uses."""

import asyncio
import sys
from contextlib import suppress
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fullpose_server.cli._arguments import Config
from fullpose_server.cli._exit import CommandError, say

if TYPE_CHECKING:
    from fullpose_server.client import Client

RIG, METHOD = "vertical-4", "plan"
FLIGHT, CONVENTION, NAME = "loop.csv", "ned", "Loop, A-4 Skyhawk"
PAUSE_S = 3.0
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
    from fullpose_server.cli._configuration import configured
    from fullpose_server.cli._serving import run
    from fullpose_server.settings import default_data_dir

    run(configured(host, port, data_dir or default_data_dir() / "demo", config).settings, fly)


async def fly(url: str) -> None:
    """Upload, plan, load, arm, and fly until cancelled. Lets an operator who takes the lease have the rig.

    Raises `CommandError` where the server refuses for good.
    """
    from fullpose_server.client import Client, ClientError

    try:
        async with Client(url, name="demo") as client:
            plan = await prepare(client)
            sys.stdout.write(f"{NAME} on {RIG}: planned with {plan['method']}, flying it over and over. Ctrl-C ends.\n")
            sys.stdout.flush()
            while True:
                await turn(client, plan)
                await asyncio.sleep(PAUSE_S)
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


async def turn(client: "Client", plan: dict[str, Any]) -> None:
    """Bring the session to its next step: one command where it is ours to give one, else nothing."""
    from fullpose_server.client import ClientError

    session = await client.session(RIG)
    holder, state = session["lease"]["holder"], session["state"]
    if holder not in (None, client.name) or state in LATCHED:
        return  # an operator has the rig, or must look at it first
    try:
        await client.take_lease(RIG)
        match state:
            case "disconnected":
                await client.command(RIG, "connect")
            case "idle":
                await client.command(RIG, "load", plan=plan["id"])
            case "ready":
                await client.command(RIG, "arm")
            case "armed":
                await client.command(RIG, "start")
                await watch(client)
    except ClientError as error:
        if error.status not in (403, 409, 503):
            raise
        say(f"demo: {error}")


async def watch(client: "Client") -> None:
    """Renew the lease until the run has ended, or an operator has taken over."""
    from fullpose_server.client import ClientError

    renewing = asyncio.create_task(_renew(client))
    try:
        await client.wait_state(RIG, "armed", "ready", "idle", "disconnected", *LATCHED)
    finally:
        renewing.cancel()
        with suppress(asyncio.CancelledError, ClientError):
            await renewing


async def _renew(client: "Client") -> None:
    while True:
        await asyncio.sleep(RENEW_S)
        await client.take_lease(RIG, "renew")
