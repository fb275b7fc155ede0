"""The chapter of a wheel that walks, which a page plays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.cams.results import walking_wheel_results
from centrode.locale import _
from centrode.render.document.blocks import ChapterBlocks, SectionBlocks
from centrode.report.player_cams import moving_wheel

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy


def cam_motion_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """The wheel that walks, which a page plays."""
    if not study.is_cam or study.is_plate_cam or study.cam.mover is None:
        return None
    wheel = walking_wheel_results(study.cam).wheel
    if wheel is None:
        return None
    moving = moving_wheel(wheel, _(study.cam.title))
    return ChapterBlocks("motion", _("Motion"), (SectionBlocks("", (moving,)),))
