"""Titles in any language are drawn."""

from __future__ import annotations

from pathlib import Path

import centrode as ct
from centrode.model.examples import example_text
from centrode.present import save_figures
from shown_motion import motion_figures


def test_letters_that_the_font_lacks_are_drawn_without_a_warning(tmp_path: Path) -> None:
    """Warnings are errors here, so one would fail."""
    text = example_text("crank-rocker").replace('title = "', 'title = "四杆机构 ')
    mechanism = ct.parse_mechanism(text)
    assert mechanism.title.startswith("四杆机构")
    figures = motion_figures(mechanism, ct.motion(mechanism, samples=5))
    names = [path.name for path in save_figures({"mechanism": figures["mechanism"]}, tmp_path)]
    assert names == ["mechanism.png", "mechanism.svg"]
