"""The mathematical font of pages: it lays out mathematics, and has every letter that formulas use."""

from __future__ import annotations

import gc
import io
import unicodedata
from pathlib import Path
from xml.etree import ElementTree as Xml

import pytest
from fontTools.ttLib import TTFont

import centrode as ct
from centrode.locale import speaking
from centrode.render.document.typst import TypstSpelling
from centrode.report.html.fonts import FONT, cut_font, font_letters
from centrode.report.html.mathematics import formulas_of
from centrode.report.html.parts import HERE
from equation_pages import Relation, entries

EXAMPLES = ["six-bar-press", "spherical-crank-rocker", "third-class-triad"]


@pytest.fixture(scope="module")
def font() -> TTFont:
    return TTFont(FONT)


def test_it_is_a_mathematical_font(font: TTFont) -> None:
    assert font["MATH"].table.MathConstants is not None
    grows = font["MATH"].table.MathVariants.VertGlyphCoverage.glyphs
    assert {font.getBestCmap()[ord(sign)] for sign in "()[]|√"} <= set(grows)


def test_the_font_is_closed(recwarn: pytest.WarningsRecorder) -> None:
    """It is read lazily; a file left open is complained of by whatever test collects it."""
    cut_font.cache_clear()
    cut_font(frozenset("ab"))
    gc.collect()
    assert [one for one in recwarn if issubclass(one.category, ResourceWarning)] == []


def test_a_page_holds_its_own_letters_and_no_others(font: TTFont) -> None:
    """Advances, outlines and constants are those of the whole font; what a page lacks is not there."""
    letters = font_letters(frozenset("𝜑√"), ["Aa"], "90° слово")
    own = TTFont(io.BytesIO(cut_font(letters)))
    assert {chr(code) for code in own.getBestCmap()} == set(" 𝜑√Aa90°")
    for letter in "𝜑√°a":
        here, there = (one["hmtx"][one.getBestCmap()[ord(letter)]] for one in (own, font))
        assert here == there
    constants = (vars(one["MATH"].table.MathConstants)["AxisHeight"].Value for one in (own, font))
    assert len(set(constants)) == 1
    assert len(cut_font(letters)) < 0.2 * FONT.stat().st_size


def test_its_licence_stands_beside_it(font: TTFont) -> None:
    licence = (Path(HERE) / "OFL.txt").read_text(encoding="utf-8")
    assert "SIL OPEN FONT LICENSE" in licence
    assert font["name"].getDebugName(0) in licence


@pytest.mark.parametrize("language", ["en", "ru", "uk"])
def test_it_has_every_letter_of_names_and_words(font: TTFont, language: str) -> None:
    alphabets = {
        "en": "abcdefghijklmnopqrstuvwxyz",
        "ru": "абвгдеёжзийклмнопрстуфхцчшщъыьэюя",
        "uk": "ґєіїщ’",
    }
    known = font.getBestCmap()
    missing = {one for one in alphabets[language] + alphabets[language].upper() if ord(one) not in known}
    assert not missing


@pytest.mark.parametrize("name", EXAMPLES)
@pytest.mark.parametrize("language", ["en", "uk"])
def test_it_has_every_letter_of_formulas(font: TTFont, name: str, language: str) -> None:
    known = font.getBestCmap()
    with speaking(language):
        page = entries(ct.equations(ct.example(name), ()), TypstSpelling())
        spelled = [part for one in page if isinstance(one, Relation) for part in one.parts]
        formulas = formulas_of(spelled)
    text = "".join("".join(Xml.fromstring(formulas.display_formula(one)).itertext()) for one in spelled)
    missing = {
        one for one in text if ord(one) not in known and not unicodedata.category(one).startswith(("Z", "C"))
    }
    assert len(text) > 50
    assert not missing
