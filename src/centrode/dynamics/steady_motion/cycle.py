"""One cycle of a machine: its period, and what its links and loads are to the drive over it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import tau
from typing import Protocol, TypeAlias

import numpy as np
import numpy.typing as npt
from numpy.polynomial import legendre

from centrode.dynamics.reduction import Reducer
from centrode.errors import InputError, MotionError, Status
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.preparation import Ready
from centrode.kinematics.solve import solve
from centrode.locale import _
from centrode.model.links import part_tables
from centrode.model.mechanism import Mechanism
from centrode.model.reading import FRAME
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.text_formula import TextFormula

# Integrals of what is smooth but for jumps: composite Gauss-Legendre quadrature with its error.
#
# Functions are given at Gauss nodes of panels, which end at the jumps. Each panel holds the Legendre series
# through its nodes, so that values and integrals exist everywhere, not at the nodes alone. Panels whose
# series has not died away are halved. Source: Gauss-Legendre quadrature and the recurrence of its
# polynomials, NIST Handbook of Mathematical Functions, sections 3.5(v) and 18.9.

Array: TypeAlias = npt.NDArray[np.float64]
Function: TypeAlias = Callable[[Array], Array]

NODES = 12
"""Gauss nodes of a panel."""
# Gauss's rule is exact to degree 23, the series to degree 11: on a panel of five degrees a function that turns up to a
# dozen times as often as the drive is left to rounding, and few panels are halved.
NOISE = 1e-9
"""Last terms, over the greatest value, that are noise (of change points passed) where halving makes them no smaller."""
MOST_PANELS = 4000
"""Panels of a cycle: 48 000 places, a bound of work. A cycle of smooth loads has `PANELS_PER_TURN` or little more."""
MOST_ROUNDS = 45
"""Halvings after which a jump that nobody announced lies in a panel of no importance."""

_ROOTS, _WEIGHTS = legendre.leggauss(NODES)
_ORDERS = np.arange(NODES)
# c_k = (k + 1/2) sum of w_i f(x_i) P_k(x_i): Gauss's rule is exact for these products
_TO_SERIES = (legendre.legvander(_ROOTS, NODES - 1) * _WEIGHTS[:, None] * (_ORDERS + 0.5)).T


@dataclass(frozen=True)
class Panels:
    """Stretches of a range, end to end: `edges` (panels + 1), growing."""

    edges: Array

    @cached_property
    def nodes(self) -> Array:
        """Gauss nodes (panels * NODES), growing."""
        return _nodes(self.edges[:-1], self.edges[1:]).reshape(-1)

    @cached_property
    def ends_and_nodes(self) -> Array:
        """Edges and nodes together, growing: where extremes are looked for."""
        return np.unique(np.concatenate([self.nodes, self.edges]))

    @cached_property
    def weights(self) -> Array:
        """Weights of the nodes (panels * NODES): the integral is the sum of weight times value."""
        return (0.5 * np.diff(self.edges)[:, None] * _WEIGHTS).reshape(-1)

    def series(self, values: Array) -> PanelSeries:
        """The function that has these values (panels * NODES) at the nodes."""
        return PanelSeries(self, values.reshape(-1, NODES) @ _TO_SERIES.T)


@dataclass(frozen=True)
class PanelSeries:
    """A function on panels: `coefficients` (panels, NODES) of Legendre polynomials."""

    panels: Panels
    coefficients: Array

    def at(self, places: Array) -> Array:
        """Values at places within the range; at a jump the one behind it."""
        panel, inner = self._inside(places)
        values = np.einsum("...k,...k->...", legendre.legvander(inner, NODES - 1), self.coefficients[panel])
        return np.asarray(values)

    def integral(self, places: Array) -> Array:
        """Integrals from the first edge to places within the range."""
        panel, inner = self._inside(places)
        inside = np.einsum("...k,...k->...", legendre.legvander(inner, NODES), self._antiderivative[panel])
        return np.asarray(self._before[panel] + inside)

    @property
    def total(self) -> float:
        """The integral over the whole range."""
        return float(self._before[-1])

    @property
    def error(self) -> float:
        """Bound of what the series leave out of `total`: their last two terms, over all panels."""
        return float(np.sum(tails(self.coefficients) * np.diff(self.panels.edges)))

    def error_at(self, places: Array) -> Array:
        """What the series may leave out of values: the last two terms of the panel of each place."""
        return tails(self.coefficients)[self._inside(places)[0]]

    def _inside(self, places: Array) -> tuple[npt.NDArray[np.intp], Array]:
        """Panel of each place, and where in it, from -1 to 1."""
        edges = self.panels.edges
        panel = np.clip(np.searchsorted(edges, places, side="right") - 1, 0, len(edges) - 2)
        low, high = edges[panel], edges[panel + 1]
        return panel, (2.0 * places - low - high) / (high - low)

    @cached_property
    def _antiderivative(self) -> Array:
        """Coefficients (panels, NODES + 1) of the integral from each panel's beginning."""
        half = 0.5 * np.diff(self.panels.edges)[:, None]
        shares = half * self.coefficients / (2 * _ORDERS + 1)
        integrals = np.zeros((len(shares), NODES + 1))
        # the integral of P_k is (P_(k+1) - P_(k-1)) / (2 k + 1)
        integrals[:, 1:] += shares
        integrals[:, : NODES - 1] -= shares[:, 1:]
        integrals[:, 0] += shares[:, 0]  # of P_0 the integral is P_1 + 1
        return integrals

    @cached_property
    def _before(self) -> Array:
        """Integrals from the first edge to every edge."""
        widths = np.diff(self.panels.edges)
        # of a panel only P_0 has an integral
        return np.concatenate([[0.0], np.cumsum(widths * self.coefficients[:, 0])])


