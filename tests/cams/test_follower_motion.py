"""Motion of a follower: peaks against the literature, formulas of other hands, jumps where segments meet."""

from __future__ import annotations

import math
import sys

import mpmath as mp
import numpy as np
import pytest

import centrode as ct
from centrode.cams.cam import cam_routes
from centrode.cams.followers.motion import (
    FollowerMotion,
    cam_laws,
    compare_laws,
    first_jump,
    follower_motion,
    joints_of,
    peaks_of,
)
from centrode.cams.followers.motion_results import follower_motion_results
from centrode.cams.path_series import path_of
from centrode.cams.profiles import cam_body
from centrode.errors import InputError
from centrode.laws import CURVES, LawSegment, SegmentedLaw

EPS = sys.float_info.epsilon
PI = math.pi

# R. L. Norton, Cam Design and Manufacturing Handbook, 2009, chapters 2 and 3: as printed, and the closed forms.
LITERATURE = {
    "harmonic": (1.571, 4.935, 15.50, (PI / 2, PI**2 / 2, PI**3 / 2)),
    "cycloidal": (2.0, 6.283, 39.48, (2.0, 2 * PI, 4 * PI**2)),
    "3-4-5": (1.875, 5.773, 60.0, (15 / 8, 10 / math.sqrt(3), 60.0)),
    "4-5-6-7": (2.188, 7.513, 52.5, (35 / 16, 84 * math.sqrt(5) / 25, 52.5)),
    "trapezoid": (2.0, 5.333, 42.67, (2.0, 16 / 3, 128 / 3)),
    "modified sine": (1.760, 5.528, 69.47, (4 * PI / (4 + PI), 4 * PI**2 / (4 + PI), 16 * PI**3 / (4 + PI))),
    "modified trapezoid": (2.0, 4.888, 61.43, (2.0, 8 * PI / (2 + PI), 32 * PI**2 / (2 + PI))),
}


@pytest.mark.parametrize("name", LITERATURE)
def test_peak_coefficients_are_those_of_the_literature(name: str) -> None:
    *printed, exact = LITERATURE[name]
    found = peaks_of(SegmentedLaw((LawSegment(1.0, 1.0, name),))).coefficients
    for value, text, closed in zip(found, printed, exact, strict=True):
        assert value == pytest.approx(closed, rel=64 * EPS)
        # Four figures are printed; the last of 5.773 is cut, not rounded.
        assert abs(value - text) <= 10.0 ** (math.floor(math.log10(text)) - 3)


@pytest.mark.parametrize("rise", [0.025, -0.4])
@pytest.mark.parametrize("angle", [0.3, 2.5])
@pytest.mark.parametrize("name", LITERATURE)
def test_coefficients_do_not_depend_on_rise_and_angle(name: str, rise: float, angle: float) -> None:
    law = SegmentedLaw(
        (LawSegment(0.7, 0.5, "uniform"), LawSegment(angle, 0.5 + rise, name), LawSegment(1.0, 0.0, "3-4-5"))
    )
    found, expected = peaks_of(law, 1), peaks_of(SegmentedLaw((LawSegment(1.0, 1.0, name),)))
    # The angle of a place is rounded beside 0.7 + 2.5; the next derivative, at most 4 pi times as great, carries it on.
    rounding = 64 * EPS * 4 * PI * (1 + 0.7 / angle) * (1 + 1.0 / abs(rise))
    assert found.coefficients == pytest.approx(expected.coefficients, rel=rounding)
    assert found.torque == pytest.approx(expected.torque, rel=2 * rounding)
    assert found.first_jump == expected.first_jump


def test_velocity_times_acceleration_has_its_closed_forms() -> None:
    expected = {
        "parabolic": 8.0,  # 4 u times 4, up to the middle
        "trapezoid": 80 / 9,  # 5/3 times 16/3, where the acceleration begins to fall
        "harmonic": PI**3 / 8,  # pi/2 sin x pi^2/2 cos x
        "cycloidal": 3 * math.sqrt(3) * PI / 2,  # (1 - cos x) 2 pi sin x, greatest at 120 deg
        "uniform": 0.0,
    }
    for name, value in expected.items():
        found = peaks_of(SegmentedLaw((LawSegment(1.0, 1.0, name),))).torque
        assert found == pytest.approx(value, rel=64 * EPS, abs=0)


