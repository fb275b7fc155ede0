"""The words of the workbench: every sentence that the page itself shows, marked for the catalogues."""

from __future__ import annotations

from collections.abc import Mapping

from centrode.locale import _, mark

WORDS: Mapping[str, str] = {
    "title": mark("Workbench"),
    "new": mark("New"),
    "open": mark("Open"),
    "save": mark("Save"),
    "save_as": mark("Save as"),
    "undo": mark("Undo"),
    "redo": mark("Redo"),
    "delete": mark("Delete"),
    "duplicate": mark("Duplicate"),
    "mirror": mark("Mirror"),
    "ground": mark("Ground"),
    "guide": mark("Guide"),
    "drive": mark("Drive"),
    "fixed": mark("Fixed"),
    "trace": mark("Trace"),
    "mass": mark("Mass"),
    "load": mark("Load"),
}
"""Key of the page -> sentence in English."""


def spoken_words() -> dict[str, str]:
    """The words in the chosen language."""
    return {key: _(sentence) for key, sentence in WORDS.items()}
