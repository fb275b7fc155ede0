"""Residuals of written samples: what is zero by construction is left out where nothing else depends on it."""

from __future__ import annotations

from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.sweeps.traced_sweep import ResidualParts

m = EXPRESSIONS
X, Y, SCALE = variable("x"), variable("y"), variable("scale")


def size_of(x: object) -> Node:
    return as_node(m.abs(x))


def greatest_of(*parts: Node) -> Node:
    greatest = as_node(0.0)
    for part in parts:
        greatest = as_node(m.max(greatest, part))
    return greatest


def test_a_number_less_itself_is_left_out_where_another_part_has_it() -> None:
    own, also = size_of(X - X), size_of(X - (0.0 + X))
    lengths = greatest_of(own, also, size_of(Y - 2.0 * X))
    found = ResidualParts.of(as_node(m.max(size_of(Y - 1.0), lengths / SCALE)), SCALE)
    assert found.lengths is greatest_of(size_of(Y - 2.0 * X))
    assert found.without_unit is greatest_of(size_of(Y - 1.0))
    assert found.scale is SCALE


def test_it_stays_where_it_alone_says_that_a_number_is_not_finite() -> None:
    # a root of x is finite or NaN otherwise than x itself
    own, rooted = size_of(X - X), size_of(Y - m.sqrt(X))
    found = ResidualParts.of(greatest_of(own, rooted) / SCALE, SCALE)
    assert found.lengths is greatest_of(own, rooted)
    # what divides is no length of the mechanism: nothing is taken apart
    whole = greatest_of(own, rooted) / Y
    assert ResidualParts.of(whole, SCALE) == ResidualParts(whole)
