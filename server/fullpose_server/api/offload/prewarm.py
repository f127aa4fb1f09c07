"""Compile (or load from the cache) the kernels of a diagnosis, a tolerance and a map before somebody waits for them.

On a fresh installation that takes longer than a request may: the first to look at a flight would be refused.
"""

import numpy as np

from fullpose.attitude import dcm_from_quaternion
from fullpose.recorded import effect_of, smooth
from fullpose.rig import builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.trajectory.plane_map import plane_map
from fullpose_server.formats.diagnosis import diagnosis_document

SAMPLES = 400
RATE_HZ = 100.0
LOGGED_HZ = 400.0  # with stamps of whole milliseconds, which a regular clock explains
NOISE = 1e-4  # [rad]
TOLERANCES = (None, 2.0 * NOISE)  # [rad] no bound, and one that the smoothing spline alone does not keep


def prewarm() -> None:
    """Look at made-up recordings of a few samples, and throw the answers away.

    One is noisy, one has held samples, a gap and an outlier, one is as it should be, one has a clock that is regular.
    """
    rig = builtin_rigs()["vertical-4"]
    for time_s, q in recordings():
        diagnosis_document(time_s, q, rig)
        for tolerance in TOLERANCES:
            effect_of(time_s, q, smooth(time_s, dcm_from_quaternion(q), tolerance))
    plane_map(time_s, dcm_from_quaternion(q), rig, columns=2, rows=2)


def recordings() -> list[tuple[np.ndarray, np.ndarray]]:
    """(time (n,) [s], quaternions (n, 4)) of each."""
    time_s, clean = random_flight(1, SAMPLES / RATE_HZ, RATE_HZ, 0.5)
    random = np.random.default_rng(1)
    noisy = clean + NOISE * random.normal(size=clean.shape)
    noisy /= np.linalg.norm(noisy, axis=1)[:, None]
    worse = noisy.copy()
    worse[1::2] = worse[: len(worse) - 1 : 2][: len(worse[1::2])]  # every other sample is held
    worse[len(worse) // 2] = clean[0]
    stamps = time_s + random.uniform(-1e-4, 1e-4, len(time_s))
    stamps[len(stamps) // 3 :] += 0.2
    fine, smooth_q = random_flight(1, SAMPLES / LOGGED_HZ, LOGGED_HZ, 0.5)
    return [(time_s, noisy), (stamps, worse), (time_s, clean), (np.round(fine, 3), smooth_q)]
