"""Vectors, poses and meeting points in the plane: they keep their promises, and a root's sign is the side named."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from centrode.geometry import plane
from centrode.geometry.intersections import meet_circle_and_line, meet_circles
from centrode.geometry.plane import Line, PlaneCircle, PlanePose, Vector
from centrode.numerics.arrays import ARRAYS

EPS = 2.0**-52
NUMBER = st.floats(-4, 4)
VECTOR = st.tuples(NUMBER, NUMBER)
ANGLE = st.floats(-3.1, 3.1)
SIGN = st.sampled_from([1.0, -1.0])


def rotor(angle: float) -> Vector:
    return plane.rotor_of(math, angle)


def apart(a: Vector, b: Vector) -> float:
    return math.hypot(a[0] - b[0], a[1] - b[1])


def signed(sign: float) -> plane.Root:
    return lambda radicand: sign * math.sqrt(radicand)


@settings(max_examples=40)
@given(VECTOR, VECTOR, ANGLE)
def test_turning_keeps_products(a: Vector, b: Vector, angle: float) -> None:
    r = rotor(angle)
    allowed = 16 * EPS * (1 + math.hypot(*a) * math.hypot(*b))
    assert plane.dot(plane.rotate_vector(a, r), plane.rotate_vector(b, r)) == pytest.approx(
        plane.dot(a, b), abs=allowed
    )
    assert plane.cross(plane.rotate_vector(a, r), plane.rotate_vector(b, r)) == pytest.approx(
        plane.cross(a, b), abs=allowed
    )
    back = plane.rotate_vector(plane.rotate_vector(a, r), plane.reversed_rotor(r))
    assert apart(back, a) <= 8 * EPS * (1 + math.hypot(*a))
    assert plane.cross((1.0, 0.0), (0.0, 1.0)) == 1.0


@settings(max_examples=40)
@given(VECTOR, VECTOR, ANGLE)
def test_poses_put_their_points_where_they_are_told(local: Vector, at: Vector, angle: float) -> None:
    pose = plane.pose_with_point(local, at, rotor(angle))
    assert apart(plane.place(pose, local), at) <= 8 * EPS * (1 + math.hypot(*local) + math.hypot(*at))
    assert plane.place(plane.AT_REST, local) == local


@settings(max_examples=40)
@given(VECTOR, VECTOR, VECTOR, ANGLE)
def test_pose_by_two_points(first: Vector, second: Vector, origin: Vector, angle: float) -> None:
    assume(apart(first, second) > 0.1)
    pose = PlanePose(origin, rotor(angle))
    found = plane.pose_by_two_points(first, second, plane.place(pose, first), plane.place(pose, second))
    # errors of the places over the distance between them, times the greatest arm
    allowed = 64 * EPS * 12 / apart(first, second)
    assert apart(found.rotor, pose.rotor) <= allowed
    assert apart(found.origin, origin) <= allowed * 6


@settings(max_examples=60)
@given(VECTOR, VECTOR, st.floats(0.2, 4), st.floats(0.2, 4), SIGN)
def test_circles_meet(a: Vector, b: Vector, r: float, s: float, sign: float) -> None:
    distance = apart(a, b)
    assume(abs(r - s) + 0.05 < distance < r + s - 0.05)
    p = meet_circles(PlaneCircle(a, r), PlaneCircle(b, s), signed(sign))
    # the height over the line is the root of a radicand known to some eps: eps over the sine of the triangle
    sine = abs(plane.cross(plane.subtract(b, a), plane.subtract(p, a))) / (distance * r)
    allowed = 64 * EPS * 8 / (sine * min(distance, 1.0))
    assert apart(p, a) == pytest.approx(r, abs=allowed)
    assert apart(p, b) == pytest.approx(s, abs=allowed)
    assert sign * plane.cross(plane.subtract(b, a), plane.subtract(p, a)) > 0  # left for a positive root


def test_radicand_of_circles_is_sixteen_squared_areas() -> None:
    found: list[float] = []

    def root(x: float) -> float:
        found.append(x)
        return 0.0

    meet_circles(PlaneCircle((0.0, 0.0), 3.0), PlaneCircle((5.0, 0.0), 4.0), root)
    assert found == [16 * 6.0**2]


@settings(max_examples=60)
@given(VECTOR, st.floats(0.5, 4), VECTOR, ANGLE, SIGN)
def test_circle_and_line_meet(centre: Vector, r: float, through: Vector, angle: float, sign: float) -> None:
    d = rotor(angle)
    distance = plane.cross(d, plane.subtract(centre, through))
    assume(abs(distance) < r - 0.02)
    p = meet_circle_and_line(PlaneCircle(centre, r), Line(through, d), signed(sign))
    half = math.sqrt(r * r - distance * distance)
    allowed = 64 * EPS * 12 * r / half
    assert apart(p, centre) == pytest.approx(r, abs=allowed)
    assert plane.cross(d, plane.subtract(p, through)) == pytest.approx(0.0, abs=allowed)
    foot = plane.along(through, d, plane.dot(d, plane.subtract(centre, through)))
    assert sign * plane.dot(d, plane.subtract(p, foot)) > 0  # ahead of the foot for a positive root


@settings(max_examples=40)
@given(VECTOR, ANGLE, VECTOR, st.floats(0.1, 3.0))
def test_lines_meet(a: Vector, angle: float, b: Vector, between: float) -> None:
    d, e = rotor(angle), rotor(angle + between)
    seen: list[float] = []

    def divisor(x: float) -> float:
        seen.append(x)
        return x

    p = plane.meet_lines(a, d, b, e, divisor)
    sine = math.sin(between)
    assert seen == [pytest.approx(sine, abs=8 * EPS)]
    allowed = 64 * EPS * 12 / sine**2
    assert plane.cross(d, plane.subtract(p, a)) == pytest.approx(0.0, abs=allowed)
    assert plane.cross(e, plane.subtract(p, b)) == pytest.approx(0.0, abs=allowed)


@settings(max_examples=60)
@given(VECTOR, VECTOR, VECTOR, ANGLE, VECTOR, SIGN)
def test_a_link_aims_its_line_at_a_target(
    pivot: Vector, at: Vector, through: Vector, angle: float, target: Vector, sign: float
) -> None:
    d = rotor(angle)
    offset, reach = plane.cross(d, plane.subtract(through, pivot)), apart(target, at)
    assume(reach > abs(offset) + 0.05)
    pose = plane.aim(pivot, at, through, d, target, signed(sign))
    half = math.sqrt(reach**2 - offset**2)
    allowed = 256 * EPS * 12 * reach / half / min(reach, 1.0)
    assert math.hypot(*pose.rotor) == pytest.approx(1.0, abs=allowed)
    assert apart(plane.place(pose, pivot), at) <= allowed
    on_line = plane.subtract(target, plane.place(pose, through))
    direction = plane.rotate_vector(d, pose.rotor)
    assert plane.cross(direction, on_line) == pytest.approx(0.0, abs=allowed * 8)
    assert sign * plane.dot(direction, plane.subtract(target, at)) > 0


def test_lengths() -> None:
    assert plane.length_of(ARRAYS, (0.3, 0.0)) == 0.3
    assert plane.length_of(ARRAYS, (3.0, 4.0)) == 5.0
    np.testing.assert_array_equal(plane.length_of(ARRAYS, (np.array([3.0]), np.array([4.0]))), [5.0])
