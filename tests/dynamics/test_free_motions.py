"""Mechanisms left to themselves, of one and of several degrees of freedom, against tables of values and closed forms.

The tables are those of tests/reference/dynamics; how far their two codes are apart stands in their column `differ`.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
import scipy.integrate
import scipy.special
import xarray as xr
from tools.campaigns.free_motions.references import position_of_squares

import centrode as ct
from free_motions import (
    CHANGE_POINTS,
    DOUBLE_PENDULUM,
    DOUBLE_ROCKER,
    FIVE_BAR,
    FOUR_BAR,
    PENDULUM,
    SPHERICAL_FOUR_BAR,
    squares,
    squeezer,
    table,
)

TIGHT = 1e-12
PRINTED = 1e-12
"""Half a unit of the last digit of the tables, of numbers of some radians."""


def left(text: str | ct.Mechanism, at: object, **changes: object) -> xr.Dataset:
    """The motion at instants, by a tight tolerance."""
    mechanism = ct.parse_mechanism(text) if isinstance(text, str) else text
    assert mechanism.simulation is not None
    update = {"tolerance": TIGHT, "equations": "multibody", **changes}
    return ct.simulate(mechanism, mechanism.simulation.model_copy(update=update), at=at)


@cache
def at_the_table(name: str) -> xr.Dataset:
    """The motion at the instants of its table."""
    texts = {
        "double-pendulum": DOUBLE_PENDULUM,
        "five-bar": FIVE_BAR,
        "through-limits": DOUBLE_ROCKER,
        "four-bar-reactions": FOUR_BAR,
        "andrews": squeezer(),
    }
    return left(texts[name], table(name)["t"])


# what the sources advise, of each instant: rad, or of Andrews' mechanism relative to the turns made
ADVISED = {
    "double-pendulum": lambda t, values: 1e-9,
    "five-bar": lambda t, values: 1e-9,
    "through-limits": lambda t, values: 1e-9 if t <= 1.0 else 1e-8,
    "four-bar-reactions": lambda t, values: 1e-8,
    "andrews": lambda t, values: 1e-9 * max(1.0, abs(values)) if t <= 0.03 else 1e-8,
}


@pytest.mark.parametrize("name", ADVISED)
def test_angles_are_those_of_the_tables(name: str) -> None:
    run, known = at_the_table(name), table(name)
    assert run.attrs["ended"] == "duration" or name == "andrews"
    for k, time in enumerate(known["t"]):
        for link in run["link"].values:
            value = known[link][k]
            bound = max(ADVISED[name](time, value), 3.0 * known["differ"][k])
            assert abs(float(run["angle"].sel(link=link)[k]) - value) <= bound + PRINTED, (link, time)


@pytest.mark.parametrize("name", ADVISED)
def test_rates_are_those_of_the_tables(name: str) -> None:
    """Rates are printed with twelve digits, and miss by what the angles do over the time of the motion."""
    run, known = at_the_table(name), table(name)
    for link in run["link"].values:
        rates = known[f"d{link}"]
        bound = 1e-7 * np.abs(rates).max()
        assert np.abs(run["angular_velocity"].sel(link=link).values - rates).max() <= bound, link


@pytest.mark.parametrize("name", ADVISED)
def test_energy_is_that_of_the_tables(name: str) -> None:
    run, known = at_the_table(name), table(name)
    given = run["work_of_other_loads"].values
    total = (run["kinetic_energy"] + run["potential_energy"]).values - given
    # the tables count the torque's work as a potential energy from the angle zero
    if name == "four-bar-reactions":
        total = total - 0.1 * math.pi / 3
    if name == "andrews":
        total = total + 0.033 * 0.0617138900142765
    assert np.abs(total - known["energy"]).max() <= 1e-8 * max(1.0, np.abs(known["energy"]).max())
    turned_over = np.abs(run["kinetic_energy"].values).max()
    assert run.attrs["worst_energy_residual"] <= 1e-9 * turned_over


def test_acceleration_of_the_crank() -> None:
    run, known = at_the_table("four-bar-reactions"), table("four-bar-reactions-forces")
    found = run["angular_acceleration"].sel(link="AB").values
    # over ten seconds an error of 1e-8 rad times the slope of the acceleration
    assert np.abs(found - known["ddAB"]).max() <= 1e-7 * np.abs(known["ddAB"]).max()


def test_on_the_sphere() -> None:
    known = table("spherical-four-bar-free")
    run = left(SPHERICAL_FOUR_BAR, known["t"])
    for k in range(len(known["t"])):
        assert abs(float(run["drive_value"][k, 0]) - known["AB"][k]) <= 1e-9
        assert abs(float(run["drive_speed"][k, 0]) - known["dAB"][k]) <= 1e-8
        place = run["position"].sel(point="C").values[k]
        assert np.abs(place - [known[f"C_{axis}"][k] for axis in "xyz"]).max() <= 1e-9


def test_a_pendulum_of_one_mass() -> None:
    """IFToMM A01: elliptic functions give the angle from the downward vertical, 2 asin(k sn(K - sqrt(g) t, k))."""
    times = np.array([0.5, 1.0, 5.0, 9.99, 10.0])
    run = left(PENDULUM, times)
    modulus = 0.5
    quarter = scipy.special.ellipk(modulus)
    sn = scipy.special.ellipj(quarter - math.sqrt(9.81) * times, modulus)[0]
    theta = -2.0 * np.arcsin(math.sqrt(modulus) * sn)
    place = run["position"].sel(point="A").values
    assert np.abs(place[:, 0] - np.sin(theta)).max() <= 1e-9
    assert np.abs(place[:, 1] + np.cos(theta)).max() <= 1e-9
    # elliptic functions of 25 digits, at 5 s and 10 s
    assert np.abs(place[2] - [-0.9423054350437573354968575, -0.3347543384140005807887011]).max() <= 1e-9
    assert np.abs(place[-1] - [-0.2750874625761168600543914, -0.9614192050991250642651351]).max() <= 1e-9


def test_a_pendulum_over_844_periods() -> None:
    """A01 at 2000 s, within the millionth of a metre that its library asks for."""
    run = left(PENDULUM, [2000.0], duration=2000.0, tolerance=1e-13)
    place = run["position"].sel(point="A").values[0]
    assert np.abs(place - [0.81460306858903215212, -0.58001882783693546159]).max() <= 1e-6


def test_andrews_mechanism_as_iftomm_has_it() -> None:
    """A03: the crank at -0.0620 rad; quadrature of the energy gives its angle to 25 digits."""
    known = {
        0.01: 2.153381340199014167181026,
        0.02: 8.178115005483415436431968,
        0.03: 15.80017467066272021171045,
        0.04: 24.36806492575054854642924,
        0.05: 33.81534072136017377697757,
    }
    run = left(squeezer(-0.0620), list(known))
    for k, beta in enumerate(known.values()):
        # 1e-9 m at F, 7 mm from the axis
        assert 0.007 * abs(float(run["angle"].sel(link="OF")[k]) - beta) <= 1e-9
    assert run.attrs["worst_energy_residual"] <= 1e-10


def test_through_change_points_on_the_smooth_branch() -> None:
    """All links in line, where two motions cross: the motion goes on smoothly, and says where it passed."""
    known = table("change-points")
    run = left(CHANGE_POINTS, known["t"])
    assert run.attrs["ended"] == "duration"
    kinds = run["occasion_kind"].attrs["flag_meanings"].split()
    passed = [
        float(time)
        for time, kind in zip(run["occasion_time"].values, run["occasion_kind"].values, strict=True)
        if kinds[kind] == "crossing"
    ]
    for k, time in enumerate(known["t"]):
        assert sum(one < time for one in passed) == known["crossings"][k]
        assert abs(float(run["angle"].sel(link="AB")[k]) - known["AB"][k]) <= 1e-8
        for link in ("BC", "DC"):
            apart = float(run["angle"].sel(link=link)[k]) - known[link][k]
            assert abs(math.remainder(apart, math.tau)) <= 1e-8, (link, time)


@pytest.mark.parametrize(("loops", "last"), [(1, 20.0), (2, 20.0), (12, 1.0)])
def test_squares_through_their_change_points(loops: int, last: float) -> None:
    """IFToMM A02: twice a turn all bars lie in line, and every square could fold; the position of B0 within 1e-9 m."""
    times = np.linspace(0.0, last, 41)
    run = left(squares(loops), times, tolerance=1e-13, duration=last)
    assert run.attrs["ended"] == "duration"
    places = run["position"].sel(point="B0").values
    assert np.abs(places - position_of_squares(loops, times)).max() <= 1e-9
    # values of elliptic functions to 25 digits
    known = {
        1: (0.4783850577609705590053952, 0.8781501787912093011639041),
        2: (0.3284581115408153786521642, 0.9445185381786009621612854),
    }
    if loops in known:
        assert np.abs(places[20] - known[loops]).max() <= 1e-9


def test_through_limits_by_both_routes() -> None:
    """The reduced equation reaches the limit and ends there; the equations of all links go on."""
    mechanism = ct.parse_mechanism(DOUBLE_ROCKER.replace("start = 1.2", "start = 1.2\nspeed = 1"))
    assert mechanism.simulation is not None
    settings = mechanism.simulation.model_copy(update={"tolerance": 1e-11})
    reduced = ct.simulate(mechanism, settings)
    assert reduced.attrs["ended"] == "limit"
    run = left(mechanism, reduced["time"].values)
    apart = np.abs(reduced["drive_value"].values - run["drive_value"].values).max()
    assert apart <= 1e-8
    farther = left(mechanism, [5.0])
    assert abs(float(farther["drive_value"][0, 0]) - 0.001934462271703) <= 1e-8


def test_time_reversal() -> None:
    """With all speeds reversed the five-bar goes back the way that it came."""
    mechanism = ct.parse_mechanism(FIVE_BAR)
    there = left(mechanism, [1.0], duration=1.0)
    drives = {name: float(there["drive_value"].sel(drive=name)[0]) for name in ("AB", "ED")}
    turned = "\n".join(
        f"start = {drives['AB']}"
        if line == "start = 2.0"
        else f"start = {drives['ED']}"
        if line == "start = 0.7"
        else line
        for line in FIVE_BAR.splitlines()
    )
    speeds = {f"drives.{name}": -float(there["drive_speed"].sel(drive=name)[0]) for name in ("AB", "ED")}
    back = left(turned, [1.0], duration=1.0, speeds=ct.Simulation(speeds=speeds).speeds)
    assert np.abs(back["drive_value"].values[0] - [2.0, 0.7]).max() <= 1e-9


@pytest.mark.parametrize("tolerance", [1e-2, 1e-6])
def test_no_step_passes_over_a_change_point(tolerance: float) -> None:
    """A square passes as many of them whatever the tolerance, and stays on its branch."""
    run = left(squares(1), [3.0], tolerance=tolerance, duration=3.0)
    tight = left(squares(1), [3.0], tolerance=1e-11, duration=3.0)
    assert run.sizes["occasion"] == tight.sizes["occasion"] > 0
    apart = run["position"].sel(point="B0").values - tight["position"].sel(point="B0").values
    assert np.abs(apart).max() <= 1e-3
