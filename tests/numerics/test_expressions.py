"""Expression nodes: one node for one expression, rewriting that keeps every bit, tracing of jets and plans."""

from __future__ import annotations

import gc
import math
import struct
import subprocess
import sys
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from centrode.numerics.arrays import ARRAYS
from centrode.numerics.expressions import EXPRESSIONS, Node, apply_operation, as_node, constant, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.scans import evaluate

m = EXPRESSIONS
x, y, z = variable("x"), variable("y"), variable("z")
SPECIAL = (0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 3.0, -0.1, math.inf, -math.inf, math.nan, 5e-324, 1e308, -1e-308)
LANES = np.array(np.meshgrid(SPECIAL, SPECIAL, SPECIAL)).reshape(3, -1)

Formula = Callable[[Any, Any, Any, Any], Any]


def same_bits(a: Any, b: Any) -> bool:
    """Equal to the last bit, signs of zeros included; one NaN is as good as another."""
    a, b = np.broadcast_arrays(np.asarray(a, float), np.asarray(b, float))
    return bool(np.all((a.view(np.int64) == b.view(np.int64)) | (np.isnan(a) & np.isnan(b))))


def on_lanes(node: Any, lanes: np.ndarray = LANES) -> Any:
    names = dict(zip("xyz", lanes, strict=True))
    return np.broadcast_to(evaluate(Graph.of({"value": node}), names)["value"], lanes.shape[1])


def test_equal_expressions_are_one_node() -> None:
    assert variable("x") is x
    assert (x + y) * 2.0 is (x + y) * 2
    assert x + y is y + x
    assert x * y is y * x
    assert x - y is not y - x
    assert constant(0.0) is not constant(-0.0)
    assert constant(1.0) is not variable("1.0")
    assert m.min(x, y) is not m.min(y, x)  # zeros of both signs come out as the second


def test_nodes_that_nobody_holds_are_forgotten() -> None:
    key = (variable("held by nobody") + 1.0).key
    gc.collect()
    assert (variable("held by nobody") + 1.0).key == key


def test_keys_are_the_same_in_another_process() -> None:
    text = "from centrode.numerics.expressions import variable as v\nprint((v('y') * v('x') + 0.1).key.hex())"
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == (x * y + 0.1).key.hex()


