"""Places, attitudes and meeting places on the sphere: they keep their promises, and a root's sign is the side named."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mpmath import mp

from centrode.geometry import sphere
from centrode.geometry.intersections import meet_circles_on_sphere
from centrode.geometry.on_sphere import SPHERE
from centrode.geometry.sphere import Attitude, Coordinates, HalfArc, Vector
from centrode.numerics.arrays import ARRAYS

EPS = 2.0**-52
PLACE = st.tuples(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5))
ANGLE = st.floats(-3.1, 3.1)
ARC = st.floats(0.1, 3.0)
SIGN = st.sampled_from([1.0, -1.0])


def unit(at: Coordinates) -> Vector:
    return sphere.unit_vector(ARRAYS, at)


def arc(a: Vector, b: Vector) -> float:
    return float(sphere.arc(ARRAYS, a, b))


def half(arc: float) -> HalfArc:
    return math.sin(arc / 2), math.cos(arc / 2)


def apart(a: Vector, b: Vector) -> float:
    return math.dist(a, b)


def triple(a: Vector, b: Vector, c: Vector) -> float:
    return float(sphere.dot(sphere.cross(a, b), c))


def signed(sign: float) -> sphere.Root:
    return lambda radicand: sign * math.sqrt(radicand)


def an_attitude(pole: Coordinates, angle: float) -> Attitude:
    """Any attitude: the first axis at a place, turned about it."""
    x = unit(pole)
    north, _west = sphere.meridian(ARRAYS, pole)
    y = sphere.rotate_tangent(ARRAYS, x, north, (math.cos(angle), math.sin(angle)))
    return Attitude(x, y, sphere.cross(x, y))


def test_coordinates() -> None:
    assert unit((0.0, 0.0)) == (1.0, 0.0, 0.0)
    assert unit((0.5, 0.0)) == (math.cos(0.5), math.sin(0.5), 0.0)
    assert apart(unit((0.7, math.pi / 2)), (0.0, 0.0, 1.0)) <= EPS
    for at in ((0.0, 0.0), (0.4, -1.1), (-2.0, 0.3)):
        north, west = sphere.meridian(ARRAYS, at)
        further = (at[0], at[1] + 1e-3)
        assert sphere.dot(north, unit(further)) == pytest.approx(math.sin(1e-3), abs=4 * EPS)
        assert apart(west, sphere.cross(unit(at), north)) <= 4 * EPS  # the left of the way to the north


@settings(max_examples=40)
@given(PLACE, ANGLE, PLACE, PLACE)
def test_attitudes_keep_arcs(pole: Coordinates, angle: float, a: Coordinates, b: Coordinates) -> None:
    attitude = an_attitude(pole, angle)
    places = [sphere.vector_in_frame(attitude, unit(at)) for at in (a, b)]
    assume(1e-3 < arc(unit(a), unit(b)) < math.pi - 1e-3)
    assert arc(*places) == pytest.approx(arc(unit(a), unit(b)), abs=32 * EPS)
    found = sphere.attitude_by_two_points(ARRAYS, a, b, *places)
    # errors of the places over the sine of the arc between them
    allowed = 64 * EPS / math.sin(arc(*places))
    assert all(apart(x, y) <= allowed for x, y in zip(found, attitude, strict=True))


@settings(max_examples=60)
@given(PLACE, PLACE, ARC, ARC, SIGN)
def test_circles_meet(a: Coordinates, b: Coordinates, r: float, s: float, sign: float) -> None:
    one, other = unit(a), unit(b)
    distance = arc(one, other)
    assume(abs(r - s) + 0.05 < distance < min(r + s, math.tau - r - s) - 0.05)
    p = meet_circles_on_sphere(one, half(r), other, half(s), signed(sign))
    volume = triple(one, other, p)
    # the height over the arc is the root of a radicand known to some eps
    allowed = 64 * EPS / (abs(volume) * math.sin(distance))
    assert sphere.dot(p, p) == pytest.approx(1.0, abs=allowed)
    assert sphere.dot(p, one) == pytest.approx(math.cos(r), abs=allowed)
    assert sphere.dot(p, other) == pytest.approx(math.cos(s), abs=allowed)
    assert sign * volume > 0  # to the left of the way from the first centre to the second


@pytest.mark.parametrize("size", [1.0, 1e-3, 1e-6])
def test_radicand_of_circles_is_the_squared_volume_to_the_last_digits(size: float) -> None:
    """Also of small circles, where the formula with cosines of arcs loses twice their digits."""
    found: list[float] = []

    def root(x: float) -> float:
        found.append(x)
        return math.sqrt(x)

    a, b, r, s = (0.0, 0.0), (0.9 * size, 0.0), 0.7 * size, 0.5 * size
    p = meet_circles_on_sphere(unit(a), half(r), unit(b), half(s), root)
    with mp.workdps(50):
        g, c, d = (mp.cos(mp.mpf(x)) for x in (b[0], r, s))
        exact = 1 - g**2 - c**2 - d**2 + 2 * g * c * d
        # the factors are differences of squares of the same size: a few roundings each, and those of the places
        places = 8 * EPS / size if size < 1.0 else 8 * EPS
        assert abs(found[0] / exact - 1) <= 32 * EPS + 16 * places
    assert arc(p, unit(a)) == pytest.approx(r, abs=64 * EPS)
    assert arc(p, unit(b)) == pytest.approx(s, abs=64 * EPS)


def test_circles_that_touch_have_a_radicand_of_zero() -> None:
    """Equal circles about one another's rim, and arcs that together make a great circle."""
    touching = [(2.0, 1.0, 1.0), (0.5, 1.5, 1.0), (2.0, 2.2, math.tau - 4.2)]
    for distance, r, s in touching:
        found: list[float] = []

        def root(x: float, found: list[float] = found) -> float:
            found.append(x)
            return 0.0

        meet_circles_on_sphere(unit((0.3, 0.2)), half(r), unit_at(distance), half(s), root)
        assert abs(found[0]) <= 32 * EPS


