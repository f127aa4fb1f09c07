"""What the most expensive requests cost the server: its memory, and how soon each is answered.

    python -m bench.realtime.hostile_requests [--at-once 8] [--json FILE]

Each kind is sent `--at-once` times at the same time: bodies of 100 MB, Parquet that unpacks to gigabytes, batches of a
million samples. Memory is the sum over the server and the processes it has started, rigs and planner among them
(resident, sampled every 20 ms, what they share counted once for each: never less than it is).
"""

import argparse
import io
import json
import os
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from bench.machine import machine
from bench.realtime.rig_load import served

MB = 1_000_000
NAMES = ("time_s", "yaw_deg", "pitch_deg", "roll_deg")
Send = Callable[[httpx.Client], httpx.Response]


def parquet(columns: list[pa.Array], names: tuple[str, ...] = NAMES, **options: object) -> bytes:
    """A Parquet file of these columns."""
    file = io.BytesIO()
    pq.write_table(pa.table(columns, names=list(names)), file, compression="zstd", **options)
    return file.getvalue()


def upload(data: bytes, name: str) -> Send:
    """Send it as a file."""
    return lambda client: client.post("/trajectories", files={"file": (name, data)})


def body(path: str, data: bytes) -> Send:
    """Send it as JSON, in chunks: no length is announced."""

    def chunks() -> Iterator[bytes]:
        for begin in range(0, len(data), 65536):
            yield data[begin : begin + 65536]

    return lambda client: client.post(path, content=chunks(), headers={"content-type": "application/json"})


def requests() -> dict[str, Send]:
    """The requests, by what they are."""
    zeros = pa.array(np.zeros(50 * MB))
    long = pa.array(["x" * (100 * MB)]).dictionary_encode()
    text = b'{"a": "' + b"x" * (100 * MB) + b'"}'
    groups = parquet([pa.array(np.zeros(20_000))] * 4, row_group_size=1)
    wide = ("time_s", *(f"c{k}" for k in range(5000)))
    batch = {"rig": "vertical-4", "time_s": list(range(1_000_000)), "q": [[1, 0, 0, 0]] * 1_000_000}
    flight = b'{"name": "f", "time_s": [' + b"1," * (40 * MB) + b"1]}"
    return {
        "Parquet, 50e6 rows of zeros": upload(parquet([zeros] * 4), "rows.parquet"),
        "Parquet, a dictionary of 100 MB": upload(parquet([long, *[pa.array([0.0])] * 3]), "dictionary.parquet"),
        "Parquet, 20 000 row groups": upload(groups, "groups.parquet"),
        "Parquet, 5000 columns": upload(parquet([pa.array(np.zeros(2))] * 5001, wide), "wide.parquet"),
        "Parquet, nested, one row of 50e6": upload(
            parquet([pa.ListArray.from_arrays([0, 50 * MB], zeros), *[pa.array([0.0])] * 3]), "nested.parquet"
        ),
        "JSON flight, 80 MB of numbers": body("/trajectories", flight),
        "POST /plans, 100 MB": body("/plans", text),
        "POST /compare, 100 MB": body("/compare", text),
        "POST /solve, 100 MB": body("/solve", text),
        "POST /solve, a million samples": body("/solve", json.dumps(batch).encode()),
    }


class Memory:
    """The largest resident memory of a process and of all it has started, while it is watched."""

    def __init__(self, pid: int) -> None:
        self.own = self.all = 0
        self._pid = pid
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def __enter__(self) -> "Memory":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join()

    def _watch(self) -> None:
        while not self._ended.wait(0.02):
            sizes = _sizes(self._pid)
            self.own = max(self.own, sizes.get(self._pid, 0))
            self.all = max(self.all, sum(sizes.values()))


def _sizes(root: int) -> dict[int, int]:
    """Resident bytes of a process and its descendants, by pid."""
    parents, sizes = {}, {}
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            fields = (entry / "stat").read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        parents[int(entry.name)] = int(fields[1])
        sizes[int(entry.name)] = int(fields[21]) * os.sysconf("SC_PAGE_SIZE")
    family, grown = {root}, True
    while grown:
        more = {pid for pid, parent in parents.items() if parent in family} - family
        family, grown = family | more, bool(more)
    return {pid: sizes[pid] for pid in family if pid in sizes}


def measure(port: int, pid: int, send: Send, at_once: int) -> dict[str, object]:
    """Statuses, times and memory of one kind of request."""

    def once(_: int) -> tuple[int, float]:
        with httpx.Client(base_url=f"http://127.0.0.1:{port}/api/v1", timeout=120.0) as client:
            begun = time.perf_counter()
            try:
                status = send(client).status_code
            except httpx.TransportError:  # refused while it was still sending
                status = 0
            return status, time.perf_counter() - begun

    with Memory(pid) as memory, ThreadPoolExecutor(at_once) as pool:
        answers = list(pool.map(once, range(at_once)))
    return {
        "statuses": sorted({status for status, _ in answers}),
        "longest_s": max(taken for _, taken in answers),
        "server_mb": memory.own / MB,
        "all_mb": memory.all / MB,
    }


def main() -> None:
    """Measure, print, and write where asked."""
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--at-once", type=int, default=8)
    arguments.add_argument("--json", type=Path)
    given = arguments.parse_args()
    print(machine())
    found = {}
    sent = requests()
    with tempfile.TemporaryDirectory() as folder, served(Path(folder)) as (port, pid):
        print(f"{'request':36} {'answer':>12} {'longest s':>10} {'server MB':>10} {'all MB':>8}")
        for name, send in sent.items():
            one = found[name] = measure(port, pid, send, given.at_once)
            answer = ", ".join(map(str, one["statuses"]))
            print(f"{name:36} {answer:>12} {one['longest_s']:10.2f} {one['server_mb']:10.0f} {one['all_mb']:8.0f}")
    if given.json is not None:
        given.json.write_text(json.dumps({"machine": machine(), "requests": found}, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
