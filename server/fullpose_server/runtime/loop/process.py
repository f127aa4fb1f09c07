"""The rig process, `python -m fullpose_server.runtime.loop.process --config FILE`: one a rig.

It is started by the server and outlives it.
"""

import argparse
import logging
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from fullpose_server.drives import registry
from fullpose_server.drives.base import Drive, DriveError
from fullpose_server.runtime.contract import config
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.loop import clock, prewarm
from fullpose_server.runtime.loop.control_loop import RigLoop

_LOCK_TRIES = 50
_RECORDER_S = 10.0


def main() -> int:
    """Run one rig until it is told to end; returns the exit status."""
    arguments = argparse.ArgumentParser(description="Runs one rig's loop.")
    arguments.add_argument("--config", type=Path, required=True)
    given = arguments.parse_args()
    logging.basicConfig(format="%(asctime)s %(message)s", level=logging.INFO)
    log = logging.getLogger("fullpose.rig")
    settings = config.decode(given.config.read_bytes())
    paths = RigPaths(settings.directory)
    lock = _lock(paths)
    if lock is None:
        log.error("another process runs %s", settings.name)
        return 1
    try:
        drive: Drive = registry.make(settings.drive, settings.rig, settings.rate_hz, settings.drive_options)
    except DriveError as cause:
        log.error("%s", cause)
        return 2
    memory = paths.memory()
    memory.unlink(missing_ok=True)  # of a process that was killed: we hold the lock
    shared = Shared(memory, create=True)
    shared.header["rig_pid"] = os.getpid()
    shared.header["server_beat_ns"] = time.monotonic_ns()
    # A rig is stopped by command; a stray Ctrl-C or hang-up must not drop it in mid-flight.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    recorder = start_recorder(memory, settings.runs)
    prewarm.kernels(settings)
    _wait_for(recorder, shared)
    loop: RigLoop | None = None
    try:
        try:
            realtime = clock.go_realtime(settings.realtime_priority, settings.cpu)
        except OSError as cause:
            log.error("process.cpu = %s: %s; expected one of this machine's", settings.cpu, cause.strerror)
            return 2
        loop = RigLoop(
            settings, drive, shared, paths, realtime, lambda: start_recorder(memory, settings.runs), recorder
        )
        signal.signal(signal.SIGTERM, lambda *_: loop.terminate())
        clock.still_collector()
        paths.write_notes(os.getpid())
        log.info("%s ready, pid %d, real time %s", settings.name, os.getpid(), realtime)
        loop.run()
    finally:
        paths.notes.unlink(missing_ok=True)
        memory.unlink(missing_ok=True)
        os.close(lock)
    return 0


def start_recorder(memory: Path, runs: Path) -> "subprocess.Popen[bytes]":
    """Start the recorder as a child of this process."""
    command = [
        sys.executable,
        "-m",
        "fullpose_server.runtime.recording.recorder",
        "--memory",
        str(memory),
        "--runs",
        str(runs),
    ]
    return subprocess.Popen([*command, "--parent", str(os.getpid())], stdin=subprocess.DEVNULL)


def _wait_for(recorder: "subprocess.Popen[bytes]", shared: Shared) -> None:
    """Wait for the recorder's first sign of life; without one the session will refuse to arm, and say why."""
    deadline = time.monotonic() + _RECORDER_S
    while time.monotonic() < deadline and recorder.poll() is None:
        if int(shared.header["recorder_beat_ns"][0]):
            return
        time.sleep(0.01)


def _lock(paths: RigPaths) -> int | None:
    for _ in range(_LOCK_TRIES):
        fd = paths.take_lock()
        if fd is not None:
            return fd
        time.sleep(0.02)  # a server that looks whether we live holds it for a moment
    return None


if __name__ == "__main__":
    status = main()
    logging.shutdown()
    # Not through the interpreter's end: with the collector frozen, extension modules complain of leaks there.
    os._exit(status)