def test_where_laws_jump_against_dwells() -> None:
    found = {name: peaks_of(SegmentedLaw((LawSegment(1.0, 1.0, name),))).first_jump for name in CURVES}
    assert found == {
        "uniform": 1,
        "parabolic": 2,
        "harmonic": 2,
        "cycloidal": 3,
        "3-4-5": 3,
        "4-5-6-7": 4,
        "trapezoid": 3,
        "modified sine": 3,
        "modified trapezoid": 3,
    }
    smooth = SegmentedLaw((LawSegment(1.0, 1.0, "polynomial", (0.0,) * 4, (0.0,) * 4),))
    assert peaks_of(smooth).first_jump is None


def cam(segments: list[dict[str, object]], **follower: object) -> ct.PlateCam:
    roller = {"contact": "roller", "roller_radius": "10 mm"}
    return ct.PlateCam(
        kind="cam", cam={"base_radius": "40 mm"}, follower={**roller, **follower}, segments=segments
    )


def rise_and_fall(curve: str) -> ct.PlateCam:
    return cam(
        [
            {"angle": "100 deg", "to": "24 mm", "curve": curve},
            {"angle": "40 deg", "curve": "dwell"},
            {"angle": "120 deg", "to": 0, "curve": curve},
            {"angle": "100 deg", "curve": "dwell"},
        ]
    )


CLOSED = {
    "harmonic": lambda u: (1 - mp.cos(mp.pi * u)) / 2,
    "cycloidal": lambda u: u - mp.sin(2 * mp.pi * u) / (2 * mp.pi),
    "3-4-5": lambda u: 10 * u**3 - 15 * u**4 + 6 * u**5,
    "4-5-6-7": lambda u: 35 * u**4 - 84 * u**5 + 70 * u**6 - 20 * u**7,
}


@pytest.mark.parametrize("name", CLOSED)
def test_lift_and_derivatives_are_those_of_the_closed_form(name: str) -> None:
    """To the sixth derivative, beside forty digits, in a rise and in a fall."""
    motion, order = follower_motion(rise_and_fall(name)), 6
    with mp.workdps(40):
        for start, angle, before, after in ((0.0, 100, 0.0, 24e-3), (140.0, 120, 24e-3, 0.0)):
            beta = mp.mpf(angle) * mp.pi / 180
            for share in (0.11, 0.37, 0.5, 0.82):
                phi = math.radians(start + share * angle)
                u = (mp.mpf(phi) - mp.mpf(start) * mp.pi / 180) / beta
                found = motion.lift(phi, order)
                terms = mp.taylor(CLOSED[name], u, order)
                for k in range(order + 1):
                    rise = mp.mpf(after) - mp.mpf(before)
                    expected = terms[k] * mp.factorial(k) * rise / beta**k + (before if k == 0 else 0)
                    # A rounding of the angle counts with the next derivative: of no curve above 840 (2 pi)^k here.
                    margin = 32 * EPS * 840 * (2 * PI) ** max(k - 3, 0) * 24e-3 / float(beta) ** k
                    assert abs(found[k] - float(expected)) <= margin


def test_the_lift_is_periodic() -> None:
    motion = follower_motion(rise_and_fall("cycloidal"))
    phi = np.linspace(0.05, 6.2, 40)
    for turns in (-3, 1, 50):
        found, once = motion.lift(phi + turns * math.tau, 2), motion.lift(phi, 2)
        # The angle loses digits by the turns in front of it, the next derivative carries that on.
        margin = 4 * EPS * abs(turns) * math.tau * np.abs(motion.lift(phi, 3)).max(axis=1)[1:]
        assert (np.abs(found - once).max(axis=1) <= margin + EPS).all()
    assert motion.lift(0.0).shape == (1,) and motion.lift(phi.reshape(8, 5), 3).shape == (4, 8, 5)


