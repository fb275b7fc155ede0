"""The normal form as numbers: integrated, it gives the motion back."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import centrode as ct
from centrode.equations.integration import CauchyForm, cauchy_form
from worked_out import planar_examples

TABLE = Path(__file__).parents[1] / "reference" / "planar-slider-rocker-table.csv"
EPS = np.finfo(float).eps
TIGHT = 1e-11
"""Relative tolerance asked of the integrator."""


def state_of(form: CauchyForm, motion: object) -> np.ndarray:
    """The unknowns at the samples of a motion, those of cylinders and bearings left out by the caller."""
    columns = []
    for name in form.names:
        kind, _dot, of = name.partition(".")
        data = motion.angle.sel(link=of) if kind == "angle" else motion.slide.sel(guide=of)  # type: ignore[attr-defined]
        columns.append(data.values)
    return np.stack(columns, axis=-1)


def test_names_symbols_and_the_start_of_the_worked_example() -> None:
    form = cauchy_form(ct.example("slider-between-cranks"))
    assert form.names == ("angle.AC", "angle.CB", "angle.BD")
    assert form.symbols == ("phi2", "phi3", "phi4")
    assert form.constraint_names == ("y_C", "x_D", "y_D")
    assert form.initial == pytest.approx([0.5, 1.9, 3.5], abs=4 * EPS)
    assert np.max(np.abs(form.constraints(0.0, form.initial))) <= 16 * EPS


def test_runge_kutta_gives_the_printed_table() -> None:
    """The source's rkfixed: 100 steps over one turn; every printed digit of the angles and rates is met."""
    form = cauchy_form(ct.example("slider-between-cranks"))
    steps, h = 100, 2 * np.pi / 100
    state = form.initial
    states = [state]
    for k in range(steps):
        a = form.rates(k * h, state)
        b = form.rates((k + 0.5) * h, state + 0.5 * h * a)
        c = form.rates((k + 0.5) * h, state + 0.5 * h * b)
        d = form.rates((k + 1) * h, state + h * c)
        state = state + h / 6 * (a + 2 * b + 2 * c + d)
        states.append(state)
    with TABLE.open(encoding="utf-8", newline="") as file:
        printed = list(csv.reader(line for line in file if not line.startswith("#")))
    for k, row in enumerate(printed[1:]):
        numbers = [float(x) for x in row]
        worked = [*states[k], *form.rates(k * h, states[k])]
        # half a unit of the third decimal
        assert np.max(np.abs(np.array(numbers[1:7]) - worked)) <= 0.5e-3 + 16 * EPS, k
    # one turn brings it back, but for the error of the method, h^4
    assert np.max(np.abs(states[-1] - form.initial)) <= h**4


@pytest.mark.parametrize("name", planar_examples())
def test_rates_at_samples_are_the_velocities(name: str) -> None:
    mechanism = ct.example(name)
    form = cauchy_form(mechanism)
    motion = ct.motion(mechanism, samples=5)
    try:
        states = state_of(form, motion)
    except (KeyError, ValueError):
        pytest.skip("it has unknowns that are not in a motion, or none")
    ok = motion.status.values == ct.Status.OK
    time = motion.time.values[ok]
    states = states[ok]
    scale = max(1.0, float(np.max(np.abs(states))))
    assert np.max(np.abs(form.constraints(time, states))) <= 64 * EPS * scale * len(form.names)
    rates = form.rates(time, states)
    assert rates.shape == states.shape
    one = np.stack([form.rates(t, x) for t, x in zip(time, states, strict=True)])
    assert np.array_equal(rates, one)
    for i, full in enumerate(form.names):
        kind, _dot, of = full.partition(".")
        if kind != "angle":
            continue
        known = motion.angular_velocity.sel(link=of).values[ok]
        worst = max(np.linalg.cond(matrices(form, time, states)[k]) for k in range(len(time)))
        speed = 1.0 + np.max(np.abs(rates))
        assert np.max(np.abs(rates[:, i] - known)) <= 64 * EPS * worst * speed**2
    places = form.positions(time, states)
    for point in motion.point.values:
        known = motion.position.sel(point=point).values[ok]
        # digits of a position that is near a dead point are those of its angles
        assert np.max(np.abs(places[point] - known)) <= 256 * EPS * worst_of(form, time, states) * scale


def matrices(form: CauchyForm, time: np.ndarray, states: np.ndarray) -> np.ndarray:
    """The Jacobian of the constraints by differences of the rates' own left sides, block by block."""
    count = states.shape[-1]
    h = 1e-6
    columns = [
        (form.constraints(time, states + h * unit) - form.constraints(time, states - h * unit)) / (2 * h)
        for unit in np.eye(count)
    ]
    return np.stack(columns, axis=-1)


def worst_of(form: CauchyForm, time: np.ndarray, states: np.ndarray) -> float:
    return float(max(np.linalg.cond(one) for one in matrices(form, time, states)))


@pytest.mark.parametrize(
    "name", ["inverted-slider-crank", "geared-five-bar", "third-class-triad", "rolling-wheel-rod"]
)
def test_integrated_it_gives_the_motion(name: str) -> None:
    mechanism = ct.example(name)
    form = cauchy_form(mechanism)
    motion = ct.motion(mechanism, samples=9)
    time = motion.time.values
    found = solve_ivp(
        form.rates, (0.0, time[-1]), form.initial, "DOP853", time[time >= 0], rtol=TIGHT, atol=TIGHT
    )
    states = state_of(form, motion)
    # errors of single steps add up along the way: a hundred steps or so, enlarged as the constraints allow
    allowed = 1e3 * TIGHT * worst_of(form, time, states)
    assert np.max(np.abs(found.y.T - states)) <= allowed
    assert np.max(np.abs(form.constraints(time, found.y.T))) <= allowed


def test_cylinders_have_angles_of_their_own() -> None:
    form = cauchy_form(ct.example("excavator-arm"))
    assert "angle.K-A" in form.names
    angle = form.initial[form.names.index("angle.K-A")]
    at = form.positions(0.0, form.initial)
    way = at["A"] - at["K"]
    assert angle == pytest.approx(np.arctan2(way[1], way[0]), abs=16 * EPS)
    assert np.hypot(*way) == pytest.approx(2.41, rel=16 * EPS)


def test_a_singular_group_has_no_rates() -> None:
    """Crank and coupler in line, links parallel: NaN, and only for that state among several."""
    form = cauchy_form(ct.example("crank-rocker"))
    states = np.array([form.initial, [1.0, 1.0]])
    rates = form.rates(np.zeros(2), states)
    assert np.isfinite(rates[0]).all()
    assert np.isnan(rates[1]).all() or np.max(np.abs(rates[1])) > 1 / (16 * EPS)


def test_the_sphere_is_refused() -> None:
    with pytest.raises(ct.InputError, match="in the plane, not on the sphere"):
        cauchy_form(ct.example("spherical-four-bar"))
