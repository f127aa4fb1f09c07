"""The sentences of a diagnosis: what was found, each with a figure. Degrees and seconds."""

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from fullpose._typing import Array
from fullpose.recorded.diagnosis import Diagnosis
from fullpose.recorded.noise import SECOND_DIFFERENCE
from fullpose.recorded.quantum import Of
from fullpose.rig import FRAMES, Rig

COSTS = 10.0  # [deg/s^2]; noise that costs less acceleration is told, but is no warning
COSTS_PERCENT = 2.0  # of a rig's smallest acceleration limit, likewise
UNEVEN = 0.01  # of the median step
FEW_OFF = 0.2  # of the largest: stamps nearer to the clock are not among those that are off it
FEW = 0.05  # of the samples: so few stamps off the clock are named one by one
MOST_NAMED = 3  # gaps, outliers or near-duplicates in one sentence


class Level(StrEnum):
    """How much a finding matters."""

    WARNING = "warning"  # a plan will suffer from it
    REMARK = "remark"


@dataclass(frozen=True)
class Finding:
    """One thing found."""

    code: str
    level: Level
    sentence: str


@dataclass(frozen=True)
class OnRig:
    """What the noise costs the frames of a rig at the poses of a flight: standard deviations [rad/s^2]."""

    rig: Rig
    typical: Array  # (4,) the median over the flight
    largest: Array  # (4,)


def findings(d: Diagnosis, on_rig: OnRig | None = None) -> tuple[Finding, ...]:
    """Everything that there is to say of the flight: the warnings first."""
    found = [
        _held(d),
        _rounding(d, on_rig) or _noise(d, on_rig),
        _stamps(d),
        _near_duplicates(d),
        _gaps(d),
        _outliers(d),
        _motion(d, on_rig),
    ]
    said = [each for each in found if each is not None]
    return tuple(sorted(said, key=lambda each: each.level is not Level.WARNING))


def figure(value: float) -> str:
    """Three digits of a number, never as a power of ten above 0.0001: 0.0102, 24300."""
    if value == 0.0 or not math.isfinite(value):
        return f"{value:g}"
    digits = 2 - math.floor(math.log10(abs(value)))
    return f"{value:.3g}" if abs(value) < 1e-4 else f"{round(value, digits):.{max(0, digits)}f}"


def milliseconds(seconds: float) -> str:
    """A time between samples."""
    return f"{seconds * 1e3:.4g} ms"


def _noise(d: Diagnosis, on_rig: OnRig | None) -> Finding:
    if not d.noise_measured:
        why = "too few samples, or steps too long, to tell noise from motion"
        return Finding("noise", Level.REMARK, f"The noise could not be measured: {why}.")
    sigma = np.degrees(d.white_noise_rad)
    if not sigma.any():
        return Finding("noise", Level.REMARK, "No white noise: the attitude is as smooth as its samples can tell.")
    axes = ", ".join(figure(value) for value in sigma)
    text = f"White noise of {axes} deg about the body's x, y, z (standard deviation){_cost(d, on_rig)}."
    return Finding("noise", _level(d, on_rig), text)


def _rounding(d: Diagnosis, on_rig: OnRig | None) -> Finding | None:
    """Rounding, where it is what makes the noise: noise well above it has a sentence of its own."""
    quantum = d.quantum
    if not quantum.rad or d.white_noise_rad.max() > 2.0 * quantum.rad / math.sqrt(12.0):
        return None
    match quantum.of:
        case Of.QUATERNION:
            what = f"Quaternions are rounded to {quantum.unit:g}, {figure(math.degrees(quantum.rad))} deg of attitude"
        case Of.COUNTS:
            what = f"Angles are counts of an encoder, 360 deg / {round(360.0 / quantum.unit)}"
        case _:
            what = f"Angles are rounded to {quantum.unit:g} deg"
    return Finding("quantum", _level(d, on_rig), f"{what}{_cost(d, on_rig)}.")


def _cost(d: Diagnosis, on_rig: OnRig | None) -> str:
    body = float(np.degrees(d.noise_acceleration_rad_s2.max()))
    text = (
        f"; followed exactly, at steps of {milliseconds(d.median_step_s)}, that alone costs {figure(body)} deg/s^2 of "
        "body acceleration (standard deviation)"
    )
    if on_rig is None:
        return text
    frames = ", ".join(
        f"{FRAMES[i]} {figure(math.degrees(on_rig.typical[i]))}{_limit(on_rig.rig.frames[i].max_acceleration)}"
        for i in on_rig.rig.geometry.frames
    )
    return f"{text}, and of the frames of {on_rig.rig.name}: {frames} deg/s^2"


def _limit(limit: float) -> str:
    return f" of {figure(math.degrees(limit))}" if math.isfinite(limit) else ""


def _level(d: Diagnosis, on_rig: OnRig | None) -> Level:
    cost = np.degrees(d.noise_acceleration_rad_s2.max())
    if on_rig is None:
        return Level.WARNING if cost > COSTS else Level.REMARK
    shares = [100.0 * on_rig.typical[i] / on_rig.rig.frames[i].max_acceleration for i in on_rig.rig.geometry.frames]
    return Level.WARNING if max(shares) > COSTS_PERCENT else Level.REMARK


