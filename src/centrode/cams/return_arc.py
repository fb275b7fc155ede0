"""The return arc of a cam, designed: the smoothest curve within bounds of size and curvature that joins both ends."""

from __future__ import annotations

import functools
import importlib
import math
from dataclasses import dataclass
from functools import cached_property
from math import factorial
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.cams.nodes import nodes_of
from centrode.cams.roller_path import JETS, Array, Frames, PolarCurve, RollerPath, SymmetricPath, frames
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.numerics.jets import Jet
from centrode.numerics.search import Extremes, extremes

# slower to import than NumPy
_optimize = functools.partial(importlib.import_module, "scipy.optimize")

# Closed paths of a roller's centre: a working arc by the law, and what brings the roller back to its
# beginning.

Kind: TypeAlias = Literal["working", "return"]
ROUNDING = 1e-12
"""Angles [rad] that are the same."""


@dataclass(frozen=True)
class Turned:
    """The stretch of a curve from `start` to `stop`, turned by an angle [rad], mirrored before that if asked."""

    curve: PolarCurve
    start: float
    stop: float
    by: float
    mirrored: bool = False

    def radius(self, phi: Array, order: int = 0) -> Array:
        sign = -1.0 if self.mirrored else 1.0
        # the sum of angles may leave the stretch by rounding
        own = np.clip(sign * (np.asarray(phi) - self.by), self.start, self.stop)
        # odd derivatives change their sign where the curve is mirrored
        return sign ** np.arange(order + 1)[:, None] * self.curve.radius(own, order)


@dataclass(frozen=True)
class Arc:
    """A stretch of a closed path from `start` to `stop` [rad].

    `breaks` (growing, inside) are angles at which higher derivatives of the radius jump.
    """

    kind: Kind
    curve: PolarCurve
    start: float
    stop: float
    breaks: tuple[float, ...] = ()

    @property
    def edges(self) -> tuple[float, ...]:
        """Angles of the ends and breaks, growing: the arc is smooth between them."""
        return self.start, *self.breaks, self.stop


@dataclass(frozen=True)
class ArcJoint:
    """Where two arcs meet.

    Attributes
    ----------
    at : float [rad]
    gap : float [m]
        Radius behind it less that before it.
    kink : float [rad]
        By how much the pressure angle jumps; negative where the path has an outward corner.
    curvature_jump : float [1/m]
    curvature_slope_jump : float [1/m/rad]
    """

    at: float
    gap: float
    kink: float
    curvature_jump: float
    curvature_slope_jump: float


@dataclass(frozen=True)
class ClosedPath:
    """Arcs end to end over one turn; angles outside are reduced to it.

    At a joint value and derivatives are those of the arc behind it. A single arc may be shorter than a turn: then the
    path is open, it has no joints, and there is nothing beyond its ends.
    """

    arcs: tuple[Arc, ...]

    @property
    def start(self) -> float:
        return self.arcs[0].start

    @property
    def stop(self) -> float:
        return self.arcs[-1].stop

    @property
    def whole(self) -> bool:
        """Whether it goes round a whole turn."""
        return abs(self.stop - self.start - math.tau) < 1e3 * ROUNDING

    @property
    def edges(self) -> tuple[float, ...]:
        """Ends and breaks of all arcs, growing."""
        return *(edge for arc in self.arcs for edge in arc.edges[:-1]), self.stop

    def radius(self, phi: Array, order: int = 0) -> Array:
        """Polar radius and its derivatives by phi (order + 1, n) [m/rad^k]."""
        places, arcs = self.locate(phi)
        radii = np.full((order + 1, places.size), np.nan)
        for number, arc in enumerate(self.arcs):
            here = arcs == number
            if here.any():
                radii[:, here] = arc.curve.radius(places[here], order)
        return radii

    def locate(self, phi: Array) -> tuple[Array, NDArray[np.intp]]:
        """Angles reduced to the turn from `start`, and the number of the arc of each."""
        given = np.atleast_1d(np.asarray(phi, dtype=np.float64))
        turns = np.floor((given - self.start) / math.tau)
        # what lies within the turn keeps its digits
        places = np.where((given >= self.start) & (given <= self.stop), given, given - math.tau * turns)
        slack = 1e3 * ROUNDING
        inside = (places >= self.start - slack) & (places <= self.stop + slack)
        places = np.where(inside, np.clip(places, self.start, self.stop), np.nan)
        ends = [arc.stop for arc in self.arcs[:-1]]
        # at a joint the arc behind it holds
        return places, np.searchsorted(ends, places, side="right")

    @cached_property
    def joints(self) -> tuple[ArcJoint, ...]:
        """Where arcs meet; the last one closes the turn."""
        if not self.whole:
            return ()
        behind = (*self.arcs[1:], self.arcs[0])
        return tuple(_joint(one, two) for one, two in zip(self.arcs, behind, strict=True))

    @property
    def greatest_kink(self) -> float:
        """The greatest kink of a joint [rad], without sign."""
        return max((abs(joint.kink) for joint in self.joints), default=0.0)