def tails(coefficients: Array) -> Array:
    """The last terms of series (..., NODES): what they may leave out."""
    # the last two terms: of an even or odd function every second one vanishes
    return np.asarray(np.max(np.abs(coefficients[..., -2:]), axis=-1))


def resolve_panels(
    functions: Function, edges: Array, tolerances: Sequence[float], scales: Function = np.asarray
) -> tuple[Panels, Array]:
    """Panels on which several functions are smooth enough, and their values at the nodes.

    Parameters
    ----------
    functions : places (n) -> values (functions, n)
    edges : (any) growing
        The ends of the range with the jumps that are known, and as many places between as a first look needs.
    tolerances : one a function
        What a panel's series may leave out of an integral, over the greatest value times the whole range.
    scales : greatest values (functions) -> (functions)
        What counts as the greatest value, where a function may be nothing but rounding beside another.

    Returns
    -------
    panels, values (functions, panels * NODES)
        Halved until the series leave out less than that, or there are `MOST_PANELS`; `PanelSeries.error` tells
        what is left.
    """
    low, high = edges[:-1], edges[1:]
    done: list[tuple[Array, Array]] = []
    span, allowed = float(edges[-1] - edges[0]), np.asarray(tolerances)
    count, peak = len(low), np.zeros(0)
    before = np.full((len(allowed), count), np.inf)  # the last terms of the panel that each one is half of
    for _round in range(MOST_ROUNDS):
        values = functions(_nodes(low, high).reshape(-1)).reshape(-1, len(low), NODES)
        greatest = np.max(np.abs(values), axis=(1, 2))
        peak = greatest if not peak.size else np.maximum(peak, greatest)
        scale = scales(peak)[:, None]
        last = tails(values @ _TO_SERIES.T)
        # the last terms over the panel's width against what the whole range may lose
        too_great = last * (high - low) > span * allowed[:, None] * scale
        # a panel whose last terms halving does not make much smaller holds noise, which no halving resolves
        resolvable = (last < before / 4) | (last > NOISE * scale)
        coarse: npt.NDArray[np.bool_] = np.any(too_great & resolvable, axis=0)
        if count + int(coarse.sum()) > MOST_PANELS:
            # no room for more panels: what is there has to do, and the error tells
            coarse[:] = False
        done.append((low[~coarse], values[:, ~coarse]))
        if not coarse.any():
            break
        count += int(coarse.sum())
        middle = 0.5 * (low[coarse] + high[coarse])
        before = np.concatenate([last[:, coarse]] * 2, axis=1)
        # new halves behind the others: order is made at the end
        low, high = np.concatenate([low[coarse], middle]), np.concatenate([middle, high[coarse]])
    else:
        done.append((low, functions(_nodes(low, high).reshape(-1)).reshape(-1, len(low), NODES)))
    firsts = np.concatenate([part[0] for part in done])
    order = np.argsort(firsts)
    panels = Panels(np.append(firsts[order], edges[-1]))
    together = np.concatenate([part[1] for part in done], axis=1)[:, order]
    return panels, together.reshape(len(together), -1)


