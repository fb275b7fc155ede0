"""Angles and displacements that run on over turns: filled in for samples by way of the mesh of the path."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.kinematics.angles import NodeTurns, angle_and_rates, node_turns
from centrode.kinematics.layout import rotor_of_angle, slide_of
from centrode.kinematics.pace import nearest_node
from centrode.kinematics.quick_turns import QuickTurns
from centrode.kinematics.ready import Ready
from centrode.kinematics.sampling import Samples
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
TURN = 2.0 * np.pi


@dataclass(frozen=True)
class Course:
    """Positions of some mechanisms of a batch on the mesh, from the initial one outwards."""

    ready: Ready
    numbers: Dimensions
    on_mesh: Positions
    mesh: Array
    quick: QuickTurns

    def turns(
        self, rotor: Callable[[Dimensions, Positions], tuple[Number, Number]], initial: float
    ) -> NodeTurns:
        """Turns along the mesh of what a rotor shows; `initial` [rad] is its angle in the initial position."""
        start = int(np.argmin(np.abs(self.mesh - self.ready.kinematics.path.initial)))
        quick = self.quick.measured(lambda numbers, at: _angle_of(rotor(numbers, at)))
        return node_turns(rotor(self.numbers, self.on_mesh), initial, start, len(self.mesh), quick)

    def nearest(self, parameter: Array) -> npt.NDArray[np.intp]:
        """The node nearest to each parameter."""
        return nearest_node(self.mesh, parameter)


def _angle_of(rotor: tuple[Number, Number]) -> Number:
    cosine, sine = rotor
    return np.arctan2(sine, cosine)


def fill_angles(course: Course, samples: Samples, parameter: Array) -> None:
    """Fill in the angles that are measured and that the plan itself does not give with their turns."""
    nearest = course.nearest(parameter)
    for k, link in enumerate(samples.layout.angles):
        if link in samples.followed:
            continue
        nodes = course.turns(partial(_rotor, link), course.ready.assembled.angles[link])
        rotor = samples.columns[:, samples.layout.rotor(link)]
        angle_and_rates(rotor, nodes.at(nearest, rotor[0, 0], rotor[0, 1], parameter), samples.angles[:, k])


def fill_slides(course: Course, samples: Samples, parameter: Array) -> None:
    """Add its rounds to the displacement along a guide that closes."""
    space, layout = course.numbers.space, samples.layout
    for k, (guide, point) in enumerate(zip(layout.guides, layout.guided, strict=True)):
        period = space.period(ARRAYS, course.numbers.curve(guide))
        if period is None:
            continue
        nodes = course.turns(partial(_rotor_of_slide, guide, point), _initial(course, guide, point))
        slide = samples.columns[0, layout.first_slide + k]
        angle = slide * (TURN / period)
        slide += period * nodes.at(course.nearest(parameter), np.cos(angle), np.sin(angle), parameter)


def _rotor(link: str, numbers: Dimensions, at: Positions) -> tuple[Number, Number]:
    """Cosine and sine of a link's angle."""
    return rotor_of_angle(ARRAYS, numbers, at, link)


def _rotor_of_slide(guide: str, point: str, numbers: Dimensions, at: Positions) -> tuple[Number, Number]:
    """Cosine and sine of the angle about a guide's pole."""
    period: Number = numbers.space.period(ARRAYS, numbers.curve(guide))
    angle = slide_of(ARRAYS, numbers, at, guide, point) * (TURN / period)
    return np.cos(angle), np.sin(angle)


def _initial(course: Course, guide: str, point: str) -> float:
    """Angle about the pole [rad] in the initial position: the drive's where one drives it, else in (-pi, pi]."""
    at, numbers = course.ready.assembled.positions, course.ready.kinematics.numbers
    slide = at.drives.get(guide, slide_of(ARRAYS, numbers, at, guide, point))
    return float(slide * TURN / numbers.space.period(ARRAYS, numbers.curve(guide)))
