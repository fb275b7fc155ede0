"""Links that fall in line: what an extreme position or a dead point looks like."""

from __future__ import annotations

from itertools import combinations, product
from typing import Any, TypeAlias

import numpy as np

from centrode.algebra.arrays import ARRAYS
from centrode.analysis.turning.tours import Tour
from centrode.model.mechanism import Mechanism

Number: TypeAlias = Any

FLAT = 1e-7
"""Sine of the angle between two links below which they are said to be in line: half the digits of a root."""


def in_line(tour: Tour, value: float) -> tuple[tuple[str, str], ...]:
    """Pairs of moving links, hinged to each other, that are in line at a value of the drive."""
    mechanism = tour.prepared.mechanism
    at = tour.stopped(value, ARRAYS)
    places = {
        name: np.array([float(np.reshape(x, -1)[0]) for x in place]) for name, place in at.points.items()
    }
    joints = joints_of(mechanism)
    pairs = []
    for one, other in combinations(mechanism.links, 2):
        for pin in (p for p in joints[one] if p in joints[other]):
            ends = product((p for p in joints[one] if p != pin), (p for p in joints[other] if p != pin))
            if any(_flat(mechanism, places[a], places[pin], places[b]) for a, b in ends):
                pairs.append((one, other))
    return tuple(dict.fromkeys(pairs))


def joints_of(mechanism: Mechanism) -> dict[str, tuple[str, ...]]:
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


def _flat(mechanism: Mechanism, a: Any, pin: Any, b: Any) -> bool:
    """Whether three places lie on one line, on the sphere on one great circle."""
    one, other = a - pin, b - pin
    sizes = float(np.linalg.norm(one) * np.linalg.norm(other))
    if not sizes > 0.0:
        return False
    if mechanism.space == "sphere":
        return abs(float(np.dot(pin, np.cross(one, other)))) <= FLAT * sizes
    return abs(float(one[0] * other[1] - one[1] * other[0])) <= FLAT * sizes
