"""Figures as commands save them: decimals as the language has them, no English but names, and what users wrote."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

import centrode as ct
from centrode.analysis.instant_centres.results import centre_results
from centrode.dynamics.bearings.results import reaction_results
from centrode.dynamics.reduction_results import reduction_results
from centrode.equations.integration import integration_results
from centrode.locale import speaking
from centrode.present.animations.layers import turned_caption
from centrode.present.figure_files import save_figures
from centrode.present.spelled_figures import spell_decimals, with_decimal_mark

UNITS = {"deg", "rad", "kg", "mm", "MPa", "max", "min"}
Drawn = Callable[[ct.Mechanism], Mapping[str, Figure]]


def texts(figure: Figure) -> Iterator[str]:
    """All that stands in a figure after it was drawn, formulas left out."""
    figure.draw_without_rendering()
    for text in figure.findobj(Text):
        assert isinstance(text, Text)
        if text.get_visible():
            yield re.sub(r"\$[^$]*\$", "", text.get_text())


def reactions(mechanism: ct.Mechanism) -> Mapping[str, Figure]:
    return ct.figures(reaction_results(mechanism, 37))


def reduction(mechanism: ct.Mechanism) -> Mapping[str, Figure]:
    return ct.figures(reduction_results(mechanism, 37))


def integration(mechanism: ct.Mechanism) -> Mapping[str, Figure]:
    return ct.figures(integration_results(mechanism, steps=40))


def centres(mechanism: ct.Mechanism) -> Mapping[str, Figure]:
    return ct.figures(centre_results(mechanism, instants=[0.2]))


@pytest.mark.parametrize("language", ["ru", "uk"])
@pytest.mark.parametrize(
    ("name", "drawn"),
    [
        ("six-bar-press", reactions),
        ("six-bar-press", reduction),
        ("planetary-gear-train", integration),
        ("rolling-wheel-rod", integration),
        ("slider-between-cranks", centres),
    ],
)
def test_no_english_words_and_points(language: str, name: str, drawn: Drawn, tmp_path: Path) -> None:
    mechanism = ct.example(name)
    names = [*mechanism.link_names, *mechanism.points, *(guide.id for guide in mechanism.guides)]
    names += [*(gear.id for gear in mechanism.gears), *(wheel.id for wheel in mechanism.rolling)]
    known = UNITS | {word for one in names for word in re.findall("[A-Za-z]{3,}", one)}
    with speaking(language):
        figures = drawn(mechanism)
        save_figures(figures, tmp_path)
        found = [text for figure in figures.values() for text in texts(figure)]
    for text in found:
        assert not re.search(r"\d\.\d", text), text
        assert set(re.findall("[A-Za-z]{3,}", text)) <= known, text


def test_titles_of_users_keep_their_points(tmp_path: Path) -> None:
    mechanism = ct.parse_mechanism(
        ct.mechanism_text(ct.example("six-bar-press")).replace('"Six-bar press"', '"Press 2.5"')
    )
    assert mechanism.title == "Press 2.5"
    with speaking("ru"):
        figures = dict(reactions(mechanism))
        save_figures(figures, tmp_path)
        assert any(re.search(r"\d,\d %", text) for text in texts(figures["bearing-wear"]))
        for figure in figures.values():
            assert any(text.split("\n")[-1] == "Press 2.5" for text in texts(figure))


def test_numbers_of_pictures_are_spelled_once() -> None:
    mechanism = ct.example("six-bar-press")
    with speaking("uk"):
        figure = reduction(mechanism)["reduced-moment"]
        spell_decimals(figure)
        once = list(texts(figure))
        spell_decimals(figure)
        assert list(texts(figure)) == once
        assert with_decimal_mark("1.5, B2.1, $r_{1.5}$, 2.0.1") == "1,5, B2.1, $r_{1.5}$, 2.0.1"


@pytest.mark.parametrize(("language", "said"), [("en", "φ = 28.6 deg"), ("ru", "φ = 28,6 deg")])
def test_captions_of_animations(language: str, said: str) -> None:
    with speaking(language):
        assert turned_caption(0.5, ct.example("six-bar-press").display) == said
