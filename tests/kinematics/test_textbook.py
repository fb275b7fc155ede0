"""Textbook closed forms on random dimensions: four-bars, slider-cranks, their inversion, scotch yoke, trammel."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import centrode as ct
from centrode.kinematics.preparation import ready
from centrode.model.classics import inverted_slider_crank
from mechanisms import EPS, conditioning, events, four_bar, link, point, slide, solve_evenly, statuses

LENGTH = st.floats(0.5, 4.0)


def rounding(
    mechanism: ct.Mechanism, samples: int, start: float, stop: float
) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """Roundings of the closed form and of the motion together: each 8 eps times the condition (3, samples)."""
    return 16 * EPS * conditioning(solve_evenly(ready(mechanism), samples, start, stop), tries=4)


@settings(max_examples=20)
@given(LENGTH, LENGTH, LENGTH, LENGTH, st.sampled_from(["left", "right"]))
def test_freudensteins_equation(a: float, b: float, c: float, d: float, side: str) -> None:
    assume(2 * max(a, b, c, d) < 0.95 * (a + b + c + d))
    mechanism = ct.four_bar(a, b, c, d, side=side)
    start = float(ready(mechanism).kinematics.path.initial)
    data = ct.motion(mechanism, 41, start=start - 0.4, stop=start + 0.4)
    reached = data["status"].to_numpy() == ct.Status.OK
    phi, psi = link(data, "crank")[reached], link(data, "rocker")[reached]
    k1, k2, k3 = d / a, d / c, (a * a - b * b + c * c + d * d) / (2 * a * c)
    # both angles carry errors of some eps times the condition, and the equation has the slopes K1 and K2
    allowed = (
        rounding(mechanism, 41, start - 0.4, start + 0.4)[0][reached]
        * (1 + k1 + k2 + abs(k3))
        * max(d, 1)
        / min(a, c)
    )
    assert (np.abs(k1 * np.cos(psi) - k2 * np.cos(phi) + k3 - np.cos(phi - psi)) <= allowed).all()


@settings(max_examples=20)
@given(LENGTH, LENGTH, LENGTH, LENGTH)
def test_speeds_of_a_four_bar(a: float, b: float, c: float, d: float) -> None:
    """omega3/omega1 = a sin(phi - theta)/(c sin(psi - theta)), theta the coupler's angle (loop differentiated)."""
    assume(2 * max(a, b, c, d) < 0.95 * (a + b + c + d))
    mechanism = ct.four_bar(a, b, c, d)
    start = float(ready(mechanism).kinematics.path.initial)
    data = ct.motion(mechanism, 21, start=start - 0.3, stop=start + 0.3)
    phi, theta, psi = (link(data, name) for name in ("crank", "coupler", "rocker"))
    sine = np.abs(np.sin(psi - theta))
    far = (data["status"].to_numpy() == ct.Status.OK) & (sine > 0.2)
    rate = (a * np.sin(phi - theta) / (c * np.sin(psi - theta)))[far]
    # each angle is off by some eps over the sine; the quotient divides by it once more
    allowed = 64 * EPS * (max(a, b, c, d) / min(a, b, c, d)) ** 2 / sine[far] ** 3
    assert (np.abs(link(data, "rocker", "angular_velocity")[far] - rate) <= allowed).all()


def grashof(a: float, b: float, c: float, d: float) -> bool:
    lengths = sorted((a, b, c, d))
    return lengths[0] + lengths[3] <= lengths[1] + lengths[2]


@settings(max_examples=40)
@given(LENGTH, LENGTH, LENGTH, LENGTH)
def test_limits_of_four_bars_by_the_law_of_cosines(a: float, b: float, c: float, d: float) -> None:
    assume(2 * max(a, b, c, d) < 0.95 * (a + b + c + d))
    ends = [(a * a + d * d - r * r) / (2 * a * d) for r in (b + c, abs(b - c))]
    assume(all(abs(abs(x) - 1) > 1e-3 for x in ends))
    expected = sorted(s * math.acos(x) for x in ends if abs(x) < 1 for s in (1, -1))
    data = ct.motion(ct.four_bar(a, b, c, d), 3, start=-3.1415, stop=3.1415)
    # an acos loses its digits with 1/sine towards 0 and pi
    bound = max(
        (16 * EPS * (a + b + c + d) ** 2 / (2 * a * d * abs(math.sin(q))) for q in expected), default=0.0
    )
    assert events(data, "limit") == pytest.approx(expected, abs=bound)
    crank_turns = grashof(a, b, c, d) and min(a, b, c, d) in (a, d)
    assert crank_turns == (not expected)


