"""The compact form of reports: its checks, its captions and numbers, and the scheme that opens it."""

from __future__ import annotations

import io
import re
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
import typst
from matplotlib.figure import Figure
from matplotlib.image import imread

import centrode as ct
from centrode.analysis.representative_position import representative_sample
from centrode.errors import InputError, Status
from centrode.render.document import chapters
from centrode.render.document.blocks import CheckBlock, Moving, ParagraphBlock, Picture, Report, TableBlock
from centrode.render.figures import pictures
from centrode.report.chapters import CHAPTERS
from centrode.report.pdf_document import Source, pdf_document, style_files
from centrode.report.study import settle_options
from centrode.report.texts import blocks_of
from centrode.topics.registry import TOPICS
from samples import few

from .pdf_reading import PdfFile

NAME = "crank-rocker"


def made(full: bool) -> Report:
    return ct.report(ct.example(NAME), ct.ReportOptions(full=full), language="en")


@pytest.fixture(scope="module")
def compact() -> Report:
    return made(full=False)


@pytest.fixture(scope="module")
def full() -> Report:
    return made(full=True)


def test_the_table_of_checks_holds_every_check_of_the_full_form(compact: Report, full: Report) -> None:
    checks = [block for block in blocks_of(full) if isinstance(block, CheckBlock)]
    table = next(block for block in compact.chapters[-1].sections[0].blocks if isinstance(block, TableBlock))
    assert [row[2] for row in table.rows] == [check.text for check in checks]
    # where all hold, the sentence before the table says so in place of a column
    assert all(check.holds for check in checks)
    assert [len(row) for row in table.rows] == [3] * len(checks)
    assert len(checks) > 1


def headings(report: Report) -> set[tuple[str, str]]:
    """Titles of chapters and of their sections."""
    titles = {(chapter.title, "") for chapter in report.chapters}
    return titles | {
        (chapter.title, section.title) for chapter in report.chapters for section in chapter.sections
    }


def test_the_full_form_holds_the_compact_one_and_more(compact: Report, full: Report) -> None:
    *others, checks = compact.chapters
    compact = replace(compact, chapters=tuple(others))
    assert checks.name == "checks"
    assert headings(compact) < headings(full)
    tables = [block for block in blocks_of(full) if isinstance(block, TableBlock)]

    def holds(whole: TableBlock, table: TableBlock) -> bool:
        """Whether a table has all columns and rows of another: it may have deviations and more rows besides."""
        if not set(table.head) <= set(whole.head):
            return False
        columns = [whole.head.index(name) for name in table.head]
        return set(table.rows) <= {tuple(row[column] for column in columns) for row in whole.rows}

    found = [block for block in blocks_of(compact) if isinstance(block, TableBlock)]
    for table in found:
        assert any(holds(whole, table) for whole in tables), table.caption
    assert len(found) < len(tables)


def test_every_chapter_that_concerns_a_mechanism_is_in_the_full_form(monkeypatch: pytest.MonkeyPatch) -> None:
    press = ct.example("six-bar-press")
    wanted = {
        chapter.name
        for topic in TOPICS
        for chapter in topic.document.chapters
        if topic.subject == "mechanism"
        and not topic.document.on_request
        and ((concerns := chapter.concerns or topic.concerns) is None or concerns(press))
    }
    monkeypatch.setattr(
        pictures, "figure_of", lambda *_: Figure()
    )  # which chapters there are hangs on no picture
    monkeypatch.setattr(chapters, "drawn_to_scale", lambda figure, words, *_: chapters.picture(figure, words))
    monkeypatch.setattr(chapters, "scale_of", lambda _: 1.0)
    made = ct.report(press, ct.ReportOptions(full=True), language="en")
    # conclusions end a note, or are named
    assert {chapter.name for chapter in made.chapters} == wanted - {"conclusions"}
    assert not [chapter.name for chapter in made.chapters if chapter.missing or not chapter.sections]
    assert len(wanted) > 15


@pytest.mark.parametrize(
    ("file", "command", "full"),
    [
        (None, None, False),
        (True, None, True),
        (False, None, False),
        (True, False, False),
        (False, True, True),
    ],
)
def test_the_form_is_that_of_the_command_then_of_the_file(
    file: bool | None, command: bool | None, full: bool
) -> None:
    mechanism = replace_wishes(ct.example(NAME), file)
    assert settle_options(mechanism, ct.ReportOptions(full=command), CHAPTERS).full is full
    if file is not None:  # chapters that are chosen are full, unless somebody says otherwise
        chosen = ct.ReportOptions(chapters=("data",))
        assert settle_options(mechanism, chosen, CHAPTERS).full is file


