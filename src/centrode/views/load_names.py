"""Names of loads as texts: a load by its own name, else by its kind and what it acts on."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from centrode.sheets.texts import Joined, Name, Sentence, Text

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism

KINDS = {
    "force": Sentence("force"),
    "torque": Sentence("torque"),
    "spring": Sentence("spring"),
    "damper": Sentence("damper"),
    "weight": Sentence("weight"),
    "friction": Sentence("friction"),
}
_NUMBERED = re.compile(r" \d+$")


def load_text(mechanism: Mechanism, label: str) -> Text:
    """A load of a dataset: "weight AB", where the load has no name of its own.

    Loads of one name are numbered ("weight AB 2"): such a name is the user's own as well.
    """
    own = {load.name for load in mechanism.loads}
    kind, space, rest = label.partition(" ")
    if label in own or _NUMBERED.sub("", label) in own or not space or kind not in KINDS:
        return Name(label)
    return Joined((KINDS[kind], Name(rest)), " ")
