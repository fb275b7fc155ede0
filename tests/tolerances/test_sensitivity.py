"""Derivatives against closed forms, and against differences in fifty digits where there is no closed form to print."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import centrode as ct
from centrode.kinematics.preparation import ready
from centrode.model.files import with_value
from centrode.tolerances.dimension_limits import length_paths
from centrode.tolerances.limit_gradient import gradient_at_limit

Array = np.ndarray[tuple[int, ...], np.dtype[np.float64]]


def differences(function: Callable[..., Any], *numbers: float) -> list[float]:
    """Derivatives of a function by its numbers, as differences in fifty digits: their error is some 1e-30."""
    mp.mp.dps = 50
    step = mp.mpf(10) ** -15
    given = [mp.mpf(x) for x in numbers]
    found = []
    for k in range(len(given)):
        ahead, behind = list(given), list(given)
        ahead[k], behind[k] = given[k] + step, given[k] - step
        found.append(float((function(*ahead) - function(*behind)) / (2 * step)))
    return found


def gradient(found: Any, name: str) -> Array:
    return np.asarray(found[f"gradient.{name}"])


# Slider-crank: x = r cos(phi) + sqrt(l^2 - (e - r sin(phi))^2).


def test_slider_crank_against_its_closed_form() -> None:
    r, l, e = 0.3, 1.1, 0.1
    paths = ["links.crank.length", "links.coupler.length", "guides.B.through.y"]
    mechanism = ct.slider_crank(r, l, e, speed=2.0)
    names = ["position.B.x", "velocity.B.x", "angle.coupler"]
    found = ct.sensitivity(mechanism, names, by=paths, samples=73)
    phi = found["parameter"].to_numpy()
    h = e - r * np.sin(phi)
    root = np.sqrt(l**2 - h**2)
    exact = np.stack([np.cos(phi) + h * np.sin(phi) / root, l / root, -h / root], axis=-1)
    assert np.abs(gradient(found, "position.B.x") - exact).max() < 1e-13
    # v = (-r sin + h r cos / root) w; d(h/root) = dh l^2/root^3, h dl terms by hand
    w, cosine, sine = 2.0, np.cos(phi), np.sin(phi)
    by_h = l**2 / root**3
    by_r = w * (-sine + cosine * h / root - r * cosine * sine * by_h)
    by_l = -w * r * cosine * h * l / root**3
    by_e = w * r * cosine * by_h
    exact = np.stack([by_r, by_l, by_e], axis=-1)
    assert np.abs(gradient(found, "velocity.B.x") - exact).max() < 1e-13 * np.abs(exact).max()
    # sin(angle) = h/l
    exact = np.stack([-sine / root, -h / l / root, 1 / root], axis=-1)
    assert np.abs(gradient(found, "angle.coupler") - exact).max() < 1e-13


def test_true_stroke_of_a_slider_crank() -> None:
    """Between the dead positions: sqrt((l + r)^2 - e^2) - sqrt((l - r)^2 - e^2), which lie between samples."""
    r, l, e = 0.3, 1.1, 0.1
    paths = ["links.crank.length", "links.coupler.length", "guides.B.through.y"]
    found = ct.sensitivity(
        ct.slider_crank(r, l, e), ["stroke.B", "range(position_B_x)"], by=paths, samples=73
    )
    far, near = np.sqrt((l + r) ** 2 - e**2), np.sqrt((l - r) ** 2 - e**2)
    assert float(found["stroke.B"]) == pytest.approx(far - near, rel=1e-14)
    exact = [(l + r) / far + (l - r) / near, (l + r) / far - (l - r) / near, -e / far + e / near]
    assert gradient(found, "stroke.B") == pytest.approx(exact, rel=1e-12, abs=1e-13)
    # the range of samples is another number, with its own derivative
    assert gradient(found, "range(position_B_x)") != pytest.approx(exact, rel=1e-6)


def test_four_bar_against_its_closed_form() -> None:
    """Freudenstein's equation F = K1 cos psi - K2 cos phi + K3 - cos(phi - psi) = 0: dpsi = -F_p/F_psi dp."""
    a, b, c, d = 1.0, 3.5, 3.0, 4.0
    paths = ["links.crank.length", "links.coupler.length", "links.rocker.length", "frame.points.D.x"]
    found = ct.sensitivity(ct.four_bar(a, b, c, d), ["angle.rocker"], by=paths, samples=73)
    phi, psi = found["parameter"].to_numpy(), found["angle.rocker"].to_numpy()
    # 2 a d cos phi - 2 c d cos psi + 2 a c cos(phi - psi) = a^2 - b^2 + c^2 + d^2, of the same equation
    by_psi = 2 * c * d * np.sin(psi) + 2 * a * c * np.sin(phi - psi)
    by = [
        2 * d * np.cos(phi) + 2 * c * np.cos(phi - psi) - 2 * a,
        2 * b + 0 * phi,
        -2 * d * np.cos(psi) + 2 * a * np.cos(phi - psi) - 2 * c,
        2 * a * np.cos(phi) - 2 * c * np.cos(psi) - 2 * d,
    ]
    exact = -np.stack(by, axis=-1) / by_psi[:, None]
    assert np.abs(gradient(found, "angle.rocker") - exact).max() < 1e-12 * np.abs(exact).max()


