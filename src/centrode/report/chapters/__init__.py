"""The chapters of reports by name, in the order of the document.

A chapter is made by a function of the report's study. It gives None where the description has nothing for it, and
raises CentrodeError where it cannot be made.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import NamedTuple, TypeAlias

from centrode.locale import mark
from centrode.render.document.blocks import ChapterBlocks
from centrode.report.chapters.curvature_cams import (
    cam_motion_chapter,
)
from centrode.report.chapters.followers.motion import follower_motion_chapter
from centrode.report.chapters.linkages.data import data_chapter
from centrode.report.chapters.linkages.motion import motion_chapter, plots_chapter
from centrode.report.chapters.linkages.structure import structure_chapter
from centrode.report.chapters.linkages.tables import tables_chapter
from centrode.report.chapters.spherical_linkages import (
    sphere_data_chapter,
    sphere_plots_chapter,
    sphere_tables_chapter,
)
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
        return next((chapter for one in makers if (chapter := one(study)) is not None), None)

    return make


OWN: Mapping[str, Kind] = {
    "data": Kind(mark("Data"), either(data_chapter, sphere_data_chapter)),
    "motion": Kind(mark("Motion"), either(motion_chapter, cam_motion_chapter, follower_motion_chapter)),
    "structure": Kind(mark("Structure"), structure_chapter),
    "tables": Kind(mark("Tables of the motion"), either(tables_chapter, sphere_tables_chapter)),
    "plots": Kind(mark("Plots of the motion"), either(plots_chapter, sphere_plots_chapter)),
}


def with_topics(own: Mapping[str, Kind]) -> dict[str, Kind]:
    """Chapters with those of the topics; a chapter that several make is that of the first with something to tell."""
    kinds = dict(own)
    for topic in TOPICS:
        for chapter in topic.document.chapters:
            make: Make = functools.partial(topic_chapter, topic, chapter)
            if chapter.name in kinds:
                make = either(kinds[chapter.name].make, make)
            kinds[chapter.name] = Kind(chapter.title, make)
    return kinds


CHAPTERS: Mapping[str, Kind] = in_order(with_topics(OWN), order.CHAPTERS)
"""Those of the topics among the others."""
