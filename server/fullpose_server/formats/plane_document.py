"""The map of a flight's plane of time and base angle as console and plot page draw it: degrees, per cent, bytes.

A cell has two bytes. `margin` is in per cent, rounded down, so that no colour promises more than there is, between -100
and 100. `limits` has the code of the limit that leaves no more in its lower half, and in the upper one that of the rate
limit that holds it: 1 + 3 * frame + limit, base, outer, middle, inner and position, rate, acceleration from 0; 0: none.
"""

import base64
from typing import Any

import numpy as np

from fullpose._typing import Array, Integers
from fullpose.bounds import TOLERANCE, limited_name
from fullpose.rig import Rig
from fullpose.trajectory.plane_map import PathMargin, PlaneMap, path_margin, plane_map
from fullpose.verify import payload_attitudes

COLUMNS, ROWS = 400, 180
MOST_SAMPLES = 250_000  # that the map is made from: of a longer flight every second one, or fewer
MOST_NEEDLES = 400


def plane_document(
    time: Array, attitude: Array | None, angles: Array, rig: Rig, columns: int = COLUMNS, rows: int = ROWS
) -> dict[str, Any]:
    """The document of a path: time (n,) [s], angles (n, 4) [rad] of a rig with a base that moves.

    attitude (n, 3, 3): the flight's, where the path is not good; None: what the frames make.
    Raises `MethodError` for a rig that has no such plane, `InputError` for less than two samples.
    """
    part = slice(None, None, -(-len(time) // MOST_SAMPLES))
    fewer = np.asarray(angles[part])
    seen = payload_attitudes(rig, fewer) if attitude is None else attitude[part]
    made = plane_map(time[part], seen, rig, fewer, columns, rows)
    path = path_margin(time, angles, rig)
    begin = float(time[0])
    return {
        "time_s": np.round(made.time - begin, 6).tolist(),
        "base_deg": [float(v) for v in np.degrees(made.base[[0, -1]])],
        "rows": len(made.base),
        "margin": _text(_percent(made.margin).astype(np.int8)),
        "limits": _text((made.binding + 16 * made.against).astype(np.uint8)),
        **_needles(made, begin),
        "path": _path(time, path, made.time),
        "tightest": _tightest(time - begin, path),
    }


def _percent(margin: Array) -> Array:
    """Per cent, rounded down but for rounding itself; a limit is met, not passed, within the check's tolerance."""
    met = np.where((margin < 0.0) & (margin >= -TOLERANCE), 0.0, margin)
    return np.clip(np.floor(100.0 * met + 1e-9), -100.0, 100.0)


def _text(cells: Any) -> str:
    return base64.b64encode(np.ascontiguousarray(cells).tobytes()).decode("ascii")


def _needles(made: PlaneMap, begin: float) -> dict[str, Any]:
    """The widest needles, by time; of a level or noisy flight there are thousands."""
    found = made.needles
    widest = np.sort(np.argsort(-found.half_width, kind="stable")[:MOST_NEEDLES])
    rows = zip(
        (found.time[widest] - begin).tolist(),
        np.degrees(found.base[widest]).tolist(),
        np.degrees(found.half_width[widest]).tolist(),
        strict=True,
    )
    return {
        "needles": [{"time_s": t, "base_deg": b, "half_width_deg": w} for t, b, w in rows],
        "needles_left_out": len(found.time) - len(widest),
    }


def _path(time: Array, path: PathMargin, at: Array) -> dict[str, Any]:
    """The path at the map's times; its margin is the least of the samples that are nearer to that than to another."""
    rows = np.searchsorted(time, at)
    begins = np.unique(np.concatenate([[0], (rows[:-1] + rows[1:] + 1) // 2]))
    least = _least(path.margin, begins)
    return {
        "base_deg": np.round(np.degrees(path.base[rows]), 4).tolist(),
        "side": path.side[rows].tolist(),
        "margin": _percent(path.margin[least]).tolist(),
        "limit": path.binding[least].tolist(),
    }


def _least(margin: Array, begins: Integers) -> Integers:
    """Where the margin is least from each of `begins` to the next."""
    ends = np.append(begins[1:], len(margin))
    return np.array([a + int(np.argmin(margin[a:b])) for a, b in zip(begins, ends, strict=True)])


def _tightest(time: Array, path: PathMargin) -> dict[str, Any]:
    """Where the path has least margin, and the sentence of it."""
    k = path.tightest
    margin, named = float(_percent(path.margin[k])), limited_name(int(path.binding[k]))
    frame, limit = named or (None, None)
    if named is None:
        sentence = "No limit is asked for anything."
    else:
        room = f"{margin:.0f} % left" if margin >= 0.0 else f"{beyond(float(path.margin[k]))} beyond it"
        sentence = f"Tightest at {time[k]:.3f} s: the {frame} frame's {limit} limit, {room}."
    return {"time_s": float(time[k]), "margin": margin, "frame": frame, "limit": limit, "sentence": sentence}


def beyond(margin: float) -> str:
    """How far beyond a limit, in per cent of it."""
    share = -100.0 * margin
    return f"{share:.0f} %" if share >= 1.0 else f"{share:.2g} %"
