"""The unit sphere as a space: the formulas of `sphere`, by the names that structure and motion use."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, tau
from typing import NamedTuple

from centrode.geometry import sphere
from centrode.geometry.intersections import Hold, implied_meeting_on_sphere, meet_circles_on_sphere
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
    dot,
    linear_combination,
    subtract,
    tangent,
    tangent_inside,
    times,
    unit_vector,
    vector_in_frame,
)

Curve = tuple[Coordinates, tuple[Number]]


class SphereCircle(NamedTuple):
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
    lacks = frozenset({"rolling", "distance", "guided links"})
    at_rest = AT_REST

    def place(self, m: Namespace, pose: Attitude, local: Coordinates) -> Vector:
        return vector_in_frame(pose, unit_vector(m, local))

    def attitude(self, pose: Attitude) -> tuple[Number, ...]:
        return (*pose.x, *pose.y, *pose.z)

    def pose_of(self, m: Namespace, attitude: Sequence[Number], local: Coordinates, at: Vector) -> Attitude:
        x, y, z = ((attitude[k], attitude[k + 1], attitude[k + 2]) for k in (0, 3, 6))
        return Attitude(x, y, z)

    def stretch(self, attitude: Sequence[Number]) -> list[Number]:
        x, y, z = self.pose_of(None, attitude, (0.0, 0.0), AT_REST.x)
        return [
            *(dot(axis, axis) - 1.0 for axis in (x, y, z)),
            # unit length and right angles: six numbers say that nine are axes of a link
            *(dot(one, other) for one, other in ((x, y), (y, z), (z, x))),
        ]

    def rotor(
        self, m: Namespace, pose: Attitude, points: Sequence[Coordinates], towards: Sequence[Vector]
    ) -> tuple[Number, Number]:
        first, second = points[:2]
        pivot, along = self.place(m, pose, first), tangent_inside(m, first, second)
        zero = tangent(pivot, towards[0])
        cosine, sine = sphere.components(vector_in_frame(pose, along), zero, pivot)
        # the arm's length is a dimension: a link that does not fit has no unit rotor, as in the plane
        factor = 1.0 / (sphere.length(m, along) * sphere.length(m, zero))
        return cosine * factor, sine * factor

    def pose_by_two_points(
        self, m: Namespace, first: Coordinates, second: Coordinates, at_first: Vector, at_second: Vector
    ) -> Attitude:
        return sphere.attitude_by_two_points(m, first, second, at_first, at_second)

    def pose_at_angle(
        self,
        m: Namespace,
        angle: Number,
        points: Sequence[Coordinates],
        at: Sequence[Vector | None],
        towards: Sequence[Vector],
    ) -> Attitude | None:
        if at[0] is None or not towards:
            return None
        first, second = points[:2]
        along = tangent_inside(m, first, second)
        zero = sphere.unit(m, tangent(at[0], towards[0]))
        arm = sphere.rotate_tangent(m, at[0], zero, (m.cos(angle), m.sin(angle)))
        return attitude_on(unit_vector(m, first), along, at[0], arm, sphere.length(m, along))

    def turned_pose(
        self,
        m: Namespace,
        base: Attitude,
        rotor: tuple[Number, Number],
        pivot: Coordinates,
        at: Vector,
        reference: Reference,
    ) -> Attitude:
        first, second, base_first, base_second = sphere.require_reference(reference)
        # the arm of the reference is a dimension: so a link that does not fit is stretched, and tells
        length = sphere.length(m, tangent_inside(m, base_first, base_second))
        # the length of the given arc, not of the one found: what does not fit is seen in the residual
        towards = sphere.rotate_tangent(m, at, tangent(at, self.place(m, base, base_second)), rotor)
        along = tangent_inside(m, first, second)
        return attitude_on(unit_vector(m, first), along, at, towards, length * sphere.length(m, along))

    def aim(
        self, m: Namespace, pivot: Coordinates, at: Vector, curve: Curve, target: Vector, root: Root
    ) -> Attitude:
        pole, (radius,) = curve
        around_pivot = sphere.half_arc(m, pivot, pole)
        # the pole lies on a circle about the pivot and, as the target is on the guide, on one about the
        # target
        at_pole = meet_circles_on_sphere(at, around_pivot, target, sphere.half(m, radius), root)
        return sphere.attitude_by_two_points(m, pivot, pole, at, at_pole)

    def circle(self, m: Namespace, centre: Vector, first: Coordinates, second: Coordinates) -> SphereCircle:
        return SphereCircle(centre, sphere.half_arc(m, first, second))

    def rail(self, m: Namespace, pose: Attitude, curve: Curve) -> SphereCircle:
        pole, (radius,) = curve
        return SphereCircle(self.place(m, pose, pole), sphere.half(m, radius))

    def stop(self, m: Namespace, pose: Attitude, curve: Curve, displacement: Number) -> SphereCircle:
        # a circle of no arc: a place
        return SphereCircle(self.place_at_slide(m, pose, curve, displacement), (0.0, 1.0))

    def place_at_slide(self, m: Namespace, pose: Attitude, curve: Curve, displacement: Number) -> Vector:
        pole, (radius,) = curve
        # a displacement is an arc along the circle: over the sine of its radius it is the angle about the
        # pole
        inside = sphere.place_on_circle(m, pole, radius, displacement / m.sin(radius))
        return vector_in_frame(pose, inside)

    def meet(self, one: SphereCircle, other: SphereCircle, root: Root, divisor: Root) -> Vector:
        for locus in (one, other):
            if sphere.is_literal(locus.half[0], 0.0):
                return locus.centre  # a stop is a place already
        return meet_circles_on_sphere(one.centre, one.half, other.centre, other.half, root)

    def directions_at(self, m: Namespace, locus: SphereCircle, place: Vector) -> tuple[Vector, ...]:
        out = tangent(place, locus.centre)
        squared = dot(out, out)
        # about its own place, or the opposite one, a circle is square to every direction
        first, second = basis(m, place)
        scale = m.where(m.less(0.0, squared), 1.0 / m.sqrt(squared), 0.0)
        x, y = scale * dot(out, first), scale * dot(out, second)
        x = m.where(m.less(0.0, squared), x, 1.0)
        # the place itself is square to both: along it lies what rounding does to its unit length
        return (
            linear_combination((x, first), (y, second)),
            linear_combination((-y, first), (x, second)),
            place,
        )

    def implied_place(
        self,
        one: SphereCircle,
        other: SphereCircle,
        place: Vector,
        root: Number,
        hold: Hold,
    ) -> Vector | None:
        if any(sphere.is_literal(locus.half[0], 0.0) for locus in (one, other)):
            return None
        return implied_meeting_on_sphere((one, other), place, root, hold)

    def lack(self, m: Namespace, one: SphereCircle, other: SphereCircle) -> tuple[float, float, float, float]:
        apart = float(self.distance(m, one.centre, other.centre))
        # the arc from its half: both signs of a half arc are one circle
        first, second = (2.0 * atan2(abs(float(half[0])), float(half[1])) for half in (one.half, other.half))
        # circles that reach around the sphere from the other side miss each other too
        around = first + second + apart - tau
        return apart - first - second, first - second - apart, second - first - apart, around

    def distance(self, m: Namespace, a: Vector, b: Vector) -> Number:
        return sphere.arc(m, a, b)

    def leverage(self, m: Namespace, first: Coordinates, second: Coordinates) -> Number:
        return sphere.length(m, tangent_inside(m, first, second))

    def reach(self, m: Namespace, curve: Curve, at: Vector) -> Number:
        pole, (radius,) = curve
        return m.abs(sphere.arc(m, unit_vector(m, pole), at) - radius)

    def period(self, m: Namespace, curve: Curve) -> Number:
        # the length of a circle of that arc
        return tau * m.sin(curve[1][0])

    def slide(self, m: Namespace, point: Vector, pose: Attitude, curve: Curve) -> Number:
        return self.slid(m, point, pose, curve, 0.0)

    def in_link(self, m: Namespace, point: Vector, pose: Attitude, local: Coordinates) -> list[Number]:
        return sphere.stereographic(m, point, pose, local)

    def in_link_rows(self, m: Namespace, point: Vector, pose: Attitude, local: Coordinates) -> list[Rows]:
        gradients = sphere.stereographic_slopes(m, point, pose, local)
        return [sphere.of_both(m, point, gradient) for gradient in gradients]

    def apart(self, m: Namespace, point: Vector, pose: Attitude, local: Coordinates) -> list[Number]:
        return list(subtract(point, self.place(m, pose, local)))

    def on_guide(self, m: Namespace, point: Vector, pose: Attitude, curve: Curve) -> Number:
        pole, (radius,) = curve
        return sphere.arc(m, self.place(m, pose, pole), point) - radius

    def on_guide_row(self, m: Namespace, point: Vector, pose: Attitude, curve: Curve) -> Rows:
        return sphere.of_both(m, point, sphere.away(m, point, self.place(m, pose, curve[0])))

    def turn(
        self, m: Namespace, pose: Attitude, base: Attitude, rotor: tuple[Number, Number], reference: Reference
    ) -> Number:
        cosine, sine = sphere.components(*sphere.arms(m, pose, base, reference))
        # the angle's rotor turned back by the given one: its arc tangent is zero where both agree
        return m.atan2(sine * rotor[0] - cosine * rotor[1], cosine * rotor[0] + sine * rotor[1])

    def turn_row(self, m: Namespace, pose: Attitude, base: Attitude, reference: Reference) -> Rows:
        slope = sphere.angle_gradient(*sphere.arms(m, pose, base, reference))
        return slope, times(-1.0, slope)

    def slid(self, m: Namespace, point: Vector, pose: Attitude, curve: Curve, displacement: Number) -> Number:
        pole, (radius,) = curve
        ahead, left, _north, _west = sphere.azimuth(m, point, pose, pole)
        sine = m.sin(radius)
        if sphere.is_literal(displacement, 0.0):
            return sine * m.atan2(left, ahead)
        cosine, turned = m.cos(displacement / sine), m.sin(displacement / sine)
        return sine * m.atan2(left * cosine - ahead * turned, ahead * cosine + left * turned)

    def slid_row(self, m: Namespace, point: Vector, pose: Attitude, curve: Curve) -> Rows:
        pole, (radius,) = curve
        ahead, left, north, west = sphere.azimuth(m, point, pose, pole)
        # d atan2(left, ahead) = (ahead d left - left d ahead) / (ahead^2 + left^2)
        factor = m.sin(radius) / (ahead * ahead + left * left)
        return sphere.of_both(m, point, times(factor, subtract(times(ahead, west), times(left, north))))

    def moved_point(self, m: Namespace, point: Vector, by: Sequence[Number]) -> Vector:
        # along both tangents and back onto the sphere: to first order a shift by these arcs
        first, second = basis(m, point)
        moved = add(point, linear_combination((by[0], first), (by[1], second)))
        return times(1.0 / m.sqrt(dot(moved, moved)), moved)

    def moved_pose(self, m: Namespace, pose: Attitude, by: Sequence[Number]) -> Attitude:
        # Cayley's rotation about half the vector agrees with the rotation to second order, and is rational
        half = (0.5 * by[0], 0.5 * by[1], 0.5 * by[2])
        x, y, z = (sphere.rotate_by_cayley(axis, half) for axis in pose)
        return Attitude(x, y, z)

    def shifts(self, m: Namespace, at: Vector, scale: Number) -> Sequence[Row]:
        first, second = basis(m, at)
        return times(scale, first), times(scale, second), at

    def spin(self, pose: Attitude, at: Vector) -> Row:
        return at

    def normalise(self, m: Namespace, pose: Attitude) -> Attitude:
        # Gram and Schmidt with the first axis kept; the third follows
        x = times(1.0 / m.sqrt(dot(pose.x, pose.x)), pose.x)
        across = subtract(pose.y, times(dot(x, pose.y), x))
        y = times(1.0 / m.sqrt(dot(across, across)), across)
        return Attitude(x, y, sphere.cross(x, y))


SPHERE: Space = Sphere()
