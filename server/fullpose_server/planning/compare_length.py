"""How many samples a comparison may have: it keeps every method's solution, and a flight may be sparse and long."""

import math

from fullpose.errors import InputError

MOST_SAMPLES = 12_000_000  # of all methods together, of up to about 200 bytes each


def check_length(duration_s: float, rate_hz: float, methods: int) -> None:
    """Raise `InputError` where a flight of `duration_s` has too many samples at `rate_hz` for so many methods."""
    if not (math.isfinite(rate_hz) and rate_hz > 0.0):
        raise InputError("rate_hz", None, rate_hz, "a number above zero")
    most = MOST_SAMPLES // methods
    if not duration_s * rate_hz < most:
        allowed = f"at most {most / rate_hz:.6g} s at {rate_hz:.6g} Hz, that is {_most(most, methods)}"
        raise InputError("duration_s", None, duration_s, allowed)


def check_samples(samples: int, methods: int) -> None:
    """Raise `InputError` where a flight has too many samples of its own for so many methods."""
    most = MOST_SAMPLES // methods
    if samples > most:
        raise InputError("samples", None, samples, f"at most {_most(most, methods)}")


def _most(most: int, methods: int) -> str:
    return f"{most} samples" + (f" with {methods} methods side by side" if methods > 1 else "")
