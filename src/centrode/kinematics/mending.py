"""What a group gives next to its change points: interpolated from nodes on both sides.

Barycentric formula at Chebyshev nodes; Berrut and Trefethen, SIAM Review 46, 2004.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.algebra.rounding import UNIT_ROUNDOFF, Rounded
from centrode.kinematics.evaluate import Kinematics
from centrode.structure.groups import links_of, points_of
from centrode.structure.positions import Positions, mapped_pose

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any
Index: TypeAlias = tuple[Any, ...]

SIDE = 1.5 - 0.5 * np.cos((np.arange(6) + 0.5) * np.pi / 6)
NODES = np.concatenate([-SIDE[::-1], SIDE])
"""Chebyshev nodes on each side, between one and two half widths away."""
WEIGHTS = np.array([1.0 / np.prod(node - np.delete(NODES, k)) for k, node in enumerate(NODES)])


@dataclass(frozen=True)
class Windows:
    """The stretches about the change points of a group, of all mechanisms of a batch: arrays (windows,)."""

    lane: Lanes
    centre: Array
    half: Array

    def __len__(self) -> int:
        return len(self.lane)


def inside(windows: Windows, along: Array, lanes: Lanes | None) -> tuple[Index, Lanes]:
    """Index of the parameters inside a window, and which window that is; of two the later one counts.

    `along` are parameters (n,) of all mechanisms, or with `lanes` one mechanism's each.
    """
    if lanes is None:
        order = np.argsort(along, kind="stable")
        ends = windows.centre - windows.half, windows.centre + windows.half
        # one more on both sides: the last bit is left to the comparison below
        first = np.maximum(np.searchsorted(along[order], ends[0]) - 1, 0)
        last = np.minimum(np.searchsorted(along[order], ends[1], side="right") + 1, len(along))
    else:
        order = np.argsort(lanes, kind="stable")
        first, last = (np.searchsorted(lanes[order], windows.lane, side=side) for side in ("left", "right"))
    counts = last - first
    chosen = np.repeat(np.arange(len(windows)), counts)
    places = order[np.arange(len(chosen)) + np.repeat(first - np.cumsum(counts) + counts, counts)]
    within = np.abs(along[places] - windows.centre[chosen]) < windows.half[chosen]
    chosen, places = chosen[within], places[within]
    return ((windows.lane[chosen], places) if lanes is None else (places,)), chosen


def numbers_of(kinematics: Kinematics, group: int, at: Positions) -> list[Number]:
    """Everything a group gives, number by number."""
    which = kinematics.structure.groups[group]
    numbers = [x for point in points_of(which) for x in at.points[point]]
    for link in links_of(which):
        numbers += [x for vector in at.poses[link] for x in vector]
    return numbers + [at.angles[link] for link in links_of(which) if link in at.angles]


def set_numbers(kinematics: Kinematics, group: int, at: Positions, numbers: list[Number]) -> None:
    """Put numbers in the order of `numbers_of` back into positions."""
    which = kinematics.structure.groups[group]
    rest = iter(numbers)
    for point in points_of(which):
        at.points[point] = tuple(next(rest) for _old in at.points[point])
    for link in links_of(which):
        at.poses[link] = mapped_pose(at.poses[link], lambda _old: next(rest))
    for link in links_of(which):
        if link in at.angles:
            at.angles[link] = next(rest)


def finite(numbers: list[Number], windows: int) -> npt.NDArray[np.bool_]:
    """The windows at whose nodes (windows * nodes,) all numbers are finite, so that they are of use."""
    found = np.ones((windows, len(NODES)), dtype=bool)
    for number in numbers:
        found &= np.isfinite(_at_nodes(_summed(number), windows))
    return np.asarray(found.all(axis=1))


def _summed(number: Number) -> Number:
    if isinstance(number, Jet):
        return sum(number.coefficients)
    return number.value + number.bound if isinstance(number, Rounded) else number


def _at_nodes(x: Number, windows: int) -> Array:
    """A number at the nodes of all windows as (windows, nodes)."""
    return np.broadcast_to(x, (windows * len(NODES),)).reshape(windows, len(NODES))


def mended(
    old: Number, node: Number, shape: tuple[int, ...], index: Index, chosen: Lanes, basis: Array
) -> Number:
    """A number with the entries at `index` interpolated from those at the nodes of the chosen windows."""
    if isinstance(old, Rounded):
        known = Rounded.of(node)
        value = _interpolated(known.value, chosen, basis)
        bound = _interpolated(known.bound + UNIT_ROUNDOFF * np.abs(known.value), chosen, np.abs(basis))
        return Rounded(_put(old.value, shape, index, value), _put(old.bound, shape, index, bound))
    still = [0.0 * node] * old.order if isinstance(old, Jet) and not isinstance(node, Jet) else []
    nodes = node.coefficients if isinstance(node, Jet) else (node, *still)
    if isinstance(old, Jet):
        return Jet(
            [
                _put(c, shape, index, _interpolated(k, chosen, basis))
                for c, k in zip(old.coefficients, nodes, strict=False)
            ]
        )
    return _put(old, shape, index, _interpolated(nodes[0], chosen, basis))


def _interpolated(at_nodes: Number, chosen: Lanes, basis: Array) -> Array:
    windows = int(chosen[-1]) + 1 if len(chosen) else 0
    if np.ndim(at_nodes) == 0:
        known = np.full((windows, len(NODES)), at_nodes)
    else:
        known = at_nodes.reshape(-1, len(NODES))
    # node by node: a matrix product rounds differently for different numbers of samples
    total = np.zeros(len(chosen))
    for k in range(len(NODES)):
        total += known[chosen, k] * basis[:, k]
    return total


def _put(old: Number, shape: tuple[int, ...], index: Index, values: Array) -> Array:
    whole = np.array(np.broadcast_to(old, shape), dtype=np.float64)
    whole[index] = values
    return whole
