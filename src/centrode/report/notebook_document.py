"""A report as a notebook: the description as text that can be edited, and cells that compute each chapter from it."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Iterator
from typing import Any, TypeAlias

from centrode.locale import _, speaking
from centrode.render.document.blocks import (
    ChapterBlocks,
    DescriptionText,
    ProseBlock,
    Report,
    SectionBlocks,
    Span,
    TableBlock,
)
from centrode.report.texts import parts_of

Cell: TypeAlias = dict[str, Any]

PAGE = """from IPython.display import IFrame

chosen = ct.ReportOptions(chapters=({name!r},))
(page,) = ct.write_report(ct.report({subject}, chosen, language={language!r}), "chapters", ("html",), name={name!r})
IFrame(page, "100%", 600)"""
"""What shows a chapter that no public function alone computes."""
BEGIN = "%matplotlib inline\nimport centrode as ct\n\nct.choose_language({language!r});"
READ = {
    "mechanism": "mechanism = ct.parse_mechanism(description)",
    "cam": "cam = ct.parse_cam(description)",
    "gear pair": "import tomllib\n\npair = ct.GearPair(**tomllib.loads(description))",
    "gear train": "import tomllib\n\ntrain = ct.GearTrain(**tomllib.loads(description))",
}
"""How each subject is read, into a variable of its last word."""
MARKS = re.compile(r"([\\`*_{}\[\]()#+\-.!|~$^])")
VERSION = {"nbformat": 4, "nbformat_minor": 5}


def notebook_document(report: Report) -> bytes:
    """A report as a notebook (ipynb, version 4.5) without outputs; the same report gives the same bytes."""
    with speaking(report.language):
        cells = list(_cells(report))
    for number, cell in enumerate(cells, start=1):
        cell["id"] = f"cell-{number}"
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    book = {
        "cells": cells,
        "metadata": {"kernelspec": kernel, "language_info": {"name": "python"}},
        **VERSION,
    }
    return (json.dumps(book, ensure_ascii=False, indent=1) + "\n").encode()


def _cells(report: Report) -> Iterator[Cell]:
    yield _words(_head(report))
    for chapter in (chapter for chapter in report.chapters if chapter.role == "front"):
        yield from _chapter(chapter, report.language, None)
    description = report.description
    if description is not None:
        yield _code(BEGIN.format(language=report.language))
        yield _words(_("The description. Change it here, and run all cells: every chapter is computed anew."))
        yield _code(f"description = {_literal(description.text)}")
        yield _code(READ[description.subject])
        if description.subject == "mechanism":
            yield _code(f"instants = {list(description.instants)!r}")
    for chapter in report.chapters:
        if chapter.role != "front":
            yield from _chapter(chapter, report.language, description)


def _head(report: Report) -> str:
    """The title with what was computed, or the lines of the title page."""
    page = report.title_page
    if page is None:
        return f"# {_shown(report.title)}\n\n{_shown(report.subtitle)}"
    people = (f"{label}: {name}" for label, name in page.people)
    lines = [*page.head, page.work, page.course, "", page.variant, *people, page.foot]
    shown = [_shown(line) for line in lines]
    shown[len(page.head) + 2] = f"# {_shown(report.title)}"
    return "\n\n".join(line for line in shown if line)


def _chapter(chapter: ChapterBlocks, language: str, description: DescriptionText | None) -> Iterator[Cell]:
    reason = [_shown(chapter.missing)] if chapter.missing else []
    before = [_prose(section) for section in chapter.sections if section.written == "before"]
    yield _words("\n\n".join([f"## {_shown(chapter.title)}", *reason, *before]))
    if description is not None and chapter.computed and not chapter.missing:
        page = PAGE.format(name=chapter.name, subject=description.subject.split()[-1], language=language)
        yield _code(chapter.code or page)
    after = [_prose(section) for section in chapter.sections if section.written == "after"]
    if after:
        yield _words("\n\n".join(after))


def _prose(section: SectionBlocks) -> str:
    """What a user wrote about a chapter, as Markdown in which only the marks are Markdown's."""
    parts = [f"### {_shown(section.title)}"] if section.title else []
    for block in section.blocks:
        if isinstance(block, ProseBlock):
            paragraphs = ["".join(map(_span, one)) for one in block.paragraphs]
            mark = {"paragraph": "", "bullets": "- ", "numbers": "1. "}[block.kind]
            parts.append("\n".join(f"{mark}{one}" for one in paragraphs))
        elif isinstance(block, TableBlock):
            rows = [block.head, ["---"] * len(block.head), *block.rows]
            parts.append("\n".join(f"| {' | '.join(map(_cell, row))} |" for row in rows))
    return "\n\n".join(parts)


def _cell(text: str) -> str:
    return text if text == "---" else _shown("".join(part.text for part in parts_of(text)))


def _span(span: Span) -> str:
    if span.code and "`" not in span.text:
        return f"`{span.text}`"
    text, mark = _shown(span.text), "**" * span.strong + "*" * span.emphasized
    start, end = len(text) - len(text.lstrip()), len(text.rstrip())
    return f"{text[:start]}{mark}{text[start:end]}{mark[::-1]}{text[end:]}" if text.strip() else text


def _shown(text: str) -> str:
    """Text that Markdown, with its tags and its mathematics, shows as it is."""
    return MARKS.sub(r"\\\1", html.escape(" ".join(text.splitlines()), quote=False))


def _literal(text: str) -> str:
    """A text as a literal of Python that can be read and edited."""
    safe = text.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
    return f'"""\n{safe}"""' if safe.endswith("\n") else f'"""\n{safe}\n"""'


def _words(text: str) -> Cell:
    return {"cell_type": "markdown", "metadata": {}, "source": text.splitlines(keepends=True)}


def _code(text: str) -> Cell:
    return {
        "cell_type": "code",
        "execution_count": None,
        "metadata": {},
        "outputs": [],
        "source": text.splitlines(keepends=True),
    }
