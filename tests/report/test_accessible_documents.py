"""PDFs by their standards: a second reader finds outline, language, headings, descriptions of formulas and figures."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import centrode as ct
from centrode.locale import speaking
from centrode.render.document.blocks import (
    ChapterBlocks,
    FormulaBlock,
    Moving,
    ParagraphBlock,
    Picture,
    Report,
    SectionBlocks,
    SystemBlock,
)
from centrode.report.html.elements import formulas_in
from centrode.report.pdf_document import pdf_document
from centrode.report.prose import prose_sections
from centrode.report.spoken_formulas import LONGEST, spoken_formula, spoken_relations, spoken_text
from centrode.report.texts import blocks_of
from centrode.report.variants.files import write_variant_reports
from samples import few

from .made import HOSTILE
from .made import report as made_by_hand
from .pdf_reading import PdfFile

BOTH = "ua-1 a-2a"


def headings(report: Report) -> Iterator[str]:
    """Titles of chapters and sections with their numbers."""
    for chapter, blocks in enumerate(report.chapters, start=1):
        yield f"{chapter} {blocks.title}"
        titled = [section.title for section in blocks.sections if section.title]
        yield from (f"{chapter}.{part} {title}" for part, title in enumerate(titled, start=1))


def squeezed(text: str) -> str:
    """Letters alone: lines end anywhere in a heading, and words are hyphenated."""
    return re.sub(r"[\s\u00ad\u2010\ufffe-]", "", text)


def check_document(report: Report) -> None:
    """The document of a report by its second reader."""
    read = PdfFile(pdf_document(report))
    assert read.standards == BOTH
    assert read.is_tagged
    assert (read.language, read.title) == (report.language, report.title)
    wanted = list(headings(report))
    assert list(map(squeezed, read.outline)) == list(map(squeezed, wanted))
    text = squeezed(read.text)
    assert not [title for title in wanted if squeezed(title) not in text]
    assert squeezed(report.title) in text
    blocks = [block for block in blocks_of(report) if not (isinstance(block, Moving) and not block.caption)]
    figures = read.descriptions("Figure")
    assert len(figures) == sum(isinstance(block, Picture | Moving) for block in blocks)
    formulas = read.descriptions("Formula")
    assert len(formulas) >= sum(isinstance(block, FormulaBlock | SystemBlock) for block in blocks)
    assert all(figures) and all(formulas)


@pytest.mark.parametrize("language", few(["en"], ["en", "ru", "uk"]))  # the others speak in the test below
def test_a_report_has_outline_language_and_descriptions(language: str) -> None:
    check_document(ct.report("crank-rocker", ct.ReportOptions(full=False), language=language))


@pytest.mark.parametrize(("name", "language"), [("spherical-four-bar", "uk"), ("valve-cam", "ru")])
def test_documents_of_the_sphere_and_of_cams_have_them(name: str, language: str) -> None:
    check_document(ct.report(name, ct.ReportOptions(full=False), language=language))


def test_reports_and_answers_of_variants_have_them(tmp_path: Path) -> None:
    topology = ct.parse_mechanism(
        ct.mechanism_text(ct.example("slider-between-cranks")) + '\n[report]\nchapters = ["structure"]\n'
    )
    write_variant_reports(
        topology, [{"variant": "long", "l2": 1.2}], tmp_path, formats=("pdf",), language="uk"
    )
    found = sorted(tmp_path.rglob("*.pdf"))
    assert len(found) == 2
    for file in found:
        read = PdfFile(file.read_bytes())
        assert (read.standards, read.language) == (BOTH, "uk")
        assert read.outline
        assert all(squeezed(title) in squeezed(read.text) for title in read.outline)


def test_a_document_with_a_users_texts_has_them() -> None:
    made = made_by_hand()
    text = "*Own* `code` text\n\n1. <b>one</b> $x$\n2. " + HOSTILE.replace("\n", " ")
    prose = ChapterBlocks("three", "Own text", tuple(prose_sections(text, "before")))
    report = Report(made.title, made.subtitle, "en", (*made.chapters, prose))
    assert PdfFile(pdf_document(report)).standards == BOTH


def test_letters_that_no_font_has_leave_a_plain_document() -> None:
    name = "Ланка \N{ROBOT FACE} \u6a5f\u69cb"
    chapter = ChapterBlocks("a", "A", (SectionBlocks("", (ParagraphBlock(name),)),))
    read = PdfFile(pdf_document(Report("T", "", "uk", (chapter,))))
    assert read.standards == ""
    assert read.is_tagged and read.language == "uk"
    assert "Ланка" in read.text


SPOKEN = {
    "x_(B) = frac(l, 2)": (
        "x sub B equals l over 2",
        "x с индексом B равно l делить на 2",
        "x з індексом B дорівнює l поділити на 2",
    ),
    "-omega_(1)^(2)": (
        "minus ω sub 1 squared",
        "минус ω с индексом 1 в квадрате",
        "мінус ω з індексом 1 у квадраті",
    ),
    "dot.double(s)": ("s with two dots", "s с двумя точками", "s з двома крапками"),
    "sin (phi - psi)": (
        "sine open bracket φ minus ψ close bracket",
        "синус скобка открывается φ минус ψ скобка закрывается",
        "синус дужка відкривається φ мінус ψ дужка закривається",
    ),
    'arrow(v)_(italic("BA"))': ("vector v sub BA", "вектор v с индексом BA", "вектор v з індексом BA"),
    'sqrt(x) slash "x)(_^"': (
        "the square root of x, end of the root divided by x)(_^",
        "корень из x, конец корня разделить на x)(_^",
        "корінь із x, кінець кореня поділити на x)(_^",
    ),
}


@pytest.mark.parametrize("formula", SPOKEN)
def test_formulas_are_put_into_words(formula: str) -> None:
    for language, words in zip(("en", "ru", "uk"), SPOKEN[formula], strict=True):
        with speaking(language):
            assert spoken_formula(formula) == words


def test_no_sign_of_the_notation_is_left() -> None:
    report = ct.report("crank-rocker", ct.ReportOptions(full=False), language="en")
    formulas = {one for block in blocks_of(report) for one in formulas_in(block)}
    assert len(formulas) > 50
    for formula in formulas:
        assert not re.search(r'[_^"\\()]|frac\b|dot\.|italic|upright|thin', spoken_formula(formula)), formula


def test_descriptions_are_no_longer_than_the_standard_allows() -> None:
    lines = (("x", " + ".join(["frac(a, b)"] * 1000)),) * 3
    told = spoken_relations(FormulaBlock(lines))
    assert sum(len(one.encode("utf-16-le")) + 4 for one in told) < 32767
    assert len(spoken_text("word " * LONGEST)) == LONGEST
    chapter = ChapterBlocks("a", "A", (SectionBlocks("", (FormulaBlock(lines[:1]),)),))
    assert PdfFile(pdf_document(Report("T", "", "en", (chapter,)))).standards == BOTH
