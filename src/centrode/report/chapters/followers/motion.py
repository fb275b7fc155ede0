"""The cam that turns under its follower, to be played."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.locale import _
from centrode.render.document.blocks import ChapterBlocks, SectionBlocks
from centrode.render.document.cam_player import moving_follower
from centrode.report.chapters.followers.parts import body_of

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy


def follower_motion_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """A turn of the cam; nothing where its size is not given."""
    body = body_of(study) if study.is_plate_cam else None
    if body is None:
        return None
    moving = moving_follower(body, _(study.plate.title))
    return ChapterBlocks("motion", _("Motion"), (SectionBlocks("", (moving,)),))
