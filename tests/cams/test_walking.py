"""Shoes and walking wheels: level, without slip, steps; and that the proof notices what is wrong."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import quad

import centrode as ct
from cam_shapes import EPS, exchanged, paper_path, three_point_curvature
from centrode.cams.curvature_laws import ExponentialCurvature
from centrode.cams.path_series import expanded_path
from centrode.cams.profiles import cam_body
from centrode.cams.return_arc import working_arc
from centrode.cams.roller_path import SymmetricPath
from centrode.cams.walking_wheel import Shoe, WheelMover, profile_by_parts, rolling, shoe
from centrode.errors import InputError, MotionError
from circle_path import CirclePath

HEIGHT = 0.17


@pytest.fixture(scope="module")
def four() -> WheelMover:
    return ct.walking_wheel(exchanged())


@pytest.fixture(scope="module")
def three() -> WheelMover:
    return ct.walking_wheel(exchanged(("legs = 4", "legs = 3")))


def test_support_function_and_the_papers_formulas_give_one_shoe(four: WheelMover) -> None:
    phi = np.linspace(-four.half, four.half, 301)
    apart = four.shoe.place(phi) - profile_by_parts(four, phi)
    # H'/sin phi is divided down to 0.03 rad: a rounding of H' there is 33 roundings of H
    assert np.abs(apart).max() < 64 * EPS * HEIGHT


def test_at_phi_zero_the_limits_are_those_of_the_second_derivative(four: WheelMover) -> None:
    radius, _slope, second = four.shoe.arc.curve.radius(np.zeros(1), 2)[:, 0]
    first, upright = four.shoe.parts(np.array([0.0, -0.0]))
    np.testing.assert_allclose(first, second - radius, rtol=4 * EPS)
    np.testing.assert_allclose(upright, HEIGHT - second, rtol=4 * EPS)
    assert np.isfinite(four.shoe.parts(np.array([1e-300, 5e-324, -1e-20]))).all()


def test_near_phi_zero_parts_are_exact_to_rounding() -> None:
    """On a circle H'/sin phi = -y - y^2 cos phi / sqrt(R^2 - y^2 sin^2 phi): y where its centre lies."""
    path = CirclePath(0.05, 0.0, 12.0)
    y, big = path.centre[1], 1.0 / 12.0
    found = Shoe(working_arc(path, legs=4), HEIGHT)
    phi = np.array([0.0, 1e-12, 1e-6, 1e-3, 0.02, 0.0299, 0.0301, 0.05, 0.3, -0.01, -0.7])
    share = -y - y**2 * np.cos(phi) / np.sqrt(big**2 - (y * np.sin(phi)) ** 2)
    radius = y * np.cos(phi) + np.sqrt(big**2 - (y * np.sin(phi)) ** 2)
    first, upright = found.parts(phi)
    # an angle of 0.0301 rad multiplies the rounding of H' by 33; some ten roundings
    np.testing.assert_allclose(first, share * np.cos(phi) - radius, rtol=0.0, atol=400 * EPS * 0.05)
    np.testing.assert_allclose(upright, HEIGHT - share * np.cos(phi) ** 2, rtol=0.0, atol=400 * EPS * 0.05)


def test_polar_form_is_the_place(four: WheelMover) -> None:
    phi = np.linspace(-four.half, four.half, 51)
    alpha, radius = four.shoe.polar(phi)
    x, y = four.shoe.place(phi).T
    np.testing.assert_allclose(
        np.stack([radius * np.sin(alpha), radius * np.cos(alpha)]), [x, y], atol=8 * EPS * 0.2
    )
    np.testing.assert_allclose(alpha, -alpha[::-1], atol=8 * EPS)


