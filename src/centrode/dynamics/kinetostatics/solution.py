"""The equations of kinetostatics at many positions: built once, solved for any forces that act."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.constraint_pulls import pulls_of
from centrode.dynamics.kinetostatics.equilibrium import Equilibrium, Foot, Pressing, equilibrium_of
from centrode.dynamics.kinetostatics.inverse import Inverse, inverse_of
from centrode.dynamics.kinetostatics.scheme import Axis, Scheme, Unknown
from centrode.dynamics.kinetostatics.teeth import Teeth
from centrode.dynamics.pulls import Pull, Vector, on_frame
from centrode.dynamics.states import State
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


@dataclass(frozen=True)
class Forces:
    """What the equations give for some outer forces.

    Attributes
    ----------
    multipliers : unknown -> its value at every position [N or N m]
    outer : the forces that acted
    """

    system: Kinetostatics
    multipliers: Mapping[Unknown, Number]
    outer: tuple[Pull, ...]

    def pulls(self, unknown: Unknown) -> list[Pull]:
        """Forces and moments of one scalar constraint on all it ties together."""
        return self._tied[unknown]

    @cached_property
    def _tied(self) -> dict[Unknown, list[Pull]]:
        pulls = self.system.pulls
        return {one: [pull.times(value) for pull in pulls[one]] for one, value in self.multipliers.items()}

    @cached_property
    def pressing(self) -> tuple[Pressing, ...]:
        """What of loads on pins does not lie along a sphere."""
        mechanism = self.system.scheme.structure.mechanism
        return self.system.equilibrium.pressing(self.outer, mechanism, self.system.at)

    @cached_property
    def acting(self) -> tuple[Pull, ...]:
        """Everything that acts on any body but the centre of a sphere."""
        tied = [pull for pulls in self._tied.values() for pull in pulls]
        return (*tied, *self.outer, *(pull for one in self.pressing for pull in one.pulls))

    @cached_property
    def centre(self) -> tuple[Pull, ...]:
        """What the centre of a sphere exerts on each link, and the opposite on the frame."""
        return self.system.equilibrium.centre(self.acting, self.system.scheme.structure.mechanism)

    @cached_property
    def all_pulls(self) -> tuple[Pull, ...]:
        """Everything that acts on any body."""
        return (*self.acting, *self.centre)

    @cached_property
    def on_frame(self) -> list[Pull]:
        """Everything that acts on the frame and its points."""
        fixed = self.system.scheme.structure.mechanism.frame.points
        return [pull for pull in self.all_pulls if on_frame(pull.body, fixed)]


@dataclass(frozen=True)
class Kinetostatics:
    """J' lambda = -Q at the positions of a state (one mechanism): any Q, without building J again.

    Attributes
    ----------
    scheme : what is solved for
    numbers : the mechanism's dimensions
    teeth : where gears mesh
    equilibrium : what the space makes of forces
    scale : the mechanism's greatest length [m], by which moments are measured
    at : plain positions
    pulls : unknown -> forces and moments of its row, at a multiplier of one
    shape : of every array, (1, n)
    """

    scheme: Scheme
    numbers: Dimensions
    teeth: Teeth
    equilibrium: Equilibrium
    scale: float
    at: Positions
    pulls: Mapping[Unknown, tuple[Pull, ...]]
    shape: tuple[int, ...]

    @classmethod
    def of(cls, scheme: Scheme, numbers: Dimensions, state: State, teeth: Teeth) -> Kinetostatics:
        """The equations at the positions of a state."""
        space = equilibrium_of(state.mechanism)
        at = space.positions(state, numbers)
        pulls: dict[Unknown, tuple[Pull, ...]] = {}
        with np.errstate(all="ignore"):
            for constraint in scheme.structure.constraints:
                found = pulls_of(constraint, state.mechanism, numbers, at, teeth, space)
                pulls |= {(constraint, row): each for row, each in enumerate(found)}
        shape = (1, len(state.parameter))
        return cls(scheme, numbers, teeth, space, space.scale(numbers), at, pulls, shape)

    @cached_property
    def inverse(self) -> Inverse:
        """The matrix of the equations, inverted at every position."""
        size, unknowns = self.scheme.size, self.scheme.unknowns
        matrix = np.zeros((size, len(unknowns), *self.shape))
        for column, unknown in enumerate(unknowns):
            self._add(matrix[:, column], self.pulls[unknown])
            if self.equilibrium.by_moment(unknown[0]):
                matrix[:, column] *= self.scale
        return inverse_of(np.ascontiguousarray(np.moveaxis(matrix, (0, 1), (-2, -1))))

    def right_side(self, outer: Iterable[Pull]) -> Array:
        """Forces and moments [N] on the links, as (equations, 1, n)."""
        found = np.zeros((self.scheme.size, *self.shape))
        self._add(found, outer)
        return found

    def forces(self, outer: Sequence[Pull]) -> Forces:
        """Constraint forces that balance what acts on points and links.

        Equations that repeat others bear nothing, except where the others alone are singular: there all together bear
        the least. What nothing determines is one of the many forces that are possible.
        """
        solved = self.inverse.times(-self.right_side(outer))
        multipliers: dict[Unknown, Number] = {}
        for row, unknown in enumerate(self.scheme.unknowns):
            turns = self.equilibrium.by_moment(unknown[0])
            multipliers[unknown] = solved[row] * self.scale if turns else solved[row]
        multipliers |= self._at_hosts(multipliers, outer)
        return Forces(self, multipliers, tuple(outer))

    def _at_hosts(
        self, multipliers: Mapping[Unknown, Number], outer: Sequence[Pull]
    ) -> dict[Unknown, Number]:
        """What the host of each pin bears: the rest of what acts on the pin."""
        sums: dict[Axis, Number] = dict.fromkeys(self.scheme.hosts, np.zeros(self.shape))
        acting = [(pull, value) for unknown, value in multipliers.items() for pull in self.pulls[unknown]]
        for pull, value in [*acting, *((pull, 1.0) for pull in outer)]:
            if pull.body.kind == "point":
                for axis in range(2):
                    place = pull.body.name, axis
                    along = _along(pull.force, self._host_axis(place)) if place in sums else 0.0
                    if not _nothing(along):
                        sums[place] = sums[place] + along * value
        return {unknown: -sums[place] for place, unknown in self.scheme.hosts.items()}

    def _host_axis(self, place: Axis) -> Vector:
        """Direction in which a pin's host bears it: that of its row, a unit vector square to that of its other row."""
        pulls = self.pulls[self.scheme.hosts[place]]
        return next(pull.force for pull in pulls if pull.body.kind == "point")

    def _add(self, column: Array, pulls: Iterable[Pull]) -> None:
        """Add what pulls do to each equation; the frame has none."""
        for pull in pulls:
            for row, value in self._entries(pull):
                if not _nothing(value):
                    column[row] += value

    def _entries(self, pull: Pull) -> list[tuple[int, Number]]:
        name, scheme = pull.body.name, self.scheme
        if pull.body.kind == "link":
            return self._on_link(name, pull) if name in scheme.links else []
        if (name, 0) in scheme.hosts:
            return self._on_link(scheme.hosts[name, 0][0].link, pull)  # type: ignore[attr-defined]
        if (name, 0) not in scheme.loose:
            return []
        row, axes = 3 * len(scheme.links) + scheme.loose.index((name, 0)), self._pin_axes(name)
        return [(row + k, _along(pull.force, axis)) for k, axis in enumerate(axes)]

    def _pin_axes(self, point: str) -> Sequence[Vector]:
        return self.equilibrium.pin_axes(self.at.points[point])

    def _on_link(self, link: str, pull: Pull) -> list[tuple[int, Number]]:
        row = self.scheme.first_row(link)
        return [(row + k, value) for k, value in enumerate(self.on_link(link, pull))]

    def on_link(self, link: str, pull: Pull) -> tuple[Number, Number, Number]:
        """What a pull does to the three equations of its link [N]: about its first point, by the greatest length."""
        return self.equilibrium.on_link(pull, self._feet[link], self.scale)

    @cached_property
    def _feet(self) -> dict[str, Foot]:
        links = self.scheme.structure.mechanism.links
        firsts = {name: next(iter(link.coordinates)) for name, link in links.items()}
        return {name: self.equilibrium.foot(self.at.points[first]) for name, first in firsts.items()}


def _along(force: Vector, axis: Vector) -> Number:
    """Component of a force; a component that is plainly zero costs nothing."""
    found: Number = 0.0
    for x, u in zip(force, axis, strict=True):
        if not _nothing(x) and not _nothing(u):
            found = found + (x if isinstance(u, float) and u == 1.0 else x * u)
    return found


def _nothing(value: Number) -> bool:
    return isinstance(value, float) and value == 0.0