def test_transmission_angle_of_a_four_bar() -> None:
    """cos mu = (b^2 + c^2 - f^2) / (2 b c), f^2 = a^2 + d^2 - 2 a d cos phi."""
    a, b, c, d = 1.0, 3.5, 3.0, 4.0
    paths = ["links.crank.length", "links.coupler.length", "links.rocker.length", "frame.points.D.x"]
    found = ct.sensitivity(
        ct.four_bar(a, b, c, d),
        ["transmission_angle.coupler-rocker", "min(transmission_angle_coupler_rocker)"],
        by=paths,
        samples=73,
    )
    phi, mu = found["parameter"].to_numpy(), found["transmission_angle.coupler-rocker"].to_numpy()
    f2 = a * a + d * d - 2 * a * d * np.cos(phi)
    assert np.abs(np.cos(mu) - (b * b + c * c - f2) / (2 * b * c)).max() < 1e-14
    by = [
        -(2 * a - 2 * d * np.cos(phi)) / (2 * b * c),
        (2 * b - 2 * c * np.cos(mu)) / (2 * b * c),
        (2 * c - 2 * b * np.cos(mu)) / (2 * b * c),
        -(2 * d - 2 * a * np.cos(phi)) / (2 * b * c),
    ]
    exact = -np.stack(by, axis=-1) / np.sin(mu)[:, None]
    assert (
        np.abs(gradient(found, "transmission_angle.coupler-rocker") - exact).max()
        < 1e-13 * np.abs(exact).max()
    )
    least = int(np.argmin(mu))
    assert gradient(found, "min(transmission_angle_coupler_rocker)") == pytest.approx(
        exact[least], rel=1e-12, abs=1e-13
    )


@pytest.mark.parametrize(
    "example", ["six-bar-press", "whitworth-quick-return", "slider-between-cranks", "scotch-yoke"]
)
def test_transmission_angles_are_those_of_the_analysis(example: str) -> None:
    angles = ct.transmission_angles(example, 37)
    names = [f"transmission_angle.{group}" for group in angles["group"].to_numpy()]
    found = ct.sensitivity(example, names, samples=37)
    for name in names:
        exact = angles["transmission_angle"].sel(group=name.partition(".")[2])
        assert np.abs(found[name] - exact.to_numpy()).max() < 1e-14


def test_limits_of_a_double_rocker() -> None:
    """At a limit coupler and rocker are in line: a^2 + d^2 - 2 a d cos q = (b + c)^2."""
    a, b, c, d = 2.0, 1.5, 1.2, 3.2
    mechanism = ct.four_bar(a, b, c, d, start=0.4)
    paths = ["links.crank.length", "links.coupler.length", "links.rocker.length", "frame.points.D.x"]
    found = ct.sensitivity(mechanism, ["limit.greatest", "limit.least"], by=paths)
    q = float(found["limit.greatest"])
    assert np.cos(q) == pytest.approx((a * a + d * d - (b + c) ** 2) / (2 * a * d), rel=1e-12)
    by_q = 2 * a * d * np.sin(q)
    by = [2 * a - 2 * d * np.cos(q), -2 * (b + c), -2 * (b + c), 2 * d - 2 * a * np.cos(q)]
    assert gradient(found, "limit.greatest") == pytest.approx([-x / by_q for x in by], rel=1e-9)