def _joint(one: Arc, two: Arc) -> ArcJoint:
    # the pressure angle, the curvature and its slope compare better than derivatives of the radius, whose
    # size depends on it
    before, behind = frames(one.curve, np.array([one.stop])), frames(two.curve, np.array([two.start]))
    return ArcJoint(
        one.stop,
        float(behind.radius[0] - before.radius[0]),
        float(behind.pressure_angle[0] - before.pressure_angle[0]),
        float(behind.curvature[0] - before.curvature[0]),
        float(behind.curvature_slope[0] - before.curvature_slope[0]),
    )


def breaks_of(path: RollerPath, start: float, stop: float) -> tuple[float, ...]:
    """Angles between `start` and `stop` at which higher derivatives of a path jump, growing."""
    breaks = set(path.law.breaks)
    if isinstance(path, SymmetricPath):
        # a symmetric path has the breaks of its half on both sides, and one in the middle
        breaks = {0.0, *breaks, *(-place for place in breaks)}
    return tuple(sorted(place for place in breaks if start < place < stop))


def working_arc(path: RollerPath, legs: int | None = None, half: float | None = None) -> Arc:
    """The working arc of a path: +-pi/legs, +-half, or the whole path.

    Parameters
    ----------
    legs : int, optional
        Number of legs of a mover: each works over +-pi/legs.
    half : float [rad], optional
        Half of the arc.

    Raises
    ------
    InputError
        The path does not reach that far (it ends, or the follower stalls before), or the arc is a whole turn.
    """
    start, stop = path.start, path.stop
    if half is None and legs is not None:
        half = math.pi / legs
    if half is not None:
        start, stop = -half, half
    # a range that reaches the end of the path but for rounding counts as reaching it
    short = ROUNDING + 4 * np.finfo(float).eps * abs(stop)
    if start < path.start - short or stop > path.stop + short:
        arc, there = (
            _("{first:.6g} to {last:.6g} deg").format(first=math.degrees(low), last=math.degrees(high))
            for low, high in ((start, stop), (path.start, path.stop))
        )
        what = _("the working arc covers {arc}, the path {there}").format(arc=arc, there=there)
        stalled = _("the follower stalls there: use more legs or another law")
        raise InputError(
            "[range]",
            what,
            stalled if path.stall is not None else _("give a longer path, or a symmetric law"),
        )
    if not 0 < stop - start < math.tau - ROUNDING:
        what = _("a working arc must be longer than zero and shorter than a turn")
        raise InputError("[mover] working_arc" if half is not None else "[range]", what, _("change it"))
    return Arc("working", path, start, stop, breaks_of(path, start, stop))


