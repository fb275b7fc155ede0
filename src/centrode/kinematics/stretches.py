"""Stretches of a path about change points on which links turn fast, and their turns from place to place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.path import nearest_node

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Counts: TypeAlias = npt.NDArray[Any]

TURN = 2.0 * np.pi


@dataclass(frozen=True)
class ParameterStretch:
    """Places about a change point of one mechanism, nodes of the mesh at both ends: they begin with the node `first`.

    `nodes` are the numbers of those places that are nodes of the mesh, in their order.
    """

    lane: int
    places: Array
    first: int
    nodes: Lanes


@dataclass(frozen=True)
class TurnedStretch:
    """The angle of a link in (-pi, pi] at the places of a stretch, and how often it has passed pi since the first."""

    stretch: ParameterStretch
    angle: Array
    passed: Array

    @classmethod
    def of(cls, stretch: ParameterStretch, angle: Array) -> TurnedStretch:
        """Turns counted from place to place; where an angle is absent none are passed."""
        # from place to place an angle turns by less than half a turn, by the choice of the places
        steps = np.round(-np.diff(angle) / TURN)
        passed = np.concatenate([[0.0], np.cumsum(np.where(np.isfinite(steps), steps, 0.0))])
        return cls(stretch, angle, passed)

    @property
    def steps(self) -> Array:
        """Turns passed from one node of the mesh to the next."""
        return np.diff(self.passed[self.stretch.nodes])

    def turns(self, angle: Array, parameter: Array, at_first: float) -> Array:
        """Turns of angles at parameters on the stretch; `at_first` are those at its first place."""
        nearest = nearest_node(self.stretch.places, parameter)
        apart = np.round((self.angle[nearest] - angle) / TURN)
        # where an angle is absent there is nothing to turn
        return at_first + self.passed[nearest] + np.where(np.isfinite(apart), apart, 0.0)


def with_quick_steps(steps: Counts, turned: Sequence[TurnedStretch]) -> None:
    """Put what is counted from place to place into turns (lanes, nodes - 1) passed from node to node."""
    for part in turned:
        lane = part.stretch.lane if len(steps) > 1 else 0
        first = part.stretch.first
        # what was concluded from neighbouring nodes alone is replaced
        steps[lane, first : first + len(part.steps)] = part.steps


def with_quick_turns(
    turns: Counts,
    angle: Array,
    parameter: Array,
    lanes: Lanes | None,
    at_nodes: Counts,
    turned: Sequence[TurnedStretch],
) -> None:
    """Put turns of angles at parameters on stretches into turns.

    These are (lanes, n) for parameters (n,), or with `lanes` one of each mechanism, all (k,). `at_nodes` are the turns
    (lanes, nodes) on the mesh.
    """
    for part in turned:
        places, lane = part.stretch.places, part.stretch.lane
        there = (parameter >= places[0]) & (parameter <= places[-1])
        if lanes is not None:
            there &= lanes == lane
        at_first = float(at_nodes[lane if len(at_nodes) > 1 else 0, part.stretch.first])
        where: Any = there if lanes is not None else (lane if len(turns) > 1 else 0, there)
        turns[where] = part.turns(angle[where], parameter[there], at_first)
