"""What contacts feel at one state of a motion: forces, and what forces and impulses along their rows change."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.contacts import COMPLIANT, ContactMode
from centrode.dynamics.forward_dynamics.elimination import Vector
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion, MassSystem, Terms
from centrode.dynamics.forward_dynamics.motion_problem import MotionNames, modes_of
from centrode.dynamics.forward_dynamics.pressed_modes import FrictionLimits, JointPresses
from centrode.numerics.expressions import EXPRESSIONS, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.initial_value_problems import TIME, InitialValueProblem
from centrode.numerics.python_functions import Function, python_function

Array: TypeAlias = npt.NDArray[np.float64]


class ContactForces(NamedTuple):
    """What contacts feel at one state.

    Attributes
    ----------
    values, speeds : of their coordinates (contacts)
    forwards, backwards : forces that they would have if they slipped
    free : accelerations of the rows (rows) without forces in them
    loose : what their own forces would add if no closure held (rows)
    mobility : (rows, rows), accelerations of the rows by forces along them
    shifts : (coordinates, rows), changes of the speeds by impulses along the rows
    reactions : (kept drives, rows), impulses of kept drives by impulses along the rows
    rates : of the kept drives
    conditions : values of the user's events
    presses : reactions of joints with friction by coefficients
    is_late : whether speeds alone are those behind an impact, and forces and accelerations still those before it
    limits : bounds of friction by coefficients, where its forces are known
    """

    values: Array
    speeds: Array
    forwards: Array
    backwards: Array
    free: Array
    loose: Array
    mobility: Array
    shifts: Array
    reactions: Array
    rates: Array
    conditions: Array
    presses: JointPresses
    is_late: bool = False
    limits: Mapping[int, FrictionLimits] = MappingProxyType({})

    def with_limits(self, limits: Mapping[int, FrictionLimits]) -> ContactForces:
        """The same with bounds of friction by coefficients."""
        forwards, backwards = self.forwards.copy(), self.backwards.copy()
        for k, one in limits.items():
            forwards[k], backwards[k] = one.forwards, one.backwards
        return self._replace(forwards=forwards, backwards=backwards, limits=limits)


def contact_function(
    equations: EquationsOfMotion, names: MotionNames, problem: InitialValueProblem
) -> Function:
    """What contacts feel, as a function of time, parameters and what is carried."""
    m, tree = EXPRESSIONS, equations.tree
    modes = [
        # friction that slips is a force of its own here, what is closed has none
        ContactMode(mode.active if contact.kind == COMPLIANT else 0.0, 0.0, 0.0)
        for contact, mode in zip(equations.contacts, modes_of(names, variable) or (), strict=True)
    ]
    values = tree.values(m, [variable(name) for name in names.coordinates])
    speeds = [variable(name) for name in names.speeds]
    terms = equations.terms(m, values, speeds, variable(TIME), modes, [variable(x) for x in names.states])
    count = equations.equations
    rows, bias = terms.rows[count:], terms.bias[count:]
    system = equations.system(m, terms.without_contacts(count))
    moved, _forces = system.solve(system.force, terms.bias[:count])
    still = [0.0] * count
    outputs: dict[str, Any] = {}
    for k, one in enumerate(terms.measures):
        outputs |= {f"value {k}": one.value, f"speed {k}": one.speed}
        outputs |= {f"forwards {k}": one.forwards, f"backwards {k}": one.backwards}
    for i, row in enumerate(rows):
        outputs[f"free {i}"] = _product(row, moved) + bias[i]
        alone = system.mass.forward(row)
        outputs[f"loose {i}"] = system.mass.product(alone, alone)
        shift, forces = system.solve(row, still)
        outputs |= {f"mobility {i} {j}": _product(other, shift) for j, other in enumerate(rows)}
        outputs |= {f"shift {i} {k}": shift.get(k, 0.0) for k in range(equations.size)}
        first = count - len(equations.kept)
        outputs |= {f"reaction {i} {k}": forces.get(first + k, 0.0) for k in range(len(equations.kept))}
    outputs |= {f"rate {k}": rate for k, rate in enumerate(terms.rates)}
    outputs |= {f"condition {k}": value for k, value in enumerate(terms.conditions)}
    outputs |= _press_outputs(equations, terms, system, (moved, _forces))
    graph = Graph({name: as_node(x) for name, x in outputs.items()})
    return python_function(graph, [TIME, *problem.parameters, *problem.carried_names])


def _press_outputs(
    equations: EquationsOfMotion, terms: Terms, system: MassSystem, free: tuple[Vector, Vector]
) -> dict[str, Any]:
    """Reactions of joints with friction by coefficients, without forces of contacts and by each of these."""
    count = equations.equations
    still = [0.0] * count
    responses = [
        (number, system.solve(terms.rows[row], still)) for row, number in equations.contact_rows
    ] if terms.openings else []  # fmt: skip
    outputs: dict[str, Any] = {}
    for k, ways in terms.openings.items():
        for j in range(2):
            own = ways[j] if j < len(ways) else None
            outputs[f"press {k} {j}"] = 0.0 if own is None else own.reaction(*free)
            for i, response in responses:
                outputs[f"gain {k} {j} {i}"] = 0.0 if own is None else own.response(i, *response)
    return outputs


def _product(one: Any, other: Any) -> Any:
    total: Any = 0.0
    for k, x in one.items():
        if k in other:
            total = total + x * other[k]
    return total