def mirror_arc(working: Arc) -> ClosedPath:
    """The path that is closed by mirror images of the working arc, with a kink wherever gamma is not zero.

    Raises
    ------
    InputError
        The arc (its half if it is symmetric) does not go into half a turn.
    """
    start = 0.0 if isinstance(working.curve, SymmetricPath) else working.start
    width = working.stop - start
    count = round(math.tau / width)
    if count % 2 or abs(count * width - math.tau) > 1e3 * ROUNDING:
        what = _("mirror images of an arc of {arc:.6g} deg do not close").format(arc=math.degrees(width))
        nearest = math.degrees(math.pi / max(1, round(math.pi / width)))
        raise InputError("", what, _("use {arc:.6g} deg, or a designed return arc").format(arc=nearest))
    arcs = [working]
    # a symmetric arc is two images of its half
    images = count - (2 if start != working.start else 1)
    for number in range(1, images + 1):
        arcs.append(_image(working, start, width, number))
    last = arcs[-1]
    # the last joint closes the turn exactly
    arcs[-1] = Arc(last.kind, last.curve, last.start, working.start + math.tau, last.breaks)
    return ClosedPath(tuple(arcs))


def _image(working: Arc, start: float, width: float, number: int) -> Arc:
    """The `number`-th image behind a working arc: mirrored if odd; a symmetric arc's images go in halves."""
    first, stop = start + number * width, start + (number + 1) * width
    odd = bool(number % 2)
    # an odd image is mirrored about its beginning, an even one is only turned
    by = 2 * start + (number + 1) * width if odd else number * width
    curve = Turned(working.curve, start, working.stop, by, odd)
    inner = [place for place in working.breaks if start < place < working.stop]
    images = sorted((by - place if odd else by + place) for place in inner)
    return Arc("return", curve, first, stop, tuple(images))


# Curves that join two ends of a path in value, slope and curvature: the smoothest one and what may be added
# to it.
#
# The smoothest one leaves rho'' + rho, which is constant on a circle about the cam's centre and to first
# order on any circle, as constant as it can: the integral of (rho''' + rho')^2 is least. By the equation of
# Euler and Lagrange, D^2 (D^2 + 1)^2 rho = 0, it is a sum of 1, tau, cos tau, sin tau, tau cos tau, tau sin
# tau. What may be added, a polynomial that vanishes at both ends with its derivatives, is square to it in the
# same integral, so that integrals add.

GAUSS_NODES = 96
"""Gauss nodes of the integral of smoothness."""


@dataclass(frozen=True)
class Ends:
    """Ends that a return arc joins: angles [rad] and derivatives of the radius there, from value on [m/rad^k]."""

    start: float
    stop: float
    at_start: tuple[float, ...]
    at_stop: tuple[float, ...]

    @property
    def contact(self) -> int:
        """The highest derivative that joins."""
        return len(self.at_start) - 1

    @property
    def middle(self) -> float:
        return 0.5 * (self.start + self.stop)

    @property
    def half(self) -> float:
        return 0.5 * (self.stop - self.start)


@dataclass(frozen=True)
class ReturnCurve:
    """A curve between ends: the smoothest one plus `weights` of the additions, a PolarCurve."""

    ends: Ends
    weights: tuple[float, ...] = ()

    def radius(self, phi: Array, order: int = 0) -> Array:
        """Polar radius and its derivatives by phi (order + 1, n) [m/rad^k]; NaN outside the ends."""
        given = np.asarray(phi, dtype=np.float64)
        slack = 1e-12
        inside = (given >= self.ends.start - slack) & (given <= self.ends.stop + slack)
        rows = derivatives(self.ends, given, order, len(self.weights))
        radii = np.tensordot(np.array([*self.smoothest, *self.weights]), rows, axes=1)
        return np.where(inside, radii, np.nan)

    @cached_property
    def smoothest(self) -> Array:
        """Weights of the functions of the smoothest curve."""
        contact = self.ends.contact
        rows = [
            derivatives(self.ends, np.array([at]), contact, 0)[:, :, 0].T
            for at in (self.ends.start, self.ends.stop)
        ]
        # as many functions as conditions at both ends
        return np.linalg.solve(np.concatenate(rows), np.array([*self.ends.at_start, *self.ends.at_stop]))


