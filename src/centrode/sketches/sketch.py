"""What a drawing of a mechanism holds: strokes, circles, hatches and words, and what their layers are for."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from centrode.errors import InputError
from centrode.locale import _

Place: TypeAlias = tuple[float, float]

MOST_STROKES = 2000
MOST_VERTICES = 1000
"""Vertices of one stroke."""
LARGEST = 1e12
"""Coordinates beyond it are refused."""

ROLES: Mapping[str, frozenset[str]] = {
    role: frozenset(words.split())
    for role, words in {
        "link": "link links bar bars rod rods coupler звено звенья тяга ланка ланки",
        "hinge": "hinge hinges joint joints pivot pivots pin pins шарнир шарниры шарнір шарніри",
        "ground": "ground grounds frame fixed base support supports стойка опора опоры неподвижно стояк опори нерухомо",
        "guide": "guide guides slot slots rail rails направляющая направляющие паз напрямна напрямні",
        "slider": "slider sliders block blocks piston ползун ползуны поршень повзун повзуни",
        "drive": "drive drives driver crank input motor привод кривошип вход привід вхід",
        "name": "name names label labels text texts имена подписи имя імена підписи",
        "gear": "gear gears pitch wheel wheels колесо колёса зубчатые колеса",
        "aside": (
            "dim dims dimension dimensions title titles path paths centrode centrodes defpoints hidden construction "
            "centreline centerline axis axes border sheet note notes cam cams размеры оси рамка розміри осі"
        ),
    }.items()
}
"""What a layer is for, by the words of its name."""


def role_of(layer: str) -> str:
    """What a layer is for: a key of `ROLES`, or an empty text where its name says nothing."""
    words = set(re.split(r"[\W\d_]+", layer.casefold()))
    return next((role for role, known in ROLES.items() if words & known), "")


@dataclass(frozen=True)
class Polyline:
    """Straight lines one after another; `closed` ones return to their first point, which is not repeated."""

    points: tuple[Place, ...]
    closed: bool
    layer: str


@dataclass(frozen=True)
class SketchCircle:
    """A circle."""

    centre: Place
    radius: float
    layer: str


@dataclass(frozen=True)
class Label:
    """A text and where it stands."""

    text: str
    place: Place
    layer: str


@dataclass
class Sketch:
    """A drawing in its own units, y upwards.

    Attributes
    ----------
    arcs : of circles, of which only the centre is used
    hatches : outlines of filled places
    unit : metres in a unit of the drawing
    notes : what was taken for granted, as sentences
    unread : what was left out -> how often
    """

    strokes: list[Polyline] = field(default_factory=list)
    rings: list[SketchCircle] = field(default_factory=list)
    arcs: list[SketchCircle] = field(default_factory=list)
    hatches: list[Polyline] = field(default_factory=list)
    labels: list[Label] = field(default_factory=list)
    unit: float = 1e-3
    notes: list[str] = field(default_factory=list)
    unread: dict[str, int] = field(default_factory=dict)

    def leave_out(self, what: str, count: int = 1) -> None:
        """Note something that is not read."""
        self.unread[what] = self.unread.get(what, 0) + count

    def add_stroke(self, points: Sequence[Place], layer: str, *, closed: bool = False) -> None:
        """Add lines through points; ends that meet close them, points that repeat are one."""
        kept: list[Place] = []
        for point in points[: MOST_VERTICES + 1]:
            if not kept or math.dist(kept[-1], point) > 0.0:
                kept.append(point)
        if len(kept) > 3 and math.dist(kept[0], kept[-1]) <= 1e-9 * extent(kept):
            closed = True
        if closed and len(kept) > 1 and math.dist(kept[0], kept[-1]) <= 1e-9 * extent(kept):
            kept.pop()
        if len(kept) < 2:
            self.leave_out(_("lines without length"))
            return
        self.strokes.append(Polyline(tuple(kept), closed and len(kept) > 2, layer))

    def check(self, where: str) -> None:
        """Raise InputError where the drawing is too large, or holds numbers that are none."""
        parts = len(self.strokes) + len(self.rings) + len(self.hatches) + len(self.arcs) + len(self.labels)
        if parts > MOST_STROKES or any(len(one.points) > MOST_VERTICES for one in self.strokes):
            what = _("the drawing has {count} parts, at most {most} are read").format(
                count=parts, most=MOST_STROKES
            )
            raise InputError(where, what, _("keep the mechanism alone"))
        places = [place for one in (*self.strokes, *self.hatches) for place in one.points]
        places += [one.centre for one in (*self.rings, *self.arcs)] + [one.place for one in self.labels]
        numbers = [x for place in places for x in place] + [one.radius for one in (*self.rings, *self.arcs)]
        if not all(abs(x) < LARGEST for x in numbers):
            raise InputError(where, _("a coordinate of the drawing is no number, or too large"))


def extent(places: Sequence[Place]) -> float:
    """Longer side of the box around places."""
    if not places:
        return 0.0
    return float(max(max(values) - min(values) for values in zip(*places, strict=True)))
