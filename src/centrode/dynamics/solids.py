"""Masses of spherical links: centre of mass, and inertia about it as mass spread along three directions.

The energy of rotation is half the sum of p_k |u_k'|^2 over the directions u_k of the principal axes, with
p_k = (I_i + I_j - I_k)/2: squares without cancellation, none of them negative exactly if the tensor is one of a body.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Any, TypeAlias

from centrode.dynamics.bodies import (
    About,
    Given,
    LinkNumbers,
    Local,
    Mass,
    Number,
    Radial,
    Spread,
    Vector3,
    is_none,
)
from centrode.errors import InputError
from centrode.geometry.sphere import add, basis, cross, dot, half_arc, subtract, times, unit_vector
from centrode.locale import _
from centrode.model import sphere
from centrode.model.bodies import RING_AND_POINT
from centrode.model.mechanism import Mechanism
from centrode.model.tensors import principal, tensor_of

Namespace: TypeAlias = Any

STRAIGHT = 1e-9
"""Points of an arc may lie off its great circle by this: coordinates are given in decimals."""


def solids_of(mechanism: Mechanism, given: Given, m: Namespace) -> tuple[Mass, ...]:
    """Links of a spherical mechanism that have mass or inertia; raises InputError for what is not complete."""
    found = []
    for name, link in mechanism.links.items():
        reader = Reader(name, link, given, mechanism.sphere_radius, m)
        mass, inertia = reader.mass, reader.inertia()
        if is_none(mass) and not inertia:
            continue
        centre = Radial(name, (1.0, 0.0, 0.0), 0.0) if is_none(mass) else reader.centre()
        found.append(Mass(name, mass, centre, inertia))
    return tuple(found)


@dataclass(frozen=True)
class Reader(LinkNumbers):
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
            self.where, _("nothing says where its centre of mass is"), _("give centre, or shape")
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
            raise InputError(self.where, what, _("give mass, or take shape out"))
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
        share = self.mass * radius * radius / (4.0 if self.link.shape == "disc" else 2.0)
        return tuple(Spread(share, axis) for axis in basis(self.m, self._direction()))

    def _middle(self) -> Radial:
        """Centre of mass of a thin arc: nearer to the centre of the sphere than the arc."""
        if self.link.centre is not None or self.link.centre_radius is not None:
            what = _("the centre of an arc is that of its shape")
            raise InputError(self.where, what, _("take centre and centre_radius out, or give inertia"))
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
        middle, across = times(0.5 / cosine, add(one, other)), times(0.5 / sine, subtract(other, one))
        return sine, self.m.atan2(sine, cosine), middle, across

    def _ends(self) -> tuple[str, str]:
        """The points between which an arc reaches: the two farthest, all others on their great circle."""
        places = {point: sphere.unit_vector(at) for point, at in self.link.coordinates.items()}
        pairs = list(combinations(places, 2))
        if not pairs:
            what = _("an arc lies between two points, and this link has one")
            raise InputError(self.where, what, _("give centre and inertia in place of shape"))
        first, second = max(pairs, key=lambda pair: sphere.arc(places[pair[0]], places[pair[1]]))
        if not sphere.makes_arc(places[first], places[second]):
            what = _("its farthest points lie opposite, so that no one arc joins them")
            raise InputError(self.where, what, _("give centre and inertia in place of shape"))
        normal = cross(places[first], places[second])
        middle = add(places[first], places[second])
        for at in places.values():
            if abs(dot(at, normal)) > STRAIGHT or dot(at, middle) < 0.0:
                what = _("an arc is part of a great circle, but the points of this link do not lie on one")
                raise InputError(self.where, what, _("give centre and inertia in place of shape"))
        return first, second
