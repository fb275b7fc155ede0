"""Equations of motion that can be solved: redundant closures set aside, links without mass held by weights.

The rank of the closures is a number of the structure, but at single positions (change points) it is less. So it is
looked for at the initial position and at some near it, as the greatest one there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion
from centrode.dynamics.forward_dynamics.initial_position import (
    close_position,
    equation_units,
    residuals_and_rows,
    units_of,
)
from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.arrays import ARRAYS

Array: TypeAlias = npt.NDArray[np.float64]

RANK = 1e-9
"""A singular value below this share of the greatest counts as none."""
CONDITION = 1e-9
"""Below this share of its greatest eigenvalue the mass matrix has no inverse."""
UNMOVED = 1e-14
"""Below this share a direction of free motion moves no mass."""
IMPLIED = 1e-7
"""An equation takes part in what others imply from this component of a unit vector of the left null space on."""
LOOKS = (0.0, 0.13, -0.17, 0.29)
"""How far along the free directions the rank is looked for, in rad or lengths: not all can be singular."""


def solvable_equations(equations: EquationsOfMotion, coordinates: Array) -> tuple[EquationsOfMotion, int]:
    """Equations with what their solution needs (dependent rows, weights, references), and the rank of the closures.

    `coordinates` (coordinates) [rad or m] are those of a position that closes.

    Raises
    ------
    InputError
        A motion is possible that moves no mass.
    """
    places = _places_near(equations, coordinates)
    ranks = [closure_rank(equations, place) for place in places]
    rank = max(ranks)
    if rank < equations.equations:
        generic = places[ranks.index(rank)]
        equations = replace(equations, dependent=_dependent_equations(equations, generic, rank))
    equations = _with_weights(equations, places)
    return replace(equations, references=_references(equations, places)), rank


def _places_near(equations: EquationsOfMotion, coordinates: Array) -> list[Array]:
    """The position itself and some that close near it, along the free directions."""
    units = units_of(equations.tree, equations.numbers)
    places = [coordinates]
    generator = np.random.default_rng(2)
    for far in LOOKS[1:]:
        _left, rows = residuals_and_rows(
            equations.tree, equations.numbers, equations.tree.closures, coordinates, {}
        )
        if len(rows):
            scaled = rows * units / equation_units(equations.tree.closures, equations.numbers)[:, None]
            _u, sizes, turned = np.linalg.svd(scaled)
            free = turned[int(np.sum(sizes > RANK * max(sizes, default=1.0))) :]
        else:
            free = np.eye(len(coordinates))
        if not len(free):
            continue
        way = generator.uniform(0.5, 1.0, len(free)) @ free
        guess = coordinates + far * units * way / max(float(np.max(np.abs(way))), 1e-12)
        try:
            places.append(
                close_position(equations.tree, equations.numbers, equations.tree.closures, guess, {})
            )
        except InputError:
            continue
    return places


def _scaled_rows(equations: EquationsOfMotion, coordinates: Array) -> Array:
    starts = {kept.name: float(kept.driven.initial) for kept in equations.kept}
    _left, rows = residuals_and_rows(
        equations.tree, equations.numbers, equations.constraints, coordinates, starts
    )
    units = units_of(equations.tree, equations.numbers)
    return np.asarray(rows * units / equation_units(equations.constraints, equations.numbers)[:, None])


def closure_rank(equations: EquationsOfMotion, coordinates: Array) -> int:
    """Rank of the closures at joint coordinates (coordinates) [rad or m]."""
    rows = _scaled_rows(equations, coordinates)
    sizes = np.linalg.svd(rows, compute_uv=False) if len(rows) else np.zeros(0)
    return int(np.sum(sizes > RANK * max(sizes, default=1.0)))


def _dependent_equations(equations: EquationsOfMotion, coordinates: Array, rank: int) -> frozenset[int]:
    """Equations that take part in what others imply: where the left null space of their rows is not zero."""
    rows = _scaled_rows(equations, coordinates)
    left, _sizes, _right = np.linalg.svd(rows)
    null = left[:, rank:]
    return frozenset(int(k) for k in np.nonzero(np.max(np.abs(null), axis=1) > IMPLIED)[0])


def _with_weights(equations: EquationsOfMotion, places: Sequence[Array]) -> EquationsOfMotion:
    """Weights of the closures where links are without mass; InputError where a motion moves no mass."""
    units, count = units_of(equations.tree, equations.numbers), equations.size
    weak = False
    moved = 0.0
    for place in places:
        values = equations.tree.values(ARRAYS, list(place))
        terms = equations.terms(ARRAYS, values, [0.0] * count, 0.0)
        mass = np.zeros((count, count))
        for (i, j), x in terms.mass.items():
            mass[i, j] = mass[j, i] = float(x) * units[i] * units[j]
        sizes = np.linalg.eigvalsh(mass) if count else np.ones(1)
        weak = weak or sizes[0] <= CONDITION * max(float(sizes[-1]), 1e-300)
        rows = _scaled_rows(equations, place)
        free = _null_space(rows, count)
        of_free = np.linalg.eigvalsh(free.T @ mass @ free) if free.shape[1] else np.ones(1)
        moved = max(moved, float(of_free[0]) / max(float(sizes[-1]), 1e-300))
    if moved <= UNMOVED:
        what = _("a motion is possible that moves no mass")
        raise InputError("[links]", what, _("give the links that move alone a mass"))
    if not weak:
        return equations
    return replace(equations, weights=_weights(equations, places[-1], units))


def _references(equations: EquationsOfMotion, places: Sequence[Array]) -> tuple[float, ...]:
    """The greatest diagonal of S at some places, the same for all equations of a constraint."""
    greatest = np.zeros(equations.equations)
    for place in places:
        values = equations.tree.values(ARRAYS, list(place))
        system = equations.system(ARRAYS, equations.terms(ARRAYS, values, [0.0] * equations.size, 0.0))
        greatest = np.maximum(greatest, np.array(system.diagonal, dtype=np.float64))
    first = 0
    for constraint in equations.constraints:
        own = slice(first, first + constraint.size)
        greatest[own] = np.sum(greatest[own])
        first += constraint.size
    return tuple(float(x) if x > 0.0 else 1.0 for x in greatest)


def _null_space(rows: Array, count: int) -> Array:
    if not len(rows):
        return np.eye(count)
    _left, sizes, right = np.linalg.svd(rows)
    rank = int(np.sum(sizes > RANK * max(sizes, default=1.0)))
    return np.asarray(right[rank:].T)


def _weights(equations: EquationsOfMotion, place: Array, units: Array) -> tuple[float, ...]:
    """A mass for each closure equation: that of the links over the square of its row."""
    values = equations.tree.values(ARRAYS, list(place))
    terms = equations.terms(ARRAYS, values, [0.0] * equations.size, 0.0)
    heaviest = max((float(x) * units[i] ** 2 for (i, j), x in terms.mass.items() if i == j), default=1.0)
    sizes = [sum((float(x) * units[k]) ** 2 for k, x in row.items()) for row in terms.rows]
    return tuple(heaviest / size if size > 0.0 else heaviest for size in sizes)
