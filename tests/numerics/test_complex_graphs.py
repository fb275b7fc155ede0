"""Graphs over complex numbers as graphs over real ones, and as functions of Python: against Python's own numbers."""

from __future__ import annotations

import cmath

import numpy as np
import pytest

from centrode.numerics.complex_graphs import IMAGINARY, complex_parts
from centrode.numerics.expressions import EXPRESSIONS, Node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.python_functions import python_function
from centrode.numerics.scans import evaluate

m = EXPRESSIONS
x, y, r = variable("x"), variable("y"), variable("r")
EPS = 2.0**-52

FORMULAS: dict[str, tuple[Node, object]] = {
    "arithmetic": ((x * y - r) / (x + 2.0 * y) + -x, lambda x, y, r: (x * y - r) / (x + 2 * y) - x),
    "roots": (m.sqrt(x * x + y * y + 4.0), lambda x, y, r: cmath.sqrt(x * x + y * y + 4)),
    "circles": (m.sin(x) * m.cos(y - r), lambda x, y, r: cmath.sin(x) * cmath.cos(y - r)),
    "growth": (m.exp(x) * m.log(y + 3.0), lambda x, y, r: cmath.exp(x) * cmath.log(y + 3)),
    "angles": (m.atan2(y, x), lambda x, y, r: -1j * cmath.log((x + 1j * y) / cmath.sqrt(x * x + y * y))),
    "powers": ((x + 3.0) ** 1.5, lambda x, y, r: (x + 3) ** 1.5),
    "sides": (m.max(x, y) + m.min(x, r) + m.abs(-x), lambda x, y, r: x + r + x),
    "choices": (m.where(m.less(x, r), x, y * y), lambda x, y, r: y * y),
}


@pytest.mark.parametrize("name", FORMULAS)
def test_values_next_to_the_real_axis(name: str) -> None:
    node, exact = FORMULAS[name]
    at = {"x": 0.9 + 0.2j, "y": 0.4 - 0.3j, "r": 0.5}
    expected = exact(at["x"], at["y"], at["r"])  # type: ignore[operator]
    parts = complex_parts(Graph({"value": node}), {"r"})["value"]
    real = Graph.of({"real": parts.real, "imaginary": parts.imaginary})
    given = {"x": 0.9, IMAGINARY + "x": 0.2, "y": 0.4, IMAGINARY + "y": -0.3, "r": 0.5}
    found = evaluate(real, given)
    bound = 32 * EPS * max(1.0, abs(expected))
    assert abs(complex(float(found["real"]), float(found["imaginary"])) - expected) <= bound
    (plain,) = python_function(Graph({"value": node}), ("x", "y", "r"), is_complex=True)(
        [at["x"], at["y"], at["r"]]
    )
    assert abs(plain - expected) <= bound


@pytest.mark.parametrize("name", FORMULAS)
def test_python_has_the_numbers_of_the_arrays(name: str) -> None:
    node, _exact = FORMULAS[name]
    graph = Graph({"value": node})
    (found,) = python_function(graph, ("x", "y", "r"))([0.9, 0.4, 0.5])
    expected = float(evaluate(graph, {"x": 0.9, "y": 0.4, "r": 0.5})["value"])
    assert abs(found - expected) <= 2 * EPS * abs(expected)


def test_where_there_is_no_value_there_is_none() -> None:
    graph = Graph({"root": m.sqrt(x), "log": m.log(x), "by zero": 1.0 / (x + 1.0)})
    root, log, by_zero = python_function(graph, ("x",))([-1.0])
    assert np.isnan(root) and np.isnan(log) and np.isinf(by_zero)