def replace_wishes(mechanism: ct.Mechanism, full: bool | None) -> ct.Mechanism:
    wish = "" if full is None else f"\n[report]\nfull = {str(full).lower()}\n"
    made = ct.parse_mechanism(ct.mechanism_text(mechanism) + wish)
    assert ct.parse_mechanism(ct.mechanism_text(made)).report.full is full
    return made


def test_every_table_and_figure_has_a_number_and_a_caption_of_its_own(compact: Report, full: Report) -> None:
    for report in (compact, full):
        for kind in (TableBlock, Picture):
            found = [block for block in blocks_of(report) if isinstance(block, kind)]
            if kind is Picture:
                found = [
                    one for one in blocks_of(report) if isinstance(one, Picture | Moving) and one.caption
                ]
            assert [block.number for block in found] == list(range(1, len(found) + 1))
            captions = Counter(block.caption for block in found)
            assert all(captions) and max(captions.values()) == 1


def test_every_figure_is_referred_to(compact: Report) -> None:
    numbers = {block.number for block in blocks_of(compact) if isinstance(block, Picture)} - {1}
    told: set[int] = set()
    for block in blocks_of(compact):
        if isinstance(block, ParagraphBlock) and block.text.startswith("See figure"):
            first, *last = map(int, re.findall(r"\d+", block.text))
            told |= set(range(first, (last or [first])[0] + 1))
    assert told == numbers


def test_the_scheme_opens_a_report(compact: Report) -> None:
    first = compact.opening[0]
    assert isinstance(first, Picture)
    assert first.number == 1
    assert first.caption.startswith("Kinematic scheme")


@pytest.mark.parametrize(
    "name", ["crank-rocker", "six-bar-press", "slider-crank-offset", "spherical-four-bar", "kite"]
)
def test_the_scheme_stands_far_from_dead_positions(name: str) -> None:
    mechanism = ct.example(name)
    motion = ct.motion(mechanism, 73)
    sample = representative_sample(mechanism, motion)
    assert Status(int(motion["status"][sample])) == Status.OK
    angles = ct.transmission_angles(mechanism, 73)["transmission_angle"]
    sine = abs(np.sin(angles)).min("group")
    assert float(sine[sample]) >= float(sine.max()) / 3


def test_unknown_chapters_are_still_refused() -> None:
    with pytest.raises(InputError, match="there is no chapter"):
        ct.report(ct.example(NAME), ct.ReportOptions(chapters=("checks",), full=False))


def blank_bands(report: Report) -> list[float]:
    """The greatest blank band of each page, as a part of the height of its text."""
    source = Source(report)
    files = {"main": source.text.encode(), **style_files(report), **source.files}
    pages = typst.Compiler(ignore_system_fonts=True).compile(input=files, format="png", ppi=30)
    bands = []
    for page in pages if isinstance(pages, list) else [pages]:
        grey = imread(io.BytesIO(page), format="png")[..., :3].mean(axis=2)
        height = len(grey)
        text = grey[int(height * 17 / 297) : int(height * 277 / 297)]
        inked = np.flatnonzero((text < 0.8).any(axis=1))
        bands.append(float(np.diff(np.concatenate([[0], inked, [len(text)]])).max()) / len(text))
    return bands


@pytest.mark.drawn
def test_pages_of_the_compact_form_are_filled(compact: Report, full: Report) -> None:
    bands = blank_bands(compact)
    assert len(bands) < len(blank_bands(full))
    # where a chapter ends with figures for which a page has no room, the next begins behind them
    assert sum(band > 0.3 for band in bands[:-1]) <= 1
    assert PdfFile(pdf_document(compact)).half_empty_pages == []


@pytest.mark.drawn
@pytest.mark.parametrize(
    "name",
    few(
        ["slider-between-cranks", "spherical-four-bar", "valve-cam"],
        ["slider-between-cranks", "slider-between-cranks-locked", "spherical-four-bar", "valve-cam"],
    ),
)
def test_no_page_is_half_empty_unless_a_chapter_ends(name: str) -> None:
    made = PdfFile(pdf_document(ct.report(name, language="uk")))
    assert len(made.pages) > 7
    assert made.half_empty_pages == []
