"""Derivatives as sums of standing and moving factors: against forward mode, and what they are made of."""

from __future__ import annotations

import numpy as np
import pytest

from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.graphs import Graph, directional_derivatives
from centrode.numerics.linear_forms import ONE, StandingFactors
from centrode.numerics.scans import evaluate

m = EXPRESSIONS
A, B, C, Q = (variable(name) for name in "abcq")
MOVING = StandingFactors(frozenset("q"))
OUTPUTS: list[Node] = [
    as_node(A * (B * m.cos(Q) + C * m.sin(Q))),
    as_node(m.sqrt(A * A + m.cos(Q) * (B - A)) / C),
    as_node(m.where(m.less(A, B * m.sin(Q)), A * B, m.sqrt(A + B + m.sin(Q)))),
    as_node(m.max(A * m.cos(Q), B) * C - (-A)),
    as_node(m.atan2(A + m.sin(Q), B * m.cos(Q)) + m.exp(C)),
    as_node(A * B),
    as_node(m.cos(Q)),
]


@pytest.mark.parametrize("seed", range(5))
def test_a_form_is_the_derivative(seed: int) -> None:
    draw = np.random.default_rng(seed)
    values = dict(zip("abcq", draw.uniform(0.2, 2.0, 4), strict=True))
    directions = [{A: 1.0}, {B: 1.0, C: as_node(A * 0.5)}]
    expected = directional_derivatives(OUTPUTS, directions)
    forms = MOVING.derivatives(OUTPUTS, directions, lambda graph: graph)
    for row, others in zip(forms, expected, strict=True):
        for form, other in zip(row, others, strict=True):
            numbers = {
                "whole": MOVING.number_of(form),
                "common": MOVING.number_of(MOVING.with_common_factors(form)),
            }
            there = evaluate(Graph.of({**numbers, "expected": other}), values)
            # both are sums of the same products in another order
            assert there["whole"] == pytest.approx(there["expected"], rel=1e-13, abs=1e-13)
            assert there["common"] == pytest.approx(there["expected"], rel=1e-13, abs=1e-13)


def test_factors_that_stand_are_taken_out() -> None:
    cosine, sine = as_node(m.cos(Q)), as_node(m.sin(Q))
    ((of_first, *_others, of_product, of_wave),) = MOVING.derivatives(
        OUTPUTS, [{B: 1.0}], lambda graph: graph
    )
    assert of_first == {cosine: A}
    # what stands as a whole is a factor of one, and what does not depend on the direction has no derivative
    assert of_product == {ONE: A}
    assert of_wave == {}
    assert MOVING.split(as_node(-(A * cosine) * (B * sine)))[0] is as_node(cosine * sine)


def test_a_sum_beside_its_own_terms_needs_no_product() -> None:
    cosine, sine = as_node(m.cos(Q)), as_node(m.sin(Q))
    wave = as_node(A * cosine + B * sine)
    number = MOVING.number_of({wave: C, cosine: 2.0, sine: 3.0})
    assert Graph.of({"": number}).counts["multiply"] == 4  # two of the factors, two of what moves
    found = evaluate(Graph.of({"": number}), {"a": 2.0, "b": 3.0, "c": 0.5, "q": 0.7})[""]
    assert found == pytest.approx(3.0 * np.cos(0.7) + 4.5 * np.sin(0.7), rel=1e-15)
