"""A live flight with `preview`: the exact step in the loop, its way ahead planned in a process of its own.

The loop never waits for the planner. One job is with it at a time; a way that comes late, or never, costs room on the
self-motion and nothing else, and `plan_age_s` says so. mathematics, section 9.
"""

import math
import pickle
import socket
import subprocess
import sys

import numpy as np

from fullpose._typing import Array
from fullpose.errors import SolverError
from fullpose.plan import Ahead, PreviewOptions, PreviewStepper, Replan
from fullpose.registry import method_options
from fullpose.rig import Rig
from fullpose_server.runtime.live.planner_process import MESSAGE
from fullpose_server.runtime.live.settings import LiveError, LiveSettings
from fullpose_server.runtime.live.steppers import Flight
from fullpose_server.runtime.motion.path_player import attitude_of

FARTHEST_S = 2.0  # of the future
LEVEL = (1.0, 0.0, 0.0, 0.0)


def compile_preview(rig: Rig, dt: float) -> None:
    """Compile what the loop calls of a preview: a few ticks, with a way to follow among them. No planner is needed."""
    pose = rig.home.copy()
    flight = Flight(rig, dt, pose, lambda start, attitude: PreviewStepper(rig, PreviewOptions(), start, attitude))
    level = np.array(LEVEL)
    C = np.empty((1, 3, 3))
    attitude_of(level, C[0])
    flight.stepper.offer(np.array([flight.now + 0.1]), C)
    flight.step(level)
    time = flight.now + 0.1 * np.arange(3)
    flight.stepper.adopt(Ahead(1, np.asarray(time), np.tile(pose, (3, 1)), np.zeros((3, 4)), 0, math.inf))
    for _ in range(3):
        flight.step(level)
    flight.stepper.replan()


class PreviewStep:
    """One rig's live preview. Waits for nothing: until its planner has started there is no foresight."""

    def __init__(self, rig: Rig, settings: LiveSettings, dt: float) -> None:
        self._rig, self._dt = rig, dt
        try:
            self._options: PreviewOptions = method_options(settings.method, settings.options) or PreviewOptions()
            self._restart(rig.home.copy())  # writable, as in flight: to Numba a type of its own
        except SolverError as cause:
            raise LiveError(str(cause)) from cause
        self.preview_s = self._options.preview_s
        if self.preview_s > FARTHEST_S:
            raise LiveError(f"option preview_s = {self.preview_s:g}: expected {FARTHEST_S:g} s at most")
        self._planner = Planner(self._first_job())

    def begin(self, pose: Array) -> None:
        """From rest at `pose` (4,) [rad]."""
        self._planner.abandon()
        self._restart(pose)

    def _restart(self, pose: Array) -> None:
        self._flight = Flight(self._rig, self._dt, pose, self._stepper)
        self._heard = 0.0  # [s] of this flight, when the planner was last heard

    def _first_job(self) -> Replan:
        """Something for the planner to begin with, so that its kernels are there when the flight begins."""
        self.announce(0.1, LEVEL)
        self._flight.step(np.array(LEVEL))
        job = self._flight.stepper.replan()
        self._restart(self._rig.home.copy())
        return job

    def _stepper(self, pose: Array, attitude: Array) -> PreviewStepper:
        return PreviewStepper(self._rig, self._options, pose, attitude)

    def follow(self, q: Array) -> tuple[Array, int]:
        """The next angles (4,) [rad] toward attitude q (4,), and the code of the limit that keeps them from it."""
        flight, planner = self._flight, self._planner
        ahead = planner.answer()
        if ahead is not None and flight.stepper.adopt(ahead):
            self._heard = flight.now
        found = flight.step(q)
        if flight.stepper.due and not planner.busy:
            planner.ask(flight.stepper.replan())
        return found

    def announce(self, ahead_s: float, q: tuple[float, float, float, float]) -> None:
        """The attitude q that is to be flown `ahead_s` [s] after the tick to come."""
        C = np.empty((1, 3, 3))
        attitude_of(np.array(q), C[0])
        self._flight.stepper.offer(np.array([self._flight.now + ahead_s]), C)

    def void(self) -> None:
        """What was announced is not to come: the source began anew."""
        self._flight.stepper.void()

    @property
    def plan_age_s(self) -> float:
        """How long ago the planner was last heard [s]."""
        return self._flight.now - self._heard

    def close(self) -> None:
        """End the planner."""
        self._planner.close()


class Planner:
    """The planner's process, and the one job that may be with it. Raises `LiveError` where it cannot be started."""

    def __init__(self, first: Replan) -> None:
        """Starts it with the job `first`; waits for neither."""
        # Messages, whole or not at all, so that nothing is ever half read in the loop.
        self._link, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.busy = self._abandoned = False
        with other:
            for option in (socket.SO_SNDBUF, socket.SO_RCVBUF):
                self._link.setsockopt(socket.SOL_SOCKET, option, MESSAGE)
                other.setsockopt(socket.SOL_SOCKET, option, MESSAGE)
            command = [
                sys.executable,
                "-m",
                "fullpose_server.runtime.live.planner_process",
                "--fd",
                str(other.fileno()),
            ]
            try:
                self._process = subprocess.Popen(command, stdin=subprocess.DEVNULL, pass_fds=(other.fileno(),))
            except OSError as cause:
                self._link.close()
                raise LiveError(f"the preview's planner cannot be started: {cause.strerror}") from cause
        self._link.setblocking(False)
        self.ask(first)

    def fileno(self) -> int:
        """Readable when it has answered, or ended."""
        return self._link.fileno()

    def ask(self, job: Replan) -> None:
        """Give it a job. Where it cannot be given (it ended), it stays unasked, and the way grows old."""
        try:
            self._link.sendall(pickle.dumps(job, protocol=5))
        except OSError:
            return
        self.busy, self._abandoned = True, False

    def answer(self) -> Ahead | None:
        """The way that has come since, if one has, and if it was not abandoned."""
        if not self.busy:
            return None
        try:
            data = self._link.recv(MESSAGE)
        except OSError:
            return None
        if not data:
            return None  # it ended: still busy, for ever
        self.busy = False
        ahead: Ahead = pickle.loads(data)
        return None if self._abandoned else ahead

    def abandon(self) -> None:
        """The job that is with it, if any, belongs to a flight that is over."""
        self._abandoned = True

    def close(self) -> None:
        """End it."""
        self._link.close()
        try:
            self._process.wait(1.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
