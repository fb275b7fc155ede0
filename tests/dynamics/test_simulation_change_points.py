"""Simulation where the assembly is kept: the path ends at the change point, and is the smooth one up to there."""

from __future__ import annotations

import math
from typing import Any

import pytest

import centrode as ct
from centrode.dynamics.simulation.steady_state import steady_regime
from mechanisms import parts_of
from redriven import redriven

PARALLEL = """
[frame.points]
O = [0, 0]
D = [4, 0]
[links.OA]
length = 1
mass = 3
shape = "rod"
angle = 0.5
[links.AB]
length = 4
mass = 5
shape = "rod"
angle = 0
[links.DB]
length = 1
mass = 3
shape = "rod"
angle = 0.5
[[drives]]
link = "OA"
speed = 1
[assembly]
continuation = "CONTINUATION"
"""
INERTIA = 2 * 3 / 3 + 5
"""Two rods about their ends and a coupler that does not turn: the same at every angle of a parallelogram."""


def parallelogram(continuation: str = "keep", angle: float = 0.5) -> ct.Mechanism:
    text = PARALLEL.replace("CONTINUATION", continuation)
    return ct.parse_mechanism(text.replace("angle = 0.5", f"angle = {angle!r}"))


SPHERE = """
space = "sphere"
[frame.points]
A = [1, 0, 0]
D = ["cos(0.9)", "sin(0.9)", 0]
Z = [0, 0, 1]
[links.AB]
length = 0.4
reference = ["A", "D"]
model = "ring and point mass"
centre = "A"
inertia = 2
[links.BC]
length = 0.9
[links.DC]
length = 0.4
reference = ["D", "A"]
[[drives]]
link = "AB"
start = 0.5
speed = 1
[assembly]
sides = { C = "left" }
continuation = "keep"
"""


@pytest.mark.parametrize("scheme", ["adaptive", "stiff"])
@pytest.mark.parametrize(("moment", "place"), [(2.0, math.pi), (-2.0, 0.0)])
def test_the_path_ends_at_the_change_point(moment: float, place: float, scheme: Any) -> None:
    """From rest at 0.5 rad under a constant moment: t = sqrt(2 J |q - 0.5| / M) where the bars lie in one line."""
    settings = ct.Simulation(driving=repr(moment), duration=20, scheme=scheme, tolerance=1e-11)
    found = ct.simulate(parallelogram(), settings, motion=True)
    assert found.attrs["ended"] == "change point"
    names = found.occasion_kind.attrs["flag_meanings"].split()
    assert [names[k] for k in found.occasion_kind.values] == ["change_point"]
    assert float(found.occasion_value[0]) == pytest.approx(place, abs=1e-9)
    time = math.sqrt(2 * INERTIA * abs(place - 0.5) / abs(moment))
    assert [float(found.time[-1]), float(found.occasion_time[0])] == pytest.approx([time, time], rel=1e-9)
    assert found.inertia.values == pytest.approx(
        INERTIA, rel=1e-10
    )  # first derivatives beside a change point
    assert found.angle.sel(link="AB").values == pytest.approx(0.0, abs=1e-9)
    assert 'continuation = "keep"' in found.attrs["mechanism"]


def test_fixed_steps_end_there_too() -> None:
    settings = ct.Simulation(speed=1, duration=4, scheme="runge-kutta-4", steps=100)
    found = ct.simulate(parallelogram(), settings)
    assert found.attrs["ended"] == "change point"
    assert float(found.time[-1]) == pytest.approx(2.64, abs=1e-12)  # the last step before pi - 0.5
    assert float(found.occasion_value[0]) == pytest.approx(math.pi, abs=1e-9)


def test_a_start_at_a_change_point() -> None:
    """One at the start lies behind it: forwards it runs to the next, backwards there is no path."""
    text = ct.mechanism_text(parallelogram(angle=0.0)).replace(
        "[assembly]", '[assembly]\nsides = { B = "left" }'
    )
    mechanism = ct.parse_mechanism(text)
    found = ct.simulate(mechanism, ct.Simulation(speed=1, duration=20))
    assert found.attrs["ended"] == "change point"
    assert float(found.time[-1]) == pytest.approx(math.pi, rel=1e-8)
    for into in ({"speed": -1}, {"driving": "-3"}):
        with pytest.raises(ct.MotionError, match="starts at the change point"):
            ct.simulate(mechanism, ct.Simulation(duration=20, **into))
    with pytest.raises(ct.MotionError, match="limit or a change point"):
        ct.simulate(mechanism, ct.Simulation(duration=20, speed=-1, scheme="runge-kutta-4"))


def test_beyond_a_change_point_nothing_starts() -> None:
    with pytest.raises(ct.InputError, match="does not reach"):
        ct.simulate(parallelogram(), ct.Simulation(start=4.0, speed=1, duration=1))


def test_the_same_on_the_sphere() -> None:
    """Equal opposite arcs lie in one circle at 0 and 180 degrees; a crank of 2 kg m^2 runs there at its even speed."""
    found = ct.simulate(ct.parse_mechanism(SPHERE), ct.Simulation(speed=3, duration=5))
    assert found.attrs["ended"] == "change point"
    assert float(found.time[-1]) == pytest.approx((math.pi - 0.5) / 3, rel=1e-9)


def test_the_same_of_a_group_of_higher_class() -> None:
    """A parallelogram led by the rocker behind its coupler: the angle of FR with the crank at 0 comes from dyads."""
    by_dyads = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "D": [4.0, 0.0], "F": [1.0, 5.0]}},
        links={
            "OA": {"length": 1.0},
            "coupler": {"points": {"A": [0.0, 0.0], "B": [4.0, 0.0], "P": [2.0, 1.5]}, "angle": 0.0},
            "DB": {"length": 1.0, "angle": 0.7},
            "PR": {"length": 3.0},
            "FR": {"length": 2.0},
        },
        drives=[{"link": "OA", "start": 0.7, "speed": 1.0}],
        assembly={"sides": {"R": "left"}},
    )
    start, place = ct.motion(by_dyads, at=[0.0, 0.7]).angle.sel(link="FR").values[::-1]
    parts = parts_of(redriven(by_dyads, "FR", 0.7).other)
    parts["links"]["FR"]["inertia"] = 2.0
    mechanism = ct.Mechanism(**parts | {"assembly": {"continuation": "keep"}})
    found = ct.simulate(mechanism, ct.Simulation(speed=math.copysign(1.0, place - start), duration=5))
    assert found.attrs["ended"] == "change point"
    assert float(found.time[-1]) == pytest.approx(abs(place - start), rel=1e-8)


def test_smooth_ones_run_on() -> None:
    found = ct.simulate(parallelogram("smooth"), ct.Simulation(speed=1, duration=20))
    assert found.attrs["ended"] == "duration"


def test_no_steady_regime_across_change_points() -> None:
    with pytest.raises(ct.MotionError, match="turns all the way round"):
        steady_regime(parallelogram(), ct.Simulation(driving="1 - v", speed=1))
