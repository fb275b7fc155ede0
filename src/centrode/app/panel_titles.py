"""Topics as the workbench calls them: sentences name its panels where a terminal has commands."""

from __future__ import annotations

import re

from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.topics.registry import TOPICS
from centrode.topics.topic import Topic

_OPTION = re.compile(r"(?<![\w-])--([a-z]{2})")
_COMMAND = re.compile(r"\bcentrode ([a-z]+(?:-[a-z]+)*)")


def shown_topics() -> tuple[Topic, ...]:
    """Topics that the workbench shows, in the order of commands and chapters."""
    return tuple(topic for topic in TOPICS if topic.title and topic.subject in ("mechanism", "cam"))


def with_panel_titles(sentence: str) -> str:
    """A translated sentence with the titles of panels in place of commands; a command without a panel stays."""
    if "centrode " not in sentence:
        return sentence
    titles = {topic.name: topic.title for topic in shown_topics()}

    def title(command: re.Match[str]) -> str:
        name = titles.get(command[1])
        return _("“{title}”").format(title=_(name)) if name else command[0]

    return _COMMAND.sub(title, sentence)


def failure_texts(failure: CentrodeError) -> tuple[str, str]:
    """Where and what is wrong, and the repair, as the workbench says them."""
    where = f"{failure.where}: " if failure.where else ""
    return _without_dashes(with_panel_titles(where + failure.what)), _without_dashes(
        with_panel_titles(failure.repair)
    )


def _without_dashes(sentence: str) -> str:
    """A sentence whose options are named as the keys, or the fields of a panel, that they are there."""
    return _OPTION.sub(r"\1", sentence)
