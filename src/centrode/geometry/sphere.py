"""Vectors, attitudes and meeting points on the unit sphere, as formulas over any algebra.

A place is a unit vector of three numbers; coordinates are (longitude, latitude) [rad]. An attitude holds the
three axes of a link as they stand in the frame. Arcs enter by sine and cosine of their halves, and places by
their differences, so that small linkages keep their relative accuracy. Where a formula has two answers it
takes the signed root, as the formulas of the plane do.
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

from centrode.geometry.space import Reference, Row, Rows

Number: TypeAlias = Any
Namespace: TypeAlias = Any
Vector: TypeAlias = tuple[Number, Number, Number]
Coordinates: TypeAlias = tuple[Number, Number]
HalfArc: TypeAlias = tuple[Number, Number]
"""Sine and cosine of half an arc."""


class Attitude(NamedTuple):
    """Attitude of a link: its own axes, as unit vectors in those of the frame."""

    x: Vector
    y: Vector
    z: Vector


AT_REST = Attitude((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
"""Attitude of the frame."""


def is_literal(x: Number, value: float) -> bool:
    """Whether a number is this plain float, and no array or jet that happens to have its value."""
    return type(x) is float and x == value


def add(a: Vector, b: Vector) -> Vector:
    """Sum of two vectors."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def subtract(a: Vector, b: Vector) -> Vector:
    """Vector from b to a."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def times(factor: Number, a: Vector) -> Vector:
    """A vector multiplied by a number."""
    return factor * a[0], factor * a[1], factor * a[2]


def dot(a: Vector, b: Vector) -> Number:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Vector product; at place a it points to the left of the way to b, seen from outside."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def linear_combination(*terms: tuple[Number, Vector]) -> Vector:
    """Sum of vectors times factors; factors that are plainly zero or one cost nothing."""
    total: Vector | None = None
    for factor, vector in terms:
        if is_literal(factor, 0.0):
            continue
        term = vector if is_literal(factor, 1.0) else times(factor, vector)
        total = term if total is None else add(total, term)
    return (0.0, 0.0, 0.0) if total is None else total


def unit_vector(m: Namespace, at: Coordinates) -> Vector:
    """Place of (longitude, latitude) [rad]."""
    longitude, latitude = at
    if is_literal(latitude, 0.0):
        # the points of a two-point link lie on its own equator, the first at longitude 0
        if is_literal(longitude, 0.0):
            return 1.0, 0.0, 0.0
        return m.cos(longitude), m.sin(longitude), 0.0
    off_axis = m.cos(latitude)
    return off_axis * m.cos(longitude), off_axis * m.sin(longitude), m.sin(latitude)


def meridian(m: Namespace, at: Coordinates) -> tuple[Vector, Vector]:
    """Unit vectors to the north and to the west of a place: the west is the left of the north."""
    longitude, latitude = at
    cosine, sine = m.cos(longitude), m.sin(longitude)
    lower = m.sin(latitude)
    return (-lower * cosine, -lower * sine, m.cos(latitude)), (sine, -cosine, 0.0)


def vector_in_frame(attitude: Attitude, inside: Vector) -> Vector:
    """Vector of a link's own axes, as it stands in the frame."""
    return linear_combination(*zip(inside, attitude, strict=True))


def tangent(a: Vector, b: Vector) -> Vector:
    """Vector at place a square to it, towards b; its length is the sine of the arc."""
    line = subtract(b, a)
    # b - (a . b) a with a . b = 1 - |b - a|^2 / 2: differences keep the digits of near places
    return add(line, times(0.5 * dot(line, line), a))


def tangent_inside(m: Namespace, first: Coordinates, second: Coordinates) -> Vector:
    """Vector at a link's point, square to it, towards another of its points, in the link's axes (see `tangent`)."""
    if is_literal(first[1], 0.0) and is_literal(second[1], 0.0):
        # on the link's own equator the tangent is known from the difference of longitudes
        sine = m.sin(second[0] - first[0])
        if is_literal(first[0], 0.0):
            return 0.0, sine, 0.0
        return -sine * m.sin(first[0]), sine * m.cos(first[0]), 0.0
    return tangent(unit_vector(m, first), unit_vector(m, second))


def half_arc(m: Namespace, first: Coordinates, second: Coordinates) -> HalfArc:
    """Half the arc between two points of a link; its sign is that of the longitude on a two-point link."""
    # of longitudes on the equator: exact differences, with a sign
    if is_literal(first[1], 0.0) and is_literal(second[1], 0.0):
        half = 0.5 * (second[0] - first[0])
        return m.sin(half), m.cos(half)
    return half_arc_of(m, unit_vector(m, first), unit_vector(m, second))


