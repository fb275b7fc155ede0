"""Equations of motion as functions: their initial value problem, and what contacts feel and states end with."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf, isfinite
from typing import Any, Self, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.contact_forces import contact_function
from centrode.dynamics.forward_dynamics.controllers import states_of
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion
from centrode.dynamics.forward_dynamics.initial_position import units_of
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.dynamics.forward_dynamics.model_numbers import NumbersAsVariables
from centrode.dynamics.forward_dynamics.motion_problem import CONTROLS, MotionNames, motion_problem
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.initial_value_problems import STEP, TIME, InitialValueProblem
from centrode.numerics.integrators import Integrator, integrator_of
from centrode.numerics.python_functions import Function
from centrode.numerics.python_integrations import PythonIntegration
from centrode.numerics.scans import evaluate

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

STALLED = 1e-13
"""A step below this share of the time reached is none."""


@dataclass(frozen=True)
class MotionFunctions:
    """Equations of motion as an initial value problem whose steps can be taken.

    Their numbers are parameters of the problem, so that mechanisms of one structure share one kernel.
    """

    equations: EquationsOfMotion

    @cached_property
    def variables(self) -> NumbersAsVariables:
        """The equations with numbers as variables: one for all mechanisms of this structure."""
        return NumbersAsVariables.of(self.equations)

    @cached_property
    def names(self) -> MotionNames:
        """Names of what is carried from step to step."""
        return MotionNames.of(self.equations)

    @cached_property
    def problem(self) -> InitialValueProblem:
        """The initial value problem, its numbers being parameters."""
        return motion_problem(self.variables.equations, self.variables.parameters)

    @cached_property
    def contact_function(self) -> Function:
        """What contacts feel at one state; see `contact_forces.contact_function`."""
        return contact_function(self.variables.equations, self.names, self.problem)

    @cached_property
    def closing_function(self) -> Function:
        """What a state ends with behind an event, on plain numbers."""
        return PythonIntegration(self.problem).closing

    def with_numbers(self, equations: EquationsOfMotion) -> Self:
        """The same problem for equations of the same structure with other numbers."""
        other = type(self)(equations)
        shared: tuple[str, ...] = ("variables", "names", "problem")
        shared += ("contact_function", "closing_function") if self.equations.has_events else ()
        for name in shared:
            other.__dict__[name] = getattr(self, name)
        return other

    def integrator(self, executor: str = "auto") -> Integrator:
        """What takes steps of one mechanism, by an executor."""
        return integrator_of(self.problem, executor)

    def parameters(self, end: Number, tolerance: Number, rate: Number, lanes: int = 1) -> Array:
        """Values of the parameters (parameters, lanes).

        Parameters
        ----------
        end : time at which steps end [s]
        tolerance : of the error of a step
        rate : what speeds are compared with [1/s]
        """
        smallest = STALLED * np.maximum(np.asarray(end, dtype=np.float64), 1.0 / np.asarray(rate))
        smallest = np.where(np.isfinite(smallest), smallest, 0.0)
        controls = dict(
            zip(CONTROLS, (end, smallest, tolerance, rate, float(self.equations.numbers.scale)), strict=True)
        )
        rows = np.array([np.broadcast_to(controls[name], lanes) for name in CONTROLS], dtype=np.float64)
        numbers = self.variables.values(self.equations)
        return np.concatenate([rows, np.broadcast_to(numbers, (len(numbers), lanes))])

    def rate(self, start: InitialState, duration: float = inf) -> float:
        """What speeds are compared with [1/s]: those at the start, and what the accelerations make of a rest.

        In equilibrium both are rounding: then what counts is what would be seen at the end of a duration [s].
        """
        units = units_of(self.equations.tree, self.equations.numbers)
        values = self.equations.tree.values(ARRAYS, list(start.coordinates))
        with np.errstate(all="ignore"):
            terms = self.equations.terms(ARRAYS, values, list(start.speeds), 0.0)
            accelerations, _forces, _flags = self.equations.accelerations(ARRAYS, terms)
        fast = float(np.max(np.abs(start.speeds) / units, initial=0.0))
        bent = float(np.max(np.abs(np.array(accelerations, dtype=np.float64)) / units, initial=0.0))
        least = 1.0 / duration if duration > 0.0 else 0.0
        rate = max(fast, np.sqrt(bent) if isfinite(bent) else 0.0, least)
        return rate if rate > 0.0 else 1.0

    def carried_values(self, start: InitialState) -> Array:
        """What the integrator carries (carried), at a state that closes."""
        names = self.names
        found = dict.fromkeys(self.problem.carried_names, 0.0)
        found |= dict(zip(names.coordinates, start.coordinates, strict=True))
        found |= dict(zip(names.speeds, start.speeds, strict=True))
        found |= dict(zip(names.states, states_of(self.equations.controls), strict=True))
        closing = evaluate(
            self.problem.of_closing,
            found
            | {TIME: 0.0, STEP: 1.0}
            | dict(zip(self.problem.parameters, self.parameters(1.0, 1.0, 1.0)[:, 0], strict=True)),
        )
        # rotors and flags are those of the start; the start itself is closed already
        kept = (*names.coordinates, *names.speeds, *names.works, *names.states)
        return np.array(
            [found[name] if name in kept else float(closing[name]) for name in self.problem.carried_names]
        )

    def energies_at(self, carried: Array, time: float) -> tuple[float, float]:
        """Kinetic energy, and potential energy less the works, of what is carried."""
        names = self.names
        q, w = list(carried[names.part(names.coordinates)]), list(carried[names.part(names.speeds)])
        kinetic, potential = self.equations.energies(ARRAYS, self.equations.tree.values(ARRAYS, q), w, time)
        return float(kinetic), float(potential) - float(np.sum(carried[names.part(names.works)]))
