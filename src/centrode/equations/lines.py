"""Guides, cylinders and tracks as parts of vector chains."""

from __future__ import annotations

from dataclasses import dataclass

from centrode.equations.alphabet import Vector
from centrode.geometry.plane import along
from centrode.kinematics.prepared import Ready
from centrode.structure.constraints import Contact, DisplacementDrive, DistanceDrive, PointOnGuide
from centrode.structure.gearing import Straight


@dataclass(frozen=True)
class Line:
    """A point stays on a line of a body: on a guide, or with a wheel's centre on the parallel of its track."""

    name: str
    point: str
    on: str
    through: Vector
    direction: Vector
    drive: str | None = None


@dataclass(frozen=True)
class Rod:
    """A distance that has a direction of its own: a cylinder, or the radius from a track's centre to the wheel's.

    `first` is a point, or (body, coordinates) of a place that has no name.
    """

    name: str
    first: str | tuple[str, Vector]
    second: str
    length: float
    drive: str | None = None


def lines_of(ready: Ready) -> list[Line]:
    """Guides and straight tracks, in the order of the constraints."""
    structure, numbers = ready.structure, ready.kinematics.numbers
    driven = {c.guide: c.drive for c in structure.constraints if isinstance(c, DisplacementDrive)}
    found = []
    for constraint in structure.constraints:
        if constraint in structure.redundant:
            continue
        if isinstance(constraint, PointOnGuide):
            through, direction = numbers.curve(constraint.guide)
            drive = driven.get(constraint.guide)
            found.append(
                Line(constraint.guide, constraint.point, constraint.on, _v(through), _v(direction), drive)
            )
        if isinstance(constraint, Contact):
            track = numbers.gearing.track[constraint.rolling]
            if isinstance(track, Straight):
                normal = (-track.direction[1], track.direction[0])
                through = along(track.through, normal, numbers.gearing.reach(constraint.rolling))
                found.append(
                    Line(
                        constraint.rolling, constraint.centre, constraint.on, _v(through), _v(track.direction)
                    )
                )
    return found


def rods_of(ready: Ready) -> list[Rod]:
    """Cylinders and round tracks."""
    structure, numbers = ready.structure, ready.kinematics.numbers
    found = []
    for constraint in structure.constraints:
        if constraint in structure.redundant:
            continue
        if isinstance(constraint, DistanceDrive):
            length = float(ready.assembled.positions.drives[constraint.drive])
            found.append(Rod(constraint.drive, constraint.first, constraint.second, length, constraint.drive))
        if isinstance(constraint, Contact):
            track = numbers.gearing.track[constraint.rolling]
            if not isinstance(track, Straight):
                reach = float(numbers.gearing.reach(constraint.rolling))
                found.append(
                    Rod(constraint.rolling, (constraint.on, _v(track.centre)), constraint.centre, reach)
                )
    return found


def _v(vector: tuple[object, ...]) -> Vector:
    x, y = vector
    return float(x), float(y)  # type: ignore[arg-type]