def half_arc_of(m: Namespace, a: Vector, b: Vector) -> HalfArc:
    # |a - b| and |a + b| are twice the sine and cosine of half the arc, exact for small arcs and for nearly
    # opposite places
    """Half the arc between two places."""
    apart, together = subtract(a, b), add(a, b)
    return 0.5 * m.sqrt(dot(apart, apart)), 0.5 * m.sqrt(dot(together, together))


def arc(m: Namespace, a: Vector, b: Vector) -> Number:
    """Arc between two places [rad], in [0, pi]."""
    sine, cosine = half_arc_of(m, a, b)
    return 2.0 * m.atan2(sine, cosine)


def attitude_on(inside: Vector, along: Vector, at: Vector, towards: Vector, squared: Number) -> Attitude:
    """Attitude that brings a link's own place `inside` to `at` and its own tangent `along` there to `towards`.

    `squared` is the product of the two tangents' lengths.
    """
    left = cross(at, towards)
    # of a two-point link only two terms of the nine are left
    left_inside = (0.0, -along[2], along[1]) if is_literal(inside[0], 1.0) else cross(inside, along)
    # the link's own orthogonal triple, carried over to where it lies; only the tangents have lengths to divide by

    def axis(k: int) -> Vector:
        return linear_combination(
            (inside[k], at), (_ratio(along[k], squared), towards), (_ratio(left_inside[k], squared), left)
        )

    return Attitude(axis(0), axis(1), axis(2))


def _ratio(a: Number, b: Number) -> Number:
    return a if is_literal(a, 0.0) else a / b


def attitude_by_two_points(
    m: Namespace, first: Coordinates, second: Coordinates, at_first: Vector, at_second: Vector
) -> Attitude:
    """Attitude of a link from the places of two of its points.

    Its axes are unit vectors as far as the places keep the link's own arc; the residual of a motion contains
    their lengths, so an arc that does not fit shows.
    """
    along = tangent_inside(m, first, second)
    towards = tangent(at_first, at_second)
    return attitude_on(unit_vector(m, first), along, at_first, towards, dot(along, along))


def rotate_tangent(m: Namespace, at: Vector, towards: Vector, rotor: tuple[Number, Number]) -> Vector:
    """Tangent at a place turned by a rotor (cos, sin), counter-clockwise seen from outside."""
    return linear_combination((rotor[0], towards), (rotor[1], cross(at, towards)))


def radicand_of_circles(centre_1: Vector, half_1: HalfArc, centre_2: Vector, half_2: HalfArc) -> Number:
    """Number whose root tells where two circles meet, given by their centres and half their arcs.

    With h the squared sine of half the arc between the centres, it is 4 (h - sin((r1 - r2)/2)^2)(sin((r1 + r2)/2)^2
    - h), the square of the triple product of the three places, kept factored, so that it changes sign exactly where
    the triangle opens.
    """
    h, total, difference = _triangle(centre_1, half_1, centre_2, half_2)
    return 4.0 * (h - difference * difference) * (total * total - h)


def circles_meet(
    centre_1: Vector, half_1: HalfArc, centre_2: Vector, half_2: HalfArc, root: Number
) -> Vector:
    """Place where two circles meet, to the left of the arc centre_1 -> centre_2 for a positive root."""
    line = subtract(centre_2, centre_1)
    h, total, difference = _triangle(centre_1, half_1, centre_2, half_2)
    # the squared sine of the whole arc, 4 h (1 - h)
    squared = 4.0 * h * (1.0 - h)
    # 1 - cos r1, so that the place is the first centre and small parts
    lowered = 2.0 * half_1[0] * half_1[0]
    factor = 1.0 / squared
    ahead = 2.0 * (total * difference + h - lowered * h) * factor
    left = root * factor
    return linear_combination(
        (1.0 + (2.0 * h * ahead - lowered), centre_1), (ahead, line), (left, cross(centre_1, line))
    )


def _triangle(
    centre_1: Vector, half_1: HalfArc, centre_2: Vector, half_2: HalfArc
) -> tuple[Number, Number, Number]:
    """Squared sine of half the arc between the centres, sines of half the sum and the difference of the radii."""
    line = subtract(centre_2, centre_1)
    # sin((r1 + r2)/2) and sin((r1 - r2)/2) by the sums of angles
    one, other = half_1[0] * half_2[1], half_1[1] * half_2[0]
    return 0.25 * dot(line, line), one + other, one - other


def place_on_circle(m: Namespace, pole: Coordinates, radius: Number, angle: Number) -> Vector:
    """Place on a circle about a pole at an angle from the north, counter-clockwise seen from outside."""
    north, west = meridian(m, pole)
    sine = m.sin(radius)
    return linear_combination(
        (m.cos(radius), unit_vector(m, pole)), (sine * m.cos(angle), north), (sine * m.sin(angle), west)
    )


