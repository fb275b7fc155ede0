"""The motion to be played."""

from __future__ import annotations

from centrode.locale import _
from centrode.render.document.blocks import Chapter, Section
from centrode.report.moving import moving_of
from centrode.report.study import ReportStudy


def motion_chapter(study: ReportStudy) -> Chapter | None:
    """The mechanism in motion, which a page plays and a PDF shows in its initial position."""
    if study.is_cam:
        return None
    moving = study.once("moving", lambda: moving_of(study.mechanism, study.motion))
    return Chapter("motion", _("Motion"), (Section("", (moving,)),))
