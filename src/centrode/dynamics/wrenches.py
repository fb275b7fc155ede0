"""Forces and moments on points and links: what every load, constraint and inertia comes down to."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

from centrode.geometry import sphere
from centrode.structure.constraints import FRAME, Entity

Number: TypeAlias = Any
Vector: TypeAlias = tuple[Number, ...]
"""Components along the axes of the space: two, on the sphere three."""
Moment: TypeAlias = Any
"""A number in the plane, a vector on the sphere; a plain zero is none in both."""
NO_FORCE: Vector = (0.0, 0.0)
NOWHERE: Vector = (0.0, 0.0, 0.0)


class Wrench(NamedTuple):
    """A force at a place, and a moment, on one body.

    Attributes
    ----------
    body : a point (a pin), or a link, the frame included
    force : (x, y), on the sphere (x, y, z) [N]
    at : (x, y), on the sphere (x, y, z) [m]
        Where the force acts, as a place of that body.
    moment : number, on the sphere a vector [N m]
        A couple that comes on top; points take none.
    """

    body: Entity
    force: Vector
    at: Vector
    moment: Moment = 0.0

    def times(self, factor: Number) -> Wrench:
        """The wrench multiplied by a number."""
        force = tuple(_product(x, factor) for x in self.force)
        moment = self.moment
        turned = tuple(x * factor for x in moment) if isinstance(moment, tuple) else _product(moment, factor)
        return Wrench(self.body, force, self.at, turned)

    def moment_about(self, place: Vector) -> Moment:
        """Moment of the force about a place, and the couple [N m]."""
        if len(self.force) == 2:
            if self.at is place:
                # a force turns nothing about the place where it acts, be it known or not
                return self.moment
            along, across = self.force
            (x, y), (u, v) = self.at, place
            # plain zeros, of which couples and rows of hinges are full, cost nothing
            turned = 0.0 if _is_zero(across) else (x - u) * across
            turned = turned if _is_zero(along) else turned - (y - v) * along
            return turned if _is_zero(self.moment) else turned + self.moment
        x, y, z = self.at
        u, v, w = place
        turned = sphere.cross((x - u, y - v, z - w), (self.force[0], self.force[1], self.force[2]))
        return sphere.add(turned, self.moment) if isinstance(self.moment, tuple) else turned


def _is_zero(number: Number) -> bool:
    return isinstance(number, float) and number == 0.0


def _product(number: Number, factor: Number) -> Number:
    """A plain zero, of which rows are full, stays one and costs nothing."""
    return number if _is_zero(number) else number * factor


def on_point(point: str, force: Vector, at: Vector) -> Wrench:
    """A force on a pin."""
    return Wrench(Entity("point", point), force, at)


def on_link(link: str, force: Vector, at: Vector) -> Wrench:
    """A force on a link."""
    return Wrench(Entity("link", link), force, at)


def couple(link: str, moment: Moment) -> Wrench:
    """A moment on a link."""
    none = NOWHERE if isinstance(moment, tuple) else NO_FORCE
    return Wrench(Entity("link", link), none, none, moment)


def plus(summed: Number, number: Number) -> Number:
    """A sum with one number more; a plain zero, of which forces of hinges are full, costs nothing."""
    if _is_zero(number):
        return summed
    return number if _is_zero(summed) else summed + number


@dataclass(frozen=True)
class Resultant:
    """Wrenches with their moments about one place, and what they come to together.

    Attributes
    ----------
    pulls : all wrenches
    moments : of each about the place
    force, moment : of all together
    """

    pulls: Sequence[Wrench]
    moments: Sequence[Moment]
    force: Vector
    moment: Moment

    @classmethod
    def of(cls, pulls: Sequence[Wrench], about: Vector) -> Resultant:
        """The resultant about a place."""
        moments = [pull.moment_about(about) for pull in pulls]
        force: list[Number] = [0.0] * len(about)
        moment: Moment = 0.0 if len(about) == 2 else NOWHERE
        for pull, turned in zip(pulls, moments, strict=True):
            force = [plus(x, y) for x, y in zip(force, pull.force, strict=True)]
            moment = sphere.add(moment, turned) if isinstance(moment, tuple) else plus(moment, turned)
        return cls(pulls, moments, tuple(force), moment)


def components(moment: Moment) -> Vector:
    """The numbers of a moment: one, or three."""
    return moment if isinstance(moment, tuple) else (moment,)


def on_frame(body: Entity, fixed: Iterable[str]) -> bool:
    """Whether a body is the frame or one of its points."""
    return body == Entity("link", FRAME) or (body.kind == "point" and body.name in fixed)
