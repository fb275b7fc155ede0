"""The unit sphere as a space: the formulas of `sphere`, by the names that structure and motion use."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, tau
from typing import NamedTuple

from centrode.geometry import sphere
from centrode.geometry.space import Namespace, Number, Reference, Root, Row, Rows, Space
from centrode.geometry.sphere import (
    AT_REST,
    Attitude,
    Coordinates,
    HalfArc,
    Vector,
    add,
    attitude_on,
    basis,
    carried,
    combined,
    cross,
    dot,
    meridian,
    subtract,
    tangent,
    tangent_inside,
    times,
    unit_vector,
)

Curve = tuple[Coordinates, tuple[Number]]
FAINT = 1e-30
"""Far below rounding: it makes a place opposite to the right one infinitely wrong instead of undetermined."""


class Circle(NamedTuple):
    """Locus of an unknown place: a circle about a centre, given by half its arc."""

    centre: Vector
    half: HalfArc


class Sphere:
    """See `Space`; lengths are arcs [rad], a guide's curve is a circle: its pole and (its arc,)."""

    name = "sphere"
    coordinates = ("longitude", "latitude")
    axes = ("x", "y", "z")
    unit = "rad"
    crosses_once = False
    lacks = frozenset({"gears", "rolling", "distance", "guided links"})
    at_rest = AT_REST

    def place(self, m: Namespace, pose: Attitude, local: Coordinates) -> Vector:
        return carried(pose, unit_vector(m, local))

    def attitude(self, pose: Attitude) -> tuple[Number, ...]:
        return (*pose.x, *pose.y, *pose.z)

    def pose_of(self, m: Namespace, attitude: Sequence[Number], local: Coordinates, at: Vector) -> Attitude:
        x, y, z = ((attitude[k], attitude[k + 1], attitude[k + 2]) for k in (0, 3, 6))
        return Attitude(x, y, z)

    def stretch(self, attitude: Sequence[Number]) -> list[Number]:
        x, y, z = self.pose_of(None, attitude, (0.0, 0.0), AT_REST.x)
        return [
            *(dot(axis, axis) - 1.0 for axis in (x, y, z)),
            *(dot(one, other) for one, other in ((x, y), (y, z), (z, x))),
        ]

    def rotor(self, m: Namespace, pose: Attitude, ends: Sequence[Vector]) -> tuple[Number, Number]:
        pivot, reference, second = ends
        return _unit(m, _components(tangent(pivot, second), tangent(pivot, reference), pivot))

    def pose_by_two_points(
        self, m: Namespace, first: Coordinates, second: Coordinates, at_first: Vector, at_second: Vector
    ) -> Attitude:
        return sphere.attitude_by_two_points(m, first, second, at_first, at_second)

    def turned_pose(
        self,
        m: Namespace,
        base: Attitude,
        rotor: tuple[Number, Number],
        pivot: Coordinates,
        at: Vector,
        reference: Reference,
    ) -> Attitude:
        first, second, base_first, base_second = _given(reference)
        # the arm of the reference is a dimension: so a link that does not fit is stretched, and tells
        length = _length(m, tangent_inside(m, base_first, base_second))
        towards = sphere.turned(m, at, tangent(at, self.place(m, base, base_second)), rotor)
        along = tangent_inside(m, first, second)
        return attitude_on(unit_vector(m, first), along, at, towards, length * _length(m, along))

    def aim(
        self, m: Namespace, pivot: Coordinates, at: Vector, curve: Curve, target: Vector, root: Root
    ) -> Attitude:
        pole, (radius,) = curve
        around_pivot = sphere.half_arc(m, pivot, pole)
        at_pole = sphere.meet_circles(at, around_pivot, target, _half(m, radius), root)
        return sphere.attitude_by_two_points(m, pivot, pole, at, at_pole)

    def circle(self, m: Namespace, centre: Vector, first: Coordinates, second: Coordinates) -> Circle:
        return Circle(centre, sphere.half_arc(m, first, second))

    def rail(self, m: Namespace, pose: Attitude, curve: Curve) -> Circle:
        pole, (radius,) = curve
        return Circle(self.place(m, pose, pole), _half(m, radius))

    def stop(self, m: Namespace, pose: Attitude, curve: Curve, displacement: Number) -> Circle:
        pole, (radius,) = curve
        inside = sphere.place_on_circle(m, pole, radius, displacement / m.sin(radius))
        return Circle(carried(pose, inside), (0.0, 1.0))

    def meet(self, one: Circle, other: Circle, root: Root, divisor: Root) -> Vector:
        for locus in (one, other):
            if sphere.is_literal(locus.half[0], 0.0):
                return locus.centre  # a stop is a place already
        return sphere.meet_circles(one.centre, one.half, other.centre, other.half, root)

    def lack(self, m: Namespace, one: Circle, other: Circle) -> tuple[float, float, float, float]:
        apart = float(self.distance(m, one.centre, other.centre))
        first, second = (2.0 * atan2(abs(float(half[0])), float(half[1])) for half in (one.half, other.half))
        around = first + second + apart - tau
        return apart - first - second, first - second - apart, second - first - apart, around

    def distance(self, m: Namespace, a: Vector, b: Vector) -> Number:
        return sphere.arc(m, a, b)

    def distance_row(self, m: Namespace, a: Vector, b: Vector) -> Rows:
        return _of_point(m, a, _away(m, a, b)), _of_point(m, b, _away(m, b, a))

    def leverage(self, m: Namespace, first: Coordinates, second: Coordinates) -> Number:
        return _length(m, tangent_inside(m, first, second))

    def reach(self, m: Namespace, curve: Curve, at: Vector) -> Number:
        pole, (radius,) = curve
        return m.abs(sphere.arc(m, unit_vector(m, pole), at) - radius)

    def slide(self, m: Namespace, point: Vector, pose: Attitude, curve: Curve) -> Number:
        return self.slid(m, point, pose, curve, 0.0)

    def in_link(self, m: Namespace, point: Vector, pose: Attitude, local: Coordinates) -> list[Number]:
        # stereographic coordinates of the point, seen from opposite to where it ought to be
        at, first, second = _chart(m, pose, local)
        apart, together = subtract(point, at), add(point, at)
        near = 0.25 * dot(together, together) + FAINT * FAINT
        return [(dot(first, apart) + FAINT * dot(apart, apart)) / near, dot(second, apart) / near]

    def in_link_rows(self, m: Namespace, point: Vector, pose: Attitude, local: Coordinates) -> list[Rows]:
        at, first, second = _chart(m, pose, local)
        together = add(point, at)
        near = 0.25 * dot(together, together) + FAINT * FAINT
        slopes = (
            times(1.0 / near, subtract(axis, times(0.5 * dot(axis, point) / near, at)))
            for axis in (first, second)
        )
        return [_of_both(m, point, slope) for slope in slopes]

    def on_guide(self, m: Namespace, point: Vector, pose: Attitude, curve: Curve) -> Number:
        pole, (radius,) = curve
        return sphere.arc(m, self.place(m, pose, pole), point) - radius

    def on_guide_row(self, m: Namespace, point: Vector, pose: Attitude, curve: Curve) -> Rows:
        return _of_both(m, point, _away(m, point, self.place(m, pose, curve[0])))

    def turn(
        self, m: Namespace, pose: Attitude, base: Attitude, rotor: tuple[Number, Number], reference: Reference
    ) -> Number:
        arm, zero, axis = _arms(m, pose, base, reference)
        cosine, sine = _components(arm, zero, axis)
        return m.atan2(sine * rotor[0] - cosine * rotor[1], cosine * rotor[0] + sine * rotor[1])

    def turn_row(self, m: Namespace, pose: Attitude, base: Attitude, reference: Reference) -> Rows:
        arm, zero, axis = _arms(m, pose, base, reference)
        left = cross(axis, zero)
        cosine, sine = dot(arm, zero), dot(arm, left)
        slope = times(
            1.0 / (cosine * cosine + sine * sine),
            cross(arm, subtract(times(cosine, left), times(sine, zero))),
        )
        return slope, times(-1.0, slope)

    def slid(self, m: Namespace, point: Vector, pose: Attitude, curve: Curve, displacement: Number) -> Number:
        pole, (radius,) = curve
        north, west = (carried(pose, axis) for axis in meridian(m, pole))
        sine, ahead, left = m.sin(radius), dot(point, north), dot(point, west)
        if sphere.is_literal(displacement, 0.0):
            return sine * m.atan2(left, ahead)
        cosine, turned = m.cos(displacement / sine), m.sin(displacement / sine)
        return sine * m.atan2(left * cosine - ahead * turned, ahead * cosine + left * turned)

    def slid_row(self, m: Namespace, point: Vector, pose: Attitude, curve: Curve) -> Rows:
        pole, (radius,) = curve
        north, west = (carried(pose, axis) for axis in meridian(m, pole))
        ahead, left = dot(point, north), dot(point, west)
        factor = m.sin(radius) / (ahead * ahead + left * left)
        return _of_both(m, point, times(factor, subtract(times(ahead, west), times(left, north))))

    def moved_point(self, m: Namespace, point: Vector, by: Sequence[Number]) -> Vector:
        first, second = basis(m, point)
        moved = add(point, combined((by[0], first), (by[1], second)))
        return times(1.0 / m.sqrt(dot(moved, moved)), moved)

    def moved_pose(self, m: Namespace, pose: Attitude, by: Sequence[Number]) -> Attitude:
        half = (0.5 * by[0], 0.5 * by[1], 0.5 * by[2])
        x, y, z = (sphere.rotated(axis, half) for axis in pose)
        return Attitude(x, y, z)

    def shifts(self, m: Namespace, at: Vector, scale: Number) -> Sequence[Row]:
        first, second = basis(m, at)
        return times(scale, first), times(scale, second), at