def test_curvature_of_the_shoe_by_three_points(three: WheelMover) -> None:
    errors = []
    for count in (100, 200, 400):
        phi = np.linspace(0.01, three.half, count + 1)
        back = three_point_curvature(three.shoe.place(phi))
        errors.append(np.abs(back - 1.0 / three.shoe.bend(phi)[1:-1]).max())
    assert 3.5 < errors[0] / errors[1] < 4.5 and 3.5 < errors[1] / errors[2] < 4.5


def test_a_cam_round_about_the_hub_makes_an_ordinary_wheel() -> None:
    cam = exchanged(('"exponential"', '"constant"'), ('k0 = "0.01 1/mm"\nk1 = 0.75', 'k0 = "0.02 1/mm"'))
    wheel = ct.walking_wheel(cam)
    assert wheel.step == pytest.approx(HEIGHT * math.tau / 4, rel=16 * EPS)
    assert wheel.unevenness == pytest.approx(1.0, rel=64 * EPS)
    assert abs(wheel.print_gap) < 64 * EPS * HEIGHT
    outline = wheel.shoe.place(np.linspace(-0.7, 0.7, 29)) + np.array([0.0, 0.05])
    np.testing.assert_allclose(np.hypot(*outline.T), HEIGHT, rtol=64 * EPS)


def test_travel_is_the_papers_integral(four: WheelMover) -> None:
    path = paper_path()

    def rate(phi: float) -> float:
        height, slope = path.radius(np.array([phi]), 1)[:, 0]
        first, second = four.shoe.parts(np.array([phi]))
        return float(slope * math.sin(phi) + (height + first[0]) * math.cos(phi) + second[0])  # (3)

    for phi in (-0.7, 0.2, math.pi / 4):
        by_quad, bound = quad(rate, 0.0, phi, epsabs=1e-13, epsrel=1e-12)
        assert float(four.travel(np.array([phi]))[0]) == pytest.approx(by_quad, abs=bound + 64 * EPS * HEIGHT)
    # (2): (H + Y1) sin phi and the integral of Y2 - Y1' sin phi, whose parts are the contact's
    ends = np.array([-0.5, 0.5])
    height = path.radius(ends)[0]
    first, _second = four.shoe.parts(ends)
    np.testing.assert_allclose((height + first) * np.sin(ends), -four.touch(ends), atol=64 * EPS)


def test_the_hub_is_level_and_the_shoe_does_not_slip(four: WheelMover, three: WheelMover) -> None:
    for wheel in (four, three):
        found = rolling(wheel)
        # places of some ten roundings; H'/sin phi multiplies by 33 near phi = 0
        assert found.level < 64 * EPS * HEIGHT
        assert found.slip < 64 * EPS
        # a quadrature of panels of 0.1 rad with 12 nodes, whose slopes are those of a fitted polynomial
        assert abs(found.shoe_arc - found.ground) < 1e-13
        assert found.shoe_arc == pytest.approx(wheel.print_length, rel=1e-12)
        assert abs(found.joint) < 64 * EPS
        assert found.clearance > -64 * EPS * HEIGHT
        assert wheel.step == pytest.approx(wheel.print_length + wheel.print_gap, rel=16 * EPS)


