"""Which column of the arrays of a motion holds what.

Coordinates of moving points; the numbers that tell how links are turned; displacements of guides; cosine and
sine of the angles that are not those of a link's own axes. How many numbers each takes, the space says.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.geometry.space import Space
from centrode.kinematics.evaluate import Kinematics
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
Namespace: TypeAlias = Any


@dataclass(frozen=True)
class Layout:
    """Names and places of the columns; `guided` are the guides' points, `angles` the links whose angle is measured."""

    space: Space
    points: tuple[str, ...]
    links: tuple[str, ...]
    guides: tuple[str, ...]
    guided: tuple[str, ...]
    angles: tuple[str, ...]

    @property
    def axes(self) -> int:
        """Number of coordinates of a point."""
        return len(self.space.axes)

    @property
    def attitude(self) -> int:
        """Number of columns of a link."""
        return len(self.space.attitude(self.space.at_rest))

    @property
    def first_attitude(self) -> int:
        """First column of the first link."""
        return self.axes * len(self.points)

    @property
    def first_slide(self) -> int:
        """Column of the first guide's displacement."""
        return self.first_attitude + self.attitude * len(self.links)

    @property
    def first_rotor(self) -> int:
        """First column of the first angle that is not a link's own attitude."""
        return self.first_slide + len(self.guides)

    @property
    def width(self) -> int:
        """Number of columns."""
        return self.first_rotor + (0 if self._own else 2 * len(self.angles))

    @property
    def runs_on(self) -> bool:
        """Whether an angle is that of a link's own axes, so that one the plan counts with its turns says it all."""
        return self._own

    @property
    def _own(self) -> bool:
        """Whether a link's attitude is the rotor of its angle, so that it needs no columns of its own."""
        return self.attitude == 2

    def rotor(self, link: str) -> slice:
        """Columns of cosine and sine of a link's angle."""
        first = self.first_attitude if self._own else self.first_rotor
        column = first + 2 * self.angles.index(link)
        return slice(column, column + 2)

    def numbers(self, m: Namespace, dimensions: Dimensions, at: Positions) -> list[Number]:
        """The numbers of all columns at positions, over any algebra."""
        found = [x for point in self.points for x in at.points[point]]
        found += [x for link in self.links for x in self.space.attitude(at.poses[link])]
        for guide, point in zip(self.guides, self.guided, strict=True):
            found.append(slide_of(m, dimensions, at, guide, point))
        if not self._own:
            found += [x for link in self.angles for x in rotor_of_angle(m, dimensions, at, link)]
        return found


def layout_of(kinematics: Kinematics) -> Layout:
    """Columns for a mechanism: moving points, links and guides in description order."""
    mechanism, numbers = kinematics.structure.mechanism, kinematics.numbers
    return Layout(
        numbers.space,
        tuple(mechanism.moving_points),
        tuple(mechanism.links),
        tuple(guide.id for guide in mechanism.guides),
        tuple(guide.point for guide in mechanism.guides),
        tuple(numbers.ends),
    )


def rotor_of_angle(m: Namespace, numbers: Dimensions, at: Positions, link: str) -> tuple[Number, Number]:
    """Cosine and sine of a link's angle."""
    towards = [at.points[end] for end in numbers.ends[link]]
    return numbers.space.rotor(m, at.poses[link], [*numbers.local[link].values()], towards)


def slide_of(m: Namespace, numbers: Dimensions, at: Positions, guide: str, point: str) -> Number:
    """Displacement of a guide's point along its curve."""
    return numbers.space.slide(m, at.points[point], at.poses[numbers.bodies[guide]], numbers.curve(guide))


def positions_from(
    kinematics: Kinematics,
    layout: Layout,
    values: Array,
    angles: Array,
    parameter: Number,
    m: Namespace = ARRAYS,
) -> Positions:
    """Positions as plain values of the columns and angles (columns first), to evaluate constraints on."""
    numbers, size = kinematics.numbers, layout.attitude
    at = Positions.of_frame(numbers, kinematics.path.drive_values(m, parameter), m)
    for k, point in enumerate(layout.points):
        at.points[point] = tuple(values[layout.axes * k : layout.axes * (k + 1)])
    for k, link in enumerate(layout.links):
        column = layout.first_attitude + size * k
        point, local = next(iter(numbers.local[link].items()))
        attitude = values[column : column + size]
        at.poses[link] = numbers.space.pose_of(m, tuple(attitude), local, at.points[point])
    at.angles.update(zip(layout.angles, angles, strict=True))
    return at
