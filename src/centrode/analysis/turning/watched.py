"""Numbers watched along the drive (angles of links, displacements, transmission angles), and where they turn back.

A number is watched as an angle's cosine and sine (of any common length), or plainly. Where its rate changes its
sign between nodes, the root of the rate is found with the second derivative of the motion itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.analysis.turning.tours import Tour
from centrode.numerics.search import newton_roots, sign_changes
from centrode.structure.constraints import Positions

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
Pair: TypeAlias = tuple[Number, Number]
Watching: TypeAlias = Callable[[Positions], "Pair | Number"]
"""From positions of jets to (cosine, sine), or to a number."""

STILL = 1e-9
"""A number that changes by less, in rad or in the greatest length, does not move."""


@dataclass(frozen=True)
class Watched:
    """A number by its name, its SI unit, and how it follows from positions."""

    name: str
    unit: str
    of: Watching

    def rate(self, at: Positions, count: int) -> tuple[Array, Array]:
        """What has the sign of the number's rate by the drive (n,), and its derivative."""
        found = self.of(at)
        if isinstance(found, tuple):
            cosine, sine = (_derivatives(x, count) for x in found)
            return cosine[0] * sine[1] - sine[0] * cosine[1], cosine[0] * sine[2] - sine[0] * cosine[2]
        value = _derivatives(found, count)
        return value[1], value[2]

    def value(self, at: Positions, count: int) -> Array:
        """The number itself (n,); an angle in (-pi, pi]."""
        found = self.of(at)
        if isinstance(found, tuple):
            cosine, sine = (_derivatives(x, count)[0] for x in found)
            return np.asarray(np.arctan2(sine, cosine))
        return _derivatives(found, count)[0]


def _derivatives(number: Number, count: int) -> list[Array]:
    """Value and derivatives of a jet (or of a constant) as plain arrays (n,)."""
    found = [number.derivative(k) for k in range(number.order + 1)] if isinstance(number, Jet) else [number]
    found += [0.0] * (3 - len(found))
    return [np.broadcast_to(np.asarray(x, dtype=np.float64), (1, count))[0] for x in found]


@dataclass(frozen=True)
class Course:
    """Numbers watched on the nodes of a tour, and where each of them turns back.

    Attributes
    ----------
    values : (watched, nodes); angles run on
    turned : for each watched, the drive's values (k,) where its rate is zero, in order, and its values there
    """

    tour: Tour
    watched: tuple[Watched, ...]
    nodes: Array
    values: Array
    turned: tuple[tuple[Array, Array], ...]


def course_of(tour: Tour, watched: Sequence[Watched]) -> Course:
    """Watch numbers along a tour."""
    nodes = tour.nodes()
    at = tour.at(nodes, 1)
    values = np.array([_unwrapped(one, one.value(at, len(nodes))) for one in watched])
    rates = np.array([one.rate(at, len(nodes))[0] for one in watched])
    if not len(watched):
        return Course(tour, (), nodes, np.zeros((0, len(nodes))), ())
    scale = [
        1.0 if one.unit == "rad" else float(tour.continuation.kinematics.numbers.scale) for one in watched
    ]
    moving = np.ptp(values, axis=1) > STILL * np.array(scale)
    which, cells = sign_changes(np.where(moving[:, None], rates, np.nan))
    places = _roots(tour, watched, which, nodes[cells], nodes[cells + 1])
    reached = _values_at(tour, watched, which, places)
    turned = []
    for k, one in enumerate(watched):
        mine = which == k
        found = _near(one, reached[mine], values[k][cells[mine]])
        turned.append(_in_order(tour, places[mine], found))
    return Course(tour, tuple(watched), nodes, values, tuple(turned))


def _unwrapped(one: Watched, values: Array) -> Array:
    return np.unwrap(values) if one.unit == "rad" and np.isfinite(values).all() else values


def _near(one: Watched, values: Array, nodes: Array) -> Array:
    """Angles in the turn of their nodes."""
    if one.unit != "rad":
        return values
    return values + 2.0 * np.pi * np.round((nodes - values) / (2.0 * np.pi))


def _in_order(tour: Tour, places: Array, values: Array) -> tuple[Array, Array]:
    """In the drive's order; of a tour that comes round, within its first turns."""
    if tour.comes_round:
        first, last = tour.span
        places = np.where(places >= last, places - (last - first), places)
    order = np.argsort(places)
    return places[order], values[order]


def _roots(
    tour: Tour, watched: Sequence[Watched], which: npt.NDArray[np.intp], low: Array, high: Array
) -> Array:
    def rate(values: Array) -> tuple[Array, Array]:
        return _chosen(tour, watched, which, values, lambda one, at: one.rate(at, len(values)))

    return newton_roots(rate, low, high)


def _values_at(tour: Tour, watched: Sequence[Watched], which: npt.NDArray[np.intp], places: Array) -> Array:
    if not len(which):
        return np.zeros(0)
    found = _chosen(
        tour, watched, which, places, lambda one, at: (one.value(at, len(places)), np.zeros(len(places)))
    )
    return found[0]


def _chosen(
    tour: Tour,
    watched: Sequence[Watched],
    which: npt.NDArray[np.intp],
    values: Array,
    ask: Callable[[Watched, Positions], tuple[Array, Array]],
) -> tuple[Array, Array]:
    """What each entry asks about its own watched number, from one evaluation of the motion."""
    at = tour.at(values, 2)
    first, second = np.zeros(len(values)), np.zeros(len(values))
    for k in np.unique(which):
        one, other = ask(watched[k], at)
        first[which == k], second[which == k] = one[which == k], other[which == k]
    return first, second
