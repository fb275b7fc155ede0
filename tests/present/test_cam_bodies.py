"""Figures of a cam's profile and of the walking wheel show what was computed."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Circle

import centrode as ct
from cam_shapes import exchanged
from centrode.cams.results import cam_profile_results, walking_wheel_results
from centrode.cams.walking_wheel import WheelMover
from centrode.present.cams.walking_wheel import draw_wheel
from centrode.present.figure_files import save_figures


@pytest.fixture(scope="module")
def wheel() -> WheelMover:
    return ct.walking_wheel(exchanged())


def drawn(cam: ct.Cam, *, groove: bool = False) -> Figure:
    return ct.figures(cam_profile_results(cam, 5, groove=groove))["cam-body"]


def positions(turned: list[float]) -> Figure:
    return ct.figures(walking_wheel_results(exchanged(), 5, instants=turned))["walking-wheel"]


def entries(figure: Figure) -> list[str]:
    legend = figure.axes[0].get_legend()
    assert legend is not None
    return [text.get_text() for text in legend.get_texts()]


def test_the_profile_is_drawn_in_the_display_unit() -> None:
    figure = drawn(exchanged())
    axes = figure.axes[0]
    assert axes.get_xlabel() == "x, mm"
    assert "profile, return arc" in entries(figure) and "outer wall, working arc" not in entries(figure)
    assert "undercut" not in entries(figure)
    lines = [np.column_stack(line.get_data()) for line in axes.get_lines()]
    longest = max(lines, key=len)  # the return arc, path and profile alike
    distances = np.hypot(*longest.T)
    assert 40.0 < distances.min() < distances.max() < 75.0
    rollers = [patch for patch in axes.patches if isinstance(patch, Circle)]
    assert [round(one.get_radius(), 9) for one in rollers] == [15.0, 15.0]
    texts = [one.get_text() for one in axes.texts]
    assert sorted(texts) == ["45°", "−45°"]


def test_groove_and_undercut_are_named() -> None:
    groove = drawn(exchanged(), groove=True)
    assert {"outer wall, working arc", "outer wall, return arc"} <= set(entries(groove))
    mirrored = exchanged(more='[return]\nkind = "mirrored"\n')
    assert "undercut" in entries(drawn(mirrored))


def test_an_open_profile_is_drawn() -> None:
    cam = exchanged(('[mover]\nlegs = 4\npost = "120 mm"\n', ""))
    assert "profile, return arc" not in entries(drawn(cam))


def test_the_wheel_stands_on_the_ground(wheel: WheelMover) -> None:
    axes = Figure().subplots()
    for turned in (-0.7, 0.0, 0.5):
        artists = draw_wheel(axes, wheel, wheel.pose(turned), 1e3)
        lowest = min(
            float(np.min(line.get_ydata()))
            for line in axes.get_lines()
            if len(np.atleast_1d(line.get_xdata())) > 100
        )
        # shoes of 361 points: the lowest lies above the ground by less than the arc between two squared over 2 R
        assert -1e-9 < lowest < (0.75 / 180 * 187) ** 2 / 2 / 145
        rollers = [one for one in axes.patches if isinstance(one, Circle) and one.get_radius() == 15.0]
        assert len(rollers) == 4
        for one in artists:
            one.remove()
        assert not axes.get_lines()


def test_each_instant_has_its_panel(tmp_path: Path) -> None:
    figure = positions([-0.1, 0.0, 0.2, 0.3])
    shown = [axes for axes in figure.axes if axes.get_visible()]
    assert [axes.get_title() for axes in shown] == ["−5.73°", "0°", "11.46°", "17.19°"]
    assert shown[0].get_xlabel() == "x, mm"
    many = positions(np.linspace(0.0, math.tau, 30).tolist())
    assert len([axes for axes in many.axes if axes.get_visible()]) == 12
    paths = save_figures({"wheel": figure}, tmp_path)
    again = save_figures({"again": positions([-0.1, 0.0, 0.2, 0.3])}, tmp_path)
    assert [a.read_bytes() == b.read_bytes() for a, b in zip(paths, again, strict=True)] == [True, True]
