"""Closed paths: designed return arcs join and keep their bounds, mirror images have the kink they have."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

import centrode as ct
from cam_shapes import EPS, exchanged, paper_path
from centrode.cams.profiles import cam_body
from centrode.cams.return_arc import (
    ArcBounds,
    ClosedPath,
    Ends,
    ReturnCurve,
    derivatives,
    design_return,
    mirror_arc,
    working_arc,
)
from centrode.cams.roller_path import SymmetricPath, frames
from centrode.errors import InputError, MotionError
from circle_path import CirclePath

TABLE_ETA_45 = 0.214339
"""Of the paper's table, to half a unit of its last digit."""


def assert_joined(closed: ClosedPath, contact: int) -> None:
    for joint in closed.joints:
        size = float(closed.radius(np.array([joint.at]))[0, 0])
        # six or eight conditions solved: some hundred roundings, whose derivatives are of the size of the radius
        slack = 500 * EPS
        assert abs(joint.gap) < slack * size
        assert abs(joint.kink) < slack
        assert abs(joint.curvature_jump) < slack * 10 / size
        if contact == 3:
            assert abs(joint.curvature_slope_jump) < slack * 100 / size


@pytest.mark.parametrize("contact", [2, 3])
@pytest.mark.parametrize("legs", [3, 4, 6])
def test_a_designed_arc_joins_in_value_slope_and_curvature(legs: int, contact: int) -> None:
    assert_joined(design_return(working_arc(paper_path(), legs=legs), contact=contact).closed, contact)


def test_an_arc_that_is_not_symmetric_joins_as_well() -> None:
    path = paper_path().half
    found = design_return(working_arc(path), ArcBounds(convex=True))
    assert found.closed.arcs[0].start == 0.0
    assert_joined(found.closed, 2)
    assert found.curvature.least >= 0.0


def test_a_circle_about_the_centre_is_closed_by_itself() -> None:
    found = design_return(working_arc(SymmetricPath(CirclePath(0.05, 0.0, 20.0, 0.0)), legs=5))
    phi = np.linspace(0.0, math.tau, 200)
    np.testing.assert_allclose(found.closed.radius(phi)[0], 0.05, rtol=64 * EPS)
    assert found.additions == 0


def test_the_smoothest_arc_is_the_smoothest() -> None:
    """(rho''' + rho')^2 integrated by another rule: whatever is added makes it greater, by its own integral."""
    working = working_arc(paper_path(), legs=4)
    curve = design_return(working).curve
    phi = np.linspace(curve.ends.start, curve.ends.stop, 20001)

    def rough(one: ReturnCurve) -> float:
        rows = one.radius(phi, 3)
        return float(np.trapezoid((rows[3] + rows[1]) ** 2, phi))

    least = rough(curve)
    for weights in ((1e-3,), (0.0, -2e-3), (1e-3, 5e-4, -1e-3)):
        added = ReturnCurve(curve.ends, weights)
        alone = added.radius(phi, 3) - curve.radius(phi, 3)
        own = float(np.trapezoid((alone[3] + alone[1]) ** 2, phi))
        # the trapezoidal rule at steps of 2.4e-4 is good to some 1e-7 of what it integrates
        assert rough(added) == pytest.approx(least + own, rel=1e-6)
        assert own > 0.0


def test_what_is_added_vanishes_at_the_ends() -> None:
    ends = Ends(0.7, 5.0, (1.0, 0.1, 0.2), (1.0, -0.1, 0.3))
    rows = derivatives(ends, np.array([0.7, 5.0]), 2, 6)[-6:]
    assert np.abs(rows).max() < 1e-13


BOUNDS = [
    ArcBounds(greatest_radius=0.070),
    ArcBounds(greatest_radius=0.066, least_bend=0.053),
    ArcBounds(greatest_radius=0.062),
    ArcBounds(least_radius=0.052, greatest_radius=0.060, convex=False, least_bend=0.02, least_hollow=0.05),
]


