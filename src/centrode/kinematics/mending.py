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
class Window:
    """The stretch about a change point of one mechanism of a batch."""

    lane: int
    centre: float
    half: float


def inside(window: Window, along: Array, lanes: Lanes | None) -> Index | None:
    """Index of the parameters inside a window; None if there are none."""
    if lanes is None:
        found = np.nonzero(np.abs(along[window.lane] - window.centre) < window.half)[0]
        return (window.lane, found) if len(found) else None
    found = np.nonzero((lanes == window.lane) & (np.abs(along - window.centre) < window.half))[0]
    return (found,) if len(found) else None


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


def of_window(number: Number, window: int) -> Number:
    """The nodes of one window."""
    part = slice(window * len(NODES), (window + 1) * len(NODES))
    if isinstance(number, Jet):
        return Jet([_cut(c, part) for c in number.coefficients])
    if isinstance(number, Rounded):
        return Rounded(_cut(number.value, part), _cut(number.bound, part))
    return np.full(len(NODES), number)


def _cut(x: Number, part: slice) -> Array:
    return np.full(len(NODES), x) if np.ndim(x) == 0 else x[part]


def value_of(number: Number) -> Array:
    """What must be finite for a node to be of use."""
    if isinstance(number, Jet):
        return np.asarray(sum(number.coefficients))
    return np.asarray(number.value + number.bound if isinstance(number, Rounded) else number)


def mended(old: Number, node: Number, shape: tuple[int, ...], index: Index, basis: Array) -> Number:
    """A number with the entries at `index` interpolated from those at the nodes."""
    if isinstance(old, Rounded):
        known = Rounded.of(node)
        value = _interpolated(known.value, basis)
        bound = _interpolated(known.bound + UNIT_ROUNDOFF * np.abs(known.value), np.abs(basis))
        return Rounded(_put(old.value, shape, index, value), _put(old.bound, shape, index, bound))
    still = [0.0 * node] * old.order if isinstance(old, Jet) and not isinstance(node, Jet) else []
    nodes = node.coefficients if isinstance(node, Jet) else (node, *still)
    if isinstance(old, Jet):
        return Jet(
            [
                _put(c, shape, index, _interpolated(k, basis))
                for c, k in zip(old.coefficients, nodes, strict=False)
            ]
        )
    return _put(old, shape, index, _interpolated(nodes[0], basis))


def _interpolated(at_nodes: Array, basis: Array) -> Array:
    # node by node: a matrix product rounds differently for different numbers of samples
    total = np.zeros(basis.shape[0])
    for k in range(basis.shape[1]):
        total += at_nodes[k] * basis[:, k]
    return total


def _put(old: Number, shape: tuple[int, ...], index: Index, values: Array) -> Array:
    whole = np.array(np.broadcast_to(old, shape), dtype=np.float64)
    whole[index] = values
    return whole
