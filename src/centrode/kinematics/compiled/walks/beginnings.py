"""Where walks of a batch begin: groups of higher class in the initial position, found as the arrays find them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.compiled.deciding import chains_of
from centrode.kinematics.compiled.newton.postures import Names, numbers_of
from centrode.kinematics.evaluate import Hooks
from centrode.kinematics.higher_class.newton import newton
from centrode.kinematics.higher_class.places import starts
from centrode.kinematics.higher_class.surroundings import Surroundings, flattened, needed, shaped
from centrode.kinematics.higher_class.system import System
from centrode.kinematics.ready import Ready
from centrode.kinematics.solve import of_batch
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

AT_ONCE = 4096
"""Mechanisms that are begun together: their numbers stay in the cache."""


def beginnings(ready: Ready, numbers: Dimensions, lanes: int) -> dict[str, Array]:
    """Free coordinates in the initial position of every mechanism of a batch, name -> (lanes,).

    NaN where a mechanism is not reached from the description's own dimensions.
    """
    parts = []
    for first in range(0, lanes, AT_ONCE):
        rows = slice(first, min(first + AT_ONCE, lanes))
        some = numbers.mapped(lambda x, rows=rows: x if isinstance(x, float) else x[rows])  # type: ignore[misc]
        parts.append(_of_some(ready, some, rows.stop - first))
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]} if parts else {}


def _of_some(ready: Ready, numbers: Dimensions, lanes: int) -> dict[str, Array]:
    kinematics = of_batch(ready.kinematics, numbers)
    initial, found = kinematics.path.initial, dict[str, Array]()
    everyone = np.arange(lanes)
    hooks = _Beginning(ready)
    for group, chain in chains_of(ready, kinematics.taken(everyone).numbers).items():
        around = Surroundings(kinematics, group, hooks.at_lanes)
        state = starts(around, ready.kinematics.numbers, ready.assembled.positions, initial, lanes)
        hooks.states[group] = around, state
        blank = around.blank(everyone)
        at = blank.at(np, Positions({}, {}, {}, {}), state)
        posture = chain.posture(at)
        labels = Names(group, chain).labels
        for name, values in zip(numbers_of(labels), numbers_of(posture), strict=True):
            found[name] = np.array(np.broadcast_to(values, lanes), dtype=np.float64)
    return found


class _Beginning:
    """What decides in the initial position, with the groups of higher class that are begun so far."""

    def __init__(self, ready: Ready) -> None:
        self.signs = ready.assembled.signs
        self.states: dict[int, tuple[Surroundings, Array]] = {}

    def at_lanes(self, m: Namespace, parameter: Array, lanes: Lanes) -> Hooks:
        return _OfLanes(m, self.signs, self.states, lanes)


class _OfLanes(Hooks):
    def __init__(
        self,
        m: Namespace,
        signs: Mapping[int, float],
        states: Mapping[int, tuple[Surroundings, Array]],
        lanes: Lanes,
    ) -> None:
        self.m, self.signs, self.states, self.lanes = m, signs, states, lanes

    def root(self, group: int, radicand: Number) -> Number:
        return self.m.sqrt(radicand) * self.signs[group]

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        around, states = self.states[group]
        equations, shape = around.equations, self.lanes.shape
        known = flattened(needed(equations, at), shape)
        system = System(equations, around.kinematics.taken(self.lanes).numbers, known, len(self.lanes))
        found = newton(system, states[self.lanes])
        state = np.where(found.found[:, None], found.state, np.nan)
        shaped(system.at(m, known, state), equations, shape, at)
