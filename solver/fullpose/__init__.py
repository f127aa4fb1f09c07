"""Fullpose: attitude trajectories on four-axis flight motion simulators. Angles in radians, times in seconds.

The mathematics is docs/mathematics.md. A name is loaded when it is first used: the rig process takes its kinematics
from here, and has no time for the planner.
"""

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fullpose._version import __version__
    from fullpose.attitude import (
        dcm_from_euler,
        dcm_from_quaternion,
        euler_from_dcm,
        euler_from_ned,
        quaternion_from_dcm,
        quaternion_from_euler,
        quaternion_from_ned,
    )
    from fullpose.compare import compare
    from fullpose.errors import CancelledError, InputError, MethodError, RigError, SolverError
    from fullpose.plan import Plan, PlanOptions, PreviewOptions, plan
    from fullpose.recorded import diagnose, smooth
    from fullpose.registry import method_names, method_options
    from fullpose.resample import resample
    from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
    from fullpose.scenarios import SCENARIOS
    from fullpose.solution import Solution
    from fullpose.solve import solve
    from fullpose.trajectory.plane_map import plane_map
    from fullpose.verify import verify

_HOMES = {
    "_version": ("__version__",),
    "attitude": (
        "dcm_from_euler", "dcm_from_quaternion", "euler_from_dcm", "euler_from_ned", "quaternion_from_dcm",
        "quaternion_from_euler", "quaternion_from_ned",
    ),
    "compare": ("compare",),
    "errors": ("CancelledError", "InputError", "MethodError", "RigError", "SolverError"),
    "plan": ("Plan", "PlanOptions", "PreviewOptions", "plan"),
    "recorded": ("diagnose", "smooth"),
    "registry": ("method_names", "method_options"),
    "resample": ("resample",),
    "rig": ("FrameLimits", "Geometry", "Rig", "builtin_rigs"),
    "scenarios": ("SCENARIOS",),
    "solution": ("Solution",),
    "solve": ("solve",),
    "trajectory.plane_map": ("plane_map",),
    "verify": ("verify",),
}  # fmt: skip
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "SCENARIOS",
    "CancelledError",
    "FrameLimits",
    "Geometry",
    "InputError",
    "MethodError",
    "Plan",
    "PlanOptions",
    "PreviewOptions",
    "Rig",
    "RigError",
    "Solution",
    "SolverError",
    "__version__",
    "builtin_rigs",
    "compare",
    "dcm_from_euler",
    "dcm_from_quaternion",
    "diagnose",
    "euler_from_dcm",
    "euler_from_ned",
    "method_names",
    "method_options",
    "plan",
    "plane_map",
    "quaternion_from_dcm",
    "quaternion_from_euler",
    "quaternion_from_ned",
    "resample",
    "smooth",
    "solve",
    "verify",
]


class _Face(ModuleType):
    """This package, so that `fullpose.solve` is the function whether or not its module of that name is loaded yet."""

    def __getattr__(self, name: str) -> Any:
        if name not in _HOME_OF:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        value = getattr(import_module(f"{__name__}.{_HOME_OF[name]}"), name)
        super().__setattr__(name, value)
        return value

    def __setattr__(self, name: str, value: object) -> None:
        if not (name in _HOME_OF and isinstance(value, ModuleType)):  # a loaded module does not take a name's place
            super().__setattr__(name, value)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *__all__})


sys.modules[__name__].__class__ = _Face
