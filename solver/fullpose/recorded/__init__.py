"""Recorded flights: what a log of attitudes is made of, what is wrong with it, and the attitude behind it (mathematics,
section 13)."""

from fullpose.recorded.diagnosis import Diagnosis, diagnose
from fullpose.recorded.effect import Effect, effect_of
from fullpose.recorded.tube import Smoothed, smooth

__all__ = ["Diagnosis", "Effect", "Smoothed", "diagnose", "effect_of", "smooth"]
