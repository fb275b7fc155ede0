"""Masses of the links: mass, centre of mass and central moment of inertia, from what the description gives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import dist
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.state import (
    About,
    Centre,
    Given,
    LinkNumbers,
    Local,
    Mass,
    Number,
    Radial,
    Spread,
    State,
    Vector3,
    is_none,
)
from centrode.errors import InputError
from centrode.geometry.sphere import add, basis, cross, dot, half_arc, subtract, times, unit_vector
from centrode.locale import _
from centrode.model import values
from centrode.model.links import RING_AND_POINT
from centrode.model.mechanism import FRAME, Mechanism, Vector
from centrode.model.values import principal, tensor_of
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet

# Masses of spherical links: centre of mass, and inertia about it as mass spread along three directions.
#
# The energy of rotation is half the sum of p_k |u_k'|^2 over the directions u_k of the principal axes, with
# p_k = (I_i + I_j - I_k)/2: squares without cancellation, none of them negative exactly if the tensor is one
# of a body.

Namespace: TypeAlias = Any

STRAIGHT = 1e-9
"""Points of an arc may lie off its great circle by this: coordinates are given in decimals."""


def solid_of(mechanism: Mechanism, name: str, given: Given, m: Namespace) -> Mass | None:
    """Mass of a link on the sphere; None of a massless one, InputError for what is not complete."""
    reader = InertiaReader(name, mechanism.links[name], given, mechanism.sphere_radius, m)
    mass, inertia = reader.mass, reader.inertia()
    if is_none(mass) and not inertia:
        return None
    # inertia without mass: the centre does not move anything
    centre = Radial(name, (1.0, 0.0, 0.0), 0.0) if is_none(mass) else reader.centre()
    return Mass(name, mass, centre, inertia)


@dataclass(frozen=True)
class InertiaReader(LinkNumbers):
    """Masses of one spherical link; `m` has the functions for its numbers."""

    sphere_radius: float
    m: Namespace

    @property
    def mass(self) -> Number:
        return self.number("mass", self.link.mass or 0.0)

    @property
    def local(self) -> Local:
        """Longitude and latitude of the points in the link's own axes."""
        if self.link.length is not None:
            first, second = self.link.coordinates
            return {first: (0.0, 0.0), second: (self.number("length", self.link.length), 0.0)}
        return {
            point: (self.number(f"points.{point}.longitude", x), self.number(f"points.{point}.latitude", y))
            for point, (x, y) in self.link.coordinates.items()
        }

    def centre(self) -> Radial:
        """Where the mass is."""
        if self.link.shape == "arc":
            return self._middle()
        given = self.link.centre_radius
        distance = self.sphere_radius if given is None else self.number("centre_radius", given)
        return Radial(self.name, self._direction(), distance)

    def _direction(self) -> Vector3:
        """Direction of the centre of mass in the link's own axes."""
        given, link = self.link.centre, self.link
        if isinstance(given, str):
            return unit_vector(self.m, self.local[given])
        if given is not None:
            at = self.number("centre.longitude", given[0]), self.number("centre.latitude", given[1])
            return unit_vector(self.m, at)
        if len(link.coordinates) == 1:
            return unit_vector(self.m, next(iter(self.local.values())))
        if len(link.coordinates) == 2 and link.shape is None and link.model is None:
            return self._sector()[2]
        raise InputError(
            self.where, _("the position of its centre of mass is not given"), _("give centre, or shape")
        )

    def inertia(self) -> tuple[Spread | About, ...]:
        """Parts of the inertia: given, or by the shape; raises InputError where nothing tells them."""
        link = self.link
        if link.model == RING_AND_POINT:
            return self._ring()
        if link.inertia is not None:
            return self._tensor()
        if link.shape is None:
            if is_none(self.mass):
                return ()
            what = _("it has a mass and turns, but no inertia")
            raise InputError(self.where, what, _("give inertia (0 for a mass in one point), or shape"))
        if link.mass is None:
            what = _("it has a shape, but no mass")
            raise InputError(self.where, what, _("give mass, or remove shape"))
        return self._arc() if link.shape == "arc" else self._round()

    def _ring(self) -> tuple[About, ...]:
        own = self.link.inertia
        if isinstance(own, tuple):
            what = _("a ring has one moment of inertia, about the axis through its centre")
            raise InputError(self.where, what, _("give inertia as one number"))
        inertia = self.number("inertia", own or 0.0)
        return () if is_none(inertia) else (About(inertia, self._direction()),)

    def _tensor(self) -> tuple[Spread, ...]:
        own = self.link.inertia
        assert own is not None
        if not isinstance(own, tuple):
            # equal moments about all axes: each direction has half of one, as an axis is the sum of two
            # others
            each = 0.5 * self.number("inertia", own)
            axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
            return () if is_none(each) else tuple(Spread(each, axis) for axis in axes)
        moments, rows = principal(tensor_of(own))
        # what decimals or rounding make of a plane body or a rod may be less than nothing
        spreads = [max(0.0, 0.5 * sum(moments) - moment) for moment in moments]
        parts = [Spread(x, (u[0], u[1], u[2])) for x, u in zip(spreads, rows, strict=True) if x]
        return tuple(parts)

    def _round(self) -> tuple[Spread, ...]:
        """A thin disc or ring square to the direction of its centre."""
        if self.link.radius is None:
            what = _("a {shape} needs a radius").format(shape=self.link.shape)
            raise InputError(self.where, what, _("give radius, or inertia"))
        radius = self.number("radius", self.link.radius)
        # the sum of m x^2 along a diameter: m r^2 / 4 of a disc, m r^2 / 2 of a ring; none across
        share = self.mass * radius * radius / (4.0 if self.link.shape == "disc" else 2.0)
        return tuple(Spread(share, axis) for axis in basis(self.m, self._direction()))

    def _middle(self) -> Radial:
        """Centre of mass of a thin arc: nearer to the centre of the sphere than the arc."""
        if self.link.centre is not None or self.link.centre_radius is not None:
            what = _("the centre of an arc is that of its shape")
            raise InputError(self.where, what, _("remove centre and centre_radius, or give inertia"))
        sine, half, middle, _across = self._sector()
        return Radial(self.name, middle, self.sphere_radius * sine / half)

    def _arc(self) -> tuple[Spread, ...]:
        """A thin arc: of the angle 2 h, the mean of cos^2 is (1 + sin 2h/(2h))/2 and that of cos is sin h/h."""
        sine, half, middle, across = self._sector()
        # products and not powers: those of expressions are products
        size = self.mass * self.sphere_radius * self.sphere_radius
        share, mean = self.m.sin(2.0 * half) / (4.0 * half), sine / half
        return Spread(size * (0.5 + share - mean * mean), middle), Spread(size * (0.5 - share), across)

    def _sector(self) -> tuple[Number, Number, Vector3, Vector3]:
        """Sine of half the arc, half the arc, direction of its middle, and across to it along the arc."""
        first, second = self._ends()
        one, other = (unit_vector(self.m, self.local[end]) for end in (first, second))
        sine, cosine = half_arc(self.m, self.local[first], self.local[second])
        # sum and difference of two unit vectors are 2 cos h and 2 sin h long
        middle, across = times(0.5 / cosine, add(one, other)), times(0.5 / sine, subtract(other, one))
        return sine, self.m.atan2(sine, cosine), middle, across

    def _ends(self) -> tuple[str, str]:
        """The points between which an arc reaches: the two farthest, all others on their great circle."""
        places = {point: values.unit_vector(at) for point, at in self.link.coordinates.items()}
        pairs = list(combinations(places, 2))
        if not pairs:
            what = _("an arc lies between two points, and this link has one")
            raise InputError(self.where, what, _("give centre and inertia in place of shape"))
        first, second = max(pairs, key=lambda pair: values.arc(places[pair[0]], places[pair[1]]))
        if not values.makes_arc(places[first], places[second]):
            what = _("its farthest points are diametrically opposite, so the arc between them is not unique")
            raise InputError(self.where, what, _("give centre and inertia in place of shape"))
        normal = cross(places[first], places[second])
        middle = add(places[first], places[second])
        for at in places.values():
            # on the great circle of the ends, and on the side of their middle
            if abs(dot(at, normal)) > STRAIGHT or dot(at, middle) < 0.0:
                what = _("an arc is part of a great circle, but the points of this link do not lie on one")
                raise InputError(self.where, what, _("give centre and inertia in place of shape"))
        return first, second


