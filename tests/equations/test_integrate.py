"""`integrate`: the printed tables of the sources, and the closed forms on every example and on random mechanisms."""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr
from hypothesis import assume, given, settings

import centrode as ct
from centrode.equations.integration import NUDGE, STRIDE, Scaled, adaptive_steps, cauchy_form
from centrode.kinematics.preparation import ready
from centrode.render.netcdf import write_dataset
from growing import descriptions, mechanism_of
from mechanisms import EPS, four_bar
from samples import few, spread
from worked_form import Worked

Array = npt.NDArray[np.float64]
REFERENCE = Path(__file__).parents[1] / "reference"
ROUNDED = 1 + 1e-9
"""A printed value is one of its decimals off by half a unit at most; the decimal fraction itself is not exact."""

SEVERAL = (
    "cardan-gear", "chebyshev-straight-line", "crank-rocker", "elliptic-trammel", "excavator-arm",
    "five-bar-two-drives",
    "four-bar-and-slider", "fourth-class-group", "geared-five-bar", "oscillating-cylinder", "parallelogram",
    "planetary-gear-train", "planetary-hypocycloid", "rack-and-pinion", "rolling-wheel-rod", "scotch-yoke", "shaper",
    "slider-between-cranks-locked", "slider-between-cranks-vertical", "tangent-mechanism", "two-link-arm", "wiper",
)  # fmt: skip
"""Every kind of joint, group and drive."""

CHANGING = (
    "antiparallelogram",
    "galloway",
    "kite",
    "parallelogram",
    "scott-russell",
    "three-crank-parallelogram",
)
"""Examples with change points, where the equations stop."""


