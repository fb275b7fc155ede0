"""Names of loads and reactions, which datasets have in English, in the language of the reader."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.locale import _, mark

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism

KINDS = {
    "force": mark("force"),
    "torque": mark("torque"),
    "spring": mark("spring"),
    "damper": mark("damper"),
    "weight": mark("weight"),
    "friction": mark("friction"),
}


def load_name(mechanism: Mechanism, label: str) -> str:
    """A load by its own name, else by its kind and what it acts on: "weight AB"."""
    if any(load.name == label for load in mechanism.loads):
        return label
    kind, space, rest = label.partition(" ")
    return f"{_(KINDS[kind])} {rest}" if space and kind in KINDS else label
