"""Health says which runner has stopped."""

import asyncio
from pathlib import Path

import httpx

from fullpose_server.app import create_app
from fullpose_server.settings import Settings


def test_a_runner_that_has_stopped_shows_in_health(tmp_path: Path) -> None:
    async def inside() -> None:
        app = create_app(Settings(data_dir=tmp_path))
        wire = httpx.ASGITransport(app)
        async with (
            app.router.lifespan_context(app),
            httpx.AsyncClient(transport=wire, base_url="http://127.0.0.1") as http,
        ):
            assert (await http.get("/api/v1/health")).json()["status"] == "ok"
            await app.state.services.comparisons.close()
            now = (await http.get("/api/v1/health")).json()
        assert now["status"] == "degraded"
        assert "comparisons are made no more" in now["warnings"]

    asyncio.run(inside())
