"""The chapter of the repaired mechanism: what a report has of the one that locks, of the one that turns."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from centrode.errors import CentrodeError
from centrode.locale import _, mark
from centrode.render.document.blocks import Block, ChapterBlocks, SectionBlocks, shown
from centrode.render.document.captions import Captioned
from centrode.render.document.chapters import document_chapter
from centrode.report.study import ReportStudy
from centrode.report.topics import result_of
from centrode.sheets.sheet import Chapter, Section, Sheet
from centrode.sheets.texts import NOTHING
from centrode.topics.kinematics import ROTATABILITY
from centrode.views.single_changes import repaired_blocks

if TYPE_CHECKING:
    from centrode.analysis.redesign.proposal import ProposedRepair

NAME = "repaired-mechanism"
TITLE = mark("The repaired mechanism")
PARTS = ("tables", "plots", "graphic")
"""Chapters of the repaired mechanism, one after the other: motion, tables, and the check by the other method."""


def proposed_repair(study: ReportStudy) -> ProposedRepair | None:
    """The repair that the report proposes; None where the mechanism makes its motion, or none was found."""
    if study.subject != "mechanism":
        return None
    try:
        result = result_of(ROTATABILITY, study)
    except CentrodeError:
        return None
    proposed: ProposedRepair | None = getattr(result, "proposed", None)
    return proposed


def repaired_study(study: ReportStudy, proposed: ProposedRepair) -> ReportStudy:
    """The study of the repaired mechanism, with the wishes of the report."""
    return study.once(
        "repaired study",
        lambda: ReportStudy(proposed.repaired, replace(study.wishes, chapters=None)),
    )


def repaired_chapter(
    makers: Mapping[str, Callable[[ReportStudy], ChapterBlocks | None]], study: ReportStudy
) -> ChapterBlocks | None:
    """Motion, tables and graph-analytic check of the repaired mechanism; None where there is none."""
    proposed = proposed_repair(study)
    if proposed is None:
        return None
    own = repaired_study(study, proposed)
    made = [chapter for name in PARTS if (chapter := makers[name](own)) is not None]
    data = Sheet(chapters={NAME: Chapter(NOTHING, (Section(NOTHING, tuple(repaired_blocks(proposed))),))})
    opening = document_chapter(NAME, data, study.numbers, full=study.wishes.full)
    sections = (*opening.sections, *(section for chapter in made for section in _sections(chapter)))
    return ChapterBlocks(NAME, _(TITLE), sections)


def _sections(chapter: ChapterBlocks) -> tuple[SectionBlocks, ...]:
    """The sections of a chapter, each with the title of the chapter before its own, and captions that tell of which."""
    return tuple(
        replace(
            section,
            title=f"{chapter.title}: {section.title}" if section.title else chapter.title,
            blocks=tuple(map(_with_mechanism, section.blocks)),
        )
        for section in chapter.sections
    )


def _with_mechanism(block: Block) -> Block:
    if not isinstance(block, Captioned) or not block.caption:
        return block
    behind = shown(_("repaired mechanism"))
    return replace(block, caption=f"{block.caption}; {behind}")
