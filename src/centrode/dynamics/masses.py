"""Masses of the links: mass, centre of mass and central moment of inertia, from what the description gives."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from math import dist
from typing import Any, TypeAlias

from centrode.algebra.arrays import ARRAYS
from centrode.dynamics.bodies import Centre, Given, LinkNumbers, Local, Mass, Number, Radial, is_none
from centrode.dynamics.solids import Reader as SolidReader
from centrode.dynamics.solids import solids_of
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import FRAME, Mechanism, Vector

__all__ = ["Centre", "Given", "Mass", "centre_of", "masses_of", "massless_links"]

Namespace: TypeAlias = Any

STRAIGHT = 1e-9
"""Points of a rod may lie off its line by this share of its length: coordinates are given in decimals."""


def masses_of(mechanism: Mechanism, given: Given | None = None, m: Namespace = ARRAYS) -> tuple[Mass, ...]:
    """Links that have mass or inertia, in description order; the others are massless.

    `m` has the functions of the numbers given.

    Raises
    ------
    InputError
        A mass whose centre, or whose inertia although its link turns, nothing tells.
    """
    if mechanism.space == "sphere":
        return solids_of(mechanism, given or {}, m)
    still = _links_that_do_not_turn(mechanism)
    found = []
    for name, link in mechanism.links.items():
        reader = _Reader(name, link, given or {})
        mass, inertia = reader.number("mass", link.mass or 0.0), reader.inertia(name in still)
        if is_none(mass) and is_none(inertia):
            continue
        first = next(iter(link.coordinates))
        centre = Centre(name, first, 0.0, 0.0) if is_none(mass) else reader.centre()
        found.append(Mass(name, mass, centre, inertia))
    return tuple(found)


def centre_of(
    mechanism: Mechanism, link: str, given: Given | None = None, m: Namespace = ARRAYS
) -> Centre | Radial:
    """Centre of mass of a link: given, the only point, or by its shape; InputError where nothing tells it."""
    if mechanism.space == "sphere":
        return SolidReader(link, mechanism.links[link], given or {}, mechanism.sphere_radius, m).centre()
    return _Reader(link, mechanism.links[link], given or {}).centre()


def has_masses_or_loads(mechanism: Mechanism) -> bool:
    """Whether a description has anything for dynamics."""
    return bool(mechanism.loads) or any(link.mass or link.inertia for link in mechanism.links.values())


def massless_links(mechanism: Mechanism) -> tuple[str, ...]:
    """Links without mass and without inertia."""
    heavy = {mass.link for mass in masses_of(mechanism)}
    return tuple(name for name in mechanism.links if name not in heavy)


def _links_that_do_not_turn(mechanism: Mechanism) -> set[str]:
    """Links that prismatic pairs tie to the frame's directions, one behind another."""
    still = {FRAME}
    grown = True
    while grown:
        ties = [(guide.on, guide.link) for guide in mechanism.guides if guide.link is not None]
        more = {name for pair in ties if still & set(pair) for name in pair}
        grown = not more <= still
        still |= more
    return still


@dataclass(frozen=True)
class _Reader(LinkNumbers):
    """Masses of one planar link."""

    @property
    def local(self) -> Local:
        """Places of the points in the link's own axes."""
        if self.link.length is not None:
            first, second = self.link.coordinates
            return {first: (0.0, 0.0), second: (self.number("length", self.link.length), 0.0)}
        return {
            point: (self.number(f"points.{point}.x", x), self.number(f"points.{point}.y", y))
            for point, (x, y) in self.link.coordinates.items()
        }

    def centre(self) -> Centre:
        given, link = self.link.centre, self.link
        if link.shape == "rod":
            return self._middle(given)
        if isinstance(given, str):
            return Centre(self.name, given, 0.0, 0.0)
        if given is not None:
            base, (x, y) = next(iter(self.local.items()))
            at = self.number("centre.x", given[0]), self.number("centre.y", given[1])
            return Centre(self.name, base, at[0] - x, at[1] - y)
        if len(link.coordinates) == 1:
            return Centre(self.name, next(iter(link.coordinates)), 0.0, 0.0)
        if len(link.coordinates) == 2 and link.shape is None:
            return self._middle(None)
        raise InputError(
            self.where, _("nothing says where its centre of mass is"), _("give centre, or shape")
        )

    def _middle(self, given: str | Vector | None) -> Centre:
        first, second = self.ends()
        (x, y), (u, v) = (self.link.coordinates[end] for end in (first, second))
        at = self.link.coordinates[given] if isinstance(given, str) else given
        if at is not None and dist(at, ((x + u) / 2, (y + v) / 2)) > STRAIGHT * dist((x, y), (u, v)):
            what = _("the centre of a rod is its middle")
            raise InputError(self.where, what, _("take centre out, or give inertia in place of shape"))
        (x, y), (u, v) = (self.local[end] for end in (first, second))
        return Centre(self.name, first, 0.5 * (u - x), 0.5 * (v - y))

    def inertia(self, still: bool) -> Number:
        """Central moment of inertia: given, by the shape, or none where it cannot matter."""
        link = self.link
        if link.inertia is not None:
            assert not isinstance(link.inertia, tuple)
            return self.number("inertia", link.inertia)
        mass = self.number("mass", link.mass or 0.0)
        if link.shape is not None and link.mass is None:
            what = _("it has a shape, but no mass")
            raise InputError(self.where, what, _("give mass, or take shape out"))
        if link.shape in ("disc", "ring"):
            if link.radius is None:
                what = _("a {shape} needs a radius").format(shape=link.shape)
                raise InputError(self.where, what, _("give radius, or inertia"))
            radius = self.number("radius", link.radius)
            return mass * radius * radius / (2.0 if link.shape == "disc" else 1.0)
        if link.shape == "rod":
            (x, y), (u, v) = (self.local[end] for end in self.ends())
            return mass * ((u - x) * (u - x) + (v - y) * (v - y)) / 12.0
        if not is_none(mass) and not still:
            what = _("it has a mass and turns, but no moment of inertia")
            raise InputError(self.where, what, _("give inertia (0 for a mass in one point), or shape"))
        return 0.0

    def ends(self) -> tuple[str, str]:
        """The points between which a rod reaches: the two farthest, all others on their line."""
        places = self.link.coordinates
        pairs = list(combinations(places, 2))
        if not pairs:
            what = _("a rod lies between two points, and this link has one")
            raise InputError(self.where, what, _("give centre and inertia in place of shape"))
        first, second = max(pairs, key=lambda pair: dist(places[pair[0]], places[pair[1]]))
        (x, y), (u, v) = places[first], places[second]
        for at in places.values():
            if abs((at[0] - x) * (v - y) - (at[1] - y) * (u - x)) > STRAIGHT * dist((x, y), (u, v)) ** 2:
                what = _("a rod is straight, but the points of this link do not lie on one line")
                raise InputError(self.where, what, _("give centre and inertia in place of shape"))
        return first, second