def derivatives(ends: Ends, phi: Array, order: int, additions: int) -> Array:
    """Derivatives (function, order + 1, n) of the smoothest curve's functions and of the additions."""
    # about the middle of the arc, so that powers of tau stay small
    tau = Jet([phi - ends.middle, *([np.ones_like(phi)] if order else []), *([0.0 * phi] * (order - 1))])
    shares = tau * (1.0 / ends.half)
    jets = [*_kernel(tau, ends.contact), *_additions(shares, ends.contact, additions)]
    # Taylor coefficients to derivatives
    return np.array([[c * factorial(k) for k, c in enumerate(jet.coefficients)] for jet in jets])


def roughness(ends: Ends, additions: int) -> Array:
    """Integrals (additions, additions) of the products of rho^(c+1) + rho^(c-1) of the additions, c the contact."""
    roots, weights = np.polynomial.legendre.leggauss(GAUSS_NODES)
    contact = ends.contact
    rows = derivatives(ends, ends.middle + ends.half * roots, contact + 1, additions)[-additions:]
    # with contact 3 one derivative higher, as the integral then is of (rho'''' + rho'')^2
    values = rows[:, contact + 1] + rows[:, contact - 1]
    return np.asarray((values * (weights * ends.half)) @ values.T)


def _kernel(tau: Jet, contact: int) -> list[Jet]:
    """1, tau, ... and the sines and cosines with tau: 2 (contact + 1) functions."""
    sine, cosine = JETS.sin(tau), JETS.cos(tau)
    powers = [tau * 0.0 + 1.0]
    # kernel of D^2 (D^2 + 1)^2, with two powers more for each further order of contact
    for _power in range(2 * contact - 3):
        powers.append(powers[-1] * tau)
    return [*powers, cosine, sine, tau * sine, tau * cosine]


def _additions(shares: Jet, contact: int, count: int) -> list[Jet]:
    """Legendre polynomials of x = tau / half times (1 - x^2)^(contact + 1)."""
    if not count:
        return []
    # vanishes at both ends with as many derivatives as join
    window = (1.0 - shares * shares) ** (contact + 1)
    legendre = [shares * 0.0 + 1.0, shares]
    for n in range(1, count):
        # the recurrence (n + 1) P_(n+1) = (2 n + 1) x P_n - n P_(n-1)
        legendre.append((shares * legendre[n] * (2 * n + 1.0) - legendre[n - 1] * float(n)) / (n + 1.0))
    return [window * polynomial for polynomial in legendre[:count]]


# Bounds of a return arc: its size and its curvature, and by how much a curve keeps them.

MOST = 16
"""Functions added to the smoothest curve."""
TOLERANCE = 1e-9
"""Share of a bound by which it counts as kept."""


