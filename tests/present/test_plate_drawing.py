"""Figures of cams with followers: what is drawn, and that it is drawn where the cam is."""

from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.patches import Circle

import centrode as ct
from centrode.cams.followers.profile_results import follower_profile_results
from centrode.render.outline_drawings import PENS
from centrode.sheets.outlines import LineUse

LIFTER = """
title = "Lifter $5"
kind = "cam"
display = { length = "mm", angle = "deg" }
[cam]
base_radius = "20 mm"
turn = "clockwise"
[follower]
contact = "roller"
roller_radius = "16 mm"
offset = "-5 mm"
[[segments]]
angle = "40 deg"
to = "25 mm"
curve = "cycloidal"
[[segments]]
angle = "320 deg"
to = 0
curve = "cycloidal"
[bounds]
pressure_angle = "60 deg"
[tool]
radius = "6 mm"
[study]
show_undercut = true
"""


@pytest.fixture(scope="module")
def cam() -> ct.PlateCam:
    found = ct.parse_cam(LIFTER)
    assert isinstance(found, ct.PlateCam)
    return found


@pytest.fixture(scope="module")
def figures(cam: ct.PlateCam) -> dict[str, Figure]:
    return ct.figures(follower_profile_results(cam, 91))


def test_profile_roller_and_undercut_are_drawn(cam: ct.PlateCam, figures: dict[str, Figure]) -> None:
    (axes,) = figures["cam-body"].axes
    body = ct.follower_cam(cam)
    circles = {round(one.radius, 6): one.center for one in axes.patches if isinstance(one, Circle)}
    np.testing.assert_allclose(circles[16.0], (-5.0, math.sqrt(36.0**2 - 25.0)), rtol=1e-12)
    assert circles[20.0] == (0.0, 0.0)
    (cut,) = body.undercuts
    colour = PENS[LineUse.UNDERCUT]["color"]
    red = [line.get_xydata() for line in axes.lines if to_hex(line.get_color()).upper() == colour]
    ends = 1e3 * body.contact(np.array([cut.start, cut.stop])).place
    np.testing.assert_allclose([red[0][0], red[-1][-1]], ends, atol=1e-9)
    drawn = np.concatenate([np.asarray(line.get_xydata()) for line in axes.lines])
    phi = np.linspace(0.0, 6.28, 100)
    place = 1e3 * body.contact(phi).place
    assert (
        np.abs(place[:, None] - drawn).max(axis=2).min(axis=1).max() < 1.0
    )  # points of the profile are near
    legend = [text.get_text() for text in axes.get_legend().get_texts()]
    assert {"profile of the cam", "path of the cutter's centre", "undercut", "follower"} <= set(legend)


def test_curves_show_what_is_admissible(figures: dict[str, Figure]) -> None:
    pressure, bend = figures["cam-curvature"].axes
    levels = {round(float(np.asarray(line.get_ydata())[0]), 9) for line in pressure.lines}
    assert {60.0, -60.0} <= levels
    shown = np.asarray(bend.lines[0].get_ydata())
    assert np.nanmax(np.abs(shown)) <= 80.0  # four base radii
    assert np.isnan(shown).any()


def test_every_follower_is_drawn() -> None:
    flat = LIFTER.replace('contact = "roller"\nroller_radius = "16 mm"', 'contact = "flat"')
    swinging = LIFTER.replace(
        'contact = "roller"\nroller_radius = "16 mm"\noffset = "-5 mm"',
        'kind = "oscillating"\ncontact = "flat"\npivot_distance = "90 mm"',
    ).replace("25 mm", "4 deg")
    arm = LIFTER.replace('offset = "-5 mm"', 'kind = "oscillating"\narm = "60 mm"\npivot_distance = "70 mm"')
    for text in (flat, swinging, arm.replace("25 mm", "12 deg")):
        found = ct.figures(follower_profile_results(ct.parse_cam(text)))["cam-body"]
        found.draw_without_rendering()
        assert found.axes[0].get_xlabel() == "x, mm"
