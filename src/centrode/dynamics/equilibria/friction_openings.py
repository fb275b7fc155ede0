"""Directions of contacts with friction at rest, and equations of the openings of their joints, as a graph."""

from __future__ import annotations

from centrode.dynamics.forward_dynamics.contacts import FREE
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion
from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.graphs import Graph


def graph_of_openings(equations: EquationsOfMotion, states: int, time: str) -> Graph:
    """Coordinates along which contacts act, and force, mass and rows of the openings of pressed joints.

    Parameters
    ----------
    equations : with numbers over expressions
    states : number of the states of controllers, which follow the joint coordinates
    time : name of its variable
    """
    q = [variable(f"coordinate {k}") for k in range(equations.size + states)]
    terms = equations.terms(
        EXPRESSIONS,
        equations.tree.values(EXPRESSIONS, q[: equations.size]),
        [0.0] * equations.size,
        variable(time),
        [FREE] * len(equations.contacts),
        q[equations.size :],
    )
    outputs: dict[str, Node] = {}
    for row, number in equations.contact_rows:
        outputs |= {f"along {number} {i}": as_node(x) for i, x in terms.rows[row].items()}
    for k, ways in terms.openings.items():
        for j, way in enumerate(ways):
            outputs[f"force {k} {j}"] = as_node(way.force)
            outputs |= {f"mass {k} {j} {i}": as_node(x) for i, x in way.mass.items()}
            outputs |= {
                f"rows {k} {j} {i}": as_node(x) for i, x in way.rows.items() if i < equations.equations
            }
            outputs |= {f"own {k} {j} {i}": as_node(x) for i, x in way.along.items()}
    return Graph(outputs)