def _nodes(low: Array, high: Array) -> Array:
    return 0.5 * (low + high)[:, None] + 0.5 * (high - low)[:, None] * _ROOTS


# How a driving moment goes over a cycle: a formula of the drive's value and speed.


@dataclass(frozen=True)
class MomentShape:
    """A driving moment up to a factor, by a formula of `q` [rad] and of the speed `v` [rad/s], which is positive."""

    formula: TextFormula

    def at(self, values: Array, speed: Array | float) -> Array:
        """Moment (n,) up to the factor, at values (n,) [rad] and speeds [rad/s]; InputError where it is not finite."""
        # one speed as an array too: plain numbers would raise where arrays have infinities
        speeds = np.broadcast_to(np.asarray(speed, dtype=np.float64), values.shape)
        with np.errstate(all="ignore"):
            moments = self.formula(ARRAYS, q=values, v=speeds)
        moments = np.broadcast_to(np.asarray(moments, dtype=np.float64), values.shape)
        if not np.isfinite(moments).all():
            raise InputError(
                "[machine] driving",
                _("the driving moment has no finite value everywhere in the cycle"),
                _("correct the formula"),
            )
        return moments


PANELS_PER_TURN = 72
TOLERANCES = (1e-13, 1e-13, 1e-8, 1e-13)
"""Of inertia, moment, the inertia's slope, which only locates extremes, and the drive's moment."""
PROBES = 2 * np.pi * np.array([0.0133, 0.137, 0.291, 0.454, 0.618, 0.773, 0.911])
"""Places of the first turn that are looked at again in later turns; loads often jump at its beginning."""
FEW_TURNS, MOST_TURNS = 4, 60
"""Turns that are compared first, which small ratios of gears repeat after, and in all."""
SAME = 1e-7
"""Difference, over the greatest value, up to which two turns are the same: that of interpolated change points."""


class CycleReduction(Protocol):
    """Functions of a mechanism reduced to its drive that a cycle needs, by the drive's value [rad]."""

    def at(self, values: Array, rate: Array) -> tuple[Array, Array, Array]:
        """Inertia [kg m^2], its derivative, and moment of all loads [N m], at values and rates [rad/s] (n)."""

    def jumps(self, low: float, high: float) -> Sequence[float]:
        """Values of the drive between two where the moment jumps."""


@dataclass(frozen=True)
class Cycle:
    """A period of a machine whose drive turns all the way round.

    Everything counts from the beginning of the cycle, in the sense in which the drive turns: angles turned [rad]
    from 0 to `period`, and moments that drive are positive.

    Attributes
    ----------
    first : float [rad]
        The drive's value at the beginning.
    sense : +1.0 or -1.0
    turns : int
        Whole turns of the drive until everything repeats.
    inertia, slope : PanelSeries [kg m^2], [kg m^2/rad]
        Inertia of the links (group II), reduced to the drive, and its derivative.
    moment : PanelSeries [N m]
        Of all loads and weights, at the speed the cycle was computed at.
    """

    reduction: CycleReduction
    first: float
    sense: float
    turns: int
    inertia: PanelSeries
    slope: PanelSeries
    moment: PanelSeries

    @property
    def period(self) -> float:
        """Angle [rad] of a cycle."""
        return tau * self.turns

    @property
    def panels(self) -> Panels:
        """Panels of all series; they end at the jumps of the loads."""
        return self.inertia.panels

    def value(self, turned: Array) -> Array:
        """The drive's value [rad] at an angle turned."""
        return self.first + self.sense * turned

    def at_speed(self, speed: Array) -> Cycle:
        """The cycle with loads at speeds (nodes) [rad/s] of the drive at the nodes of the panels."""
        moment = _reduce_in_sense(self.reduction, self.first, self.sense, self.panels.nodes, speed)[1]
        return replace(self, moment=self.panels.series(moment))


