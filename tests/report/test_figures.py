"""Figures of reports: how high they are, the decimal mark of their numbers, what they say of letters."""

from __future__ import annotations

import logging
import re
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from centrode.locale import speaking
from centrode.render.document.figures import FLAT, describe_curves, picture
from centrode.render.drawing.style import Decimals, house_style
from centrode.render.figures.files import spell_decimals
from centrode.report.spoken_formulas import spoken_text

TITLE = "Press 2.5"


def curves(rows: int, label: str = "v, m/s") -> Figure:
    figure = Figure(figsize=(7.6, 1.2 + 2.3 * rows), layout="constrained")
    for axes in figure.subplots(rows, 1, squeeze=False)[:, 0]:
        axes.plot(np.linspace(0.0, 1.0, 5), np.linspace(0.0, 0.04, 5))
        axes.yaxis.set_major_formatter(Decimals())
        axes.set_ylabel(label)
    figure.axes[0].set_title("φ = 26.1 deg, B2.1, $r_{1.5}$")
    figure.suptitle(TITLE)
    return figure


def ticks(figure: Figure) -> list[str]:
    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    axes = figure.axes[0]
    return [label.get_text() for label in (*axes.get_xticklabels(), *axes.get_yticklabels())]


@pytest.mark.parametrize(("language", "mark"), [("en", "."), ("ru", ","), ("uk", ",")])
def test_numbers_have_the_mark_of_the_language(language: str, mark: str) -> None:
    figure = curves(1)
    with speaking(language):
        spell_decimals(figure)
        labels = [label for label in ticks(figure) if label]
    assert any(mark in label for label in labels)
    assert all(re.fullmatch(rf"−?\d+({re.escape(mark)}\d+)?", label) for label in labels)
    assert figure.axes[0].get_title() == f"φ = 26{mark}1 deg, B2.1, $r_{{1.5}}$"
    assert figure.get_suptitle() == TITLE  # what a user wrote


@pytest.mark.parametrize("rows", [1, 2, 3, 4])
@pytest.mark.parametrize("label", ["v, m/s", "moment that the drive gives for the inertia of all links, N m"])
def test_curves_leave_room_for_others_and_their_labels_are_apart(rows: int, label: str) -> None:
    figure = curves(rows, label)
    picture(figure, "")
    width, height = figure.get_size_inches()
    assert height <= FLAT[rows] * width * (1.0 + np.finfo(float).eps)
    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    boxes = [axes.yaxis.label.get_window_extent(canvas.get_renderer()) for axes in figure.axes]
    for upper, lower in pairwise(boxes):
        assert lower.y1 <= upper.y0
    assert boxes[0].y1 <= figure.bbox.height
    assert boxes[-1].y0 >= 0.0


def test_drawings_and_many_panels_keep_their_size() -> None:
    drawing = curves(1)
    drawing.set_figheight(7.0)
    drawing.axes[0].set_aspect("equal")
    many = curves(5)
    for figure in (drawing, many):
        before = tuple(figure.get_size_inches())
        picture(figure, "")
        assert tuple(figure.get_size_inches()) == before


def test_letters_without_a_font_are_not_talked_about(
    caplog: pytest.LogCaptureFixture, recwarn: pytest.WarningsRecorder
) -> None:
    figure = Figure(figsize=(4, 3), layout="constrained")
    with house_style():
        figure.subplots().set_ylabel("$v_{🤖}$, 🤖")
    with caplog.at_level(logging.WARNING):
        picture(figure, "")
    assert not caplog.records
    assert not [one for one in recwarn if "Glyph" in str(one.message)]


def test_curves_are_described_by_their_axes_ranges_and_names() -> None:
    figure = Figure(figsize=(6, 4), layout="constrained")
    upper, lower = figure.subplots(2, 1)
    upper.plot([0.0, 1.0], [-0.25, 2.5], label="AB")
    upper.plot([0.0, 1.0], [np.nan, 0.0], label="$x$ C")
    upper.set_ylabel(r"$\varphi''$, °")
    upper.legend()
    lower.plot([0.0, 1.0], [1e-17, 3.0])
    lower.set_ylabel("${v}_{BA}$, m/s")
    lower.set_xlabel(r"angle $\frac{\omega}{2}$ \#")
    described = describe_curves(figure)
    assert described == (
        r"Horizontal axis: angle ω2 \\#. "
        r"""Vertical axis: $phi''$, ° from −0.25 to 2.5; $v_("BA")$, m/s from 0 to 3. Curves: AB, $x$ C."""
    )
    assert spoken_text(described).startswith(r"Horizontal axis: angle ω2 \#. Vertical axis: φ prime prime, °")
    upper.set_aspect("equal")
    lower.set_aspect("equal")
    assert describe_curves(figure) == ""  # a drawing


def test_labels_of_panels_keep_out_of_each_other() -> None:
    """A word of sixteen letters is taller than a panel that is drawn as low as three on a page are."""
    with house_style():
        figure = curves(3, "коэффициентность удельного давления")
        figure.axes[-1].set_xlabel("вдоль линии зацепления")
    picture(figure, "Sliding")
    figure.draw_without_rendering()
    boxes = [axes.yaxis.label.get_window_extent() for axes in figure.axes]
    assert all(not one.overlaps(other) for one, other in pairwise(boxes))
