"""A rig process starts in seconds and holds no more than it needs."""

import json
import subprocess
import sys

import pytest

HEAVY = ["fastapi", "pyarrow", "pydantic", "sqlalchemy", "starlette", "uvicorn", "viser", "websockets", "asyncio"]
HEAVY += [
    "scipy.linalg",
    "scipy.optimize",
    "scipy.spatial",
    "scipy.interpolate",
    "fullpose_server.api",
    "fullpose_server.store",
]


@pytest.mark.parametrize(
    "module", ["fullpose_server.runtime.loop.process", "fullpose_server.runtime.recording.recorder"]
)
def test_nothing_of_the_web_server_is_in_its_processes(module: str) -> None:
    script = f"import json, sys, {module}, fullpose_server.drives.simulated; print(json.dumps(sorted(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert set(json.loads(done.stdout)) & set(HEAVY) == set()
