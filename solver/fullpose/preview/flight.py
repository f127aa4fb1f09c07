"""A flight from a file flown by `preview`, as if it arrived sample by sample; re-plans run inline."""

import math

import numpy as np

from fullpose._typing import Array
from fullpose.methods.base import Block
from fullpose.preview.options import PreviewOptions
from fullpose.preview.prediction import SPACING
from fullpose.preview.replan import Ahead
from fullpose.preview.stepper import PreviewStepper
from fullpose.rig import Rig


class PreviewFlight:
    """A stepper that is told the future `preview_s` ahead, re-plans every `replan_s` and adopts `delay_s` later."""

    def __init__(self, rig: Rig, options: PreviewOptions, start: Array | None, time: Array, attitude: Array) -> None:
        self.stepper = PreviewStepper(rig, options, start, attitude[0])
        self._options, self._time, self._attitude = options, time, attitude
        self._offered = 0
        self._pending: list[tuple[float, Ahead]] = []
        self.replans = 0

    def block(self, time: Array, attitude: Array) -> Block:
        """Advance over samples of the flight: time (m,) [s], attitude (m, 3, 3)."""
        m = len(time)
        out = Block(np.empty((m, 4)), np.empty(m, np.int16), np.empty(m, np.int32))
        at = 0
        while at < m:
            self._offer(float(time[at]))
            self._adopt(float(time[at]))
            # As far as nothing happens but steps: the next re-plan or the next adoption.
            event = min([self._next, *(due for due, _ in self._pending)])
            end = min(m, max(at + 1, int(np.searchsorted(time, event - 1e-9, side="left")) + 1))
            part = slice(at, end)
            done = self.stepper.block(time[part], attitude[part])
            out.angles[part], out.limited[part], out.iterations[part] = done.angles, done.limited, done.iterations
            at = end
            if self.stepper.due:
                now = float(time[end - 1])
                self._offer(now)
                self._pending.append((now + self._options.delay_s, self.stepper.replan().run()))
                self.replans += 1
                self._adopt(now)
        return out

    @property
    def _next(self) -> float:
        return self.stepper.asked_at + self._options.replan_s

    def _adopt(self, now: float) -> None:
        while self._pending and self._pending[0][0] <= now + 1e-9:
            self.stepper.adopt(self._pending.pop(0)[1])

    def _offer(self, now: float) -> None:
        """What the source would have sent by `now` [s]."""
        if self._options.preview_s == 0.0:
            return
        end = int(np.searchsorted(self._time, now + self._options.preview_s, side="right"))
        if end <= self._offered or (end < len(self._time) and self._time[end - 1] < self._told + SPACING):
            return
        part = slice(self._offered, end)
        self.stepper.offer(self._time[part], self._attitude[part])
        self._offered = end

    @property
    def _told(self) -> float:
        return float(self._time[self._offered - 1]) if self._offered else -math.inf