def cycle_of(prepared: Ready, reduction: CycleReduction, shape: MomentShape | None, speed: float) -> Cycle:
    """The cycle of a mechanism at a constant speed [rad/s], on panels that fit the shape of the drive too.

    Raises
    ------
    InputError
        Loads or places that do not repeat.
    MotionError
        The mechanism does not turn fully.
    """
    path = prepared.kinematics.path
    first, sense = path.initial, path.forward
    turns = _turns(prepared, reduction, speed)

    def functions(turned: Array) -> Array:
        rows = _reduce_in_sense(reduction, first, sense, turned, np.full(len(turned), speed))
        if not np.isfinite(rows).all():
            raise _locks(prepared, turned[~np.isfinite(rows).all(axis=0)])
        drive = np.ones(len(turned)) if shape is None else shape.at(first + sense * turned, speed)
        return np.concatenate([rows, drive[None]])

    def scales(peaks: Array) -> Array:
        """Moments and slopes count beside what the links' inertia makes of the speed."""
        inertia, moment, slope, drive = peaks
        return np.array([inertia, max(moment, inertia * speed**2), max(slope, inertia), drive])

    panels, values = resolve_panels(functions, _edges(reduction, first, sense, turns), TOLERANCES, scales)
    inertia, moment, slope = (panels.series(row) for row in values[:3])
    return Cycle(reduction, first, sense, turns, inertia, slope, moment)


def check_drive(prepared: Ready) -> None:
    """Refuse, with an InputError, what has no drive that turns."""
    drives = prepared.mechanism.drives
    if len(drives) > 1:
        raise InputError(
            "[[drives]]",
            _("steady motion needs one drive, the mechanism has {count}").format(count=len(drives)),
            _("tie the drives by a gear, or omit [machine]"),
        )
    if drives[0].kind != "angle":
        raise InputError(
            "[[drives]]",
            _("steady motion needs a drive that turns"),
            _("drive the angle of a link, or omit [machine]"),
        )


def _reduce_in_sense(
    reduction: CycleReduction, first: float, sense: float, turned: Array, speed: Array
) -> Array:
    """Inertia, moment and slope (3, n) in the sense of the motion."""
    inertia, slope, moment = reduction.at(first + sense * turned, sense * speed)
    return np.stack([inertia, sense * moment, sense * slope])


def _edges(reduction: CycleReduction, first: float, sense: float, turns: int) -> Array:
    """Edges of the first panels: evenly, and at the jumps."""
    period = tau * turns
    ends = sorted((first, first + sense * period))
    jumps = sense * (np.array(sorted(reduction.jumps(*ends))) - first)
    jumps = jumps[(jumps > 0.0) & (jumps < period)]
    even = np.linspace(0.0, period, PANELS_PER_TURN * turns + 1)
    inner = even[1:-1]
    if jumps.size:
        # even edges next to a jump would leave slivers of panels
        inner = inner[np.min(np.abs(inner[:, None] - jumps), axis=1) > 1e-9]
    return np.unique(np.concatenate([even[[0, -1]], inner, jumps]))


def _turns(prepared: Ready, reduction: CycleReduction, speed: float) -> int:
    """The least number of turns after which places, inertia and loads repeat."""
    path = prepared.kinematics.path
    # few turns first, as most machines repeat after one
    for most in (FEW_TURNS, MOST_TURNS):
        turned = (PROBES + tau * np.arange(most + 1)[:, None]).reshape(-1)
        places = _places(prepared, turned)
        reduced = _reduce_in_sense(reduction, path.initial, path.forward, turned, np.full(turned.size, speed))
        if not np.isfinite(reduced).all():
            raise _locks(prepared, turned[~np.isfinite(reduced).all(axis=0)])
        inertia, moment = reduced[:2]
        # a moment that is nothing but rounding repeats
        small = 1e-6 * speed**2 * float(np.max(np.abs(inertia)))
        moves = _repeats(places, most, 0.0) & _repeats(inertia, most, 0.0)
        repeats = moves & _repeats(moment, most, small)
        if repeats.any():
            return 1 + int(np.argmax(repeats))
    if moves.any():
        raise InputError(
            "[machine]",
            _("the loads do not repeat with the motion"),
            _("steady motion needs loads that depend on positions and velocities, not on time or turns"),
        )
    raise InputError(
        "[machine]",
        _("the mechanism does not return to its initial position after {turns} turns of the drive").format(
            turns=most
        ),
        _("change the ratios of its gears"),
    )


