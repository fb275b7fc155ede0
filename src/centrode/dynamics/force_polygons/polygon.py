"""Force polygons as data: vectors one behind the other, with names and a round scale."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TypeAlias

from centrode.dynamics.force_polygons.actions import Action, Source
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.problems import nearest

ROUND = (1.0, 2.0, 2.5, 5.0, 10.0)
"""Scales of forces, times a power of ten."""
PARTS = "ⁿᵗ"
"""Marks of normal and tangential parts behind the name of a reaction."""
PAPERS = {"A5": (210.0, 148.0), "A4": (297.0, 210.0), "A3": (420.0, 297.0)}
"""Sheets across [mm]."""
ROOM, HEAD = 0.38, 0.17
"""Share of a sheet's width for a polygon, and of its height above and below it."""
Size: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class PolygonVector:
    """A force of a polygon.

    Attributes
    ----------
    name : R12ᵗ, G2, Φ2, R03
    label : what it is: the load's name, the link, the joint
    body : the body it acts on
    source : "load", "weight", "inertia", "reaction" or "drive"
    force [N], start [N], place [m] : complex numbers; where the arrow begins in the polygon, where the force acts
    """

    name: str
    label: str
    body: str
    source: Source
    force: complex
    start: complex
    place: complex

    @property
    def end(self) -> complex:
        """Where the arrow ends [N]."""
        return self.start + self.force


@dataclass(frozen=True)
class Polygon:
    """A closed chain of forces on a group or on one link.

    Attributes
    ----------
    bodies : what it is about
    vectors : one behind the other
    chords : of a group, the reactions of its inner joints, drawn into the chain; each closes the polygon of one link
    scale : newtons that a millimetre stands for
    """

    bodies: tuple[str, ...]
    vectors: tuple[PolygonVector, ...]
    chords: tuple[PolygonVector, ...]
    scale: float

    @property
    def sums(self) -> tuple[PolygonVector, ...]:
        """Reactions that were found in two parts, normal and tangential, as wholes."""
        return tuple(
            replace(first, name=first.name[:-1], force=first.force + second.force)
            for first, second in pairwise(self.vectors)
            if first.name[-1] in PARTS and first.name[:-1] == second.name[:-1]
        )

    @property
    def gap(self) -> complex:
        """What is left open [N]: rounding."""
        return sum((vector.force for vector in self.vectors), 0j)

    def length(self, vector: PolygonVector) -> float:
        """Length of a vector on paper [mm]."""
        return abs(vector.force) / self.scale

    def vector(self, name: str) -> PolygonVector:
        """A vector by its name; KeyError where there is none."""
        for one in (*self.vectors, *self.sums, *self.chords):
            if one.name == name:
                return one
        raise KeyError(name)


def chained(actions: Iterable[Action]) -> tuple[PolygonVector, ...]:
    """Actions one behind the other, from the origin."""
    found: list[PolygonVector] = []
    at = 0j
    for action in actions:
        found.append(vector_of(action, at))
        at += action.force
    return tuple(found)


def vector_of(action: Action, start: complex) -> PolygonVector:
    """An action as a vector that begins somewhere."""
    return PolygonVector(
        action.symbol, action.label, action.body, action.source, action.force, start, action.place
    )


def polygon_of(
    bodies: Sequence[str], actions: Iterable[Action], chords: Iterable[PolygonVector], room: Size
) -> Polygon:
    """A polygon with the finest round scale at which it goes into a room [mm]."""
    vectors = chained(actions)
    return Polygon(tuple(bodies), vectors, tuple(chords), scale_of(vectors, room))


def scale_of(vectors: Sequence[PolygonVector], room: Size) -> float:
    """The finest scale [N/mm] of the series 1, 2, 2.5, 5 at which vectors go into a room."""
    corners = [0j, *(vector.end for vector in vectors)]
    wide = max(corner.real for corner in corners) - min(corner.real for corner in corners)
    high = max(corner.imag for corner in corners) - min(corner.imag for corner in corners)
    return round_scale(max(wide / room[0], high / room[1]))


def round_scale(least: float) -> float:
    """The least number of the series that is not smaller; 1 of nothing."""
    if not least > 0.0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(least))
    return next(float(f"{step * power:.3g}") for step in ROUND if step * power >= (1 - 1e-9) * least)


def sheet_of(paper: str) -> Size:
    """Width and height [mm] of a sheet across; InputError for a name that is none."""
    if paper not in PAPERS:
        what = _("{paper} is no size of paper here").format(paper=f'"{paper}"')
        known = _("one of: {names}").format(names=", ".join(PAPERS))
        raise InputError("paper", what, nearest(paper, PAPERS) or known)
    return PAPERS[paper]


def room_of(paper: str) -> Size:
    """Room [mm] of a polygon on a sheet."""
    wide, high = sheet_of(paper)
    return ROOM * wide, (1 - HEAD) * high
