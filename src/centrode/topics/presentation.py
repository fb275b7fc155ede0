"""A result of any topic: in words, in tables, in figures, as files of a folder."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from centrode import render
from centrode.errors import InputError
from centrode.files.drafts import draft_folder
from centrode.locale import _
from centrode.topics.registry import TOPICS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from centrode.model.cam_files import AnyCam
    from centrode.model.mechanism import Display
    from centrode.sheets.sheet import Sheet, Table
    from centrode.topics.topic import Topic


def topic_of(result: Any) -> Topic:
    """The topic whose result something is; InputError for what is no result of a topic."""
    kind = type(result)
    names = {(one.__module__, one.__qualname__) for one in kind.__mro__}
    for topic in TOPICS:
        if (topic.result.module, topic.result.name) in names:
            return topic
    known = ", ".join(topic.result.name for topic in TOPICS)
    raise InputError(
        kind.__name__,
        _("is not a result that can be shown"),
        _("show one of {known}").format(known=known),
    )


def sheet_of(result: Any) -> Sheet:
    """What there is to say about a result and its parts, as data; InputError for what is no result of a topic."""
    return sheet_with_parts(topic_of(result), result)


def sheet_with_parts(topic: Topic, result: Any) -> Sheet:
    """The sheet of a result of a topic, with those of the parts that are results of other topics."""
    sheet = cast("Sheet", topic.view(result))
    parts: Mapping[str, Any] = getattr(result, "parts", {})
    return sheet.with_parts(map(sheet_of, parts.values())) if parts else sheet


def sheets_of_cam(cam: AnyCam, samples: int | None = None, flags: Collection[str] = ()) -> dict[str, Sheet]:
    """The sheets of all topics that a cam has something for, by the name of the topic.

    Parameters
    ----------
    samples : int
        As of each computation.
    flags : collection of str
        Topics that are left out otherwise; they refuse a cam that has nothing for them.
    """
    return {
        topic.name: topic.view(topic.compute(cam, samples))
        for topic in TOPICS
        if topic.subject == "cam"
        and (topic.flag in flags if topic.flag else topic.concerns is None or topic.concerns(cam))
    }


def display_of(result: Any) -> Display:
    """The units of the description that a result knows: that of its mechanism or of its cam."""
    description = result.mechanism if hasattr(result, "mechanism") else result.cam
    return cast("Display", description.display)


def summary(result: Any) -> str:
    """The facts of a result as lines of text, with the tables that a terminal prints.

    They are in the language that is spoken and the units of the result's description.
    """
    return render.sheet_text(sheet_of(result), display_of(result))


def tables(result: Any) -> Mapping[str, Table]:
    """The tables of a result by name; columns are arrays in SI."""
    return sheet_of(result).tables


def figures(result: Any) -> dict[str, Figure]:
    """The figures of a result by name; needs matplotlib."""
    return render.figures_of(sheet_of(result).pictures, display_of(result))


def write(result: Any, folder: str | Path) -> None:
    """Write tables, datasets, figures and the summary of a result into a folder, which appears whole or not at all.

    A result without single numbers has no summary. Raises InputError where the folder cannot be written.
    """
    sheet, display = sheet_of(result), display_of(result)
    with draft_folder(Path(folder)) as draft:
        render.write_tables(sheet, draft, display)
        render.write_pictures(sheet.pictures, draft, display)
        if sheet.scalars:
            render.write_summary(sheet.scalars, draft / "summary.json")
