"""Following a live source: samples in by UDP and by the local socket, one exact step a tick, one reply a sample.

The step is the solver's, on the attitude that the buffer gives for the tick; it starts from the pose and attitude the
rig has, so that a source that begins elsewhere is approached inside the limits. Where samples stop, the attitude is
extrapolated briefly, then the source counts as lost and the session stops the rig.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np

from fullpose._typing import Array
from fullpose.rig import Rig
from fullpose_server.runtime.contract.config import LiveConfig
from fullpose_server.runtime.contract.messages import LiveHealth
from fullpose_server.runtime.live.admission import Admission, Outcome, Taken
from fullpose_server.runtime.live.buffer import LiveBuffer
from fullpose_server.runtime.live.factory import live_step
from fullpose_server.runtime.live.packets import (
    SAMPLE_SIZE,
    LiveReply,
    LiveSample,
    LiveStatus,
    decode_sample,
    encode_reply,
)
from fullpose_server.runtime.live.provenance import LARGEST, SIZES, Provenance
from fullpose_server.runtime.live.settings import LiveError, LiveSettings
from fullpose_server.runtime.live.steppers import LiveStep
from fullpose_server.runtime.motion.path_player import attitude_error

_PER_TICK = 16
_RATE_SPAN_S = 1.0
_DEG = 180.0 / math.pi


class Link(Protocol):
    """A datagram socket that never blocks, as the source sees it."""

    def fileno(self) -> int:
        """What tells it from the other links."""
        ...

    def recvfrom(self, size: int, /) -> tuple[bytes, Any]:
        """A datagram and its sender; raises OSError where there is none."""
        ...

    def sendto(self, data: bytes, to: Any, /) -> int:
        """Send a datagram; raises OSError where it cannot be."""
        ...

    def close(self) -> None:
        """Close it."""
        ...


@dataclass(frozen=True)
class ReadyLive:
    """Settings with the step that was made for them, and what the source proves itself by."""

    settings: LiveSettings
    step: LiveStep
    provenance: Provenance


class LiveView(NamedTuple):
    """What a monitor sees of the source: ages, and counts since the session went live."""

    acquired: bool  # the source's attitude was reached once
    limited: bool
    heard: bool  # the last tick had a sample to follow, however old
    age_ms: float  # of that sample
    plan_age_s: float  # of the planner's last word; nan where none plans
    bad: int
    dropped: int
    clock_steps: int
    strangers: int
    implausible: int
    implausible_deg_s: float  # of the newest of them
    plausible_deg_s: float  # the greatest that is used
    unproven: int


class LiveSource:
    """One rig's live source. `poll` every tick; `tick` while the session is live."""

    def __init__(
        self, rig: Rig, config: LiveConfig, dt: float, links: Sequence[Link], monotonic: Callable[[], float]
    ) -> None:
        """`links` bring samples every `dt` [s] and are closed with the source; `monotonic` tells the time [s]."""
        self._rig = rig
        self._config = config
        self._dt = dt
        self._buffer = LiveBuffer(config.delay_ms / 1e3)
        self._step: LiveStep | None = None
        self._settings = LiveSettings()
        self._provenance = Provenance()
        self._links = tuple(links)
        self._monotonic = monotonic
        self._waiting: list[Taken] = []
        self._admission = Admission(config.plausible_rate(rig))
        self._now = 0.0
        self._begun = 0.0
        self._following = False
        self._waited = True
        self.stale = self.limited = False
        self.acquired = False  # the source's attitude was reached once
        self.bad = 0
        self.last_age_ms = 0.0
        self.rate_hz = 0.0
        self._rated = (0.0, 0)  # when, and samples by then

    def close(self) -> None:
        """Close the sockets, end the planner."""
        self.unload()
        for each in self._links:
            each.close()

    def ready(self, settings: LiveSettings, key: str | None = None) -> ReadyLive:
        """Make ready for `settings`, at rest, and a source that has `key`. Changes nothing. Raises `LiveError`."""
        provenance = Provenance(key, settings.address)
        return ReadyLive(settings, live_step(self._rig, settings, self._dt), provenance)

    def has(self, digest: bytes) -> bool:
        """Whether it is that of the key of the source that is loaded."""
        return self._provenance.has(digest)

    def bind(self, ready: ReadyLive) -> None:
        """Take what was made ready in the place of what was before."""
        self.unload()
        self._step = ready.step
        self._settings = ready.settings
        self._provenance = ready.provenance
        self._buffer = LiveBuffer(self._config.delay_ms / 1e3 + ready.step.preview_s)

    def unload(self) -> None:
        """Forget the settings: a planner ends."""
        if self._step is not None:
            self._step.close()
            self._step = None
        self._provenance = Provenance()

    def _loaded(self) -> LiveStep:
        if self._step is None:
            raise LiveError("no live source is loaded")  # a fault of ours: the session does not order it
        return self._step

    def begin(self, pose: Array, now: float) -> None:
        """Follow from rest at `pose` (4,) [rad]; what the source sent before counts no more."""
        step = self._loaded()
        self._buffer.reset()
        step.begin(pose)
        self._begun = now
        self._following = True
        self.acquired = False
        self.stale = self.limited = False
        self._admission.begin()

    def end(self) -> None:
        """The session is no longer live."""
        if self._following:
            self._following = self.stale = self.limited = False

    def poll(self, now: float) -> None:
        """Take the samples that have come."""
        self._now = now
        if now - self._rated[0] > _RATE_SPAN_S:
            self.rate_hz = max(0, self._buffer.accepted - self._rated[1]) / (now - self._rated[0])
            self._rated = (now, self._buffer.accepted)
        for each in self._links:
            for _ in range(_PER_TICK):
                try:
                    data, sender = each.recvfrom(LARGEST + 1)
                except OSError:
                    break
                sample = decode_sample(data[:SAMPLE_SIZE]) if len(data) in SIZES else None
                if sample is None:
                    self.bad += 1
                    continue
                if self._provenance.proves(data, sender):
                    outcome = self._weighed(sample, (each.fileno(), sender), now)
                else:
                    outcome = self._admission.unproved()
                self._waiting.append(Taken(sample, outcome, self._monotonic(), each, sender))

    def _weighed(self, sample: LiveSample, source: tuple[int, Any], now: float) -> Outcome:
        """Use a sample, or say why not."""
        if not self._following:
            return Outcome(LiveStatus.IDLE)
        outcome = self._admission.weigh(source, self._buffer.rate_of(sample), now)
        if outcome.unused or self._take(sample, now):
            return outcome
        return Outcome(LiveStatus.DROPPED)

    def _take(self, sample: LiveSample, now: float) -> bool:
        step, clock_steps = self._loaded(), self._buffer.steps
        if not self._buffer.add(sample, now):
            return False
        if self._buffer.steps != clock_steps:
            step.void()
        ahead = -self._buffer.age(now)
        if ahead > 0.0:
            step.announce(ahead, sample.quaternion)
        return True

    def tick(self, x1: Array, v1: Array, x: Array, q: Array) -> bool:  # noqa: ARG002
        """Fill the next command x and the attitude q it follows; False where the source is lost."""
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
        angles, code = self._loaded().follow(q)
        self.limited = code != 0
        self.acquired = self.acquired or not self.limited
        x[:] = angles
        return True

    def reply(self, x: Array, error_deg: float, margin: float, now: float) -> None:
        """Answer the samples taken in this tick: x (4,) [rad] was commanded."""
        for taken in self._waiting:
            sample, via, sender = taken.sample, taken.via, taken.sender
            status = taken.outcome.unused or (LiveStatus.FOLLOWED if self._following else LiveStatus.IDLE)
            if status is LiveStatus.FOLLOWED and self.limited:
                status |= LiveStatus.LIMITED
            value = taken.outcome.rate * _DEG
            limit = math.nan if math.isnan(value) else self._admission.plausible * _DEG
            lag = attitude_error(self._rig.axes, x, np.array(sample.quaternion)) * _DEG
            angles = tuple((x * _DEG).tolist())
            latency = (now - taken.arrived) * 1e6
            reply = LiveReply(
                int(status), sample.sequence, sample.time_s, angles, error_deg, lag, margin, latency, value, limit
            )
            if sender:
                try:
                    via.sendto(encode_reply(reply), sender)
                except OSError:
                    continue  # who does not read its replies does not get them
        self._waiting.clear()

    @property
    def plan_age_s(self) -> float:
        """How old the planner's last word is [s]; nan where none plans."""
        return math.nan if self._step is None else self._step.plan_age_s

    def view(self) -> LiveView:
        """What a monitor needs to know of this tick."""
        b, seen = self._buffer, self._admission
        return LiveView(
            self.acquired,
            self.limited,
            not self._waited,
            self.last_age_ms,
            self.plan_age_s,
            self.bad,
            b.dropped,
            b.steps,
            seen.strangers,
            seen.implausible,
            seen.implausible_rate * _DEG,
            seen.plausible * _DEG,
            seen.unproven,
        )

    def health(self) -> LiveHealth | None:
        """What an operator wants to know of it; None where no live source is loaded."""
        if self._step is None:
            return None
        counts = self.counts
        heard = self._following and not self._waited
        age_ms = self.plan_age_s * 1e3
        return LiveHealth(
            rate_hz=self.rate_hz,
            age_ms=self.last_age_ms if heard else None,
            way_age_ms=None if math.isnan(age_ms) or not heard else age_ms,
            **counts,
        )

    @property
    def counts(self) -> dict[str, int]:
        """Samples accepted, dropped (late or doubled), bad (none at all), implausible, unproven; steps of the clock."""
        b = self._buffer
        told = {"accepted": b.accepted, "dropped": b.dropped, "bad": self.bad, "clock_steps": b.steps}
        return told | {"implausible": self._admission.implausible, "unproven": self._admission.unproven}