@pytest.mark.parametrize("order", [-1, 21, 1.5, True])
def test_orders_are_bounded(order: object) -> None:
    motion = follower_motion(rise_and_fall("3-4-5"))
    if order is True:
        assert motion.lift(0.5, True).shape == (2,)
        return
    with pytest.raises(InputError, match="derivatives from 0 to 20"):
        motion.lift(0.5, order)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "order", "size"),
    [
        ("uniform", 1, 1.0),
        ("harmonic", 2, PI**2 / 2),
        ("cycloidal", 3, 4 * PI**2),
        ("3-4-5", 3, 60.0),
        ("4-5-6-7", 4, 840.0),
    ],
)
def test_jumps_at_joints_are_those_of_the_curves(name: str, order: int, size: float) -> None:
    motion = follower_motion(rise_and_fall(name))
    assert first_jump(motion) == order
    joints = joints_of(motion)
    assert [joint.first_jump for joint in joints] == [order] * 4
    # Derivatives before the end of the rise are those of a curve mirrored at both its ends.
    sides = [
        (0, 100, 1, -((-1.0) ** (order + 1))),
        (1, 120, 0, -1.0),
        (2, 120, 0, (-1.0) ** (order + 1)),
        (3, 100, 1, 1),
    ]
    for number, angle, _side, sign in sides:
        expected = sign * size * 24e-3 / math.radians(angle) ** order
        assert joints[number].jumps[order] == pytest.approx(expected, rel=1e3 * EPS)
        assert joints[number].jumps[:order] == (0.0,) * order
    assert [round(math.degrees(joint.angle)) for joint in joints] == [100, 140, 260, 360]


def matched(draw: np.random.Generator, order: int) -> tuple[list[LawSegment], np.ndarray]:
    """Polynomials around a turn that agree at every joint up to an order."""
    angles = draw.uniform(0.3, 1.0, 4)
    angles *= math.tau / angles.sum()
    rates = draw.normal(size=(4, order)) * 0.01
    lifts = [*draw.uniform(0.01, 0.03, 3), 0.0]
    segments = [
        LawSegment(
            float(angle), float(lift), "polynomial", tuple(rates[k - 1].tolist()), tuple(rates[k].tolist())
        )
        for k, (angle, lift) in enumerate(zip(angles, lifts, strict=True))
    ]
    return segments, rates


@pytest.mark.parametrize("seed", range(6))
def test_no_jump_is_seen_where_segments_agree_and_each_is_where_they_do_not(seed: int) -> None:
    draw = np.random.default_rng(seed)
    segments, rates = matched(draw, 4)
    assert first_jump(FollowerMotion(SegmentedLaw(tuple(segments), True))) is None
    order = 1 + seed % 4
    # A part in 10^9 is far above rounding and far below what a drawing shows.
    moved = rates[1].copy()
    moved[order - 1] *= 1 + 1e-9
    one = segments[2]
    segments[2] = LawSegment(one.time, one.to, one.curve, tuple(moved.tolist()), one.at_end)
    joints = joints_of(FollowerMotion(SegmentedLaw(tuple(segments), True)))
    assert [joint.first_jump for joint in joints] == [None, order, None, None]
    expected = moved[order - 1] - rates[1, order - 1]
    # The jump is the difference of two numbers that are each right to some roundings.
    assert joints[1].jumps[order] == pytest.approx(expected, rel=0, abs=1e3 * EPS * abs(rates[1]).max())


def test_inner_jumps_of_curves_of_several_formulas_count() -> None:
    whole = cam(
        [
            {
                "angle": "180 deg",
                "to": "20 mm",
                "curve": "b-spline",
                "degree": 3,
                "through": [["60 deg", "4 mm"], ["90 deg", "8 mm"]],
                "at_start": [0],
                "at_end": [0],
            },
            {"angle": "180 deg", "to": 0, "curve": "polynomial", "at_start": [0], "at_end": [0]},
        ]
    )
    motion = follower_motion(whole)
    assert first_jump(motion) == 2  # nothing is asked of the acceleration
    assert motion.law.segments[0].inner_jump == 3
    sine = SegmentedLaw((LawSegment(1.0, 1.0, "modified sine"),))
    assert sine.segments[0].inner_jump == 4