def _repeats(values: Array, most: int, small: float) -> npt.NDArray[np.bool_]:
    """Whether values at the probes (turns * probes, ...) are the first ones again after 1, 2, ... `most` turns."""
    by_turn = values.reshape(most + 1, -1)
    # each turn against the first one, at the same probes
    apart = np.max(np.abs(by_turn[1:] - by_turn[0]), axis=1, initial=0.0)
    return np.asarray(apart <= SAME * (float(np.max(np.abs(values), initial=0.0)) + small))


def _idle_points(mechanism: Mechanism) -> set[str]:
    """Points of wheels and carriers alone that have no mass, and that no load, guide or rolling contact names."""
    named = set(
        _strings([part_tables(part) for part in (*mechanism.loads, *mechanism.guides, *mechanism.rolling)])
    )
    wheels = {name for gear in mechanism.gears for name in (*gear.links, gear.carrier)} - {FRAME} - named
    idle = {name for name in wheels if not mechanism.links[name].mass and not mechanism.links[name].inertia}
    kept = {point for name, link in mechanism.links.items() if name not in idle for point in link.coordinates}
    points = {point for name in idle for point in mechanism.links[name].coordinates}
    return points - kept - named


def _strings(value: object) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        for entry in value.values():
            yield from _strings(entry)
    elif isinstance(value, list | tuple):
        for entry in value:
            yield from _strings(entry)


def _places(prepared: Ready, turned: Array) -> Array:
    """Coordinates of all moving points (n, coordinates) but those of idle wheels.

    A planet hardly ever returns with its carrier: where it neither weighs nor is loaded, it need not.
    """
    path = prepared.kinematics.path
    ones = np.ones(len(turned))
    solved = solve(prepared, SampleGrid(turned, path.initial + path.forward * turned, ones, 0.0 * ones))
    missing = ~np.isin(solved.status[0], (Status.OK, Status.SINGULAR))
    if missing.any():
        raise _locks(prepared, turned[missing])
    idle = _idle_points(prepared.mechanism)
    kept = [place for place, point in enumerate(prepared.mechanism.moving_points) if point not in idle]
    return np.asarray(solved.points[0, 0][:, kept].reshape(len(turned), -1))


def _locks(prepared: Ready, turned: Array) -> MotionError:
    path = prepared.kinematics.path
    value = path.initial + path.forward * float(turned.min())
    return MotionError(
        "[machine]",
        _("the mechanism does not turn fully: it has no motion at {value:.6g} deg of its drive").format(
            value=np.degrees(value)
        ),
        _("change the dimensions (centrode rotatability gives the cause)"),
    )


# The reduction of a mechanism to its drive as a cycle asks for it.


class ReducedCycle:
    """A `Reducer` seen by a cycle; the time in formulas of loads runs as at the mean speed."""

    def __init__(self, reducer: Reducer) -> None:
        self.reducer = reducer
        path = reducer.ready.kinematics.path
        self.first, self.steady = path.start, reducer.default_rate or path.forward

    def at(self, values: Array, rate: Array) -> tuple[Array, Array, Array]:
        """Inertia, its derivative and moment at values and rates of the drive."""
        reduced = self.reducer.at(values, rate, time=(values - self.first) / self.steady)
        return reduced.inertia, reduced.inertia_slope, reduced.moment

    def jumps(self, low: float, high: float) -> Sequence[float]:
        """Values of the drive between two where one-sided loads jump."""
        jumps: list[float] = self.reducer.jumps(low, high).tolist()
        return jumps


def reduction_of(mechanism: Mechanism) -> CycleReduction:
    """A mechanism reduced to its drive."""
    return ReducedCycle(Reducer.of(mechanism))
