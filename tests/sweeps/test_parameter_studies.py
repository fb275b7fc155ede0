"""Parameter studies: the numbers of separate calls, those that the thesis's model is known by, laws of similarity."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.dynamics.bearings.results import reaction_results
from centrode.dynamics.simulation.steady_state import steady_regime
from centrode.model.files import with_values
from centrode.sweeps import parameter_studies

THESIS = ct.example("spherical-crank-rocker")
PRESS = ct.example("six-bar-press")
FRICTION = tuple(f"loads.friction {point}.quadratic" for point in "ACD")
INERTIAS = {"links.AB.inertia": "1 - cos(links_AB_length)", "links.BC.inertia": "1 - cos(links_BC_length)"}


@pytest.fixture(scope="module")
def figures() -> xr.Dataset:
    """The thesis's figures 5 and 8."""
    arcs = {
        "links.AB.length": [math.pi / 12, math.pi / 13],
        "links.BC.length": [math.pi / 3 - math.pi / 12, math.pi / 2 - math.pi / 13],
        "simulation.driving": [1.0, 3.5],
    }
    return ct.sweep(THESIS, arcs, compute="simulate", dependent=INERTIAS)


def test_the_known_speeds_of_the_thesis(figures: xr.Dataset) -> None:
    """Speeds that are known to three decimals."""
    assert np.allclose(figures["least_speed"], [2.478, 5.062], rtol=0, atol=0.5e-3)
    assert np.allclose(figures["greatest_speed"], [3.631, 6.532], rtol=0, atol=0.5e-3)
    assert abs(float(figures["mean_speed"][0]) - 2.940) <= 0.5e-3
    assert figures["least_speed"].attrs["units"] == "rad/s"


def test_a_simulation_is_that_of_its_own_description(figures: xr.Dataset) -> None:
    arcs = {path: float(figures[path][1]) for path in ("links.AB.length", "links.BC.length")}
    inertias = {"links.AB.inertia": 1 - math.cos(arcs["links.AB.length"]),
                "links.BC.inertia": 1 - math.cos(arcs["links.BC.length"])}  # fmt: skip
    alone = steady_regime(with_values(THESIS, arcs | inertias | {"simulation.driving": 3.5}))
    for name, other in (
        ("least_speed", "least_speed"), ("least_speed_at", "least_at"), ("greatest_speed", "greatest_speed"),
        ("greatest_speed_at", "greatest_at"), ("mean_speed", "mean_speed"), ("fluctuation", "fluctuation"),
        ("driving_moment", "driving_moment"), ("period", "time"), ("multiplier", "multiplier"),
    ):  # fmt: skip
        assert float(figures[name][1]) == getattr(alone, other), name


def test_speeds_go_by_the_root_of_moment_over_friction() -> None:
    """With friction by squares alone, moment and friction over each other scale time and nothing else."""
    grid = ct.grid({"simulation.driving": [1.0, 4.0], FRICTION[0]: [0.1]})
    alike = dict.fromkeys(FRICTION[1:], "loads_friction_A_quadratic")
    found = ct.sweep(THESIS, grid, ["greatest_speed", "greatest_speed_at", "fluctuation"], compute="simulate",
                     dependent=alike)  # fmt: skip
    assert set(found.data_vars) == {
        *alike,
        "greatest_speed",
        "greatest_speed_at",
        "fluctuation",
        "computed",
        "refusal",
    }
    assert found["greatest_speed"].dims == ("simulation.driving", FRICTION[0])
    # the regime is settled to 1e-9 of its speed
    assert np.allclose(found["greatest_speed"][1], 2 * found["greatest_speed"][0], rtol=1e-8)
    assert np.allclose(found["fluctuation"][1], found["fluctuation"][0], rtol=1e-7)
    assert np.allclose(found["greatest_speed_at"][1], found["greatest_speed_at"][0], rtol=0, atol=1e-5)


def test_flywheels_steady_motions_and_reactions_are_those_of_separate_calls() -> None:
    lengths = {"links.OA.length": [0.34, 0.35]}
    other = ct.with_value(PRESS, "links.OA.length", 0.35)
    wheels = ct.sweep(PRESS, lengths, compute="flywheel")
    alone = ct.flywheel(other)
    assert alone.rim is not None
    assert [float(wheels[name][1]) for name in ("inertia", "energy_greatest_at", "rim_mass", "fluctuation")] == [
        alone.inertia, alone.greatest_at, alone.rim.mass, alone.obtained,
    ]  # fmt: skip
    steady = ct.sweep(PRESS, lengths, compute="steady_motion")
    course = abs(ct.steady_motion(other, 721).drive_speed)
    # samples miss an extreme by no more than the eighth of their second difference
    missed = float(np.abs(np.diff(course, 2)).max()) / 8
    assert 0.0 <= float(steady["greatest_speed"][1]) - float(course.max()) <= missed
    assert 0.0 <= float(course.min()) - float(steady["least_speed"][1]) <= missed
    forces = ct.sweep(PRESS, lengths, compute="reactions", samples=37)
    for load in reaction_results(other, 37).loads or ():
        found = [
            float(forces[f"{word}_{load.key}{end}"][1])
            for word in ("greatest", "least")
            for end in ("", "_at")
        ]
        assert found == [load.greatest, load.at_greatest, load.least, load.at_least]


