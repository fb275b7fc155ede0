"""Reports as PDF: nothing runs off a page, nothing a user wrote is obeyed, the bytes repeat."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from centrode.model.page_standards import Standard
from centrode.render.document.blocks import (
    ChapterBlocks,
    FormulaBlock,
    ParagraphBlock,
    Picture,
    ReferenceBlock,
    Report,
    SectionBlocks,
    TableBlock,
)
from centrode.report.figure_places import Layout, lonely_figures, well_placed
from centrode.report.pdf_document import Source, document_files, pdf_document

from .made import HOSTILE, report, svg
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
    (page,) = pages_of(chapter, title=word, language=language)
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


def test_contents_share_their_last_page_with_the_first_chapter() -> None:
    for count, page in ((3, 0), (60, 1)):
        chapters = tuple(
            ChapterBlocks(f"c{k}", f"Chapter {k}", (SectionBlocks("", (ParagraphBlock(f"begin{k}"),)),))
            for k in range(count)
        )
        pages = pages_of(*chapters)
        assert "begin0" in pages[page], count
        assert re.search(rf"Chapter {count - 1}\s*\.", pages[page])  # the end of the contents


def rows_of(page: str) -> list[int]:
    return [int(number) for number in re.findall(r"\brow(\d+)\b", page)]


@pytest.mark.parametrize(
    ("language", "line"),
    [("en", "Table 1, continued"), ("ru", "Продолжение таблицы 1"), ("uk", "Продовження таблиці 1")],
)
@pytest.mark.parametrize("standard", ["plain", "gost", "dstu"])
def test_a_table_that_runs_over_a_page_is_continued_by_name(
    language: str, line: str, standard: Standard
) -> None:
    rows = tuple((f"row{k}", "1") for k in range(120))
    table = TableBlock(("head", "b"), rows, "Rows", number=1)
    chapter = ChapterBlocks("a", "A", (SectionBlocks("", (ParagraphBlock("Words."), table)),))
    report = Report("T", "", language, (chapter,), standard=standard)
    pages = [page for page in PdfFile(pdf_document(report)).pages if rows_of(page)]
    assert len(pages) > 1
    assert [page.count(line) for page in pages] == [0] + [1] * (len(pages) - 1)
    assert all("head" in page for page in pages)
    assert [row for page in pages for row in rows_of(page)] == list(range(120))
    assert all(page.index(line) < page.index("head") for page in pages[1:])


def test_parts_of_a_wide_table_are_continued_by_name() -> None:
    table = TableBlock(
        tuple(f"column{k}" for k in range(30)), (("123.4567",) * 30,) * 3, "Wide", (True,) * 30, number=1
    )
    (page,) = pages_of(ChapterBlocks("a", "A", (SectionBlocks("", (table,)),)))
    parts = len(re.findall(r"\bcolumn0\b", page))
    assert parts > 1
    assert page.count("Table 1, continued") == parts - 1


def test_no_row_stands_alone_on_the_last_page_of_a_table() -> None:
    for count in range(34, 48):
        rows = tuple((f"row{k}", "1") for k in range(count))
        table = TableBlock(("a", "b"), rows, "Rows", number=1)
        pages = pages_of(ChapterBlocks("a", "A", (SectionBlocks("", (ParagraphBlock("Words."), table)),)))
        assert all(len(rows_of(page)) != 1 for page in pages), count


def test_figures_stand_before_the_next_chapter() -> None:
    tall = Picture(svg(400, 420), "Tall", 6.0)
    words = ParagraphBlock("word " * 350)
    chapters = (
        ChapterBlocks("a", "First", (SectionBlocks("", (words, tall, tall)),)),
        ChapterBlocks("b", "Second", (SectionBlocks("", (ParagraphBlock("after " * 100),)),)),
    )
    text = "\n".join(pages_of(*chapters))
    assert text.rindex("Tall") < text.index("after")


@pytest.mark.parametrize("standard", ["plain", "gost"])
@pytest.mark.parametrize("lines", range(12, 36, 4))
def test_no_figure_at_the_end_of_a_chapter_has_half_a_page_of_its_own(lines: int, standard: Standard) -> None:
    """Two figures find no room on one page, nor the first of them below the text: it goes above a part of it."""
    low, high = (Picture(svg(400, height), f"{height} high", 5.5) for height in (300, 440))
    words = tuple(ParagraphBlock(f"line {k} " + "word " * 12) for k in range(lines))
    sections = (SectionBlocks("", (*words, low, ParagraphBlock("Between."), high)),)
    second = ChapterBlocks("b", "Second", (SectionBlocks("", (ParagraphBlock("after " * 100),)),))
    report = Report("T", "", "en", (ChapterBlocks("a", "First", sections), second), standard=standard)
    made = PdfFile(pdf_document(report))
    assert made.half_empty_pages == []
    text = made.text
    assert text.index("300 high") < text.index("440 high") < text.index("after")
    assert [f"line {k} " in text for k in range(lines)] == [True] * lines


def test_figures_go_earlier_within_their_chapter_and_keep_their_order() -> None:
    """A page of 700 points: the text of a chapter ends in the middle of one, two figures have pages of their own."""
    lines = (
        "#heading(level: 1, a)|#par|#floating-picture(1)|#chapter-end|#heading(level: 1, b)|#par|#par|#par"
    )
    lines += "|#floating-picture(2)|#floating-picture(3)|#chapter-end"
    texts: list[str] = []

    def layout_of(text: str) -> Layout:
        texts.append(text)
        place = text.split("\n").index("#floating-picture(2)")
        # from two lines earlier on the second figure stands above the text
        seconds = ((3, 300.0), (2, 350.0))[place <= 6]
        return Layout(((1, 500.0), (2, 400.0)), ((1, 300.0), seconds, (4, 400.0)))

    placed = well_placed(lines.replace("|", "\n"), layout_of, 50.0, 700.0).split("\n")
    assert len(texts) == 3
    assert placed == [*lines.split("|")[:6], "#floating-picture(2)", "#par", "#par", *lines.split("|")[9:]]

    def hopeless(text: str) -> Layout:
        texts.append(text)
        return Layout(((1, 500.0), (2, 400.0)), ((1, 300.0), (3, 300.0), (4, 400.0)))

    texts.clear()
    assert well_placed(lines.replace("|", "\n"), hopeless, 50.0, 700.0) == lines.replace("|", "\n")
    assert len(texts) == 4  # before each paragraph of its chapter, no farther


def test_a_page_that_becomes_too_empty_behind_a_figure_is_filled_next() -> None:
    """Two chapters of a page of text and a figure; the first figure where it fits pushes the second off its page."""
    lines = ["#heading(level: 1, a)", "#par", "#par", "#floating-picture(1)", "#chapter-end"]
    lines += ["#heading(level: 1, b)", "#par", "#par", "#floating-picture(2)", "#chapter-end"]

    def layout_of(text: str) -> Layout:
        first, second = (text.split("\n").index(f"#floating-picture({figure})") for figure in (1, 2))
        if first == 3:  # behind its text, at the top of the next page
            return Layout(((1, 400.0), (2, 700.0)), ((2, 300.0), (2, 600.0)))
        return Layout(((1, 700.0), (2, 400.0)), ((1, 300.0), ((3, 300.0), (2, 350.0))[second < 8]))

    assert list(lonely_figures(lines, layout_of("\n".join(lines)), 50.0, 700.0)) == [0]
    placed = well_placed("\n".join(lines), layout_of, 50.0, 700.0).split("\n")
    assert [placed.index(f"#floating-picture({figure})") for figure in (1, 2)] == [2, 7]
    assert list(lonely_figures(placed, layout_of("\n".join(placed)), 50.0, 700.0)) == []


def test_a_number_and_its_unit_stay_on_one_line() -> None:
    for width in range(1, 40):
        words = "a" * width + " " + " ".join(f"{k} 1.5 rad/s" for k in range(60))
        (page,) = pages_of(ChapterBlocks("a", "A", (SectionBlocks("", (ParagraphBlock(words),)),)))
        assert not re.search(r"1\.5\s*\n\s*rad|rad/\s*\n", page), width
        assert re.search(r"1\.5\Drad/s", page)


def test_a_number_keeps_its_sign_of_equality() -> None:
    for width in range(1, 12):
        words = "a" * width + " " + " ".join(f"lever = −{k}.5°," for k in range(60))
        (page,) = pages_of(ChapterBlocks("a", "A", (SectionBlocks("", (ParagraphBlock(words),)),)))
        assert not re.search(r"=\s*\n", page), width


def test_each_chapter_is_a_file_that_does_not_change_with_others() -> None:
    """Typst lays out again what has changed: here the first of two chapters."""

    def files(first: str) -> dict[str, bytes]:
        chapters = tuple(
            ChapterBlocks(name, name, (SectionBlocks("", (ParagraphBlock(text),)),))
            for name, text in (("a", first), ("b", "the same"))
        )
        source = Source(Report("", "", "en", chapters))
        return document_files(source.text, source.head)

    short, long = files("short"), files("much longer")
    assert {name for name in short if short[name] != long[name]} == {"chapter-1.typ"}
    assert short["main"].decode().splitlines()[-2:] == [
        '#include "chapter-1.typ"',
        '#include "chapter-2.typ"',
    ]


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
