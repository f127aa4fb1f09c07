"""The step methods by name, in the order of the command line (`plan` sees the whole flight: `solver.planner`)."""

from solver.methods import alm, exact
from solver.methods.base import StepMethod

METHODS: dict[str, StepMethod] = {method.name: method for method in (exact.METHOD, alm.METHOD)}