@dataclass(frozen=True)
class ArcBounds:
    """Bounds of the roller-centre path on its return arc.

    Attributes
    ----------
    least_radius, greatest_radius : float [m]
        Of the polar radius.
    least_bend : float [m]
        Least radius of curvature where the path bends towards the cam's centre (convex); it has to exceed the
        roller's radius or the profile is undercut.
    convex : bool
        No inward bend anywhere.
    least_hollow : float [m]
        Least radius of curvature where the path bends away from the centre; of no use with `convex`.
    pressure_angle : float [rad]
        Greatest pressure angle, without sign.
    """

    least_radius: float = 0.0
    greatest_radius: float = math.inf
    least_bend: float = 0.0
    convex: bool = True
    least_hollow: float = 0.0
    pressure_angle: float = math.pi / 2

    def __post_init__(self) -> None:
        lengths = (self.least_radius, self.greatest_radius, self.least_bend, self.least_hollow)
        if any(math.isnan(length) or length < 0 for length in lengths) or math.isinf(self.least_radius):
            raise InputError("[return]", _("bounds must be positive lengths"), _("correct them"))
        if not 0 < self.pressure_angle <= math.pi / 2:
            what = _("the greatest pressure angle must lie between 0 and 90 deg")
            raise InputError("[return] pressure_angle", what, _("correct it"))
        if self.least_radius >= self.greatest_radius:
            what = _("the least radius must be smaller than the greatest")
            raise InputError("[return]", what, _("exchange or widen them"))

    @property
    def greatest_curvature(self) -> float:
        """Of the path [1/m]."""
        return 1.0 / self.least_bend if self.least_bend else math.inf

    @property
    def least_curvature(self) -> float:
        """Of the path [1/m]: negative where it may bend away from the centre."""
        if self.convex:
            return 0.0
        return -1.0 / self.least_hollow if self.least_hollow else -math.inf

    def margins(self, rho: Array, moving: Array, scale: float) -> tuple[Array, Array]:
        """Margins of the bounds, positive where kept, and their gradients.

        Parameters
        ----------
        rho : (3, n)
            Radius and two derivatives, over `scale`.
        moving : (weights, 3, n)
            What they change by with each weight.
        scale : float [m]

        Returns
        -------
        (m), (m, weights)
            Of the finite bounds, in units of the scale.
        """
        bend, slopes = _curvature(rho, moving)
        steep = math.tan(self.pressure_angle) if self.pressure_angle < math.pi / 2 else math.inf
        # tan(gamma) = rho'/rho, whose sign and size the pressure angle has
        slant, slanting = rho[1] / rho[0], (moving[:, 1] - moving[:, 0] * rho[1] / rho[0]) / rho[0]
        margins, gradients = [], []
        for value, gradient, low, high in (
            # a polar radius has to stay positive whatever is requested
            (rho[0], moving[:, 0], max(self.least_radius / scale, 1e-3), self.greatest_radius / scale),
            (bend, slopes, self.least_curvature * scale, self.greatest_curvature * scale),
            (slant, slanting, -steep, steep),
        ):
            if math.isfinite(low):
                margins.append(value - low)
                gradients.append(gradient.T)
            if math.isfinite(high):
                margins.append(high - value)
                gradients.append(-gradient.T)
        return np.concatenate(margins), np.concatenate(gradients)


@dataclass(frozen=True)
class Margins:
    """Extremes of a curve beside its bounds.

    Attributes
    ----------
    radius : (least, greatest) [m]
    curvature : (least, greatest) [1/m]
    pressure_angle : float [rad]
        The greatest, without sign.
    places : tuple of float [rad]
        Where these lie.
    """

    bounds: ArcBounds
    radius: tuple[float, float]
    curvature: tuple[float, float]
    pressure_angle: float
    places: tuple[float, ...]

    @staticmethod
    def along(curve: ReturnCurve, bounds: ArcBounds) -> Margins:
        """The extremes of a whole arc."""
        size, bend, slant = sizes(curve), bends(curve), slants(curve)
        places = tuple(
            at for extreme in (size, bend, slant) for at in (extreme.at_least, extreme.at_greatest)
        )
        steepest = max(-slant.least, slant.greatest)
        # the angle counts without its sign
        return Margins(bounds, (size.least, size.greatest), (bend.least, bend.greatest), steepest, places)

    @staticmethod
    def at(frame: Frames, bounds: ArcBounds) -> Margins:
        """The values at one place."""
        size, bend = float(frame.radius[0]), float(frame.curvature[0])
        steepness = abs(float(frame.pressure_angle[0]))
        return Margins(bounds, (size, size), (bend, bend), steepness, (float(frame.phi[0]),))

    def broken(self) -> str:
        """Which bounds are broken and by how much, in words; empty if none is."""
        bounds, scale = self.bounds, self.radius[1]
        words = []
        if self.radius[0] < bounds.least_radius - TOLERANCE * scale:
            text = _("the polar radius falls to {value} mm, the bound is {bound} mm")
            words.append(text.format(value=_mm(self.radius[0]), bound=_mm(bounds.least_radius)))
        if self.radius[1] > bounds.greatest_radius + TOLERANCE * scale:
            text = _("the polar radius grows to {value} mm, the bound is {bound} mm")
            words.append(text.format(value=_mm(self.radius[1]), bound=_mm(bounds.greatest_radius)))
        if self.curvature[1] > bounds.greatest_curvature + TOLERANCE / scale:
            text = _("the radius of curvature falls to {value} mm, the bound is {bound} mm")
            words.append(text.format(value=_mm(1.0 / self.curvature[1]), bound=_mm(bounds.least_bend)))
        if self.curvature[0] < bounds.least_curvature - TOLERANCE / scale:
            value = _mm(-1.0 / self.curvature[0])
            text = _("the path is hollow with a radius of {value} mm where it has to be convex")
            if not bounds.convex:
                text = _("the radius of the hollow falls to {value} mm, the bound is {bound} mm")
            words.append(text.format(value=value, bound=_mm(bounds.least_hollow)))
        if self.pressure_angle > bounds.pressure_angle + TOLERANCE:
            text = _("the pressure angle grows to {value:.5g} deg, the bound is {bound:.5g} deg")
            steep = math.degrees(self.pressure_angle), math.degrees(bounds.pressure_angle)
            words.append(text.format(value=steep[0], bound=steep[1]))
        return "; ".join(words)