def masses_of(mechanism: Mechanism, given: Given | None = None, m: Namespace = ARRAYS) -> tuple[Mass, ...]:
    """Links that have mass or inertia, in description order; the others are massless.

    `m` has the functions of the numbers given.

    Raises
    ------
    InputError
        A mass whose centre, or whose inertia although its link turns, nothing tells.
    """
    still = _links_that_do_not_turn(mechanism)
    masses = (_mass_of(mechanism, name, still, given or {}, m) for name in mechanism.links)
    return tuple(mass for mass in masses if mass is not None)


def _mass_of(mechanism: Mechanism, name: str, still: set[str], given: Given, m: Namespace) -> Mass | None:
    """Mass of a link; None of a massless one, InputError for what is not complete."""
    if mechanism.space == "sphere":
        return solid_of(mechanism, name, given, m)
    link = mechanism.links[name]
    reader = _MassReader(name, link, given)
    if link.masses:
        return reader.of_parts(still=name in still)
    mass, inertia = reader.number("mass", link.mass or 0.0), reader.inertia(name in still)
    if is_none(mass) and is_none(inertia):
        return None
    first = next(iter(link.coordinates))
    centre = Centre(name, first, 0.0, 0.0) if is_none(mass) else reader.centre()
    return Mass(name, mass, centre, inertia)


