"""What a group of higher class is solved in: the part of the plan before it, at any parameters."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, TypeAlias, cast

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.algebra.rounding import Rounded
from centrode.kinematics.evaluate import Hooks, Kinematics
from centrode.kinematics.newton import System
from centrode.kinematics.paths import JETS
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton
from centrode.structure.positions import Positions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any
Namespace: TypeAlias = Any


@dataclass(frozen=True)
class Surroundings:
    """The plan up to a group of higher class; `hooks` runs it at parameters, one lane for each."""

    kinematics: Kinematics
    group: int
    hooks: Any

    @property
    def unit(self) -> float:
        """Change of the parameter that counts as large."""
        return self.kinematics.path.unit

    def known(self, parameter: Array, lanes: Lanes, order: int) -> Positions:
        """What is known before the group, as jets by the path's parameter."""
        used = self.kinematics.taken(lanes)
        hooks: Hooks = self.hooks(JETS, parameter, lanes)
        with np.errstate(all="ignore"):
            at = used.frame(JETS, Jet.variable(parameter, order))
            used.advance(at, range(self.group), JETS, hooks)
        return at

    def with_numbers(self, numbers: Dimensions) -> Surroundings:
        """The same part of the plan with other dimensions."""
        return replace(self, kinematics=replace(self.kinematics, numbers=numbers))

    def system(self, known: Positions, lanes: Lanes) -> System:
        """The group's equations beside known positions, one lane for each place."""
        group = cast(Newton, self.kinematics.structure.groups[self.group])
        return System(group, self.kinematics.taken(lanes).numbers, known.mapped(plain), len(lanes))


def plain(number: Number) -> Number:
    """The value of a number of any algebra."""
    return number.value if isinstance(number, Jet | Rounded) else number


def flattened(at: Positions, shape: tuple[int, ...]) -> Positions:
    """Positions with every array spread over the shape and laid out in one row; floats stay."""

    def flat(x: Number) -> Number:
        if isinstance(x, Jet):
            return Jet([flat(c) for c in x.coefficients])
        if isinstance(x, Rounded):
            return Rounded(flat(x.value), flat(x.bound))
        return x if np.ndim(x) == 0 else np.broadcast_to(x, shape).reshape(-1)

    return at.mapped(flat)


def shaped(at: Positions, names: Newton, shape: tuple[int, ...], into: Positions) -> None:
    """Add the group's points and links, laid out in one row, to positions of a shape."""

    def fold(x: Number) -> Number:
        if isinstance(x, Jet):
            return Jet([fold(c) for c in x.coefficients])
        if isinstance(x, Rounded):
            return Rounded(fold(x.value), fold(x.bound))
        return np.reshape(x, shape) if np.ndim(x) else x

    folded = at.mapped(fold)
    for name in names.points:
        into.points[name] = folded.points[name]
    for name in names.links:
        into.poses[name] = folded.poses[name]
        into.angles[name] = folded.angles[name]
