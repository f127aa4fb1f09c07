"""Uniform splines of any degree whose values at the ends are their first and last coefficients."""

import numpy as np
from scipy.interpolate import BSpline

from fullpose._typing import Array
from fullpose.trajectory.qp import Matrix


def clamped_basis(time: Array, knot: float, degree: int) -> tuple[Array, Matrix]:
    """(knots, the values (n, m) of the functions at time (n,) [s]), knots about `knot` [s] apart."""
    pieces = max(1, round(float(time[-1] - time[0]) / knot))
    knots = np.r_[[time[0]] * degree, np.linspace(time[0], time[-1], pieces + 1), [time[-1]] * degree]
    return knots, BSpline.design_matrix(time, knots, degree).tocsr()
