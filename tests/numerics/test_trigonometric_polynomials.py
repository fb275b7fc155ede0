"""Trigonometric polynomials found in expressions, against the expressions themselves and against 50 digits."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest

from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.rounding_bounds import SAFETY
from centrode.numerics.scans import evaluate
from centrode.numerics.trigonometric_polynomials import TrigonometricPolynomial, factors_of, polynomials_of

m = EXPRESSIONS
Q, A, B, C = (variable(name) for name in ("q", "a", "b", "c"))
FORMULAS: dict[str, Any] = {
    "a wave": A * m.cos(Q) + B * m.sin(Q) + C,
    "a shifted wave": A * m.cos(2.0 * Q + B) - m.sin(C - Q),
    "a distance": (A - B * m.cos(Q)) * (A - B * m.cos(Q)) + (C - B * m.sin(Q)) * (C - B * m.sin(Q)),
    "a product": (A + B * m.sin(Q)) * (C - m.cos(3.0 * Q)) / (2.0 + A * A),
    "frequencies that differ": m.cos(Q) * m.sin(2.5 * Q) * A + m.sqrt(B) * m.cos(Q - C) * m.cos(Q),
    "waves that cancel": m.sqrt(m.sin(Q) * m.sin(Q) + m.cos(Q) * m.cos(Q) + A) * m.sin(B) + abs(C) * m.cos(Q),
}
OTHERS: dict[str, Any] = {
    "a root": m.sqrt(2.0 + m.cos(Q)),
    "a quotient": A / (2.0 + m.cos(Q)),
    "a ratio that varies": m.cos(A * Q),
    "the variable itself": A + Q,
    "a wave of a wave": m.cos(m.sin(Q)),
}


def found_in(formula: Any) -> TrigonometricPolynomial:
    node = as_node(formula)
    return polynomials_of([node], "q")[node]


def values_of(seed: int, count: int = 200) -> dict[str, Any]:
    draw = np.random.default_rng(seed)
    return {name: draw.uniform(0.2, 3.0, count) for name in "abc"}


def bounds(polynomial: TrigonometricPolynomial, low: float, high: float, values: Any) -> Any:
    ends = polynomial.extremes(low, high)
    return evaluate(Graph.of(vars(ends)), values)


@pytest.mark.parametrize("name", FORMULAS)
def test_the_polynomial_is_the_expression(name: str) -> None:
    """At any angle, within the bound that the polynomial has of its own rounding."""
    formula, polynomial, values = as_node(FORMULAS[name]), found_in(FORMULAS[name]), values_of(1)
    waves = {f"{k} {f}": x for f, pair in polynomial.waves.items() for k, x in enumerate(pair)}
    numbers = evaluate(Graph.of({"c": polynomial.constant, "error": polynomial.error, **waves}), values)
    for q in np.linspace(-7.0, 7.0, 29):
        own = numbers["c"] + sum(
            numbers[f"0 {f}"] * np.cos(f * q) + numbers[f"1 {f}"] * np.sin(f * q) for f in polynomial.waves
        )
        off = np.abs(own - evaluate(Graph.of({"": formula}), values | {"q": np.full(200, q)})[""])
        assert (off <= 2.0**-53 * SAFETY * numbers["error"]).all()


@pytest.mark.parametrize("name", OTHERS)
def test_what_is_no_polynomial_is_left_out(name: str) -> None:
    node = as_node(OTHERS[name])
    assert node not in polynomials_of([node], "q")


def test_a_distance_has_one_wave() -> None:
    """The second wave of both coordinates' squares cancels in letters, not only in numbers."""
    assert list(found_in(FORMULAS["a distance"]).waves) == [1.0]


@pytest.mark.parametrize(
    ("low", "high"), [(0.0, 2.0 * np.pi), (-3.0, 9.0), (0.3, 0.9), (-2.0, 2.5), (4.0, 4.0)]
)
@pytest.mark.parametrize("name", FORMULAS)
def test_extremes_bound_the_expression(name: str, low: float, high: float) -> None:
    """Everywhere in the range; those of a single wave are attained, to the square of a step of the grid."""
    formula, polynomial, values = as_node(FORMULAS[name]), found_in(FORMULAS[name]), values_of(2)
    ends = bounds(polynomial, low, high, values)
    grid = np.linspace(low, high, 2001)
    heights = np.array([evaluate(Graph.of({"": formula}), values | {"q": np.full(200, q)})[""] for q in grid])
    least, greatest = heights.min(axis=0), heights.max(axis=0)
    assert (ends["least"] - ends["error"] <= least).all()
    assert (ends["greatest"] + ends["error"] >= greatest).all()
    step = (high - low) / 2000.0
    sagitta = 0.5 * step**2 * 9.0 * np.maximum(np.abs(least), np.abs(greatest)) + 20.0 * step**2
    assert (least <= ends["reached"] + ends["error"] + sagitta).all()
    if len(polynomial.waves) == 1:
        assert (least <= ends["least"] + ends["error"] + sagitta).all()
        assert (greatest >= ends["greatest"] - ends["error"] - sagitta).all()


def test_rounding_bounds_hold_at_fifty_digits() -> None:
    """Near a border: the least factor of a crank-rocker's radicand, against mpmath from the same doubles."""
    d, a, s = (variable(name) for name in "das")
    far = (d - a * m.cos(Q)) * (d - a * m.cos(Q)) + (a * m.sin(Q)) * (a * m.sin(Q))
    polynomial = found_in(s * s - far)
    draw = np.random.default_rng(3)
    values = {"d": 10.0 ** draw.uniform(-3.0, 3.0, 500), "a": 10.0 ** draw.uniform(-3.0, 3.0, 500)}
    values["s"] = (values["d"] + values["a"]) * (1.0 + 10.0 ** -draw.uniform(10.0, 16.0, 500))
    ends = bounds(polynomial, 0.0, 7.0, values)
    with mpmath.workdps(50):
        for k in range(500):
            d_k, a_k, s_k = (mpmath.mpf(float(values[name][k])) for name in "das")
            off = abs(float(s_k**2 - (d_k + a_k) ** 2 - mpmath.mpf(float(ends["least"][k]))))
            assert off <= ends["error"][k]
    # and they are no more than some hundred units of the last place of the greatest term
    assert (ends["error"] < 5000.0 * 2.0**-53 * values["s"] ** 2).all()


def test_products_are_taken_apart() -> None:
    factors = (A - m.cos(Q)) * ((B + m.sin(Q)) * 4.0) * (C * C)
    node = as_node(factors)
    parts = factors_of(node, polynomials_of([node], "q"))
    assert len(parts) == 4
    product = evaluate(
        Graph.of({str(k): x for k, x in enumerate(parts)}), values_of(4) | {"q": np.full(200, 0.4)}
    )
    whole = evaluate(Graph.of({"": node}), values_of(4) | {"q": np.full(200, 0.4)})[""]
    np.testing.assert_allclose(np.prod([*np.broadcast_arrays(*product.values())], axis=0), whole, rtol=1e-14)
    assert all(isinstance(x, Node) for x in parts)
