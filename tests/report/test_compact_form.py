"""The compact form of reports: its checks, its captions and numbers, and the scheme that opens it."""

from __future__ import annotations

import io
import re
from collections import Counter

import numpy as np
import pytest
import typst
from matplotlib.image import imread

import centrode as ct
from centrode.analysis.representative_position import representative_sample
from centrode.errors import InputError, Status
from centrode.model.settings import Display
from centrode.render.document.blocks import (
    ChapterBlocks,
    CheckBlock,
    Moving,
    ParagraphBlock,
    Picture,
    Report,
    SectionBlocks,
    TableBlock,
)
from centrode.render.document.chapters import document_chapter
from centrode.render.document.numbering import number_blocks, refer_to_figures
from centrode.render.document.numbers import Numbers
from centrode.report.checks import gather_checks
from centrode.report.pdf_document import STYLE, Source
from centrode.report.texts import blocks_of
from centrode.sheets.sheet import Chapter, Column, Section, Sheet, Table
from centrode.sheets.texts import NOTHING

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
    assert [(row[2], row[3]) for row in table.rows] == [
        (check.text, "holds" if check.holds else "does not hold") for check in checks
    ]
    assert len(checks) > 1


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
    files = {"main": source.text.encode(), "style.typ": STYLE.read_bytes(), **source.files}
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
    assert all(band <= 0.3 for band in bands[:-1])


def test_a_check_of_several_instants_is_given_once_with_its_greatest_difference() -> None:
    checks = (
        CheckBlock("within 1", True, "within {share}", 0.1),
        CheckBlock("within 3", True, "within {share}", 0.3),
        CheckBlock("another", True, "another", 0.2),
        CheckBlock("broken", False, "within {share}", 2.0),
    )
    chapter = ChapterBlocks("one", "One", (SectionBlocks("", (ParagraphBlock("words"), *checks)),))
    *_kept, gathered = gather_checks([chapter])
    sentence, table = gathered.sections[0].blocks
    assert isinstance(sentence, ParagraphBlock) and sentence.text.startswith(
        "4 checks were made. 3 of them hold."
    )
    assert isinstance(table, TableBlock)
    assert [row[1:] for row in table.rows] == [
        ("One", "within 3", "holds"),
        ("", "another", "holds"),
        ("", "broken", "does not hold"),
    ]


def test_two_figures_are_named_and_a_thinned_table_keeps_the_ends_of_its_gaps() -> None:
    figures = tuple(Picture(b"", f"Figure {one}", 1.0) for one in "ab")
    report = Report("", "", "en", (ChapterBlocks("one", "One", (SectionBlocks("", figures),)),))
    told = refer_to_figures(number_blocks(report)).chapters[0].sections[0].blocks[0]
    assert told == ParagraphBlock("See figures 1 and 2.")
    rows = (*range(0, 160, 10), 350, 360)  # of a dwell from 150 to 350 the first and the last
    sheet = Sheet(
        chapters={
            "one": Chapter(
                NOTHING, (Section(NOTHING, (Table((Column("a", np.arange(361.0)),), NOTHING, rows),)),)
            )
        }
    )
    made = document_chapter("one", sheet, Numbers(Display(), 5), full=False).sections[0].blocks[0]
    assert isinstance(made, TableBlock)
    assert [round(float(row[0])) for row in made.rows] == [*range(0, 141, 20), 150, 350, 360]