@settings(max_examples=20)
@given(st.floats(0.2, 1.0), st.floats(1.5, 4.0), st.floats(-0.4, 0.4), st.sampled_from(["ahead", "behind"]))
def test_offset_slider_crank(r: float, l: float, e: float, side: str) -> None:
    """Position, velocity and acceleration of the slider in closed form."""
    data = ct.motion(ct.slider_crank(r, l, e, side=side), 37, start=0.0, stop=2 * np.pi)
    q = data["drive_value"].to_numpy()[:, 0]
    sign = 1.0 if side == "ahead" else -1.0
    n = e - r * np.sin(q)
    dn, ddn = -r * np.cos(q), r * np.sin(q)
    w = np.sqrt(l * l - n * n)
    x = r * np.cos(q) + sign * w
    v = -r * np.sin(q) - sign * n * dn / w
    a = -r * np.cos(q) - sign * ((dn * dn + n * ddn) / w + (n * dn) ** 2 / w**3)
    # l / w stays below 2.8 here; each order divides by w once or twice more
    for name, exact, loss in (("position", x, 3.0), ("velocity", v, 3.0**3), ("acceleration", a, 3.0**5)):
        assert np.max(np.abs(point(data, "B", name).real - exact)) <= 8 * EPS * (r + l) * loss
    assert (
        np.max(np.abs(link(data, "coupler") - np.angle(point(data, "B") - point(data, "A")))) % (2 * np.pi)
        <= 64 * EPS
    )


@settings(max_examples=20)
@given(st.floats(0.3, 1.0), st.floats(1.5, 3.0), st.floats(-0.3, 0.3))
def test_inverted_slider_crank(a: float, d: float, e: float) -> None:
    """Slide s = sqrt(|DA|^2 - e^2); angular velocity of the rocker by the velocity of A across the slot."""
    data = ct.motion(inverted_slider_crank(a, d, e), 37, start=0.0, stop=2 * np.pi)
    q = data["drive_value"].to_numpy()[:, 0]
    arm = a * np.exp(1j * q) - d
    s = np.sqrt(np.abs(arm) ** 2 - e * e)
    velocity = 1j * a * np.exp(1j * q)
    ds = (np.conj(arm) * velocity).real / s
    # A' = (s' + i omega (s + i e)) R, so omega = Im(A'/R) / s with R = arm/(s + i e)
    omega = (velocity * (s + 1j * e) / arm).imag / s
    loss = (a + d) / 0.4  # |DA| and s stay above 0.4
    assert np.max(np.abs(slide(data, "A") - s)) <= 8 * EPS * (a + d) * loss
    assert np.max(np.abs(slide(data, "A", "slide_velocity") - ds)) <= 8 * EPS * (a + d) * loss**2
    assert np.max(np.abs(link(data, "rocker", "angular_velocity") - omega)) <= 8 * EPS * loss**3


def test_scotch_yoke_is_harmonic() -> None:
    data = ct.motion(ct.example("scotch-yoke"), 361)
    q = data["drive_value"].to_numpy()[:, 0]
    for name, exact in (("position", np.cos(q)), ("velocity", -np.sin(q)), ("acceleration", -np.cos(q))):
        assert np.max(np.abs(point(data, "H", name) - 0.5 * exact)) <= 4 * EPS
    assert np.max(np.abs(link(data, "yoke"))) == 0.0


def test_elliptic_trammel_draws_its_ellipse() -> None:
    data = ct.motion(ct.example("elliptic-trammel"), 101)
    x = data["drive_value"].to_numpy()[:, 0]
    h = np.sqrt(1 - x * x)
    p, b = point(data, "P"), point(data, "B")
    # B is the root of 1 - x^2, at least 0.3 here: one division by it a derivative
    assert np.max(np.abs(b - 1j * h)) <= 8 * EPS / 0.3
    assert np.max(np.abs((p.real / 0.75) ** 2 + (p.imag / 0.25) ** 2 - 1)) <= 32 * EPS / 0.3
    assert np.max(np.abs(point(data, "B", "velocity") + 0.1j * x / h)) <= 8 * EPS / 0.3**3
    assert np.max(np.abs(point(data, "B", "acceleration") + 0.01j / h**3)) <= 8 * EPS / 0.3**5


def test_instant_centre_of_the_trammel() -> None:
    """The rod turns about (x_A, y_B): velocities are square to the line there, in proportion to the distance."""
    data = ct.motion(ct.example("elliptic-trammel"), 11)
    centre = point(data, "A").real + 1j * point(data, "B").imag
    omega = link(data, "AB", "angular_velocity")
    for name in ("A", "B", "P"):
        expected = 1j * omega * (point(data, name) - centre)
        assert np.max(np.abs(point(data, name, "velocity") - expected)) <= 16 * EPS / 0.3**3


def test_both_sides_of_a_four_bar_are_mirror_images_of_each_other() -> None:
    """B left and right of A -> D: reflections of each other in that line."""
    left, right = (
        ct.motion(four_bar(1.0, 3.5, 3.0, 4.0, assembly={"sides": {"B": side}}), 37)
        for side in ("left", "right")
    )
    assert statuses(left) == statuses(right) == ["ok"] * 37
    a = point(left, "A")
    along = (4 - a) / np.conj(4 - a)
    assert np.max(np.abs(np.conj(point(left, "B") - a) * along - (point(right, "B") - a))) <= 64 * EPS * 4
    assert (((point(left, "B") - a) * np.conj(4 - a)).imag > 0).all()
