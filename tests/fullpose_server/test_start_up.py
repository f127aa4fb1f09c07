"""What the server loads before it answers."""

import subprocess
import sys

HEAVY = ("viser", "trimesh", "alembic", "httpx", "piqp")


def test_the_app_loads_without_what_draws_plans_or_migrates() -> None:
    code = "import sys, fullpose_server.cli._event_loop; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert "fullpose_server.scene.proxy" in loaded
    assert loaded.isdisjoint(HEAVY)
