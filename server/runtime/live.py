"""Following a live source: samples in by UDP and by the local socket, one exact step a tick, one reply a sample.

The step is the solver's, on the attitude that the buffer gives for the tick; it starts from the pose and attitude the
rig has, so that a source that begins elsewhere is approached inside the limits. Where samples stop, the attitude is
extrapolated briefly, then the source counts as lost and the session stops the rig.
"""

import hashlib
import math
import os
import socket
import time
from dataclasses import dataclass, field
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from server.runtime.config import LiveConfig
from server.runtime.live_buffer import LiveBuffer
from server.runtime.live_packet import (
    SAMPLE_SIZE,
    LiveReply,
    LiveSample,
    LiveStatus,
    decode_sample,
    encode_reply,
)
from server.runtime.path import attitude_error, attitude_of
from server.runtime.place import Place
from solver.errors import SolverError
from solver.kinematics import payload_attitude
from solver.rig import Rig

Array = NDArray[np.float64]
_PER_TICK = 16
_DEG = 180.0 / math.pi


@dataclass(frozen=True)
class LiveSettings:
    """How a live source is flown: the step method and its options."""

    method: str = "exact"
    options: dict[str, Any] = field(default_factory=dict)
    first_sample_s: float = 5.0  # to wait for the source to begin

    @property
    def hash(self) -> str:
        """sha-256 of the settings: what `arm` is held to."""
        content = [self.method, sorted(self.options.items()), self.first_sample_s]
        return hashlib.sha256(msgspec.json.encode(content)).hexdigest()


class LiveError(Exception):
    """Live settings that cannot be flown: which, and why."""


class LiveStep:
    """The solver's step for one rig and settings. Raises `LiveError` where they do not go together."""

    def __init__(self, rig: Rig, settings: LiveSettings, dt: float) -> None:
        # Heavier than the rest of the rig process: only where it is used.
        from solver.methods import METHODS

        if settings.method not in METHODS:
            raise LiveError(f"method {settings.method!r}: expected one of {', '.join(METHODS)}")
        self._method = METHODS[settings.method]
        if not self._method.claims_limits:
            raise LiveError(f"method {settings.method} does not keep the limits: it cannot fly a live source")
        self._rig = rig
        self._dt = dt
        try:
            self._options = msgspec.convert(settings.options, self._method.options)
            self.begin(rig.home.copy())  # writable, as in flight: to Numba a type of its own
        except (SolverError, msgspec.ValidationError) as cause:
            raise LiveError(str(cause)) from cause
        # Compiled here, at rest, and not in the first live tick.
        self.follow(np.array([1.0, 0.0, 0.0, 0.0]))
        self.begin(rig.home.copy())

    def begin(self, pose: Array) -> None:
        """From rest at `pose` (4,) [rad]."""
        from solver.methods.base import LiveStepper  # with it come all methods

        self._C = np.empty((1, 3, 3))
        payload_attitude(self._rig.axes, pose, self._C[0])
        stepper = self._method.stepper(self._rig, self._options, pose, self._C[0].copy())
        if not isinstance(stepper, LiveStepper):
            raise LiveError(f"method {self._method.name} cannot take over a rig that stands")
        stepper.begin_at_rest(self._dt)
        self._stepper = stepper
        self._tick = 1
        self._time = np.zeros(1)

    def follow(self, q: Array) -> tuple[Array, int]:
        """The next angles (4,) [rad] toward attitude q (4,), and the code of the limit that keeps them from it."""
        attitude_of(q, self._C[0])
        self._time[0] = self._tick * self._dt
        self._tick += 1
        block = self._stepper.block(self._time, self._C)
        return block.angles[0], int(block.limited[0])