def test_a_refused_mechanism_has_no_numbers_and_a_reason(tmp_path: Path) -> None:
    found = ct.sweep(PRESS, ct.grid({"links.OA.length": ["0.34 m", "1 m"]}), compute="flywheel")
    assert found["computed"].to_numpy().tolist() == [1, 0]
    assert math.isnan(float(found["inertia"][1])) and str(found["refusal"][1].values)
    assert "refused" in ct.summary(found)
    ct.write(found, tmp_path / "study")
    again = ct.open(tmp_path / "study" / "study.nc")
    assert np.array_equal(again["inertia"], found["inertia"], equal_nan=True)
    assert (tmp_path / "study" / "study.csv").read_text(encoding="utf-8").startswith("links.OA.length [m],")
    none = ct.sweep(PRESS, {"links.OA.length": [1.0]}, compute="flywheel")
    assert not none["computed"].any()


def test_the_figure_is_over_what_varies() -> None:
    lengths = ct.grid({"links.OA.length": [0.35, 0.33, 0.34]})
    found = ct.sweep(
        PRESS, lengths, ["inertia", "greatest_speed", "greatest_speed_at"], compute="steady_motion"
    )
    (figure,) = ct.figures(found).values()
    panels = figure.axes
    assert panels[-1].get_xlabel().startswith("links.OA.length")
    places = panels[0].get_lines()[0].get_xdata()
    assert np.all(np.diff(np.asarray(places, dtype=float)) > 0)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"compute": "simulat"}, 'unknown analysis "simulat"; did you mean "simulate"'),
        ({"compute": "flywheel", "outputs": "inertias"}, 'there is no number "inertias"; did you mean "inertia"'),
        ({"compute": "flywheel", "reduce": "max"}, "it belongs to sweeps of motions"),
        ({"compute": "flywheel", "dependent": {"links.OA.length": "1"}}, "it varies itself"),
        ({"compute": "flywheel", "dependent": {"links.DX.mass": "1"}}, "DX"),
        ({"compute": "flywheel", "dependent": {"links.DH.mass": "2*links_AB_length"}}, "links_AB_length"),
        ({"compute": "flywheel", "dependent": {"links.DH.mass": 3}}, "a formula is a text"),
        ({"dependent": {"links.DH.mass": "1"}, "outputs": "angle"}, "it belongs to a parameter study"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(options: dict[str, Any], message: str) -> None:
    with pytest.raises(ct.InputError, match=message):
        ct.sweep(PRESS, {"links.OA.length": [0.34]}, **options)


def test_too_many_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parameter_studies, "MOST_MECHANISMS", 1)
    with pytest.raises(ct.InputError, match="2 mechanisms are given; give at most 1"):
        ct.sweep(PRESS, {"links.OA.length": [0.33, 0.34]}, compute="flywheel")


def test_a_motion_does_not_depend_on_loads() -> None:
    with pytest.raises(ct.InputError, match="simulation"):
        ct.sweep(THESIS, {"simulation.driving": [1, 2]}, "joint_angle", samples=5)


def test_numbers_of_loads_and_of_the_simulation() -> None:
    changed = with_values(THESIS, {"simulation.driving": 2.5, "loads.friction C.quadratic": 0.05})
    assert ct.value_at(changed, "simulation.driving") == 2.5
    assert ct.value_at(changed, "loads.friction C.quadratic") == 0.05
    assert changed.simulation is not None and changed.simulation.driving == "2.5"
    with pytest.raises(ct.InputError, match="is not a number here"):
        ct.value_at(ct.example("six-bar-press-run-up"), "simulation.driving")


def test_variants_have_the_numbers_too() -> None:
    rows = [{"variant": "a", "links.OA.length": 0.34}, {"variant": "b", "links.OA.length": 0.35}]
    found = ct.variants(PRESS, rows, compute="flywheel")
    alone = ct.flywheel(ct.with_value(PRESS, "links.OA.length", 0.35))
    assert found.rows[1].numbers["inertia"] == (alone.inertia, "kg m^2")
    columns = {column.name: column for column in ct.tables(found)["summary"].columns}
    assert columns["inertia"].values[1] == alone.inertia and columns["inertia"].unit == "kg m^2"
    with pytest.raises(ct.InputError, match="unknown analysis"):
        ct.variants(PRESS, rows, compute="motion")