def basis(m: Namespace, at: Vector) -> tuple[Vector, Vector]:
    """Two unit vectors square to a place and to each other, a function of the place alone.

    Duff and others, Building an orthonormal basis, revisited (Journal of Computer Graphics Techniques 6, 2017).
    """
    x, y, z = at
    side = m.sign(m.sign(z) + 0.5)  # zero counts as positive
    a = -1.0 / (side + z)
    b = x * y * a
    return (1.0 + side * x * x * a, side * b, -side * x), (b, side + y * y * a, -y)


def rotate_by_cayley(vector: Vector, half: Vector) -> Vector:
    """A vector turned by Cayley's rotation: about `half`, by twice the arc tangent of its length."""
    once = cross(half, vector)
    # v + 2 (h x v + h x (h x v)) / (1 + h h)
    return add(vector, times(2.0 / (1.0 + dot(half, half)), add(once, cross(half, once))))


# Measures of the sphere and their gradients, by the coordinates of points and links.
#
# A gradient is a vector at a place; what depends on the place of a point in the axes of a link alone changes
# by the same gradient when the link turns.

FAINT = 1e-30
"""Far below rounding: it makes a place opposite to the right one infinitely wrong instead of undetermined."""


def arms(m: Namespace, pose: Attitude, base: Attitude, reference: Reference) -> tuple[Vector, Vector, Vector]:
    """The link's own tangent, that of the reference arc, and the place of that arc's first point."""
    first, second, base_first, base_second = require_reference(reference)
    return (
        vector_in_frame(pose, tangent_inside(m, first, second)),
        vector_in_frame(base, tangent_inside(m, base_first, base_second)),
        vector_in_frame(base, unit_vector(m, base_first)),
    )


def require_reference(reference: Reference) -> tuple[Coordinates, ...]:
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


def angle_gradient(arm: Vector, zero: Vector, axis: Vector) -> Vector:
    """Gradient of the angle from the tangent `zero` to `arm` about `axis`, by the rotation vector of the arm."""
    left = cross(axis, zero)
    # angle = atan2(sine, cosine): its gradient by the rotation of the arm is that of both products
    cosine, sine = dot(arm, zero), dot(arm, left)
    across = cross(arm, subtract(times(cosine, left), times(sine, zero)))
    return times(1.0 / (cosine * cosine + sine * sine), across)


def chart(m: Namespace, pose: Attitude, local: Coordinates) -> tuple[Vector, Vector, Vector]:
    """Place of a link's point and two unit vectors square to it that are fixed in the link."""
    inside = unit_vector(m, local)
    first, second = basis(m, inside)
    return vector_in_frame(pose, inside), vector_in_frame(pose, first), vector_in_frame(pose, second)


def nearness(point: Vector, at: Vector) -> Number:
    """Squared cosine of half the arc between two places."""
    together = add(point, at)
    # below rounding: the quotient is never 0/0
    return 0.25 * dot(together, together) + FAINT * FAINT


def stereographic(m: Namespace, point: Vector, pose: Attitude, local: Coordinates) -> list[Number]:
    """Coordinates of a point about a link's point, projected from opposite to it: opposite is infinitely far."""
    at, first, second = chart(m, pose, local)
    apart, near = subtract(point, at), nearness(point, at)
    # the faint part decides the sign where the point is exactly opposite
    return [(dot(first, apart) + FAINT * dot(apart, apart)) / near, dot(second, apart) / near]


def stereographic_slopes(m: Namespace, point: Vector, pose: Attitude, local: Coordinates) -> list[Vector]:
    """Gradients of the two coordinates of `stereographic`, as vectors at the point."""
    at, *axes = chart(m, pose, local)
    near = nearness(point, at)
    # gradients of the quotient, with |point + at|^2 in the denominator
    return [times(1.0 / near, subtract(axis, times(0.5 * dot(axis, point) / near, at))) for axis in axes]


def azimuth(
    m: Namespace, point: Vector, pose: Attitude, pole: Coordinates
) -> tuple[Number, Number, Vector, Vector]:
    """Components of a point to the north and to the west of a pole that a link carries, and both unit vectors."""
    north, west = (vector_in_frame(pose, axis) for axis in meridian(m, pole))
    return dot(point, north), dot(point, west), north, west


def away(m: Namespace, point: Vector, pole: Vector) -> Vector:
    """Gradient at a point of its arc from a pole: the unit vector away from it."""
    towards = tangent(point, pole)
    # the tangent towards the pole, of unit length, reversed
    return times(-1.0 / length(m, towards), towards)


def of_point(m: Namespace, point: Vector, slope: Vector) -> Row:
    """A gradient by the coordinates of the point."""
    first, second = basis(m, point)
    return dot(slope, first), dot(slope, second)


def of_both(m: Namespace, point: Vector, slope: Vector) -> Rows:
    """A gradient by the coordinates of the point and of the link."""
    # turning the link moves the point the other way in its axes: the moment of the gradient
    return of_point(m, point, slope), cross(slope, point)
