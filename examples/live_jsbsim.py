"""Fly JSBSim live on a rig of a running server, and say how well the rig follows.

    fullpose serve                                    # in another terminal
    python examples/live_jsbsim.py [--url http://127.0.0.1:8642] [--rig vertical-4] [--method exact] [--seconds 20]

JSBSim (pip install jsbsim) integrates a Cessna 172 in real time, a hand on the stick sways it, and every 5 ms its
attitude goes to the rig over the WebSocket. The reply to each sample says what the rig was told, and how far from it.
"""

import argparse
import asyncio
import contextlib
import json
import math
import os
import time
from typing import Any

import jsbsim
from websockets.asyncio.client import ClientConnection

from fullpose_server.client import Client, ClientError

RATE_HZ = 200


def aircraft() -> jsbsim.FGFDMExec:
    """A Cessna 172, trimmed in level flight to the north."""
    os.environ.setdefault("JSBSIM_DEBUG", "0")  # or it prints a banner
    made = jsbsim.FGFDMExec(None)
    made.load_model("c172x")
    made.set_dt(1.0 / RATE_HZ)
    for name, value in (("ic/h-sl-ft", 4000.0), ("ic/vc-kts", 100.0), ("ic/psi-true-deg", 0.0), ("ic/gamma-deg", 0.0)):
        made[name] = value
    made.run_ic()
    made["propulsion/set-running"] = -1
    made["simulation/do_simple_trim"] = 0
    return made


async def send(link: ClientConnection, plane: jsbsim.FGFDMExec, seconds: float) -> None:
    """Integrate in real time and send every step."""
    elevator = plane["fcs/elevator-cmd-norm"]
    begun = time.monotonic()
    for step in range(int(seconds * RATE_HZ)):
        t = step / RATE_HZ
        plane["fcs/aileron-cmd-norm"] = 0.12 * math.sin(1.3 * t)
        plane["fcs/elevator-cmd-norm"] = elevator - 0.06 * math.sin(0.9 * t)
        plane.run()
        sample = {
            "type": "sample",
            "time_s": plane.get_sim_time(),
            "euler_deg": [plane[f"attitude/{name}-deg"] for name in ("psi", "theta", "phi")],
            "body_rate_deg_s": [math.degrees(plane[f"velocities/{axis}-rad_sec"]) for axis in "pqr"],
        }
        await link.send(json.dumps(sample))
        await asyncio.sleep(max(0.0, begun + (step + 1) / RATE_HZ - time.monotonic()))


async def gather(link: ClientConnection, replies: list[dict[str, Any]]) -> None:
    """Every message of the server."""
    while True:
        replies.append(json.loads(await link.recv()))


async def renew(client: Client, rig: str) -> None:
    """Stay in command: a silent operator's rig is stopped."""
    while True:
        await asyncio.sleep(1.0)
        await client.take_lease(rig, "renew")


async def fly(url: str, rig: str, method: str, seconds: float) -> None:
    """Take the rig, follow JSBSim, stop, and give the rig back."""
    replies: list[dict[str, Any]] = []
    async with Client(url, name="jsbsim") as client:
        await client.take_lease(rig)
        if (await client.session(rig))["state"] == "disconnected":
            await client.command(rig, "connect")
        async with client.live(rig, method=method, convention="ned") as link:
            await client.command(rig, "arm")
            await client.command(rig, "go_live")
            beside = [asyncio.create_task(gather(link, replies)), asyncio.create_task(renew(client, rig))]
            await send(link, aircraft(), seconds)
            with contextlib.suppress(ClientError):  # it has stopped by itself: its alarms say why
                await client.stop(rig)  # without it the rig would stop by itself, and say that its source was lost
            for task in beside:
                task.cancel()
            await asyncio.gather(*beside, return_exceptions=True)
        session = await client.wait_state(rig, "armed", "faulted")
        for alarm in session["alarms"]:
            print(f"{alarm['severity']}: {alarm['message']}")
        for word in ("disarm", "unload"):
            await client.command(rig, word)
        await client.release_lease(rig)
    report([reply for reply in replies if reply["type"] == "reply" and reply["status"] == ["followed"]], len(replies))


def report(followed: list[dict[str, Any]], answers: int) -> None:
    """What the replies say."""
    if not followed:
        raise SystemExit(f"no sample of {answers} was followed")
    settled = followed[len(followed) // 2 :]

    def worst(name: str) -> float:
        return max(reply[name] for reply in settled)

    late = sorted(reply["server_latency_us"] / 1e3 for reply in settled)
    print(f"{answers} samples answered, {len(followed)} followed")
    print(f"solve error up to {worst('error_deg'):.1e} deg, behind the sample by up to {worst('lag_deg'):.2f} deg")
    print(f"smallest margin to a limit {min(reply['margin'] for reply in settled):.0%}")
    print(f"reply after {late[len(late) // 2]:.1f} ms, 99 of 100 within {late[int(0.99 * len(late))]:.1f} ms")


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description="Fly JSBSim live on a rig.")
    parser.add_argument("--url", default="http://127.0.0.1:8642")
    parser.add_argument("--rig", default="vertical-4")
    parser.add_argument("--method", default="exact", help="one that keeps the limits, or preview")
    parser.add_argument("--seconds", type=float, default=20.0)
    given = parser.parse_args()
    asyncio.run(fly(given.url, given.rig, given.method, given.seconds))


if __name__ == "__main__":
    main()
