"""Forces and moments on points and links: what every load, constraint and inertia comes down to."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.geometry.plane import Vector, cross, subtract
from centrode.structure.positions import FRAME, Entity

Number: TypeAlias = Any
NO_FORCE: Vector = (0.0, 0.0)


@dataclass(frozen=True)
class Pull:
    """A force at a place, and a moment, on one body.

    Attributes
    ----------
    body : a point (a pin), or a link, the frame included
    force : (x, y) [N]
    at : (x, y) [m]
        Where the force acts, as a place of that body.
    moment : number [N m]
        A couple that comes on top; points take none.
    """

    body: Entity
    force: Vector
    at: Vector
    moment: Number = 0.0

    def times(self, factor: Number) -> Pull:
        """The same, so many times as great."""
        x, y = self.force
        return Pull(self.body, (x * factor, y * factor), self.at, self.moment * factor)

    def moment_about(self, place: Vector) -> Number:
        """Moment of the force about a place, and the couple [N m]."""
        return cross(subtract(self.at, place), self.force) + self.moment


def on_point(point: str, force: Vector, at: Vector) -> Pull:
    """A force on a pin."""
    return Pull(Entity("point", point), force, at)


def on_link(link: str, force: Vector, at: Vector) -> Pull:
    """A force on a link."""
    return Pull(Entity("link", link), force, at)


def couple(link: str, moment: Number) -> Pull:
    """A moment on a link."""
    return Pull(Entity("link", link), NO_FORCE, NO_FORCE, moment)


def total(pulls: Iterable[Pull], about: Vector = (0.0, 0.0)) -> tuple[Number, Number, Number]:
    """Force (x, y) and moment about a place of all pulls together."""
    x: Number = 0.0
    y: Number = 0.0
    moment: Number = 0.0
    for pull in pulls:
        x, y = x + pull.force[0], y + pull.force[1]
        moment = moment + pull.moment_about(about)
    return x, y, moment


def on_frame(body: Entity, fixed: Iterable[str]) -> bool:
    """Whether a body is the frame or one of its points."""
    return body == Entity("link", FRAME) or (body.kind == "point" and body.name in fixed)
