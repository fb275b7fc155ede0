"""Names of loads and reactions, which datasets have in English, in the language of the reader."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
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


def with_load_names(
    mechanism: Mechanism, labels: Iterable[str], rows: Iterable[tuple[str, str]]
) -> list[tuple[str, str]]:
    """Rows of facts in which loads are listed, with their names in the language of the reader."""
    names = {label: load_name(mechanism, label) for label in labels}

    def named(text: str) -> str:
        parts = text.split(", ")
        return ", ".join(_renamed(part, names) for part in parts)

    return [(label, named(text)) for label, text in rows]


def _renamed(part: str, names: Mapping[str, str]) -> str:
    """A load, or a load behind its symbol ("G2 weight AB")."""
    symbol, space, label = part.partition(" ")
    if part in names:
        return names[part]
    return f"{symbol} {names[label]}" if space and label in names else part
