"""The step methods by name, in the order of the command line (`plan` sees the whole flight: `fullpose.plan`)."""

from fullpose.methods import (
    alm,
    clamped,
    dwln,
    exact,
    fixed_joint,
    follow_up,
    gradient_projection,
    lagrange,
    three_axis,
    weighted,
)
from fullpose.methods.base import StepMethod

_MODULES = (
    exact,
    alm,
    dwln,
    lagrange,
    weighted,
    gradient_projection,
    fixed_joint,
    clamped,
    follow_up,
    three_axis,
)

METHODS: dict[str, StepMethod] = {module.METHOD.name: module.METHOD for module in _MODULES}