def sizes(curve: ReturnCurve) -> Extremes:
    """Extremes of the polar radius [m] over an arc."""
    nodes = nodes_of((curve.ends.start, curve.ends.stop))
    return extremes(lambda phi: curve.radius(phi)[0], lambda phi: curve.radius(phi, 1)[1], nodes)


def bends(curve: ReturnCurve) -> Extremes:
    """Extremes of the curvature [1/m] over an arc."""
    nodes = nodes_of((curve.ends.start, curve.ends.stop))
    return extremes(
        lambda phi: frames(curve, phi).curvature, lambda phi: frames(curve, phi).curvature_slope, nodes
    )


def slants(curve: ReturnCurve) -> Extremes:
    """Extremes of the pressure angle [rad] over an arc."""

    def slope(phi: Array) -> Array:
        frame = frames(curve, phi)  # gamma' = 1 - K ds/dphi
        return np.asarray(1.0 - frame.curvature * frame.speed)

    nodes = nodes_of((curve.ends.start, curve.ends.stop))
    return extremes(lambda phi: frames(curve, phi).pressure_angle, slope, nodes)


def _mm(length: float) -> str:
    return f"{1e3 * length:.6g}"


def _curvature(rho: Array, moving: Array) -> tuple[Array, Array]:
    """Curvature (n) of a polar curve and its change (weights, n) with each weight."""
    value, slope, second = rho
    square = value**2 + slope**2
    # K = (rho^2 + 2 rho'^2 - rho rho'') / (rho^2 + rho'^2)^(3/2)
    above = value**2 + 2.0 * slope**2 - value * second
    bend = above / square**1.5
    changed = (
        (2.0 * value - second) * moving[:, 0] + 4.0 * slope * moving[:, 1] - value * moving[:, 2]
    ) / square**1.5
    # by the quotient rule: the second part is that of the root below
    return bend, changed - 3.0 * bend / square * (value * moving[:, 0] + slope * moving[:, 1])


# The search for a return arc within bounds: linear, then quadratic programmes over the weights of additions.

NODES = 181
SLACK = 1e-6
"""Least room that is kept to a bound at the nodes, over the size; grows to what is missed between them."""
MOST_ROOM = 1e-3
ITERATIONS = 200
STEPS = 60
LEAST_STEP = 1e-7
ENOUGH = 0.3
"""Share of what tangents promise that a step has to gain, or the next is shorter."""