ENGINE = """[frame.points]
O = [0, 0]
[links.OA]
length = 0.3
[links.AB]
length = 1.1
[links.piston]
points = ["B"]
mass = 2.0
[[guides]]
point = "B"
on = "frame"
through = [0, 0]
direction = [1, 0]
link = "piston"
[[drives]]
link = "OA"
start = 0
speed = 1e-9
[[loads]]
kind = "force"
point = "B"
vector = [-500, 0]
[assembly]
sides = { B = "ahead" }
"""


def test_reduced_inertia_and_reactions_of_an_engine() -> None:
    """The piston has mass and load: J = m (dx/dphi)^2, the rod carries F / cos(beta), sin(beta) = r sin(phi)/l."""
    r, l, m, force = 0.3, 1.1, 2.0, 500.0
    paths = ["links.OA.length", "links.AB.length", "links.piston.mass"]
    found = ct.sensitivity(
        ct.parse_mechanism(ENGINE), ["joint_force.B/AB", "reduced_inertia"], by=paths, samples=37
    )
    phi = found["parameter"].to_numpy()
    sine = r * np.sin(phi) / l
    cosine = np.sqrt(1 - sine**2)
    # along the rod: F (1, tan beta)
    by_sine = force / cosine**3
    exact = np.stack([by_sine * sine / r, -by_sine * sine / l, 0 * phi], axis=-1)
    across = gradient(found, "joint_force.B/AB")[:, 1]
    assert np.abs(np.abs(across) - np.abs(exact)).max() < 1e-12 * force
    # x' = -r sin(phi) (1 + cos(phi) r / (l cos(beta)))
    slope = -r * np.sin(phi) * (1 + r * np.cos(phi) / (l * cosine))
    by_cosine = r * np.sin(phi) * r * np.cos(phi) / (l * cosine**2)
    slope_by_r = -np.sin(phi) * (1 + 2 * r * np.cos(phi) / (l * cosine)) + by_cosine * (
        -sine / cosine * sine / r
    )
    slope_by_l = r * np.sin(phi) * r * np.cos(phi) / (l * l * cosine) + by_cosine * (sine / cosine * sine / l)
    exact = np.stack([2 * m * slope * slope_by_r, 2 * m * slope * slope_by_l, slope**2], axis=-1)
    assert np.abs(gradient(found, "reduced_inertia") - exact).max() < 1e-13


# The sphere, against fifty digits.


def _spherical_rocker(phi: Any, crank: Any, coupler: Any, rocker: Any) -> Any:
    """Angle psi of the rocker from the arc DZ: C = (sin a sin psi, cos a, sin a cos psi) with the arc a = DC."""
    b = (mp.cos(crank), mp.sin(crank) * mp.cos(phi), mp.sin(crank) * mp.sin(phi))
    # cos(coupler) = B . C: p sin(psi) + q cos(psi) = s
    p, q = b[0] * mp.sin(rocker), b[2] * mp.sin(rocker)
    s = mp.cos(coupler) - b[1] * mp.cos(rocker)
    return mp.atan2(p, q) - mp.acos(s / mp.sqrt(p * p + q * q)), mp.atan2(p, q) + mp.acos(
        s / mp.sqrt(p * p + q * q)
    )


def test_sphere_against_differences_in_fifty_digits() -> None:
    paths = ["links.AB.length", "links.BC.length", "links.DC.length"]
    found = ct.sensitivity(
        "spherical-four-bar", ["joint_angle.DC", "transmission_angle.BC-DC"], by=paths, samples=9
    )
    lengths = [ct.value_at(ct.example("spherical-four-bar"), path) for path in paths]
    for phi, angle, row in zip(
        found["parameter"].to_numpy(),
        found["joint_angle.DC"].to_numpy(),
        gradient(found, "joint_angle.DC"),
        strict=True,
    ):
        roots = [float(x) for x in _spherical_rocker(mp.mpf(float(phi)), *lengths)]
        branch = int(np.argmin([abs(abs(x) - abs(angle)) for x in roots]))
        exact = differences(lambda *x, k=branch, q=phi: _spherical_rocker(mp.mpf(float(q)), *x)[k], *lengths)
        sense = np.sign(angle) * np.sign(roots[branch])
        assert abs(roots[branch]) == pytest.approx(abs(angle), abs=1e-14)
        assert row == pytest.approx(sense * np.array(exact), rel=1e-12, abs=1e-13)


