"""Reports as PDF: nothing runs off a page, nothing a user wrote is obeyed, the bytes repeat."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from centrode.render.document.blocks import (
    ChapterBlocks,
    FormulaBlock,
    ParagraphBlock,
    ReferenceBlock,
    Report,
    SectionBlocks,
    TableBlock,
)
from centrode.report.pdf_document import Source, pdf_document

from .made import HOSTILE, report
from .pdf_reading import PdfFile

WIDTH, HEIGHT, MARGIN = 595.28, 841.89, 56.69
SLACK = 4.0
"""Points that punctuation at the end of a line hangs into the margin: less than half a letter."""


@pytest.fixture(scope="module")
def document() -> PdfFile:
    return PdfFile(pdf_document(report()))


def pages_of(*chapters: ChapterBlocks, title: str = "T", language: str = "en") -> list[str]:
    return PdfFile(pdf_document(Report(title, "", language, chapters))).pages


def test_what_users_wrote_is_shown_as_it_is(document: PdfFile) -> None:
    told = re.sub(r"\s+", "", document.text)
    wanted = re.sub(r"\s+", "", HOSTILE)
    # title, contents twice, headings, subtitle, reason: whole where no line was hyphenated
    assert told.count(wanted) >= 5


def test_nothing_runs_off_the_page(document: PdfFile) -> None:
    boxes = document.words()
    assert len(boxes) > 1000
    for left, bottom, right, top, word in boxes:
        assert left >= MARGIN - SLACK, word
        assert right <= WIDTH - MARGIN + SLACK, word
        assert bottom >= 0, word
        assert top <= HEIGHT, word


def test_heads_of_tables_are_repeated_and_columns_shared_out(document: PdfFile) -> None:
    parts = [page for page in document.pages if "123.4567" in page]
    assert len(parts) > 1
    assert all(re.search(r"𝑥0|x0|𝑥\s*0", page) for page in parts)  # the first column leads every part


@pytest.mark.parametrize(("language", "word"), [("ru", "механизм"), ("uk", "механізм")])
def test_text_can_be_searched(language: str, word: str) -> None:
    chapter = ChapterBlocks("a", word.capitalize(), (SectionBlocks("", (ParagraphBlock(f"Це {word}."),)),))
    (_contents, page) = pages_of(chapter, title=word, language=language)
    assert word in page
    assert "Таблица" not in page


def test_the_bytes_repeat_in_another_process() -> None:
    program = (
        "import sys; sys.path.insert(0, sys.argv[1])\n"
        "from report.made import report\n"
        "from centrode.report.pdf_document import pdf_document\n"
        "sys.stdout.buffer.write(pdf_document(report()))\n"
    )
    tests = str(Path(__file__).parents[1])
    done = subprocess.run([sys.executable, "-c", program, tests], capture_output=True, check=True)
    assert done.stdout == pdf_document(report())


def test_long_contents_share_a_page_with_the_first_chapter() -> None:
    for count, page in ((3, 1), (60, 1)):
        chapters = tuple(
            ChapterBlocks(f"c{k}", f"Chapter {k}", (SectionBlocks("", (ParagraphBlock(f"begin{k}"),)),))
            for k in range(count)
        )
        pages = pages_of(*chapters)
        assert "begin0" in pages[page], count
        assert bool(re.search(r"Chapter 59\s*\.", pages[page])) == (count > 50)  # the end of the contents


@pytest.mark.parametrize("titled", [True, False])
@pytest.mark.parametrize("count", [2, 30, 37, 39, 47, 80])
def test_contents_name_the_right_pages(count: int, titled: bool) -> None:
    rows = tuple((f"row{k}", "1") for k in range(20))
    section = SectionBlocks("Headed" if titled else "", (TableBlock(("a", "b"), rows),))
    chapters = tuple(
        ChapterBlocks(f"c{k}", f"Chapter {k}k", (section,)) for k in range(count // (1 + titled))
    )
    pages = pages_of(*chapters)
    for k in range(len(chapters)):
        (told,) = re.findall(rf"Chapter {k}k [. ]*\W*(\d+)\n", "\n".join(pages))
        assert re.search(rf"Chapter {k}k\n", pages[int(told) - 1]), (k, told)


@pytest.mark.parametrize("lines", range(30, 50, 2))
def test_a_table_begins_with_more_than_a_row(lines: int) -> None:
    rows = tuple((f"row{k}", "1") for k in range(40))
    filling = tuple(ParagraphBlock("filling") for _ in range(lines))
    sections = (
        SectionBlocks("", filling),
        SectionBlocks("Headed", (TableBlock(("a", "b"), rows, "Captioned"),)),
    )
    _contents, *pages = pages_of(ChapterBlocks("a", "A", sections))
    (page,) = (page for page in pages if "Captioned" in page)
    assert "Headed" in page
    assert page.count("row") >= 5


def test_what_announces_a_line_stays_with_it() -> None:
    blocks = (
        ParagraphBlock("Group by group:"),
        ParagraphBlock("point A"),
        FormulaBlock((("x", "1"),)),
        ParagraphBlock("Last."),
        ReferenceBlock("refer"),
        TableBlock(("a",), (("b",),)),
    )
    source = Source(Report("", "", "en", (ChapterBlocks("a", "A", (SectionBlocks("", blocks),)),))).text
    kept = [line for line in source.splitlines() if "sticky: true" in line]
    assert [any(word in line for line in kept) for word in ("Group", "point A", "Last", "refer")] == [
        True,
        True,
        False,
        True,
    ]


def test_code_in_a_formula_is_a_fault() -> None:
    chapter = ChapterBlocks("a", "A", (SectionBlocks("", (FormulaBlock((("x", '#read("style.typ")'),)),)),))
    with pytest.raises(ValueError, match="not a formula"):
        Source(Report("", "", "en", (chapter,)))


def test_every_string_of_the_source_is_closed() -> None:
    source = Source(report()).text
    left = re.sub(r'"(?:[^"\\]|\\.)*"', "", source)
    assert "panic" not in left
    assert "script" not in left
    assert '"' not in left
