"""The sheets of results: which topic something is a result of, and its sheet with those of its parts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, cast

from centrode.errors import InputError
from centrode.locale import _
from centrode.topics.registry import TOPICS

if TYPE_CHECKING:
    from centrode.sheets.sheet import Sheet
    from centrode.topics.topic import Topic


def topic_of(result: Any) -> Topic:
    """The topic whose result something is; InputError for what is no result of a topic."""
    kind = type(result)
    names = {(base.__module__, base.__qualname__) for base in kind.__mro__}
    for topic in TOPICS:
        if (topic.result.module, topic.result.name) in names:
            return topic
    known = ", ".join(topic.result.name for topic in TOPICS)
    raise InputError(
        kind.__name__,
        _("is not a result that can be shown"),
        _("show one of {known}").format(known=known),
    )


def sheet_with_parts(topic: Topic, result: Any) -> Sheet:
    """The sheet of a result of a topic, with those of its parts that are results of other topics."""
    sheet = cast("Sheet", topic.view(result))
    parts: Mapping[str, Any] = getattr(result, "parts", {})
    return (
        sheet.with_parts({name: sheet_with_parts(topic_of(part), part) for name, part in parts.items()})
        if parts
        else sheet
    )
