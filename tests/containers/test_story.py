"""The whole story through the proxy with TLS: upload, plan, fly, stream; server and container killed in flight."""

import asyncio
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import httpx
import numpy as np
import pytest

from fullpose_server.client import Client, ClientError
from fullpose_server.runtime.recording.mcap_reader import is_complete, read_samples
from tests.containers.engine import Box, Engine, podman
from tests.containers.flights import FILE, RIG, VERTICAL, flown, streamed
from tests.containers.proxies import CADDY, Proxy, proxied
from tests.fullpose_server.runtime.rigs import within_limits
from tests.support.waiting import answered, until


async def back(client: Client) -> dict[str, Any]:
    """The session, once a server answers that has its rig."""

    async def asked() -> dict[str, Any] | None:
        try:
            session = await client.session(RIG)
        except ClientError:
            return None
        return session if session["health"]["rig_alive"] else None

    return await answered(asked)


def record(proxy: Proxy, run: str, folder: Path) -> Path:
    """A run's record, exported through the proxy."""
    path = folder / f"{run}.mcap"
    with httpx.Client(verify=proxy.tls, timeout=120.0, headers={"Authorization": f"Bearer {proxy.token}"}) as http:
        answer = http.get(f"{proxy.url}/api/v1/runs/{run}/export", params={"format": "mcap"})
    path.write_bytes(answer.raise_for_status().content)
    return path


@pytest.mark.parametrize("caddy", CADDY)
def test_nobody_passes_the_proxy_without_tls_or_the_server_without_a_token(
    engine: Engine, box: Box, caddy: str
) -> None:
    proxy = proxied(engine, box, caddy)
    with httpx.Client(verify=proxy.tls) as http:
        refused = http.get(f"https://localhost:{proxy.port}/api/v1/health")
    assert refused.status_code == 401
    with pytest.raises(httpx.ConnectError, match="CERTIFICATE_VERIFY_FAILED"):
        httpx.get(f"https://localhost:{proxy.port}/api/v1/health")
    plain = httpx.get(f"http://localhost:{proxy.port}/api/v1/health")
    assert plain.status_code == 400

    async def asked() -> tuple[dict[str, Any], list[dict[str, Any]]]:
        async with proxy.client() as client:
            return await client.health(), await client.rigs()

    health, rigs = asyncio.run(asked())
    assert health["status"] == "ok", health["warnings"]
    assert {"vertical-4", "horizontal-4"} <= {rig["name"] for rig in rigs}


@pytest.mark.parametrize("caddy", CADDY)
def test_a_server_killed_in_flight_is_back_and_has_its_rig_and_a_killed_container_loses_nothing(
    engine: Engine, tmp_path: Path, caddy: str
) -> None:
    volumes = engine.volumes("data", "kernels")
    with engine.server(rig=FILE, volumes=volumes) as box:
        box.wait_healthy()
        proxy = proxied(engine, box, caddy)

        async def fly() -> tuple[dict[str, Any], str]:
            async with proxy.client() as client:
                plan = await flown(client, tmp_path)
                frames = await streamed(client, 20)
                assert all(np.diff([frame["seq"] for frame in frames]) > 0)
                before = await client.session(RIG)
                await asyncio.to_thread(box.kill, "fullpose serve")
                session = await back(client)
                assert session["health"]["rig_pid"] == before["health"]["rig_pid"]  # the very process
                assert session["run_id"] == before["run_id"], (session["state"], session["alarms"])
                await client.take_lease(RIG, "takeover")
                if session["state"] == "held":
                    await client.command(RIG, "resume")
                ended = await client.wait_state(RIG, "armed", "faulted", "estopped")
                assert ended["state"] == "armed", ended["alarms"]
                return plan, before["run_id"]

        plan, run = asyncio.run(fly())
        assert "started anew, and adopts the rigs" in box.logs()
        whole = record(proxy, run, tmp_path)
        assert is_complete(whole)
        rows = read_samples(whole)
        within_limits(rows, SimpleNamespace(rig=VERTICAL, rate_hz=1000.0))
        assert np.ptp(rows["demand"], axis=0).max() > 30.0

        async def again() -> str:
            async with proxy.client() as client:
                await client.take_lease(RIG, "takeover")
                await client.command(RIG, "start")
                begun = await client.wait_state(RIG, "running", "faulted")
                assert begun["state"] == "running", begun["alarms"]
                await streamed(client, 100)
                second: str = (await client.session(RIG))["run_id"]
            return second

        second = asyncio.run(again())
        podman("kill", "--signal", "KILL", box.name)
        until(lambda: box.inspect("{{.State.Running}}") == "false")
        podman("start", box.name)
        box.wait_healthy()

        async def kept() -> None:
            async with proxy.client() as client:
                health = await client.health()
                assert health["status"] == "ok", health["warnings"]
                assert {one["id"] for one in await client.runs(RIG)} == {run, second}
                assert [one["id"] for one in await client.plans(rig=RIG)] == [plan["id"]]
                await client.take_lease(RIG)
                for word, args in (("connect", {}), ("acknowledge", {}), ("load", {"plan": plan["id"]}), ("arm", {})):
                    await client.command(RIG, word, **args)
                assert (await client.session(RIG))["state"] == "armed"

        asyncio.run(kept())
        assert record(proxy, run, tmp_path).read_bytes() == whole.read_bytes()
        torn = read_samples(record(proxy, second, tmp_path))
        assert len(torn) > 500
        within_limits(torn, SimpleNamespace(rig=VERTICAL, rate_hz=1000.0))