@pytest.mark.parametrize("bounds", BOUNDS)
def test_bounds_are_kept_over_the_whole_arc(bounds: ArcBounds) -> None:
    found = design_return(working_arc(paper_path(), legs=4), bounds)
    assert found.additions > 0 and found.roughness > 0.0
    assert_joined(found.closed, 2)
    phi = np.linspace(found.curve.ends.start, found.curve.ends.stop, 30001)
    rho, first, second = found.curve.radius(phi, 2)
    bend = (rho**2 + 2 * first**2 - rho * second) / (rho**2 + first**2) ** 1.5
    assert rho.max() <= bounds.greatest_radius * (1 + 1e-9)
    assert rho.min() >= bounds.least_radius * (1 - 1e-9)
    assert bend.max() <= bounds.greatest_curvature + 1e-7
    assert bend.min() >= bounds.least_curvature - 1e-7
    # the extremes that are told are those of a fine mesh
    assert found.radius.greatest == pytest.approx(rho.max(), rel=1e-8)
    assert found.curvature.least == pytest.approx(bend.min(), rel=1e-6, abs=1e-6)


def test_the_pressure_angle_is_kept() -> None:
    bounds = ArcBounds(pressure_angle=0.25)
    found = design_return(working_arc(paper_path().half), bounds)
    phi = np.linspace(found.curve.ends.start, found.curve.ends.stop, 30001)
    rho, slope = found.curve.radius(phi, 1)
    assert np.abs(np.arctan2(slope, rho)).max() <= 0.25 + 1e-9
    assert np.abs(design_return(working_arc(paper_path().half)).pressure_angle.least) > 0.25


def test_tighter_bounds_cost_roughness() -> None:
    working = working_arc(paper_path(), legs=4)
    costs = [
        design_return(working, ArcBounds(greatest_radius=one)).roughness
        for one in (0.075, 0.072, 0.068, 0.064)
    ]
    assert costs[0] == 0.0
    assert costs == sorted(costs)
    assert len(set(costs)) == 4


def test_what_is_impossible_is_told_with_numbers() -> None:
    bounds = ArcBounds(greatest_radius=0.066, least_bend=0.0545)
    with pytest.raises(MotionError) as refusal:
        design_return(working_arc(paper_path(), legs=4), bounds)
    numbers = [float(one) for one in re.findall(r"[\d.]+(?= mm)", str(refusal.value))]
    radius, radius_bound, bend, bend_bound = numbers
    assert (radius_bound, bend_bound) == (66.0, 54.5)
    assert radius > 66.0 and bend < 54.5
    # by so much the best arc misses: it exists within bounds widened to that
    wider = ArcBounds(greatest_radius=1.001e-3 * radius, least_bend=0.999e-3 * bend)
    assert design_return(working_arc(paper_path(), legs=4), wider).additions > 0


def test_a_bound_that_the_joint_breaks_is_told_there() -> None:
    with pytest.raises(
        InputError, match=r"at 45 deg: the polar radius grows to 56\.0051 mm, the bound is 55 mm"
    ):
        design_return(working_arc(paper_path(), legs=4), ArcBounds(greatest_radius=0.055))


@pytest.mark.parametrize(
    "bounds",
    [{"least_radius": -1.0}, {"least_radius": 0.05, "greatest_radius": 0.04}, {"pressure_angle": 2.0}],
)
def test_bounds_make_sense(bounds: dict[str, float]) -> None:
    with pytest.raises(InputError):
        ArcBounds(**bounds)  # type: ignore[arg-type]


def test_mirror_images_have_the_kink_of_the_paper() -> None:
    closed = mirror_arc(working_arc(paper_path(), legs=4))
    kinks = [joint for joint in closed.joints if abs(joint.kink) > 1e-9]
    assert [round(math.degrees(one.at)) for one in kinks] == [45, 135, 225, 315]
    # half a unit of the table's last digit, through asin
    slack = 2 * 0.5e-6 / math.sqrt(1 - TABLE_ETA_45**2)
    for joint in kinks:
        assert abs(-joint.kink - 2 * math.asin(TABLE_ETA_45)) < slack
        assert abs(joint.gap) < 8 * EPS * 0.06
        assert abs(joint.curvature_jump) < 100 * EPS * 20
    phi = np.linspace(0.0, math.tau, 400)
    np.testing.assert_allclose(
        closed.radius(phi)[0], closed.radius(phi + math.pi / 2)[0], rtol=64 * EPS, atol=0.0
    )


