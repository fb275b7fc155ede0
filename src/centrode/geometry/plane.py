"""Vectors, poses and meeting points in the plane, as formulas over any algebra.

A vector is a pair of numbers; a rotor is a unit vector (cos, sin) and turns another vector by `rotate_vector`. A
pose is the origin of a link's axes and their rotor. Where a formula has two answers it takes `root`, a
function that gives the signed square root of the radicand: the sign is the branch.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeAlias

Number: TypeAlias = Any
Namespace: TypeAlias = Any
Vector: TypeAlias = tuple[Number, Number]
Root: TypeAlias = Callable[[Number], Number]


class PlanePose(NamedTuple):
    """Where a link is: origin of its axes and their rotor."""

    origin: Vector
    rotor: Vector


class PlaneCircle(NamedTuple):
    """Locus of an unknown vector: a circle."""

    centre: Vector
    radius: Number


class Line(NamedTuple):
    """Locus of an unknown vector: a line with a unit direction."""

    through: Vector
    direction: Vector


AT_REST = PlanePose((0.0, 0.0), (1.0, 0.0))
"""Pose of the frame."""


def is_literal_zero(x: Number) -> bool:
    """Whether a number is the plain float zero, and no array or jet that happens to be zero."""
    return type(x) is float and x == 0.0


def is_origin(a: Vector) -> bool:
    """Whether a vector is the plain zero vector, which nothing needs to be added to."""
    return is_literal_zero(a[0]) and is_literal_zero(a[1])


def add(a: Vector, b: Vector) -> Vector:
    """Sum of two vectors."""
    return a[0] + b[0], a[1] + b[1]


def subtract(a: Vector, b: Vector) -> Vector:
    """Vector from b to a."""
    return a[0] - b[0], a[1] - b[1]


def dot(a: Vector, b: Vector) -> Number:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1]


def cross(a: Vector, b: Vector) -> Number:
    """Normal component of the vector product; positive if b lies to the left of a."""
    return a[0] * b[1] - a[1] * b[0]


def rotate_vector(a: Vector, rotor: Vector) -> Vector:
    """Vector a turned by a rotor; of two rotors, the rotor of the summed angle."""
    if is_literal_zero(a[1]):
        # a link's first axis, and its origin: most vectors that are turned
        return (0.0, 0.0) if is_literal_zero(a[0]) else (a[0] * rotor[0], a[0] * rotor[1])
    return a[0] * rotor[0] - a[1] * rotor[1], a[0] * rotor[1] + a[1] * rotor[0]


def reversed_rotor(rotor: Vector) -> Vector:
    """Rotor of the opposite angle."""
    return rotor[0], -rotor[1]


def rotor_of(m: Namespace, angle: Number) -> Vector:
    """Rotor of an angle [rad]."""
    return m.cos(angle), m.sin(angle)


def along(origin: Vector, direction: Vector, distance: Number) -> Vector:
    """Point at a distance from the origin in a unit direction."""
    return origin[0] + distance * direction[0], origin[1] + distance * direction[1]


def place(pose: PlanePose, local: Vector) -> Vector:
    """Point of a link at its local coordinates."""
    return pose.origin if is_origin(local) else add(pose.origin, rotate_vector(local, pose.rotor))


def pose_with_point(local: Vector, at: Vector, rotor: Vector) -> PlanePose:
    """Pose of a link that has the given rotor and its local point at a place."""
    return PlanePose(at if is_origin(local) else subtract(at, rotate_vector(local, rotor)), rotor)


def pose_by_two_points(first: Vector, second: Vector, at_first: Vector, at_second: Vector) -> PlanePose:
    """Pose of a link from the places of two of its points.

    The rotor is a unit vector as far as the places keep the link's own distance; the residual of a motion
    contains the second point, so a distance that does not fit shows.
    """
    rotor = rotate_vector(_inverse(subtract(second, first)), subtract(at_second, at_first))
    return pose_with_point(first, at_first, rotor)


def _inverse(a: Vector) -> Vector:
    """Reciprocal of a vector as a complex number: it turns the vector to the first axis and to unit length.

    A link's own numbers do not move: one division serves all places, and all derivatives.
    """
    # a two-point link lies along its first axis: exact
    if is_literal_zero(a[1]):
        return 1.0 / a[0], 0.0
    factor = 1.0 / dot(a, a)
    return a[0] * factor, -(a[1] * factor)


def moved_point(m: Namespace, point: Vector, by: Sequence[Number]) -> Vector:
    """A point moved by its two coordinates."""
    return add(point, (by[0], by[1]))


def moved_pose(m: Namespace, pose: PlanePose, by: Sequence[Number]) -> PlanePose:
    """A pose with its origin moved by two coordinates and turned about it by an angle [rad]."""
    return PlanePose(add(pose.origin, (by[0], by[1])), rotate_vector(pose.rotor, rotor_of(m, by[2])))


def radicand_of_circles(one: PlaneCircle, other: PlaneCircle) -> Number:
    """Number whose root tells where two circles meet.

    It is 16 times the squared area of the triangle, kept factored (Heron), so that it changes sign exactly where
    the triangle opens: ((r1 + r2)^2 - l^2)(l^2 - (r1 - r2)^2).
    """
    line = subtract(other.centre, one.centre)
    # squares of lengths alone: no root is taken before the one that decides
    squared = dot(line, line)
    total, difference = one.radius + other.radius, one.radius - other.radius
    return (total * total - squared) * (squared - difference * difference)


def circles_meet(one: PlaneCircle, other: PlaneCircle, root: Number) -> Vector:
    """Point where two circles meet, to the left of the way from centre to centre for a positive root."""
    line = subtract(other.centre, one.centre)
    # l^2 is divided by once, and both parts of the answer share the quotient
    half = 0.5 / dot(line, line)
    # (l^2 + r1^2 - r2^2) / (2 l^2), with the difference of squares as a product: no digits are lost for equal
    # radii
    ahead = 0.5 + (one.radius + other.radius) * (one.radius - other.radius) * half
    left = root * half
    return (
        one.centre[0] + ahead * line[0] - left * line[1],
        one.centre[1] + ahead * line[1] + left * line[0],
    )


def radicand_of_circle_and_line(one: PlaneCircle, other: Line) -> Number:
    """Number whose root is the way from the foot of the centre: (r - n)(r + n), n the distance of the centre."""
    distance = cross(other.direction, subtract(one.centre, other.through))
    return (one.radius - distance) * (one.radius + distance)


def circle_meets_line(one: PlaneCircle, other: Line, root: Number) -> Vector:
    """Point where a circle meets a line, ahead of the foot of its centre for a positive root."""
    # the foot of the centre on the line, and from there the root either way
    foot = dot(other.direction, subtract(one.centre, other.through))
    return along(other.through, other.direction, foot + root)


def meet_lines(
    through_1: Vector, direction_1: Vector, through_2: Vector, direction_2: Vector, divisor: Root
) -> Vector:
    """Point where two lines meet; `divisor` is given the sine between them, whose zero sends the point to infinity."""
    sine = divisor(cross(direction_1, direction_2))
    return along(through_1, direction_1, cross(subtract(through_2, through_1), direction_2) / sine)


def aim(
    pivot: Vector, at: Vector, through: Vector, direction: Vector, target: Vector, root: Root
) -> PlanePose:
    """Pose of a link with its pivot at a place, whose line passes through a target.

    `pivot`, `through` and `direction` are in the link's axes. A positive root has the target ahead of the
    foot of the pivot on the line. The radicand is w^2 - e^2, w the distance from the pivot to the target, e
    that to the line.
    """
    # the line's distance from the pivot in the link's own axes, with its side
    offset = cross(direction, subtract(through, pivot))
    to_target = subtract(target, at)
    squared = dot(to_target, to_target)
    half = root(squared - offset * offset)
    # the direction of the line as it has to lie: that of the target, turned by the angle whose sine is
    # -offset / w
    line = rotate_vector(to_target, (half / squared, -offset / squared))
    return pose_with_point(pivot, at, rotate_vector(line, reversed_rotor(direction)))


def length_of(m: Namespace, a: Vector) -> Number:
    """Length of a vector; exact for one along the first axis, as the vector of a two-point link is."""
    if is_literal_zero(a[1]):
        return a[0]
    return m.sqrt(dot(a, a))
