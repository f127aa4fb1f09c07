"""Every method in one table, `plan` and `preview` too, in the order of the command line; and their options, from text
or JSON: names and types are those of their dataclasses.

The planner is loaded by those who plan: a row holds its options, which are light, and imports the rest when it is run.
"""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, fields
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from fullpose._typing import Array, Clock, Progress
from fullpose.errors import MethodError
from fullpose.methods import METHODS
from fullpose.methods.base import StepMethod, Stepper
from fullpose.preview.options import PreviewOptions
from fullpose.rig import Rig
from fullpose.trajectory.options import PlanOptions

if TYPE_CHECKING:
    from fullpose.plan import Plan

OptionValue = bool | int | float | str
DEFAULT = "plan"  # of `fullpose.solve` and of the command line


class Sees(StrEnum):
    """How much of a flight a method sees when it chooses a sample's angles."""

    FLIGHT = "the whole flight"
    AHEAD = "a part of it ahead"
    SAMPLE = "one sample at a time"


@dataclass(frozen=True)
class Method:
    """A row of the table: a `Planner` or a `Stepwise`."""

    name: str
    source: str  # paper, section, equation
    claims_limits: bool
    options: type[Any]  # a frozen dataclass whose fields have defaults
    sees: Sees

    def chosen(self, options: Any) -> Any:
        """The options given, or the defaults for None. Raises `MethodError` for those of another method."""
        if options is None:
            return self.options()
        if not isinstance(options, self.options):
            raise MethodError(f"options of {self.name}: expected {self.options.__name__}, not {type(options).__name__}")
        return options


@dataclass(frozen=True)
class Planner(Method):
    """A method that sees the whole flight: (time (n,) [s], attitude (n, 3, 3), rig, near, options, progress, clock)."""

    plans: "Callable[[Array, Array, Rig, Array | None, Any, Progress | None, Clock | None], Plan]"


@dataclass(frozen=True)
class Stepwise(Method):
    """A method that goes sample by sample.

    begins: (rig, options, near which pose (4,) [rad] to start or None for home, time (n,) [s], attitude (n, 3, 3)) ->
    the flight in progress. step: what can be begun without a flight, from a stream's first attitude or on a rig that
    stands.
    """

    begins: Callable[[Rig, Any, Array | None, Array, Array], Stepper]
    step: StepMethod | None = None


def _plan(
    time: Array, attitude: Array, rig: Rig, near: Array | None, options: Any, progress: Progress | None,
    clock: Clock | None,
) -> "Plan":  # fmt: skip
    from fullpose.plan import plan

    return plan(time, attitude, rig, near, options=options, progress=progress, clock=clock)


def _preview(rig: Rig, options: Any, near: Array | None, time: Array, attitude: Array) -> Stepper:
    from fullpose.preview.flight import PreviewFlight

    return PreviewFlight(rig, options, near, time, attitude)


def _stepwise(step: StepMethod) -> Stepwise:
    def begins(rig: Rig, options: Any, near: Array | None, time: Array, attitude: Array) -> Stepper:  # noqa: ARG001
        return step.stepper(rig, options, near, attitude[0])

    return Stepwise(step.name, step.source, step.claims_limits, step.options, Sees.SAMPLE, begins=begins, step=step)


_ROWS: tuple[Planner | Stepwise, ...] = (
    Planner(
        "plan",
        "the whole flight at once: dynamic programming on both charts, then a sparse quadratic programme "
        "(mathematics, section 8)",
        claims_limits=True,
        options=PlanOptions,
        sees=Sees.FLIGHT,
        plans=_plan,
    ),
    Stepwise(
        "preview",
        "the exact step along a trajectory re-planned over a horizon of known or predicted attitude "
        "(mathematics, section 9)",
        claims_limits=True,
        options=PreviewOptions,
        sees=Sees.AHEAD,
        begins=_preview,
    ),
    *map(_stepwise, METHODS.values()),
)

REGISTRY: Mapping[str, Planner | Stepwise] = {row.name: row for row in _ROWS}


def find_method(name: str) -> Planner | Stepwise:
    """The row of a method. Raises `MethodError` where there is none of this name."""
    if name not in REGISTRY:
        raise MethodError(f"no method named {name!r}: expected one of {', '.join(REGISTRY)}")
    return REGISTRY[name]


def find_step(name: str) -> StepMethod:
    """A method that can be streamed. Raises `MethodError` for one that sees more of a flight, or an unknown name."""
    match find_method(name):
        case Stepwise(step=StepMethod() as step):
            return step
    raise MethodError(f"method {name!r} cannot be streamed: expected one of {', '.join(METHODS)}")


def method_names() -> tuple[str, ...]:
    """All methods, in the order of the command line."""
    return tuple(REGISTRY)


def method_options(method: str, values: Mapping[str, Any]) -> Any:
    """The options object of a method; None, its defaults, where nothing is given.

    Raises `MethodError` for an unknown method or option, or a value of another type or outside its range.
    """
    row = find_method(method)
    if not values:
        return None
    known = [each.name for each in fields(row.options)]
    for name in values:
        if name not in known:
            raise MethodError(f"method {method} has no option {name!r}: its options are {', '.join(known) or 'none'}")
    return row.options(**values)


def option_defaults(method: str) -> dict[str, Any]:
    """Names and defaults of a method's options. Raises `MethodError` where there is no such method."""
    kind = find_method(method).options
    return {each.name: value for each, value in zip(fields(kind), asdict(kind()).values(), strict=True)}


def parse_option(text: str, method: str) -> tuple[str, Any]:
    """(name, value) of `name=value`, the value read as the option's type. Raises `MethodError`."""
    name, equals, value = text.partition("=")
    if not equals:
        raise MethodError(f"option {text!r}: expected name=value")
    default = option_defaults(method).get(name)
    try:
        if isinstance(default, bool):
            return name, {"true": True, "false": False}[value.lower()]
        if isinstance(default, (int, float)):
            return name, type(default)(value)
    except (ValueError, KeyError):
        raise MethodError(f"option {name} of {method}: {value!r}: expected {type(default).__name__}") from None
    return name, value


@dataclass(frozen=True)
class Variant:
    """A method as it is asked for in a comparison: its name, its options, and a label that tells it from the others.

    `options` by name, those not given at their defaults; `variant` checks them.
    """

    method: str
    label: str
    options: Mapping[str, OptionValue] = field(default_factory=dict)


def variant(method: str, options: Mapping[str, Any] | None = None, label: str | None = None) -> Variant:
    """A method with some of its options; without a label it is called by them, as `parse_variant` reads it.

    Raises `MethodError` as `method_options` does.
    """
    values = dict(options or {})
    method_options(method, values)
    if label is None:
        given = [f"{name}={_written(values[name])}" for name in option_defaults(method) if name in values]
        label = ":".join([method, *given])
    return Variant(method, label, values)


def parse_variant(text: str) -> Variant:
    """The variant of `method` or `method:name=value:name=value`. Raises `MethodError`."""
    method, *options = text.strip().split(":")
    find_method(method)
    return variant(method, dict(parse_option(option, method) for option in options))


def _written(value: Any) -> str:
    """As `parse_option` reads it."""
    if isinstance(value, bool):
        return str(value).lower()
    return str(value).removesuffix(".0") if isinstance(value, float) else str(value)
