"""The base radius that a roller allows: its ratios to the radius of curvature and to the size of its path."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.cams.followers.base_circle import least_cam

EPS = float(np.finfo(float).eps)
SEGMENT = '[[segments]]\nangle = "{angle} deg"\ncurve = "{curve}"\n'


def cam_text(roller: float, lift: float, angle: float, bounds: str, curve: str = "harmonic") -> str:
    """A rise, a fall of the same law, a dwell; lengths in metres, angles in degrees."""
    rise = SEGMENT.format(angle=angle, curve=curve)
    return (
        f'kind = "cam"\n[follower]\nroller_radius = {roller}\n[bounds]\n{bounds}\n'
        + f"{rise}to = {lift}\n{rise}to = 0\n"
        + SEGMENT.format(angle=360 - 2 * angle, curve="dwell")
    )


def body_of(text: str) -> tuple[ct.PlateCam, float, str]:
    cam = ct.parse_cam(text)
    assert isinstance(cam, ct.PlateCam)
    least = least_cam(cam)
    body = ct.follower_cam(cam)
    assert body.base_radius == least.base_radius and not body.undercuts
    return cam, body.base_radius, least.by


def tip(ratio: float, roller: float, lift: float, angle: float) -> float:
    """Base radius with which at the tip of a harmonic lift the roller has its ratio, in closed form.

    There s' = 0 and s'' = -c with c = pi^2 h/(2 beta^2), so that 1/K = y^2/(y + c) of the height y = r0 + r + h.
    """
    bend = math.pi**2 * lift / (2 * math.radians(angle) ** 2)
    asked = roller / ratio
    return 0.5 * (asked + math.sqrt(asked**2 + 4 * asked * bend)) - lift - roller


@pytest.mark.parametrize(
    ("roller", "lift", "angle"), [(0.01, 0.01, 40.0), (0.02, 0.01, 40.0), (0.005, 0.02, 30.0)]
)
@pytest.mark.parametrize("ratio", [None, 0.8, 0.7, 1.0])
def test_a_harmonic_lift(ratio: float | None, roller: float, lift: float, angle: float) -> None:
    bounds = 'pressure_angle = "85 deg"\nroller_to_radius = 1'
    bounds += "" if ratio is None else f"\nroller_to_curvature = {ratio}"
    _cam, found, by = body_of(cam_text(roller, lift, angle, bounds))
    assert by == ("curvature" if ratio == 1.0 else "roller to curvature")
    assert found == pytest.approx(tip(ratio or 0.8, roller, lift, angle), rel=1e-9)


def test_a_slow_lift_leaves_the_size_to_the_roller() -> None:
    """r = 0.4 (r0 + r): before, the cam might be as small as a thirtieth of its roller."""
    for bounds, ratio in (("", 0.4), ("\nroller_to_radius = 0.5", 0.5)):
        text = cam_text(0.02, 0.005, 120.0, 'pressure_angle = "30 deg"' + bounds, "3-4-5")
        _cam, found, by = body_of(text)
        assert by == "roller to radius" and found == pytest.approx(0.02 / ratio - 0.02, rel=1e-12)
    _cam, small, by = body_of(
        cam_text(0.02, 0.005, 120.0, "roller_to_radius = 1\nroller_to_curvature = 1", "3-4-5")
    )
    assert by == "curvature" and small < 0.001


def test_what_the_description_bounds_stands_in_place_of_the_ratios() -> None:
    bounds = 'pressure_angle = "60 deg"\ncurvature_radius = 0.001'
    cam, found, by = body_of(cam_text(0.01, 0.01, 40.0, bounds))
    assert by == "curvature" and found == pytest.approx(tip(1 / 1.1, 0.01, 0.01, 40.0), rel=1e-9)
    chosen = ct.choose_base_radius(cam).least
    assert chosen is not None and (chosen.base_radius, chosen.by) == (found, by)
    assert "radius up to 0.4 of the least radius of its path" in ct.summary(ct.choose_base_radius(cam))


def test_a_base_radius_that_is_given_keeps_ratios_that_are_given_alone() -> None:
    text = cam_text(0.01, 0.01, 40.0, 'pressure_angle = "60 deg"') + "[cam]\nbase_radius = 0.0175\n"
    chosen = ct.choose_base_radius(ct.parse_cam(text))
    assert chosen.margin is not None and chosen.margin.least > 0
    assert chosen.least is not None and chosen.least.base_radius > 0.02
    strict = text.replace("[bounds]\n", "[bounds]\nroller_to_radius = 0.3\n")
    broken = ct.choose_base_radius(ct.parse_cam(strict)).margin
    assert broken is not None and broken.by == "roller to radius"
    assert broken.least == pytest.approx(1 - 0.01 / (0.3 * 0.0275), rel=64 * EPS)


def test_reports_show_what_decides() -> None:
    for bounds, told in (
        ('pressure_angle = "60 deg"', "is 0.8 of the radius of curvature of its path"),
        ('pressure_angle = "60 deg"\nroller_to_radius = 0.1', "is 0.1 of the least radius of its path"),
    ):
        text = cam_text(0.01, 0.01, 40.0, bounds)
        report = ct.report(ct.parse_cam(text), ct.ReportOptions(chapters=("base-radius",)))
        assert told in repr(report.chapters)
        assert "violates none" in repr(report.chapters)


@pytest.mark.parametrize("ratio", ["0", "1.1", "-0.4", '"40 mm"', "true"])
def test_ratios_that_are_none(ratio: str) -> None:
    with pytest.raises(ct.InputError, match="roller_to_radius"):
        ct.parse_cam(cam_text(0.01, 0.01, 40.0, f"roller_to_radius = {ratio}"))


def test_ratios_are_of_rollers() -> None:
    text = cam_text(0.01, 0.01, 40.0, "roller_to_radius = 0.4")
    with pytest.raises(ct.InputError, match='"roller_to_radius" is used with a roller only'):
        ct.parse_cam(text.replace("roller_radius = 0.01", 'contact = "knife"'))
