"""What is asked of the steady motion: shafts, driving moments, periods, samples at given places."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.steady_motion.steady import solution_of
from machines import CRANK, crank, engine
from samples import few

EPS = float(np.finfo(np.float64).eps)
GEARED = """\
[links.EC]
length = 0.5
mass = 1
centre = "C"
inertia = 0
[[gears]]
links = ["OA", "EC"]
ratio = {ratio}
"""


def test_shafts_are_referred_through_their_ratios() -> None:
    plain = ct.flywheel(engine())
    geared = ct.flywheel(
        engine(
            "fluctuation = 0.05\n[[machine.shafts]]\ninertia = 0.3\n[[machine.shafts]]\ninertia = 0.02\n"
            "ratio = -4\n[machine.flywheel]\nratio = 4"
        )
    )
    assert geared.present == pytest.approx(0.3 + 0.02 * 16, rel=4 * EPS)
    assert plain.inertia is not None
    assert geared.inertia == pytest.approx(plain.inertia, rel=1e-12)
    assert geared.added == pytest.approx((plain.inertia - 0.62) / 16, rel=1e-12)
    assert geared.rim is not None
    assert geared.rim.rim_speed == pytest.approx(
        0.5 * geared.rim.outer * 4 * geared.greatest_speed, rel=1e-12
    )


def test_no_flywheel_where_the_shafts_are_enough() -> None:
    found = ct.flywheel(engine("fluctuation = 0.05\n[[machine.shafts]]\ninertia = 1000"))
    assert found.added == found.added_first_order == 0.0
    assert found.rim is found.disc is found.source_rim is None
    assert found.obtained < 0.05
    assert 0.5 * (found.least_speed + found.greatest_speed) == pytest.approx(20.0, rel=1e-13)


def test_a_given_driving_moment_is_scaled_to_the_work() -> None:
    shaped = solution_of(engine('fluctuation = 0.05\ndriving = "1 + 0.5*cos(q)"'))
    plain = solution_of(engine())
    assert shaped.balance.driving_moment == pytest.approx(plain.balance.driving_moment, rel=1e-12)
    turned = np.linspace(0.0, 6.0, 7)
    scale = plain.balance.driving_moment * (1 + 0.5 * np.cos(0.4 + turned))
    np.testing.assert_allclose(shaped.balance.driving.at(turned), scale, rtol=1e-12)
    assert abs(shaped.balance.total.total) <= shaped.balance.error
    falling = solution_of(engine('fluctuation = 0.3\ndriving = "30 - v"'))
    settled = falling.speed.balance
    nodes = settled.cycle.panels.nodes
    ratio = settled.driving.at(nodes) / (30 - falling.speed.at(nodes))
    assert np.ptp(ratio) <= 1e-11 * ratio.mean(), "the moment belongs to the speed it brings about"
    assert falling.iterations > 1


def geared(ratio: float) -> ct.Mechanism:
    """The crank with a second wheel behind a gear."""
    text = CRANK.format(load="-8", fluctuation=0.01, speed=1) + GEARED.format(ratio=ratio)
    return ct.parse_mechanism(text.replace("O = [0, 0]", "O = [0, 0]\nE = [3, 0]"))


@pytest.mark.parametrize(("ratio", "turns"), [(-2.0, 1), (-1.5, 2), (-1 / 3, 3), (0.8, 5)])
def test_the_period_is_found(ratio: float, turns: int) -> None:
    """A wheel behind a gear carries a mass off its axis: everything repeats when both are back."""
    found = solution_of(geared(ratio))
    assert found.cycle.turns == turns
    assert found.needed is not None


def test_what_never_repeats_is_refused() -> None:
    with pytest.raises(
        ct.InputError, match="does not return to its initial position after 60 turns of the drive"
    ):
        ct.flywheel(geared(math.sqrt(2)))


def test_samples_at_given_places() -> None:
    mechanism = engine()
    even = ct.steady_motion(mechanism, 5)
    at = ct.steady_motion(mechanism, at=even.drive_value.values[:4, 0] + 6 * math.pi)
    np.testing.assert_allclose(at.turned, even.turned[:4], rtol=0.0, atol=64 * EPS * 20)
    np.testing.assert_allclose(
        at.velocity, even.velocity[:4], rtol=0.0, atol=1e-12 * float(np.abs(even.velocity).max())
    )
    source = ct.steady_motion(mechanism, 5, method="first-order")
    np.testing.assert_array_equal(source.drive_speed_first_order, even.drive_speed_first_order)
    np.testing.assert_allclose(
        source.angular_velocity.sel(link="OA"), source.drive_speed_first_order, rtol=8 * EPS
    )
    assert ct.parse_mechanism(even.attrs["mechanism"]) == mechanism


@pytest.mark.parametrize(
    ("damping", "swing", "fluctuation"),
    few(
        [(5.0, 1.0, 1.9), (50.0, 20.0, 0.002), (200.0, 20.0, 0.005)],
        [(5.0, 1e-6, 1.9), (5.0, 1.0, 1.9), (50.0, 20.0, 0.05), (50.0, 20.0, 0.002), (200.0, 20.0, 0.005)],
    ),
)
def test_a_damped_crank_settles(damping: float, swing: float, fluctuation: float) -> None:
    """J w w' = D - c w - S sin q, linear for small S: amplitude S / hypot(c, J w_m) of w, and its squares beyond."""
    mechanism = crank(f"-{damping}*v - {swing}*sin(q)", fluctuation)
    found = ct.flywheel(mechanism)
    assert found.inertia is not None
    carried = max(found.inertia, 0.0) + 2.0
    amplitude = swing / math.hypot(damping, carried * 10.0)
    linear = 2 * amplitude / 10.0
    # J itself is known to 1e-13 of the whole energy, and the swing of that is the fluctuation
    assert found.obtained == pytest.approx(linear, rel=linear**2 + 1e-11 / linear)


def test_damping_may_make_a_flywheel_needless() -> None:
    """With 5 w^2 the crank's own inertia keeps 0.0392, whatever the first round asks for; 0.05 is allowed."""
    found = solution_of(crank("-5*v*abs(v) - 20*sin(q)", 0.05))
    assert found.needed is not None
    assert found.needed <= found.present
    fluctuation = 2 * 20 / math.hypot(2 * 5 * 10, 2 * 10) / 10
    assert found.speed.extremes().range / 10 == pytest.approx(fluctuation, rel=4 * fluctuation**2)


def test_a_load_that_jumps_where_the_cycle_begins_repeats() -> None:
    """sign(sin q) is 0 at q = 0 and not at 2 pi as rounded; the work swings by 20 pi."""
    text = CRANK.format(load="-20 - 20*sign(sin(q))", fluctuation=0.01, speed=1)
    found = ct.flywheel(ct.parse_mechanism(text.replace("start = 0.3", "start = 0")))
    assert found.inertia == pytest.approx(20 * math.pi / (100 * 0.01) - 2, rel=1e-9)


def test_a_driving_moment_without_a_value_is_refused() -> None:
    with pytest.raises(ct.InputError, match="no finite value everywhere in the cycle"):
        ct.flywheel(engine('fluctuation = 0.05\ndriving = "1/(v - v)"'))
