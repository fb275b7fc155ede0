"""A mechanism by its drive's value, fast and with a known error: series on panels, stretch by stretch.

Panels are those of `quadrature`: Legendre series through Gauss nodes, halved until their last terms have died
away; they end at the jumps of loads. Of a drive that turns all the way round the stretches of one period serve all
others.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import ceil, floor, inf, isfinite, tau
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt
from numpy.polynomial import legendre

from centrode.dynamics.simulation.rows import COORDINATE, EACH, FORMULAS, INERTIA, SLOPE, Rows
from centrode.dynamics.steady_motion.quadrature import NODES, resolved
from centrode.errors import InputError, MotionError
from centrode.kinematics.branches import AT_THE_START
from centrode.locale import _
from centrode.numerics.search import maxima_between

Array: TypeAlias = npt.NDArray[np.float64]

TOLERANCE = 1e-13
"""What a panel's series may leave out of an integral over a stretch, over the greatest value."""
PANELS = 72
"""Panels of a stretch at first."""
NEAR_LIMIT = 1e-6
"""Distance from a limit, in units of the drive, where a simulation ends: beyond it inertia grows without bounds."""
TOWARDS_LIMIT = (1e-2, 1e-4)
"""Distances from there at which functions are represented anew, each section to its own greatest values."""
PROBES = tau * np.array([0.0133, 0.137, 0.291, 0.454, 0.618, 0.773, 0.911])
MOST_PERIOD = 4
SAME = 1e-9
LEAST_INERTIA = 1e-9
"""Inertia, over the greatest one, below which the motion is not carried."""
LOW = 0.05
"""Share of the greatest inertia below which its minima are looked at."""
CHECKED = (-0.97, -0.31, 0.53)
"""Places within each panel, from -1 to 1, at which the series are compared with the reduction itself."""
_POWERS = np.stack(
    [np.pad(legendre.leg2poly(row), (0, NODES - 1 - k)) for k, row in enumerate(np.eye(NODES))]
)
_ROOTS, _WEIGHTS = legendre.leggauss(NODES)
_TO_SERIES = legendre.legvander(_ROOTS, NODES - 1) * _WEIGHTS[:, None] * (np.arange(NODES) + 0.5)
_TO_POWERS = _TO_SERIES @ _POWERS
"""From values at the nodes to coefficients of powers of the place within a panel."""


@dataclass(frozen=True)
class Stretch:
    """Functions on a range.

    Attributes
    ----------
    edges : (panels + 1), growing
    powers : (panels, rows, NODES)
        Coefficients of powers of the place within a panel, from -1 to 1.
    jumps : (any), growing
        Where loads jump.
    """

    edges: Array
    powers: Array
    jumps: Array


