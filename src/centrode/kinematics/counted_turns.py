"""Angles that groups depend on with their turns: counted on the mesh of the path, outwards from its start.

A value anywhere takes its turns from the nearest node, so it does not depend on the samples asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.algebra.rounding import Rounded
from centrode.kinematics.pace import nearest_node
from centrode.kinematics.stretches import TurnedStretch, with_quick_steps, with_quick_turns

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any
TURN = 2.0 * np.pi


@dataclass(frozen=True)
class Turns:
    """An angle at the nodes of a mesh, and the whole turns to add to it there.

    `angle` and `turns` have shape (lanes, nodes), or (1, nodes) where the lanes agree. `quick` has the stretches on
    which half a turn may lie between two nodes.
    """

    mesh: Array
    angle: Array
    turns: Array
    quick: Sequence[TurnedStretch] = ()

    def continued(self, angle: Number, parameter: Array, lanes: Lanes | None) -> Number:
        """An angle in (-pi, pi], over any algebra, with its turns at parameters as `Hooks` has them."""
        node = nearest_node(self.mesh, parameter)
        if lanes is None:
            where: Any = (slice(None), node.reshape(-1))
        else:
            where = (lanes if len(self.angle) > 1 else 0, node)
        value = _value(angle)
        whole = self.turns[where] + np.round((self.angle[where] - value) / TURN)
        if self.quick:
            value = np.broadcast_to(value, whole.shape)
            with_quick_turns(whole, value, np.reshape(parameter, -1), lanes, self.turns, self.quick)
        return angle + TURN * whole if whole.any() else angle


def counted(
    angle: Number, mesh: Array, initial: float, start: float, quick: Sequence[TurnedStretch] = ()
) -> Turns:
    """Turns of an angle on a mesh (nodes,); `initial` is its value at the parameter `start`."""
    values = np.atleast_2d(np.asarray(_value(angle), dtype=np.float64))
    values = np.broadcast_to(values, (values.shape[0], len(mesh)))
    node = int(np.argmin(np.abs(mesh - start)))
    values = _bridged(values, node)
    steps = np.round((values[:, :-1] - values[:, 1:]) / TURN)
    with_quick_steps(steps, quick)
    turns = np.zeros(values.shape)
    np.cumsum(steps, axis=1, out=turns[:, 1:])
    turns += (np.round((initial - values[:, node]) / TURN) - turns[:, node])[:, None]
    return Turns(mesh, values, turns, quick)


def _bridged(values: Array, start: int) -> Array:
    """Gaps filled by the last known value on the way from the start, in both directions; zero if there is none."""
    known = np.isfinite(values)
    if known.all():
        return values
    nodes, last = np.arange(values.shape[1]), values.shape[1]
    ahead = np.maximum.accumulate(np.where(known & (nodes >= start), nodes, -1), axis=1)
    behind = np.where(known & (nodes <= start), nodes, last)
    behind = np.minimum.accumulate(behind[:, ::-1], axis=1)[:, ::-1]
    source = np.where(nodes >= start, ahead, behind)
    missing = (source < 0) | (source >= last)
    source = np.where(missing, np.argmax(known, axis=1)[:, None], source)
    filled = np.take_along_axis(values, source, axis=1)
    return np.where(np.isfinite(filled), filled, 0.0)


def _value(angle: Number) -> Any:
    if isinstance(angle, Jet | Rounded):
        return angle.value
    return angle
