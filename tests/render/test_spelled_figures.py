"""Figures as commands save them: decimals as the language has them, no English but names, and what users wrote."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

import centrode as ct
from blank_canvas import blank_pictures
from centrode.analysis.instant_centres.results import CentreResults, centre_results
from centrode.animation.layers import turned_caption
from centrode.dynamics.bearings.results import ReactionResults, reaction_results
from centrode.dynamics.reduction_results import ReductionResults, reduction_results
from centrode.equations.integration import integration_results
from centrode.locale import speaking
from centrode.render.figures.files import save_figures, spell_decimals, with_decimal_mark

INTERNATIONAL = {"max", "min"}
LATIN_UNIT = re.compile(r"(?:\d |, )(?:mm|m|rad|deg|s|kg|N|J|W|M?Pa)(?![\w′])")
Computed = Callable[[ct.Mechanism], Any]


@functools.cache
def results_of(name: str, computed: Computed) -> Any:
    """What is drawn: numbers are the same in every language."""
    return computed(ct.example(name))


def saved(figures: Mapping[str, Figure], folder: Path) -> Mapping[str, Figure]:
    """Figures spelled as files have them; the files themselves are blank, for `texts` draws each figure."""
    with blank_pictures():
        save_figures(figures, folder)
    return figures


def texts(figure: Figure) -> Iterator[str]:
    """All that stands in a figure after it was drawn, formulas left out; where it stands is not looked at."""
    figure.set_layout_engine("none")
    figure.draw_without_rendering()
    for text in figure.findobj(Text):
        assert isinstance(text, Text)
        if text.get_visible():
            yield re.sub(r"\$[^$]*\$", "", text.get_text())


def reactions(mechanism: ct.Mechanism) -> ReactionResults:
    return reaction_results(mechanism, 37)


def reduction(mechanism: ct.Mechanism) -> ReductionResults:
    return reduction_results(mechanism, 37)


def integration(mechanism: ct.Mechanism) -> Any:
    return integration_results(mechanism, steps=40)


def centres(mechanism: ct.Mechanism) -> CentreResults:
    return centre_results(mechanism, instants=[0.2])


@pytest.mark.parametrize("language", ["ru", "uk"])
@pytest.mark.parametrize(
    ("name", "computed"),
    [
        ("six-bar-press", reactions),
        ("six-bar-press", reduction),
        ("planetary-gear-train", integration),
        ("rolling-wheel-rod", integration),
        ("slider-between-cranks", centres),
    ],
)
def test_no_english_words_and_points(language: str, name: str, computed: Computed, tmp_path: Path) -> None:
    mechanism = ct.example(name)
    names = [*mechanism.link_names, *mechanism.points, *(guide.id for guide in mechanism.guides)]
    names += [*(gear.id for gear in mechanism.gears), *(wheel.id for wheel in mechanism.rolling)]
    known = INTERNATIONAL | {word for one in names for word in re.findall("[A-Za-z]{3,}", one)}
    with speaking(language):
        figures = saved(ct.figures(results_of(name, computed)), tmp_path)
        found = [text for figure in figures.values() for text in texts(figure)]
    for text in found:
        assert not re.search(r"\d\.\d", text), text
        assert set(re.findall("[A-Za-z]{3,}", text)) <= known, text
        assert not LATIN_UNIT.search(text), text


def test_titles_of_users_keep_their_points(tmp_path: Path) -> None:
    mechanism = ct.parse_mechanism(
        ct.mechanism_text(ct.example("six-bar-press")).replace('"Six-bar press"', '"Press 2.5"')
    )
    assert mechanism.title == "Press 2.5"
    with speaking("ru"):
        results = replace(results_of("six-bar-press", reactions), mechanism=mechanism)
        figures = saved(ct.figures(results), tmp_path)
        assert any(re.search(r"\d,\d %", text) for text in texts(figures["bearing-wear"]))
        for figure in figures.values():  # titles are there before a figure is drawn
            assert any(text.get_text().split("\n")[-1] == "Press 2.5" for text in figure.findobj(Text))


def test_numbers_of_pictures_are_spelled_once() -> None:
    with speaking("uk"):
        figure = ct.figures(results_of("six-bar-press", reduction))["reduced-moment"]
        spell_decimals(figure)
        once = list(texts(figure))
        spell_decimals(figure)
        assert list(texts(figure)) == once
        assert with_decimal_mark("1.5, B2.1, $r_{1.5}$, 2.0.1") == "1,5, B2.1, $r_{1.5}$, 2.0.1"


@pytest.mark.parametrize(("language", "said"), [("en", "φ = 28.6°"), ("ru", "φ = 28,6°")])
def test_captions_of_animations(language: str, said: str) -> None:
    with speaking(language):
        assert turned_caption(0.5, ct.example("six-bar-press").display) == said
