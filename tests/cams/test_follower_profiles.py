"""Profiles under followers against closed forms: textbook formulas, eccentric circles, envelopes found by force."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from cam_shapes import three_point_curvature
from centrode.cams.followers.geometry import (
    Face,
    FollowerCam,
    Oscillating,
    Point,
    Translating,
    oscillating_face,
    oscillating_follower,
    translating_follower,
)
from centrode.errors import InputError
from centrode.numerics.jets import Jet
from follower_motions import JETS, Array, Wave, lift_of, rise_dwell_fall_dwell

EPS = float(np.finfo(float).eps)
TURN = math.tau
BOTH = pytest.mark.parametrize("sense", [1.0, -1.0])


class By:
    """A lift by a formula over jets, smooth all round."""

    edges = (0.0, TURN)

    def __init__(self, formula: Callable[[Jet], Jet]) -> None:
        self.formula = formula

    def lift(self, phi: Array, order: int = 0) -> Array:
        found = self.formula(Jet.variable(np.asarray(phi, dtype=float), order))
        return np.array([found.derivative(k) + 0.0 * phi for k in range(order + 1)])


def flat(motion: object, base: float, sense: float = 1.0, offset: float = 0.0) -> FollowerCam:
    return FollowerCam(motion, Translating(base, offset), Face(), base, sense)  # type: ignore[arg-type]


def rolled(
    motion: object, base: float, roller: float, offset: float = 0.0, sense: float = 1.0
) -> FollowerCam:
    guide = translating_follower(base + roller, offset)
    return FollowerCam(motion, guide, Point(roller), base, sense)  # type: ignore[arg-type]


def even(count: int = 360) -> Array:
    return np.linspace(0.0, TURN, count + 1)[:-1]


def test_the_worked_cam_with_a_flat_face() -> None:
    """Cycloidal rise 1, dwell, fall 1, dwell, 90 degrees each: base radius 1.893, face width 2.546."""
    cam = flat(rise_dwell_fall_dwell(1.0), 1.893)
    assert cam.bends.least == pytest.approx(0.25, abs=0.0005)  # the base radius is printed to half of this
    assert cam.face.greatest - cam.face.least == pytest.approx(8 / math.pi, rel=8 * EPS)
    assert not cam.undercuts and not cam.corners


@BOTH
def test_a_roller_by_the_textbook(sense: float) -> None:
    """x, y, pressure angle and radius of curvature as they are printed for an offset roller."""
    motion, base, r, e = rise_dwell_fall_dwell(0.02, "3-4-5"), 0.04, 0.01, 0.006
    cam, phi = rolled(motion, base, r, e, sense), even()
    s, v, a = motion.lift(phi, 2)
    y = math.sqrt((base + r) ** 2 - e**2) + s
    slope = v - sense * e
    long = np.hypot(y, slope)
    # the frame's axes first: the normal there, then turned against the cam
    x_frame, y_frame = e + sense * r * slope / long, y - r * y / long
    x = x_frame * np.cos(phi) + sense * y_frame * np.sin(phi)
    z = y_frame * np.cos(phi) - sense * x_frame * np.sin(phi)
    found = cam.contact(phi)
    size = base + r + 0.02
    np.testing.assert_allclose(found.place, np.stack([x, z], axis=-1), atol=16 * EPS * size)
    np.testing.assert_allclose(np.tan(found.pressure_angle), slope / y, atol=16 * EPS)
    bend = long**3 / (y**2 + slope * (2 * v - sense * e) - y * a) - r
    np.testing.assert_allclose(1 / found.bend, 1 / bend, atol=64 * EPS / base)
    np.testing.assert_allclose(np.hypot(*found.normal.T), 1.0, rtol=4 * EPS)
    np.testing.assert_allclose(np.sum(found.normal * found.tangent, axis=1), 0.0, atol=4 * EPS)


@BOTH
@pytest.mark.parametrize("r", [0.0, 0.008])
def test_an_eccentric_circle_under_a_translating_roller(sense: float, r: float) -> None:
    """A circle off the cam's centre: the roller's centre is led on a circle of radius long about the eccentric."""
    out, big, e = 0.01, 0.05, 0.004
    long = big + r
    start = math.sqrt(long**2 - (e - out) ** 2)  # the eccentric lies on x at phi = 0: height there

    def lift(phi: Jet) -> Jet:
        across = JETS.cos(phi) * -out + e
        return JETS.sin(phi) * (sense * out) + JETS.sqrt(across * across * -1.0 + long**2) - start

    cam = rolled(By(lift), math.hypot(start, e) - r, r, e, sense)
    found = cam.contact(even())
    np.testing.assert_allclose(np.hypot(*(found.place - [out, 0.0]).T), big, rtol=32 * EPS)
    # digits of the curvature: the lift's second derivative counts in its own size
    np.testing.assert_allclose(found.bend, big, rtol=1e3 * EPS)
    np.testing.assert_allclose(found.speed, np.abs(found.speed), rtol=0)


@BOTH
@pytest.mark.parametrize("r", [0.0, 0.008])
def test_an_eccentric_circle_under_an_oscillating_roller(sense: float, r: float) -> None:
    """The same circle makes a four-bar of cam, follower and frame: its rocker's angle is the lift."""
    out, big, arm, distance = 0.01, 0.05, 0.07, 0.08
    long = big + r

    def angle(phi: Jet) -> Jet:
        x, y = JETS.cos(phi) * out - distance, JETS.sin(phi) * (sense * out)
        square = x * x + y * y
        inner = (square + (arm**2 - long**2)) / (JETS.sqrt(square) * (2.0 * arm))
        return JETS.acos(inner) - JETS.atan2(y, x * -1.0) * -1.0

    start = float(angle(Jet.variable(0.0, 0)).value)
    guide = Oscillating(start, distance, arm)
    cam = FollowerCam(By(lambda phi: angle(phi) - start), guide, Point(r), big, sense)
    found = cam.contact(even())
    np.testing.assert_allclose(np.hypot(*(found.place - [out, 0.0]).T), big, rtol=32 * EPS)
    np.testing.assert_allclose(found.bend, big, rtol=1e3 * EPS)