def test_an_unsymmetric_arc_is_mirrored_at_both_ends() -> None:
    path = paper_path().half
    closed = mirror_arc(working_arc(path))
    assert len(closed.arcs) == 4
    phi = np.linspace(0.01, 1.5, 20)
    np.testing.assert_allclose(closed.radius(math.pi - phi)[0], path.radius(phi)[0], rtol=64 * EPS)
    np.testing.assert_allclose(closed.radius(math.pi + phi, 1)[1], path.radius(phi, 1)[1], rtol=1e-12)


def test_mirror_images_that_do_not_close_are_refused_with_the_nearest_that_does() -> None:
    with pytest.raises(InputError, match="an arc of 50 deg do not close; use 45 deg"):
        mirror_arc(working_arc(paper_path(), half=math.radians(50)))


def test_a_path_that_is_too_short_is_refused() -> None:
    with pytest.raises(InputError, match="the working arc covers -100 to 100 deg, the path -90 to 90 deg"):
        working_arc(paper_path(), half=math.radians(100))


def test_derivatives_are_those_of_the_radius() -> None:
    """Central differences of each derivative are the next: over all arcs, mirrored ones too."""
    for closed in (
        design_return(working_arc(paper_path(), legs=4)).closed,
        mirror_arc(working_arc(paper_path(), legs=4)),
    ):
        middles = (
            np.array([0.5 * (a + b) for a, b in zip(closed.edges[:-1], closed.edges[1:], strict=True)]) + 0.01
        )
        h = 1e-5
        before, after, here = (
            closed.radius(middles - h, 3),
            closed.radius(middles + h, 3),
            closed.radius(middles, 3),
        )
        # h^2/6 of the third derivative ahead, and rounding over h
        np.testing.assert_allclose((after - before)[:3] / (2 * h), here[1:], rtol=1e-7, atol=1e-9)


def test_a_whole_turn_has_to_close() -> None:
    turn = '[range]\nto = "180 deg"\nfrom = "-180 deg"\n'
    text = 'kind = "cam"\n[start]\nradius = "50 mm"\n[roller]\nradius = "10 mm"\n' + turn + "[curvature]\n"
    circle = cam_body(ct.parse_cam(text + 'law = "constant"\nk0 = "0.018 1/mm"\n'))
    assert circle.closed.whole and not circle.kinks and not circle.undercuts
    with pytest.raises(InputError, match="does not close: over one turn the radius changes by"):
        cam_body(ct.parse_cam(text + 'law = "exponential"\nk0 = "0.02 1/mm"\nk1 = 0.01\n'))


def test_an_outward_corner_is_undercut_where_the_profiles_cross() -> None:
    body = cam_body(exchanged(more='[return]\nkind = "mirrored"\n'))
    assert len(body.undercuts) == 4
    for one in body.undercuts:
        off = body.profile(np.array([one.start, one.stop]))
        np.testing.assert_allclose(off.place[0], off.place[1], rtol=0.0, atol=1e-14)
        # inside, the profile lies farther out than where it crosses: the roller never gets there
        inner = frames(body.closed, np.array([0.5 * (one.start + one.stop) - 1e-3]))
        distances = np.hypot(
            *(
                frames(body.closed, np.linspace(0, math.tau, 5000)).place
                - (inner.place - 0.015 * inner.normal)
            ).T
        )
        assert distances.min() < 0.015 * (1 - 1e-3)


def test_without_return_or_mover_the_profile_stays_open() -> None:
    cam = exchanged(('[mover]\nlegs = 4\npost = "120 mm"\n', ""))
    body = cam_body(cam)
    assert not body.closed.whole and body.closed.joints == ()
    assert np.isnan(body.closed.radius(np.array([2.0]))).all()
    assert float(ct.cam_profile(cam)["carrier_angle"][-1]) == pytest.approx(math.pi / 2)
