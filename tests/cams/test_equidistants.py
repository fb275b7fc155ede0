"""Profiles as equidistants: closed forms, the envelope of roller circles by force, curvature, undercut."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cam_shapes import EPS, Limacon, paper_path, three_point_curvature
from centrode.cams.profiles import ProfileBody, check_roller_fits, equidistant, greatest_roller, undercut
from centrode.cams.return_arc import Arc, ClosedPath, design_return, working_arc
from centrode.cams.roller_path import frames
from centrode.errors import InputError
from circle_path import CirclePath

ROLLER = 0.015


@pytest.mark.parametrize("gamma0", [0.0, 0.3, -0.2])
@pytest.mark.parametrize("distance", [-ROLLER, ROLLER])
def test_the_profile_of_an_eccentric_circle_is_a_circle(gamma0: float, distance: float) -> None:
    path = CirclePath(0.05, gamma0, 18.0)
    phi = np.linspace(-math.pi, math.pi, 97)
    off = equidistant(frames(path, phi), distance)
    radii = np.hypot(*(off.place - np.array(path.centre)).T)
    # some ten roundings of lengths of the size of the path
    np.testing.assert_allclose(radii, 1.0 / 18.0 + distance, rtol=0.0, atol=16 * EPS * 0.11)
    # curvature divides differences of second derivatives: errors grow with (speed x curvature)^-1, here below 10
    np.testing.assert_allclose(off.bend, 1.0 / 18.0 + distance, rtol=200 * EPS)


def test_the_formulas_of_the_paper_are_the_offset_along_the_normal() -> None:
    path = paper_path()
    phi = np.linspace(-1.5, 1.5, 61)
    height, slope = path.radius(phi, 1)
    psi = phi - np.arctan(slope / height)
    by_paper = np.stack(
        [
            height * np.sin(phi) - ROLLER * np.sin(psi),
            height * np.cos(phi) - ROLLER * np.cos(psi),
        ],
        axis=-1,
    )
    off = equidistant(frames(path, phi), -ROLLER)
    np.testing.assert_allclose(off.place, by_paper, rtol=0.0, atol=8 * EPS * 0.08)


def test_equidistants_keep_their_distance_and_the_angle_of_the_normal() -> None:
    path = paper_path()
    phi = np.linspace(-1.4, 1.4, 41)
    frame = frames(path, phi)
    inner, outer = equidistant(frame, -ROLLER), equidistant(frame, ROLLER)
    across = np.hypot(*(outer.place - inner.place).T)
    np.testing.assert_allclose(across, 2 * ROLLER, rtol=0.0, atol=16 * EPS * 0.08)
    np.testing.assert_allclose(outer.bend - inner.bend, 2 * ROLLER, rtol=64 * EPS)
    # polar form and places are the same
    np.testing.assert_allclose(
        inner.place,
        inner.polar_radius[:, None]
        * np.stack([np.sin(inner.polar_angle), np.cos(inner.polar_angle)], axis=-1),
        rtol=0.0,
        atol=8 * EPS * 0.08,
    )


def test_the_profile_is_the_envelope_of_the_rollers_by_force() -> None:
    closed = design_return(working_arc(paper_path(), legs=4)).closed
    body = ProfileBody(closed, ROLLER)
    phi = np.linspace(closed.start, closed.stop, 20001)
    centres = frames(closed, phi).place
    profile = body.profile(np.linspace(closed.start, closed.stop, 37)[1:-1])
    for angle, radius in zip(profile.polar_angle, profile.polar_radius, strict=True):
        ray = np.array([math.sin(angle), math.cos(angle)])
        along = centres @ ray
        # each roller's circle is entered at along - root, if the ray meets it at all
        left = ROLLER**2 - (np.sum(centres**2, axis=1) - along**2)
        entered = along[left >= 0] - np.sqrt(left[left >= 0])
        nearest = float(entered[entered > 0].min())
        # centres are 2 pi/20000 apart: between two circles the envelope bulges by less than (step^2 / 8)(1/r + 1/R)
        step = 0.08 * math.tau / 20000
        bulge = step**2 / 8.0 * (1.0 / ROLLER + 1.0 / 0.03) / math.cos(0.3)
        assert -8 * EPS < nearest - radius <= bulge


def test_curvature_computed_back_from_three_points_converges_to_the_profile() -> None:
    closed = design_return(working_arc(paper_path(), legs=4)).closed
    body = ProfileBody(closed, ROLLER)
    errors = []
    for count in (200, 400, 800):
        phi = np.linspace(0.85, 5.4, count + 1)
        off = body.profile(phi)
        back = three_point_curvature(off.place)
        errors.append(np.abs(back - off.curvature[1:-1]).max())
    # second order
    assert 3.6 < errors[0] / errors[1] < 4.4
    assert 3.6 < errors[1] / errors[2] < 4.4


def test_undercut_begins_where_the_law_says() -> None:
    path, roller = paper_path(), 0.06
    # K = 10 exp(0.75 phi) = 1/r
    cusp = math.log(1.0 / (10.0 * roller)) / 0.75
    edges = (-1.5, 0.0, 1.5)
    first, second = undercut(path, edges, roller)
    # an angle is found to the rounding of K over its relative slope 0.75
    slack = 64 * EPS / 0.75
    assert first.start == -1.5 and second.stop == 1.5
    assert abs(first.stop + cusp) < slack and abs(second.start - cusp) < slack
    off = equidistant(frames(path, np.array([cusp - 1e-6, cusp + 1e-6])), -roller)
    assert off.speed[0] > 0 > off.speed[1]


def test_a_roller_below_the_least_bend_leaves_no_undercut() -> None:
    path, edges = paper_path(), (-1.5, 0.0, 1.5)
    most, at = greatest_roller(path, edges)
    assert abs(abs(at) - 1.5) < 1e-15
    assert most == pytest.approx(math.exp(-0.75 * 1.5) / 10.0, rel=64 * EPS)
    assert undercut(path, edges, most * (1 - 1e-12)) == []
    assert undercut(path, edges, most * (1 + 1e-9))


def test_an_undercut_over_the_end_of_a_turn_is_one() -> None:
    closed = design_return(working_arc(paper_path(), legs=4)).closed
    found = undercut(closed, closed.edges, 0.06)
    assert [round(math.degrees(one.start)) for one in found] == [39, 274]
    for one in found:
        curvature = frames(closed, np.array([one.start, one.stop])).curvature
        np.testing.assert_allclose(curvature, 1.0 / 0.06, rtol=1e-13)


def test_a_roller_larger_than_the_hollow_of_a_groove_is_refused_with_the_greatest_that_fits() -> None:
    a, b = 0.05, 0.03
    curve, edges = Limacon(a, b), (-math.pi, 0.0, math.pi)
    # the limacon is bent most inwards at phi = pi: K = (a - 2 b) / (a - b)^2
    hollow = (a - b) ** 2 / (2 * b - a)
    most, at = greatest_roller(curve, edges, "outer")
    assert most == pytest.approx(hollow, rel=64 * EPS)
    assert abs(abs(at) - math.pi) < 1e-12
    check_roller_fits(curve, edges, hollow * 0.999, "outer")
    with pytest.raises(InputError, match=r"larger than the hollow at -?180 deg; stay below 40 mm"):
        check_roller_fits(curve, edges, 1.001 * hollow, "outer")
    # the inner side of the same hollow takes any roller; convex stretches bound it
    convex, _at = greatest_roller(curve, edges)
    assert convex < hollow
    with pytest.raises(InputError, match="undercuts"):
        check_roller_fits(curve, edges, convex * 1.01, "inner")


def test_a_roller_that_overlaps_the_cam_across_a_waist_is_found() -> None:
    # at the waist the path is 2 x 12 mm wide: a roller of 15 mm overlaps the profile of the other side by 6 mm
    arc = Arc("working", Limacon(0.04, 0.028, 2), -math.pi, math.pi)
    body = ProfileBody(ClosedPath((arc,)), 0.015)
    assert body.undercuts == []
    depth, at = body.overlap
    # the deepest place is at the waist or beside it
    assert depth >= 0.006 - 1e-6
    assert abs(abs(at) - math.pi / 2) < 0.5
    assert ProfileBody(ClosedPath((arc,)), 0.008).overlap == (0.0, 0.0)
    closed = design_return(working_arc(paper_path(), legs=4)).closed
    assert ProfileBody(closed, ROLLER).overlap == (0.0, 0.0)


@pytest.mark.parametrize("radius", [0.0, -0.01, math.nan, math.inf])
def test_a_roller_has_a_positive_finite_radius(radius: float) -> None:
    with pytest.raises(InputError, match="positive and finite"):
        undercut(paper_path(), (-1.0, 1.0), radius)
