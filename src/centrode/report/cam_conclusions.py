"""The conclusions of a report on a cam: from the results of its other chapters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from centrode.errors import CentrodeError
from centrode.render.document.chapters import document_chapter
from centrode.report.topics import result_of
from centrode.sheets.sheet import Sheet
from centrode.topics.cams import (
    CAM_CONTACT,
    FOLLOWER_FORCES,
    FOLLOWER_MOTION,
    FOLLOWER_PROFILE,
    ROLLER_PATH,
)
from centrode.topics.topic import Lazily

if TYPE_CHECKING:
    from centrode.render.document.blocks import ChapterBlocks
    from centrode.report.study import ReportStudy
    from centrode.topics.topic import Topic

NAME = "conclusions"
# reports on linkages load no cams
_chapter = Lazily("centrode.views.cam_conclusions", "cam_conclusions_chapter")


def conclusions_of_cam(study: ReportStudy) -> ChapterBlocks | None:
    """What follows from the results of a cam; None of a linkage."""
    if not study.is_cam:
        return None
    chapter = _chapter(
        _result(FOLLOWER_MOTION, study),
        _result(FOLLOWER_PROFILE, study),
        _result(FOLLOWER_FORCES, study),
        _result(ROLLER_PATH, study),
        _result(CAM_CONTACT, study),
    )
    return document_chapter(NAME, Sheet(chapters={NAME: chapter}), study.numbers, full=study.wishes.full)


def _result(topic: Topic, study: ReportStudy) -> Any:
    """The result of a topic; None where the cam has nothing for it, or it fails: its own chapter says why."""
    if topic.concerns is not None and not topic.concerns(study.description):
        return None
    try:
        return result_of(topic, study)
    except CentrodeError:
        return None