def test_threads_get_the_same_nodes() -> None:
    found: list[Node] = []
    at_once = threading.Barrier(8)

    def make() -> None:
        at_once.wait()
        node = variable("shared")
        for k in range(200):
            node = node * 1.5 + float(k)
        found.append(node)

    threads = [threading.Thread(target=make) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(set(found)) == 1


@pytest.mark.parametrize(
    ("made", "expected"),
    [
        (x + constant(-0.0), x),
        (x - 0.0, x),
        (x * 1.0, x),
        (1 * x, x),
        (x * -1.0, -x),
        (x / 1.0, x),
        (x / 4.0, x * 0.25),
        (x / -0.5, x * -2.0),
        (m.abs(x) * -1.0 * -1.0, m.abs(x)),
        (apply_operation("negate", -x), x),
        (x + -y, x - y),
        (-x + y, y - x),
        (x - -y, x + y),
        (-x - x, -2.0 * x),
        (-x + -x, -2.0 * x),
        (-x * -y, x * y),
        (-x / y, -(x / y)),
        (x / -y, -(x / y)),
        (-0.0 - x, -x),
        (abs(-x), abs(x)),
        (m.sin(-x), -m.sin(x)),
        (m.cos(-x), m.cos(x)),
        (m.min(x, x), x),
        (m.where(x < y, z, z), z),
        (m.where(m.opposite(x < y), x, y), m.where(x < y, y, x)),
        (constant(2.0) * 3.0, constant(6.0)),
        (constant(1.0) / 0.0, constant(math.inf)),
        (m.sqrt(constant(2.0)), constant(math.sqrt(2.0))),
    ],
)
def test_simpler_expressions(made: Node, expected: Node) -> None:
    assert made is expected


@pytest.mark.parametrize(
    "node",
    [
        x + 0.0,
        x * 0.0,
        x - x,
        x / x,
        x / 3.0,
        2.0 * (2.0 * x),
        (x + y) + z,
        m.sqrt(x * x),
        0.0 - x,
        x / 5e-324,
    ],
)
def test_what_would_change_bits_stays(node: Node) -> None:
    assert node.arguments
    assert node.operation not in ("variable", "constant", "negate")


def test_roots_and_quotients_of_constants_are_no_errors() -> None:
    assert math.isnan(float(m.sqrt(constant(-1.0)).detail))
    assert math.isnan(m.sqrt(-1.0))
    assert math.isnan(float((constant(0.0) / 0.0).detail))
    assert float((constant(-1.0) / constant(0.0)).detail) == -math.inf


numbers = st.sampled_from(SPECIAL) | st.floats(-4, 4)
leaves = st.sampled_from(["x", "y", "z"]) | numbers
UNARY = ("neg", "abs", "sqrt")
BINARY = ("+", "-", "*", "/")


def compound(inner: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    return (
        st.tuples(st.sampled_from(UNARY), inner)
        | st.tuples(st.sampled_from(BINARY), inner, inner)
        | st.tuples(st.just("where"), inner, inner, inner, inner)
    )


trees = st.recursive(leaves, compound, max_leaves=25)


def computed(tree: Any, functions: Any, values: dict[str, Any]) -> Any:
    """The tree over any algebra, operation by operation."""
    if isinstance(tree, str):
        return values[tree]
    if isinstance(tree, float):
        return values[""](tree)
    inside = [computed(one, functions, values) for one in tree[1:]]
    match tree[0]:
        case "neg":
            return -inside[0]
        case "abs" | "sqrt" as name:
            return getattr(functions, name)(inside[0])
        case "where":
            return functions.where(functions.less(inside[0], inside[1]), inside[2], inside[3])
        case sign:
            a, b = inside
            return {"+": lambda: a + b, "-": lambda: a - b, "*": lambda: a * b, "/": lambda: a / b}[sign]()


@given(trees)
def test_rewriting_changes_no_bit(tree: Any) -> None:
    plain = {"": np.float64, **dict(zip("xyz", LANES, strict=True))}
    with np.errstate(all="ignore"):
        expected = computed(tree, ARRAYS, plain)
    node = computed(tree, EXPRESSIONS, {"": constant, "x": x, "y": y, "z": z})
    assert same_bits(on_lanes(node), expected)


def test_sine_and_cosine_of_numpy_are_odd_and_even() -> None:
    """The rules for sin(-x) and cos(-x) change no bit on NumPy either."""
    at = np.concatenate([np.random.default_rng(0).uniform(-100, 100, 10_000), SPECIAL])
    with np.errstate(invalid="ignore"):
        assert same_bits(np.sin(-at), -np.sin(at))
        assert same_bits(np.cos(-at), np.cos(at))


def test_a_formula_cannot_branch_on_a_value() -> None:
    with pytest.raises(TypeError, match="where"):
        bool(x < y)


@pytest.mark.parametrize(
    "make",
    [
        lambda: apply_operation("add", x, x < y),
        lambda: m.where(as_node(x), x, y),
        lambda: m.both(x < y, x),
        lambda: apply_operation("sqrt", x, y),
    ],
)
def test_conditions_and_numbers_do_not_mix(make: Callable[[], Any]) -> None:
    with pytest.raises(TypeError):
        make()


def test_plain_numbers_stay_plain() -> None:
    for value in (
        m.sqrt(2.0),
        m.sin(1.0),
        m.cos(1.0),
        m.atan2(1.0, 2.0),
        m.exp(1.0),
        m.log(2.0),
        m.abs(-1.0),
    ):
        assert type(value) is float


def test_numpy_scalars_count_as_numbers() -> None:
    assert np.float64(2.0) * x is x * 2.0
    assert np.float64(2.0) - x is 2.0 - x


FORMULAS: dict[str, Formula] = {
    "arithmetic": lambda m, x, y, z: (x + y) * z - x / (y * y + 1.0),
    "functions": lambda m, x, y, z: m.sin(x) * m.cos(y) + m.atan2(y, x) - m.sqrt(z * z + 1.0) * m.exp(-x * x),
    "derived": lambda m, x, y, z: m.tan(x) + m.atan(y) + m.asin(0.1 * z) + m.acos(0.1 * z) + m.log(1.0 + x * x),
    "sides": lambda m, x, y, z: m.abs(x) + m.sign(y) + m.min(x, z) * m.max(y, z) + m.least(x, y) - m.greatest(y, z),
    "selection": lambda m, x, y, z: m.where(m.both(m.less(x, y), m.is_number(z)), x * y, z / x),
}  # fmt: skip


@pytest.mark.parametrize("name", FORMULAS)
def test_a_traced_formula_computes_what_the_formula_does(name: str) -> None:
    lanes = np.random.default_rng(1).uniform(-2, 2, (3, 500))
    expected = FORMULAS[name](ARRAYS, *lanes)
    # derived functions are spelled in others: a few roundings of numbers below 10
    bound = 16 * 2.0**-53 * 10 if name == "derived" else 0.0
    assert np.abs(on_lanes(FORMULAS[name](m, x, y, z), lanes) - expected).max() <= bound


@pytest.mark.parametrize("name", ["arithmetic", "functions", "selection"])
def test_jets_are_traced(name: str) -> None:
    at = np.random.default_rng(2).uniform(0.1, 2, (3, 50))
    arrays, nodes = JetFunctions(ARRAYS), JetFunctions(m)
    expected = FORMULAS[name](arrays, Jet.variable(at[0], 3), at[1], at[2])
    traced = FORMULAS[name](nodes, Jet.variable(x, 3), y, z)
    for k in range(4):
        value = evaluate(Graph.of({"d": traced.derivative(k)}), dict(zip("xyz", at, strict=True)))["d"]
        assert same_bits(value, np.broadcast_to(expected.derivative(k), 50)), k


def test_constants_keep_their_bits() -> None:
    for value in SPECIAL:
        assert struct.pack("<d", float(constant(value).detail)) == struct.pack("<d", value)
