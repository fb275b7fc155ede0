"""Forward mode against reverse mode, and against differences where a selection lies in between."""

from __future__ import annotations

import numpy as np
import pytest

from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.graphs import Graph, directional_derivatives, gradient
from centrode.numerics.scans import evaluate

m = EXPRESSIONS
X, Y, Z = (variable(name) for name in "xyz")
OUTPUTS: list[Node] = [
    as_node(m.sqrt(X * X + Y * Y) / Z),
    as_node(m.atan2(Y, X) * m.sin(Z) - X),
    as_node(m.where(m.less(X, Y), X * Y, m.sqrt(X - Y))),
    as_node(m.max(m.abs(X), Y) * m.cos(Z)),
    as_node(m.exp(X) ** 2.0 + m.log(Y)),
    Z,
]


@pytest.mark.parametrize("seed", range(5))
def test_directions_of_variables_are_the_columns_of_reverse_mode(seed: int) -> None:
    draw = np.random.default_rng(seed)
    values = dict(zip("xyz", draw.uniform(0.2, 2.0, 3), strict=True))
    factor = 1.5
    forward = directional_derivatives(OUTPUTS, [{X: 1.0}, {Y: 1.0}, {X: 1.0, Z: factor}])
    for k, output in enumerate(OUTPUTS):
        by = gradient(output, [X, Y, Z])
        asked = {"x": by[0], "y": by[1], "both": by[0] + factor * by[2]}
        there = evaluate(Graph.of(asked), values)
        found = evaluate(Graph.of(dict(zip(asked, (row[k] for row in forward), strict=True))), values)
        for name in asked:
            # both are sums of the same products in another order
            assert found[name] == pytest.approx(there[name], rel=1e-13, abs=1e-13)
