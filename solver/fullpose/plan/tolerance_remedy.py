"""The tolerance as a remedy: what the recording added is taken away; what a limit still closes is given up evenly."""

import math
from dataclasses import replace

import numpy as np

from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion
from fullpose.plan.recorded_noise import recorded_noise
from fullpose.plan.remedy import NOTHING, Remedy, Trials
from fullpose.recorded import smooth
from fullpose.recorded.tube import rounded_up
from fullpose.rig import Rig
from fullpose.verify import attitude_errors, payload_attitudes
from fullpose.vocabulary import RemedyKind

ANY = math.pi  # [rad]: whatever the least tolerance is, the flight is flown within it
LOOK = 0  # alternatives of the plan that is returned: the search for an exact path is over by then
TRIALS = 2  # that search, and the plan within the tolerance
EXACT = 1e-9  # [rad] of attitude: less is no tolerance


def least_change(time: Array, attitude: Array, rig: Rig, trials: Trials) -> Remedy:
    """The flight within the least tolerance that was found: time (n,) [s], attitude (n, 3, 3)."""
    noisy = recorded_noise(time, attitude)
    at, C = time, attitude
    if noisy is not None:
        within = smooth(time, attitude, noisy.suggested, noisy.diagnosis)
        at, C = np.array(within.time), dcm_from_quaternion(within.q)
    made = trials.exact(at, C, rig)  # first: what is flown exactly needs no tolerance
    if made is None or not made.ready:
        made = trials.final(at, C, rig, replace(trials.options, tolerance=ANY, alternatives=LOOK))
    error, _ = attitude_errors(payload_attitudes(rig, made.solution.angles), attitude)
    most = float(error.max())
    given_up = trials.given_up
    if most <= EXACT:
        return Remedy(RemedyKind.TOLERANCE, NOTHING, 0.0, at, C, rig, made, deviation=error, given_up=given_up)
    enough = max(rounded_up(most), noisy.suggested if noisy is not None else 0.0)
    return Remedy(RemedyKind.TOLERANCE, "attitude", enough, at, C, rig, made, deviation=error, given_up=given_up)
