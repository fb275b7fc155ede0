"""Gradients against mpmath's derivatives and against jets, selections with NaN, cost."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest

from centrode.numerics.arrays import ARRAYS
from centrode.numerics.expressions import EXPRESSIONS, variable
from centrode.numerics.graphs import Graph, gradient
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.scans import evaluate

EPS = 2.0**-52
m = EXPRESSIONS
NAMES = ("a", "b", "c")
VARIABLES = [variable(name) for name in NAMES]
AT = (0.7, 1.3, 0.4)
Formula = Callable[..., Any]


class Precise:
    """The functions in mpmath's names."""

    sin, cos, exp, log, sqrt, atan2, abs = mp.sin, mp.cos, mp.exp, mp.log, mp.sqrt, mp.atan2, mp.fabs
    min, max = staticmethod(min), staticmethod(max)
    least, greatest = min, max
    less = staticmethod(lambda x, y: x < y)
    where = staticmethod(lambda condition, x, y: x if condition else y)


FORMULAS: dict[str, Formula] = {
    "sums": lambda m, a, b, c: 2.0 + a - b + (a - 3.0 * c) - (-b),
    "products": lambda m, a, b, c: a * b * c * (a * a - 2.0),
    "quotients": lambda m, a, b, c: a / b - (b + c) / (a * a + 1.0) + 2.0 / c,
    "roots": lambda m, a, b, c: m.sqrt(a * a + b) * m.sqrt(c),
    "angles": lambda m, a, b, c: m.sin(a * b) - m.cos(c) * m.atan2(b - c, a + c),
    "exponentials": lambda m, a, b, c: m.exp(-a * b) + m.log(b + c),
    "powers": lambda m, a, b, c: (a + b) ** 2.5 + (1.0 + c) ** a,
    "sides": lambda m, a, b, c: m.abs(a - b) + m.min(a, c) * m.max(a * a, b) + m.least(b, c) * m.greatest(a, c),
    "selection": lambda m, a, b, c: m.where(m.less(a, b), a * b, c) * m.where(m.less(b, a), b, c * c),
    "dyad": lambda m, a, b, c: m.sqrt((4.0 - a * a) * (a * a - 0.01 * c)) / (a * a) * m.cos(b) - b / c,
}  # fmt: skip


def traced(formula: Formula) -> list[float]:
    parts = gradient(formula(m, *VARIABLES), VARIABLES)
    graph = Graph.of(dict(zip(NAMES, parts, strict=True)))
    return [float(x) for x in evaluate(graph, dict(zip(NAMES, AT, strict=True))).values()]


@pytest.mark.parametrize("name", FORMULAS)
def test_against_many_digits(name: str) -> None:
    formula = FORMULAS[name]
    with mp.workdps(40):
        for i, found in enumerate(traced(formula)):
            numbers = [mp.mpf(x) for x in AT]

            def along(x: Any, i: int = i, numbers: list[Any] = numbers) -> Any:
                return formula(Precise, *numbers[:i], x, *numbers[i + 1 :])

            # a few dozen roundings of numbers below 10
            assert abs(found - float(mp.diff(along, numbers[i]))) <= 64 * EPS * 10, NAMES[i]


@pytest.mark.parametrize("name", sorted(set(FORMULAS) - {"selection", "powers", "sides"}))
def test_against_jets(name: str) -> None:
    formula, jets = FORMULAS[name], JetFunctions(ARRAYS)
    for i, found in enumerate(traced(formula)):
        numbers: list[Any] = list(AT)
        numbers[i] = Jet.variable(AT[i], 1)
        jet = formula(jets, *numbers)
        expected = jet.derivative(1) if isinstance(jet, Jet) else 0.0
        assert abs(found - expected) <= 64 * EPS * 10, NAMES[i]


def test_what_it_does_not_depend_on() -> None:
    a, b, c = VARIABLES
    assert gradient(a * b, [c]) == [0.0]
    assert gradient(a, [a, b]) == [1.0, 0.0]
    assert gradient(m.where(a < b, c, 2.0), [a, b])[0] == 0.0


def test_what_is_not_selected_may_be_nan() -> None:
    a, b, _c = VARIABLES
    value = m.where(a < 0.0, b, m.sqrt(a) * b) + m.greatest(m.sqrt(a), 2.0 * b)
    graph = Graph.of({"a": (parts := gradient(value, [a, b]))[0], "b": parts[1]})
    found = evaluate(graph, {"a": np.array([-1.0, 4.0]), "b": np.array([3.0, 0.5])})
    # at a = -1 the root is NaN, and neither side takes it; at a = 4 the root is 2 and greater than 1
    assert found["a"].tolist() == [0.0, 0.25 * 0.5 + 0.25]
    assert found["b"].tolist() == [1.0 + 2.0, 2.0]


def test_nan_stays_where_it_is_the_value() -> None:
    a, b, _c = VARIABLES
    (part,) = gradient(m.sqrt(a) * b, [a])
    assert np.isnan(evaluate(Graph.of({"d": part}), {"a": -1.0, "b": 2.0})["d"])


def test_second_derivatives_are_gradients_of_gradients() -> None:
    a, b, _c = VARIABLES
    (first,) = gradient(m.sin(a * b) / a, [a])
    second = gradient(first, [b])[0]  # type: ignore[arg-type]
    found = float(evaluate(Graph.of({"d": second}), {"a": 0.7, "b": 1.3})["d"])
    assert abs(found - (-1.3 * np.sin(0.7 * 1.3))) <= 64 * EPS


def test_it_costs_a_few_times_the_value() -> None:
    """The cheap gradient principle (Griewank and Walther, section 4.6): a small multiple, whatever the formula."""
    names = [f"p{i}" for i in range(6)]
    p = [variable(name) for name in names]
    value = FORMULAS["dyad"](m, *p[:3]) * FORMULAS["products"](m, *p[3:]) + FORMULAS["angles"](
        m, p[0], p[3], p[5]
    )
    parts = dict(zip(names, gradient(value, p), strict=True))
    cost = Graph({"value": value}).counts.total()
    assert Graph.of({"value": value, **parts}).counts.total() <= 5 * cost
