"""Chapters of the topics of the registry."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from centrode.errors import CentrodeError, MotionError, NotComputedYet
from centrode.locale import _
from centrode.render.document.blocks import Chapter, Paragraph, Section, shown
from centrode.render.document.chapters import document_chapter
from centrode.report.moments import moments_of

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy
    from centrode.sheets.sheet import Sheet
    from centrode.topics.topic import ChapterOfTopic, Topic


def topic_chapter(topic: Topic, chapter: ChapterOfTopic, study: ReportStudy) -> Chapter | None:
    """A chapter of a topic; None where the description has nothing for it.

    A chapter that nobody has chosen and that cannot be computed says why, and is no failure.
    """
    if study.is_cam != (topic.subject == "cam") or not topic.concerns(study.description):
        return None
    try:
        return document_chapter(chapter.name, _sheet(topic, study), study.numbers)
    except (MotionError, NotComputedYet) as reason:
        if study.wishes.chapters is not None:
            raise
        return left_out(chapter.name, _(chapter.title), reason)


def _sheet(topic: Topic, study: ReportStudy) -> Sheet:
    """The sheet of a topic at the instants of the report, computed once."""

    def compute() -> Sheet:
        instants = study.wishes.instants
        if not study.is_cam:
            instants = tuple(moment.at for moment in moments_of(study))
        return cast("Sheet", topic.view(topic.compute(study.description, instants=instants)))

    return study.once(("sheet", topic.name), compute)


def left_out(name: str, title: str, reason: CentrodeError) -> Chapter:
    """A chapter that nobody has chosen and that cannot be computed: it says why."""
    where = f"{reason.where}: " if reason.where else ""
    text = _("This is left out. {reason}").format(reason=shown(f"{where}{reason.what}"))
    return Chapter(name, title, (Section("", (Paragraph(text),)),))
