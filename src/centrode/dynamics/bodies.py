"""What a mass is to the computation: centre of mass and inertia about it, in the plane and on the sphere."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.model.bodies import Link

Number: TypeAlias = Any
Local: TypeAlias = Mapping[str, tuple[Number, Number]]
Given: TypeAlias = Mapping[str, Number]
"""Numbers by their paths ("links.AB.mass") in place of the description's own."""
Vector3: TypeAlias = tuple[Number, Number, Number]


@dataclass(frozen=True)
class Centre:
    """A centre of mass in the plane: a point of the link, and the way from there in the link's own axes [m]."""

    link: str
    base: str
    along: Number
    across: Number


@dataclass(frozen=True)
class Radial:
    """A centre of mass of a spherical link: a direction in the link's own axes, and how far from the centre [m]."""

    link: str
    direction: Vector3
    distance: Number


@dataclass(frozen=True)
class Spread:
    """Mass spread about the centre of mass along a direction of the link's axes: the sum of m x^2 [kg m^2].

    Three of them, square to each other, are a tensor of inertia: about the axis k it is the sum of the two others.
    """

    moment: Number
    direction: Vector3


@dataclass(frozen=True)
class About:
    """Inertia [kg m^2] about one axis of the link alone, the ring of "ring and point mass"."""

    moment: Number
    direction: Vector3


@dataclass(frozen=True)
class Mass:
    """Mass [kg], centre, and inertia about it of one link; numbers may be those of a batch.

    In the plane the inertia is a moment [kg m^2], on the sphere it has parts.
    """

    link: str
    mass: Number
    centre: Centre | Radial
    inertia: Number | tuple[Spread | About, ...]

    @property
    def weighs(self) -> bool:
        """Whether it has mass, and not only inertia."""
        return not is_none(self.mass)

    @property
    def planar_centre(self) -> Centre:
        """The centre of mass of a planar link."""
        assert isinstance(self.centre, Centre)
        return self.centre

    @property
    def moment_of_inertia(self) -> Number:
        """The inertia of a planar link [kg m^2]."""
        assert not isinstance(self.inertia, tuple)
        return self.inertia

    @property
    def resists(self) -> bool:
        """Whether it has a moment of inertia."""
        return self.inertia != () if isinstance(self.inertia, tuple) else not is_none(self.inertia)


@dataclass(frozen=True)
class LinkNumbers:
    """The numbers of one link, those of a batch (by their paths in `given`) where they vary."""

    name: str
    link: Link
    given: Given

    @property
    def where(self) -> str:
        """What messages call it."""
        return f"[links.{self.name}]"

    def number(self, key: str, own: float) -> Number:
        """The number under a key, `own` where it does not vary."""
        return self.given.get(f"links.{self.name}.{key}", float(own))


def is_none(value: Number) -> bool:
    """Whether a number is a plain zero, and not one that may vary."""
    return isinstance(value, float) and value == 0.0
