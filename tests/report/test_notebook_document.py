"""Notebooks of reports: they run from top to bottom, and compute anew what is changed in the description."""

from __future__ import annotations

import json
import re
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient

import centrode as ct
from centrode.render.document.blocks import (
    ChapterBlocks,
    DescriptionText,
    ProseBlock,
    Report,
    SectionBlocks,
    Span,
)
from centrode.report.notebook_document import notebook_document
from centrode.topics.registry import TOPICS
from report.made import HOSTILE

QUICK = ("structure", "tables", "rotatability")


def run(report: Report, old: str = "", new: str = "") -> Any:
    """The notebook of a report with its outputs, a text in its code replaced."""
    book = nbformat.reads(notebook_document(report).decode().replace(old, new), as_version=4)
    nbformat.validate(book)
    NotebookClient(book, timeout=120, kernel_name="python3").execute()
    return book


def shown(book: Any, code: str) -> str:
    """What the last cell with a code shows."""
    cell = [one for one in book.cells if one.cell_type == "code" and code in one.source][-1]
    return json.dumps([output["data"] for output in cell.outputs], ensure_ascii=False)


@pytest.mark.filterwarnings("ignore")  # of the kernel's own libraries
def test_every_chapter_is_computed_anew_from_the_description_that_is_edited() -> None:
    report = ct.report(ct.example("crank-rocker"), ct.ReportOptions(chapters=QUICK), language="en")
    # with a crank of 2.6 the shortest and the longest link are longer than the others together: nothing turns fully
    book = run(report, "length = 1.0", "length = 2.6")
    assert all(cell.execution_count for cell in book.cells if cell.cell_type == "code")
    changed = ct.parse_mechanism(report.description.text.replace("length = 1.0", "length = 2.6"))
    assert not ct.rotatability(changed).turns_fully
    assert ct.rotatability(ct.example("crank-rocker")).turns_fully
    assert "6.6 m" in shown(book, "rotatability")
    assert "II" in shown(book, "check")


def test_the_same_report_gives_the_same_cells_for_each_chapter() -> None:
    report = ct.report(ct.example("crank-rocker"), ct.ReportOptions(chapters=QUICK), language="uk")
    text = notebook_document(report)
    assert text == notebook_document(report)
    book = nbformat.reads(text.decode(), as_version=4)
    headings = [cell.source for cell in book.cells if cell.source.startswith("## ")]
    assert headings == [f"## {chapter.title}" for chapter in report.chapters]
    (description,) = (cell.source for cell in book.cells if cell.source.startswith("description = "))
    values: dict[str, str] = {}
    exec(description, values)
    assert ct.parse_mechanism(values["description"]) == ct.example("crank-rocker")


def test_cells_call_public_functions() -> None:
    codes = [chapter.code for topic in TOPICS for chapter in topic.document.chapters if chapter.code]
    assert len(codes) > 20
    for code in codes:
        compile(code, "cell", "exec")
        for name in re.findall(r"\bct\.(\w+)", code):
            assert hasattr(ct, name), code


@pytest.mark.parametrize("text", [HOSTILE, "$x_1$", "<b>", "#a", "2.50 kg", '""" + 1', "\\", "`"])
def test_what_users_wrote_is_neither_code_nor_mathematics(text: str) -> None:
    own = SectionBlocks(text, (ProseBlock(((Span(text, strong=True), Span(text, code=True)),)),), "before")
    description = DescriptionText(f"title = '{text}'", "mechanism", (0.5,))
    chapters = (ChapterBlocks("structure", text, (own,)), ChapterBlocks("words", text, missing=text))
    book = nbformat.reads(
        notebook_document(Report(text, text, "en", chapters, description=description)).decode(), as_version=4
    )
    nbformat.validate(book)
    (code,) = (cell.source for cell in book.cells if cell.source.startswith("description = "))
    values: dict[str, str] = {}
    exec(code, values)
    assert values["description"].strip() == description.text.strip()
    words = [cell.source for cell in book.cells if cell.cell_type == "markdown"]
    # nothing opens a tag, a formula or a picture; own text has code besides, in which nothing does
    for plain in (re.sub(r"\\.", "", words[0]), re.sub(r"\\.", "", words[-1])):
        assert not set("<$`[!") & set(plain)
    assert [cell.source for cell in book.cells if "ct.principle" in cell.source] == []


def test_a_sheet_about_many_has_words_alone() -> None:
    book = nbformat.reads(notebook_document(Report("a", "b", "en", ())).decode(), as_version=4)
    assert [cell.cell_type for cell in book.cells] == ["markdown"]
