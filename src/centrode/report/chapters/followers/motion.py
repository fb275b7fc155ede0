"""The cam that turns under its follower, to be played."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.cams.followers.base_circle import follower_cam, has_size
from centrode.locale import _
from centrode.render.document.blocks import ChapterBlocks, SectionBlocks
from centrode.report.player_cams import moving_follower

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy


def follower_motion_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """A turn of the cam; nothing where its size is not given."""
    if not study.is_plate_cam or not has_size(study.plate):
        return None
    moving = moving_follower(follower_cam(study.plate), _(study.plate.title))
    return ChapterBlocks("motion", _("Motion"), (SectionBlocks("", (moving,)),))
