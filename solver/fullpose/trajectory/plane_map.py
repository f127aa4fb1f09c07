"""The plane of time and base angle as a picture: why a flight is tight (mathematics, section 14)."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fullpose._jit import kernel
from fullpose._typing import Array, Codes, Integers
from fullpose.bounds import CODES, EXACT, POSITION, limited_name
from fullpose.charts import TURN, vertical_views
from fullpose.errors import InputError, MethodError
from fullpose.flight import check_flight
from fullpose.kinematics import rotation_error
from fullpose.limits import limit_table
from fullpose.rig import Frame, Limit, Rig
from fullpose.trajectory.curve import LOCKED
from fullpose.trajectory.limit_shares import limit_shares
from fullpose.trajectory.needles import needles
from fullpose.trajectory.plane_margin import Cells, fill_cells

COLUMNS, ROWS = 400, 360
MOST_CELLS = 4_000_000  # each is two margins and four codes: 100 MB
CHUNK = 1 << 16  # samples of a path looked at together
OUTER = 1


class MapNeedles(NamedTuple):
    """Where outer and middle frame are both free to change sides: (k,) each."""

    time: Array  # [s], increasing
    base: Array  # [rad]; half a turn on is another
    half_width: Array  # [rad] a path that passes nearer, but not through it, breaks the outer frame's rate limit


@dataclass(frozen=True)
class PathMargin:
    """What a path leaves of the limits at each of its samples: arrays (n,), read-only.

    `margin` is the least share left of all frames' positions, rates and accelerations, the last two as differences of
    the samples (`fullpose.verify`), negative beyond a limit; `binding` the `bounds.limited_code` of that limit.
    """

    base: Array  # [rad]
    side: Integers  # 0 where cos d3 >= 0, else 1
    margin: Array
    binding: Codes

    @property
    def tightest(self) -> int:
        """The sample with the least margin."""
        return int(np.argmin(self.margin))


@dataclass(frozen=True)
class PlaneMap:
    """The margins over a grid of times and base angles, the needles, and a path through them. Arrays are read-only.

    margin: (2, m, r) for the side cos d3 >= 0 and the other, times, base angles: the most that a path through there can
    leave of any frame's range or rate limit, as a share of it (`fullpose.trajectory.plane_margin` has the definition);
    1: all, 0: none, negative: it breaks a limit, whatever the base does. A range counts by its half, and a frame but
    the base is in the turn that leaves most. binding: (2, m, r) which limit leaves no more (`bounds.limited_name`), 0
    where none asks for anything; against: (2, m, r) the rate limit that holds that one, where two do: what relieves one
    of the two frames loads the other.
    """

    rig: Rig
    time: Array  # (m,) [s]
    base: Array  # (r,) [rad]
    margin: Array
    binding: Codes
    against: Codes
    needles: MapNeedles
    path: PathMargin | None

    @property
    def side(self) -> Integers:
        """(m, r) the side with more margin."""
        return np.asarray(np.argmax(self.margin, axis=0))

    @property
    def best(self) -> Array:
        """(m, r) the margin of that side."""
        return np.asarray(self.margin.max(axis=0))

    def limit_at(self, side: int, column: int, row: int) -> tuple[Frame, Limit] | None:
        """(frame, limit) that leaves no more at a cell; None where none asks for anything."""
        return limited_name(int(self.binding[side, column, row]))


def plane_map(
    time: ArrayLike,
    attitude: ArrayLike,
    rig: Rig,
    angles: ArrayLike | None = None,
    columns: int = COLUMNS,
    rows: int = ROWS,
) -> PlaneMap:
    """The map of a flight: time (n,) [s], attitude (n, 3, 3) body from reference, on a rig of four axes.

    angles (n, 4) [rad]: a path of the frames to be shown in it. Columns are samples of the flight, evenly in their
    order, at most `columns`. Rows are base angles: the whole range where that is a turn at most, else half a turn
    beyond the path on either side (or beyond home, without one), inside the range. What is between the grid's points is
    not looked at.

    Raises `InputError` for what is no flight, no path of it or no size, `MethodError` for a rig without a free base.
    """
    t, C = check_flight(time, attitude)
    if not rig.geometry.redundant:
        raise MethodError(f"rig {rig.name} has three axes: an attitude leaves it no choice, so there is no plane of it")
    if rig.position_max[0] - rig.position_min[0] < LOCKED:
        raise MethodError(f"the base of rig {rig.name} has no range to move in: there is no plane of it")
    if len(t) < 2:
        raise InputError("time", None, t.shape, "two samples at least")
    if columns < 2 or rows < 2 or columns * rows > MOST_CELLS:
        raise InputError("columns and rows", None, (columns, rows), f"two at least each, {MOST_CELLS} cells at most")
    x = None if angles is None else _path(angles, len(t))
    chosen = np.unique(np.linspace(0.0, len(t) - 1.0, columns).round().astype(np.int64))
    base = _base_angles(rig, x, rows)
    cells = _cells(t, C, rig, chosen, base)
    path = None if x is None else path_margin(t, x, rig)
    made = PlaneMap(rig, t[chosen], base, *cells, _needles(t, C, rig), path)
    held = (made.time, made.base, *cells, *made.needles)
    for array in held if path is None else (*held, path.base, path.side, path.margin, path.binding):
        array.setflags(write=False)
    return made


def path_margin(time: Array, angles: Array, rig: Rig) -> PathMargin:
    """What angles (n, 4) [rad] at time (n,) [s] leave of the limits; a frame that cannot move has no say."""
    n = len(time)
    spans = rig.position_max - rig.position_min
    counted = (spans >= LOCKED) & np.isfinite(spans)
    unit = np.where(counted, 0.5 * spans, 1.0)
    margin, binding = np.empty(n), np.empty(n, np.int16)
    for begin in range(0, n, CHUNK):
        end, wide = min(n, begin + CHUNK), max(0, begin - 2)
        shares = limit_shares(time[wide : end + 2], angles[wide : end + 2], rig, unit)
        shares[:, ~counted, POSITION] = np.inf
        flat = shares[begin - wide : end - wide].reshape(end - begin, -1)
        least = np.argmin(flat, axis=1)
        margin[begin:end] = np.minimum(flat[np.arange(end - begin), least], 1.0)
        binding[begin:end] = np.where(margin[begin:end] < 1.0, CODES[least], EXACT)
    return PathMargin(angles[:, 0].copy(), (np.cos(angles[:, 2]) < 0.0).astype(np.int64), margin, binding)


def _path(angles: ArrayLike, n: int) -> Array:
    x = np.array(angles, dtype=np.float64)
    if x.shape != (n, 4) or not np.isfinite(x).all():
        raise InputError("angles", None, x.shape, f"({n}, 4) finite angles, one row a sample")
    return x


def _base_angles(rig: Rig, path: Array | None, rows: int) -> Array:
    low, high = float(rig.position_min[0]), float(rig.position_max[0])
    if high - low > TURN:
        visited = rig.home[:1] if path is None else path[:, 0]
        low = max(low, float(visited.min()) - 0.5 * TURN)
        high = min(high, float(visited.max()) + 0.5 * TURN)
    return np.linspace(low, high, rows)


def _cells(time: Array, attitude: Array, rig: Rig, chosen: Integers, base: Array) -> Cells:
    shape = 2, len(chosen), len(base)
    cells = Cells(np.empty(shape), np.empty(shape, np.int16), np.empty(shape, np.int16))
    rate = np.empty((len(chosen), 3))
    _body_rates(time, attitude, chosen, rate)
    fill_cells(rig.geometry.horizontal, limit_table(rig), attitude[chosen], rate, base, cells)
    return cells


@kernel
def _body_rates(time: Array, attitude: Array, chosen: Integers, rate: Array) -> None:
    """rate (m, 3) [rad/s] <- about the body's axes at the samples `chosen` (m,), by their neighbours on both sides."""
    last = time.shape[0] - 1
    for j in range(chosen.shape[0]):
        before, after = max(chosen[j] - 1, 0), min(chosen[j] + 1, last)
        rotation_error(attitude[after], attitude[before], rate[j])
        for i in range(3):
            rate[j, i] /= time[after] - time[before]


def _needles(time: Array, attitude: Array, rig: Rig) -> MapNeedles:
    """The needles and their widths.

    Where V01 crosses zero, M01' = V01' whatever the base does, and a path that passes at the base angle's distance x
    has M00 = sin x up to its sign, so the outer frame goes at |V01' / sin x| there.
    """
    found = needles(time, attitude, rig.geometry.horizontal)
    slope = np.abs(np.gradient(vertical_views(attitude, rig.geometry.horizontal)[:, 0, 1], time))
    share = np.interp(found.time, time, slope) / rig.max_rate[OUTER]
    return MapNeedles(found.time, found.base, np.arcsin(np.minimum(share, 1.0)))