@BOTH
def test_an_eccentric_circle_under_flat_faces(sense: float) -> None:
    out, big, distance, off = 0.01, 0.05, 0.12, 0.004
    cam = flat(Wave(2 * out), big - out, sense)  # lift out (1 - cos phi): centre below the axis at phi = 0
    found = cam.contact(even())
    np.testing.assert_allclose(np.hypot(*(found.place - [0.0, -out]).T), big, rtol=16 * EPS)
    np.testing.assert_allclose(found.bend, big, rtol=16 * EPS)

    def angle(phi: Jet) -> Jet:
        # distance of the face from the eccentric: d sin(psi) - off - eccentric . n = big
        x, y = JETS.cos(phi) * out, JETS.sin(phi) * (sense * out)
        across = x * -1.0 + distance
        return JETS.asin((across * 0.0 + (big + off)) / JETS.sqrt(across * across + y * y)) + JETS.atan2(
            y, across
        )

    start = float(angle(Jet.variable(0.0, 0)).value)
    turning = FollowerCam(
        By(lambda phi: angle(phi) - start), Oscillating(start, distance, 0.0, off), Face(), big, sense
    )
    found = turning.contact(even())
    np.testing.assert_allclose(np.hypot(*(found.place - [out, 0.0]).T), big, rtol=32 * EPS)
    np.testing.assert_allclose(found.bend, big, rtol=1e3 * EPS)
    places = turning.in_frame(found.place, found.phi)
    np.testing.assert_allclose(
        np.hypot(*(places - [distance, 0.0]).T), np.hypot(found.along, off), rtol=32 * EPS
    )


def cams() -> dict[str, FollowerCam]:
    motion, swing = rise_dwell_fall_dwell(0.012), rise_dwell_fall_dwell(0.25)
    return {
        "knife": rolled(motion, 0.04, 0.0, 0.005),
        "roller": rolled(motion, 0.04, 0.009, -0.004, -1.0),
        "arm": FollowerCam(swing, oscillating_follower(0.05, 0.06, 0.07), Point(0.01), 0.04, 1.0),
        "face": flat(motion, 0.04, -1.0),
        "turning face": FollowerCam(
            rise_dwell_fall_dwell(0.08), oscillating_face(0.04, 0.11, 0.003), Face(), 0.04, -1.0
        ),
    }


