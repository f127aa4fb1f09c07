"""Options of a method from text or JSON: names and types are those of its dataclass in `solver`."""

from dataclasses import asdict, fields
from typing import Any

from solver.errors import MethodError
from solver.methods import METHODS


def method_options(method: str, values: dict[str, Any]) -> Any:
    """The options object of a method, None where nothing is given and the method has its defaults.

    Raises `MethodError` for an unknown method or option, or a value of another type.
    """
    if method not in METHODS:
        raise MethodError(f"no method named {method!r}: expected one of {', '.join(METHODS)}")
    if not values:
        return None
    kind = METHODS[method].options
    defaults = option_defaults(method)
    for name, value in values.items():
        if name not in defaults:
            known = ", ".join(defaults) or "none"
            raise MethodError(f"method {method} has no option {name!r}: its options are {known}")
        wanted = type(defaults[name])
        if not (isinstance(value, wanted) or (wanted is float and type(value) is int)):
            raise MethodError(f"option {name} of {method}: {value!r}: expected {wanted.__name__}")
    return kind(**{name: type(defaults[name])(value) for name, value in values.items()})


def option_defaults(method: str) -> dict[str, Any]:
    """Names and defaults of a method's options."""
    kind = METHODS[method].options
    return {field.name: value for field, value in zip(fields(kind), asdict(kind()).values(), strict=True)}
