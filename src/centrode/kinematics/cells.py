"""Cells of the path on which a radicand or divisor is known to keep its sign, or to pass zero once at most.

A cell is known by a bound of the second derivative (`numerics.bends`): it is clear where the number cannot reach zero,
and straight where its slope cannot. Between the centres of two known cells that abut, there is a zero exactly where
the signs at the centres differ. Cells that are not known are divided until they are, or until they are so short that
what happens in them is one place. Towards places where something happens they get shorter in a geometric series,
as what follows from a limit runs like a square root there, and from a pole like a reciprocal.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
Guard: TypeAlias = Callable[[Lanes, Array, Array], tuple[Array, Array, Array]]
"""From lanes, centres and half widths of cells: value and slope at each centre, and the bend over each cell."""

FINEST = 1e-10
"""Half width (in the path's units) below which a cell is one place."""
PARTS = 4
"""Into how many parts an unknown cell is divided."""
HALVINGS = 26
"""How often the way to a place where something happens is halved: from a cell of half a degree to `FINEST`."""
COARSE = 1e-6
"""Half width like `FINEST`, of a mechanism with many unknown cells: beside poles rounding alone may leave thousands."""
MANY, MOST = 1_000, 10_000
"""Unknown cells of a mechanism from which on they are taken no further than that, and no further at all."""


def clear(value: Array, slope: Array, bend: Array, half: Array | float) -> Mask:
    """Where a number stays off zero all over its cell."""
    # Taylor's formula: within `half` the number strays by at most |slope| half + bend half^2 / 2
    return np.asarray((np.abs(slope) + (0.5 * half) * bend) * half < np.abs(value))


def straight(slope: Array, bend: Array, half: Array | float) -> Mask:
    """Where a number rises or falls all over its cell."""
    return np.asarray(np.abs(slope) > bend * half)


@dataclass(frozen=True)
class CellPieces:
    """Cells of chosen mechanisms with the values at their centres: arrays (k,).

    `known` are the cells that are clear or straight, `nodes` those of the mesh that were not divided. A cell of
    infinite value is a wall: what lies before it has nothing to do with what lies behind it.
    """

    lane: Lanes
    centre: Array
    half: Array
    value: Array
    known: Mask
    nodes: Mask

    def __len__(self) -> int:
        return len(self.lane)

    @classmethod
    def of(
        cls,
        lane: Lanes,
        centre: Array,
        half: Array | float,
        value: Array | float = np.nan,
        nodes: bool = False,
    ) -> CellPieces:
        """Cells about centres; those of the mesh are known."""
        wide = (np.broadcast_to(x, centre.shape) for x in (half, value, nodes, nodes))
        return cls(lane, centre, *wide)

    def take(self, which: npt.NDArray[np.intp] | Mask) -> CellPieces:
        """Cells with these numbers, or where a mask is true."""
        return CellPieces(*(getattr(self, each.name)[which] for each in fields(self)))

    def sort_by_path(self) -> CellPieces:
        """The cells of every mechanism in the order of the path."""
        return self.take(np.lexsort((self.centre, self.lane)))

    @classmethod
    def join(cls, *parts: CellPieces) -> CellPieces:
        """The cells of several together."""
        return cls(*(np.concatenate([getattr(part, each.name) for part in parts]) for each in fields(cls)))


def towards(lane: Lanes, low: Array, high: Array, place: Array) -> CellPieces:
    """Stretches of the path, each with a place in it, in cells that get shorter towards the place and leave it out."""
    shares = 2.0 ** -np.arange(HALVINGS + 1.0)
    ways = np.concatenate([low - place, high - place])[:, None] * shares
    # cells [w/2, w] of the way, with w halved from one to the next: centre at 3/4 of w, half width a quarter
    centre = (np.tile(place, 2)[:, None] + 0.75 * ways).ravel()
    half = 0.25 * np.abs(ways).ravel()
    lane = np.repeat(np.tile(lane, 2), len(shares))
    worth = half > 0.0
    return CellPieces.of(lane[worth], centre[worth], half[worth])


def divide_cells(pieces: CellPieces, guard: Guard, unit: float) -> CellPieces:
    """Cells until each is known, or so short that it is one place; those where the guard has no value are left out."""
    divided: list[CellPieces] = []
    rest = pieces
    while len(rest):
        value, slope, bend = guard(rest.lane, rest.centre, rest.half)
        there = np.isfinite(value)
        with np.errstate(all="ignore"):
            known = clear(value, slope, bend, rest.half) | straight(slope, bend, rest.half)
        # what has no slope has no bound: dividing further would not help
        # where the law of a drive changes its formula at a change point there are no derivatives
        done = known | ~np.isfinite(slope) | (rest.half <= unit * _finest(rest.lane, there & ~known))
        every = CellPieces(rest.lane, rest.centre, rest.half, value, known, rest.nodes)
        divided.append(every.take(there & done))
        rest = parts_of(every.take(there & ~done))
    return CellPieces.join(*divided) if divided else pieces


def _finest(lane: Lanes, unknown: Mask) -> Array | float:
    """Half width below which cells are not divided, by how many of their mechanism are unknown."""
    if np.count_nonzero(unknown) <= MANY:
        return FINEST
    count = np.bincount(lane[unknown], minlength=int(lane.max()) + 1)
    # past MANY unknown cells rounding next to a pole is the reason, and not events
    return np.asarray(np.select([count <= MANY, count <= MOST], [FINEST, COARSE], np.inf)[lane])


def parts_of(pieces: CellPieces) -> CellPieces:
    """The parts of cells."""
    shifts = (2.0 * np.arange(PARTS) + 1.0) / PARTS - 1.0
    return CellPieces.of(
        np.repeat(pieces.lane, PARTS),
        (pieces.centre[:, None] + pieces.half[:, None] * shifts).ravel(),
        np.repeat(pieces.half / PARTS, PARTS),
    )


def changes(pieces: CellPieces, slack: float) -> tuple[Lanes, Array, Array]:
    """Lanes and stretches between neighbours of opposite signs, in cells in the order of the path.

    Cells that are not farther apart than `slack` abut. What is zero has no sign. Neighbours on the mesh are left out.
    """
    first, last = _neighbours(pieces, slack)
    turned = np.sign(pieces.value[first]) != np.sign(pieces.value[last])
    # two neighbouring nodes of the mesh were looked at before
    turned &= ~((last == first + 1) & pieces.nodes[first] & pieces.nodes[last])
    return pieces.lane[first[turned]], pieces.centre[first[turned]], pieces.centre[last[turned]]


def without_sign(pieces: CellPieces, slack: float) -> tuple[Lanes, Array, Array, Array]:
    """Lanes and stretches between neighbours of the same sign that have zeros between them, and the sign."""
    first, last = _neighbours(pieces, slack)
    hidden = (last > first + 1) & (np.sign(pieces.value[first]) == np.sign(pieces.value[last]))
    first, last = first[hidden], last[hidden]
    return pieces.lane[first], pieces.centre[first], pieces.centre[last], np.sign(pieces.value[first])


def unsettled_stretches(pieces: CellPieces, slack: float) -> tuple[Lanes, Array, Array, Array]:
    """Lanes and stretches between neighbours of the same sign of which one is not known, and the sign."""
    first, last = _neighbours(pieces, slack)
    doubtful = (last == first + 1) & ~(pieces.known[first] & pieces.known[last])
    doubtful &= np.sign(pieces.value[first]) == np.sign(pieces.value[last])
    first, last = first[doubtful], last[doubtful]
    return pieces.lane[first], pieces.centre[first], pieces.centre[last], np.sign(pieces.value[first])


def _neighbours(pieces: CellPieces, slack: float) -> tuple[Lanes, Lanes]:
    # neighbours abut if no more than the slack lies between them; a wall abuts with nothing
    """Pairs of cells with a sign that abut, or that only cells without one lie between."""
    apart = np.diff(pieces.centre) - pieces.half[1:] - pieces.half[:-1]
    broken = (np.diff(pieces.lane) != 0) | (apart > slack) | np.isinf(pieces.value[1:])
    chain = np.concatenate([[0], np.cumsum(broken)])
    signed = np.nonzero(np.isfinite(pieces.value) & (pieces.value != 0.0))[0]
    first, last = signed[:-1], signed[1:]
    together = chain[first] == chain[last]
    return first[together], last[together]
