"""Names that results have in English, in the language of the reader."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.locale import _
from centrode.model.reading import body_word

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism

SLIDER, GUIDE, GEAR, ROLLING = "slider ", "guide ", "gear ", "rolling "


def body_name(mechanism: Mechanism, name: str) -> str:
    """A link by its own name; the frame, and a slider that no link is named for, by a word."""
    if name in mechanism.links or not name.startswith(SLIDER):
        return body_word(name)
    return _("slider {point}").format(point=name.removeprefix(SLIDER))
