"""The text of functions of Python: nothing that came with a graph as a word gets there."""

from __future__ import annotations

import ast
import math

import pytest

from centrode.errors import InputError
from centrode.numerics.expressions import EXPRESSIONS, Node, constant, variable
from centrode.numerics.graphs import Graph, graph_of_rows
from centrode.numerics.python_functions import COMPLEX, REAL, function_text, python_function
from centrode.numerics.text_formula import compile_formula

m = EXPRESSIONS
HOSTILE = (
    "__import__('os').abort()",
    "x\n raise SystemExit(1)\n #",
    "given[0]); raise SystemExit(1) #",
    "0 if [].append(1) else ().__class__.__base__.__subclasses__()",
    "def function(given): return given",
)


class LyingNumber(float):
    """A number that does not write its digits."""

    def __repr__(self) -> str:
        return "__import__('os').abort()"

    __str__ = __repr__


def graph_of_all_operations(one: str, other: str) -> Graph:
    """All that a formula may consist of, of two variables, by whose names the outputs begin too."""
    x, y = variable(one), variable(other)
    both = m.both(m.less(x, y), m.opposite(m.either(m.less_equal(x, y), m.equal(x, y))))
    return Graph(
        {
            f"{one} numbers": (x + y) * (x - y) / y - (-x) + m.sqrt(x) + m.abs(y) + m.exp(x) + m.log(y),
            f"{one} angles": m.sin(x) + m.cos(y) + m.atan2(x, y) + x**y,
            f"{one} sides": m.min(x, y) + m.max(x, y) + m.least(x, y) + m.greatest(x, y),
            f"{one} choices": m.where(both, x, y),
        }
    )


@pytest.mark.parametrize("is_complex", [False, True])
@pytest.mark.parametrize("name", HOSTILE)
def test_names_of_variables_are_not_in_the_text(name: str, is_complex: bool) -> None:
    """The text is that of the same graph with plain names, and has no name that was not made there."""
    texts = [
        function_text(graph_of_all_operations(x, y), (x, y), is_complex)
        for x, y in (("x", "y"), (name, name + " "))
    ]
    assert texts[0] == texts[1]
    made = {"given", *(COMPLEX if is_complex else REAL)}
    used = {node.id for node in ast.walk(ast.parse(texts[1])) if isinstance(node, ast.Name)}
    assert all(one in made or (one[0] == "v" and one[1:].isdigit()) for one in used)
    assert not any(isinstance(node, ast.Attribute | ast.Import) for node in ast.walk(ast.parse(texts[1])))


def test_constants_are_written_as_their_digits() -> None:
    """A number that writes something else, and those that have no digits."""
    numbers = [LyingNumber(0.1), -0.0, 5e-324, 1.7976931348623157e308, math.inf, -math.inf]
    graph = Graph({str(k): constant(x) for k, x in enumerate(numbers)} | {"none": constant(math.nan)})
    assert "import" not in function_text(graph, (), False)
    *found, none = python_function(graph, ())([])
    assert [float.hex(x) for x in found] == [float.hex(float(x)) for x in numbers]
    assert math.isnan(none)


def test_an_operation_that_is_none_is_refused() -> None:
    node = Node()
    node.operation, node.arguments, node.detail, node.key = HOSTILE[0], (variable("x"),), "", b"key"
    with pytest.raises(KeyError):
        python_function(Graph({"value": node}), ("x",))
    with pytest.raises(ValueError, match="no graph"):
        graph_of_rows([["variable", "x"], [HOSTILE[0], 0], ["output", "value", 1]])


@pytest.mark.parametrize("text", HOSTILE)
def test_a_formula_that_is_python_is_refused(text: str) -> None:
    with pytest.raises(InputError):
        compile_formula(text, ("x",), "where")


def test_built_in_functions_have_no_name() -> None:
    function = python_function(Graph({"value": m.sin(variable("x"))}), ("x",))
    assert function([0.5]) == (math.sin(0.5),)
    assert function.__globals__["__builtins__"] == {}  # type: ignore[attr-defined]
