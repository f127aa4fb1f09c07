"""The rig process, `python -m fullpose_server.runtime.loop.process --config FILE`: one a rig.

It is started by the server and outlives it.
"""

import argparse
import faulthandler
import logging
import os
import signal
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from uuid import uuid4

import numpy as np

from fullpose_server.drives import registry
from fullpose_server.drives.base import Drive, DriveError
from fullpose_server.formats.plan_folder import rig_hash
from fullpose_server.processes import call_itself
from fullpose_server.runtime.contract import config
from fullpose_server.runtime.contract.drive_call import EXIT_HANGS
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.live.links import open_links
from fullpose_server.runtime.live.source import LiveSource
from fullpose_server.runtime.loop import clock, prewarm
from fullpose_server.runtime.loop.clock import Clock, SystemClock
from fullpose_server.runtime.loop.context import LoopState, Parts
from fullpose_server.runtime.loop.control_loop import ControlLoop
from fullpose_server.runtime.loop.control_server import ControlServer
from fullpose_server.runtime.loop.drive_watch import DriveWatch
from fullpose_server.runtime.loop.event_log import EventLog
from fullpose_server.runtime.loop.leisure import Leisure
from fullpose_server.runtime.loop.loop_profile import fitted, profile_of, told
from fullpose_server.runtime.loop.recorder_child import RecorderChild, WaitingRecorder
from fullpose_server.runtime.loop.watched_drive import WatchedDrive
from fullpose_server.runtime.motion.generator import Motion
from fullpose_server.runtime.motion.limit_guard import Guard
from fullpose_server.session.machine import SessionMachine

_LOCK_TRIES = 50


def assemble(settings: config.RigConfig, drive: Drive, shared: Shared, live: LiveSource, ticks: Clock) -> Parts:
    """The parts of one rig's loop."""
    rig = settings.rig
    return Parts(
        config=settings,
        clock=ticks,
        machine=SessionMachine(rig.name, rig_hash(rig), settings.owner, settings.shelves),
        drive=WatchedDrive(drive, shared.header, ticks),
        motion=Motion(rig, settings.motion, settings.rate_hz),
        guard=Guard(rig, settings.guard, 1.0 / settings.rate_hz),
        live=live,
        shared=shared,
        log=EventLog(shared, ticks),
        state=LoopState(np.array(rig.home), np.zeros(4)),
    )


def main() -> int:
    """Run one rig until it is told to end; returns the exit status."""
    arguments = argparse.ArgumentParser(description="Runs one rig's loop.")
    whose = arguments.add_mutually_exclusive_group(required=True)
    whose.add_argument("--config", type=Path)
    whose.add_argument("--spare", action="store_true", help="get ready, and read the name of that file from stdin")
    given = arguments.parse_args()
    if not given.spare:
        return run(given.config, None)
    call_itself(f"fullpose rig process in reserve ({__spec__.name})")
    spare = WaitingRecorder()
    prewarm.any_rig()
    told = sys.stdin.readline().strip()  # nothing: the server is gone
    return run(Path(told), spare) if told else 0


def run(file: Path, waiting: WaitingRecorder | None) -> int:
    """Run the rig whose configuration is in `file`; returns the exit status."""
    settings = config.decode(file.read_bytes())
    call_itself(f"fullpose rig {settings.name} ({__spec__.name})")
    if waiting is not None:
        _write_to(RigPaths(settings.directory).log)
    logging.basicConfig(format="%(asctime)s %(message)s", level=logging.INFO)
    log = logging.getLogger("fullpose.rig")
    paths = RigPaths(settings.directory)
    ticks = SystemClock()
    lock = _lock(paths, ticks)
    if lock is None:
        log.error("another process runs %s", settings.name)
        return 1
    profile = profile_of(settings.drive, realtime=clock.realtime_granted(settings.realtime_priority))
    settings = fitted(settings, profile)
    try:
        drive: Drive = registry.make(settings.drive, settings.rig, settings.rate_hz, settings.drive_options)
    except DriveError as cause:
        log.error("%s", cause)
        return 2
    memory = paths.memory()
    memory.unlink(missing_ok=True)  # of a process that was killed: we hold the lock
    shared = Shared(memory, create=True)
    shared.header["rig_pid"] = os.getpid()
    shared.header["server_beat_ns"] = ticks.monotonic_ns()
    # A rig is stopped by command; a stray Ctrl-C or hang-up must not drop it in mid-flight.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    recorder = RecorderChild(memory, settings.runs, waiting)
    prewarm.kernels(settings)
    recorder.wait_for(shared, ticks)
    try:
        try:
            realtime = told(clock.go_realtime(settings.realtime_priority, settings.cpu), profile)
        except OSError as cause:
            log.error("process.cpu = %s: %s; expected one of this machine's", settings.cpu, cause.strerror)
            return 2
        links = open_links(paths, settings.live)
        live = LiveSource(settings.rig, settings.live, 1.0 / settings.rate_hz, links, partial(clock.seconds, ticks))
        parts = replace(assemble(settings, drive, shared, live, ticks), realtime=realtime, life=uuid4().hex)
        leisure = Leisure(recorder, parts.log, shared.header, settings.exit_idle_s, clock.seconds(ticks))
        loop = ControlLoop(parts, partial(ControlServer, paths), leisure)
        signal.signal(signal.SIGTERM, lambda *_: loop.terminate())
        ended = partial(_end_at_once, paths, log)
        stacks = partial(faulthandler.dump_traceback, sys.stderr)
        DriveWatch(parts.drive, loop.caretaker, ticks, stacks, ended).start(settings.realtime_priority)
        clock.still_collector()
        paths.write_notes(os.getpid())
        log.info("%s ready, pid %d, real time %s", settings.name, os.getpid(), realtime)
        loop.run()
    finally:
        paths.notes.unlink(missing_ok=True)
        memory.unlink(missing_ok=True)
        os.close(lock)
    return 0


def _end_at_once(paths: RigPaths, log: logging.Logger) -> None:
    """End the process from another thread than the one that hangs; the recorder completes the record."""
    log.error("the drive does not let go of the loop: the process ends")
    logging.shutdown()
    paths.notes.unlink(missing_ok=True)
    os._exit(EXIT_HANGS)


def _write_to(log: Path) -> None:
    """What this process writes goes there from now on."""
    with log.open("ab") as file, Path(os.devnull).open("rb") as nothing:
        os.dup2(nothing.fileno(), 0)
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)


def _lock(paths: RigPaths, ticks: Clock) -> int | None:
    for _ in range(_LOCK_TRIES):
        fd = paths.take_lock()
        if fd is not None:
            return fd
        ticks.sleep(0.02)  # a server that looks whether we live holds it for a moment
    return None


if __name__ == "__main__":
    status = main()
    logging.shutdown()
    # Not through the interpreter's end: with the collector frozen, extension modules complain of leaks there.
    os._exit(status)
