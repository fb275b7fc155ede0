"""Sums in which squares of a cosine and its sine stand together."""

from __future__ import annotations

import math

import numpy as np
import pytest

from centrode.numerics.expressions import Node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.scans import evaluate
from centrode.numerics.unit_rotors import without_unit_squares

A, B, C, S, X = (variable(name) for name in ("a", "b", "c", "s", "x"))
ROTORS = [(C, S)]


@pytest.mark.parametrize(
    ("sum_", "left"),
    [
        ((C * A) * (C * A) + (S * A) * (S * A), {"a"}),
        (B * (C * C) + X + B * (S * S), {"b", "x"}),
        ((C * A) * (S * B) - (S * A) * (C * B) + X, {"x"}),
        (X - A * (C * C) - (S * S) * A, {"a", "x"}),
        ((C * C) * A - (S * S) * A, {"a", "c", "s"}),
        ((C * C) * A + (S * S) * B, {"a", "b", "c", "s"}),
        (C * A + S * A, {"a", "c", "s"}),
        # rounds to a whole number
        ((X + 1.5 * 2.0**52) - 1.5 * 2.0**52, {"x"}),
    ],
)
def test_what_depends_on_no_rotor_has_none(sum_: Node, left: set[str]) -> None:
    shorter = Graph(without_unit_squares({"sum": sum_}, ROTORS, ["a", "b"]))
    assert set(shorter.variables) == left
    values = {"a": 1.3, "b": -0.7, "c": math.cos(0.4), "s": math.sin(0.4), "x": 2.1}
    arrays = {name: np.array([value]) for name, value in values.items()}
    before, after = (float(evaluate(graph, arrays)["sum"][0]) for graph in (Graph({"sum": sum_}), shorter))
    assert abs(before - after) <= 8 * np.finfo(float).eps * 4.0
