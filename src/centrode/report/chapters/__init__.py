"""The chapters of reports by name, in the order of the document.

A chapter is made by a function of the report's study. It gives None where the description has nothing for it, and
raises CentrodeError where it cannot be made.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

from centrode.locale import mark
from centrode.report.blocks import Chapter
from centrode.report.chapters.data import data_chapter
from centrode.report.study import ReportStudy


class Kind(NamedTuple):
    """A chapter's title, marked for the catalogues, and what makes it."""

    title: str
    make: Callable[[ReportStudy], Chapter | None]


CHAPTERS: Mapping[str, Kind] = {
    "data": Kind(mark("Data"), data_chapter),
}
