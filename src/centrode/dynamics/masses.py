"""Masses of the links: mass, centre of mass and central moment of inertia, from what the description gives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations
from math import dist, hypot

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.bodies import Link
from centrode.model.mechanism import FRAME, Mechanism, Vector

STRAIGHT = 1e-9
"""Points of a rod may lie off its line by this share of its length: coordinates are given in decimals."""


@dataclass(frozen=True)
class Mass:
    """Mass [kg], centre in the link's own axes [m], moment of inertia about it [kg m^2] of one link."""

    link: str
    mass: float
    centre: Vector
    inertia: float


def masses_of(mechanism: Mechanism) -> tuple[Mass, ...]:
    """Links that have mass or inertia, in description order; the others are massless.

    Raises
    ------
    InputError
        A mass whose centre, or whose inertia although its link turns, nothing tells.
    """
    still = _links_that_do_not_turn(mechanism)
    found = []
    for name, link in mechanism.links.items():
        mass, inertia = link.mass or 0.0, _inertia(name, link, name in still)
        if mass or inertia:
            found.append(Mass(name, mass, centre_of(name, link) if mass else (0.0, 0.0), inertia))
    return tuple(found)


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


def centre_of(name: str, link: Link) -> Vector:
    """Centre of mass in the link's own axes [m]: given, the only point, or the middle of a rod.

    Raises InputError where nothing tells it.
    """
    where = f"[links.{name}]"
    given = link.coordinates[link.centre] if isinstance(link.centre, str) else link.centre
    if link.shape == "rod":
        middle, length = _rod(name, link)
        if given is not None and dist(given, middle) > STRAIGHT * length:
            what = _("the centre of a rod is its middle")
            raise InputError(where, what, _("take centre out, or give inertia in place of shape"))
        return middle
    if given is not None:
        return given
    if len(link.coordinates) == 1:
        return next(iter(link.coordinates.values()))
    raise InputError(where, _("nothing says where its centre of mass is"), _("give centre, or shape"))


def _inertia(name: str, link: Link, still: bool) -> float:
    """Central moment of inertia: given, by the shape, or none where it cannot matter."""
    where, mass = f"[links.{name}]", link.mass or 0.0
    if link.inertia is not None:
        return link.inertia
    if link.shape is not None and link.mass is None:
        what = _("it has a shape, but no mass")
        raise InputError(where, what, _("give mass, or take shape out"))
    if link.shape == "disc":
        if link.radius is None:
            raise InputError(where, _("a disc needs a radius"), _("give radius, or inertia"))
        return mass * link.radius**2 / 2.0
    if link.shape == "rod":
        return mass * _rod(name, link)[1] ** 2 / 12.0
    if mass and not still:
        what = _("it has a mass and turns, but no moment of inertia")
        raise InputError(where, what, _("give inertia (0 for a mass in one point), or shape"))
    return 0.0


def _rod(name: str, link: Link) -> tuple[Vector, float]:
    """Middle and length of a rod: it reaches between the two farthest of its points, all on one line."""
    places: Mapping[str, Vector] = link.coordinates
    pairs = list(combinations(places.values(), 2))
    if not pairs:
        what = _("a rod lies between two points, and this link has one")
        raise InputError(f"[links.{name}]", what, _("give centre and inertia in place of shape"))
    (x, y), (u, v) = max(pairs, key=lambda pair: dist(*pair))
    length = hypot(u - x, v - y)
    for at in places.values():
        if abs((at[0] - x) * (v - y) - (at[1] - y) * (u - x)) > STRAIGHT * length**2:
            what = _("a rod is straight, but the points of this link do not lie on one line")
            raise InputError(f"[links.{name}]", what, _("give centre and inertia in place of shape"))
    return ((x + u) / 2.0, (y + v) / 2.0), length
