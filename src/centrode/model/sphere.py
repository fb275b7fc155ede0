"""Places on the unit sphere: longitude and latitude, unit vectors, and angles between arcs."""

from __future__ import annotations

import math

from centrode.model.values import Vector

Vector3 = tuple[float, float, float]
Axes = tuple[Vector3, Vector3, Vector3]

FLAT = 1e-9
"""Arcs shorter than this, or as near to half a great circle, do not tell a direction [rad]."""


def unit_vector(place: Vector) -> Vector3:
    """Unit vector of (longitude, latitude) [rad]: (cos lat cos lon, cos lat sin lon, sin lat)."""
    longitude, latitude = place
    across = math.cos(latitude)
    return across * math.cos(longitude), across * math.sin(longitude), math.sin(latitude)


def longitude_latitude(vector: Vector3) -> Vector:
    """(longitude, latitude) [rad] of a vector of any length but zero; longitude in (-pi, pi], 0 at the poles."""
    x, y, z = vector
    return math.atan2(y, x), math.atan2(z, math.hypot(x, y))


def dot(a: Vector3, b: Vector3) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector3, b: Vector3) -> Vector3:
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def arc(a: Vector3, b: Vector3) -> float:
    """Arc [rad] between two unit vectors, 0 to pi, to rounding also where it is short."""
    return math.atan2(math.hypot(*cross(a, b)), dot(a, b))


def makes_arc(a: Vector3, b: Vector3) -> bool:
    """Whether two unit vectors neither coincide nor lie opposite, so that one great circle joins them."""
    return FLAT < arc(a, b) < math.pi - FLAT


def heading(start: Vector3, towards: Vector3) -> Vector3:
    """Unit tangent in `start` of the arc towards a point that is neither `start` nor opposite to it."""
    normal = cross(start, towards)
    size = math.hypot(*normal)
    x, y, z = cross(normal, start)
    return x / size, y / size, z / size


def turned_about(axis: Vector3, tangent: Vector3, angle: float) -> Vector3:
    """A tangent in `axis` turned by an angle [rad], counter-clockwise seen from outside the sphere."""
    left = cross(axis, tangent)
    cosine, sine = math.cos(angle), math.sin(angle)
    x, y, z = (cosine * t + sine * n for t, n in zip(tangent, left, strict=True))
    return x, y, z


def axes(pivot: Vector3, forward: Vector3) -> Axes:
    """Right-handed axes of a pivot and a unit tangent in it."""
    return pivot, forward, cross(pivot, forward)


def carried(vector: Vector3, mine: Axes, theirs: Axes) -> Vector3:
    """A vector turned together with its axes into others."""
    sizes = [dot(vector, axis) for axis in mine]
    x, y, z = (sum(size * axis[k] for size, axis in zip(sizes, theirs, strict=True)) for k in range(3))
    return x, y, z


def angle_between(pivot: Vector3, reference: Vector3, point: Vector3) -> float:
    """Angle [rad] in the pivot from the arc to `reference` to the arc to `point`, in (-pi, pi].

    Counter-clockwise seen from outside the sphere; neither point may be the pivot or opposite to it.
    """
    start, end = heading(pivot, reference), heading(pivot, point)
    return math.atan2(dot(pivot, cross(start, end)), dot(start, end))
