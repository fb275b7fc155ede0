"""Sentences that name formulas by their numbers, in every kind of document."""

from __future__ import annotations

import io
import re
import zipfile

import pytest

import centrode as ct
from centrode.render.document.blocks import (
    ChapterBlocks,
    FormulaBlock,
    ParagraphBlock,
    ReferenceBlock,
    Report,
    SectionBlocks,
    SystemBlock,
)
from centrode.render.document.captions import number_blocks
from centrode.report.editable.latex_document import latex_document
from centrode.report.editable.word import word_document
from centrode.report.html.page import html_page
from centrode.report.pdf_document import pdf_document
from centrode.report.texts import blocks_of

from .pdf_reading import PdfFile


@pytest.fixture(scope="module")
def report() -> Report:
    """Two formulas of one name around a system, one of another behind the sentences that name them."""
    formulas = (
        FormulaBlock((("x", "1"),), "first"),
        SystemBlock((("a", "b"), ("c", "d")), ("x", "y"), ("1", "2")),
        FormulaBlock((("y", "2"),), "first"),
    )
    sentences = (
        ReferenceBlock("Both follow from {first}, at once."),
        ReferenceBlock("Nothing follows from {later}."),
        ReferenceBlock("Nothing follows from {first} and {missing}."),
        ParagraphBlock("A sentence."),
    )
    sections = (
        SectionBlocks("", formulas),
        SectionBlocks("S", sentences),
        SectionBlocks("", (FormulaBlock((("z", "3"),), "later"),)),
    )
    return Report("T", "", "en", (ChapterBlocks("a", "A", sections),))


def test_numbers_are_those_of_the_formulas_before(report: Report) -> None:
    numbered = number_blocks(number_blocks(report))
    found = list(blocks_of(numbered))
    assert [one.number for one in found if isinstance(one, FormulaBlock | SystemBlock)] == [1, 2, 3, 4]
    (reference,) = (one for one in found if isinstance(one, ReferenceBlock))
    assert reference.pieces == ("Both follow from ", 1, ", ", 3, ", at once.")


def test_they_stand_in_every_document(report: Report) -> None:
    page = html_page(report).decode()
    assert 'Both follow from <a href="#formula-1">(1)</a>, <a href="#formula-3">(3)</a>, at once.' in page
    assert set(re.findall(r'id="(formula-\d)"', page)) == {f"formula-{k}" for k in range(1, 5)}
    read = PdfFile(pdf_document(report))
    assert read.standards == "ua-1 a-2a"
    assert "Both follow from (1), (3), at once." in read.text
    source = latex_document(report, "figures")[0].decode()
    assert r"Both follow from \eqref{eq:1}, \eqref{eq:3}, at once." in source
    assert re.findall(r"\\label\{eq:(\d)\}", source) == ["1", "2", "3", "4"]
    with zipfile.ZipFile(io.BytesIO(word_document(report))) as word:
        text = word.read("word/document.xml").decode()
    assert re.findall(r"REF (formula-\d)", text) == ["formula-1", "formula-3"]
    assert {"formula-1", "formula-3"} <= set(re.findall(r'w:name="(formula-\d)"', text))
    for document in (page, read.text, source, text):
        assert "Nothing" not in document


def test_tables_of_the_motion_name_the_formulas_of_rates() -> None:
    chosen = ("derivation", "tables")
    made = ct.report("crank-rocker", ct.ReportOptions(chapters=chosen), language="en")
    formulas = {one.number: one for one in blocks_of(made) if isinstance(one, FormulaBlock)}
    (reference,) = (one for one in blocks_of(made) if isinstance(one, ReferenceBlock))
    words, rates, between, accelerations, _end = reference.pieces
    assert (words, between) == ("Angular velocities follow from ", ", angular accelerations from ")
    assert isinstance(rates, int) and isinstance(accelerations, int)
    assert [line[0] for line in formulas[rates].lines] == [f"frac(d phi_({k}), d t)" for k in (2, 3)]
    assert [line[0] for line in formulas[accelerations].lines] == [f"epsilon_({k})" for k in (2, 3)]
    alone = ct.report("crank-rocker", ct.ReportOptions(chapters=("tables",)), language="en")
    assert not [one for one in blocks_of(alone) if isinstance(one, ReferenceBlock)]