def test_a_swinging_follower_has_angles() -> None:
    swinging = ct.PlateCam(
        kind="cam",
        cam={"base_radius": "40 mm", "speed": "300 rpm"},
        follower={
            "kind": "oscillating",
            "contact": "roller",
            "roller_radius": "8 mm",
            "arm": "90 mm",
            "pivot_distance": "110 mm",
        },
        segments=[
            {
                "angle": "180 deg",
                "to": "20 deg",
                "curve": "polynomial",
                "at_start": ["0 deg/rad", 0],
                "at_end": [0, 0],
            },
            {"angle": "180 deg", "to": 0, "curve": "cycloidal"},
        ],
    )
    motion = follower_motion(swinging)
    assert motion.swings and motion.unit == "rad" and motion.speed == pytest.approx(10 * PI)
    data = ct.cam(swinging, at=[PI / 2])
    assert float(data.swing[0]) == pytest.approx(PI / 18, rel=8 * EPS)
    assert float(data.swing_velocity[0]) == pytest.approx(15 / 8 * (PI / 9) / PI * 10 * PI, rel=16 * EPS)
    assert data.swing_second.attrs["units"] == "1/rad" and data.swing_jerk.attrs["units"] == "rad/s^3"
    assert data.joint_before.attrs["units"] == "rad, 1, 1/rad, 1/rad^2, 1/rad^3"


def test_compared_laws_are_scaled_to_one_rise() -> None:
    found = compare_laws(0.01, 0.5, 20.0, ["cycloidal", "harmonic"], samples=5)
    assert found.law.values.tolist() == ["cycloidal", "harmonic"]
    assert found.rise_share.sel(law="harmonic", derivative=0).values == pytest.approx(
        [(1 - math.cos(PI * u)) / 2 for u in (0, 0.25, 0.5, 0.75, 1)], abs=4 * EPS
    )
    assert found.attrs["speed"] == 20.0


