"""What a group of higher class is solved in: the part of the plan before it, at any parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TypeAlias, cast

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jets import Jet
from centrode.algebra.rounding import ROUNDED, Rounded
from centrode.kinematics.evaluate import Hooks, Kinematics
from centrode.kinematics.higher_class.system import System
from centrode.kinematics.paths import JETS
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any
Namespace: TypeAlias = Any


@dataclass(frozen=True)
class Surroundings:
    """The plan up to a group of higher class; `hooks` runs it at parameters, one lane for each."""

    kinematics: Kinematics
    group: int
    hooks: Callable[[Namespace, Array, Lanes], Hooks]

    @property
    def unit(self) -> float:
        """Change of the parameter that counts as large."""
        return self.kinematics.path.unit

    @property
    def equations(self) -> Newton:
        """The group itself."""
        return cast(Newton, self.kinematics.structure.groups[self.group])

    def known(self, parameter: Jet, lanes: Lanes) -> Positions:
        """What the group's equations need of what is known before it, at a parameter given as a jet."""
        used = self.kinematics.taken(lanes)
        hooks = self.hooks(JETS, parameter.value, lanes)
        with np.errstate(all="ignore"):
            at = used.frame(JETS, parameter)
            used.advance(at, range(self.group), JETS, hooks)
        return needed(self.equations, at)

    def known_at(self, parameter: Array, lanes: Lanes) -> Positions:
        """The same at plain parameters."""
        return needed(self.equations, self.before(parameter, lanes))

    def before(self, parameter: Array, lanes: Lanes) -> Positions:
        """Everything that is known before the group, at plain parameters."""
        used = self.kinematics.taken(lanes)
        with np.errstate(all="ignore"):
            at = used.frame(ARRAYS, parameter)
            used.advance(at, range(self.group), ARRAYS, self.hooks(ARRAYS, parameter, lanes))
        return at

    def bounded(self, parameter: Array, lanes: Lanes) -> Positions:
        """The same with bounds of rounding errors."""
        used = self.kinematics.taken(lanes)
        with np.errstate(all="ignore"):
            at = used.frame(ROUNDED, Rounded.of(parameter))
            used.advance(at, range(self.group), ROUNDED, self.hooks(ROUNDED, parameter, lanes))
        return needed(self.equations, at)

    def blank(self, lanes: Lanes) -> System:
        """The group's equations beside nothing: for what needs the state alone."""
        return System(
            self.equations, self.kinematics.taken(lanes).numbers, Positions({}, {}, {}, {}), len(lanes)
        )

    def with_numbers(self, numbers: Dimensions, lanes: Lanes) -> Surroundings:
        """The same part of the plan with other dimensions of some mechanisms, which are counted anew."""

        def hooks(m: Namespace, parameter: Array, which: Lanes) -> Hooks:
            return self.hooks(m, parameter, lanes[which])

        return replace(self, kinematics=replace(self.kinematics, numbers=numbers), hooks=hooks)

    def system(self, known: Positions, lanes: Lanes) -> System:
        """The group's equations beside known positions, one lane for each place."""
        return System(self.equations, self.kinematics.taken(lanes).numbers, known.mapped(plain), len(lanes))


def needed(group: Newton, at: Positions) -> Positions:
    """The points and links of which the equations of a group speak."""
    bodies = {body.name for constraint, _row in group.equations for body in constraint.bodies}
    return Positions(
        {name: place for name, place in at.points.items() if name in bodies},
        {name: pose for name, pose in at.poses.items() if name in bodies},
        at.drives,
        {name: angle for name, angle in at.angles.items() if name in bodies},
    )


def plain(number: Number) -> Number:
    """The value of a number of any algebra."""
    return number.value if isinstance(number, Jet | Rounded) else number


def within(function: Callable[[Number], Number]) -> Callable[[Number], Number]:
    """A function of plain numbers made one of jets and bounded numbers, part by part."""

    def apply(x: Number) -> Number:
        if isinstance(x, Jet):
            return Jet([apply(c) for c in x.coefficients])
        if isinstance(x, Rounded):
            return Rounded(apply(x.value), apply(x.bound))
        return function(x)

    return apply


def flattened(at: Positions, shape: tuple[int, ...]) -> Positions:
    """Positions with every array spread over the shape and laid out in one row; floats stay."""

    def flat(x: Number) -> Number:
        return x if np.ndim(x) == 0 else np.broadcast_to(x, shape).reshape(-1)

    return at.mapped(within(flat))


def shaped(at: Positions, names: Newton, shape: tuple[int, ...], into: Positions) -> None:
    """Add the group's points and links, laid out in one row, to positions of a shape."""

    def fold(x: Number) -> Number:
        return np.reshape(x, shape) if np.ndim(x) else x

    folded = at.mapped(within(fold))
    for name in names.points:
        into.points[name] = folded.points[name]
    for name in names.links:
        into.poses[name] = folded.poses[name]
        if name in folded.angles:
            into.angles[name] = folded.angles[name]
