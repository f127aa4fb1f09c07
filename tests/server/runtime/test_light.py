"""A rig process starts in seconds and holds no more than it needs."""

import json
import subprocess
import sys

import pytest

HEAVY = ["fastapi", "pyarrow", "pydantic", "sqlalchemy", "starlette", "uvicorn", "viser", "websockets", "asyncio"]
HEAVY += ["scipy.linalg", "scipy.optimize", "scipy.spatial", "scipy.interpolate", "server.api", "server.store"]


@pytest.mark.parametrize("module", ["server.runtime.process", "server.runtime.recorder"])
def test_nothing_of_the_web_server_is_in_its_processes(module: str) -> None:
    script = f"import json, sys, {module}, server.drives.simulated; print(json.dumps(sorted(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert set(json.loads(done.stdout)) & set(HEAVY) == set()
