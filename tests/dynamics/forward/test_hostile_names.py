"""Names of a description and the functions that are made of its equations of motion."""

from __future__ import annotations

import math

import pytest

from centrode.dynamics.forward_dynamics.free_motion import free_motion_of
from centrode.errors import InputError
from centrode.numerics.initial_value_problems import STEP, TIME
from centrode.numerics.python_functions import function_text
from dynamics.forward.free_descriptions import GRAVITY, Parts, mechanism, rod

PLAIN = ("A", "B", "C", "D", "AB", "BC", "DC")
HOSTILE = (
    "given[0]); raise SystemExit(1) #",
    "__import__('os').abort()",
    "exit()",
    "v0 = exit()",
    "def function(given): exit()",
    "0 if exit() else 1",
    "''' + exit() + '''",
)


def four_bar_of(names: tuple[str, ...], force: str = "2*x - 0.3*v") -> Parts:
    """A four-bar linkage by the names of its points and links, with a force by a formula."""
    a, b, c, d, crank, coupler, rocker = names
    return {
        "gravity": GRAVITY,
        "frame": {"points": {a: [0.0, 0.0], d: [0.9, 0.0]}},
        "links": {crank: rod(a, b, 0.3), coupler: rod(b, c, 0.8), rocker: rod(d, c, 0.6)},
        "drives": [{"link": crank, "start": math.pi / 3, "speed": 1.0}],
        "assembly": {"sides": {c: "left"}},
        "loads": [{"kind": "force", "point": c, "vector": [force, "-0.4*v + sin(t)"]}],
    }


def texts_of(names: tuple[str, ...]) -> list[str]:
    problem = free_motion_of(mechanism(four_bar_of(names))).integration.problem
    own = (*problem.parameters, *problem.carried_names)
    graphs = (problem.of_rates, (TIME,)), (problem.of_closing, (TIME, STEP))
    return [
        function_text(graph, (*first, *own), is_complex)
        for graph, first in graphs
        for is_complex in (False, True)
    ]


def test_names_of_links_and_points_are_not_in_the_functions() -> None:
    """What names hold changes no character of the text that is compiled."""
    assert texts_of(HOSTILE) == texts_of(PLAIN)


@pytest.mark.parametrize("text", HOSTILE)
def test_a_load_by_a_formula_that_is_python_is_refused(text: str) -> None:
    with pytest.raises(InputError):
        free_motion_of(mechanism(four_bar_of(PLAIN, text)))