def centre_of(
    mechanism: Mechanism, link: str, given: Given | None = None, m: Namespace = ARRAYS
) -> Centre | Radial:
    """Centre of mass of a link: given, the only point, or by its shape; InputError where nothing tells it."""
    if mechanism.links[link].masses:
        return _MassReader(link, mechanism.links[link], given or {}).of_parts(still=True).centre
    if mechanism.space == "sphere":
        return InertiaReader(link, mechanism.links[link], given or {}, mechanism.sphere_radius, m).centre()
    return _MassReader(link, mechanism.links[link], given or {}).centre()


def has_masses_or_loads(mechanism: Mechanism) -> bool:
    """Whether a description has anything for dynamics."""
    links = mechanism.links.values()
    return bool(mechanism.loads) or any(link.mass or link.inertia or link.masses for link in links)


@dataclass(frozen=True)
class LinkMasses:
    """Masses that the description gives the links of a mechanism.

    Attributes
    ----------
    mechanism : the mechanism
    masses : of the links whose mass is known [kg, m, kg m^2]
    massless : names of the links without mass and without inertia
    incomplete : link -> what its mass lacks
    """

    mechanism: Mechanism
    masses: tuple[Mass, ...]
    massless: tuple[str, ...]
    incomplete: Mapping[str, InputError]


def link_masses(mechanism: Mechanism) -> LinkMasses:
    """Masses of the links, each for itself: one that lacks its centre or its inertia leaves the others as they are."""
    still = _links_that_do_not_turn(mechanism)
    masses: list[Mass] = []
    massless: list[str] = []
    incomplete: dict[str, InputError] = {}
    for name in mechanism.links:
        try:
            mass = _mass_of(mechanism, name, still, {}, ARRAYS)
        except InputError as reason:
            incomplete[name] = reason
            continue
        if mass is None:
            massless.append(name)
        else:
            masses.append(mass)
    return LinkMasses(mechanism, tuple(masses), tuple(massless), incomplete)


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
        # a tie holds in both senses: what is guided on a body that does not turn does not turn, and the other
        # way round
        more = {name for pair in ties if still & set(pair) for name in pair}
        grown = not more <= still
        still |= more
    return still


