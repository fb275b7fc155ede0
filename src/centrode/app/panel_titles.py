"""Topics as the workbench calls them: sentences name its panels where a terminal has commands."""

from __future__ import annotations

import re

from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.topics.registry import TOPICS
from centrode.topics.topic import Topic

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
    """What is wrong, and the repair, as the workbench says them."""
    return with_panel_titles(failure.what), with_panel_titles(failure.repair)
