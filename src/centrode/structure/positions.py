"""What is unknown, and where it is: points, links, positions in any algebra."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple, TypeAlias

from centrode.geometry.plane import Vector, reversed_rotor, turned
from centrode.geometry.space import Place, Pose
from centrode.structure.dimensions import Dimensions

Number: TypeAlias = Any
Namespace: TypeAlias = Any
FRAME = "frame"


class Entity(NamedTuple):
    """An unknown: a moving point, or a link."""

    kind: Literal["point", "link"]
    name: str

    @property
    def unknowns(self) -> int:
        """Number of coordinates: 2 of a point, 3 of a link."""
        return 2 if self.kind == "point" else 3


Row: TypeAlias = dict[Entity, tuple[Number, ...]]
"""Derivatives of one equation by the coordinates of what it ties together."""


@dataclass
class Positions:
    """Places of all points and links, in any algebra, with the values of the drives.

    `angles` holds the angles [rad] that are known with their turns: of the frame, of links that a drive or a
    gear turns, and of links whose turns something else depends on.
    """

    points: dict[str, Place]
    poses: dict[str, Pose]
    drives: Mapping[str, Number]
    angles: dict[str, Number] = field(default_factory=lambda: {FRAME: 0.0})

    @classmethod
    def of_frame(cls, dimensions: Dimensions, drives: Mapping[str, Number], m: Namespace) -> Positions:
        """What is known before any group is solved: the frame and the drives."""
        space = dimensions.space
        fixed = {name: space.place(m, space.at_rest, at) for name, at in dimensions.frame.items()}
        return cls(fixed, {FRAME: space.at_rest}, drives)

    def mapped(self, function: Callable[[Number], Number]) -> Positions:
        """The same positions with every number replaced by function(number)."""
        return Positions(
            {name: tuple(map(function, at)) for name, at in self.points.items()},
            {name: mapped_pose(pose, function) for name, pose in self.poses.items()},
            {name: function(value) for name, value in self.drives.items()},
            {name: function(value) for name, value in self.angles.items()},
        )

    def copied(self) -> Positions:
        """The same positions, to which others may be added apart."""
        return Positions(dict(self.points), dict(self.poses), self.drives, dict(self.angles))


def mapped_pose(pose: Pose, function: Callable[[Number], Number]) -> Pose:
    """The same pose with every number replaced by function(number), in their order."""
    return type(pose)(*(tuple(map(function, vector)) for vector in pose))


def angle_between(m: Namespace, rotor: Vector, reference: Vector) -> Number:
    """Angle from one rotor to another, in (-pi, pi]."""
    difference = turned(rotor, reversed_rotor(reference))
    return m.atan2(difference[1], difference[0])
