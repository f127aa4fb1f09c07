"""Every options class says what is wrong with a value, before anything is begun with it."""

import math
from dataclasses import fields

import numpy as np
import pytest

from fullpose.errors import MethodError
from fullpose.options import Range
from fullpose.registry import REGISTRY, method_options

NUMBERS = [
    (name, each.name) for name, row in REGISTRY.items() for each in fields(row.options) if "range" in each.metadata
]


@pytest.mark.parametrize("name", REGISTRY)
def test_every_number_has_a_range_and_its_default_is_inside(name: str) -> None:
    for each in fields(REGISTRY[name].options):
        if isinstance(each.default, (int, float)) and not isinstance(each.default, bool):
            assert isinstance(each.metadata.get("range"), Range), each.name
            assert each.default in each.metadata["range"]


@pytest.mark.parametrize(("name", "option"), NUMBERS)
def test_what_is_out_of_range_is_named_with_what_was_expected(name: str, option: str) -> None:
    kind = REGISTRY[name].options
    allowed = next(each.metadata["range"] for each in fields(kind) if each.name == option)
    for wrong in (math.nan, math.inf, -math.inf, allowed.least - 1.0):
        with pytest.raises(MethodError, match=f"option {option} = .*expected (a number|int)"):
            kind(**{option: wrong})


@pytest.mark.parametrize("option", ["grid", "stage", "knot", "fine_grid", "trust", "window", "iterations"])
def test_a_plan_is_not_begun_with_nothing_to_step_by(option: str) -> None:
    with pytest.raises(MethodError, match=f"option {option} = 0"):
        method_options("plan", {option: 0})


def test_two_options_that_contradict_each_other() -> None:
    with pytest.raises(MethodError, match="overlap = 12"):
        method_options("plan", {"overlap": 12.0})
    with pytest.raises(MethodError, match="max_penalty = 1"):
        method_options("alm", {"max_penalty": 1.0})
    with pytest.raises(MethodError, match="back_beyond"):
        method_options("follow_up", {"back_beyond": 0.1})


def test_a_word_of_a_closed_vocabulary() -> None:
    assert method_options("alm", {"mode": "exact_inner"}).mode == "exact_inner"
    with pytest.raises(
        MethodError, match=r"mode = 'sideways': expected one of closed_loop, open_loop, exact, exact_inner"
    ):
        method_options("alm", {"mode": "sideways"})


@pytest.mark.parametrize(
    ("method", "option", "value", "kind"),
    [
        ("plan", "iterations", 1.5, "int"),
        ("plan", "iterations", True, "int"),
        ("plan", "grid", "fine", "float"),
        ("plan", "best_effort", "no", "bool"),
        ("plan", "best_effort", 1, "bool"),
        ("preview", "beam", 1.5, "int"),
        ("exact", "avoidance", None, "float"),
        ("exact", "avoidance", [2.0], "float"),
    ],
)
def test_a_value_of_another_type_is_refused_wherever_it_comes_from(
    method: str, option: str, value: object, kind: str
) -> None:
    """Made by hand, `iterations=1.5` passed and "fine" was a TypeError."""
    for made in (lambda: REGISTRY[method].options(**{option: value}), lambda: method_options(method, {option: value})):
        with pytest.raises(MethodError, match=f"option {option} = .*expected {kind}"):
            made()


def test_numbers_of_numpy_and_whole_numbers_are_numbers() -> None:
    made = method_options("plan", {"grid": np.float64(0.01), "stage": 1, "iterations": np.int64(3)})
    assert (made.grid, made.stage, made.iterations) == (0.01, 1, 3)
