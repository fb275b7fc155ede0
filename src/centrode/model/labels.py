"""Names of bodies: sliders that no link is named for, and the words that a reader has for frame and sliders."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.locale import _
from centrode.model.reading import body_word

if TYPE_CHECKING:
    from centrode.model.links import Guide
    from centrode.model.mechanism import Mechanism

SLIDER, GUIDE, GEAR, ROLLING = "slider ", "guide ", "gear ", "rolling "


def body_name(mechanism: Mechanism, name: str) -> str:
    """A link by its own name; the frame, and a slider that no link is named for, by a word."""
    if name in mechanism.links or not name.startswith(SLIDER):
        return body_word(name)
    return _("slider {point}").format(point=name.removeprefix(SLIDER))


def sliders_of(mechanism: Mechanism) -> dict[str, Guide]:
    """Name -> guide of the sliders that a description does not name as links."""
    sliders: dict[str, Guide] = {}
    for guide in mechanism.guides:
        if guide.link is None:
            name = f"slider {guide.id}"
            # a link may have the name already
            while name in mechanism.links or name in sliders:
                name += "'"
            sliders[name] = guide
    return sliders
