"""What stands first in a report: the kinematic scheme of a linkage, the drawing of a cam; on a page the motion too."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from centrode.errors import CentrodeError
from centrode.kinematics.motion import motion
from centrode.locale import _
from centrode.model.follower_cam import PlateCam
from centrode.render.document.blocks import Block, ChapterBlocks, Moving
from centrode.render.document.chapters import document_picture
from centrode.views.schemes import scheme_picture

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy


def opening_of(study: ReportStudy, chapters: Sequence[ChapterBlocks]) -> tuple[Block, ...]:
    """The scheme in a position far from dead ones; of a cam the first picture of its motion.

    Nothing where there is no motion to choose from: the chapters say why.
    """
    if study.is_cam:
        # on paper nothing moves: the picture is called after what it shows
        follows = isinstance(study.description, PlateCam)
        caption = _("The cam with its follower") if follows else _("The walking wheel with its shoes")
        return tuple(replace(one.still, caption=caption) for one in _players(chapters)[:1])
    if study.subject != "mechanism":
        return ()
    try:
        course = study.motion if study.wishes.chapters is None else motion(study.mechanism)
    except CentrodeError:
        return ()
    return (document_picture(scheme_picture(study.mechanism, course), study.numbers),)


def move_players(
    opening: tuple[Block, ...], chapters: Sequence[ChapterBlocks]
) -> tuple[tuple[Block, ...], tuple[ChapterBlocks, ...]]:
    """What a page plays, put behind the opening, which shows on paper what it plays; its chapter is dropped."""
    if not opening:
        return opening, tuple(chapters)
    players = tuple(replace(one, caption="") for one in _players(chapters))
    kept = tuple(chapter for chapter in chapters if chapter.missing or not _only_plays(chapter))
    return (*opening, *players), kept


def _players(chapters: Sequence[ChapterBlocks]) -> list[Moving]:
    """The motions of the chapters that hold nothing else."""
    return [
        block
        for chapter in chapters
        if _only_plays(chapter)
        for section in chapter.sections
        for block in section.blocks
        if isinstance(block, Moving)
    ]


def _only_plays(chapter: ChapterBlocks) -> bool:
    blocks = [block for section in chapter.sections for block in section.blocks]
    return bool(blocks) and all(isinstance(block, Moving) for block in blocks)