class ArcSearch:
    """Bounds at nodes as constraints on weights; lengths over `scale`, `basis` makes roughness the sum of squares."""

    def __init__(self, ends: Ends, bounds: ArcBounds, basis: Array, scale: float) -> None:
        self.ends, self.bounds, self.scale = ends, bounds, scale
        # the ends are given: nothing moves there
        self.nodes = np.linspace(ends.start, ends.stop, NODES)[1:-1]
        self.still = ReturnCurve(ends).radius(self.nodes, 2) / scale
        self.moving = np.tensordot(basis.T, derivatives(ends, self.nodes, 2, MOST)[-MOST:], axes=1)
        given = ReturnCurve(ends).radius(np.array([ends.start, ends.stop]), 2) / scale
        at_ends, _gradients = bounds.margins(given, np.zeros((MOST, 3, 2)), scale)
        # a bound that the ends nearly touch leaves no more room than half of what they have
        room = np.maximum(0.5 * at_ends.reshape(-1, 2).min(axis=1), 0.0)
        self.most_room = np.repeat(room, len(self.nodes))
        self.room = np.minimum(SLACK, self.most_room)

    def margins(self, weights: Array) -> tuple[Array, Array]:
        """Margins (m) beyond the room at the nodes and their gradients (m, weights)."""
        rho = self.still + np.tensordot(weights, self.moving, axes=1)
        margins, gradients = self.bounds.margins(rho, self.moving, self.scale)
        return margins - self.room, gradients

    def least(self, weights: Array) -> float:
        """The least margin, less the room."""
        return float((self.margins(weights)[0] + self.room).min())

    def between(self, curve: ReturnCurve) -> None:
        """Widen the room by what a curve misses between the nodes."""
        places = np.linspace(self.ends.start, self.ends.stop, 16 * NODES)
        margins, _gradients = self.bounds.margins(
            curve.radius(places, 2) / self.scale, np.zeros((MOST, 3, len(places))), self.scale
        )
        # the least margin of each bound between the nodes, as far as it is negative
        missed = -np.minimum(margins.reshape(-1, len(places)).min(axis=1), 0.0)
        # a little more than is missed, and growing: rounds come to an end
        wider = self.room + 1.3 * np.repeat(missed, len(self.nodes)) + SLACK
        self.room = np.minimum(np.minimum(wider, MOST_ROOM), self.most_room)

    def feasible(self, weights: Array) -> Array:
        """Weights whose least margin is not negative, else the greatest that is found.

        Each step is a linear programme within a box about the weights, which shrinks where the step does not do
        what its tangents promise.
        """
        margins, slopes = self.margins(weights)
        size = 1.0
        for _step in range(STEPS):
            if margins.min() >= 0.0 or size < LEAST_STEP:
                break
            solution = _optimize().linprog(
                # the unknown at the end is the least margin of the linearised bounds, which is made greatest
                np.append(np.zeros(MOST), -1.0),
                np.pad(-slopes, ((0, 0), (0, 1)), constant_values=1.0),
                margins,
                bounds=[(-size, size)] * MOST + [(None, MOST_ROOM)],
            )
            if solution.status != 0:
                break
            tried, promised = weights + solution.x[:-1], float(solution.x[-1] - margins.min())
            there = self.margins(tried)
            gained = float(there[0].min() - margins.min())
            # tangents promised more than came of it: the box was too wide for them
            if gained < ENOUGH * promised:
                size *= 0.4
            if gained > 0.0:
                weights, (margins, slopes) = tried, there
            # nothing more to be had near here
            if promised < SLACK * SLACK:
                break
        return weights

    def smoothest(self, weights: Array) -> Array:
        """From weights that keep the bounds, those with the least sum of squares that do."""
        solution = _optimize().minimize(
            lambda x: (float(x @ x), 2.0 * x),
            weights,
            jac=True,
            method="SLSQP",
            constraints={
                "type": "ineq",
                "fun": lambda x: self.margins(x)[0],
                "jac": lambda x: self.margins(x)[1],
            },
            options={"maxiter": ITERATIONS, "ftol": 1e-10},
        )
        # the programme may end outside the bounds by its tolerance: then what was feasible stays
        return np.asarray(solution.x) if self.least(solution.x) >= 0.0 else weights


ROUNDS = 8
"""Times that the bounds are tightened by what is missed between the nodes of the search."""


@dataclass(frozen=True)
class Returned:
    """A designed return arc and what it keeps.

    Attributes
    ----------
    curve : ReturnCurve
    closed : ClosedPath
    radius, curvature, pressure_angle : Extremes
        Of the arc: polar radius [m] and curvature [1/m] of the roller's path, pressure angle [rad].
    additions : int
        Functions added to the smoothest curve to keep the bounds; 0 where it keeps them by itself.
    roughness : float
        Integral of (rho''' + rho')^2 of the additions over the square of the radius at the joints; with contact 3 one
        derivative higher.
    """

    curve: ReturnCurve
    closed: ClosedPath
    radius: Extremes
    curvature: Extremes
    pressure_angle: Extremes
    additions: int
    roughness: float