def test_laws_of_a_cam_hold_its_own() -> None:
    own = cam(
        [
            {"angle": "90 deg", "curve": "dwell"},
            {"angle": "90 deg", "to": "10 mm", "curve": "polynomial", "at_start": [0, 0], "at_end": [0, 0]},
            {"angle": "180 deg", "to": 0, "curve": "cycloidal"},
        ]
    )
    found = cam_laws(own)
    assert found.law.values.tolist() == [*CURVES, "its own"]
    assert found.attrs["segment"] == 1
    # The polynomial by these conditions is the 3-4-5.
    assert found.peak_coefficient.sel(law="its own").values[1:] == pytest.approx(
        found.peak_coefficient.sel(law="3-4-5").values[1:], rel=256 * EPS
    )
    apart = found.rise_share.sel(law="its own") - found.rise_share.sel(law="3-4-5")
    assert np.abs(apart).max() <= 64 * EPS * 60


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"curves": ["cycloid"]}, 'no curve "cycloid"; did you mean "cycloidal"'),
        ({"curves": []}, "no law is given"),
        ({"rise": 0.0}, "a rise needs a height"),
        ({"angle": -1.0}, "a positive angle"),
        ({"angle": math.inf}, "a positive angle"),
    ],
)
def test_bad_comparisons_are_refused(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        compare_laws(**arguments)  # type: ignore[arg-type]


def test_other_kinds_of_cams_are_told_apart() -> None:
    curvature, plate = ct.example("cam-from-curvature"), rise_and_fall("3-4-5")
    for call in (follower_motion, cam_laws):
        with pytest.raises(InputError, match="given by a curvature law"):
            call(curvature)
    for call in (
        path_of,
        cam_routes,
        cam_body,
        ct.cam_contact,
        ct.choose_cam,
        ct.walking_wheel,
    ):
        with pytest.raises(InputError, match="given by its follower's lift"):
            call(plate)


def narrow() -> ct.PlateCam:
    return cam(
        [
            {"angle": "150 deg", "to": "20 mm", "curve": "uniform"},
            {"angle": "0.5 deg", "to": "20.01 mm", "curve": "modified trapezoid"},
            {"angle": "209.5 deg", "to": 0, "curve": "harmonic"},
        ]
    )


def test_what_is_drawn_does_not_depend_on_samples() -> None:
    """A segment between two samples is drawn all the same, from joint to joint."""
    data = ct.cam(narrow(), samples=3)
    assert data.sizes["sample"] == 3
    angle, velocity = data.drawn_angle.values, data.drawn_motion.sel(derivative=1).values
    inside = (angle > math.radians(150)) & (angle < math.radians(150.5))
    # C_v = 2 at the middle, which is a break of the curve and so a place.
    assert velocity[inside].max() == pytest.approx(2 * 1e-5 / math.radians(0.5), rel=1e-9)
    assert angle[0] == 0 and angle[-1] == data.joint_angle.values[-1]
    # Each place is rounded by half a unit of a turn's last place.
    assert (np.diff(angle) >= 0).all() and np.diff(angle).max() <= math.radians(1.0) + 2 * EPS * math.tau
    both = np.flatnonzero(np.isclose(angle, math.radians(150), rtol=1e-15))
    assert velocity[both].tolist() == pytest.approx([20e-3 / math.radians(150), 0.0], rel=1e-12)


def test_jumps_are_drawn_as_such() -> None:
    plate = narrow()
    figure = ct.figures(follower_motion_results(plate, samples=3))["cam-motion"]
    dashed = [[line for line in axes.lines if line.get_linestyle() == "--"] for axes in figure.axes]
    # Of the lift none; of the velocity two, at both ends of the turn and at 150 deg.
    assert [len(lines) for lines in dashed][:2] == [0, 3]
    heights = sorted(float(np.ptp(line.get_ydata())) for line in dashed[1])
    assert heights == pytest.approx([20e-3 / math.radians(150)] * 3, rel=1e-12)
    assert [text.get_text() for text in figure.axes[0].texts] == ["uniform", "2", "harmonic"]


@pytest.mark.parametrize(
    "wrong",
    [
        {"follower": 5},
        {"follower": {"contact": "knife"}, "segments": 3},
        {"follower": {"contact": "knife"}, "segments": [3]},
        {"follower": {"kind": ["oscillating"]}, "segments": []},
        {"follower": {"contact": "knife", "spring": 3}, "segments": []},
        {"follower": {"contact": "knife"}, "segments": [{"angle": math.nan, "curve": "dwell"}]},
        {"follower": {"contact": "knife"}, "segments": [{"angle": 1e9, "curve": "dwell"}]},
    ],
)
def test_what_is_no_cam_in_python_is_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(InputError):
        ct.PlateCam(kind="cam", **wrong)


def test_constant_acceleration_turns_round_in_the_middle_of_a_rise() -> None:
    """s = 2 h u^2, then mirrored: the acceleration 4 h / beta^2 changes its sign at once, and results say so."""
    results = follower_motion_results(rise_and_fall("parabolic"))
    assert results.first_jump == 2 and results.peaks[0].coefficients == pytest.approx(
        (2.0, 4.0, 0.0), abs=64 * EPS
    )
    rise, fall = results.inner_joints
    for joint, middle, angle, sign in ((rise, 50, 100, 1), (fall, 200, 120, -1)):
        size = sign * 4 * 24e-3 / math.radians(angle) ** 2
        assert math.degrees(joint.angle) == pytest.approx(middle, rel=8 * EPS)
        assert (joint.before[2], joint.after[2]) == pytest.approx((size, -size), rel=64 * EPS)
        assert joint.jumps[:2] == (0.0, 0.0) and joint.jumps[2] == pytest.approx(-2 * size, rel=64 * EPS)
    # the figure has a dashed line at each of the six jumps and at the beginning of the turn, the table a row
    figure = ct.figures(results)["cam-motion"]
    dashed = [[line for line in axes.lines if line.get_linestyle() == "--"] for axes in figure.axes]
    assert [len(lines) for lines in dashed] == [0, 0, 7, 0]
    assert "inside them" in ct.summary(results)


def test_laws_are_drawn_from_both_sides_of_a_jump() -> None:
    found = compare_laws(curves=["parabolic", "trapezoid"])
    share = found.drawn_share.values
    middle = np.flatnonzero(np.abs(share - 0.5) < 1e-12)
    assert len(middle) == 2 and (np.diff(share) > 0).all()
    drawn = found.drawn_rise.sel(law="parabolic", derivative=2).values[middle]
    assert drawn.tolist() == [4.0, -4.0]
    corner = np.flatnonzero(np.abs(share - 0.125) < 1e-12)
    jerk = found.drawn_rise.sel(law="trapezoid", derivative=3).values[corner]
    assert jerk == pytest.approx([128 / 3, 0.0], rel=64 * EPS, abs=0)
