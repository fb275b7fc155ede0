"""What the letters of a mechanism's equations stand for, in words and numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from centrode.locale import _
from centrode.model.labels import GEAR, ROLLING
from centrode.quantities import display_unit

if TYPE_CHECKING:
    from centrode.equations.derivation import Equations
    from centrode.equations.symbols import Meaning
    from centrode.model.mechanism import Display


def meaning_text(meaning: Meaning, equations: Equations) -> str:
    """What a letter stands for."""
    first, second, third = (*meaning.names, "", "", "")[:3]
    body = _("the frame") if second == "frame" else _("link {link}").format(link=second)
    sentences = {
        "link angle": _("angle of link {first}"),
        "relative angle": _("angle of link {first} against link {second}"),
        "bearing": _("direction of the centre of wheel {first} from that of its track"),
        "cylinder": _("direction of cylinder {first}"),
        "angle in link": _("angle of {second}-{third} against the axis of link {first}"),
        "angle of guide": _("direction of guide {first} on {body}"),
        "angle of pair": _("constant angle of the links that guide {first} keeps parallel"),
        "length": _("{second}-{third} of link {first}"),
        "reach": _("distance of the centres of wheel {first} and its track"),
        "stroke": _("length of cylinder {first}"),
        "slide": _("displacement along guide {first}"),
        "offset along": _("from {third} to where guide {first} is measured from, along it"),
        "offset beside": _("distance of guide {first} from {third}"),
        "coordinate": _("{second} of point {first}"),
        "ratio": _("ratio of gear {first}"),
        "spin": _("turns of wheel {first} over turns of its centre"),
        "radius": _("radius of wheel {first}"),
        "constant": _("constant of {first}"),
        "constant of gear": _("constant of gear {first}"),
        "constant of wheel": _("constant of the rolling of wheel {first}"),
        "arc": _("arc from {first} to {second}"),
        "arc of circle": _("arc from the pole of guide {first} to its circle"),
        "corner": _("angle in {second} from arc {second}-{first} to arc {second}-{third}"),
        "angle from arc": _("angle of link {first} in {second} from arc {second}-{third}"),
        "angle on circle": _("angle of {first} about {second} from arc {second}-{third}"),
        "angle to path": _("angle of link {first} in {second} to the path of {second} about {third}"),
    }
    kind = meaning.kind
    if kind == "constant":
        kind, first = _constant(_constraint_of(meaning.symbol, equations))
    if meaning.kind.startswith("offset") and not third:
        third = _("the origin")
    return sentences[kind].format(first=first, second=second, third=third, body=body)


def _constant(constraint: str) -> tuple[str, str]:
    """What a constant belongs to, and its name: gears and wheels have names of their own."""
    for start, kind in ((GEAR, "constant of gear"), (ROLLING, "constant of wheel")):
        if constraint.startswith(start):
            return kind, constraint.removeprefix(start)
    return "constant", constraint


def _constraint_of(symbol: str, equations: Equations) -> str:
    for group in equations.groups:
        for one in group.conditions:
            if any(letter.name == symbol for letter in one.residual.letters):
                return one.name
    return ""


def value_text(meaning: Meaning, display: Display, least: Mapping[str, float]) -> str:
    """Its number in the units of the description; zero where it is smaller than what counts in its unit."""
    value = 0.0 if abs(meaning.value) < least.get(meaning.unit, 0.0) else meaning.value
    if meaning.unit == "1":
        return f"{meaning.value:.6g}"
    factor, shown = display_unit(meaning.unit, display.length, display.angle)
    return f"{value * factor:.6g} {shown}"
