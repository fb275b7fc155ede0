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
from scipy.optimize import brentq

from centrode.gears.involutes import Array
from centrode.gears.pair_geometry import PairGeometry

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
    """How far a pair is from each curve of the contour: positive where that is in order.

    That of the mesh is inv(alpha_w), which a mesh without play requires to be positive; where it is not, the others are
    NaN. Margins of undercut are shifts, those of fillets tangents of pressure angles, those of the thickness of
    tips modules, that of tips that pass each other an angle, those of the contact ratio its excess over the bound.
    """
    mesh = pair.working_involute
    if math.isnan(pair.working_angle):
        return {**dict.fromkeys(CURVES, math.nan), "mesh": mesh}
    first, second = pair.wheels
    module = pair.module
    ratio = pair.contact_ratio
    found = {"mesh": mesh, "contact_ratio_1": ratio - 1, "contact_ratio_1.2": ratio - LEAST_CONTACT_RATIO}
    for number, wheel in ((1, first), (2, second)):
        found[f"undercut_{number}"] = wheel.shift - wheel.least_shift if wheel.is_generated else 1.0
        gap = math.tan(wheel.active_pressure) - math.tan(wheel.flank_pressure) if wheel.is_generated else 1.0
        found[f"interference_{number}"] = gap
        thickness = wheel.tip_thickness / module
        found[f"pointed_{number}"] = thickness
        found[f"tip_0.25_{number}"] = thickness - LEAST_TIP_THICKNESS
        found[f"tip_0.4_{number}"] = thickness - 0.4
    found["tips"] = min(pair.tips_clear, 1.0)
    # Without an involute at a tip there is neither contact nor thickness: that blocks too.
    blocked = {name: found[name] if math.isfinite(found[name]) else -1.0 for name in found}
    return {name: blocked.get(name, math.nan) for name in CURVES[:-1]} | {
        "equal_sliding": sliding_difference(pair)
    }


def sliding_difference(pair: PairGeometry) -> float:
    """How much greater the specific sliding of the pinion is than that of the wheel, each where it is greatest.

    It is measured by the arc tangent, which stays bounded where sliding does not, as at a base circle.
    """
    first, second = (wheel.sliding for wheel in pair.wheels)
    return math.atan(_size(first)) - math.atan(_size(second))


def _size(sliding: float) -> float:
    # Beyond the base circle sliding turns positive through infinity: it is worse there than any finite value.
    return abs(sliding) if sliding <= 0 else math.inf


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
    grid = [[margins_of(with_shifts(pair, float(x), float(y))) for y in up] for x in across]
    margins = {name: np.array([[node[name] for node in row] for row in grid]) for name in CURVES}
    curves = {name: _curve(pair, name, across, up, margins[name]) for name in CURVES}
    return BlockingContour(pair, across, up, margins, curves)


def _default_range(pair: PairGeometry, number: int) -> tuple[float, float]:
    """Shifts that hold the contour: from a little below undercut, or -1, to where usual tips are pointed."""
    wheel = pair.wheels[number]
    least = -1.0 if wheel.internal or math.isnan(wheel.least_shift) else max(-1.0, wheel.least_shift - 0.3)
    most = max(1.6, pair.shifts[number] + 0.4)
    return min(least, pair.shifts[number] - 0.3), most


Place = tuple[float, float]
Edge = tuple[int, int, int]


def _curve(pair: PairGeometry, name: str, across: Array, up: Array, margin: Array) -> Array:
    """Where a margin vanishes: zeros on the lines of the grid in both directions, joined within its cells."""
    found: dict[Edge, Place] = {}
    for row, column in np.ndindex(margin.shape):
        for along, (other_row, other_column) in enumerate(((row + 1, column), (row, column + 1))):
            if other_row < len(across) and other_column < len(up):
                ends = (margin[row, column], margin[other_row, other_column])
                if (
                    math.isfinite(ends[0])
                    and math.isfinite(ends[1])
                    and (ends[0] < 0) != (ends[1] < 0)
                    and (place := _zero(pair, name, across, up, (row, column, along)))
                ):
                    found[row, column, along] = place
    parts = _chains(_neighbours(found, margin))
    between = [(math.nan, math.nan)]
    places = [place for part in parts for place in between + [found[edge] for edge in part]]
    return np.array(places[1:]).reshape(-1, 2)


def _zero(pair: PairGeometry, name: str, across: Array, up: Array, edge: Edge) -> Place | None:
    """Where a margin vanishes between two nodes, to rounding; None where it jumps there."""
    row, column, along = edge

    def margin(value: float) -> float:
        place = (float(across[row]), value) if along else (value, float(up[column]))
        return margins_of(with_shifts(pair, *place))[name]

    line, start = (up, column) if along else (across, row)
    root = float(brentq(margin, float(line[start]), float(line[start + 1]), xtol=1e-13))
    # Sliding beyond a base circle changes at once from one side to the other: that is no zero.
    if not abs(margin(root)) < 1e-6:
        return None
    return (float(across[row]), root) if along else (root, float(up[column]))


def _neighbours(found: Mapping[Edge, Place], margin: Array) -> dict[Edge, list[Edge]]:
    """Which edges the curve joins within a cell: its two, or of four those that leave the middle on one side."""
    neighbours: dict[Edge, list[Edge]] = {edge: [] for edge in found}
    for row, column in np.ndindex(margin.shape[0] - 1, margin.shape[1] - 1):
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
