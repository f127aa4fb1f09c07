"""Sums over a flight's samples of the uniform quintic B-splines; nothing of a flight's length is held.

A spline of d components has coefficients (size, d); at a sample the WIDTH of them from `first` on count.
"""

import math
from typing import NamedTuple

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array

DEGREE = 5
WIDTH = DEGREE + 1  # functions that are not zero at one time
# Function a of a piece is sum_p PIECES[a, p] u^p, u from 0 to 1 (de Boor, "A Practical Guide to Splines", chapter X).
PIECES = (
    np.array(
        [
            [1.0, -5.0, 10.0, -10.0, 5.0, -1.0],
            [26.0, -50.0, 20.0, 20.0, -20.0, 5.0],
            [66.0, 0.0, -60.0, 0.0, 30.0, -10.0],
            [26.0, 50.0, 20.0, -20.0, -20.0, 10.0],
            [1.0, 5.0, 10.0, 10.0, 5.0, -5.0],
            [0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        ]
    )
    / 120.0
)


class Knots(NamedTuple):
    """Uniform knots: `pieces` intervals of `interval` [s] from `begin` [s]; pieces + DEGREE functions."""

    begin: float
    interval: float
    pieces: int


@kernel
def at_sample(knots: Knots, time: float, values: Array) -> int:
    """The first function that counts at a time [s]; values (WIDTH,) <- those of it and the following ones."""
    s = (time - knots.begin) / knots.interval
    first = min(max(math.floor(s), 0), knots.pieces - 1)
    u = s - first
    for a in range(WIDTH):
        total = PIECES[a, DEGREE]
        for p in range(DEGREE - 1, -1, -1):
            total = total * u + PIECES[a, p]
        values[a] = total
    return first


@kernel
def add_normal_equations(knots: Knots, time: Array, data: Array, bands: Array, right: Array) -> None:
    """bands (WIDTH, size), right (size, d) += B^T B, its upper bands with the diagonal last, and B^T data (n, d)."""
    v = np.empty(WIDTH)
    for k in range(len(time)):
        first = at_sample(knots, time[k], v)
        for a in range(WIDTH):
            for b in range(a, WIDTH):
                bands[DEGREE - (b - a), first + b] += v[a] * v[b]
            for i in range(data.shape[1]):
                right[first + a, i] += v[a] * data[k, i]


@kernel
def curve(knots: Knots, time: Array, coefficients: Array, out: Array) -> None:
    """out (n, d) <- the spline at `time` (n,)."""
    v = np.empty(WIDTH)
    for k in range(len(time)):
        first = at_sample(knots, time[k], v)
        for i in range(out.shape[1]):
            total = 0.0
            for a in range(WIDTH):
                total += v[a] * coefficients[first + a, i]
            out[k, i] = total


class Tube(NamedTuple):
    """|s(t_k) - target_k| < radius at every sample, s a spline in three dimensions."""

    time: Array  # (n,) [s]
    target: Array  # (n, 3)
    data: Array  # (n,) 1 where the sample counts in the least squares, 0 where it only bounds
    radius: float


@kernel
def tube_sums(knots: Knots, tube: Tube, c: Array) -> tuple[float, float, float]:
    """(sum of data |e|^2, sum of -log(1 - |e|^2 / radius^2), largest |e|), e = s - target; outside, inf."""
    v = np.empty(WIDTH)
    squares = barrier = largest = 0.0
    for k in range(len(tube.time)):
        first = at_sample(knots, tube.time[k], v)
        square = 0.0
        for i in range(3):
            e = -tube.target[k, i]
            for a in range(WIDTH):
                e += v[a] * c[first + a, i]
            square += e * e
        squares += tube.data[k] * square
        largest = max(largest, square)
        inside = 1.0 - square / (tube.radius * tube.radius)
        barrier += -math.log(inside) if inside > 0.0 else math.inf
    return squares, barrier, math.sqrt(largest)


class Weights(NamedTuple):
    """What a sample weighs in the cost: `data` / 2 |e|^2 where it counts, - `barrier` log(1 - |e|^2 / radius^2)."""

    data: float
    barrier: float


@kernel
def add_tube(knots: Knots, tube: Tube, c: Array, weights: Weights, bands: Array, gradient: Array) -> None:
    """bands (3 WIDTH, 3 size), gradient (size, 3) += the samples' second and first derivatives, for `solve_banded`.

    Unknown 3 a + i is component i of coefficient a.
    """
    v, e, M = np.empty(WIDTH), np.empty(3), np.empty((3, 3))
    square = tube.radius * tube.radius
    for k in range(len(tube.time)):
        first = at_sample(knots, tube.time[k], v)
        room = square
        for i in range(3):
            e[i] = -tube.target[k, i]
            for a in range(WIDTH):
                e[i] += v[a] * c[first + a, i]
            room -= e[i] * e[i]
        slope = weights.data * tube.data[k] + 2.0 * weights.barrier / room
        for i in range(3):
            for j in range(3):
                M[i, j] = 4.0 * weights.barrier * e[i] * e[j] / (room * room)
            M[i, i] += slope
        for a in range(WIDTH):
            for i in range(3):
                gradient[first + a, i] += v[a] * slope * e[i]
                row = 3 * (first + a) + i
                for b in range(a, WIDTH):
                    for j in range(i if a == b else 0, 3):
                        column = 3 * (first + b) + j
                        bands[3 * WIDTH - 1 - (column - row), column] += v[a] * v[b] * M[i, j]
