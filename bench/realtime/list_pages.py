"""What a page of a list costs on a store of 10 000 rows of each kind, beside a bare uvicorn's answer of the same size.

    python -m bench.realtime.list_pages [--rows 10000] [--times 100] [--json FILE]

The first, a middle and the last page of 100 rows are asked for over HTTP, the connection included, of a real server
with the gate in front. One real flight, plan and comparison are made; the store is filled with copies of their rows,
with alarms, audit entries and the summaries of runs. Beside the wall time is what the server's process took of the
processor, which other programs on the machine do not change. The bound is 50 ms at p99 on an idle machine.
"""

import argparse
import http.client
import json
import os
import shutil
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from sqlalchemy import insert, select

from bench.machine import machine
from bench.realtime.bare_uvicorn import bare_server
from bench.realtime.rig_load import get, post, served
from fullpose_server.planning.compare_request import ERROR, REQUEST
from fullpose_server.runtime.recording.run_summary import RunSummary
from fullpose_server.session.alarms import Alarm, Severity
from fullpose_server.store.alarms import alarm_id
from fullpose_server.store.audit import AuditLog
from fullpose_server.store.audit_entry import AuditEntry
from fullpose_server.store.database import Database
from fullpose_server.store.tables import AlarmRow, PlanRow, Table, TrajectoryRow

PAGE = 100
BOUND_MS = 50.0
BEGAN = 1.7e9  # [s, Unix] of the first row; one a second
RIG = "vertical-4"


def _job(port: int, path: str, body: object) -> str:
    """A job of the server, done; its id."""
    status, answer = post(port, path, body)
    assert status == 202, answer
    job = json.loads(answer)["id"]
    while json.loads(get(port, f"{path}/{job}"))["status"] in ("queued", "running"):
        time.sleep(0.1)
    return str(job)


def made(data: Path) -> str:
    """A flight, a plan and a comparison of it, made by a server; the comparison's id."""
    ramp = [k / 50.0 for k in range(101)]
    flight = {"name": "roll", "time_s": ramp, "yaw_deg": ramp, "pitch_deg": ramp, "roll_deg": ramp}
    with served(data) as (port, _):
        sha256 = json.loads(post(port, "/trajectories", flight)[1])["sha256"]
        _job(port, "/plans", {"trajectory": sha256, "rig": RIG, "method": "exact"})
        return _job(port, "/compare", {"trajectory": sha256, "rig": RIG, "methods": ["exact"]})


def fill_comparisons(root: Path, model: str, rows: int) -> None:
    """Copies of a comparison, cancelled ones: what is listed has no report."""
    error = json.dumps({"status": "cancelled", "code": "cancelled", "message": "cancelled before it was done"})
    request = json.loads((root / model / REQUEST).read_text())
    for row in range(rows):
        folder = root / f"{row:016x}"
        folder.mkdir()
        (folder / REQUEST).write_text(json.dumps({**request, "created": BEGAN + row}))
        (folder / ERROR).write_text(error)


def fill_runs(folder: Path, rows: int) -> list[str]:
    """Records of which nothing but the summary is read; their ids, the oldest first."""
    found = []
    for row in range(rows):
        began = BEGAN + row
        run = f"{time.strftime('%Y%m%dT%H%M%S', time.gmtime(began))}-{RIG}-{row % 1_000_000:06d}"
        nothing: dict[str, Any] = dict.fromkeys(RunSummary.__dataclass_fields__)
        known = {
            "plan_id": f"{row:016x}",
            "id": run,
            "rig": RIG,
            "who": "ann",
            "started": began,
            "ended": began + 30.0,
            "samples": 30_000,
        }
        summary = RunSummary(**{**nothing, **known, "bytes": 8, "complete": True, "lost_samples": 0})
        record = folder / f"{run}.mcap"
        record.write_bytes(b"12345678")
        record.with_suffix(".json").write_text(json.dumps(asdict(summary)))
        found.append(run)
    return found


def fill_database(path: Path, rows: int) -> None:
    """Rows of flights, plans, alarms and the audit, each a second after the other."""
    database = Database(path)
    with database.begin() as session:
        plan = _values(session.scalars(select(PlanRow)).one())
        flight = _values(session.scalars(select(TrajectoryRow)).one())
        for row in range(rows):
            at = BEGAN + row
            session.execute(insert(PlanRow).values({**plan, "id": f"{row:016x}", "created": at}))
            session.execute(insert(TrajectoryRow).values({**flight, "sha256": f"{row:064x}", "created": at}))
            alarm = Alarm(row, "following_error", Severity.WARNING, "inner frame 1.2 deg behind", at, "inner", 1.2, 1.0)
            session.execute(insert(AlarmRow).values({"id": alarm_id("bench", row), "rig": RIG, **asdict(alarm)}))
    AuditLog(database).write([_audit(BEGAN + row) for row in range(rows)])  # each is chained to the one before
    database.close()