def _half(m: Namespace, arc: Number) -> HalfArc:
    return m.sin(0.5 * arc), m.cos(0.5 * arc)


def _length(m: Namespace, v: Vector) -> Number:
    return m.sqrt(dot(v, v))


def _given(reference: Reference) -> tuple[Coordinates, ...]:
    if reference is None:
        raise ValueError("an angle on the sphere is measured from a reference arc")
    return reference


def _components(arm: Vector, zero: Vector, axis: Vector) -> tuple[Number, Number]:
    """Cosine and sine, times a common factor, of the angle from one tangent to another, about their place."""
    return dot(arm, zero), dot(arm, cross(axis, zero))


def _unit(m: Namespace, v: tuple[Number, Number]) -> tuple[Number, Number]:
    length = m.sqrt(v[0] * v[0] + v[1] * v[1])
    return v[0] / length, v[1] / length


def _arms(
    m: Namespace, pose: Attitude, base: Attitude, reference: Reference
) -> tuple[Vector, Vector, Vector]:
    """The link's own tangent, that of the reference arc, and the place of that arc's first point."""
    first, second, base_first, base_second = _given(reference)
    return (
        carried(pose, tangent_inside(m, first, second)),
        carried(base, tangent_inside(m, base_first, base_second)),
        carried(base, unit_vector(m, base_first)),
    )


def _chart(m: Namespace, pose: Attitude, local: Coordinates) -> tuple[Vector, Vector, Vector]:
    """Place of a link's point and two unit vectors square to it that are fixed in the link."""
    inside = unit_vector(m, local)
    first, second = basis(m, inside)
    return carried(pose, inside), carried(pose, first), carried(pose, second)


def _away(m: Namespace, point: Vector, pole: Vector) -> Vector:
    """Gradient at a point of its arc from a pole: the unit vector away from it."""
    towards = tangent(point, pole)
    return times(-1.0 / m.sqrt(dot(towards, towards)), towards)


def _of_point(m: Namespace, point: Vector, slope: Vector) -> Row:
    first, second = basis(m, point)
    return dot(slope, first), dot(slope, second)


def _of_both(m: Namespace, point: Vector, slope: Vector) -> Rows:
    """Derivatives by a point and by a link, of what depends on the point's place in the link's axes alone."""
    return _of_point(m, point, slope), cross(slope, point)


SPHERE: Space = Sphere()