def test_the_proof_notices_a_shoe_of_another_cam(four: WheelMover) -> None:
    other = SymmetricPath(expanded_path(ExponentialCurvature(10.0, 0.76), 0.05, 0.0, 0.0, 1.5))

    class Wrong(Shoe):
        def parts(self, phi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            return shoe(working_arc(other, legs=4), HEIGHT).parts(phi)

    found = rolling(replace(four, shoe=Wrong(four.shoe.arc, HEIGHT)))
    assert found.level > 1e-6
    assert found.slip > 1e-5
    assert abs(found.shoe_arc - found.ground) > 1e-6


def test_the_proof_notices_a_shoe_that_digs_in() -> None:
    """A return arc that lets the legs out before they are up."""
    from_below = ct.walking_wheel(
        exchanged(("k1 = 0.75", "k1 = 0.75"), more='[return]\nleast_radius = "56 mm"\n')
    )
    shallow = rolling(from_below).clearance

    class Out:
        def radius(self, phi: np.ndarray, order: int = 0) -> np.ndarray:
            found = from_below.closed.radius(phi, order)
            found[0] = np.where(np.abs(np.remainder(phi + 1.0, math.tau) - 1.0) > 0.9, 0.3, found[0])
            return found

    assert shallow > -1e-12
    digging = rolling(replace(from_below, closed=Out()))  # type: ignore[arg-type]
    assert digging.clearance < -0.05 and abs(digging.clearance_at) > 0.9


def test_a_point_of_the_shoe_rests_on_the_ground_while_it_is_the_contact(four: WheelMover) -> None:
    """The material point of the contact at 0.2 rad, followed over a small turn: its velocity is zero there."""
    point = four.shoe.place(np.array([0.2]))
    h = 1e-4
    before, here, after = (four.pose(0.2 + k * h).of_leg(0, point)[0] for k in (-1, 0, 1))
    np.testing.assert_allclose(here, four.pose(0.2).contact, atol=64 * EPS)
    # of second order: a cycloid's cusp moves by radius of curvature h^2 / 2 upwards
    assert np.abs(after - before).max() / (2 * h) < 2 * h * HEIGHT
    assert 0.0 < after[1] < HEIGHT * h**2


def test_poses_go_on_from_leg_to_leg(four: WheelMover) -> None:
    pitch = math.tau / 4
    one, next_leg = four.pose(0.3), four.pose(0.3 + pitch)
    assert (one.supporting, next_leg.supporting) == (0, 1)
    np.testing.assert_allclose(next_leg.hub - one.hub, [four.step, 0.0], atol=64 * EPS)
    np.testing.assert_allclose(
        np.roll(next_leg.rollers, -1, axis=0) - one.rollers, [[four.step, 0.0]] * 4, atol=1e-15
    )
    before, after = four.pose(pitch / 2 - 1e-9), four.pose(pitch / 2)
    np.testing.assert_allclose(after.hub, before.hub, atol=2e-9 * HEIGHT)
    assert after.contact[0] - before.contact[0] == pytest.approx(four.print_gap, abs=1e-8)
    assert four.pose(-3.0).hub[0] < four.pose(-2.9).hub[0] < four.pose(12.0).hub[0]


def test_rollers_stay_on_the_cam(four: WheelMover) -> None:
    phi = np.linspace(0.0, math.tau, 4001)
    profile = cam_body(exchanged()).profile(phi).place
    for turned in (0.0, 0.4, 1.0, 2.5):
        pose = four.pose(turned)
        places = pose.of_cam(profile)
        for roller in pose.rollers:
            # points of the profile lie 0.05 rad m / 637 apart: the nearest is off by less than that squared over r
            nearest = float(np.hypot(*(places - roller).T).min())
            assert -64 * EPS < nearest - four.roller < (0.09 * math.tau / 4000) ** 2 / four.roller


def test_unevenness_is_that_of_a_fine_mesh(three: WheelMover) -> None:
    rates = three.rate(np.linspace(-three.half, three.half, 20001))
    assert three.rates.greatest == pytest.approx(rates.max(), rel=1e-8)
    assert three.rates.greatest >= rates.max() and three.rates.least <= rates.min()


def test_a_law_that_is_not_symmetric_walks_too_and_its_jump_is_told() -> None:
    cam = exchanged(
        ("symmetric = true\n", ""),
        ("k1 = 0.75", "k1 = 0.3"),
        ('to = "90 deg"', 'to = "1 rad"\nfrom = "-1 rad"'),
    )
    wheel = ct.walking_wheel(cam)
    found = rolling(wheel)
    assert found.level < 64 * EPS * HEIGHT and found.slip < 64 * EPS
    assert abs(found.shoe_arc - found.ground) < 1e-13
    slopes = wheel.shoe.arc.curve.radius(np.array([-wheel.half, wheel.half]), 1)[1] * math.sin(wheel.half)
    assert found.joint == pytest.approx(-slopes[0] - slopes[1], rel=1e-12)
    assert abs(found.joint) > 1e-3


def test_a_shoe_with_gamma0_is_singular() -> None:
    path = expanded_path(ExponentialCurvature(10.0, 0.75), 0.05, 0.05, -1.0, 1.0)
    with pytest.raises(
        InputError, match=r"pressure_angle: the shoe is singular: .* jump by 5\.00417 mm; set it to 0"
    ):
        shoe(working_arc(path, legs=4), HEIGHT)


def test_a_shoe_with_a_cusp_is_refused_with_what_it_lacks() -> None:
    """A path that falls: 2 H' sin phi brings the radius of curvature below zero."""
    path = SymmetricPath(CirclePath(0.13, 0.0, 1 / 0.07, 0.0, 1.2))
    arc = working_arc(path, legs=3)
    bends = Shoe(arc, 0.0).bend(np.linspace(0.0, arc.stop, 2001))
    assert bends.min() < -0.135
    with pytest.raises(MotionError, match="longer by more than") as refusal:
        shoe(arc, 0.135)
    more = float(str(refusal.value).split("more than ")[1].split(" mm")[0])
    assert more == pytest.approx(1e3 * (-bends.min() - 0.135), abs=1e-3)
    assert shoe(arc, 0.135 + 1.0001e-3 * more).least_bend[0] > 0.0


@pytest.mark.parametrize(
    ("pairs", "said"),
    [
        ([("legs = 4", "legs = 2")], "legs must be a whole number from 3 to 24, got 2"),
        ([('"120 mm"', '"10 mm"')], "a post of 10 mm lets the roller of 15 mm reach the ground"),
        (
            [('to = "90 deg"', 'to = "40 deg"')],
            "the working arc covers -45 to 45 deg, the path -40 to 40 deg",
        ),
        ([("legs = 4", 'legs = 4\nworking_arc = ["-40 deg", "40 deg"]')], "a leg works up to 45 deg"),
        ([("legs = 4", 'legs = 4\nworking_arc = ["-40 deg", "50 deg"]')], "the same angle on both sides"),
    ],
)
def test_what_does_not_walk_is_refused(pairs: list[tuple[str, str]], said: str) -> None:
    with pytest.raises(InputError, match=said):
        ct.walking_wheel(exchanged(*pairs))


def test_a_longer_working_arc_than_the_legs_need_is_taken() -> None:
    wheel = ct.walking_wheel(exchanged(("legs = 4", 'legs = 4\nworking_arc = ["-60 deg", "60 deg"]')))
    assert wheel.closed.arcs[0].stop == pytest.approx(math.pi / 3)
    assert wheel.half == math.pi / 4
    assert rolling(wheel).clearance > -64 * EPS * HEIGHT


def test_the_step_in_many_digits() -> None:
    """X(pi/4) of a circle's path in closed form by mpmath: h phi plus the integral of H' sin phi."""
    cam = exchanged(('"exponential"', '"constant"'), ('k0 = "0.01 1/mm"\nk1 = 0.75', 'k0 = "0.012 1/mm"'))
    with mp.workdps(30):
        y, big = mp.mpf("0.05") - 1 / mp.mpf(12), 1 / mp.mpf(12)

        def lift(phi: mp.mpf) -> mp.mpf:
            root = mp.sqrt(big**2 - (y * mp.sin(phi)) ** 2)
            return (-y * mp.sin(phi) - y**2 * mp.sin(phi) * mp.cos(phi) / root) * mp.sin(phi)

        half = mp.pi / 4
        step = 2 * (mp.mpf("0.17") * half + mp.quad(lift, [0, half]))
    assert ct.walking_wheel(cam).step == pytest.approx(float(step), rel=32 * EPS)