def design_return(working: Arc, bounds: ArcBounds | None = None, *, contact: int = 2) -> Returned:
    """Close a working arc by the smoothest return arc within bounds.

    Parameters
    ----------
    contact : 2 or 3
        Up to which derivative the arc joins: curvature, or the slope of the curvature as well.

    Raises
    ------
    InputError
        The working arc itself breaks a bound at its ends; `contact` is another number.
    MotionError
        No curve of the family keeps the bounds: the message says by how much the best one misses them.

    Notes
    -----
    Joins are exact to rounding; bounds are kept over the whole arc to 1e-9 of the size. The family has 16 functions
    besides the smoothest curve, found by sequential quadratic programming from it: the best near it, which is no
    proof that no other curve exists.
    """
    if contact not in (2, 3):
        raise InputError("", _("a return arc joins in curvature (2) or in its slope as well (3)"))
    bounds = bounds or ArcBounds()
    ends = _ends(working, contact)
    _ends_keep(ends, bounds)
    curve = ReturnCurve(ends)
    # the smoothest curve alone, if it keeps the bounds
    if not Margins.along(curve, bounds).broken():
        return _close_path(working, curve, 0.0)
    weights, size = _search_weights(ends, bounds)
    return _close_path(working, ReturnCurve(ends, weights), size)


def _ends(working: Arc, contact: int) -> Ends:
    """Derivatives of the radius at both ends of the gap, from inside the working arc."""
    stop, start = (
        working.curve.radius(np.array([at]), contact)[:, 0] for at in (working.stop, working.start)
    )
    return Ends(working.stop, working.start + math.tau, tuple(stop.tolist()), tuple(start.tolist()))


def _ends_keep(ends: Ends, bounds: ArcBounds) -> None:
    """Raise InputError where the joints alone break a bound."""
    curve = ReturnCurve(ends)
    for at in (ends.start, ends.stop):
        broken = Margins.at(frames(curve, np.array([at])), bounds).broken()
        if broken:
            what = _(
                "the working arc violates a bound of the return arc where they join, at {at:.6g} deg:"
            ).format(at=math.degrees(at))
            raise InputError("[return]", f"{what} {broken}", _("relax the bound"))


def _search_weights(ends: Ends, bounds: ArcBounds) -> tuple[tuple[float, ...], float]:
    """Weights of additions that keep the bounds, with the least roughness; and that roughness."""
    scale = math.sqrt(ends.at_start[0] * ends.at_stop[0])
    # in these weights, roughness is the sum of squares
    # with roughness = w' R w and R = L L', weights L'^-1 x have the roughness x' x
    basis = np.linalg.inv(np.linalg.cholesky(roughness(ends, MOST)).T)
    search = ArcSearch(ends, bounds, basis, scale)
    weights = np.zeros(MOST)
    for _round in range(ROUNDS):
        # first into the bounds, then as smooth as may be within them
        weights = search.feasible(weights)
        possible = search.least(weights) >= 0.0
        weights = search.smoothest(weights) if possible else weights
        curve = ReturnCurve(ends, tuple((scale * basis @ weights).tolist()))
        margins = Margins.along(curve, bounds)
        if not margins.broken():
            return curve.weights, float(weights @ weights)
        # where nothing keeps them at the nodes, more nodes will not help
        if not possible:
            break
        search.between(curve)
    raise MotionError(
        "[return]",
        _("no return arc satisfies the bounds; the best one violates: {broken}").format(
            broken=margins.broken()
        ),
        _("relax them"),
    )


def _close_path(working: Arc, curve: ReturnCurve, size: float) -> Returned:
    closed = ClosedPath((working, Arc("return", curve, curve.ends.start, curve.ends.stop)))
    return Returned(curve, closed, sizes(curve), bends(curve), slants(curve), len(curve.weights), size)