def _values(row: Table) -> dict[str, Any]:
    return {column.name: getattr(row, column.name) for column in row.__table__.columns}


def _audit(at: float) -> AuditEntry:
    args = {"target_deg": [0.0, 1.0, 2.0, 3.0]}
    return AuditEntry(at, "ann", RIG, "move", args, None, ("armed", "positioning"), accepted=True, detail=None)


def pages(runs: list[str]) -> dict[str, tuple[str, Callable[[int], str]]]:
    """By what is listed: the path, and where the page begins that follows the given row (counted from the oldest)."""

    def keyed(name: Callable[[int], str]) -> Callable[[int], str]:
        return lambda row: f"{BEGAN + row!r}~{name(row)}"

    return {
        "flights": ("/trajectories", keyed(lambda row: f"{row:064x}")),
        "plans": ("/plans", keyed(lambda row: f"{row:016x}")),
        "plans of one rig": (f"/plans?rig={RIG}", keyed(lambda row: f"{row:016x}")),
        "comparisons": ("/compare", keyed(lambda row: f"{row:016x}")),
        "runs": ("/runs", keyed(lambda row: runs[row])),
        "runs of one rig": (f"/runs?rig={RIG}", keyed(lambda row: runs[row])),
        "runs of one flight": ("/runs?q=roll", keyed(lambda row: runs[row])),  # all of them, by their plans' flight
        "alarms": ("/alarms", keyed(lambda row: alarm_id("bench", row))),
        "alarms of one code": ("/alarms?code=following_error", keyed(lambda row: alarm_id("bench", row))),
        "audit": ("/audit", lambda row: str(row + 1)),
    }


def asked(port: int, path: str) -> tuple[float, bytes]:
    """How long an answer takes [s], connecting included, and the answer."""
    begun = time.perf_counter()
    link = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    link.request("GET", path)
    answer = link.getresponse()
    body = answer.read()
    taken = time.perf_counter() - begun
    link.close()
    assert answer.status == 200, body
    return taken, body


def processor_s(pid: int) -> float:
    """What a process has taken of the processor so far [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure(port: int, pid: int, bare: int, path: str, times: int) -> dict[str, Any]:
    """One page, again and again, a bare answer of its size in between."""
    first_s, answer = asked(port, path)
    size = len(answer)
    assert len(json.loads(asked(port, path)[1])) == PAGE, path
    wall, beside = [], []
    before = processor_s(pid)
    for _ in range(times):
        wall.append(asked(port, path)[0])
        beside.append(asked(bare, f"/{size}")[0])
    took_s = (processor_s(pid) - before) / times
    p50, p99 = np.percentile(wall, (50, 99)) * 1e3
    return {
        "bytes": size,
        "first_ms": first_s * 1e3,
        "p50_ms": p50,
        "p99_ms": p99,
        "cpu_ms": took_s * 1e3,
        "bare_p50_ms": float(np.percentile(beside, 50)) * 1e3,
        "bare_p99_ms": float(np.percentile(beside, 99)) * 1e3,
    }


def main() -> None:
    """Fill, measure, print, and write where asked."""
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--rows", type=int, default=10_000)
    arguments.add_argument("--times", type=int, default=100)
    arguments.add_argument("--json", type=Path)
    given = arguments.parse_args()
    print(machine())
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        data = Path(folder)
        model = made(data)
        fill_comparisons(data / "comparisons", model, given.rows)
        shutil.rmtree(data / "comparisons" / model)
        with served(data) as (port, pid), bare_server() as bare:
            fill_database(data / "fullpose.db", given.rows)
            listed = pages(fill_runs(data / "runs", given.rows))
            heads = "".join(f"{head:>9}" for head in ("1st ms", "p50 ms", "p99 ms", "CPU ms"))
            print(f"{'page':28} {'kB':>6}{heads} {'bare p50':>9} {'bare p99':>9}")
            for kind, (path, key) in listed.items():
                for where, row in (("first", None), ("middle", given.rows // 2), ("last", PAGE)):
                    mark = "&" if "?" in path else "?"
                    cursor = "" if row is None else f"&before={key(row)}"
                    asks = f"/api/v1{path}{mark}limit={PAGE}{cursor}"
                    one = found[f"{kind}, {where}"] = measure(port, pid, bare, asks, given.times)
                    figures = f"{one['first_ms']:8.1f} {one['p50_ms']:8.1f} {one['p99_ms']:8.1f} {one['cpu_ms']:8.1f}"
                    beside = f"{one['bare_p50_ms']:9.1f} {one['bare_p99_ms']:9.1f}"
                    print(f"{kind + ', ' + where:28} {one['bytes'] / 1e3:6.0f} {figures} {beside}", flush=True)
    worst = max(one["p99_ms"] for one in found.values())
    print(f"largest p99: {worst:.1f} ms, the bound is {BOUND_MS:.0f} ms on an idle machine")
    if given.json is not None:
        given.json.write_text(json.dumps({"machine": machine(), "pages": found}, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
