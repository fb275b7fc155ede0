"""Cylinders: a drive that gives the distance of two points, as a constraint."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.geometry.plane import dot, subtract
from centrode.locale import _
from centrode.structure.dimensions import Dimensions
from centrode.structure.positions import Entity, Positions, Row

Number: TypeAlias = Any
Namespace: TypeAlias = Any


@dataclass(frozen=True)
class DistanceDrive:
    """A drive gives the distance of two points."""

    drive: str
    first: str
    second: str
    size = 1
    angular = False

    @property
    def bodies(self) -> tuple[Entity, ...]:
        return Entity("point", self.first), Entity("point", self.second)

    @property
    def label(self) -> str:
        return _("cylinder {drive}").format(drive=self.drive)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        apart = subtract(at.points[self.second], at.points[self.first])
        return [m.sqrt(dot(apart, apart)) - at.drives[self.drive]]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        x, y = subtract(at.points[self.second], at.points[self.first])
        length = (x * x + y * y) ** 0.5
        first, second = self.bodies
        return [{first: (-x / length, -y / length), second: (x / length, y / length)}]