def unit_at(distance: float) -> Vector:
    """A place at an arc from (0.3, 0.2)."""
    x = unit((0.3, 0.2))
    north, _west = sphere.meridian(ARRAYS, (0.3, 0.2))
    along = sphere.rotate_tangent(ARRAYS, x, north, (math.cos(1.0), math.sin(1.0)))
    return sphere.linear_combination((math.cos(distance), x), (math.sin(distance), along))


@settings(max_examples=40)
@given(PLACE, ANGLE, PLACE, PLACE, ANGLE, PLACE, PLACE)
def test_a_turned_link_has_its_angle(
    pole: Coordinates, attitude: float, zero: Coordinates, end: Coordinates, angle: float,
    pivot: Coordinates, second: Coordinates,
) -> None:  # fmt: skip
    sines = [math.sin(arc(unit(p), unit(q))) for p, q in ((zero, end), (pivot, second))]
    assume(min(sines) > 0.05)
    base = an_attitude(pole, attitude)
    at = sphere.vector_in_frame(base, unit(zero))
    reference = (pivot, second, zero, end)
    rotor = (math.cos(angle), math.sin(angle))
    pose = SPHERE.turned_pose(ARRAYS, base, rotor, pivot, at, reference)
    allowed = 128 * EPS / min(sines)
    assert apart(SPHERE.place(ARRAYS, pose, pivot), at) <= allowed
    assert SPHERE.turn(ARRAYS, pose, base, rotor, reference) == pytest.approx(0.0, abs=allowed)
    assert max(abs(x) for x in SPHERE.stretch(SPHERE.attitude(pose))) <= allowed
    ends = [at, SPHERE.place(ARRAYS, base, end), SPHERE.place(ARRAYS, pose, second)]
    cosine, sine = SPHERE.rotor(ARRAYS, pose, [pivot, second], [ends[1]])
    assert math.remainder(math.atan2(sine, cosine) - angle, math.tau) == pytest.approx(0.0, abs=allowed)
    # counter-clockwise seen from outside: the sine is the volume that the three places span
    assert sine * triple(*ends) >= -allowed
    back = SPHERE.turned_pose(ARRAYS, pose, (rotor[0], -rotor[1]), zero, at, (*reference[2:], *reference[:2]))
    assert all(apart(x, y) <= 2 * allowed for x, y in zip(back, base, strict=True))


@settings(max_examples=40)
@given(PLACE, PLACE, PLACE, PLACE, st.floats(0.2, 2.9), SIGN)
def test_a_link_aims_its_circle_at_a_target(
    pivot: Coordinates, pole: Coordinates, at: Coordinates, target: Coordinates, radius: float, sign: float
) -> None:
    arm, reach = arc(unit(pivot), unit(pole)), arc(unit(at), unit(target))
    assume(min(math.sin(arm), math.sin(reach)) > 0.1)
    assume(abs(arm - radius) + 0.05 < reach < min(arm + radius, math.tau - arm - radius) - 0.05)
    pose = SPHERE.aim(ARRAYS, pivot, unit(at), (pole, (radius,)), unit(target), signed(sign))
    centre = SPHERE.place(ARRAYS, pose, pole)
    volume = triple(unit(at), unit(target), centre)
    allowed = 256 * EPS / (abs(volume) * math.sin(reach) * math.sin(arm))
    assert apart(SPHERE.place(ARRAYS, pose, pivot), unit(at)) <= allowed
    assert SPHERE.on_guide(ARRAYS, unit(target), pose, (pole, (radius,))) == pytest.approx(0.0, abs=allowed)
    assert sign * volume > 0  # the pole lies to the left of the way from pivot to target


