"""A recorded run played again: a clock of its own over the record's samples, in place of a rig's ring.

Times are seconds after the record's first sample. The clock may be stopped, set and run at another speed; it stops by
itself at the end.
"""

import json
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fullpose_server.runtime.contract.telemetry import Samples
from fullpose_server.runtime.recording.curves import Curves
from fullpose_server.runtime.recording.long_replay import LongReplay
from fullpose_server.runtime.recording.mcap_reader import RecordError, Replay, read_events, run_of


class PlaybackError(Exception):
    """A time that the run does not have."""


class RunPlayback:
    """The samples of a record as of the clock. Its methods may be called from any thread."""

    def __init__(self, path: Path, clock: Callable[[], float] = time.monotonic, curves: Curves | None = None) -> None:
        """Of a record that has curves nothing is read before it is played; else all of it. Raises `RecordError`."""
        self.run = path.stem
        meta = run_of(path)
        self.who = meta.get("who", "")  # who began the run
        try:
            plan = json.loads(meta.get("plan") or "{}")
        except ValueError as cause:
            raise RecordError(path, f"its plan is damaged ({cause})") from cause
        self.plan: dict[str, Any] = plan if isinstance(plan, dict) else {}  # that was bound, as the record has it
        self._replay: Replay | LongReplay = Replay(path) if curves is None else LongReplay(curves)
        events = read_events(path) if curves is None else curves.about.events
        self._alarms = [event for event in events if event.get("kind") == "alarm"]
        self._clock = clock
        self._lock = threading.Lock()
        self._at = 0.0  # [s] when the clock was last set
        self._since = clock()
        self._playing = False
        self._factor = 1.0
        self.duration_s = self._replay.duration_s
        self._replay.seek(0.0)
        first = self._replay.latest()
        self._begun_ns = 0 if first is None else int(first["time_ns"][0])
        self._replay.seek(self.duration_s)
        last = self._replay.latest()
        ticks = 0 if first is None or last is None else int(last["tick"][0]) - int(first["tick"][0])
        self.rate_hz = ticks / self.duration_s if self.duration_s else 0.0

    @property
    def position(self) -> tuple[float, bool, float]:
        """(time [s], whether it plays, factor)."""
        with self._lock:
            return self._now(), self._playing, self._factor

    def play(self) -> None:
        """On from here; from the beginning where it is at the end."""
        with self._lock:
            now = self._now()
            self._set(0.0 if now >= self.duration_s else now)
            self._playing = True

    def pause(self) -> None:
        """Stand."""
        with self._lock:
            self._set(self._now())
            self._playing = False

    def seek(self, time_s: float) -> None:
        """To `time_s`, playing or not. Raises `PlaybackError`."""
        if not 0.0 <= time_s <= self.duration_s:
            raise PlaybackError(f"time_s = {time_s:.9g}: the run is from 0 to {self.duration_s:.9g} s")
        with self._lock:
            self._set(time_s)

    def speed(self, factor: float) -> None:
        """Play `factor` times as fast as it was."""
        with self._lock:
            self._set(self._now())
            self._factor = factor

    def latest(self) -> Samples | None:
        """The sample as of now (1,), None where the record holds none."""
        with self._lock:
            self._replay.seek(self._now())
            return self._replay.latest()

    def samples(self, since_seq: int, limit: int) -> tuple[Samples, int]:
        """Samples after `since_seq` up to now, oldest first, at most `limit`; none are lost."""
        with self._lock:
            self._replay.seek(self._now())
            return self._replay.since(since_seq, limit)

    def alarms(self) -> list[dict[str, Any]]:
        """The alarms raised up to now, as recorded."""
        now_ns = self._begun_ns + int(self.position[0] * 1e9)
        return [event for event in self._alarms if event["time_ns"] <= now_ns]

    def _now(self) -> float:
        if self._playing:
            now = self._at + (self._clock() - self._since) * self._factor
            if now < self.duration_s:
                return now
            self._set(self.duration_s)
            self._playing = False
        return self._at

    def _set(self, time_s: float) -> None:
        self._at, self._since = time_s, self._clock()
