"""Figures for the width of a narrow screen: nothing is wider, nothing is cut, and bars tell the scales of drawings."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch
from matplotlib.text import Text

import centrode as ct
from boxes import boxes, outside, overlapping
from centrode.dynamics.balancing.results import shaking_results
from centrode.dynamics.force_polygons.results import force_polygon_results
from centrode.render.drawing.figure_room import screen_of_width
from centrode.render.figures.document_canvas import MeasuringCanvas
from centrode.render.pages.force_signs import force_name

PHONE = 278 / 72
"""Inches of letters as they are on paper, in the panel of a phone: 320 pixels."""
HAIR = 0.01
"""Inches that antialiasing takes beside a letter."""
AT = [math.radians(120)]
LETTERS_OF_BAR = re.compile(r"([\d.]+)\D*?(N|m)$")
RESULTS: dict[str, Callable[[ct.Mechanism], Any]] = {
    "centres": lambda press: ct.instant_centres(ct.motion(press, at=AT)),
    "balance": lambda press: shaking_results(press, 25),
    "polygons": lambda press: force_polygon_results(press, AT),
}


@pytest.fixture(scope="module")
def narrow() -> Iterator[Callable[[str], dict[str, Figure]]]:
    """Figures of a result of the press, drawn for a phone."""
    press = ct.example("six-bar-press")
    drawn: dict[str, dict[str, Figure]] = {}

    def figures(name: str) -> dict[str, Figure]:
        if name not in drawn:
            with screen_of_width(PHONE):
                drawn[name] = ct.figures(RESULTS[name](press))
        return drawn[name]

    return figures


@pytest.mark.parametrize("name", ["centres", "balance"])
def test_a_figure_is_as_wide_as_the_screen_has_room_and_cuts_no_text(narrow, name: str) -> None:
    for title, figure in narrow(name).items():
        assert figure.get_figwidth() == pytest.approx(PHONE), title
        figure.suptitle("").set_in_layout(False)  # it stands beside the figure
        canvas: Any = MeasuringCanvas(figure)
        canvas.draw()
        drawn = figure.get_tightbbox(canvas.get_renderer())
        assert (drawn.min >= -HAIR).all(), title
        assert (drawn.max <= figure.get_size_inches() + HAIR).all(), title


def test_without_a_screen_figures_are_those_of_a_page() -> None:
    (figure,) = ct.figures(ct.instant_centres(ct.motion(ct.example("six-bar-press"), at=AT))).values()
    with screen_of_width(20.0):
        (wide,) = ct.figures(ct.instant_centres(ct.motion(ct.example("six-bar-press"), at=AT))).values()
    assert figure.get_size_inches() == pytest.approx(wide.get_size_inches())
    assert figure.get_figwidth() > PHONE


def test_a_group_stands_above_its_polygon(narrow) -> None:
    """Nothing is wider than the screen, no name covers another, and each force is as long as its bar says."""
    found = force_polygon_results(ct.example("six-bar-press"), AT).polygons[0]
    assert found is not None
    for number, group in enumerate(found.groups, start=1):
        figure = narrow("polygons")[f"group-{number}"]
        measured = boxes(figure)
        assert figure.get_figwidth() == pytest.approx(PHONE)
        assert overlapping(measured) == []
        assert outside(figure, measured) == []
        newtons = newtons_of_a_millimetre(figure)
        drawn = arrows(figure)
        texts = {text.get_text() for text in figure.findobj(Text)}
        for vector in group.polygon.vectors:
            if vector.name[-1] in "ⁿᵗ" or abs(vector.force) < newtons:
                continue
            assert min(abs(one - vector.force / newtons) for one in drawn) <= 1e-9
            assert force_name(vector.name) in texts


def newtons_of_a_millimetre(figure: Figure) -> float:
    """What the bar of forces says: its length on the page, and the number that stands beside it."""
    for text in figure.findobj(Text):
        found = LETTERS_OF_BAR.fullmatch(text.get_text())
        if found is not None and found[2] == "N":
            x = text.get_position()[0]
            ends = [
                (line.get_xdata().min(), line.get_xdata().max())
                for line in text.axes.lines
                if len(line.get_xdata()) == 4
            ]
            start, end = max((one for one in ends if one[1] < x), key=lambda one: one[1])
            return float(found[1]) / (end - start)
    raise AssertionError("no bar of forces")


def arrows(figure: Figure) -> list[complex]:
    """Arrows of the page [mm]."""
    patches = [patch for axes in figure.axes for patch in axes.patches if isinstance(patch, FancyArrowPatch)]
    ends = [np.array(patch._posA_posB) for patch in patches if patch._posA_posB is not None]
    return [complex(*(end - start)) for start, end in ends]
