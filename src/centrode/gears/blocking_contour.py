"""The blocking contour of a pair: which shifts (x_1, x_2) are possible at all, and which are good.

In the plane of both shifts each of these bounds what is possible: a wheel is undercut, a tip is pointed, contact ends
before the next tooth takes over, a tip runs into a fillet, or into the other tip in an internal pair. What is left lies
inside the blocking contour (Bolotovsky et al., "Handbook of geometrical calculation of involute gearing", 1986).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from centrode.gears.involutes import Array
from centrode.gears.pair_geometry import PairGeometry
from centrode.gears.shift_fields import ShiftFields, shift_fields
from centrode.numerics.search import interpolated_roots

LEAST_CONTACT_RATIO = 1.2
LEAST_TIP_THICKNESS = 0.25
"""Of a tooth at its tip, in modules."""
CURVES = (
    "mesh",
    "undercut_1",
    "undercut_2",
    "interference_1",
    "interference_2",
    "pointed_1",
    "pointed_2",
    "tips",
    "contact_ratio_1",
    "contact_ratio_1.2",
    "tip_0.25_1",
    "tip_0.25_2",
    "tip_0.4_1",
    "tip_0.4_2",
    "equal_sliding",
)
"""Names of the curves; the last digit after an underscore is the wheel's number."""
BLOCKING = CURVES[:9]
"""Of these every one has to be positive for the pair to work."""


@dataclass(frozen=True, eq=False)
class BlockingContour:
    """Margins over a grid of both shifts, and the curves on which they vanish.

    Attributes
    ----------
    pair : whose shifts vary
    first, second : (n) and (m) values of x_1 and x_2
    margins : name -> (n, m), positive where that is in order; all but "mesh" are NaN where the wheels cannot mesh
    curves : name -> (k, 2) places (x_1, x_2) along the curve on which the margin vanishes; rows of NaN between parts
    """

    pair: PairGeometry
    first: Array
    second: Array
    margins: Mapping[str, Array]
    curves: Mapping[str, Array]

    @property
    def possible(self) -> Array:
        """(n, m) the least of the margins that block: positive inside the contour."""
        return np.asarray(np.fmin.reduce([self.margins[name] for name in BLOCKING]))


def margins_of(pair: PairGeometry) -> dict[str, float]:
    """How far a pair is from each curve of the contour, by `margins_at` its shifts."""
    return {name: float(margin) for name, margin in margins_at(pair, *pair.shifts).items()}


def margins_at(pair: PairGeometry, first: ArrayLike, second: ArrayLike) -> dict[str, Array]:
    """How far a pair with shifts (...) is from each curve of the contour: positive where that is in order.

    That of the mesh is inv(alpha_w), which a mesh without play requires to be positive; where it is not, the others are
    NaN. Margins of undercut are shifts, those of fillets tangents of pressure angles, those of the thickness of
    tips modules, that of tips that pass each other an angle, those of the contact ratio its excess over the bound.
    """
    fields = shift_fields(pair, first, second)
    found = {
        "contact_ratio_1": fields.contact_ratio - 1,
        "contact_ratio_1.2": fields.contact_ratio - LEAST_CONTACT_RATIO,
        "tips": fields.tips,
    }
    for number in (1, 2):
        found[f"undercut_{number}"] = fields.above_undercut[number - 1]
        found[f"interference_{number}"] = fields.above_fillet[number - 1]
        thickness = fields.tip_thickness[number - 1]
        found[f"pointed_{number}"] = thickness
        found[f"tip_0.25_{number}"] = thickness - LEAST_TIP_THICKNESS
        found[f"tip_0.4_{number}"] = thickness - 0.4
    # Without an involute at a tip there is neither contact nor thickness: that blocks too.
    margins = {name: np.where(np.isfinite(margin), margin, -1.0) for name, margin in found.items()}
    margins["equal_sliding"] = sliding_difference(fields)
    meshes = fields.mesh >= 0
    kept = {name: np.where(meshes, margin, math.nan) for name, margin in margins.items()}
    return {"mesh": fields.mesh, **{name: kept[name] for name in CURVES[1:]}}


def sliding_difference(fields: ShiftFields) -> Array:
    """How much greater the specific sliding of the pinion is than that of the wheel, each where it is greatest.

    It is measured by the arc tangent, which stays bounded where sliding does not, as at a base circle.
    """
    first, second = (np.arctan(sliding_size(sliding)) for sliding in fields.sliding)
    return np.asarray(first - second)


def sliding_size(sliding: Array) -> Array:
    """The size of the greatest sliding of a wheel (...)."""
    # Beyond the base circle sliding turns positive through infinity: it is worse there than any finite value.
    return np.where(sliding <= 0, np.abs(sliding), np.where(np.isnan(sliding), math.nan, math.inf))


def with_shifts(pair: PairGeometry, first: float, second: float) -> PairGeometry:
    """The same wheels with other shifts."""
    return replace(pair, shifts=(first, second))


def blocking_contour(
    pair: PairGeometry,
    first: tuple[float, float] | None = None,
    second: tuple[float, float] | None = None,
    nodes: int = 61,
) -> BlockingContour:
    """The contour over a grid of shifts.

    Parameters
    ----------
    pair : whose shifts vary
    first, second : least and greatest x_1 and x_2; by default what covers the contour of usual wheels
    nodes : of the grid along each shift; places of curves are exact along its lines to rounding

    Returns
    -------
    BlockingContour
    """
    low, high = first or _default_range(pair, 0)
    below, above = second or _default_range(pair, 1)
    across, up = np.linspace(low, high, nodes), np.linspace(below, above, nodes)
    margins = margins_at(pair, across[:, None], up[None, :])
    curves = _curves(pair, across, up, margins)
    return BlockingContour(pair, across, up, margins, curves)


