"""What there is to say about a motion with several degrees of freedom: facts, figures, chapter, report."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.simulation.results import SimulationResults, simulation_results
from centrode.sheets.players import MotionPlayer
from centrode.sheets.plots import Plot
from centrode.views.simulation import sheet
from free_motions import DOUBLE_PENDULUM, FIVE_BAR, FOUR_BAR


@pytest.fixture(scope="module")
def five_bar() -> SimulationResults:
    return simulation_results(ct.parse_mechanism(FIVE_BAR), 101)


def test_figures_are_the_datasets(five_bar: SimulationResults) -> None:
    run, pictures = five_bar.simulation, sheet(five_bar).pictures
    assert list(pictures) == [
        "simulation-coordinates",
        "simulation-phase-AB",
        "simulation-phase-ED",
        "simulation-energies",
        "simulation-works",
        "simulation-paths",
    ]
    plot = pictures["simulation-coordinates"]
    assert isinstance(plot, Plot)
    for (panel,), variable in zip(
        plot.rows, ("drive_value", "drive_speed", "drive_acceleration"), strict=True
    ):
        for k, curve in enumerate(panel.curves):
            np.testing.assert_array_equal(curve.values, run[variable].values[:, k])
    portrait = pictures["simulation-phase-ED"]
    assert isinstance(portrait, Plot)
    # all samples, and places between them where the curve bends
    drawn = portrait.abscissa.values + 1j * portrait.rows[0][0].curves[0].values
    sampled = (run["drive_value"] + 1j * run["drive_speed"]).sel(drive="ED").values
    assert sampled[0] == drawn[0] and sampled[-1] == drawn[-1] and np.isin(sampled, drawn).all()
    works = pictures["simulation-works"]
    assert isinstance(works, Plot)
    assert len(works.rows[0][0].curves) == run.sizes["source"]


def test_works_account_for_the_energies(five_bar: SimulationResults) -> None:
    """What springs and weights store is what their works take."""
    run = five_bar.simulation
    stored = run["potential_energy"] - run["potential_energy"][0]
    np.testing.assert_allclose(-run["work_part"].sum("source"), stored, atol=1e-8)


def test_the_chapter_plays_through_time(five_bar: SimulationResults) -> None:
    blocks = [
        block for section in sheet(five_bar).chapters["simulation"].sections for block in section.blocks
    ]
    players = [block for block in blocks if isinstance(block, MotionPlayer)]
    assert [player.by_time for player in players] == [True]


def test_a_result_is_restored_from_its_dataset(five_bar: SimulationResults) -> None:
    assert ct.summary(five_bar.simulation) == ct.summary(five_bar)


def test_the_reduced_equation_stands_beside() -> None:
    results = simulation_results(ct.parse_mechanism(FOUR_BAR), 21, duration=1)
    assert results.second is not None
    apart = np.abs(results.second["drive_value"] - results.simulation["drive_value"].values).max()
    assert 0.0 < float(apart) < 1e-6
    free = simulation_results(ct.parse_mechanism(FIVE_BAR), 5, duration=0.1)
    assert free.second is None


def test_a_report_of_what_only_its_simulation_moves() -> None:
    made = ct.report(ct.parse_mechanism(DOUBLE_PENDULUM), name="pendulum")
    assert [chapter.name for chapter in made.chapters if not chapter.missing] == [
        chapter.name for chapter in made.chapters
    ]
    assert "simulation" in [chapter.name for chapter in made.chapters]
    assert "plots" not in [chapter.name for chapter in made.chapters]
    named = ct.report(ct.parse_mechanism(DOUBLE_PENDULUM), ct.ReportOptions(chapters=("structure",)))
    # a chapter that somebody asks for says why it is not there
    assert named.chapters[0].missing
