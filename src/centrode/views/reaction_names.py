"""Names of reactions, of sides of joints and of bodies as texts."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, assert_never

from centrode.dynamics.bearings.reaction_series import ReactionKind
from centrode.model.labels import GEAR, GUIDE, ROLLING
from centrode.model.reading import FRAME
from centrode.sheets.texts import Joined, Name, Sentence, Text

if TYPE_CHECKING:
    from centrode.dynamics.bearings.extremes import BearingLoad
    from centrode.dynamics.bearings.reaction_series import ReactionSeries

GEAR_BODIES = {
    "first": Sentence("the first"),
    "second": Sentence("the second"),
    "carrier": Sentence("the carrier"),
}


STARTS = {
    "moment of guide ": ReactionKind.GUIDE_MOMENT,
    "centre on ": ReactionKind.CENTRE,
    GUIDE: ReactionKind.GUIDE_NORMAL,
    GEAR: ReactionKind.GEAR_MOMENT,
    ROLLING: ReactionKind.ROLLING_NORMAL,
}
"""How labels of results begin that are not of hinges."""


def body_text(name: str) -> Text:
    """A link by its name, the frame by its word."""
    return Sentence("frame") if name == FRAME else Name(name)


def side_text(label: str) -> Text:
    """One side of a hinge, "O/OA" and "O/frame"; the frame by its word."""
    point, slash, body = label.partition("/")
    return Joined((Name(point), body_text(body)), "/") if slash else Name(label)


def contact_text(label: str) -> Text:
    """A reaction or a contact with friction by its label in results: of a guide, a gear, a wheel, else of a hinge."""
    if "/" in label:  # no name has a stroke in it
        return side_text(label)
    start = next((start for start in STARTS if label.startswith(start)), "")
    name = Name(label.removeprefix(start))
    match STARTS.get(start):
        case ReactionKind.GUIDE_MOMENT:
            return Sentence("guide {name}, moment", name=name)
        case ReactionKind.CENTRE:
            return Sentence("centre on {name}", name=name)
        case ReactionKind.GUIDE_NORMAL:
            return Sentence("guide {name}", name=name)
        case ReactionKind.GEAR_MOMENT:
            return Sentence("gear {name}", name=name)
        case ReactionKind.ROLLING_NORMAL:
            return Sentence("wheel {name}", name=name)
        case _:
            return name


def contacts_text(labels: str) -> Text:
    """Labels in one attribute of results, "C/wheel; guide C", as texts."""
    return Joined(tuple(map(contact_text, labels.split("; "))), "; ")


def enumerate_names(names: Iterable[str]) -> Text:
    """Names with commas between them."""
    return Joined(tuple(map(Name, names)))


def balancing_text(drive: Name, unit: str) -> Text:
    """What keeps a drive in equilibrium: of a unit of moments, or of forces."""
    if unit == "N m":
        return Sentence("balancing moment of drive {name}", name=drive)
    return Sentence("balancing force of drive {name}", name=drive)


def reaction_text(reaction: ReactionSeries | BearingLoad) -> Text:
    """What a reaction is, and which one of its kind."""
    names = reaction.names
    name = Name(names[0]) if names else Name("")
    match reaction.kind:
        case ReactionKind.HINGE:
            other, body = body_text(names[1]), body_text(names[2])
            return Sentence("{point}: {other} on {body}", point=name, other=other, body=body)
        case ReactionKind.PIN:
            return Sentence("{point}: pin on {body}", point=name, body=body_text(names[1]))
        case ReactionKind.CENTRE:
            return Sentence("centre on {name}", name=name)
        case ReactionKind.GUIDE_NORMAL:
            return Sentence("guide {name}, normal", name=name)
        case ReactionKind.GUIDE_MOMENT:
            return Sentence("guide {name}, moment", name=name)
        case ReactionKind.GEAR_MOMENT:
            return Sentence("gear {name}, on {body}", name=name, body=GEAR_BODIES[names[1]])
        case ReactionKind.TOOTH_FORCE:
            return Sentence("gear {name}, teeth", name=name)
        case ReactionKind.TOOTH_RADIAL_FORCE:
            return Sentence("gear {name}, teeth, radial", name=name)
        case ReactionKind.ROLLING_NORMAL:
            return Sentence("wheel {name}, normal", name=name)
        case ReactionKind.ROLLING_TANGENTIAL:
            return Sentence("wheel {name}, tangential", name=name)
        case ReactionKind.BALANCING:
            return balancing_text(name, reaction.unit)
        case ReactionKind.FRICTION_MOMENT:
            return Sentence("{side}, moment of friction", side=side_text(names[0]))
        case ReactionKind.FRICTION_FORCE:
            return Sentence("guide {name}, friction", name=name)
        case ReactionKind.EFFICIENCY:
            return Sentence("efficiency")
        case ReactionKind.FRAME_FORCE:
            return Sentence("force on the frame")
        case ReactionKind.FRAME_MOMENT:
            return Sentence("moment on the frame")
        case _:
            assert_never(reaction.kind)
