"""Measures of the sphere and their gradients, by the coordinates of points and links.

A gradient is a vector at a place; what depends on the place of a point in the axes of a link alone changes by
the same gradient when the link turns.
"""

from __future__ import annotations

from centrode.geometry.space import Namespace, Number, Reference, Row, Rows
from centrode.geometry.sphere import (
    Attitude,
    Coordinates,
    HalfArc,
    Vector,
    add,
    basis,
    carried,
    cross,
    dot,
    meridian,
    subtract,
    tangent,
    tangent_inside,
    times,
    unit_vector,
)

FAINT = 1e-30
"""Far below rounding: it makes a place opposite to the right one infinitely wrong instead of undetermined."""


def arms(m: Namespace, pose: Attitude, base: Attitude, reference: Reference) -> tuple[Vector, Vector, Vector]:
    """The link's own tangent, that of the reference arc, and the place of that arc's first point."""
    first, second, base_first, base_second = given(reference)
    return (
        carried(pose, tangent_inside(m, first, second)),
        carried(base, tangent_inside(m, base_first, base_second)),
        carried(base, unit_vector(m, base_first)),
    )


def given(reference: Reference) -> tuple[Coordinates, ...]:
    """The reference of an angle, without which there is none on the sphere."""
    if reference is None:
        raise ValueError("an angle on the sphere is measured from a reference arc")
    return reference


def half(m: Namespace, arc: Number) -> HalfArc:
    """Sine and cosine of half an arc."""
    return m.sin(0.5 * arc), m.cos(0.5 * arc)


def length(m: Namespace, v: Vector) -> Number:
    """Length of a vector."""
    return m.sqrt(dot(v, v))


def unit(m: Namespace, v: Vector) -> Vector:
    """A vector of unit length."""
    return times(1.0 / length(m, v), v)


def components(arm: Vector, zero: Vector, axis: Vector) -> tuple[Number, Number]:
    """Cosine and sine, times a common factor, of the angle from one tangent to another, about their place."""
    return dot(arm, zero), dot(arm, cross(axis, zero))


def turning(arm: Vector, zero: Vector, axis: Vector) -> Vector:
    """Gradient of that angle by the rotation of the arm."""
    left = cross(axis, zero)
    cosine, sine = dot(arm, zero), dot(arm, left)
    across = cross(arm, subtract(times(cosine, left), times(sine, zero)))
    return times(1.0 / (cosine * cosine + sine * sine), across)


def chart(m: Namespace, pose: Attitude, local: Coordinates) -> tuple[Vector, Vector, Vector]:
    """Place of a link's point and two unit vectors square to it that are fixed in the link."""
    inside = unit_vector(m, local)
    first, second = basis(m, inside)
    return carried(pose, inside), carried(pose, first), carried(pose, second)


def nearness(point: Vector, at: Vector) -> Number:
    """Squared cosine of half the arc between two places."""
    together = add(point, at)
    return 0.25 * dot(together, together) + FAINT * FAINT


def stereographic(m: Namespace, point: Vector, pose: Attitude, local: Coordinates) -> list[Number]:
    """Coordinates of a point about a link's point, projected from opposite to it: opposite is infinitely far."""
    at, first, second = chart(m, pose, local)
    apart, near = subtract(point, at), nearness(point, at)
    return [(dot(first, apart) + FAINT * dot(apart, apart)) / near, dot(second, apart) / near]


def stereographic_slopes(m: Namespace, point: Vector, pose: Attitude, local: Coordinates) -> list[Vector]:
    """Their gradients."""
    at, *axes = chart(m, pose, local)
    near = nearness(point, at)
    return [times(1.0 / near, subtract(axis, times(0.5 * dot(axis, point) / near, at))) for axis in axes]


def azimuth(
    m: Namespace, point: Vector, pose: Attitude, pole: Coordinates
) -> tuple[Number, Number, Vector, Vector]:
    """How far a point is to the north and to the west of a pole that a link carries, and both directions."""
    north, west = (carried(pose, axis) for axis in meridian(m, pole))
    return dot(point, north), dot(point, west), north, west


def away(m: Namespace, point: Vector, pole: Vector) -> Vector:
    """Gradient at a point of its arc from a pole: the unit vector away from it."""
    towards = tangent(point, pole)
    return times(-1.0 / length(m, towards), towards)


def of_point(m: Namespace, point: Vector, slope: Vector) -> Row:
    """A gradient by the coordinates of the point."""
    first, second = basis(m, point)
    return dot(slope, first), dot(slope, second)


def of_both(m: Namespace, point: Vector, slope: Vector) -> Rows:
    """A gradient by the coordinates of the point and of the link."""
    return of_point(m, point, slope), cross(slope, point)
