"""Gears as constraints: the angles of two wheels and their carrier."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.algebra.plain import PLAIN
from centrode.locale import _
from centrode.structure.dimensions import Dimensions
from centrode.structure.positions import FRAME, Entity, Positions, Row

Number: TypeAlias = Any
Namespace: TypeAlias = Any


@dataclass(frozen=True)
class GearRatio:
    """Two links turn against a carrier in a constant ratio: (b - c) - i (a - c) stays what it is."""

    gear: str
    first: str
    second: str
    carrier: str
    size = 1
    angular = True

    @property
    def bodies(self) -> tuple[Entity, ...]:
        return tuple(Entity("link", name) for name in self.links)

    @property
    def links(self) -> tuple[str, str, str]:
        """First wheel, second wheel, carrier."""
        return self.first, self.second, self.carrier

    @property
    def label(self) -> str:
        return _("gear {gear}").format(gear=self.gear)

    def weights(self, numbers: Dimensions) -> dict[str, Number]:
        """Link -> factor of its angle in the equation."""
        ratio = numbers.gearing.ratio[self.gear]
        first, second = numbers.gearing.shares.get(self.gear, (1.0, 1.0))
        return {self.first: -ratio, self.second: 1.0, self.carrier: ratio * first - second}

    def constant(self, m: Namespace, numbers: Dimensions, at: Positions) -> Number:
        """What the equation's left side is at positions whose angles are known [rad]."""
        carrier = at.angles[self.carrier]
        ratio = numbers.gearing.ratio[self.gear]
        first, second = numbers.gearing.shares.get(self.gear, (1.0, 1.0))
        return (at.angles[self.second] - second * carrier) - ratio * (at.angles[self.first] - first * carrier)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        return [self.constant(m, numbers, at) - numbers.gearing.phase[self.gear]]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        row: Row = {}
        for link, factor in self.weights(numbers).items():
            base = numbers.gearing.measured.get(link, FRAME)
            for body, slope in zip((link, base), _slopes(numbers, at, link, base), strict=True):
                entity, before = Entity("link", body), row.get(Entity("link", body), (0.0, 0.0, 0.0))
                row[entity] = tuple(old + factor * x for old, x in zip(before, slope, strict=True))
        return [{entity: slope for entity, slope in row.items() if entity.name in self.links}]


def _slopes(numbers: Dimensions, at: Positions, link: str, base: str) -> tuple[Any, Any]:
    """Derivatives of a link's angle by the link and by what it is measured on."""
    reference = numbers.reference(link)
    if reference is None:
        return (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
    return numbers.space.turn_row(PLAIN, at.poses[link], at.poses[base], reference)
