"""Where a simulated machine stops, sticks, breaks loose or turns back, and where its loads jump."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.integrate
import scipy.optimize
import scipy.special

import centrode as ct
from simulated import crank_rocker, rotor, sledge


def test_coulomb_friction_stops_a_sledge() -> None:
    """From 3 m/s it comes to rest after m v / F = 2 s and m v^2 / (2 F) = 3 m, and stays."""
    found = ct.simulate(sledge(), ct.Simulation(speed=3, duration=5, samples=51))
    assert found.attrs["ended"] == "standstill"
    kinds = found.occasion_kind.attrs["flag_meanings"].split()
    assert [kinds[k] for k in found.occasion_kind.values] == ["standstill"]
    assert found.occasion_time.values == pytest.approx([2], rel=1e-8)
    assert found.occasion_value.values == pytest.approx([3], rel=1e-8)
    assert float(found.work_of_friction[-1]) == pytest.approx(-9, rel=1e-8)
    rest = found.time.values > 2.0
    assert (found.drive_speed.values[rest] == 0.0).all()
    assert (found.drive_acceleration.values[rest] == 0.0).all()
    assert (found.moment_of_friction.values[rest] == 0.0).all()


def test_sticking_and_breaking_loose() -> None:
    """Pulled by 5 sin t against 3 N: it sticks until sin t = 0.6, slides as the integral says, and sticks again."""
    found = ct.simulate(sledge(), ct.Simulation(driving="5*sin(t)", duration=6, tolerance=1e-11, samples=601))
    loose = math.asin(0.6)
    names = found.occasion_kind.attrs["flag_meanings"].split()
    times = list(zip(found.occasion_time.values.tolist(), found.occasion_kind.values.tolist(), strict=True))
    first = min(t for t, kind in times if names[kind] == "breaks_loose")
    assert first == pytest.approx(loose, abs=1e-12)
    # 2 v' = 5 sin t - 3 from there, until v = 0

    def speed(t: float) -> float:
        return 0.5 * (5 * (math.cos(loose) - math.cos(t)) - 3 * (t - loose))

    stop = float(scipy.optimize.brentq(speed, 2.0, 5.0))
    assert max(t for t, kind in times if names[kind] == "sticks") == pytest.approx(stop, abs=1e-9)
    # at that time 5 sin t is below -3, or it sticks until it is
    again = math.pi + math.asin(0.6)
    held = (found.time.values < loose) | ((found.time.values > stop) & (found.time.values < again))
    assert (found.drive_speed.values[held] == 0.0).all()
    # what holds it is what pulls
    pull = 5 * np.sin(found.time.values[held])
    assert found.moment_of_friction.values[held] == pytest.approx(-pull, abs=1e-12)


def test_it_stops_at_a_limit() -> None:
    """A rocker too short for a full turn: the crank gets to the limit, where its speed is zero, and no farther."""
    mechanism = crank_rocker(rocker=1.0)
    limit = ct.limits(mechanism).interval[1]
    found = ct.simulate(mechanism, ct.Simulation(driving="200", speed=1, duration=20))
    assert found.attrs["ended"] == "limit"
    assert float(found.drive_value[-1, 0]) == pytest.approx(limit, abs=2e-6)
    assert float(found.time[-1]) < 20
    assert (found.status == 0).all()


def test_stiff_laws() -> None:
    """J v' = 1e6 (10 - v): a transient of half a microsecond, then ten seconds: few steps, and the right speed."""
    for scheme in ("adaptive", "stiff"):
        found = ct.simulate(
            rotor(), ct.Simulation(driving="1e6*(10 - v)", duration=10, scheme=scheme, tolerance=1e-8)
        )
        assert found.evaluations < 20_000
        assert float(found.drive_speed[-1]) == pytest.approx(10, rel=1e-7)
        # 10 (t - J / b) in all
        assert float(found.turned[-1]) == pytest.approx(10 * (10 - 0.5e-6), rel=1e-6)


def test_jumps_of_loads_are_met() -> None:
    """A force that acts only forwards: halving the tolerance from afar changes nothing but in proportion to it."""
    loads = '[[loads]]\nkind = "force"\npoint = "B"\nvector = [-30, 0]\nwhile_moving = [1, 0]\n'
    mechanism = crank_rocker(loads)
    settings = ct.Simulation(driving="25 - 5*v", speed=3, duration=8, samples=2)
    ends = [
        float(ct.simulate(mechanism, settings.model_copy(update={"tolerance": tolerance})).turned[-1])
        for tolerance in (1e-8, 1e-10, 1e-12)
    ]
    assert abs(ends[0] - ends[2]) < 1e-5
    assert abs(ends[1] - ends[2]) < 1e-7


def test_turning_back() -> None:
    """Thrown against a force greater than friction: it turns back, and friction with it."""
    found = ct.simulate(sledge(), ct.Simulation(driving="-8", speed=3, duration=2, tolerance=1e-11))
    names = found.occasion_kind.attrs["flag_meanings"].split()
    assert [names[k] for k in found.occasion_kind.values] == ["turns_back"]
    # up against 8 + 3 N, down with 8 - 3 N on 2 kg
    up = 3 / 5.5
    assert float(found.occasion_time[0]) == pytest.approx(up, rel=1e-9)
    assert float(found.drive_speed[-1]) == pytest.approx(-2.5 * (2 - up), rel=1e-9)
