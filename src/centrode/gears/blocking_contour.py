"""The blocking contour of a pair: which shifts (x_1, x_2) are possible at all, and which are good.

In the plane of both shifts each of these bounds what is possible: a wheel is undercut, a tip is pointed, contact ends
before the next tooth takes over, a tip runs into a fillet. What is left lies inside the blocking contour (Bolotovsky et
al., "Handbook of geometrical calculation of involute gearing", 1986).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.optimize import brentq

from centrode.gears.involutes import Array
from centrode.gears.pair_geometry import PairGeometry

LEAST_CONTACT_RATIO = 1.2
LEAST_TIP_THICKNESS = 0.25
"""Of a tooth at its tip, in modules."""
CURVES = (
    "undercut_1",
    "undercut_2",
    "interference_1",
    "interference_2",
    "pointed_1",
    "pointed_2",
    "contact_ratio_1",
    "contact_ratio_1.2",
    "tip_0.25_1",
    "tip_0.25_2",
    "tip_0.4_1",
    "tip_0.4_2",
    "equal_sliding",
)
"""Names of the curves; the last digit after an underscore is the wheel's number."""
_LEAP = 6
"""Steps of the grid over which no curve is joined."""
BLOCKING = CURVES[:7]
"""Of these every one has to be positive for the pair to work."""


@dataclass(frozen=True, eq=False)
class BlockingContour:
    """Margins over a grid of both shifts, and the curves on which they vanish.

    Attributes
    ----------
    pair : whose shifts vary
    first, second : (n) and (m) values of x_1 and x_2
    margins : name -> (n, m), positive where that is in order; NaN where the wheels cannot mesh
    curves : name -> (k, 2) places (x_1, x_2) where the margin vanishes, in the order of x_1; parted by rows of NaN
    """

    pair: PairGeometry
    first: Array
    second: Array
    margins: Mapping[str, Array]
    curves: Mapping[str, Array]

    @property
    def possible(self) -> Array:
        """(n, m) the least of the margins that block: positive inside the contour; -1 where the wheels cannot mesh."""
        lowest = np.min(np.stack([self.margins[name] for name in BLOCKING]), axis=0)
        return np.where(np.isnan(lowest), -1.0, lowest)


def margins_of(pair: PairGeometry) -> dict[str, float]:
    """How far a pair is from each curve of the contour: positive where that is in order, NaN where it cannot mesh.

    Margins of undercut are shifts, those of fillets tangents of pressure angles, those of tips modules, those of the
    contact ratio its excess over the bound.
    """
    if math.isnan(pair.working_angle):
        return dict.fromkeys(CURVES, math.nan)
    first, second = pair.wheels
    module = pair.module
    ratio = pair.contact_ratio
    found = {"contact_ratio_1": ratio - 1, "contact_ratio_1.2": ratio - LEAST_CONTACT_RATIO}
    for number, wheel in ((1, first), (2, second)):
        generated = not wheel.internal and math.isfinite(wheel.teeth)
        found[f"undercut_{number}"] = wheel.shift - wheel.least_shift if generated else 1.0
        gap = math.tan(wheel.active_pressure) - math.tan(wheel.flank_pressure) if generated else 1.0
        found[f"interference_{number}"] = gap
        thickness = wheel.tip_thickness / module
        found[f"pointed_{number}"] = thickness
        found[f"tip_0.25_{number}"] = thickness - LEAST_TIP_THICKNESS
        found[f"tip_0.4_{number}"] = thickness - 0.4
    found["equal_sliding"] = sliding_difference(pair)
    return {name: found[name] for name in CURVES}


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
    nodes : of the grid along each shift; places of curves are exact along x_2 to rounding

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


def _curve(pair: PairGeometry, name: str, across: Array, up: Array, margin: Array) -> Array:
    """Where a margin vanishes along x_2 at each x_1; where it does not depend on x_2, along x_1 at each x_2."""
    if name == "undercut_1":
        least = pair.wheels[0].least_shift
        return (
            np.array([[least, up[0]], [least, up[-1]]])
            if across[0] <= least <= across[-1]
            else np.empty((0, 2))
        )
    branches: list[list[tuple[float, float]]] = []
    step = float(up[1] - up[0])
    for row, x in enumerate(across):
        roots = _roots(partial(_margin, pair, name, float(x)), up, margin[row])
        while len(branches) < len(roots):
            branches.append([(math.nan, math.nan)])
        for branch in range(len(branches)):
            place = (float(x), roots[branch]) if branch < len(roots) else (math.nan, math.nan)
            if (
                abs(place[1] - branches[branch][-1][1]) > _LEAP * step
            ):  # another branch, or another part of the curve
                branches[branch].append((math.nan, math.nan))
            branches[branch].append(place)
    return np.array([place for branch in branches for place in branch]) if branches else np.empty((0, 2))


def _margin(pair: PairGeometry, name: str, first: float, second: float) -> float:
    return margins_of(with_shifts(pair, first, second))[name]


def _roots(margin: Callable[[float], float], up: Array, values: Array) -> list[float]:
    """Zeros of a margin between neighbouring nodes of a line of the grid, at rounding."""
    found = []
    for lower, upper, left, right in zip(up, up[1:], values, values[1:], strict=False):
        if math.isfinite(left) and math.isfinite(right) and (left < 0) != (right < 0):
            # A jump is no zero: sliding beyond a base circle changes there from one side to the other.
            root = float(brentq(margin, float(lower), float(upper), xtol=1e-13))
            if abs(margin(root)) < 1e-6:
                found.append(root)
    return found
