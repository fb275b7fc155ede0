"""Titles in any language are drawn; letters that are kept are those of matplotlib."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextToPath

import centrode as ct
from centrode.model.examples import example_text
from centrode.render.drawing.style import house_style
from centrode.render.figures.document_canvas import kept_texts
from centrode.render.figures.files import save_figures
from shown_motion import motion_figures


def test_letters_that_the_font_lacks_are_drawn_without_a_warning(tmp_path: Path) -> None:
    """Warnings are errors here, so one would fail."""
    text = example_text("crank-rocker").replace('title = "', 'title = "四杆机构 ')
    mechanism = ct.parse_mechanism(text)
    assert mechanism.title.startswith("四杆机构")
    figures = motion_figures(mechanism, ct.motion(mechanism, samples=5))
    names = [path.name for path in save_figures({"mechanism": figures["mechanism"]}, tmp_path)]
    assert names == ["mechanism.png", "mechanism.svg"]


@pytest.mark.parametrize("text", ["360", "−1.5", "drive AB, °", "", "漢"])
def test_kept_letters_are_those_of_matplotlib(text: str) -> None:
    """With letters that a figure has already, and without; twice, as the second answer is the kept one."""
    mine, theirs = kept_texts(), TextToPath()
    font = theirs._get_font(FontProperties(family="DejaVu Sans"))
    for _time in range(2):
        with house_style():
            places, outlines, rectangles = mine.get_glyphs_with_font(font, text)
            expected = theirs.get_glyphs_with_font(font, text)
        assert (places, list(outlines), rectangles) == (expected[0], list(expected[1]), expected[2])
        for name, (corners, codes) in expected[1].items():
            np.testing.assert_array_equal(outlines[name][0], corners)
            np.testing.assert_array_equal(outlines[name][1], codes)
        known = dict(list(outlines.items())[:1])
        new = mine.get_glyphs_with_font(font, text, known, True)[1]
        assert list(new) == list(outlines)[1:]
        assert set(mine.get_glyphs_with_font(font, text, known)[1]) == set(outlines)
