"""The offload processes after a start: a request waits for the one that is being made ready, and starts no other."""

import asyncio
import subprocess
import sys
from pathlib import Path

import pytest

from fullpose_server.api.offload.pool import Offload
from fullpose_server.api.offload.work import ReadRequest, Work
from fullpose_server.planning.worker_process import WorkerProcess
from fullpose_server.settings import Settings

FLIGHT = "time_s,yaw_deg,pitch_deg,roll_deg\n0,0,0,0\n1,1,0,0\n"


def test_requests_right_after_a_start_begin_no_second_process_beside_the_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    starting, most = 0, 0
    start = WorkerProcess.start

    async def counted(worker: WorkerProcess) -> None:
        nonlocal starting, most
        starting += 1
        most = max(most, starting)
        try:
            await start(worker)
        finally:
            starting -= 1

    monkeypatch.setattr(WorkerProcess, "start", counted)

    async def inside() -> None:
        offload = Offload(Settings(data_dir=tmp_path))
        offload.start()
        try:
            answers = await asyncio.gather(*(offload.run(Work.READ_FILE, asked(number)) for number in range(3)))
        finally:
            await offload.close()
        assert [answer["facts"]["samples"] for answer in answers] == [2, 2, 2]

    def asked(number: int) -> dict[str, object]:
        source, folder = tmp_path / f"{number}.csv", tmp_path / f"flight-{number}"
        source.write_text(FLIGHT, encoding="utf-8")
        folder.mkdir()
        return ReadRequest(str(source), str(folder), rows=10, columns=10, file=source.name).to_json()

    asyncio.run(inside())
    assert most == 1


def test_an_offload_process_loads_nothing_of_what_only_the_server_needs() -> None:
    code = "import sys, fullpose_server.api.offload.work; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    heavy = {"fastapi", "sqlalchemy", "scipy", "numba", "fullpose_server.formats.rig_document"}
    assert heavy & set(done.stdout.split()) == set()
