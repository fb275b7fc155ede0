"""The least cam and the best offset against closed forms and brute force."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import linprog

from centrode.cams.followers.base_circle import (
    Admissible,
    FollowerLayout,
    best_offset,
    exact_margin,
    least_base_radius,
)
from centrode.cams.followers.geometry import Face, Point
from centrode.errors import InputError, MotionError
from follower_motions import lift_of, rise_dwell_fall_dwell

EPS = float(np.finfo(float).eps)
TURN = math.tau
MANY = np.linspace(0.0, TURN, 400_001)
RISE, FALL = math.radians(30), math.radians(42)
MOTION = lift_of((100, 0.02, "cycloidal"), (60, None, "dwell"), (80, 0.0, "3-4-5"), (120, None, "dwell"))


def test_the_worked_flat_face() -> None:
    """Base radius 1.893 for a least radius of curvature of 0.25: 0.25 less the least of s + s''."""
    motion = rise_dwell_fall_dwell(1.0)
    found = least_base_radius(FollowerLayout("translating", Face()), motion, Admissible(bend=0.25))
    assert round(found.base_radius, 3) == 1.893
    s, _v, a = motion.lift(MANY, 2)
    step = float(np.abs(np.diff(s + a, 2)).max())  # what a greatest value may lose between two places
    assert 0 <= found.base_radius - (0.25 - (s + a).min()) < step
    cam = FollowerLayout("translating", Face()).cam(motion, found.base_radius)
    assert cam.bends.least == pytest.approx(0.25, rel=32 * EPS * 1.893 / 0.25)
    assert found.by == "curvature"


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("offset", [0.0, 0.006, -0.004])
def test_the_pressure_angle_decides_as_in_the_textbook(offset: float, sense: float) -> None:
    """tan(alpha) = (s' - e)/(y0 + s) asks for a height at every angle; the greatest of them counts."""
    layout = FollowerLayout("translating", Point(0.008), offset, sense=sense)
    found = least_base_radius(layout, MOTION, Admissible(RISE, FALL))
    s, v = MOTION.lift(MANY, 1)
    across = np.abs(v - sense * offset)
    asked = [
        float((across[here] / math.tan(most) - s[here]).max())
        for here, most in ((v >= 0, RISE), (v <= 0, FALL))
    ]
    least = math.hypot(max(asked), offset) - 0.008
    assert 0 <= found.base_radius - least < 1e-9
    cam = layout.cam(MOTION, found.base_radius)
    assert min(RISE - cam.pressure.greatest, FALL + cam.pressure.least) == pytest.approx(0.0, abs=64 * EPS)
    assert found.by == "pressure angle" and found.offset == offset


def test_a_radius_of_curvature_decides() -> None:
    layout = FollowerLayout("translating", Point(0.008), 0.003)
    found = least_base_radius(layout, MOTION, Admissible(RISE, FALL, 0.02))
    cam = layout.cam(MOTION, found.base_radius)
    bend, at = cam.least_bend
    assert found.by == "curvature" and found.at == pytest.approx(at, abs=1e-6)
    assert bend == pytest.approx(0.02, rel=64 * EPS * 0.05 / 0.02)
    assert cam.pressure.greatest < RISE
    smaller = layout.cam(MOTION, found.base_radius * (1 - 1e-9))
    assert smaller.least_bend[0] < 0.02


def test_without_bounds_the_least_cam_is_just_not_undercut() -> None:
    layout = FollowerLayout("translating", Point(0.03))
    motion = rise_dwell_fall_dwell(0.03)
    found = least_base_radius(layout, motion, Admissible())
    assert not layout.cam(motion, found.base_radius * (1 + 1e-9)).undercuts
    assert layout.cam(motion, found.base_radius * (1 - 1e-6)).undercuts


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_best_offset_by_straight_lines(sense: float) -> None:
    """In the plane of (s', s) every sample asks the centre (e, -y0) to lie below two lines.

    The corner of that cone is a linear programme; no point of it, found by force, is nearer to the start.
    """
    layout = FollowerLayout("translating", Point(0.008), sense=sense)
    found = best_offset(layout, MOTION, Admissible(RISE, FALL))
    s, v = MOTION.lift(MANY[::400], 1)
    rows, rights = [], []
    for here, most in ((v >= 0, RISE), (v <= 0, FALL)):
        for sign in (1.0, -1.0):
            # sign (v - e) <= tan (y0 + s)
            rows.append(np.stack([np.full(here.sum(), -sign), np.full(here.sum(), -math.tan(most))], axis=-1))
            rights.append(math.tan(most) * s[here] - sign * v[here])
    a, b = np.concatenate(rows), np.concatenate(rights)
    lowest = linprog([0.0, 1.0], A_ub=a, b_ub=b, bounds=[(None, None), (0, None)]).x
    offsets = np.linspace(-0.01, 0.01, 1001)
    heights = np.max((b[:, None] - a[:, :1] * offsets) / a[:, 1:], axis=0, where=True, initial=0.0)
    brute = float(np.hypot(offsets, heights).min())
    # what a line may lose between two samples, and an offset between two that were tried, of slope 1/tan at most
    lost = float(np.abs(np.diff(v, 2)).max()) / math.tan(RISE)
    assert math.hypot(*lowest) - 1e-9 <= found.base_radius + 0.008 <= math.hypot(*lowest) + lost + 1e-9
    assert brute - 2e-5 / math.tan(RISE) <= found.base_radius + 0.008 <= brute + lost + 1e-9
    assert found.base_radius < least_base_radius(layout, MOTION, Admissible(RISE, FALL)).base_radius
    assert math.copysign(1.0, found.offset) == sense  # towards the rise


def test_the_best_offset_with_both_bounds_by_force() -> None:
    layout, kept = FollowerLayout("translating", Point(0.008)), Admissible(RISE, FALL, 0.006)
    found = best_offset(layout, MOTION, kept)
    tried = [
        least_base_radius(FollowerLayout("translating", Point(0.008), e), MOTION, kept).base_radius
        for e in np.linspace(found.offset - 0.002, found.offset + 0.002, 5)
    ]
    assert found.base_radius <= min(tried) * (1 + 1e-9)


def test_the_best_offset_of_a_flat_face_is_the_middle_of_its_contact() -> None:
    layout = FollowerLayout("translating", Face(), 0.001, sense=-1.0)
    found = best_offset(layout, MOTION, Admissible(bend=0.004))
    cam = FollowerLayout("translating", Face(), found.offset, sense=-1.0).cam(MOTION, found.base_radius)
    assert cam.face.greatest == pytest.approx(-cam.face.least, rel=64 * EPS)
    _s, v = MOTION.lift(MANY, 1)
    assert cam.face.greatest - cam.face.least == pytest.approx(v.max() - v.min(), rel=1e-9)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_oscillating_followers(sense: float) -> None:
    motion = rise_dwell_fall_dwell(math.radians(8))
    for layout, kept in (
        (
            FollowerLayout("oscillating", Point(0.008), arm=0.08, distance=0.09, sense=sense),
            Admissible(0.6, 0.6),
        ),
        (
            FollowerLayout("oscillating", Face(), distance=0.15, face_offset=0.003, sense=sense),
            Admissible(bend=0.004),
        ),
    ):
        found = least_base_radius(layout, motion, kept)
        cam = layout.cam(motion, found.base_radius)
        assert abs(exact_margin(cam, layout, kept).least) < 64 * EPS / 0.004
        # none of thirty smaller cams keeps what is admissible
        for share in np.linspace(0.3, 0.9999, 30):
            try:
                smaller = layout.cam(motion, share * found.base_radius)
            except InputError:
                continue
            phi = np.linspace(0.0, TURN, 2001)
            contact = smaller.contact(phi)
            worst = np.abs(contact.pressure_angle).max() > 0.6 - 1e-12 or contact.bend.min() < kept.bend
            assert worst or (contact.speed < 0).any()


def test_what_no_cam_can_keep_is_told() -> None:
    motion = rise_dwell_fall_dwell(math.radians(25))
    layout = FollowerLayout("oscillating", Point(0.008), arm=0.08, distance=0.09)
    with pytest.raises(MotionError, match=r"the pressure angle is always violated at .* deg"):
        least_base_radius(layout, motion, Admissible(0.1, 0.1))
    uniform = lift_of((90, 0.01, "uniform"), (90, None, "dwell"), (90, 0.0, "uniform"), (90, None, "dwell"))
    with pytest.raises(
        MotionError, match="at 90 deg the velocity of the lift jumps: every base radius leaves a sharp"
    ):
        least_base_radius(FollowerLayout("translating", Point(0.008)), uniform, Admissible())
    edge = FollowerLayout("translating", Point(0.0))
    assert least_base_radius(edge, uniform, Admissible(0.5, 0.5)).by == "pressure angle"
    with pytest.raises(MotionError, match="sharp corner"):
        least_base_radius(edge, uniform, Admissible(0.5, 0.5, 0.001))
    with pytest.raises(InputError, match="only a translating follower"):
        best_offset(layout, motion, Admissible())
    with pytest.raises(InputError, match="turn faster than the cam"):
        quick = lift_of((20, 0.5, "cycloidal"), (320, 0.0, "cycloidal"), (20, None, "dwell"))
        FollowerLayout("oscillating", Face(), distance=0.2, sense=-1.0).cam(quick, 0.03)


def test_a_knife_edge_is_bound_by_curvature_only_where_asked() -> None:
    layout = FollowerLayout("translating", Point(0.0))
    free = least_base_radius(layout, MOTION, Admissible(RISE, FALL))
    bent = least_base_radius(layout, MOTION, Admissible(RISE, FALL, 0.03))
    assert free.by == "pressure angle" and bent.by == "curvature"
    assert layout.cam(MOTION, bent.base_radius).least_bend[0] == pytest.approx(0.03, rel=64 * EPS)


SLOW = lift_of((180, 0.2, "harmonic"), (180, 0.0, "harmonic"))
"""Radians: so slow that an arm may stand as it likes."""


def test_bounds_that_decide_nothing_are_told() -> None:
    """s + s'' of a slow harmonic lift h (1 - cos phi)/2 is h/2 everywhere: a flat face needs no base circle at all."""
    slow = lift_of((180, 0.02, "harmonic"), (180, 0.0, "harmonic"))
    assert (
        least_base_radius(FollowerLayout("translating", Face()), slow, Admissible(1.0, 1.0)).by == "nothing"
    )
    bent = least_base_radius(FollowerLayout("translating", Face()), slow, Admissible(bend=0.03))
    assert bent.by == "curvature" and bent.base_radius == pytest.approx(0.02, rel=64 * EPS)
    # The end of an arm stays on one side of the pivot: base and roller are more than |d - l|, whatever is asked.
    arm = FollowerLayout("oscillating", Point(0.01), arm=0.1, distance=0.12)
    free = least_base_radius(arm, SLOW, Admissible(bend=0.001))
    assert free.by == "nothing" and 0 < free.base_radius - 0.01 < 1e-10


@pytest.mark.parametrize("most", [1.1, 1.3, 1.5])
def test_the_least_cam_of_an_arm_that_hardly_reaches(most: float) -> None:
    """Below the least radius the pressure angle is broken, however near that is to the one the arm reaches."""
    arm = FollowerLayout("oscillating", Point(0.01), arm=0.1, distance=0.12)
    found = least_base_radius(arm, SLOW, Admissible(most, most))
    assert found.by == "pressure angle"

    def steepest(base: float) -> float:
        # tan(alpha) = (l (psi' + 1) - d cos(psi))/(d sin(psi)), the textbook's
        start = math.acos((0.1**2 + 0.12**2 - (base + 0.01) ** 2) / (2 * 0.1 * 0.12))
        lift, slope = SLOW.lift(MANY, 1)
        psi = start + lift
        tangent = (0.1 * (slope + 1) - 0.12 * np.cos(psi)) / (0.12 * np.sin(psi))
        return float(np.abs(np.arctan(tangent)).max())

    assert steepest(found.base_radius * (1 + 1e-6)) < most < steepest(found.base_radius * (1 - 1e-6))