@pytest.mark.parametrize("name", cams())
def test_the_profile_is_the_envelope_of_all_places(name: str) -> None:
    """No place of the follower goes beyond the profile's, found among 3600 places of the follower."""
    cam, phi, around = cams()[name], even(90), even(3600)
    assert not cam.undercuts
    place, others = cam.contact(phi).place, cam.contact(around)
    if isinstance(cam.touch, Face):
        support = np.sum(others.place * others.normal, axis=1)
        room = support - place @ others.normal.T
    else:
        apart = np.hypot(*(place[:, None] - others.centre).transpose(2, 0, 1))
        room = apart - cam.touch.roller
    # every 40th of the places touches; none comes nearer than rounding
    assert room.min(axis=1).max() < 16 * EPS and room.min() > -16 * EPS


@pytest.mark.parametrize("name", cams())
def test_tangent_and_curvature_are_those_of_the_drawn_points(name: str) -> None:
    cam = cams()[name]
    low, high = 0.2, 1.3
    phi = np.linspace(low, high, 4001)
    found, step = cam.contact(phi), (high - low) / 4000
    chord = np.diff(found.place, axis=0)
    size = float(np.abs(found.centre).max())
    middle = cam.contact(0.5 * (phi[1:] + phi[:-1]))
    # the chord's error is a 24th of the third derivative, which the curves of a rise keep below some 1000 sizes
    np.testing.assert_allclose(
        chord / step, middle.speed[:, None] * middle.tangent, atol=1000 * size * step**2 / 24 + 8 * EPS / step
    )
    bent = cam.sense * three_point_curvature(found.place)
    scale = float(np.abs(found.curvature).max())
    drawn = np.abs(bent - found.curvature[1:-1])
    assert drawn.max() < 1e-3 * scale
    coarse = np.abs(cam.sense * three_point_curvature(found.place[::10]) - found.curvature[10:-10:10]).max()
    assert drawn.max() < coarse / 20  # falls as the square of the distance, up to rounding


def test_undercut_of_a_flat_face_ends_where_the_curvature_changes_its_sign() -> None:
    """lift a (1 - cos 3 phi)/2: the radius of curvature is base + a/2 + 4 a cos(3 phi)."""
    base, height = 0.03, 0.01
    cam = flat(Wave(height, 3), base)
    half = math.acos(-(base + height / 2) / (4 * height)) / 3
    expected = [(half + k * TURN / 3, (k + 1) * TURN / 3 - half) for k in range(3)]
    found = [(one.start, one.stop) for one in cam.undercuts]
    np.testing.assert_allclose(found, expected, atol=32 * EPS * (base + height) / height)
    assert cam.bends.least == pytest.approx(base + height / 2 - 4 * height, rel=16 * EPS * base / 0.005)


def test_undercut_of_a_roller_between_its_cusps() -> None:
    motion, base, r = rise_dwell_fall_dwell(0.03), 0.005, 0.03
    cam = rolled(motion, base, r)
    (first, second) = cam.undercuts
    for at in (first.start, first.stop, second.start, second.stop):
        s, v, a = motion.lift(np.array([at]), 2)[:, 0]
        y = base + r + s
        bend = math.hypot(y, v) ** 3 / (y**2 + 2 * v * v - y * a)
        assert bend == pytest.approx(r, rel=64 * EPS)
    most, where = cam.greatest_roller
    assert most < r and (first.start < where < first.stop or second.start < where < second.stop)
    smaller = FollowerCam(motion, translating_follower(base + r), Point(0.999999 * most), base + r - most)
    assert not smaller.undercuts
    assert (
        len(FollowerCam(motion, translating_follower(base + r), Point(1.000001 * most), base).undercuts) == 2
    )


