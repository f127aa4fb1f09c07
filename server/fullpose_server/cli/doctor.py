"""`fullpose doctor`: whether this machine is fit to run a rig, and how to make it so."""

import os
import resource
import shutil
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from fullpose_server.cli._arguments import Config
from fullpose_server.cli._exit import BAD_INPUT, DONE

PRIORITY = 60
ENOUGH_BYTES = 2_000_000_000
SLEEPS = 500


@dataclass(frozen=True)
class Finding:
    """One check: ok, note (works, not as well as it could) or wrong, with what to do."""

    level: str
    topic: str
    text: str


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("doctor", help="Check whether this machine is fit to run a rig.")(doctor)


def doctor(
    data_dir: Annotated[Path | None, typer.Option(help="Where the server keeps its data.")] = None,
    port: Annotated[int | None, typer.Option(help="The port to be used (8642).")] = None,
    config: Config = None,
) -> None:
    """Print one line a check, for a server with the settings as they are. Exit 2 where something is wrong."""
    from fullpose_server.cli._configuration import configured

    settings = configured(port=port, data_dir=data_dir, config=config).settings
    findings = [found for check in checks(settings.data_dir, settings.port) for found in check()]
    for found in findings:
        typer.echo(f"{found.level:<6}{found.topic:<12}{found.text}")
    raise typer.Exit(BAD_INPUT if any(found.level == "wrong" for found in findings) else DONE)


def checks(data_dir: Path, port: int) -> list[Callable[[], Iterator[Finding]]]:
    """All checks, in order."""
    return [
        _python,
        _scheduling,
        _locked_memory,
        _shared_memory,
        _timer,
        lambda: _data(data_dir),
        lambda: _port(port),
        _console,
        _kernels,
    ]


def _python() -> Iterator[Finding]:
    from fullpose_server.version import VERSION

    yield Finding("ok", "version", f"Fullpose {VERSION}, Python {sys.version.split()[0]}, {os.cpu_count()} processors")


def _scheduling() -> Iterator[Finding]:
    from fullpose_server.runtime.loop.scheduling_rights import CAP_SYS_NICE, own_rights, why_refused

    rights = own_rights()
    try:
        before = os.sched_getscheduler(0)
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
        os.sched_setscheduler(0, before, os.sched_param(0))
    except OSError as error:
        why = why_refused(rights, PRIORITY)
        yield Finding(
            "note", "real time", f"SCHED_FIFO refused ({error.strerror}); a loop will be late at times: {why}"
        )
    else:
        by = "CAP_SYS_NICE" if rights.may(CAP_SYS_NICE) else f"RLIMIT_RTPRIO {rights.rtprio}"
        yield Finding("ok", "real time", f"SCHED_FIFO {PRIORITY} is allowed, by {by}")


def _locked_memory() -> Iterator[Finding]:
    from fullpose_server.runtime.loop.scheduling_rights import CAP_IPC_LOCK, own_rights

    soft, _ = resource.getrlimit(resource.RLIMIT_MEMLOCK)
    if soft == resource.RLIM_INFINITY or soft > 1 << 30 or own_rights().may(CAP_IPC_LOCK):
        yield Finding("ok", "memory", "memory may be locked")
    else:
        how = "give ulimit -l unlimited (compose: ulimits, memlock: -1), or root CAP_IPC_LOCK"
        yield Finding("note", "memory", f"only {soft // 1024} kB may be locked; paging can make a loop late: {how}")


def _shared_memory() -> Iterator[Finding]:
    folder = Path("/dev/shm")
    if folder.is_dir() and os.access(folder, os.W_OK):
        free = shutil.disk_usage(folder).free
        level = "ok" if free > 200_000_000 else "note"
        yield Finding(level, "telemetry", f"{folder} has {free / 1e6:.0f} MB (compose: shm_size), a rig needs 40 MB")
    else:
        yield Finding(
            "note", "telemetry", f"{folder} cannot be written: telemetry goes through the data folder instead"
        )


def _timer() -> Iterator[Finding]:
    late = []
    for _ in range(SLEEPS):
        due = time.monotonic_ns() + 1_000_000
        time.sleep(0.001)
        late.append(time.monotonic_ns() - due)
    late.sort()
    median, p99 = late[SLEEPS // 2] / 1e3, late[-SLEEPS // 100] / 1e3
    text = f"a 1 ms sleep ends {median:.0f} us late in the median, {p99:.0f} us p99"
    yield Finding("ok" if median < 500.0 else "note", "timer", f"{text} (ordinary scheduling)")


def _data(folder: Path) -> Iterator[Finding]:
    there = folder
    while not there.exists():
        there = there.parent
    if not os.access(there, os.W_OK):
        yield Finding("wrong", "data", f"{folder} cannot be written: name another --data-dir")
        return
    free = shutil.disk_usage(there).free
    how = "" if free > ENOUGH_BYTES else "; a run takes about 0.4 MB a second: free some, or name another --data-dir"
    yield Finding("ok" if free > ENOUGH_BYTES else "note", "data", f"{folder}: {free / 1e9:.1f} GB free{how}")


def _port(port: int) -> Iterator[Finding]:
    import socket

    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("127.0.0.1", port))
        except OSError as error:
            yield Finding("note", "port", f"{port}: {error.strerror}; a server runs there already, or use --port")
            return
    yield Finding("ok", "port", f"{port} is free")


def _console() -> Iterator[Finding]:
    folder = Path(__file__).resolve().parent.parent / "console"
    if (folder / "index.html").is_file():
        yield Finding("ok", "console", "built")
    else:
        yield Finding("wrong", "console", "not built: install the package, or run tools/setup in a source tree")


def _kernels() -> Iterator[Finding]:
    """Compiles or loads the solver, solves one pose, and tells whether the next start finds it compiled."""
    import numpy as np

    from fullpose.rig import builtin_rigs
    from fullpose.solve import solve

    begin = time.perf_counter()
    solution = solve([0.0], np.eye(3)[None], builtin_rigs()["vertical-4"], "exact")
    took = time.perf_counter() - begin
    if not float(solution.matrix_error[0]) < 1e-14:
        yield Finding(
            "wrong", "solver", f"the identity is solved with a matrix error of {solution.matrix_error[0]:.1e}"
        )
        return
    slow = "" if took < 3.0 else "; if it is so at every start, Numba's cache cannot be written"
    yield Finding("ok" if took < 3.0 else "note", "solver", f"ready after {took:.1f} s{slow}")
