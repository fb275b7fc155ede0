"""Graphs printed as JavaScript: every operation, run by Node, against the same graph on arrays."""

from __future__ import annotations

import json
import subprocess

import numpy as np
import pytest
from tools.node import MISSING, NODE

from centrode.numerics.expressions import EXPRESSIONS, Node, apply_operation, constant, variable
from centrode.numerics.graphs import Graph, Unwritten
from centrode.numerics.javascript import FUNCTIONS, HELPERS, JAVASCRIPT, PlaceFunction, once
from centrode.numerics.operations import OPERATIONS
from centrode.numerics.scans import evaluate

m = EXPRESSIONS
needs_node = pytest.mark.skipif(NODE is None, reason=MISSING)
A, B, X = variable("a"), variable("b"), variable("x")
SPECIAL = [0.0, -0.0, 1.0, -1.5, 3.0e-310, 1e308, float("inf"), -float("inf"), float("nan")]


def _as_number(node: Node) -> Node:
    return m.where(node, 1.0, 0.0) if node.is_condition else node


def _each_operation() -> dict[str, Node]:
    """Every operation of the table once, conditions as 1 and 0."""
    found = {}
    for name, operation in OPERATIONS.items():
        if operation.of_conditions:
            arguments = [m.less(A, X), m.less(X, B)][: operation.arguments]
        elif name == "where":
            arguments = [m.less(A, X), A, B]
        else:
            arguments = [A, X][: operation.arguments]
        found[name] = _as_number(apply_operation(name, *arguments))
    return found


def _run(
    function: PlaceFunction, numbers: list[float], places: list[float], last: int | None = None
) -> np.ndarray:
    """Rows that a function writes up to its last stage, places in its one row."""
    assert NODE is not None
    body = f"""
    {HELPERS}
    const f = {{ {function.source} }}.{function.name};
    const number = (x) => (x === null ? NaN : typeof x === "string" ? Number(x) : x);
    const {{ v, x }} = JSON.parse(require("fs").readFileSync(0, "utf8"));
    const n = x.length, p = new Float64Array((f.fixed.length + f.parts + f.moving.length) * n);
    f.fixed.forEach((_name, k) => p.set(x.map(number), k * n));
    f.before(v.map(number), p, n, p.subarray(f.fixed.length * n));
    f.moving.forEach((_name, k) => p.set(x.map(number), (f.fixed.length + f.parts + k) * n));
    const o = new Float64Array(f.count * n);
    f.run(v.map(number), p, n, o{"" if last is None else f", {last}"});
    process.stdout.write(Buffer.from(o.buffer));
    """

    def plain(x: float) -> float | str | None:
        return None if np.isnan(x) else repr(x).replace("inf", "Infinity") if np.isinf(x) or x == 0.0 else x

    given = json.dumps({"v": [plain(x) for x in numbers], "x": [plain(x) for x in places]})
    ended = subprocess.run([NODE, "-e", body], input=given.encode(), capture_output=True, check=True)
    return np.frombuffer(ended.stdout).reshape(-1, len(places))


@needs_node
@pytest.mark.parametrize("moving", (False, True), ids=("place", "moving"))
def test_every_operation_has_the_value_of_the_arrays(moving: bool) -> None:
    outputs = _each_operation()
    rows = ((), ("x",)) if moving else (("x",), ())
    function = PlaceFunction("f", {"a": 0, "b": 1}, *rows, tuple(outputs.values()))
    for a in SPECIAL:
        for b in (2.5, float("nan")):
            written = _run(function, [a, b], SPECIAL)
            with np.errstate(all="ignore"):
                known = evaluate(Graph(outputs), {"a": np.array(a), "b": np.array(b), "x": np.array(SPECIAL)})
            for row, name in zip(written, outputs, strict=True):
                expected = np.broadcast_to(known[name], row.shape)
                # V8 and NumPy each round functions to a unit of the last place or two; all else is rounded alike
                close = 4e-16 if name in ("sin", "cos", "atan2", "exp", "log", "power") else 0.0
                np.testing.assert_allclose(row, expected, rtol=close, atol=0.0, err_msg=f"{name} {a} {b}")


@needs_node
def test_signs_and_brackets_keep_their_meaning() -> None:
    double = constant(-2.0)
    outputs = [
        A - (-X * B), -(A - B) - -X, A - (B - X), A / (B / X), (A / B) / X, double * X - double, -(double * X),
        m.where(m.opposite(m.both(m.less(A, X), m.less(X, B))), -A, B), m.sqrt(A * A + X * X) * (A + B + X),
    ]  # fmt: skip
    function = PlaceFunction("f", {"a": 0, "b": 1}, (), ("x",), tuple(outputs))
    places = [0.3, -1.7, 2.25]
    written = _run(function, [1.5, 2.0], places)
    graph = Graph({str(k): node for k, node in enumerate(outputs)})
    known = evaluate(graph, {"a": np.array(1.5), "b": np.array(2.0), "x": np.array(places)})
    for k, row in enumerate(written):
        assert row.tolist() == np.broadcast_to(known[str(k)], row.shape).tolist()


def test_what_stands_still_is_computed_before_the_loop() -> None:
    source = PlaceFunction("f", {"a": 0}, ("x",), (), (m.sqrt(A) * m.sin(X), m.sqrt(A))).source
    run = source[source.index("run:") :]
    assert run.index("Math.sqrt") < run.index("for (let i")
    assert "o.fill(" in run
    # the sine is one of the place alone: it has a row of its own, filled once
    assert "Math.sin" not in run


def test_names_of_users_cannot_end_a_script() -> None:
    source = PlaceFunction("f", {}, (), ('turns </script>"\n',), (variable('turns </script>"\n'),)).source
    assert "</script>" not in source


def test_an_operation_without_words_is_refused_by_its_name() -> None:
    functions = {name: word for name, word in FUNCTIONS.items() if name != "atan2"}
    notation = type(JAVASCRIPT)(functions, JAVASCRIPT.number, JAVASCRIPT.signs, JAVASCRIPT.selection)
    with pytest.raises(Unwritten, match="atan2"):
        notation.text(m.atan2(A, X), [("a", 9), ("x", 9)])


def test_every_operation_has_words() -> None:
    for node in _each_operation().values():
        assert "o[0]" in once([node], {"a": 0, "b": 1, "x": 2})


@needs_node
def test_a_call_may_end_behind_a_stage() -> None:
    """What a stage shares with those before it is computed once; rows behind the last stage are not written."""
    shared = m.sqrt(X * X + A)
    outputs = (shared + B, m.sin(shared), shared * shared - X)
    staged = PlaceFunction("f", {"a": 0, "b": 1}, (), ("x",), outputs, (1, 2, 3))
    whole = PlaceFunction("f", {"a": 0, "b": 1}, (), ("x",), outputs)
    numbers, places = [2.0, -0.5], [0.3, 1.0, -4.0]
    wanted = _run(whole, numbers, places)
    for last in range(3):
        found = _run(staged, numbers, places, last)
        np.testing.assert_array_equal(found[: last + 1], wanted[: last + 1])
        assert not found[last + 1 :].any()
    np.testing.assert_array_equal(_run(staged, numbers, places), wanted)
    assert staged.source.count("Math.sqrt") == 1