@dataclass(frozen=True)
class _MassReader(LinkNumbers):
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

    def of_parts(self, still: bool) -> Mass:
        """Several masses as one: their sum, their common centre, and by parallel axes the inertia about it."""
        base, (x, y) = next(iter(self.local.items()))
        parts: list[tuple[Number, Number, Number, Number]] = []
        if self.link.mass is not None or self.link.inertia is not None:
            own = self.centre() if self.link.mass else Centre(self.name, base, 0.0, 0.0)
            u, v = self.local[own.base]
            mass = self.number("mass", self.link.mass or 0.0)
            parts.append((mass, u - x + own.along, v - y + own.across, self.inertia(still)))
        for part in self.link.masses:
            u, v = self.local[part.at] if isinstance(part.at, str) else part.at
            parts.append((part.mass, u - x, v - y, part.inertia))
        whole = sum(mass for mass, _u, _v, _own in parts)
        if is_none(whole):
            return Mass(self.name, whole, Centre(self.name, base, 0.0, 0.0), sum(part[3] for part in parts))
        along = sum(mass * u for mass, u, _v, _own in parts) / whole
        across = sum(mass * v for mass, _u, v, _own in parts) / whole
        inertia = sum(
            own + mass * ((u - along) * (u - along) + (v - across) * (v - across))
            for mass, u, v, own in parts
        )
        return Mass(self.name, whole, Centre(self.name, base, along, across), inertia)

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
            self.where, _("the position of its centre of mass is not given"), _("give centre, or shape")
        )

    def _middle(self, given: str | Vector | None) -> Centre:
        first, second = self.ends()
        (x, y), (u, v) = (self.link.coordinates[end] for end in (first, second))
        at = self.link.coordinates[given] if isinstance(given, str) else given
        # a centre that is given may only repeat what the shape says
        if at is not None and dist(at, ((x + u) / 2, (y + v) / 2)) > STRAIGHT * dist((x, y), (u, v)):
            what = _("the centre of a rod is its middle")
            raise InputError(self.where, what, _("remove centre, or give inertia in place of shape"))
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
            raise InputError(self.where, what, _("give mass, or remove shape"))
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
            # the distance from the line, over the rod's length
            if abs((at[0] - x) * (v - y) - (at[1] - y) * (u - x)) > STRAIGHT * dist((x, y), (u, v)) ** 2:
                what = _("a rod is straight, but the points of this link do not lie on one line")
                raise InputError(self.where, what, _("give centre and inertia in place of shape"))
        return first, second


# Kinetic energy: reduced inertia of one drive, inertia matrix of several, each link's share.

Array: TypeAlias = npt.NDArray[np.float64]


def coordinates_of(state: State, mass: Mass) -> list[tuple[Number, Jet]]:
    """Coordinates whose squared speeds make twice the kinetic energy of a link, each with its factor [kg or kg m^2]."""
    coordinates = [(mass.mass, x) for x in state.centre(mass.centre)] if mass.weighs else []
    if not mass.resists:
        return coordinates
    if not isinstance(mass.inertia, tuple):
        return [*coordinates, (mass.inertia, state.angle(mass.link))]
    for part in mass.inertia:
        if isinstance(part, About):
            coordinates.append((part.moment, state.turned_about(mass.link, part.direction)))
        else:
            coordinates += [(part.moment, x) for x in state.heading(mass.link, part.direction)]
    return coordinates


def shares(state: State, masses: Sequence[Mass], shape: tuple[int, ...]) -> tuple[Array, Array]:
    """Reduced inertia of each link and its derivative by the parameter, (links, *shape).

    J = m (x'^2 + y'^2) + I phi'^2, J' = 2 m (x' x'' + y' y'') + 2 I phi' phi''.
    """
    inertia, slope = np.zeros((len(masses), *shape)), np.zeros((len(masses), *shape))
    for k, mass in enumerate(masses):
        inertia[k], slope[k] = share(state, mass)
    return inertia, slope


def share(state: State, mass: Mass) -> tuple[Number, Number]:
    """Reduced inertia of one link and its derivative, over arrays or expressions."""
    inertia: Number = 0.0
    slope: Number = 0.0
    for factor, coordinate in coordinates_of(state, mass):
        first, second = coordinate.derivative(1), coordinate.derivative(2)
        inertia = inertia + factor * (first * first)
        slope = slope + factor * (2.0 * (first * second))
    return inertia, slope