@pytest.mark.parametrize(
    "name", ["triple-rocker", "slider-between-cranks-locked", "stephenson-driven-at-coupler"]
)
def test_limits_by_the_constraints_are_those_by_radicands(name: str) -> None:
    """Two routes: the radicand of the group that locks, and a vector that makes the Jacobian singular."""
    mechanism = ct.example(name)
    paths = length_paths(mechanism)
    found = ct.sensitivity(mechanism, ["limit.least", "limit.greatest"], by=paths)
    for end in ("limit.least", "limit.greatest"):
        by_constraints = gradient_at_limit(ready(mechanism), paths, float(found[end]))
        assert by_constraints == pytest.approx(gradient(found, end), rel=1e-12, abs=1e-13)


@pytest.mark.parametrize(
    ("name", "path"),
    [
        ("stephenson-driven-at-rocker", "links.OA.length"),
        ("watt-driven-second-loop", "links.PR.length"),
        ("watt-driven-second-loop", "frame.points.D.x"),
    ],
)
def test_limits_of_groups_of_higher_class(name: str, path: str) -> None:
    """Against differences of the limits themselves, extrapolated to steps of zero (Richardson)."""
    mechanism = ct.example(name)
    found = ct.sensitivity(mechanism, ["limit.least", "limit.greatest"], by=[path])
    own = float(found["value"][0])

    def ends(value: float) -> Array:
        limits = ct.limits(with_value(mechanism, path, value))
        assert limits.low is not None
        assert limits.high is not None
        return np.array([limits.low.value, limits.high.value])

    coarse, fine = ((ends(own + h) - ends(own - h)) / (2 * h) for h in (2e-4, 1e-4))
    exact = (4 * fine - coarse) / 3
    slopes = [gradient(found, end)[0] for end in ("limit.least", "limit.greatest")]
    assert np.abs(slopes - exact).max() < 1e-8 * max(1.0, np.abs(exact).max())


# Refusals, and where derivatives are missing.


@pytest.mark.parametrize(
    ("name", "told"),
    [("planetary-hypocycloid", "turns are counted"), ("spherical-crank-guide", "guides that close")],
)
def test_mechanisms_without_derivatives_are_refused_with_a_reason(name: str, told: str) -> None:
    point = ct.example(name).moving_points[-1]
    with pytest.raises(ct.InputError, match=told) as refused:
        ct.sensitivity(name, [f"position.{point}.x"], samples=5)
    assert "sweep" in str(refused.value)


def test_derivatives_are_missing_beyond_limits_with_a_status() -> None:
    found = ct.sensitivity("slider-between-cranks-locked", ["position.B"], by=["links.OA.length"])
    missing = np.isnan(gradient(found, "position.B")).all(axis=(1, 2))
    status = found["status"].to_numpy()
    assert missing.any()
    assert not missing.all()
    assert missing[status == ct.Status.OPEN].all()
    assert not missing[status == ct.Status.OK].any()


@pytest.mark.parametrize(
    ("outputs", "by", "words"),
    [
        (["position.Q.x"], None, '"Q"'),
        (["stroke.Q"], None, "no guide"),
        (["limit.first"], None, "limit"),
        (["limit.least"], None, "no limit"),
        (["transmission_angle.AB"], None, "no transmission angle"),
        (["position.B.x"], ["links.AB.lenght"], "length"),
        (["position.B.x"], ["links.AB.length", "links.AB.length"], "twice"),
        (["position.B.x"], [], "1 to 100"),
        ([], None, "no output"),
        (["position.B.x", "position.B.x"], None, "twice"),
        ([3], None, "no output"),
    ],
)
def test_refusals(outputs: Any, by: Any, words: str) -> None:
    with pytest.raises(ct.InputError, match=words):
        ct.sensitivity("crank-rocker", outputs, by=by)