class LiveSource:
    """One rig's live source. `poll` every tick; `tick` while the session is live."""

    def __init__(self, rig: Rig, config: LiveConfig, place: Place, dt: float) -> None:
        self._rig = rig
        self._config = config
        self._dt = dt
        self._buffer = LiveBuffer(config.delay_ms / 1e3)
        self._step: LiveStep | None = None
        self._settings = LiveSettings()
        self._sockets: list[socket.socket] = []
        self._waiting: list[tuple[LiveSample, bool, float, socket.socket, Any]] = []
        self._now = 0.0
        self._begun = 0.0
        self._following = False
        self._waited = True
        self.stale = self.limited = False
        self.acquired = False  # the source's attitude was reached once
        self.bad = 0
        self.last_age_ms = 0.0
        self._open(place)

    def _open(self, place: Place) -> None:
        local = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC)
        with place.socket_address("live.sock") as address:
            (place.directory / "live.sock").unlink(missing_ok=True)
            local.bind(address)
        os.chmod(place.directory / "live.sock", 0o600)  # noqa: PTH101
        self._sockets.append(local)
        if self._config.udp_port is not None:
            udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC)
            udp.bind((self._config.udp_host, self._config.udp_port))
            self._sockets.append(udp)
        for each in self._sockets:
            each.setblocking(False)

    def close(self) -> None:
        """Close the sockets."""
        for each in self._sockets:
            each.close()

    def prepare(self, settings: LiveSettings) -> None:
        """Make ready for `settings`, at rest: may compile. Raises `LiveError`."""
        self._step = LiveStep(self._rig, settings, self._dt)
        self._settings = settings

    def begin(self, pose: Array, now: float) -> None:
        """Follow from rest at `pose` (4,) [rad]; what the source sent before counts no more."""
        assert self._step is not None
        self._buffer.reset()
        self._step.begin(pose)
        self._begun = now
        self._following = True
        self.acquired = False
        self.stale = self.limited = False

    def end(self) -> None:
        """The session is no longer live."""
        if self._following:
            self._following = self.stale = self.limited = False

    def poll(self, now: float) -> None:
        """Take the samples that have come."""
        self._now = now
        for each in self._sockets:
            for _ in range(_PER_TICK):
                try:
                    data, sender = each.recvfrom(SAMPLE_SIZE + 1)
                except OSError:
                    break
                sample = decode_sample(data)
                if sample is None:
                    self.bad += 1
                    continue
                used = self._following and self._buffer.add(sample, now)
                self._waiting.append((sample, used, time.monotonic(), each, sender))

    def tick(self, x1: Array, v1: Array, x: Array, q: Array) -> bool:  # noqa: ARG002
        """Fill the next command x and the attitude q it follows; False where the source is lost."""
        assert self._step is not None
        age = self._buffer.age(self._now)
        if math.isinf(age):
            # Nothing yet: stand, for a while.
            self.last_age_ms = (self._now - self._begun) * 1e3
            x[:] = x1
            self._waited = True
            return self._now - self._begun <= self._settings.first_sample_s
        self._waited = False
        self.last_age_ms = age * 1e3
        self.stale = age > 0.0
        if age * 1e3 > self._config.extrapolate_ms:
            return False
        self._buffer.at(self._now, q)
        angles, code = self._step.follow(q)
        self.limited = code != 0
        self.acquired = self.acquired or not self.limited
        x[:] = angles
        return True

    def reply(self, x: Array, error_deg: float, margin: float, now: float) -> None:
        """Answer the samples taken in this tick: x (4,) [rad] was commanded."""
        for sample, used, arrived, via, sender in self._waiting:
            status = LiveStatus.IDLE if not self._following else LiveStatus.FOLLOWED
            if self._following and not used:
                status = LiveStatus.DROPPED
            elif self.limited:
                status |= LiveStatus.LIMITED
            lag = attitude_error(self._rig.axes, x, np.array(sample.quaternion)) * _DEG
            angles = tuple((x * _DEG).tolist())
            latency = (now - arrived) * 1e6
            reply = LiveReply(int(status), sample.sequence, sample.time_s, angles, error_deg, lag, margin, latency)
            if sender:
                try:
                    via.sendto(encode_reply(reply), sender)
                except OSError:
                    continue  # who does not read its replies does not get them
        self._waiting.clear()

    @property
    def heard(self) -> bool:
        """Whether the last tick had a sample to follow, however old."""
        return not self._waited

    @property
    def counts(self) -> dict[str, int]:
        """Samples accepted, dropped (late or doubled), bad (no sample at all), and steps of the source's clock."""
        b = self._buffer
        return {"accepted": b.accepted, "dropped": b.dropped, "bad": self.bad, "clock_steps": b.steps}