def rows(name: str) -> list[dict[str, str]]:
    with (REFERENCE / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def link(data: xr.Dataset, name: str, variable: str = "angle") -> Array:
    return np.asarray(data[variable].sel(link=name))


# the sources


def printed(column: str) -> Array:
    return np.array([float(row[column]) for row in rows("planar-slider-rocker-table.csv")])


def worked_columns(data: xr.Dataset) -> dict[str, Array]:
    turning = {
        f"{symbol}{number}_{unit}": link(data, name, variable)
        for number, name in ((2, "AC"), (3, "CB"), (4, "BD"))
        for symbol, unit, variable in (("phi", "rad", "angle"), ("omega", "rad_s", "angular_velocity"))
    }
    return {**turning, "v_C_m_s": np.asarray(data["velocity"].sel(point="C", axis="x"))}


def test_the_assignments_table_by_its_own_method() -> None:
    """Runge-Kutta with 100 steps over a turn, as the source has it; it prints the first fifty rows."""
    data = ct.integrate(ct.example("slider-between-cranks"), "rk4", 100)
    assert np.abs(data["time"].to_numpy()[:50] - printed("t_s")).max() <= 0.5e-6 * ROUNDED
    columns = worked_columns(data)
    assert len(columns) == 7
    for name, computed in columns.items():
        assert np.abs(computed[:50] - printed(name)).max() <= 0.5e-3 * ROUNDED, name


def test_the_last_row_repeats_the_first() -> None:
    """Step 8 of the assignment: with a small error, that of the method; the closed form to rounding."""
    coarse, fine = (ct.integrate(ct.example("slider-between-cranks"), steps=n) for n in (100, 400))
    assert 1e-9 < coarse.attrs["return_difference"] < 0.5e-3
    # of fourth order: 4^4 times as near, give or take the next order
    assert coarse.attrs["return_difference"] / fine.attrs["return_difference"] > 4**3
    assert coarse.attrs["closed_return_difference"] <= 16 * EPS * 2 * np.pi


def test_the_assignments_equations_are_the_sources() -> None:
    """Rates from the differentiated chains against (2.8), printed."""
    form = cauchy_form(ct.example("slider-between-cranks"))
    hand = Worked((0.5, 1.9, 3.5))
    times = np.linspace(0.0, 2 * np.pi, 9)
    states = np.array(hand.start) + np.random.default_rng(5).uniform(-0.3, 0.3, (9, 3))
    sines = np.abs(np.cos(states[:, 0]) * np.sin(states[:, 1] - states[:, 2]))
    wrong = np.abs(form.rates(times, states) - hand.rates(times, states)).max(axis=1)
    assert (wrong <= 64 * EPS / sines**2).all()


@pytest.mark.parametrize(("method", "steps"), [("rk4", 100), ("adaptive", 100)])
def test_the_excerpts_table(method: str, steps: int) -> None:
    """From 0 to 6 s in 100 steps; with 0.15 for a coefficient, as printed, a slip of the source."""
    data = ct.integrate(ct.example("four-bar-excerpt-printed"), method, steps, stop=12.0)
    table = rows("four-bar-table.csv")
    assert len(table) == 16
    for column, values in (
        ("t_s", np.asarray(data["time"])),
        ("phi1_rad", link(data, "OA")),
        ("phi2_rad", link(data, "DB")),
        ("phi3_rad", link(data, "BA")),
    ):
        half = 0.5e-2 if column == "t_s" else 0.5e-3
        found = np.array([float(row[column]) for row in table])
        assert np.abs(values[:16] - found).max() <= half * ROUNDED, column


def test_the_excerpts_right_values() -> None:
    """The mechanism that the text describes has 0.2/0.3 for a coefficient, so other angles and other rates."""
    data = ct.integrate(ct.example("four-bar-excerpt"), stop=1.8)
    one, two, three = (link(data, name) for name in ("OA", "AB", "DB"))
    common = 2 * 0.1 / 0.3 / np.sin(two - three)
    assert np.abs(link(data, "AB", "angular_velocity") + common * np.sin(one - three)).max() <= 64 * EPS
    assert np.abs(link(data, "DB", "angular_velocity") + common * np.sin(one - two)).max() <= 64 * EPS
    assert data["angular_velocity"].to_numpy()[0, 1:] == pytest.approx([-2 / 3, -2 / 3], abs=1e-9)
    printed_too = ct.integrate(ct.example("four-bar-excerpt-printed"), stop=1.8)
    slip = 0.15 * np.sin(2.08) / np.sin(1.04)
    assert link(printed_too, "DB", "angular_velocity")[0] == pytest.approx(slip, abs=64 * EPS)


def test_the_locked_mechanism_stops_where_the_closed_forms_do() -> None:
    data = ct.integrate(ct.example("slider-between-cranks-locked"), "adaptive", tolerance=1e-12)
    limit = float(data["event_value"][0])
    assert data.attrs["stop_time"] == pytest.approx(limit, abs=1e-9)
    known = np.asarray(data["status"]) == ct.Status.OK
    assert np.array_equal(known, np.asarray(data["time"]) < limit)
    assert np.isnan(np.asarray(data["angle"])[~known, 1:]).all()
    assert np.isnan(np.asarray(data["velocity"])[~known]).all()
    assert np.isnan(data.attrs["return_difference"])


# the closed forms


def allowed(mechanism: ct.Mechanism, data: xr.Dataset) -> dict[str, float]:
    """How far an integrated motion may be off, in angles and slides and their rates, in places and velocities.

    A step errs by tolerance (1 + |x|) in each unknown. The exact flow keeps what the constraints have drifted, so the
    errors of all steps add up in the constraints, and come back to the unknowns by the inverse Jacobian: its condition
    is what they are stretched by. Rates hold one more inverse, and sixth-order differences divide a rounding of places
    by their step.
    """
    form = cauchy_form(mechanism)
    scaled = Scaled(form, float(ready(mechanism).kinematics.numbers.scale))
    times, tolerance = np.asarray(data["time"]), data.attrs["tolerance"]
    found = adaptive_steps(scaled, times, tolerance)
    known = np.isfinite(found.state).all(axis=1)
    state, rates = found.state[known], found.rates[known]
    spread = sum(np.ptp([*link.coordinates.values()], axis=0).sum() for link in mechanism.links.values())
    reach = spread + np.abs(data["position"].to_numpy()[0]).max()
    noise = (
        16
        * EPS
        * len(mechanism.links)
        * reach
        / STRIDE
        * (1 + np.abs(data["angular_velocity"].to_numpy()[known]).max())
    )
    if not state.shape[1]:
        return {"state": 64 * EPS, "rate": 64 * EPS, "place": 64 * EPS * reach, "velocity": noise}
    shifts = NUDGE * np.diag(scaled.sizes)
    sides = [[scaled.constraints(times[known], state + sign * one) for sign in (1, -1)] for one in shifts]
    jacobian = np.stack([(ahead - behind) / (2 * NUDGE) for ahead, behind in sides], axis=-1)
    condition = float(np.linalg.cond(jacobian, np.inf).max())
    each = np.sqrt(state.shape[1]) * (tolerance + EPS) * (1 + np.abs(state / scaled.sizes).max())
    off = found.steps * each * condition * max(1.0, scaled.scale)
    rate = off * condition * (1 + np.abs(rates).max())
    return {"state": off, "rate": rate, "place": off * (1 + reach), "velocity": rate * (1 + reach) + noise}


KINDS = {
    "angle": "state",
    "slide": "place",
    "angular_velocity": "rate",
    "slide_velocity": "velocity",
    "position": "place",
    "velocity": "velocity",
}


def check_against_closed_forms(mechanism: ct.Mechanism, data: xr.Dataset) -> None:
    uniform = len(mechanism.drives) == 1 and mechanism.drives[0].speed is not None
    closed = ct.motion(mechanism, at=data["drive_value"][:, 0] if uniform else data["time"])
    ok = np.asarray(data["status"]) == ct.Status.OK
    limits = allowed(mechanism, data)
    for variable, kind in KINDS.items():
        far = np.abs(data[variable].to_numpy() - closed[variable].to_numpy())[ok]
        assert far.max(initial=0.0) <= limits[kind], variable
    off = data["angle"].to_numpy() - closed["angle"].to_numpy()
    assert np.array_equal(data["angle_difference"].to_numpy()[ok], off[ok])


@pytest.mark.parametrize("name", spread(SEVERAL, 8))
def test_adaptive_steps_agree_with_the_closed_forms(name: str) -> None:
    mechanism = ct.example(name)
    data = ct.integrate(mechanism, "adaptive", 40, tolerance=1e-11)
    whole = name not in CHANGING and not name.endswith("-locked")
    assert (np.asarray(data["status"]) == ct.Status.OK).all() == whole
    assert np.isfinite(data.attrs["stop_time"]) != whole
    check_against_closed_forms(mechanism, data)


@settings(max_examples=few(2, 10))
@given(descriptions())
def test_random_mechanisms_agree_with_the_closed_forms(parts: dict[str, Any]) -> None:
    mechanism = mechanism_of(parts)
    first = float(ct.motion(mechanism, 1).drive_value.to_numpy()[0, 0])
    try:
        data = ct.integrate(mechanism, "adaptive", 8, tolerance=1e-11, stop=first + 0.2)
    except ct.NotComputedYet:
        assume(False)
    check_against_closed_forms(mechanism, data)


@pytest.mark.parametrize("name", ["kite", "parallelogram", "scott-russell"])
def test_the_equations_stop_at_change_points(name: str) -> None:
    """Both assemblies meet there: the determinant is zero, and which of them goes on the equations do not tell."""
    mechanism = ct.example(name)
    data = ct.integrate(mechanism, "adaptive", 40)
    start, speed = float(data["drive_value"][0, 0]), mechanism.drives[0].speed
    places = (data["event_value"].to_numpy() - start) / speed
    # an error of the state is of the order of the tolerance over the determinant where it is found
    assert np.abs(places - data.attrs["stop_time"]).min() <= np.sqrt(1e-10)


# what is asked for


def test_a_stop_and_a_turn_backwards() -> None:
    crank_rocker = four_bar(1.0, 3.5, 3.0, 4.0, drives=[{"link": "OA", "start": 1.0, "speed": -2.0}])
    data = ct.integrate(crank_rocker, "adaptive", 10, stop=-1.0)
    assert np.asarray(data["time"]) == pytest.approx(np.linspace(0.0, 1.0, 11), abs=4 * EPS)
    assert link(data, "OA") == pytest.approx(np.linspace(1.0, -1.0, 11), abs=4 * EPS)
    check_against_closed_forms(crank_rocker, data)


@pytest.mark.parametrize(("size", "speed"), [(1e-6, 1e-10), (1e3, 1e4)])
def test_velocities_of_small_and_slow_mechanisms(size: float, speed: float) -> None:
    """Similar mechanisms have similar velocities, whatever a second and a metre are to them."""
    lengths = (1.0, 3.5, 3.0, 4.0)
    drives = [{"link": "OA", "start": 1.0, "speed": speed}]
    ours = ct.integrate(four_bar(*(size * length for length in lengths), drives=drives), "adaptive", 12)
    alike = ct.integrate(four_bar(*lengths), "adaptive", 12)
    velocities = (np.asarray(data["velocity"]) for data in (ours, alike))
    assert next(velocities) / (size * speed) == pytest.approx(
        next(velocities), abs=100 * ours.attrs["tolerance"]
    )


def test_laws_of_time_are_followed() -> None:
    wiper = ct.integrate(ct.example("wiper"), steps=20)
    law = ct.motion(ct.example("wiper"), 21)
    assert np.asarray(wiper["time"]) == pytest.approx(np.asarray(law["time"]), abs=16 * EPS)
    assert link(wiper, "OA") == pytest.approx(link(law, "OA"), abs=16 * EPS)


def test_drives_alone_need_no_integration() -> None:
    data = ct.integrate(ct.example("two-link-arm"), steps=4)
    assert data.sizes["constraint"] == 0
    check = ct.motion(ct.example("two-link-arm"), 5)
    assert np.abs(data["position"].to_numpy() - check["position"].to_numpy()).max() <= 16 * EPS
    assert (np.asarray(data["status"]) == ct.Status.OK).all()


def test_words_and_units() -> None:
    data = ct.integrate(ct.example("slider-between-cranks"), steps=4)
    assert data["constraint"].to_numpy().tolist() == ["y_C", "x_D", "y_D"]
    assert data["angle_difference"].attrs["units"] == "rad"
    assert data["drift"].attrs["units"] == "1"
    assert (data.attrs["method"], data.attrs["steps"]) == ("rk4", 4)
    assert ct.parse_mechanism(data.attrs["mechanism"]) == ct.example("slider-between-cranks")


def test_it_is_kept_as_netcdf(tmp_path: Path) -> None:
    data = ct.integrate(ct.example("slider-between-cranks-locked"), steps=30)
    write_dataset(data, tmp_path / "i.nc")
    with xr.open_dataset(tmp_path / "i.nc", engine="scipy") as read:
        assert np.array_equal(read["angle"], data["angle"], equal_nan=True)
        assert read.attrs["stop_time"] == data.attrs["stop_time"]


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"method": "rk5"}, 'did you mean "rk4"?'),
        ({"method": "euler"}, "known are: rk4, adaptive"),
        ({"steps": 0}, "give 1 to 100000"),
        ({"steps": 2.5}, "give 1 to 100000"),
        ({"steps": True}, "give 1 to 100000"),
        ({"steps": 10**9}, "give 1 to 100000"),
        ({"method": "adaptive", "tolerance": 0.0}, "give 1e-13 to 0.01"),
        ({"method": "adaptive", "tolerance": float("nan")}, "give 1e-13 to 0.01"),
        ({"method": "adaptive", "tolerance": "small"}, "give 1e-13 to 0.01"),
        ({"stop": float("inf")}, "the range must be finite"),
    ],
)
def test_what_is_refused(asked: dict[str, Any], message: str) -> None:
    with pytest.raises(ct.InputError, match=re.escape(message)):
        ct.integrate(ct.example("crank-rocker"), **asked)


def test_the_sphere_is_refused() -> None:
    with pytest.raises(ct.InputError, match="not on the sphere"):
        ct.integrate(ct.example("spherical-four-bar"))