def _default_range(pair: PairGeometry, number: int) -> tuple[float, float]:
    """Shifts that hold the contour: from a little below undercut, or -1, to where usual tips are pointed."""
    wheel = pair.wheels[number]
    least = -1.0 if wheel.internal or math.isnan(wheel.least_shift) else max(-1.0, wheel.least_shift - 0.3)
    most = max(1.6, pair.shifts[number] + 0.4)
    return min(least, pair.shifts[number] - 0.3), most


Place = tuple[float, float]
Edge = tuple[int, int, int]
Whole = NDArray[np.intp]


def _curves(pair: PairGeometry, across: Array, up: Array, margins: Mapping[str, Array]) -> dict[str, Array]:
    """Where each margin vanishes: zeros on the lines of the grid in both directions, joined within its cells."""
    edges = {name: _crossed_edges(margins[name]) for name in CURVES}
    places = _zeros(pair, across, up, edges)
    curves = {}
    for name in CURVES:
        found = {
            edge: place
            for edge, place in zip(map(tuple, edges[name].tolist()), places[name].tolist(), strict=True)
            if not math.isnan(place[0])
        }
        between = [(math.nan, math.nan)]
        parts = _chains(_neighbours(found, margins[name]))
        joined = [place for part in parts for place in between + [found[edge] for edge in part]]
        curves[name] = np.array(joined[1:]).reshape(-1, 2)
    return curves


def _crossed_edges(margin: Array) -> Whole:
    """Edges (k, 3) of the grid over which a margin changes its sign: row, column, and 0 along x_1, 1 along x_2."""
    found = []
    below, known = margin < 0, np.isfinite(margin)
    for along in (0, 1):
        ahead, behind = (slice(1, None), slice(None, -1)) if along == 0 else (np.s_[:, 1:], np.s_[:, :-1])
        crossed = (below[ahead] != below[behind]) & known[ahead] & known[behind]
        rows, columns = np.nonzero(crossed)
        found.append(np.stack([rows, columns, np.full(rows.shape, along)], axis=-1))
    return np.concatenate(found)


def _zeros(
    pair: PairGeometry, across: Array, up: Array, edges: Mapping[str, Whole]
) -> dict[str, NDArray[np.float64]]:
    """Places (k, 2) on edges where a margin vanishes, to rounding; NaN where it jumps there. All curves at once."""
    listed = np.concatenate([edges[name] for name in CURVES])
    which = np.concatenate([np.full(len(edges[name]), number) for number, name in enumerate(CURVES)])
    rows, columns, along = listed.T
    low = np.where(along, up[columns], across[rows])
    high = np.where(
        along, up[np.minimum(columns + 1, len(up) - 1)], across[np.minimum(rows + 1, len(across) - 1)]
    )

    def at(places: Array) -> tuple[Array, Array]:
        return np.where(along, across[rows], places), np.where(along, places, up[columns])

    def margin(places: Array) -> Array:
        margins = margins_at(pair, *at(places))
        return np.choose(which, [margins[name] for name in CURVES])

    roots = interpolated_roots(margin, low, high)
    # Sliding beyond a base circle changes at once from one side to the other: that is no zero.
    roots = np.where(np.abs(margin(roots)) < 1e-6, roots, math.nan)
    first, second = at(roots)
    both = np.where(np.isnan(roots)[:, None], math.nan, np.stack([first, second], axis=-1))
    return {name: both[which == number] for number, name in enumerate(CURVES)}


def _neighbours(found: Mapping[Edge, Place], margin: Array) -> dict[Edge, list[Edge]]:
    """Which edges the curve joins within a cell: its two, or of four those that leave the middle on one side."""
    neighbours: dict[Edge, list[Edge]] = {edge: [] for edge in found}
    cells = {
        cell
        for row, column, along in found
        for cell in ((row, column), (row, column - 1) if along == 0 else (row - 1, column))
    }
    for row, column in sorted(cells):
        bottom, left = (row, column, 0), (row, column, 1)
        top, right = (row, column + 1, 0), (row + 1, column, 1)
        crossed = [edge for edge in (bottom, right, top, left) if edge in found]
        if len(crossed) == 4:
            middle = margin[row : row + 2, column : column + 2].mean()
            same = (middle < 0) == (margin[row, column] < 0)
            pairs = [(bottom, right), (top, left)] if same else [(bottom, left), (top, right)]
        else:
            pairs = [(crossed[0], crossed[1])] if len(crossed) == 2 else []
        for one, two in pairs:
            neighbours[one].append(two)
            neighbours[two].append(one)
    return neighbours


def _chains(neighbours: Mapping[Edge, list[Edge]]) -> list[list[Edge]]:
    """Edges in the order of the curves through them; a closed curve ends where it began."""
    left = dict.fromkeys(sorted(neighbours, key=lambda edge: (len(neighbours[edge]) > 1, edge)))
    chains: list[list[Edge]] = []
    while left:
        edge = next(iter(left))
        chain = [edge]
        del left[edge]
        while following := [other for other in neighbours[chain[-1]] if other in left]:
            chain.append(following[0])
            del left[following[0]]
        if len(chain) > 2 and edge in neighbours[chain[-1]]:
            chain.append(edge)
        chains.append(chain)
    return chains
