"""A log of a gigabyte: time and memory of the reading beside those of the library's own parse of the same file.

    python -m bench.numerics.large_log [--size 1GB] [--folder /tmp]

Each is a process of its own, so that its peak memory is its own. The file is written first: a flight at 1 kHz with
columns that nobody reads, as logs have them. The last line is what `fullpose` does with it beside Arrow: a ratio.
"""

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from bench.machine import machine

_ROWS = 100_000  # written at once
_UNITS = {"GB": 1e9, "MB": 1e6}
_NAMES = "time_s,heading_deg,pitch_deg,bank_deg,ax,ay,az,p,q,r"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="1GB")
    parser.add_argument("--folder", type=Path, default=Path(tempfile.gettempdir()))
    parser.add_argument("--case", nargs=2, metavar=("READER", "FILE"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.case:
        print(json.dumps(READERS[arguments.case[0]](Path(arguments.case[1]))))
        return
    size = float(arguments.size[:-2]) * _UNITS[arguments.size[-2:]]
    with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
        path = Path(folder) / "log.csv"
        rows = write(path, size)
        print(machine())
        print(f"{path.stat().st_size / 1e9:.2f} GB, {rows} rows")
        print(f"{'':28}{'s':>8}{'peak MB':>10}{'MB before':>11}")
        found = {name: measured(name, path) for name in READERS}
        for name, each in found.items():
            print(f"{name:28}{each['s']:8.1f}{each['peak'] / 1e6:10.0f}{each['before'] / 1e6:11.0f}")
        base = found["Arrow, four columns"]["s"]
        print(f"fullpose / Arrow: {found['fullpose']['s'] / base:.2f}")


def write(path: Path, size: float) -> int:
    """Write a log of that many bytes; its rows."""
    rows = 0
    with path.open("wb") as file:
        file.write(f"{_NAMES}\n".encode())
        while file.tell() < size:
            t = 0.001 * np.arange(rows, rows + _ROWS)
            columns = [t, np.mod(10.0 * t, 360.0), 20.0 * np.sin(t), 40.0 * np.sin(0.7 * t)]
            columns += [np.cos(k * t) for k in range(1, 7)]
            lines = np.char.mod("%.6f", np.stack(columns, axis=-1)).tolist()
            file.write("".join(",".join(line) + "\n" for line in lines).encode())
            rows += _ROWS
    return rows


def measured(reader: str, path: Path) -> dict[str, float]:
    """One reading in a process of its own."""
    command = [sys.executable, "-m", "bench.numerics.large_log", "--case", reader, str(path)]
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    return dict(json.loads(done.stdout))


def arrow(path: Path) -> dict[str, float]:
    """The columns that a flight needs, in the library's own streaming reader, whose batches are kept."""
    import pyarrow.csv as pacsv

    wanted = pacsv.ConvertOptions(include_columns=_NAMES.split(",")[:4])
    before, begin = _peak(), time.perf_counter()
    with pacsv.open_csv(path, convert_options=wanted) as stream:
        stream.read_all()
    return {"s": time.perf_counter() - begin, "peak": _peak(), "before": before}


def fullpose(path: Path) -> dict[str, float]:
    """The flight, as every command reads it; its progress goes to stderr."""
    from fullpose_server.cli._progress import progress_bar
    from fullpose_server.formats.importers.columns import UNBOUNDED
    from fullpose_server.formats.trajectory_file import read_trajectory

    before, begin = _peak(), time.perf_counter()
    with progress_bar("read", lines=True) as progress:
        flight = read_trajectory(path, bounds=replace(UNBOUNDED, progress=progress))
    return {"s": time.perf_counter() - begin, "peak": _peak(), "before": before, "samples": flight.time.size}


READERS = {"Arrow, four columns": arrow, "fullpose": fullpose}


def _peak() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024.0


if __name__ == "__main__":
    main()
