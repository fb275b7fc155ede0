"""Kinematic schemes: two side by side to one scale, what is changed set off; the key stands on the paper."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

import centrode as ct
from centrode.analysis.redesign.results import rotatability_results
from centrode.locale import speaking
from centrode.model.settings import Display
from centrode.render.drawing.style import house_style
from centrode.render.figures.pictures import figure_of
from centrode.render.figures.schemes import CHANGED, scheme_figure
from centrode.sheets.linkages import SchemePair
from centrode.sheets.sheet import Illustration
from centrode.views.rotatability import sheet
from centrode.views.schemes import scheme_picture
from mechanisms import four_bar
from printed import faults

DISPLAY = {"length": "mm", "angle": "deg"}


def spherical() -> ct.Mechanism:
    mechanism = ct.example("spherical-four-bar")
    for path, value in (("links.AB.length", 50), ("drives.AB.start", 45), ("links.DC.angle", 50)):
        mechanism = ct.with_value(mechanism, path, f"{value} deg")
    return mechanism


LOCKED = {
    "four-bar": lambda: four_bar(
        0.06, 0.07, 0.05, 0.09, drives=[{"link": "OA", "start": 1.0, "speed": 1}], display=DISPLAY
    ),
    "slider-crank": lambda: ct.slider_crank("60 mm", "80 mm", "30 mm"),
    "two dyads": lambda: ct.example("slider-between-cranks-locked"),
    "sphere": spherical,
}


@functools.cache
def drawn(name: str) -> Figure:
    mechanism = LOCKED[name]()
    chapter = sheet(rotatability_results(mechanism, complete=True)).chapters["rotatability"]
    (pair,) = (
        block.picture
        for section in chapter.sections
        for block in section.blocks
        if isinstance(block, Illustration) and isinstance(block.picture, SchemePair)
    )
    return figure_of(pair, mechanism.display)


def scale(axes: Axes) -> np.ndarray:
    """Units to an inch, across and up."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    sides = axes.get_position().size * figure.get_size_inches()
    return np.array([np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim())]) / sides


@pytest.mark.parametrize("name", LOCKED)
def test_both_schemes_have_one_scale_and_can_be_read_in_print(name: str) -> None:
    figure = drawn(name)
    assert faults(figure) == []
    locked, repaired = figure.axes
    np.testing.assert_allclose(scale(locked), scale(repaired)[::-1], rtol=1e-9)
    assert locked.get_ylim() == repaired.get_ylim()
    assert [text.get_text() for text in figure.texts] == ["a)", "b)"]


def coloured(axes: Axes) -> set[str]:
    return {text.get_text() for text in axes.texts if to_hex(text.get_color()).upper() == CHANGED}


def test_what_is_changed_is_set_off_in_the_repaired_mechanism_alone() -> None:
    for name, value in (("four-bar", "28.2"), ("sphere", "41°")):
        locked, repaired = drawn(name).axes
        assert coloured(locked) == set() and coloured(repaired) == {value}


@pytest.mark.parametrize("space", ["plane", "sphere"])
@pytest.mark.parametrize("name", ["BC", "connecting rod", "ведуча вилка"])
def test_names_of_links_stand_on_the_paper(name: str, space: str) -> None:
    sphere = space == "sphere"
    points = {"A": [1, 0, 0], "D": [0, 1, 0]} if sphere else {"A": [0, 0], "D": [4, 0]}
    lengths = ("20 deg", "70 deg", "80 deg") if sphere else (1, 3.5, 3)
    ends = (("A", "B"), ("B", "C"), ("D", "C"))
    links: dict[str, dict[str, object]] = {
        link: {"points": list(points), "length": length}
        for link, points, length in zip(("AB", name, "DC"), ends, lengths, strict=True)
    }
    if sphere:
        links["AB"]["reference"], links["DC"]["reference"] = ["A", "D"], ["D", "A"]
    mechanism = ct.Mechanism(
        space=space,
        frame={"points": points},
        links=links,
        drives=[{"link": "AB", "start": 0.0, "speed": 1}],
        assembly={"sides": {"C": "left"}},
    )
    picture = scheme_picture(mechanism, ct.motion(mechanism, samples=37))
    with speaking("uk"), house_style():
        figure = scheme_figure(picture, Display())
        canvas: Any = FigureCanvasAgg(figure)
        canvas.draw()  # places the legend
        (axes,) = figure.axes
        legend = axes.get_legend()
        assert legend is not None
        rightmost = max(text.get_window_extent().x1 for text in legend.get_texts())
    assert rightmost < figure.bbox.x1
