"""Variational equations of a free motion: how it changes with its start and with the numbers of its mechanism.

Beside everything that is followed stand its derivatives along some directions. Their rates are those of the rates by
the chain rule, and where a step is closed its derivatives are those of what closes it: they are the exact derivatives
of the steps that are taken, as long as these stay the same. (E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary
Differential Equations I, 2nd ed., 1993, section I.14.)

Motions are smooth here. One that comes to a change point has no derivatives beyond it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.free_motion import FreeMotion
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.dynamics.forward_dynamics.integration import ATTEMPTS, MOST_STEPS
from centrode.dynamics.forward_dynamics.motion_problem import CONTROLS
from centrode.errors import MotionError, NotComputedYet
from centrode.locale import _
from centrode.numerics.expressions import as_node, variable
from centrode.numerics.graphs import directional_derivatives
from centrode.numerics.initial_value_problems import END, HEADER, STEP, TIME, InitialValueProblem
from centrode.numerics.integrators import integrator_of
from centrode.numerics.scans import evaluate

Array: TypeAlias = npt.NDArray[np.float64]


def change_of(name: str, direction: int) -> str:
    """Name of the derivative of a quantity along a direction."""
    return f"change {direction} of {name}"


def variational_problem(
    problem: InitialValueProblem, directions: Sequence[Sequence[str]]
) -> InitialValueProblem:
    """The problem with derivatives of all that is followed along some directions.

    Parameters
    ----------
    directions : of each direction the parameters that change along it; all that is followed may do
    """
    changes = [
        {variable(name): variable(change_of(name, k)) for name in (*problem.unknowns, *parameters)}
        for k, parameters in enumerate(directions)
    ]
    rates, closing = dict(problem.rates), dict(problem.closing)
    of_rates = directional_derivatives(list(problem.rates.values()), changes)
    closed = [name for name in problem.unknowns if name in problem.closing]
    of_closing = directional_derivatives([problem.closing[name] for name in closed], changes)
    for k in range(len(directions)):
        own = zip(problem.unknowns, of_rates[k], strict=True)
        rates |= {change_of(name, k): as_node(x) for name, x in own}
        kept = zip(closed, of_closing[k], strict=True)
        closing |= {change_of(name, k): as_node(x) for name, x in kept}
    further = tuple(change_of(name, k) for k, parameters in enumerate(directions) for name in parameters)
    return replace(problem, parameters=(*problem.parameters, *further), rates=rates, closing=closing)


@dataclass(frozen=True)
class ChangedMotion:
    """A motion at instants (n) with its derivatives along k directions.

    Attributes
    ----------
    times : (n) [s]
    coordinates, speeds : (n, coordinates)
    coordinate_changes, speed_changes : (n, k, coordinates)
    """

    times: Array
    coordinates: Array
    speeds: Array
    coordinate_changes: Array
    speed_changes: Array


@dataclass(frozen=True)
class VariationalEquations:
    """A free motion with directions along which it may change.

    Attributes
    ----------
    free : the motion
    directions : of each the change of numbers of the equations, by their variables; empty where the start alone changes
    """

    free: FreeMotion
    directions: tuple[Mapping[str, float], ...]

    @cached_property
    def problem(self) -> InitialValueProblem:
        """The motion with its derivatives as an initial value problem."""
        return variational_problem(self.free.integration.problem, [tuple(one) for one in self.directions])

    def motion(
        self,
        start: InitialState,
        changes: Sequence[InitialState],
        times: Array,
        tolerance: float,
        executor: str = "auto",
    ) -> ChangedMotion:
        """The motion from a state, and its derivatives from those of the state along each direction.

        Parameters
        ----------
        changes : of each direction the derivatives of coordinates and speeds; those that the closures ask for are taken
        times : (n) [s] that grow
        tolerance : of the error of a step

        Raises
        ------
        MotionError
            The motion does not get to the last instant.
        NotComputedYet
            Events change it at once.
        """
        if self.free.equations.contacts or self.free.equations.controls:
            what = _("a motion with stops, dry friction, clamps or controllers has no derivatives here")
            raise NotComputedYet("", what, _("remove them, or compare motions whose numbers differ a little"))
        integration, problem = self.free.integration, self.problem
        names, base = integration.names, integration.problem
        rate = integration.rate(start, float(times[-1]))
        parameters = np.concatenate(
            [
                integration.parameters(float(times[-1]), tolerance, rate)[:, 0],
                [x for one in self.directions for x in one.values()],
            ]
        )[:, None]
        carried = dict(zip(base.carried_names, integration.carried_values(start), strict=True))
        for k, change in enumerate(changes):
            carried |= {change_of(name, k): 0.0 for name in base.unknowns}
            own = (
                *zip(names.coordinates, change.coordinates, strict=True),
                *zip(names.speeds, change.speeds, strict=True),
            )
            carried |= {change_of(name, k): float(x) for name, x in own}
        given = (
            carried | {TIME: 0.0, STEP: 1.0} | dict(zip(problem.parameters, parameters[:, 0], strict=True))
        )
        closed = evaluate(problem.of_closing, given)
        # rotors and their changes are those of the start; so are changes that the closures keep
        for k in range(len(changes)):
            for name in base.unknowns:
                if name not in names.works:
                    carried[change_of(name, k)] = float(closed[change_of(name, k)])
        values = [carried[name] for name in problem.carried_names]
        state = np.concatenate([[0.0, min(float(times[-1]), 0.01 / rate), 0.0, 0.0], values])[:, None]
        rows = np.empty((len(times), len(problem.carried_names)))
        take = integrator_of(problem, executor)
        for number, time in enumerate(times):
            parameters[CONTROLS.index(END)] = time
            attempts = 0
            while float(state[0, 0]) < time:
                before = float(state[0, 0])
                state = take.run(parameters, state, ATTEMPTS)
                attempts += int(state[2, 0])
                if float(state[0, 0]) == before or attempts > MOST_STEPS:
                    what = _("the motion has no derivatives beyond {time:.9g} s").format(time=before)
                    raise MotionError(
                        "", what, _("give a shorter time: it comes to a change point or ends there")
                    )
            rows[number] = state[HEADER:, 0]

        def part(wanted: Sequence[str]) -> Array:
            return rows[:, [problem.carried_names.index(name) for name in wanted]]

        return ChangedMotion(
            times, part(names.coordinates), part(names.speeds),
            np.stack([part([change_of(x, k) for x in names.coordinates]) for k in range(len(changes))], axis=1),
            np.stack([part([change_of(x, k) for x in names.speeds]) for k in range(len(changes))], axis=1),
        )  # fmt: skip
