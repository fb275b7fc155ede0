"""Sentences of residuals and counts: what is zero is called exact, and what all or none do is not counted twice."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.render.spelling import PlainSpelling, ScreenSpelling
from centrode.synthesis.requests import SYNTHESES
from centrode.synthesis.synthesise import synthesise
from centrode.views import limits, multibody_motion, position_plan, regions, structure, synthesis

SAY = PlainSpelling(None).text


@pytest.mark.parametrize(
    ("place", "speed", "said"),
    [
        (0.0, 0.0, "kept exactly"),
        (
            0.0,
            2e-15,
            "kept exactly in positions and within 2.0e-15 1/s in velocities, of the greatest length",
        ),
        (1e-16, 0.0, "kept within 1.0e-16 in positions, of the greatest length, and exactly in velocities"),
        (
            1e-16,
            2e-15,
            "kept within 1.0e-16 in positions and 2.0e-15 1/s in velocities, of the greatest length",
        ),
    ],
)
def test_constraints_of_a_simulation(place: float, speed: float, said: str) -> None:
    run = xr.Dataset({"residual": ("sample", [0.0, place]), "velocity_residual": ("sample", [speed, 0.0])})
    assert SAY(multibody_motion._residuals(run)) == said


@pytest.mark.parametrize("name", ["kite", "slider-between-cranks", "six-bar-press", "crank-rocker"])
def test_an_initial_position_closes_exactly_where_its_residual_is_zero(name: str) -> None:
    checked = ct.check(ct.example(name))
    said = {SAY(fact.label): SAY(fact.value) for fact in structure.facts(checked)}["initial position"]
    assert ("exactly" in said) == (checked.initial_residual == 0.0)
    assert ("within" in said) == (checked.initial_residual > 0.0)


@pytest.mark.parametrize(
    ("reached", "said"),
    [
        ([], "none"),
        ([False, False], "2, none around the region"),
        ([True, True], "2, all around the region"),
        ([True, False, True], "3, 2 of them around the region"),
    ],
)
def test_limits_on_grid_lines(reached: list[bool], said: str) -> None:
    region = xr.Dataset({"border_reached": ("border", np.array(reached, dtype=bool))})
    assert SAY(regions._limits(region)) == said


@pytest.mark.parametrize(
    ("reached", "said"), [(12, "12, all reached"), (0, "12, none reached"), (5, "12, 5 of them reached")]
)
def test_positions_of_a_plan(reached: int, said: str) -> None:
    assert SAY(position_plan._count_of_reached(12, reached)) == said


def test_the_range_between_limits_is_chosen_by_what_is_at_hand() -> None:
    """A terminal has the option; the workbench, whose description is open, names its key alone."""
    uniform = ct.example("slider-between-cranks-locked")
    repair = limits._repair(uniform)
    option, key = "--range reachable", 'range = "reachable" under [study]'
    assert key in SAY(repair) and option in SAY(repair)
    screen = ScreenSpelling(None).text(repair)
    assert key in screen and "--" not in screen
    # as the option and the key do it: the same range
    assert uniform.with_range("reachable").study.range == "reachable"


def test_poses_that_are_met_exactly_have_no_error() -> None:
    """Three poses are led through exactly: what is left is rounding of the places, of 0.1 m and less."""
    targets = [["0 mm", "0 mm", "0 deg"], ["30 mm", "10 mm", "20 deg"], ["50 mm", "40 mm", "50 deg"]]
    wanted = {"topology": "crank-rocker", "kind": "motion", "targets": targets}
    found = synthesise(SYNTHESES.from_tables({"synthesis": wanted}))
    errors = [one.greatest for one in found.answers]
    assert 0.0 < max(errors) < 1e-14
    assert {synthesis.error_shown(found, error) for error in errors} == {0.0}
    assert synthesis.error_shown(found, 1e-12) == 1e-12
    facts = {SAY(fact.label): SAY(fact.value) for fact in synthesis.sheet(found).facts}
    assert facts["greatest error of the best"].split()[0] == "0"
    table = synthesis._table(found)
    assert not any(column.values.any() for column in table.columns if column.name.endswith("error"))


def test_an_error_of_angles_is_beside_a_radian() -> None:
    function = SimpleNamespace(
        task=SimpleNamespace(synthesis=SimpleNamespace(kind="function")),
        mechanism=SimpleNamespace(space="plane"),
    )
    assert synthesis.error_shown(function, -1e-13) == 0.0  # type: ignore[arg-type]
    assert synthesis.error_shown(function, -1e-11) == -1e-11  # type: ignore[arg-type]
