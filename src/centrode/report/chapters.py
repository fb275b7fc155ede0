"""The chapters of reports by name, in the order of the document.

A chapter is made by a function of the report's study. It gives None where the description has nothing for it, and
raises CentrodeError where it cannot be made.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import NamedTuple, TypeAlias

from centrode.render.document.blocks import ChapterBlocks
from centrode.report import cam_conclusions, repaired_mechanism
from centrode.report.study import ReportStudy
from centrode.report.topics import topic_chapter
from centrode.topics import order
from centrode.topics.order import in_order
from centrode.topics.registry import TOPICS

Make: TypeAlias = Callable[[ReportStudy], ChapterBlocks | None]


class Kind(NamedTuple):
    """A chapter's title, marked for the catalogues, and what makes it."""

    title: str
    make: Make


def either(*makers: Make) -> Make:
    """One chapter of the plane, of the sphere and of cams: the first that has something to tell."""

    def make(study: ReportStudy) -> ChapterBlocks | None:
        return next((chapter for maker in makers if (chapter := maker(study)) is not None), None)

    return make


def chapters_of_topics() -> dict[str, Kind]:
    """The chapters of all topics; one that several topics make is that of the first with something to tell."""
    kinds: dict[str, Kind] = {}
    for topic in TOPICS:
        for chapter in topic.document.chapters:
            make: Make = functools.partial(topic_chapter, topic, chapter)
            if chapter.name in kinds:
                make = either(kinds[chapter.name].make, make)
            kinds[chapter.name] = Kind(chapter.title, make)
    return kinds


def all_chapters() -> dict[str, Kind]:
    """Those of the topics, and that of a mechanism that turns in place of one that locks, which consists of them."""
    kinds = chapters_of_topics()
    makers = {name: kind.make for name, kind in kinds.items()}
    conclusions = kinds[cam_conclusions.NAME]
    made = either(conclusions.make, cam_conclusions.conclusions_of_cam)
    return {
        **kinds,
        cam_conclusions.NAME: conclusions._replace(make=made),
        repaired_mechanism.NAME: Kind(
            repaired_mechanism.TITLE, functools.partial(repaired_mechanism.repaired_chapter, makers)
        ),
    }


CHAPTERS: Mapping[str, Kind] = in_order(all_chapters(), order.CHAPTERS)
"""All chapters."""
