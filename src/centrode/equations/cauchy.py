"""The equations of a mechanism in Cauchy normal form, as numbers: rates of its unknowns from time and state.

They come from the differentiated chain equations alone, not from the closed forms of positions, so that what is
integrated is a second way to the same motion.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.equations.draft import Unknown
from centrode.equations.laying import laid
from centrode.equations.letters import Letter
from centrode.equations.places import Place
from centrode.equations.sums import Sum
from centrode.equations.systems import LinearSystem, system_of
from centrode.errors import InputError
from centrode.kinematics.path import DrivenBy
from centrode.kinematics.prepared import Ready, ready
from centrode.locale import _
from centrode.model.mechanism import Mechanism

Array: TypeAlias = npt.NDArray[np.float64]

JETS = JetFunctions(ARRAYS)


@dataclass(frozen=True)
class CauchyForm:
    """d state/dt = rates(time, state), with what the chains say of a state.

    Attributes
    ----------
    names : of the unknowns of all groups in the order of the plan: "angle.AC", "slide.C", "bearing.wheel";
        the angle of a cylinder is "angle.K-A"
    symbols : their letters, "phi2"
    initial : (n,) state at t = 0 [rad, m], angles as in the initial position, with their turns
    constraint_names : "y_C", "x_D", ..., as many as unknowns

    `time` is a number or (...), a state is (..., n): many states are computed at once.
    """

    names: tuple[str, ...]
    symbols: tuple[str, ...]
    initial: Array
    constraint_names: tuple[str, ...]
    unknowns: tuple[Unknown, ...]
    systems: tuple[LinearSystem, ...]
    residuals: tuple[Sum, ...]
    places: Mapping[str, Place]
    constants: Mapping[Letter, float]
    drives: tuple[tuple[Letter, Letter, DrivenBy], ...]

    def rates(self, time: Any, state: npt.ArrayLike) -> Array:
        """Derivatives of the state by time [rad/s, m/s], (..., n); NaN where a group's determinant is zero."""
        values = self._values(time, state)
        found: list[Array] = []
        for system in self.systems:
            shape = np.shape(next(iter(values.values())))
            matrix = np.array(
                [[self._number(entry, values, shape) for entry in row] for row in system.matrix]
            )
            right = np.array([self._number(entry, values, shape) for entry in system.right])
            solved = _solved(np.moveaxis(matrix, (0, 1), (-2, -1)), np.moveaxis(right, 0, -1))
            for i, letter in enumerate(system.unknowns):
                values[letter] = solved[..., i]
                found.append(solved[..., i])
        return np.stack(found, axis=-1) if found else np.zeros((*np.shape(time), 0))

    def positions(self, time: Any, state: npt.ArrayLike) -> dict[str, Array]:
        """Places of all points by their chains [m]: name -> (..., 2)."""
        values = self._values(time, state)
        shape = np.shape(next(iter(values.values()), 0.0))
        return {
            name: np.stack([self._number(at.x, values, shape), self._number(at.y, values, shape)], axis=-1)
            for name, at in self.places.items()
        }

    def constraints(self, time: Any, state: npt.ArrayLike) -> Array:
        """Left sides less right sides [m, rad], (..., n): how far a state has drifted off the constraints."""
        values = self._values(time, state)
        shape = np.shape(next(iter(values.values()), 0.0))
        found = [self._number(one, values, shape) for one in self.residuals]
        return np.stack(found, axis=-1) if found else np.zeros((*shape, 0))

    def _values(self, time: Any, state: npt.ArrayLike) -> dict[Letter, Any]:
        state = np.asarray(state, dtype=np.float64)
        values: dict[Letter, Any] = {}
        time = np.asarray(time, dtype=np.float64)
        shape = np.broadcast_shapes(time.shape, state.shape[:-1])
        for i, one in enumerate(self.unknowns):
            values[one.letter] = np.broadcast_to(state[..., i], shape)
        for letter, rate, driven in self.drives:
            jet = driven.value(JETS, Jet.variable(time, 1))
            value, speed = (jet.value, jet.derivative(1)) if isinstance(jet, Jet) else (jet, 0.0)
            values[letter], values[rate] = np.broadcast_to(value, shape), np.broadcast_to(speed, shape)
        return values | {letter: np.float64(x) for letter, x in self.constants.items()}

    @staticmethod
    def _number(total: Sum, values: Mapping[Letter, Any], shape: tuple[int, ...]) -> Array:
        return np.broadcast_to(total.value(np, values.__getitem__), shape).astype(np.float64)


def _solved(matrix: Array, right: Array) -> Array:
    """Solutions of many systems; NaN where one is singular."""
    with np.errstate(all="ignore"):
        try:
            return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0])
        except np.linalg.LinAlgError:
            if matrix.ndim == 2:
                return np.full(right.shape, np.nan)
            flat = [_solved(a, b) for a, b in zip(matrix, right, strict=True)]
            return np.stack(flat)


def cauchy_form(mechanism: Mechanism) -> CauchyForm:
    """The normal form of a mechanism.

    Raises InputError on the sphere, and what `motion` raises for a mechanism that does not assemble.
    """
    return form_of(ready(mechanism))


def form_of(made: Ready) -> CauchyForm:
    """The normal form of a mechanism made ready."""
    if made.mechanism.space != "plane":
        raise InputError(
            "space",
            _("the normal form is integrated in the plane, not on the sphere"),
            _("compute the motion: centrode run; equations in symbols: centrode equations"),
        )
    board, drafts = laid(made)
    letters = board.alphabet
    systems = tuple(
        system_of(
            [one.rate(board.moves) for one in draft.conditions],
            [one.rate for one in draft.unknowns],
            [one.pair for one in draft.conditions],
        )
        for draft in drafts
    )
    unknowns = tuple(one for draft in drafts for one in draft.unknowns)
    conditions = [one for draft in drafts for one in draft.conditions]
    values = letters.values
    driven = {one.drive.id: one for one in made.kinematics.path.driven}
    return CauchyForm(
        names=tuple(one.name for one in unknowns),
        symbols=tuple(one.letter.name for one in unknowns),
        initial=np.array([values[one.letter] for one in unknowns], dtype=np.float64),
        constraint_names=tuple(one.name for one in conditions),
        unknowns=unknowns,
        systems=systems,
        residuals=tuple(one.residual for one in conditions),
        places=dict(board.points),
        constants={letter: x for letter, x in values.items() if letter not in letters.rates},
        drives=tuple(
            (letter, letters.rates[letter], driven[drive]) for letter, drive in board.driven.items()
        ),
    )
