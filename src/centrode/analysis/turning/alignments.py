"""Links that fall in line: what an extreme position or a dead point looks like."""

from __future__ import annotations

from itertools import combinations, product
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.analysis.turning.tours import Tour
from centrode.model.mechanism import Mechanism

Array: TypeAlias = npt.NDArray[np.float64]
Pairs: TypeAlias = tuple[tuple[str, str], ...]
Number: TypeAlias = Any

FLAT = 1e-7
"""Sine of the angle between two links below which they are said to be in line: half the digits of a root."""


def in_line(tour: Tour, values: Array) -> list[Pairs]:
    """Pairs of moving links, hinged to each other, that are in line at each of some values (n,) of the drive."""
    mechanism = tour.prepared.mechanism
    found: list[dict[tuple[str, str], None]] = [{} for _value in values]
    if not len(values):
        return []
    places = _places(tour, values)
    for pair, a, pin, b in _hinged(mechanism):
        flat = _flat(mechanism, places[a], places[pin], places[b])
        for k in np.nonzero(flat)[0]:
            found[k][pair] = None
    return [tuple(pairs) for pairs in found]


def _places(tour: Tour, values: Array) -> dict[str, Array]:
    """Places (axes, n) of all points."""

    def plain(x: Number) -> Array:
        number: Array = np.asarray(x.value if isinstance(x, Jet) else x, dtype=np.float64)
        return np.asarray(np.broadcast_to(number, (1, len(values)))[0])

    at = tour.at(values, 0)
    return {name: np.array([plain(x) for x in place]) for name, place in at.points.items()}


def _hinged(mechanism: Mechanism) -> list[tuple[tuple[str, str], str, str, str]]:
    """Two links with a hinge between them, and another joint of each: (links, joint, hinge, joint)."""
    joints = _joints(mechanism)
    at_point: dict[str, list[str]] = {}
    for link, points in joints.items():
        for point in points:
            at_point.setdefault(point, []).append(link)
    found = []
    for pin, links in at_point.items():
        for one, other in combinations(links, 2):
            ends = product((p for p in joints[one] if p != pin), (p for p in joints[other] if p != pin))
            found += [((one, other), a, pin, b) for a, b in ends if a != b]
    order = {name: k for k, name in enumerate(mechanism.links)}
    return sorted(found, key=lambda one: (order[one[0][0]], order[one[0][1]]))


def _joints(mechanism: Mechanism) -> dict[str, tuple[str, ...]]:
    """Points of every link by which it is joined to others, to the frame or to a guide."""
    guided = {guide.point for guide in mechanism.guides}
    bodies: dict[str, int] = dict.fromkeys(mechanism.frame.points, 1)
    for link in mechanism.links.values():
        for point in link.coordinates:
            bodies[point] = bodies.get(point, 0) + 1
    return {
        name: tuple(p for p in link.coordinates if bodies[p] > 1 or p in guided)
        for name, link in mechanism.links.items()
    }


def _flat(mechanism: Mechanism, a: Array, pin: Array, b: Array) -> npt.NDArray[np.bool_]:
    """Whether three places lie on one line, on the sphere on one great circle."""
    one, other = a - pin, b - pin
    sizes = np.linalg.norm(one, axis=0) * np.linalg.norm(other, axis=0)
    if mechanism.space == "sphere":
        off = np.abs(np.sum(pin * np.cross(one, other, axis=0), axis=0))
    else:
        off = np.abs(one[0] * other[1] - one[1] * other[0])
    return np.asarray((sizes > 0.0) & (off <= FLAT * sizes))
