"""Chapters of the topics of the registry."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

from centrode.errors import CentrodeError, InputError, MotionError, NotComputedYet
from centrode.locale import _
from centrode.render.document.blocks import ChapterBlocks, ParagraphBlock, SectionBlocks, shown
from centrode.render.document.chapters import document_chapter
from centrode.report.study import moments_of

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy
    from centrode.sheets.sheet import Sheet
    from centrode.topics.topic import ChapterOfTopic, Topic


def topic_chapter(topic: Topic, chapter: ChapterOfTopic, study: ReportStudy) -> ChapterBlocks | None:
    """A chapter of a topic; None where the description has nothing for it.

    A chapter that nobody has chosen and that cannot be computed says why, and is no failure.
    """
    if topic.document.on_request and chapter.name not in (study.wishes.chapters or ()):
        return None
    concerns = topic.concerns if chapter.concerns is None else chapter.concerns
    if study.subject != topic.subject or (concerns is not None and not concerns(study.description)):
        return None
    try:
        sheet = _sheet(topic, study)
    except (InputError, MotionError, NotComputedYet) as reason:
        document = topic.document
        may_be = document.may_be_incomplete if isinstance(reason, InputError) else document.may_be_left_out
        if study.wishes.chapters is not None or not may_be:
            raise
        return left_out(chapter.name, _(chapter.title), reason)
    if chapter.name not in sheet.chapters:
        return None
    made = document_chapter(
        chapter.name, sheet, study.numbers, full=study.wishes.full, rows=study.wishes.rows
    )
    return replace(made, code=chapter.code)


def _sheet(topic: Topic, study: ReportStudy) -> Sheet:
    """The sheet of a topic at the instants of the report, made once."""
    return study.once(("sheet", topic.name), lambda: cast("Sheet", topic.view(result_of(topic, study))))


def result_of(topic: Topic, study: ReportStudy) -> Any:
    """The result of a topic at the instants of the report, computed once."""

    def compute() -> Any:
        document = topic.document
        arguments = dict(document.arguments)
        if any(chapter.name in (study.wishes.chapters or ()) for chapter in document.chapters):
            arguments |= document.chosen_arguments
        wished_options = study.wishes.options
        arguments |= {name: wished_options[name] for name in document.options if name in wished_options}
        if document.instants:
            wished = study.is_cam or document.wished
            arguments["instants"] = (
                study.wishes.instants if wished else tuple(moment.at for moment in moments_of(study))
            )
        if document.points:
            arguments["points"] = study.points
        done = None if document.add_instants is None else study.results.get(topic.name)
        if document.add_instants is not None and done is not None:
            # it is at the motion of the forces already
            return document.add_instants(done, **arguments)
        if document.motion:
            arguments["motion"] = study.motion_of_forces
        if not arguments and study.has_run and topic.name in study.results:
            # a part of the run, which computed it without wishes too
            return study.results[topic.name]
        return topic.compute(study.description, **arguments)

    return study.once(("result", topic.name), compute)


def left_out(name: str, title: str, reason: CentrodeError) -> ChapterBlocks:
    """A chapter that nobody has chosen and that cannot be computed: it says why."""
    where = f"{reason.where}: " if reason.where else ""
    text = _("Omitted: {reason}").format(reason=shown(f"{where}{reason.what}"))
    return ChapterBlocks(name, title, (SectionBlocks("", (ParagraphBlock(text),)),), computed=False)
