"""Recorded flights: what a log of attitudes is made of and what is wrong with it (mathematics, section 13)."""

from fullpose.recorded.diagnosis import Diagnosis, diagnose

__all__ = ["Diagnosis", "diagnose"]
