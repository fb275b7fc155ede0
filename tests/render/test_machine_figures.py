"""Figures of a machine show its steady motion; Wittenbauer's tangents touch and cut off what they say."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

import centrode as ct
from centrode.dynamics.steady_motion.machine import machine_results
from centrode.quantities import QUANTITIES
from machines import engine

SAMPLES = 721


@pytest.fixture(scope="module")
def press() -> tuple[Any, dict[str, Figure]]:
    mechanism = ct.example("six-bar-press")
    results = machine_results(mechanism, SAMPLES)
    return results.steady, ct.figures(results)


def texts(figure: Figure) -> list[str]:
    legend = figure.axes[0].get_legend()
    assert legend is not None
    return [text.get_text() for text in legend.get_texts()]


def test_every_curve_is_the_datasets(press: tuple[Any, dict[str, Figure]]) -> None:
    data, figures = press
    shown = {
        ("works", 0): [("work_of_drive", 1.0), ("work_of_loads", 1.0), ("work", 1.0)],
        ("energies", 0): [("work", 1.0), ("energy_of_links", 1.0), ("energy_change", 1.0)],
        ("drive-speed", 0): [("drive_speed", 180 / np.pi), ("drive_speed_first_order", 180 / np.pi)],
        ("drive-speed", 1): [("drive_acceleration", 180 / np.pi), ("drive_acceleration_first_order", 180 / np.pi)],
        ("moments", 0): [("moment_of_loads", 1.0), ("driving_moment", 1.0)],
        ("moments", 1): [("inertia_of_links", 1.0)],
        ("moments", 2): [("inertia_slope_of_links", 1.0)],
    }  # fmt: skip
    for (name, panel), variables in shown.items():
        lines = {line.get_label(): line for line in figures[name].axes[panel].get_lines()}
        for variable, factor in variables:
            line = lines[QUANTITIES[variable].title]
            np.testing.assert_allclose(line.get_ydata(), factor * data[variable], rtol=1e-15)
            np.testing.assert_allclose(line.get_xdata(), np.degrees(data["turned"]), rtol=1e-15)
    (total,) = (line for line in figures["moments"].axes[0].get_lines() if line.get_label() == "sum")
    np.testing.assert_allclose(
        total.get_ydata(), data["moment_of_loads"] + data["driving_moment"], rtol=1e-15
    )
    assert figures["drive-speed"].axes[1].get_xlabel() == r"angle turned in the cycle $\varphi$, °"


def test_wittenbauers_tangents(press: tuple[Any, dict[str, Figure]]) -> None:
    data, figures = press
    axes = figures["wittenbauer"].axes[0]
    curve, lower, low_touch, upper, high_touch, segment = axes.get_lines()
    inertia, work = np.asarray(curve.get_xdata()), np.asarray(curve.get_ydata())
    np.testing.assert_allclose(work, data["work"], rtol=0.0, atol=1e-12 * np.ptp(work))
    slack = 1e-9 * np.ptp(work)
    for line, sign in ((lower, 1.0), (upper, -1.0)):
        (x0, x1), (y0, y1) = line.get_xdata(), line.get_ydata()
        above = sign * (work - (y0 + (y1 - y0) * (inertia - x0) / (x1 - x0)))
        assert above.min() >= -slack
        # the nearest sample is half a step away at most: the diagram is a parabola there
        assert above.min() <= np.ptp(work) * (2 * np.pi / SAMPLES) ** 2
    for touch, line in ((low_touch, lower), (high_touch, upper)):
        (x0, x1), (y0, y1) = line.get_xdata(), line.get_ydata()
        x, y = touch.get_xdata()[0], touch.get_ydata()[0]
        assert abs(y - (y0 + (y1 - y0) * (x - x0) / (x1 - x0))) <= slack
        assert (
            np.hypot((inertia - x) / np.ptp(inertia), (work - y) / np.ptp(work)).min() <= 2 * np.pi / SAMPLES
        )
    low, high = segment.get_ydata()
    assert (low, high) == tuple(data.attrs["tangent_intercepts"])
    assert f"it is J = {data.attrs['inertia']:.6g} kg·m²" in texts(figures["wittenbauer"])[-1]


def test_names_and_what_is_left_out() -> None:
    mechanism = engine("[[machine.shafts]]\ninertia = 30")
    figures = ct.figures(machine_results(mechanism, 9))
    assert "wittenbauer" not in figures
    assert {"works", "energies", "moments", "drive-speed", "real-velocities", "real-accelerations"} <= set(
        figures
    )
    assert figures["works"].axes[0].get_xlabel() == r"angle turned in the cycle $\varphi$, rad"
