"""Formulas as MathML: they have the letters that other spellings of the same formulas have."""

from __future__ import annotations

import io
import re
import unicodedata
from collections import Counter
from xml.etree import ElementTree as Xml

import pytest
from fontTools.ttLib import TTFont

import centrode as ct
from centrode.equations.spelling import FormulaSpelling
from centrode.render.document.typst import TypstSpelling
from centrode.report.html.fonts import cut_font, font_letters
from centrode.report.html.mathematics import formulas_of
from centrode.report.mathematics import fragments_of
from equation_pages import Relation, entries

EXAMPLES = ["slider-between-cranks", "slider-between-cranks-locked", "six-bar-press", "third-class-triad"]
WORDS = re.compile(r"[^\W_]")


def letters(text: str) -> str:
    """What is read of a formula: letters and digits, upright, without what parts them."""
    plain = unicodedata.normalize("NFKD", text).replace("\u03d5", "φ").replace("ϵ", "ε").replace("ϱ", "ρ")
    return "".join(WORDS.findall(plain))


def read(element: str) -> str:
    return letters("".join(Xml.fromstring(element).itertext()))


def text_of(element: str) -> str:
    return text_of_element(Xml.fromstring(element))


def text_of_element(element: Xml.Element) -> str:
    return "".join(element.itertext())


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_letters_are_those_of_the_text(name: str) -> None:
    found = ct.equations(ct.example(name), ())
    typeset = entries(found, TypstSpelling())
    plain = entries(found, FormulaSpelling())
    compared = 0
    for entry, same in zip(typeset, plain, strict=True):
        parts, texts = (
            one.parts if isinstance(one, Relation) else [x for row in one.matrix for x in row]
            for one in (entry, same)
        )
        pairs = list(zip(parts, texts, strict=True))
        formulas = formulas_of(piece for part, _text in pairs for piece in fragments_of(part))
        for part, text in pairs:
            compared += 1
            read_there = Counter("".join(read(piece) for piece in formulas.pieces(part)))
            # where text has (...)/b, paper may have 1/b in front
            ones = Counter("1" * (part.count("frac(1, ") - text.count("1/")))
            assert read_there == Counter(letters(text)) + ones, (part, text)
    assert compared > 10


def test_a_fraction_a_root_an_index() -> None:
    element = formulas_of(["frac(a, sqrt(b)) + x_(1)^(2)"]).display_formula("frac(a, sqrt(b)) + x_(1)^(2)")
    formula = Xml.fromstring(element)
    fraction, plus, power = formula
    assert formula.get("displaystyle") == "true"
    assert [part.tag for part in (fraction, plus, power)] == ["mfrac", "mo", "msubsup"]
    assert fraction[1].tag == "msqrt"
    assert letters("".join(power.itertext())) == "x12"


def test_the_font_of_a_page_has_the_sign_of_its_roots() -> None:
    """No text holds the sign: browsers take it from the font, and its taller forms, or draw no root at all."""
    formulas = formulas_of(["frac(a, sqrt(b))"])
    assert "\u221a" not in "".join(text for one in formulas.found.values() for text in one.itertext())
    font = TTFont(io.BytesIO(cut_font(font_letters(formulas.letters, (), ""))))
    sign = font.getBestCmap()[0x221A]
    variants = font["MATH"].table.MathVariants
    place = variants.VertGlyphCoverage.glyphs.index(sign)
    assert variants.VertGlyphConstruction[place].VariantCount > 1
    assert 0x221A not in TTFont(io.BytesIO(cut_font(formulas_of(["a + b"]).letters))).getBestCmap()


def test_dots_stand_above_their_letter() -> None:
    element = formulas_of(["dot(phi)_(2)"]).inline("dot(phi)_(2)")
    accent = next(Xml.fromstring(element).iter("mover"))
    assert accent[1].text == "\u02d9"  # the combining one stands left of its letter in browsers
    assert "\u0307" not in element


def test_primes_stand_behind_their_letter() -> None:
    element = Xml.fromstring(formulas_of(["rho'' + x'_(1)"]).inline("rho'' + x'_(1)"))
    first, _plus, second = element
    assert (first.tag, text_of_element(first)) == ("mrow", "𝜌″")
    assert (second.tag, [text_of_element(part) for part in second]) == ("msub", ["𝑥′", "1"])


def test_a_line_may_end_before_a_sign() -> None:
    spelled = "a cos (b - c) - d + frac(1, e - f)"
    formulas = formulas_of(fragments_of(spelled))
    pieces = formulas.pieces(spelled, relation="=")
    assert [text_of(one)[0] for one in pieces] == ["=", "−", "+"]
    assert "".join(text_of(one) for one in pieces).count("−") == 3
    assert all(Xml.fromstring(one)[0].get("form") == "infix" for one in pieces)


def test_the_sign_of_a_right_side_is_no_difference() -> None:
    element = formulas_of(["-a"]).pieces("-a", relation="=")[0]
    equal, row = Xml.fromstring(element)
    assert (equal.text, row[0].text, row[0].get("form")) == ("=", "−", "prefix")


def test_a_system_keeps_rows_and_columns() -> None:
    matrix = (("a", "-b, c"), ("0", "d"))
    formulas = formulas_of(["a", "-b, c", "0", "d", "x", "y", "1", "2"])
    element = Xml.fromstring(formulas.system(matrix, ("x", "y"), ("1", "2")))
    tables = list(element.iter("mtable"))
    cells = [
        [[text for text in map("".join, (cell.itertext() for cell in row))] for row in table]
        for table in tables
    ]
    assert cells == [[["𝑎", "−𝑏,𝑐"], ["0", "𝑑"]], [["𝑥"], ["𝑦"]], [["1"], ["2"]]]


def test_text_in_formulas_is_text() -> None:
    spelled = 'x_("<script>alert(1)</script> & \\"")'
    element = formulas_of([spelled]).inline(spelled)
    assert "<script" not in element
    assert 'alert(1)</script> & "' in text_of(element).replace("\u00a0", " ")


def test_code_is_refused() -> None:
    for wrong in ("#panic(1)", "a $ b", "x & y", "// a"):
        with pytest.raises(ValueError, match="not a formula"):
            fragments_of(wrong)
