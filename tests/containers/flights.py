"""What the containers' tests fly: a rig that bears a starved machine, a flight, and how it is begun."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from fullpose.rig import builtin_rigs
from fullpose_server.client import Client
from fullpose_server.formats.rig_toml import rig_toml

RIG = "bench"
# A starved machine is late, and a container's loop may have no real time: what is tested here is not how much.
PATIENT = """
[drive]
name = "simulated"
watchdog_s = 20.0
[guard]
following_deg = {trip = 60.0}
attitude_deg = {}
lateness_ms = {}
misses_per_s = {}
[silence.owner]
hold_s = 200.0
stop_s = 300.0
disarm_s = 400.0
[silence.server]
hold_s = 0.5
stop_s = 300.0
disarm_s = 400.0
"""
VERTICAL = builtin_rigs()["vertical-4"]
FILE = rig_toml(VERTICAL).replace('name = "vertical-4"', f'name = "{RIG}"') + PATIENT
SECONDS = 30
FLIGHT = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(
    f"{k / 10},{20 * np.sin(k / 30)},{10 * np.sin(k / 20)},{5 * np.sin(k / 10)}\n" for k in range(10 * SECONDS + 1)
)


async def flown(client: Client, folder: Path) -> dict[str, Any]:
    """Upload, plan, load, arm and start; the plan, once the rig is running."""
    flight = folder / "flight.csv"
    flight.write_text(FLIGHT)
    stored = await client.upload(flight)
    plan = await client.plan(stored["sha256"], RIG, method="exact")
    assert plan["flyable"], plan
    await client.take_lease(RIG)
    for word, args in (("connect", {}), ("load", {"plan": plan["id"]}), ("arm", {}), ("start", {})):
        await client.command(RIG, word, **args)
    begun = await client.wait_state(RIG, "running", "faulted")
    assert begun["state"] == "running", begun["alarms"]
    return plan


async def streamed(client: Client, count: int) -> list[dict[str, Any]]:
    """So many frames of telemetry."""
    frames: list[dict[str, Any]] = []
    async with client.stream(RIG, topics=["telemetry"], rate_hz=50) as socket:
        async for text in socket:
            message = json.loads(text)
            if message["type"] == "telemetry":
                frames.append(message)
            if len(frames) == count:
                break
    return frames