def test_a_stretch_across_the_beginning_is_told_in_one_piece() -> None:
    motion = lift_of((60, 0.02, "cycloidal"), (240, 0.02, "uniform"), (60, 0.0, "cycloidal"))
    turned = By(lambda phi: JETS.cos(phi * 3.0) * 0.005 - 0.005)  # highest at phi = 0
    assert not flat(motion, 0.04).corners
    (first, *rest) = flat(turned, 0.04 - 0.005).undercuts[::-1]
    assert first.stop > TURN > first.start and len(rest) == 2


@BOTH
def test_corners_of_uniform_motion(sense: float) -> None:
    motion = lift_of((90, 0.01, "uniform"), (90, None, "dwell"), (90, 0.0, "uniform"), (90, None, "dwell"))
    v = 0.01 / (math.pi / 2)
    face = flat(motion, 0.04, sense).corners
    np.testing.assert_allclose([one.step for one in face], [v, -v, -v, v], rtol=1e-12)
    assert [one.undercuts(math.inf) for one in face] == [False, True, True, False]
    cam = rolled(motion, 0.03, 0.01, 0.0, sense)
    low, high = math.atan(v / 0.04), math.atan(v / 0.05)
    np.testing.assert_allclose([one.turn for one in cam.corners], [-low, high, high, -low], rtol=1e-12)
    assert [(one.start, one.stop) for one in cam.undercuts] == [
        (pytest.approx(math.pi / 2), pytest.approx(math.pi / 2)),
        (pytest.approx(math.pi), pytest.approx(math.pi)),
    ]
    assert cam.greatest_roller == (0.0, pytest.approx(math.pi / 2))
    most, at = cam.greatest_cutter
    assert most == 0.01 and at in (0.0, pytest.approx(3 * math.pi / 2))
    assert not rolled(motion, 0.04, 0.0, 0.0, sense).undercuts  # an edge leaves corners, cuts nothing away


def test_extremes_are_those_of_many_places() -> None:
    cam = rolled(rise_dwell_fall_dwell(0.02), 0.03, 0.008, 0.004)
    phi = even(200_000)
    found = cam.contact(phi)
    step = TURN / 200_000
    for extremes, values in (
        (cam.pressure, found.pressure_angle),
        (cam.path_curvature, found.path_curvature),
    ):
        bound = float(np.abs(np.diff(values, 2)).max()) + 8 * EPS * float(np.abs(values).max())
        assert 0 <= extremes.greatest - values.max() < bound
        assert 0 <= values.min() - extremes.least < bound
        near = min(abs(extremes.at_greatest - phi[np.abs(values - values.max()) < bound]))
        assert near <= step


def test_a_follower_that_misses_the_base_circle_is_refused() -> None:
    with pytest.raises(InputError, match="misses the base circle"):
        translating_follower(0.02, -0.02)
    with pytest.raises(InputError, match=r"starts between 20 and 140 mm, not at 150"):
        oscillating_follower(0.15, 0.06, 0.08)
    with pytest.raises(InputError, match="move the pivot farther away"):
        oscillating_face(0.05, 0.04)


def test_a_roller_that_spans_a_waist_overlaps_the_cam() -> None:
    cam = rolled(rise_dwell_fall_dwell(0.02), 0.03, 0.008)
    assert cam.overlap == (0.0, 0.0)
    star = rolled(Wave(0.2, 4), 0.002, 0.02)
    assert not star.undercuts  # it rolls off everywhere, yet reaches over the waist of a lobe
    depth, at = star.overlap
    found = star.contact(even(7200))
    apart = np.hypot(*(found.place - star.contact(np.array([at])).centre).T).min()
    half = 0.5 * TURN / 720 * float(np.abs(found.speed).max())  # a place lies no farther from one of 720
    assert depth > 0.008 and 0.0 <= 0.02 - apart - depth < math.hypot(apart, half) - apart


def test_the_offset_of_a_flat_face_moves_its_contact_alone() -> None:
    middle, off = (flat(rise_dwell_fall_dwell(0.01), 0.04, 1.0, offset) for offset in (0.0, 0.003))
    phi = even(40)
    np.testing.assert_array_equal(middle.contact(phi).place, off.contact(phi).place)
    np.testing.assert_allclose(middle.contact(phi).along - off.contact(phi).along, 0.003, atol=EPS)
