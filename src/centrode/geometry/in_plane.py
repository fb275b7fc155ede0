"""The plane as a space: the formulas of `plane`, by the names that structure and motion use."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, inf

from centrode.geometry import plane
from centrode.geometry.intersections import Hold, implied_meeting, meet_circle_and_line, meet_circles
from centrode.geometry.plane import (
    AT_REST,
    Line,
    PlaneCircle,
    PlanePose,
    Vector,
    along,
    cross,
    dot,
    length_of,
    meet_lines,
    pose_with_point,
    reversed_rotor,
    rotate_vector,
    rotor_of,
    subtract,
)
from centrode.geometry.space import Namespace, Number, Reference, Root, Row, Rows, Space

Curve = tuple[Vector, Vector]


class Plane:
    """See `Space`; lengths are in metres, a guide's curve is a line: a point and a unit vector."""

    name = "plane"
    coordinates = ("x", "y")
    axes = ("x", "y")
    unit = "m"
    crosses_once = True
    lacks: frozenset[str] = frozenset()
    at_rest = AT_REST

    def place(self, m: Namespace, pose: PlanePose, local: Vector) -> Vector:
        return plane.place(pose, local)

    def attitude(self, pose: PlanePose) -> Vector:
        return pose.rotor

    def pose_of(self, m: Namespace, attitude: Sequence[Number], local: Vector, at: Vector) -> PlanePose:
        cosine, sine = attitude
        # the origin is not carried along: it follows from the point's place
        return pose_with_point(local, at, (cosine, sine))

    def stretch(self, attitude: Sequence[Number]) -> list[Number]:
        cosine, sine = attitude
        return [cosine * cosine + sine * sine - 1.0]

    def rotor(
        self, m: Namespace, pose: PlanePose, points: Sequence[Vector], towards: Sequence[Vector]
    ) -> Vector:
        return pose.rotor

    def pose_by_two_points(
        self, m: Namespace, first: Vector, second: Vector, at_first: Vector, at_second: Vector
    ) -> PlanePose:
        return plane.pose_by_two_points(first, second, at_first, at_second)

    def pose_at_angle(
        self,
        m: Namespace,
        angle: Number,
        points: Sequence[Vector],
        at: Sequence[Vector | None],
        towards: Sequence[Vector],
    ) -> PlanePose | None:
        for local, place in zip(points, at, strict=True):
            if place is not None:
                return pose_with_point(local, place, rotor_of(m, angle))
        return None

    def turned_pose(
        self, m: Namespace, base: PlanePose, rotor: Vector, pivot: Vector, at: Vector, reference: Reference
    ) -> PlanePose:
        return pose_with_point(pivot, at, rotate_vector(base.rotor, rotor))

    def aim(
        self, m: Namespace, pivot: Vector, at: Vector, curve: Curve, target: Vector, root: Root
    ) -> PlanePose:
        through, direction = curve
        return plane.aim(pivot, at, through, direction, target, root)

    def circle(self, m: Namespace, centre: Vector, first: Vector, second: Vector) -> PlaneCircle:
        # the sign of a two-point link's length depends on which end is known; circles do not feel it
        return PlaneCircle(centre, length_of(m, subtract(second, first)))

    def rail(self, m: Namespace, pose: PlanePose, curve: Curve) -> Line:
        return Line(*_line(pose, curve))

    def stop(self, m: Namespace, pose: PlanePose, curve: Curve, displacement: Number) -> Line:
        direction = rotate_vector(curve[1], pose.rotor)
        return Line(self.place_at_slide(m, pose, curve, displacement), (-direction[1], direction[0]))

    def place_at_slide(self, m: Namespace, pose: PlanePose, curve: Curve, displacement: Number) -> Vector:
        through, direction = _line(pose, curve)
        return along(through, direction, displacement)

    def meet(self, one: PlaneCircle | Line, other: PlaneCircle | Line, root: Root, divisor: Root) -> Vector:
        if isinstance(one, Line):
            assert isinstance(other, Line)  # circles stand first
            return meet_lines(one.through, one.direction, other.through, other.direction, divisor)
        if isinstance(other, PlaneCircle):
            return meet_circles(one, other, root)
        return meet_circle_and_line(one, other, root)

    def directions_at(self, m: Namespace, locus: PlaneCircle | Line, place: Vector) -> tuple[Vector, ...]:
        if isinstance(locus, Line):
            x, y = locus.direction
            return (-y, x), (x, y)
        arm = subtract(place, locus.centre)
        squared = dot(arm, arm)
        # a circle without a radius is square to every direction
        round_ = m.less(0.0, squared)
        scale = m.where(round_, 1.0 / m.sqrt(squared), 0.0)
        x, y = m.where(round_, scale * arm[0], 1.0), scale * arm[1]
        return (x, y), (-y, x)

    def implied_place(
        self,
        one: PlaneCircle | Line,
        other: PlaneCircle | Line,
        place: Vector,
        root: Number,
        hold: Hold,
    ) -> Vector | None:
        return None if isinstance(one, Line) else implied_meeting(one, other, place, root, hold)

    def lack(
        self, m: Namespace, one: PlaneCircle | Line, other: PlaneCircle | Line
    ) -> tuple[float, float, float, float]:
        assert isinstance(one, PlaneCircle)  # two lines always meet, or never
        # a line is never too long: only a too short radius keeps them apart
        if isinstance(other, Line):
            offset = cross(other.direction, subtract(one.centre, other.through))
            return float(abs(offset) - abs(one.radius)), -inf, -inf, -inf
        apart = float(self.distance(m, one.centre, other.centre))
        first, second = abs(float(one.radius)), abs(float(other.radius))
        # in the order of `Space.lack`; in the plane two circles cannot be too long together
        return apart - first - second, first - second - apart, second - first - apart, -inf

    def distance(self, m: Namespace, a: Vector, b: Vector) -> Number:
        x, y = subtract(a, b)
        # hypot is safe against overflow; arrays and nodes have no such function
        return hypot(x, y) if isinstance(x, float) and isinstance(y, float) else m.sqrt(x * x + y * y)

    def leverage(self, m: Namespace, first: Vector, second: Vector) -> Number:
        return self.distance(m, first, second)

    def reach(self, m: Namespace, curve: Curve, at: Vector) -> Number:
        through, direction = curve
        return m.abs(cross(direction, subtract(through, at)))

    def period(self, m: Namespace, curve: Curve) -> None:
        return None

    def slide(self, m: Namespace, point: Vector, pose: PlanePose, curve: Curve) -> Number:
        through, direction = _line(pose, curve)
        return dot(direction, subtract(point, through))

    def in_link(self, m: Namespace, point: Vector, pose: PlanePose, local: Vector) -> list[Number]:
        return list(subtract(point, plane.place(pose, local)))

    def in_link_rows(self, m: Namespace, point: Vector, pose: PlanePose, local: Vector) -> list[Rows]:
        arm = rotate_vector(local, pose.rotor)
        # by the link's turn the point moves by the left normal of the arm (-y, x), and the residual the other
        # way
        return [((1.0, 0.0), (-1.0, 0.0, arm[1])), ((0.0, 1.0), (0.0, -1.0, -arm[0]))]

    def apart(self, m: Namespace, point: Vector, pose: PlanePose, local: Vector) -> list[Number]:
        return self.in_link(m, point, pose, local)

    def on_guide(self, m: Namespace, point: Vector, pose: PlanePose, curve: Curve) -> Number:
        through, direction = _line(pose, curve)
        return cross(direction, subtract(point, through))

    def on_guide_row(self, m: Namespace, point: Vector, pose: PlanePose, curve: Curve) -> Rows:
        direction, arm = rotate_vector(curve[1], pose.rotor), subtract(point, pose.origin)
        # the left normal by the point; by the body its shift with the other sign, and what turning about the
        # origin does
        return (-direction[1], direction[0]), (direction[1], -direction[0], -dot(direction, arm))

    def turn(
        self, m: Namespace, pose: PlanePose, base: PlanePose, rotor: Vector, reference: Reference
    ) -> Number:
        cosine, sine = rotate_vector(pose.rotor, reversed_rotor(rotate_vector(base.rotor, rotor)))
        return m.atan2(sine, cosine)

    def turn_row(self, m: Namespace, pose: PlanePose, base: PlanePose, reference: Reference) -> Rows:
        return (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)

    def slid(
        self, m: Namespace, point: Vector, pose: PlanePose, curve: Curve, displacement: Number
    ) -> Number:
        return self.slide(m, point, pose, curve) - displacement

    def slid_row(self, m: Namespace, point: Vector, pose: PlanePose, curve: Curve) -> Rows:
        direction, arm = rotate_vector(curve[1], pose.rotor), subtract(point, pose.origin)
        # along the direction; the body's turn moves the point of the guide back
        return direction, (-direction[0], -direction[1], cross(direction, arm))

    def moved_point(self, m: Namespace, point: Vector, by: Sequence[Number]) -> Vector:
        return plane.moved_point(m, point, by)

    def moved_pose(self, m: Namespace, pose: PlanePose, by: Sequence[Number]) -> PlanePose:
        return plane.moved_pose(m, pose, by)

    def shifts(self, m: Namespace, at: Vector, scale: Number) -> Sequence[Row]:
        return (scale, 0.0, 0.0), (0.0, scale, 0.0), (0.0, 0.0, 1.0)

    def spin(self, pose: PlanePose, at: Vector) -> Row:
        x, y = subtract(pose.origin, at)
        # turned about a place, the origin moves by the left normal of its way from it
        return -y, x, 1.0

    def normalise(self, m: Namespace, pose: PlanePose) -> PlanePose:
        cosine, sine = pose.rotor
        length = m.sqrt(cosine * cosine + sine * sine)
        return PlanePose(pose.origin, (cosine / length, sine / length))


def _line(pose: PlanePose, curve: Curve) -> Curve:
    """Point and direction of a guide's line as it lies now."""
    through, direction = curve
    return plane.place(pose, through), rotate_vector(direction, pose.rotor)


PLANE: Space = Plane()
