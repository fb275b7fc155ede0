"""The equations of kinetostatics at many positions: built once, solved for any forces that act."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.constraint_pulls import positions_of, pulls_of
from centrode.dynamics.kinetostatics.inverse import Inverse, inverse_of
from centrode.dynamics.kinetostatics.scheme import Axis, Scheme, Unknown
from centrode.dynamics.kinetostatics.teeth import Teeth
from centrode.dynamics.pulls import Pull, on_frame
from centrode.dynamics.states import State
from centrode.structure.dimensions import Dimensions
from centrode.structure.positions import Positions

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
        value = self.multipliers[unknown]
        return [pull.times(value) for pull in self.system.pulls[unknown]]

    @cached_property
    def all_pulls(self) -> tuple[Pull, ...]:
        """Everything that acts on any body."""
        inner = [pull for unknown in self.multipliers for pull in self.pulls(unknown)]
        return (*inner, *self.outer)

    @cached_property
    def on_frame(self) -> list[Pull]:
        """Everything that acts on the frame and its points."""
        fixed = self.system.scheme.structure.mechanism.frame.points
        return [pull for pull in self.all_pulls if on_frame(pull.body, fixed)]


@dataclass(frozen=True)
class Kinetostatics:
    """J' lambda = -Q at the positions of a state (planar, one mechanism): any Q, without building J again.

    Attributes
    ----------
    scheme : what is solved for
    numbers : the mechanism's dimensions
    teeth : where gears mesh
    scale : the mechanism's greatest length [m], by which moments are measured
    at : plain positions
    pulls : unknown -> forces and moments of its row, at a multiplier of one
    shape : of every array, (1, n)
    """

    scheme: Scheme
    numbers: Dimensions
    teeth: Teeth
    scale: float
    at: Positions
    pulls: Mapping[Unknown, tuple[Pull, ...]]
    shape: tuple[int, ...]

    @classmethod
    def of(cls, scheme: Scheme, numbers: Dimensions, state: State, teeth: Teeth) -> Kinetostatics:
        """The equations at the positions of a state."""
        at = positions_of(state, numbers)
        pulls: dict[Unknown, tuple[Pull, ...]] = {}
        with np.errstate(all="ignore"):
            for constraint in scheme.structure.constraints:
                found = pulls_of(constraint, state.mechanism, numbers, at, teeth)
                pulls |= {(constraint, row): each for row, each in enumerate(found)}
        shape = (1, len(state.parameter))
        return cls(scheme, numbers, teeth, float(numbers.scale), at, pulls, shape)

    @cached_property
    def inverse(self) -> Inverse:
        """The matrix of the equations, inverted at every position."""
        size, unknowns = self.scheme.size, self.scheme.unknowns
        matrix = np.zeros((size, len(unknowns), *self.shape))
        for column, unknown in enumerate(unknowns):
            self._add(matrix[:, column], self.pulls[unknown])
            if unknown[0].angular:
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
            multipliers[unknown] = solved[row] * self.scale if unknown[0].angular else solved[row]
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
                    if place in sums and not _nothing(pull.force[axis]):
                        sums[place] = sums[place] + pull.force[axis] * value
        return {unknown: -sums[place] for place, unknown in self.scheme.hosts.items()}

    def _add(self, column: Array, pulls: Iterable[Pull]) -> None:
        """Add what pulls do to each equation; the frame has none."""
        for pull in pulls:
            for row, value in self._entries(pull):
                if not _nothing(value):
                    column[row] += value

    def _entries(self, pull: Pull) -> list[tuple[int, Number]]:
        (x, y), scheme = pull.force, self.scheme
        if pull.body.kind == "link":
            return self._on_link(pull.body.name, pull) if pull.body.name in scheme.links else []
        found: list[tuple[int, Number]] = []
        for axis, force in enumerate(((x, 0.0), (0.0, y))):
            place = pull.body.name, axis
            if place in scheme.hosts:
                host = scheme.hosts[place][0].link  # type: ignore[attr-defined]
                found += self._on_link(host, Pull(pull.body, force, pull.at))
            elif place in scheme.loose:
                found.append((3 * len(scheme.links) + scheme.loose.index(place), force[axis]))
        return found

    def _on_link(self, link: str, pull: Pull) -> list[tuple[int, Number]]:
        """Force and moment about the link's first point, moments measured by the greatest length."""
        row, mechanism = self.scheme.first_row(link), self.scheme.structure.mechanism
        first = self.at.points[next(iter(mechanism.links[link].coordinates))]
        return [
            (row, pull.force[0]),
            (row + 1, pull.force[1]),
            (row + 2, pull.moment_about(first) / self.scale),
        ]


def _nothing(value: Number) -> bool:
    return isinstance(value, float) and value == 0.0