class Tracks:
    """Rows of a mechanism by the value of its drive.

    Attributes
    ----------
    rows : Rows
    low, high : where the motion ends, as far as it is known; else infinite
    period : change of the value after which everything repeats; 0.0 where it does not
    error : greatest difference from the reduction itself found so far, over the greatest values
    """

    def __init__(self, rows: Rows) -> None:
        self.rows = rows
        path = rows.reducer.ready.kinematics.path
        self.first, self.unit = path.initial, path.unit
        self.length = tau * path.unit
        self.low, self.high = -inf, inf
        self.error = 0.0
        self._stretches: dict[int, Stretch] = {}
        self._grown = np.zeros(rows.count)
        self._change_points: set[float] = set()
        self.period = self._repeats() if path.driven[0].drive.kind == "angle" else 0.0

    def stretch(self, number: int) -> Stretch:
        """The stretch that begins that many lengths from the initial value."""
        found = self._stretches.get(number)
        if found is None:
            found = self._stretches[number] = self._new(number)
        return found

    def place(self, value: float, upwards: bool) -> tuple[int, int]:
        """Number of the stretch on which a value lies, and of periods before; an edge belongs to what lies ahead."""
        share = (value - self.first) / self.length
        number = floor(share) if upwards else ceil(share) - 1
        if not self.period:
            return number, 0
        periods, inside = divmod(number, round(self.period / self.length))
        return inside, periods

    def is_change_point(self, value: float) -> bool:
        """Whether the motion ends at a change point there."""
        return any(abs(value - at) <= AT_THE_START * self.unit for at in self._change_points)

    def ending(self, value: float) -> Literal["limit", "change point"]:
        """What ends the motion at the end that is nearer to a value."""
        return "change point" if self.is_change_point(self.end(value)) else "limit"

    def end(self, value: float) -> float:
        """The end of the motion that is nearer to a value."""
        return self.low if abs(value - self.low) <= abs(value - self.high) else self.high

    def grown(self, periods: int) -> Array:
        """What rows have grown by after so many periods: coordinates that run on with the drive."""
        return periods * self._grown

    def _repeats(self) -> float:
        """After which change of the value everything repeats, but for coordinates that run on; 0.0 if it does not."""
        turns = np.arange(MOST_PERIOD + 1)
        values = (self.first + PROBES + tau * turns[:, None]).reshape(-1)
        low, high = self.rows.reducer.reach(self.first, float(values[-1]))
        if isfinite(low) or isfinite(high) or self._ends(self.first, float(values[-1])) != (-inf, inf):
            return 0.0
        rows = self.rows.at(values).reshape(self.rows.count, len(turns), -1)
        if not np.isfinite(rows).all():
            return 0.0
        scale = self.rows.scales(np.max(np.abs(rows), axis=(1, 2)))
        for count in range(1, MOST_PERIOD + 1):
            apart = rows[:, count:] - rows[:, :-count]
            grown = np.zeros(self.rows.count)
            grown[FORMULAS + COORDINATE :: EACH] = apart[FORMULAS + COORDINATE :: EACH, 0, 0]
            if np.all(np.abs(apart - grown[:, None, None]) <= SAME * scale[:, None, None]):
                self._grown = np.where(np.abs(grown) > SAME * scale, grown, 0.0)
                return tau * count
        return 0.0

    def _new(self, number: int) -> Stretch:
        """Represent the rows on a stretch, or on what of it is reached."""
        low, high = (self.first + self.length * (number + k) for k in (0, 1))
        self._look_for_limits(low, high)
        low, high = max(low, self.low), min(high, self.high)
        if not low < high:
            # empty: what holds at the end of the motion, from which forces may still lead back
            end = min(max(low, self.low), self.high)
            powers = np.zeros((1, self.rows.count, NODES))
            powers[0, :, 0] = self.rows.at(np.array([end]))[:, 0]
            return Stretch(np.array([end, end]), powers, np.empty(0))
        even = np.linspace(low, high, PANELS + 1)
        jumps = self.rows.jumps(low, high, even)
        near = np.min(np.abs(even[1:-1, None] - jumps), axis=1, initial=inf) if len(jumps) else inf
        inner = even[1:-1][np.broadcast_to(near > 1e-9 * self.length, PANELS - 1)]
        edges = np.unique(np.concatenate([even[[0, -1]], inner, jumps[(jumps > low) & (jumps < high)]]))
        parts = [self._represented(part) for part in self._sections(edges)]
        ends = np.concatenate([parts[0][0][:1], *(part[0][1:] for part in parts)])
        return Stretch(ends, np.concatenate([part[1] for part in parts]), jumps)

    def _sections(self, edges: Array) -> list[Array]:
        """Edges in sections: towards a limit functions grow, and are represented to what they are there."""
        cuts = [
            limit + side * near * self.unit
            for limit, side in ((self.low, 1.0), (self.high, -1.0))
            for near in TOWARDS_LIMIT
            if edges[0] < limit + side * near * self.unit < edges[-1]
        ]
        merged = np.unique(np.concatenate([edges, cuts]))
        places = [0, *sorted(set(np.searchsorted(merged, cuts).tolist())), len(merged) - 1]
        return [merged[i : j + 1] for i, j in pairwise(places)]

    def _represented(self, edges: Array) -> tuple[Array, Array]:
        """Edges of panels on a section, and the powers there."""
        panels, values = resolved(self.rows.at, edges, [TOLERANCE] * self.rows.count, self.rows.scales)
        powers = np.moveaxis(values.reshape(self.rows.count, -1, NODES) @ _TO_POWERS, 0, 1)
        self._check_inertia(panels.nodes, values[INERTIA])
        self._check(panels.edges, powers)
        return panels.edges, np.ascontiguousarray(powers)

    def _check_inertia(self, places: Array, inertia: Array) -> None:
        """Refuse a place at which nothing carries the motion (InputError), or at which there is none (MotionError)."""
        lacking = np.flatnonzero(~np.isfinite(inertia))
        if len(lacking):
            raise MotionError(
                "[simulation]",
                _("the motion has no derivatives where the drive is at {value:.6g}").format(
                    value=float(places[lacking[0]])
                ),
                _("start elsewhere, or change the dimensions"),
            )
        greatest = float(np.max(inertia))
        inner = inertia[1:-1]
        dips = 1 + np.flatnonzero((inner <= inertia[:-2]) & (inner <= inertia[2:]) & (inner < LOW * greatest))
        lows, inertias = self._least_inertias(places[dips - 1], places[dips + 1])
        at, least = min(
            zip(lows, inertias, strict=True), key=lambda one: one[1], default=(self.first, greatest)
        )
        if not least > LEAST_INERTIA * greatest:
            what = _(
                "nothing carries the motion where the drive is at {value:.6g}: the inertia is zero there"
            )
            raise InputError(
                "[links]",
                what.format(value=at),
                _("give the driven link an inertia, or [[machine.shafts]]"),
            )

    def _least_inertias(self, low: Array, high: Array) -> tuple[Array, Array]:
        """Places and values of the least inertia between places."""

        def lightness(places: Array) -> Array:
            return np.asarray(-self.rows.at(places.reshape(-1))[INERTIA].reshape(places.shape))

        at, greatest = maxima_between(lightness, low, high)
        return at, -greatest

    def _look_for_limits(self, low: float, high: float) -> None:
        """Learn where the motion ends: at limits, and where it has no derivatives for another reason."""
        reach = self.rows.reducer.reach(low, high)
        margin = NEAR_LIMIT * self.unit
        self.low, self.high = max(self.low, reach[0] + margin), min(self.high, reach[1] - margin)
        below, above = self._ends(low, high)
        if below > self.low:
            self.low = below
            self._change_points.add(below)
        if above < self.high:
            self.high = above
            self._change_points.add(above)
        some = np.linspace(max(low, self.low), min(high, self.high), 2 * PANELS + 1)
        missing = some[~self.rows.state(some)[1]]
        self.low = max([self.low, *missing[missing < self.first]])
        self.high = min([self.high, *missing[missing >= self.first]])

    def _ends(self, low: float, high: float) -> tuple[float, float]:
        """Nearest change points below and above the initial value, where they end the motion; infinite without any."""
        below, above = -inf, inf
        if not self.rows.ends_at_change_points:
            return below, above
        # one at the initial value itself lies behind it
        first = self.first + self.rows.sense * AT_THE_START * self.unit
        for event in self.rows.reducer.events(min(low, self.first), max(high, self.first)):
            if event.kind == "change point":
                below = max(below, event.at) if event.at <= first else below
                above = min(above, event.at) if event.at > first else above
        return below, above

    def _check(self, edges: Array, powers: Array) -> None:
        """Measure by how much the series miss the reduction between their nodes."""
        middle, half = 0.5 * (edges[:-1] + edges[1:]), 0.5 * np.diff(edges)
        for share in CHECKED:
            exact = self.rows.at(middle + share * half)
            apart = np.abs(powers @ share ** np.arange(NODES) - exact.T)
            scale = self.rows.scales(np.max(np.abs(exact), axis=1))
            counted = [INERTIA, *range(SLOPE + 1, self.rows.count)]
            self.error = max(self.error, float(np.nanmax((apart / scale)[:, counted])))
