"""Names that results have in English, in the language of the reader: loads and bodies."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from centrode.locale import _, mark
from centrode.model.reading import body_word

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism

LOADS = {
    "force": mark("force"),
    "torque": mark("torque"),
    "spring": mark("spring"),
    "damper": mark("damper"),
    "weight": mark("weight"),
    "friction": mark("friction"),
}
"""What stands before a load's place where the load has no name of its own."""
SLIDER, GUIDE, GEAR, ROLLING = "slider ", "guide ", "gear ", "rolling "
_NUMBERED = re.compile(r" \d+$")


def load_name(mechanism: Mechanism, label: str) -> str:
    """A load by its own name, else by its kind and what it acts on: "weight AB".

    Loads of one name are numbered ("weight AB 2"): such a name is the user's own as well.
    """
    own = {load.name for load in mechanism.loads}
    if label in own or _NUMBERED.sub("", label) in own:
        return label
    kind, space, rest = label.partition(" ")
    return f"{_(LOADS[kind])} {rest}" if space and kind in LOADS else label


def body_name(mechanism: Mechanism, name: str) -> str:
    """A link by its own name; the frame, and a slider that no link is named for, by a word."""
    if name in mechanism.links or not name.startswith(SLIDER):
        return body_word(name)
    return _("slider {point}").format(point=name.removeprefix(SLIDER))
