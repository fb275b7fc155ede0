"""The checks of a compact report: taken out of the chapters, in one table at its end."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from centrode.locale import _, ngettext
from centrode.render.document.blocks import (
    ChapterBlocks,
    CheckBlock,
    ParagraphBlock,
    SectionBlocks,
    TableBlock,
    shown,
)

NAME = "checks"
"""Of the chapter."""


def gather_checks(chapters: Sequence[ChapterBlocks]) -> tuple[ChapterBlocks, ...]:
    """Chapters without the checks that hold, and the chapter of all checks behind them.

    A check that does not hold stays in its place as well. A chapter in which nothing else is left is dropped.
    """
    kept = tuple(
        chapter
        for chapter in map(_without_checks, chapters)
        if chapter.sections or chapter.missing or not _is_left_empty(chapter, chapters)
    )
    found = [(chapter.title, check) for chapter in chapters for check in checks_of(chapter)]
    return (*kept, _chapter(found)) if found else kept


def checks_of(chapter: ChapterBlocks) -> Iterator[CheckBlock]:
    """The checks of a chapter in their order."""
    for section in chapter.sections:
        yield from (block for block in section.blocks if isinstance(block, CheckBlock))


def _is_left_empty(chapter: ChapterBlocks, before: Sequence[ChapterBlocks]) -> bool:
    """Whether a chapter without sections had some."""
    return any(one.name == chapter.name and one.sections for one in before)


def _without_checks(chapter: ChapterBlocks) -> ChapterBlocks:
    sections = (
        replace(
            section,
            blocks=tuple(
                block for block in section.blocks if not (isinstance(block, CheckBlock) and block.holds)
            ),
        )
        for section in chapter.sections
    )
    return replace(chapter, sections=tuple(section for section in sections if section.blocks))


def _chapter(found: Sequence[tuple[str, CheckBlock]]) -> ChapterBlocks:
    """A table of what was verified, chapter by chapter, with the verdicts."""
    good = sum(check.holds for _title, check in found)
    count = ngettext("{n} check was made.", "{n} checks were made.", len(found)).format(n=len(found))
    verdict = _("All hold.") if good == len(found) else _("{n} of them hold.").format(n=good)
    words = (_("does not hold"), _("holds"))
    told = _worst(found)
    titles = ["", *(title for title, _check in told)]
    rows = tuple(
        (str(number), shown(title) if title != before else "", check.text, words[check.holds])
        for number, (before, (title, check)) in enumerate(zip(titles, told, strict=False), start=1)
    )
    head = (_("No."), _("chapter"), _("what was verified"), _("verdict"))
    columns = 3 if good == len(found) else 4  # the sentence before tells that all hold
    table = TableBlock(
        head[:columns],
        tuple(row[:columns] for row in rows),
        _("What was verified, by which second route, and how far the two are apart"),
        (True, False, False, False)[:columns],
    )
    often = _("A check made at several instants is given once, with its greatest difference.")
    sentences = [count, verdict, *([often] if len(told) < len(found) else [])]
    blocks = (ParagraphBlock(" ".join(sentences)), table)
    return ChapterBlocks(NAME, _("Checks"), (SectionBlocks("", blocks),))


def _worst(found: Sequence[tuple[str, CheckBlock]]) -> list[tuple[str, CheckBlock]]:
    """Of the checks of a chapter that state the same the one that is farthest off; all that do not hold."""
    worst: dict[tuple[str, str], tuple[str, CheckBlock]] = {}
    for number, (title, check) in enumerate(found):
        key = (title, check.kind if check.holds and check.kind else f"{number}")
        if key not in worst or check.part > worst[key][1].part:
            worst[key] = (title, check)
    return list(worst.values())
