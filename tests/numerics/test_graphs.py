"""Graphs: order, counts, keys, substitution, splitting, and their text."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest

from centrode.numerics.expressions import EXPRESSIONS as FUNCTIONS
from centrode.numerics.expressions import constant, variable
from centrode.numerics.graphs import (
    LONGEST,
    Graph,
    graph_listing,
    operation_counts,
    split_graph,
    topological_order,
)
from centrode.numerics.scans import evaluate
from centrode.numerics.text_formula import compile_formula

m = FUNCTIONS
a, b, x = variable("a"), variable("b"), variable("x")


def dyad() -> Graph:
    """A formula with shared parts, of parameters a, b and an input x."""
    left, up = a - b * m.cos(x), b * m.sin(x)
    squared = left * left + up * up
    root = m.sqrt((a * a - squared) * (squared - b * b))
    return Graph.of({"ahead": left / squared - up * root, "left": left * root, "angle": m.atan2(up, left)})


def test_arguments_come_first_and_once() -> None:
    order = topological_order(dyad().outputs.values())
    assert len(set(order)) == len(order)
    seen: set[object] = set()
    for node in order:
        assert all(argument in seen for argument in node.arguments)
        seen.add(node)


def test_depth_does_not_matter() -> None:
    node = x
    for _ in range(20_000):
        node = node * a + b
    graph = Graph({"deep": node})
    assert graph.counts == {"multiply": 20_000, "add": 20_000}
    assert evaluate(graph, {"x": 1.0, "a": 1.0, "b": 1.0})["deep"] == 20_001


def test_shared_parts_are_counted_once() -> None:
    assert dyad().counts == Counter(multiply=9, subtract=4, add=1, sqrt=1, divide=1, sin=1, cos=1, atan2=1)
    assert operation_counts(Graph({"y": x * x + a * x})) == "2 multiply, 1 add"


def test_keys_tell_graphs_apart() -> None:
    graph = dyad()
    assert graph.key == dyad().key
    assert graph.key != Graph(dict(reversed(graph.outputs.items()))).key
    assert graph.key != Graph({"other": graph.outputs["ahead"]}).key


def test_substitution() -> None:
    graph = dyad().substitute({"a": 2.0, "b": x})
    assert graph.variables == ("x",)
    expected = evaluate(dyad(), {"a": 2.0, "b": 0.3, "x": 0.3})
    assert evaluate(graph, {"x": 0.3}) == pytest.approx(expected, rel=0)


def test_splitting_computes_the_same() -> None:
    graph = dyad()
    table, rest = split_graph(graph, ["x"], "part")
    assert set(table.variables) == {"x"}
    assert {node.operation for node in table.outputs.values()} == {"sin", "cos"}
    assert set(rest.variables) == {"a", "b", "part 0", "part 1"}
    at = np.linspace(0, 6, 50)
    inner = evaluate(table, {"x": at})
    whole = evaluate(graph, {"a": 2.0, "b": 0.5, "x": at})
    parts = evaluate(rest, {"a": 2.0, "b": 0.5, **inner})
    for name in graph.outputs:
        assert np.array_equal(whole[name], parts[name], equal_nan=True)


def test_outputs_that_are_alone_go_to_the_table() -> None:
    table, rest = split_graph(Graph({"one": m.sin(x), "two": a, "three": x}), ["x"], "part")
    assert rest.outputs == {"one": variable("part 0"), "two": a, "three": x}
    assert table.outputs == {"part 0": m.sin(x)}


@pytest.mark.parametrize(
    ("node", "text"),
    [
        (a - (b - x), "a - (b - x)"),
        ((a - b) - x, "a - b - x"),
        ((a + b) + x, "a + b + x"),
        (a + (b + x), "a + (b + x)"),
        (a * (b + x) / -x, "-(a * (b + x) / x)"),
        (-(a + b), "-(a + b)"),
        (a * -2.5, "a * -2.5"),
        (a / (b * x), "a / (b * x)"),
        (a / b * x, "a / b * x"),
        (m.atan2(a, b), "atan2(a, b)"),
        (2.0 * a, "2 * a"),
        (m.where(m.both(a < b, x <= 0.0), a, constant(math.inf)), "where(a < b and x <= 0, a, inf)"),
        (m.where(m.opposite(m.either(a < b, x < b)), a, b), "where(a < b or x < b, b, a)"),
        (a ** (b + 1.0), "a ** (b + 1)"),
        (a + constant(0.0), "a + 0"),
    ],
)
def test_expressions_as_text(node: object, text: str) -> None:
    assert graph_listing(Graph.of({"y": node})) == f"y = {text}"  # type: ignore[dict-item]


def test_the_listing_is_a_program() -> None:
    """Read line by line as text formulas, it gives the graph's numbers."""
    graph = dyad()
    values: dict[str, float] = {"a": 2.0, "b": 0.5, "x": 1.2}
    lines = graph_listing(graph).splitlines()
    for line in lines:
        name, _sign, text = line.partition(" = ")
        values[name] = compile_formula(text, tuple(values), "test")(np, **values) if text else math.nan
    for name, value in evaluate(graph, {"a": 2.0, "b": 0.5, "x": 1.2}).items():
        assert values[name] == value


def test_long_lines_are_broken() -> None:
    node = x
    for k in range(60):
        node = node * variable(f"factor{k}") + 1.0
    lines = graph_listing(Graph({"y": node})).splitlines()
    assert len(lines) > 5
    assert max(map(len, lines)) <= LONGEST + len("t99 =  * factor99 + 1")
