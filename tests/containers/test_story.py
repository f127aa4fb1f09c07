"""The whole story through the proxy with TLS: upload, plan, fly, stream; server and container killed in flight."""

import asyncio
from collections.abc import Awaitable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import httpx
import numpy as np
import pytest

from fullpose_server.client import Client, ClientError
from fullpose_server.runtime.recording.mcap_reader import is_complete, read_samples
from tests.containers.engine import PASSWORD, Box, Engine, podman
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


async def refused(asked: Awaitable[Any]) -> int | None:
    """The status that a request is refused with."""
    with pytest.raises(ClientError) as refusal:
        await asked
    return refusal.value.status


async def strangers_and_viewers(proxy: Proxy) -> None:
    """Whoever is not signed in does nothing; a viewer commands nothing."""
    async with proxy.client(None) as stranger, proxy.client("viewer") as viewer:
        for asked in (stranger.rigs(), stranger.take_lease(RIG), stranger.stop(RIG), stranger.estop(RIG)):
            assert await refused(asked) == 401
        with pytest.raises(ClientError):
            async with stranger.stream(RIG, topics=["session"]) as socket:
                await socket.recv()
        assert await refused(viewer.take_lease(RIG)) == 403
        assert await refused(viewer.command(RIG, "disarm")) == 403
        assert await refused(viewer.plan("0" * 64, RIG)) == 403
        assert (await viewer.session(RIG))["state"] == "running"
        await viewer.stop("vertical-3")  # of another rig: anybody signed in may


def signed_in(proxy: Proxy) -> None:
    """By name and password, through TLS: the cookie is for TLS alone, and ends with the session."""
    page = {"Origin": proxy.url}
    with httpx.Client(base_url=f"{proxy.url}/api/v1", verify=proxy.tls, timeout=120.0, headers=page) as browser:
        wrong = browser.post("/login", json={"name": "the-viewer", "password": "not the password"})
        assert wrong.status_code == 401
        right = browser.post("/login", json={"name": "the-viewer", "password": PASSWORD})
        cookie = right.raise_for_status().headers["set-cookie"]
        assert all(word in cookie for word in ("Secure", "HttpOnly", "SameSite=strict"))
        assert browser.get("/rigs").is_success
        assert browser.post(f"/rigs/{RIG}/lease").status_code == 403
        assert browser.post("/logout").status_code == 204
        assert browser.get("/rigs").status_code == 401


def record(proxy: Proxy, run: str, folder: Path) -> Path:
    """A run's record, exported through the proxy."""
    path = folder / f"{run}.mcap"
    with httpx.Client(
        verify=proxy.tls, timeout=120.0, headers={"Authorization": f"Bearer {proxy.tokens['admin']}"}
    ) as http:
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
                await strangers_and_viewers(proxy)
                before = await client.session(RIG)
                await asyncio.to_thread(box.kill, "fullpose serve")
                session = await back(client)
                assert session["health"]["rig_pid"] == before["health"]["rig_pid"]  # the very process
                assert session["run_id"] == before["run_id"], (session["state"], session["alarms"])
                await client.take_lease(RIG, "takeover", "the server was killed")
                if session["state"] == "held":
                    await client.command(RIG, "resume")
                ended = await client.wait_state(RIG, "armed", "faulted", "estopped")
                assert ended["state"] == "armed", ended["alarms"]
                return plan, before["run_id"]

        signed_in(proxy)
        plan, run = asyncio.run(fly())
        assert "started anew, and adopts the rigs" in box.logs()
        whole = record(proxy, run, tmp_path)
        assert is_complete(whole)
        rows = read_samples(whole)
        within_limits(rows, SimpleNamespace(rig=VERTICAL, rate_hz=1000.0))
        assert np.ptp(rows["demand"], axis=0).max() > 30.0

        async def again() -> str:
            async with proxy.client() as client:
                await client.take_lease(RIG, "takeover", "the server was killed")
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
