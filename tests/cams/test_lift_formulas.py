"""Lifts that are given by a formula: against the built-in laws and closed forms, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.cams.followers.motion import follower_motion, joints_of

EPS = float(np.finfo(float).eps)
CYCLOIDAL = "s0 + h*(phi/beta - sin(2*pi*phi/beta)/(2*pi))"
HARMONIC = "s0 + h/2*(1 - cos(pi*phi/beta))"
CUBICS = "s0 + h*(10*(phi/beta)^3 - 15*(phi/beta)^4 + 6*(phi/beta)^5)"
CAM = """kind = "cam"
[cam]
base_radius = "30 mm"
speed = "300 rpm"
[follower]
roller_radius = "8 mm"
mass = 0.2
spring = { stiffness = 4000.0, preload = 60.0 }
[[segments]]
angle = "90 deg"
to = "20 mm"
CURVE
[[segments]]
angle = "60 deg"
curve = "dwell"
[[segments]]
angle = "100 deg"
to = 0
CURVE
[[segments]]
angle = "110 deg"
curve = "dwell"
"""


def cam_of(curve: str) -> ct.PlateCam:
    cam = ct.parse_cam(CAM.replace("CURVE", curve))
    assert isinstance(cam, ct.PlateCam)
    return cam


def whole_turn(lift: str, more: str = "") -> ct.PlateCam:
    text = f'kind = "cam"\n[cam]\nbase_radius = 0.03\n[follower]\nroller_radius = 0.008\n{more}'
    cam = ct.parse_cam(f'{text}[[segments]]\nangle = "360 deg"\nto = 0\nlift = "{lift}"\n')
    assert isinstance(cam, ct.PlateCam)
    return cam


@pytest.mark.parametrize(
    ("name", "formula"), [("cycloidal", CYCLOIDAL), ("harmonic", HARMONIC), ("3-4-5", CUBICS)]
)
def test_the_built_in_laws(name: str, formula: str) -> None:
    """Lift, exact derivatives, joints, profile and forces are those of the law by its name."""
    written, named = cam_of(f'lift = "{formula}"'), cam_of(f'curve = "{name}"')
    ours, theirs = (ct.cam(cam, 1441) for cam in (written, named))
    for order, variable in enumerate(("lift", "lift_slope", "lift_second", "lift_third", "lift_fourth")):
        most = float(np.abs(theirs[variable]).max())
        # powers of phi/beta cancel at the end; each derivative multiplies rounding by its own coefficients
        assert float(np.abs(ours[variable] - theirs[variable]).max()) <= 1e-12 * most, order
    jumps = [[one.jumps for one in joints_of(follower_motion(cam))] for cam in (written, named)]
    assert np.allclose(jumps[0], jumps[1], rtol=1e-9, atol=1e-12)
    assert [one.first_jump for one in joints_of(follower_motion(written))] == [
        one.first_jump for one in joints_of(follower_motion(named))
    ]
    profiles = [ct.cam_profile(cam) for cam in (written, named)]
    assert float(np.abs(profiles[0].profile - profiles[1].profile).max()) < 1e-15
    forces = [ct.cam_forces(cam, 91).contact_force for cam in (written, named)]
    assert np.allclose(*forces, rtol=1e-11)
    assert ct.parse_cam(ct.cam_text(written)) == written


def test_a_turn_by_one_formula() -> None:
    """An eccentric under a flat face: s = e (1 - cos phi), so that the profile is a circle of r0 + e."""
    text = 'kind = "cam"\n[cam]\nbase_radius = 0.03\n[follower]\ncontact = "flat"\n'
    cam = ct.parse_cam(f'{text}[[segments]]\nangle = "360 deg"\nto = 0\nlift = "0.01*(1 - cos(phi))"\n')
    profile = ct.cam_profile(cam, 181)
    centre = profile.profile.values[0] - np.array([0.0, 0.04])  # the lowest place lies e above the middle
    away = np.hypot(*(profile.profile.values - centre).T)
    assert np.allclose(away, 0.04, rtol=0, atol=64 * EPS * 0.04)
    assert np.allclose(profile.profile_bend, 0.04, rtol=0, atol=64 * EPS * 0.04)
    assert "continuous" in ct.summary(ct.cam(cam, 37))
    assert not any(any(one.jumps) for one in joints_of(follower_motion(cam)))


def test_derivatives_of_a_formula_are_exact() -> None:
    """exp(-2 sin^2(phi/2)) = exp(cos phi - 1), whose derivatives are known."""
    cam = whole_turn("0.01*(1 - exp(-2*sin(phi/2)^2))")
    phi = np.linspace(0.0, math.tau, 97)
    found = follower_motion(cam).lift(phi, 3)
    sine, cosine, e = np.sin(phi), np.cos(phi), np.exp(np.cos(phi) - 1.0)
    expected = 1.0 - e, sine * e, (cosine - sine**2) * e, (-sine - 3 * sine * cosine + sine**3) * e
    assert np.allclose(found, 0.01 * np.array(expected), rtol=0, atol=1e-15)


def test_an_undercut_by_a_harmonic_formula_begins_where_the_closed_form_says() -> None:
    """At the tip of a harmonic lift 1/K = y^2/(y + c), y = r0 + r + h, c = pi^2 h/(2 beta^2): undercut below r."""
    lift, angle, roller = 0.02, math.radians(30), 0.008
    bend = math.pi**2 * lift / (2 * angle**2)
    least = 0.5 * (roller + math.sqrt(roller**2 + 4 * roller * bend)) - lift - roller
    part = f'[[segments]]\nangle = "30 deg"\nto = {{}}\nlift = "{HARMONIC}"\n'
    text = 'kind = "cam"\n[cam]\nbase_radius = {}\n[follower]\nroller_radius = 0.008\n' + part.format(lift)
    text += part.format(0) + '[[segments]]\nangle = "300 deg"\ncurve = "dwell"\n'
    assert not ct.follower_cam(ct.parse_cam(text.replace("{}", str(least * (1 + 1e-9))))).undercuts
    with pytest.raises(ct.InputError, match="undercuts the profile") as refused:
        ct.follower_cam(ct.parse_cam(text.replace("{}", str(least * (1 - 1e-6)))))
    assert f"base radius above {1e3 * least:.6g} mm" in str(refused.value)


def test_a_mechanism_that_such_a_cam_drives() -> None:
    feed = ct.example("cam-driven-linkage")
    drive = feed.drives[0]
    assert isinstance(drive.cam, ct.PlateCam)
    named = ct.cam_text(drive.cam)
    written = ct.parse_cam(named.replace('curve = "cycloidal"', f'lift = "{CYCLOIDAL}"'))
    assert written != drive.cam
    driven = feed.model_copy(update={"drives": (drive.model_copy(update={"cam": written}),)})
    ours, theirs = ct.motion(driven, 73), ct.motion(feed, 73)
    for name in ("position", "velocity", "acceleration"):
        scale = float(np.abs(theirs[name]).max())
        assert float(np.abs(ours[name] - theirs[name]).max()) < 1e-11 * scale, name


@pytest.mark.parametrize(
    ("lift", "told"),
    [
        ("0.01*sqrt(phi)", "no finite value with two derivatives at 0 deg"),
        ("0.01*(phi - 2*pi)*phi/(phi - 1)", "no finite value with two derivatives at 57.5 deg"),
        ("0.01*tan(phi/2)^2", "no finite value"),
        ("log(phi)", "no finite value"),
        ("0.01*abs(sin(phi))", 'the function "abs" is not allowed'),
        ("min(phi, 2*pi - phi)", 'the function "min" is not allowed'),
        ("0.01", "the lift jumps: its formula begins at 0.01 m, not at 0 m"),
        ("0.01*phi", "the lift jumps: its formula ends at 0.0628318531 m, not at 0 m"),
        ("1e5*(1 - cos(phi))", "the lift grows too large"),
        ("0.01*sin(t)", 'unknown name "t"'),
        ("__import__('os')", "not allowed in a formula"),
        ("0.01*sin(phi", "this is not a formula"),
        ("0.0" + "+0" * 600, "at most 1000 characters"),
        ("sin(" * 60 + "phi" + ")" * 60, "nests deeper than 50"),
    ],
)
def test_formulas_that_are_refused(lift: str, told: str) -> None:
    with pytest.raises(ct.InputError) as refused:
        whole_turn(lift)
    assert told in str(refused.value) and "[[segments]] 1" in refused.value.where


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        ("", '"curve" is missing'),
        ('curve = "formula"', '"lift" is missing'),
        ('curve = "harmonic"\nlift = "0"', "by a curve and by a formula"),
        ("lift = 3", "must be a formula in quotes"),
        ('lift = "0.01*(1-cos(phi))"\nat_start = [0]', "at_start is used with a polynomial"),
    ],
)
def test_keys_that_do_not_go_together(keys: str, told: str) -> None:
    text = 'kind = "cam"\n[follower]\nroller_radius = 0.008\n[[segments]]\nangle = "360 deg"\nto = 0\n'
    with pytest.raises(ct.InputError, match=told):
        ct.parse_cam(text + keys + "\n")
