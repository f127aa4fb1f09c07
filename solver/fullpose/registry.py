"""Methods by name with their options, from text or JSON: names and types are those of their dataclasses."""

from collections.abc import Mapping
from dataclasses import asdict, fields
from typing import Any

from fullpose.errors import MethodError
from fullpose.methods import METHODS
from fullpose.solve import PLAN, PREVIEW
from fullpose.variant import Variant

PLAN_SOURCE = "the whole flight at once: dynamic programming on both charts, then a sparse quadratic programme"
PREVIEW_SOURCE = "the exact step along a way re-planned over a horizon of known or predicted attitude"


def method_names() -> tuple[str, ...]:
    """All methods, in the order of the command line."""
    return (PLAN, PREVIEW, *METHODS)


def method_options(method: str, values: Mapping[str, Any]) -> Any:
    """The options object of a method; None, its defaults, where nothing is given.

    Raises `MethodError` for an unknown method or option, or a value of another type.
    """
    if method not in method_names():
        raise MethodError(f"no method named {method!r}: expected one of {', '.join(method_names())}")
    if not values:
        return None
    defaults = option_defaults(method)
    kept = {}
    for name, value in values.items():
        if name not in defaults:
            known = ", ".join(defaults) or "none"
            raise MethodError(f"method {method} has no option {name!r}: its options are {known}")
        wanted = type(defaults[name])
        if not (isinstance(value, wanted) or (wanted is float and type(value) is int)):
            raise MethodError(f"option {name} of {method}: {value!r}: expected {wanted.__name__}")
        kept[name] = wanted(value)
    try:
        return _options_type(method)(**kept)
    except ValueError as error:
        raise MethodError(f"options of {method}: {error}") from None


def option_defaults(method: str) -> dict[str, Any]:
    """Names and defaults of a method's options."""
    kind = _options_type(method)
    return {field.name: value for field, value in zip(fields(kind), asdict(kind()).values(), strict=True)}


def parse_option(text: str, method: str) -> tuple[str, Any]:
    """(name, value) of `name=value`, the value read as the option's type. Raises `MethodError`."""
    name, equals, value = text.partition("=")
    if not equals:
        raise MethodError(f"option {text!r}: expected name=value")
    default = option_defaults(method).get(name) if method in method_names() else None
    try:
        if isinstance(default, bool):
            return name, {"true": True, "false": False}[value.lower()]
        if isinstance(default, (int, float)):
            return name, type(default)(value)
    except (ValueError, KeyError):
        raise MethodError(f"option {name} of {method}: {value!r}: expected {type(default).__name__}") from None
    return name, value


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
    if method not in method_names():
        raise MethodError(f"no method named {method!r}: expected one of {', '.join(method_names())}")
    return variant(method, dict(parse_option(option, method) for option in options))


def _written(value: Any) -> str:
    """As `parse_option` reads it."""
    if isinstance(value, bool):
        return str(value).lower()
    return str(value).removesuffix(".0") if isinstance(value, float) else str(value)


def _options_type(method: str) -> type[Any]:
    if method in (PLAN, PREVIEW):
        from fullpose.plan import PlanOptions, PreviewOptions  # the planner is loaded by those who plan

        return PlanOptions if method == PLAN else PreviewOptions
    return METHODS[method].options