@settings(max_examples=40)
@given(PLACE, ANGLE, PLACE, st.floats(0.1, 3.0), st.floats(-0.99, 0.99))
def test_a_stop_is_where_its_displacement_says(
    at: Coordinates, angle: float, pole: Coordinates, radius: float, share: float
) -> None:
    base, curve = an_attitude(at, angle), (pole, (radius,))
    period = SPHERE.period(ARRAYS, curve)
    assert period == pytest.approx(math.tau * math.sin(radius), rel=4 * EPS)
    displacement = 0.5 * share * period
    stop = SPHERE.stop(ARRAYS, base, curve, displacement)
    place = SPHERE.meet(stop, SPHERE.rail(ARRAYS, base, curve), signed(1.0), lambda x: x)
    allowed = 64 * EPS / math.sin(radius)
    assert SPHERE.on_guide(ARRAYS, place, base, curve) == pytest.approx(0.0, abs=allowed)
    assert SPHERE.slide(ARRAYS, place, base, curve) == pytest.approx(displacement, abs=allowed)
    # arc lengths along the circle: between two places of it lies the chord 2 sin(radius) sin(half the angle)
    other = SPHERE.stop(ARRAYS, base, curve, 0.0).centre
    chord = 2 * math.sin(radius) * math.sin(abs(displacement) / math.sin(radius) / 2)
    assert apart(place, other) == pytest.approx(chord, abs=allowed)


@pytest.mark.parametrize("distance", [1e-9, 1e-4, 0.5, 2.0, 3.0])
def test_arcs_keep_their_digits(distance: float) -> None:
    assert arc(unit((0.0, 0.0)), unit((distance, 0.0))) == pytest.approx(distance, abs=4 * EPS)
    first, second = (0.2, 0.0), (0.2 + distance, 0.0)
    sine, cosine = sphere.half_arc(ARRAYS, first, second)
    assert 2 * math.atan2(sine, cosine) == pytest.approx(distance, rel=0.2 * EPS / distance + 4 * EPS)


def test_what_fails_to_meet_is_told() -> None:
    def circle(at: Coordinates, r: float) -> object:
        return SPHERE.circle(ARRAYS, unit(at), (0.0, 0.0), (r, 0.0))

    cases = [(0.2, 0.3, 0), (2.0, 0.5, 1), (0.5, 2.0, 2), (2.5, 2.9, 3)]
    for r, s, reason in cases:
        lack = SPHERE.lack(ARRAYS, circle((0.0, 0.0), r), circle((1.0, 0.0), s))
        exact = (1.0 - r - s, r - s - 1.0, s - r - 1.0, r + s + 1.0 - math.tau)
        assert lack == pytest.approx(exact, abs=8 * EPS)
        assert max(lack) == lack[reason] > 0
    assert max(SPHERE.lack(ARRAYS, circle((0.0, 0.0), 0.7), circle((1.0, 0.0), 0.7))) < 0


def test_the_formulas_keep_fifty_digits() -> None:
    """Over numbers of high precision nothing falls back to floats."""
    with mp.workdps(50):
        a, b, r, s = ((mp.mpf(k) / 7, mp.mpf(k) / 9) for k in (1, 5, 6, 8))
        one, other = (sphere.unit_vector(mp, at) for at in (a, b))
        p = meet_circles_on_sphere(one, sphere.half_arc(mp, a, r), other, sphere.half_arc(mp, b, s), mp.sqrt)
        exact = [
            sphere.arc(mp, sphere.unit_vector(mp, x), sphere.unit_vector(mp, y)) for x, y in ((a, r), (b, s))
        ]
        found = [sphere.arc(mp, p, centre) for centre in (one, other)]
        assert all(abs(x - y) < mp.mpf(10) ** -47 for x, y in zip(exact, found, strict=True))
        pose = sphere.attitude_by_two_points(mp, a, r, one, p)
        assert all(abs(x) < mp.mpf(10) ** -47 for x in SPHERE.stretch(SPHERE.attitude(pose)))


def test_a_basis_is_square_everywhere() -> None:
    places = [unit((k * 0.61, math.asin(-1 + k / 20))) for k in range(41)]
    places += [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0)]
    for at in places:
        axes = (at, *sphere.basis(ARRAYS, at))
        assert all(sphere.dot(x, x) == pytest.approx(1.0, abs=8 * EPS) for x in axes)
        assert all(abs(sphere.dot(x, y)) <= 8 * EPS for x, y in pairwise((*axes, at)))
        assert triple(*axes) == pytest.approx(1.0, abs=8 * EPS)
