"""The pilot of the flights that `tools/fly_flights.py` flies: what is sensed, and from wanted rates to the controls."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import jsbsim
import numpy as np

from fullpose._typing import Array

STEP_HZ = 400  # JSBSim's integration


@dataclass(frozen=True)
class Sensed:
    """What the pilot sees at one step."""

    time: float  # [s]
    body_from_ned: Array  # (3, 3) passive; rows are the nose, right wing and belly axes in NED
    body_rate: Array  # (3,) p, q, r [rad/s]
    incidence: float  # angle of attack [rad]
    sideslip: float  # [rad]
    airspeed: float  # calibrated [kt]


# A manoeuvre is a generator: it is sent what is sensed, yields the body rate it wants (p, q, r) [rad/s], and returns
# when it is flown.
Manoeuvre = Iterator[Array]


@dataclass(frozen=True)
class Gains:
    """Stick and rudder per rad/s of rate error at the trim speed; integral gains per second of it."""

    roll: float
    roll_integral: float
    pitch: float
    pitch_integral: float
    yaw: float
    sideslip: float


class Pilot:
    """Senses, and turns wanted body rates into stick and rudder; its manoeuvres are generators over what it senses."""

    def __init__(self, aircraft: jsbsim.FGFDMExec, gains: Gains, trim_speed: float) -> None:
        self._aircraft = aircraft
        self._gains = gains
        self._trim_speed = trim_speed
        self._integral = np.zeros(3)
        self.now = self._sense()

    def _sense(self) -> Sensed:
        a = self._aircraft
        return Sensed(
            time=a.get_sim_time(),
            body_from_ned=np.asarray(a.get_propagate().get_Tl2b(), dtype=np.float64),
            body_rate=np.array([a[f"velocities/{axis}-rad_sec"] for axis in "pqr"]),
            incidence=a["aero/alpha-rad"],
            sideslip=a["aero/beta-rad"],
            airspeed=a["velocities/vc-kts"],
        )

    def step(self, wanted: Array) -> None:
        """Hold stick and rudder for one step so that the body rate follows `wanted` (3,) [rad/s]."""
        g = self._gains
        # The controls bite with dynamic pressure: less stick for the same answer where the aircraft is fast.
        authority = (self._trim_speed / max(self.now.airspeed, 0.3 * self._trim_speed)) ** 2
        error = wanted - self.now.body_rate
        room = np.abs(self._integral) < np.array([0.6, 0.9, 0.5])
        self._integral += (
            np.where(room | (error * self._integral < 0.0), error, 0.0)
            / STEP_HZ
            * [
                g.roll_integral,
                g.pitch_integral,
                0.0,
            ]
        )
        stick = (authority * (np.array([g.roll, g.pitch, g.yaw]) * error) + self._integral).clip(-1.0, 1.0)
        a = self._aircraft
        a["fcs/aileron-cmd-norm"] = stick[0]
        a["fcs/elevator-cmd-norm"] = -stick[1]  # JSBSim: elevator down is positive
        a["fcs/rudder-cmd-norm"] = float(np.clip(-stick[2] + g.sideslip * self.now.sideslip, -1.0, 1.0))
        a.run()
        self.now = self._sense()

    def throttle(self, setting: float) -> None:
        """All engines to `setting`, 0..1 (above 1 where the aircraft has reheat)."""
        for engine in range(int(self._aircraft.get_propulsion().get_num_engines())):
            self._aircraft[f"fcs/throttle-cmd-norm[{engine}]"] = setting

    # Manoeuvres ---------------------------------------------------------------------------------------------------

    def hold(self, attitude: Array, duration: float, stiffness: float = 1.5) -> Manoeuvre:
        """Keep `attitude` (body from NED) for `duration` [s]."""
        end = self.now.time + duration
        while self.now.time < end - 1e-9:
            yield stiffness * _turn_between(self.now.body_from_ned, attitude)

    def pull(self, rate: float, angle: float, incidence: float, ease: float = 1.5) -> Manoeuvre:
        """Pitch through `angle` [rad] at `rate` [rad/s], the wings kept square to the plane it began in.

        The rate comes in over `ease` [s] and goes out with the angle that is left; the pull is eased short of
        `incidence` [rad], where the wing would stall.
        """
        start = self.now
        wing = start.body_from_ned[1].copy()
        nose, up = start.body_from_ned[0].copy(), -start.body_from_ned[2].copy()
        turned = 0.0
        while turned < angle - math.radians(1.0):
            C = self.now.body_from_ned
            # Wing axis onto the plane's normal by roll and yaw; their pitch part is what the pull is.
            square = 2.0 * C @ np.cross(C[1], wing)
            fade_in = min(1.0, (self.now.time - start.time + 0.1) / ease)
            fade_out = min(1.0, 0.1 + (angle - turned) / (0.6 * rate * ease))
            room = self.now.body_rate[1] + 2.0 * (incidence - self.now.incidence)
            yield np.array([square[0], min(rate * min(fade_in, fade_out), room), square[2]])
            now = math.atan2(self.now.body_from_ned[0] @ up, self.now.body_from_ned[0] @ nose)
            turned += math.remainder(now - turned, math.tau)

    def roll(self, rate: float, angle: float, toward: Array, ease: float = 0.6) -> Manoeuvre:
        """Roll through `angle` [rad] at `rate` [rad/s] (negative: left), the nose kept `toward` (3,) in NED."""
        start = self.now.time
        turned, before = 0.0, start
        while turned < angle - math.radians(1.0):
            C = self.now.body_from_ned
            off = 1.5 * C @ np.cross(C[0], toward)
            fade_in = min(1.0, (self.now.time - start + 0.1) / ease)
            fade_out = min(1.0, 0.1 + (angle - turned) / (0.6 * abs(rate) * ease))
            yield np.array([rate * min(fade_in, fade_out), off[1], off[2]])
            turned += abs(self.now.body_rate[0]) * (self.now.time - before)
            before = self.now.time


def _turn_between(C: Array, target: Array) -> Array:
    """The rotation vector, in body axes, that turns the body from C to `target` (both body from NED) [rad]."""
    E = target @ C.T
    axis = 0.5 * np.array([E[1, 2] - E[2, 1], E[2, 0] - E[0, 2], E[0, 1] - E[1, 0]])
    sine = float(np.linalg.norm(axis))
    angle = math.atan2(sine, 0.5 * (np.trace(E) - 1.0))
    return axis * (angle / sine) if sine > 1e-12 else axis


def levelled(C: Array, pitch: float) -> Array:
    """Wings level on the heading of C's nose, at `pitch` [rad]. Body from NED."""
    heading = math.atan2(C[0, 1], C[0, 0])
    c, s = math.cos(heading), math.sin(heading)
    flat = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    c, s = math.cos(pitch), math.sin(pitch)
    raised: Array = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]) @ flat
    return raised


# The flights -------------------------------------------------------------------------------------------------------