def _held(d: Diagnosis) -> Finding | None:
    held = d.held
    if not held.count:
        return None
    repeated = f"{held.count} of {d.samples} samples repeat the one before although the flight moves"
    if held.rate_hz is None:
        first = d.time_s[np.flatnonzero(held.mask)[:MOST_NAMED]]
        return Finding("held", Level.WARNING, f"{repeated}: {_times(first, held.count)}.")
    rates = f"{figure(held.rate_hz)} Hz written out at {figure(1.0 / d.median_step_s)} Hz"
    return Finding("held", Level.WARNING, f"Samples are held, {rates}: {repeated}.")


def _stamps(d: Diagnosis) -> Finding | None:
    stamps = d.stamps
    if stamps.regular_time_s is not None:
        return Finding("stamps", Level.WARNING, _clock(d, np.abs(d.time_s - stamps.regular_time_s)))
    if d.samples > 2 and stamps.jitter_max_s > UNEVEN * d.median_step_s:
        span = f"{milliseconds(d.smallest_step_s)} to {milliseconds(d.largest_step_s)}"
        text = (
            f"Steps are uneven, {span} about a median of {milliseconds(d.median_step_s)}; no regular clock makes the "
            "attitude smoother: the stamps stay as they are."
        )
        return Finding("stamps", Level.REMARK, text)
    return None


def _clock(d: Diagnosis, off: Array) -> str:
    """Stamps that a regular clock explains; off (n,) [s] from it."""
    stamps, rate = d.stamps, f"a regular clock of {1.0 / d.median_step_s:.6g} Hz, under which the attitude is smoother"
    few = np.flatnonzero(off > FEW_OFF * stamps.jitter_max_s)
    if few.size <= MOST_NAMED or few.size < FEW * d.samples:
        verb = "is" if few.size == 1 else "are"
        times = _times(d.time_s[few[:MOST_NAMED]], few.size)
        return f"{_count(few.size, 'stamp')} {verb} up to {milliseconds(stamps.jitter_max_s)} off {rate}: {times}."
    what = f"Stamps are rounded to {milliseconds(stamps.quantum_s)}" if stamps.quantum_s else "Stamps jitter"
    turned = float(np.degrees(d.body_rate.norm)) * stamps.jitter_rms_s
    cost = turned * SECOND_DIFFERENCE / d.median_step_s**2
    size = f"{milliseconds(stamps.jitter_rms_s)} rms and up to {milliseconds(stamps.jitter_max_s)}"
    return (
        f"{what}: they are {size} off {rate}. Taken as they are they cost, where the body turns fastest, "
        f"{figure(turned)} deg and {figure(cost)} deg/s^2 of body acceleration."
    )


def _near_duplicates(d: Diagnosis) -> Finding | None:
    count = d.near_duplicates.size
    if not count:
        return None
    times = _times(d.time_s[d.near_duplicates[:MOST_NAMED]], count)
    text = f"{_count(count, 'stamp')} all but {'repeats' if count == 1 else 'repeat'} the one before: {times}, "
    return Finding("near-duplicates", Level.WARNING, f"{text}the smallest step is {milliseconds(d.smallest_step_s)}.")


def _gaps(d: Diagnosis) -> Finding | None:
    if not d.gaps:
        return None
    longest = sorted(d.gaps, key=lambda gap: gap.start_s - gap.end_s)[:MOST_NAMED]
    named = ", ".join(f"{gap.start_s:.10g} s to {gap.end_s:.10g} s ({gap.steps:.6g} median steps)" for gap in longest)
    longest_word = "" if len(d.gaps) <= MOST_NAMED else ", the longest"
    text = (
        f"{_count(len(d.gaps), 'gap')} without samples{longest_word}: {named}; what the attitude does there is a guess."
    )
    return Finding("gaps", Level.WARNING, text)


def _outliers(d: Diagnosis) -> Finding | None:
    count = d.outliers.sample.size
    if not count:
        return None
    k = int(np.argmax(d.outliers.size_rad))
    largest = figure(math.degrees(d.outliers.size_rad[k]))
    at = float(d.time_s[d.outliers.sample[k]])
    text = (
        f"{_count(count, 'outlier')}: the largest, at {at:.10g} s, is {largest} deg off its neighbours, "
        f"{figure(float(d.outliers.sigmas[k]))} times what they differ by."
    )
    return Finding("outliers", Level.WARNING, text)


def _motion(d: Diagnosis, on_rig: OnRig | None) -> Finding | None:
    if d.samples < 2:
        return None
    rate, acceleration = d.body_rate, d.body_acceleration
    how = "By the regular clock" if d.stamps.explained else "Taken as they stand"
    text = (
        f"{how} the samples turn the body at up to {figure(math.degrees(rate.norm))} deg/s (at "
        f"{rate.norm_time_s:.6g} s) and accelerate it by up to {figure(math.degrees(acceleration.norm))} deg/s^2 (at "
        f"{acceleration.norm_time_s:.6g} s)"
    )
    if on_rig is not None:
        rig = on_rig.rig
        bounds = ", ".join(
            f"{FRAMES[i]} {figure(math.degrees(rig.frames[i].max_rate))} deg/s and "
            f"{figure(math.degrees(rig.frames[i].max_acceleration))} deg/s^2"
            for i in rig.geometry.frames
        )
        text += f"; the limits of {rig.name} are {bounds}"
    return Finding("motion", Level.REMARK, f"{text}.")


def _count(count: int, word: str) -> str:
    return f"{count} {word}{'' if count == 1 else 's'}"


def _times(times: Array, count: int) -> str:
    named = ", ".join(f"{value:.10g} s" for value in times)
    return f"at {named}" + (f" and {count - len(times)} more" if count > len(times) else "")
