"""Figures of integrated motions: closed forms below, integrated curves dashed above, errors on logarithmic scales."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import centrode as ct
from centrode.equations.integration import integration_results
from centrode.render.figures.files import save_figures


@functools.cache
def drawn(name: str, steps: int = 40) -> tuple[ct.Mechanism, dict[str, Figure]]:
    mechanism = ct.example(name)
    return mechanism, ct.figures(integration_results(mechanism, steps=steps))


def texts(figure: Figure, number: int = 0) -> list[str]:
    legend = figure.axes[number].get_legend()
    assert legend is not None
    return [text.get_text() for text in legend.get_texts()]


def test_both_curves_of_every_link_are_there() -> None:
    mechanism, figures = drawn("slider-between-cranks")
    assert list(figures) == [
        "integrated-angles",
        "integrated-angular-velocities",
        "integrated-velocities",
        "integrated-slides",
        "integration-errors",
    ]
    figure = figures["integrated-angular-velocities"]
    assert figure.axes[0].get_xlabel() == "time $t$, s"
    assert texts(figure) == ["OA", "AC", "CB", "BD", "integrated"]
    lines = figure.axes[0].lines
    closed, dashed = lines[:4], lines[4:]
    motion, integration = ct.motion(mechanism, 361), ct.integrate(mechanism, steps=40)
    for number, link in enumerate(mechanism.link_names):
        assert np.array_equal(closed[number].get_ydata(), motion.angular_velocity.sel(link=link))
        assert np.array_equal(dashed[number].get_xdata(), integration.time)
        assert np.array_equal(dashed[number].get_ydata(), integration.angular_velocity.sel(link=link))
        assert dashed[number].get_linestyle() == "--"
    assert all(len(panel.lines) == 2 * 3 for panel in figures["integrated-velocities"].axes)


def test_what_is_integrated_ends_at_the_limit() -> None:
    _mechanism, figures = drawn("slider-between-cranks-locked")
    axes = figures["integrated-angles"].axes[0]
    assert texts(figures["integrated-angles"])[-2:] == ["limit", "integrated"]
    dashed = np.array([line.get_ydata() for line in axes.lines[-4:]])
    times = np.asarray(axes.lines[-1].get_xdata())
    assert np.array_equal(np.isfinite(dashed).all(axis=0), times < 1.79991241652444)


def test_errors_are_those_of_the_dataset() -> None:
    mechanism, figures = drawn("slider-between-cranks")
    upper, lower = figures["integration-errors"].axes
    assert (upper.get_yscale(), lower.get_yscale()) == ("log", "log")
    integration = ct.integrate(mechanism, steps=40)
    for number, name in enumerate(["y_C", "x_D", "y_D"]):
        expected = np.abs(integration.drift.sel(constraint=name).to_numpy())
        shown = np.asarray(upper.lines[number].get_ydata())
        assert np.array_equal(shown[1:], expected[1:])
        assert np.isnan(shown[0])  # nothing has drifted yet
    # OA is driven: there is no error to show
    assert texts(figures["integration-errors"], 1) == ["AC", "CB", "BD"]


@pytest.mark.parametrize(
    "name", ["two-link-arm", "rack-and-pinion", "parallelogram", "five-bar-two-drives", "wiper"]
)
def test_motions_of_other_kinds_are_drawn(name: str, tmp_path: Path) -> None:
    _mechanism, figures = drawn(name, 8)
    files = save_figures(figures, tmp_path)
    assert len(files) == 2 * len(figures)
    assert all(file.stat().st_size > 5000 for file in files)


def test_no_errors_are_not_drawn() -> None:
    assert "integration-errors" not in drawn("two-link-arm", 8)[1]


def test_angles_are_in_the_units_asked_for() -> None:
    mechanism, figures = drawn("excavator-arm", 10)
    label = figures["integration-errors"].axes[1].get_ylabel()
    assert label.endswith(", °")
    integration = ct.integrate(mechanism, steps=10)
    expected = np.degrees(np.abs(integration.angle_difference.sel(link="bucket").to_numpy()))
    found = [np.asarray(line.get_ydata()) for line in figures["integration-errors"].axes[1].lines]
    assert any(np.allclose(one[1:], expected[1:], rtol=1e-12) for one in found)
