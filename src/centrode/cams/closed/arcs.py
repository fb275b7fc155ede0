"""Closed paths of a roller's centre: a working arc by the law, and what brings the roller back to its beginning."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.cams.frames import Array, PolarCurve, frames
from centrode.cams.path import RollerPath, SymmetricPath
from centrode.errors import InputError
from centrode.locale import _

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
        """Its ends and breaks, growing: it is smooth between them."""
        return self.start, *self.breaks, self.stop


@dataclass(frozen=True)
class Joint:
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
        places, arcs = self.located(phi)
        found = np.full((order + 1, places.size), np.nan)
        for number, arc in enumerate(self.arcs):
            here = arcs == number
            if here.any():
                found[:, here] = arc.curve.radius(places[here], order)
        return found

    def located(self, phi: Array) -> tuple[Array, NDArray[np.intp]]:
        """Angles reduced to the turn from `start`, and the number of the arc of each."""
        given = np.atleast_1d(np.asarray(phi, dtype=np.float64))
        turns = np.floor((given - self.start) / math.tau)
        # what lies within the turn keeps its digits
        places = np.where((given >= self.start) & (given <= self.stop), given, given - math.tau * turns)
        slack = 1e3 * ROUNDING
        inside = (places >= self.start - slack) & (places <= self.stop + slack)
        places = np.where(inside, np.clip(places, self.start, self.stop), np.nan)
        ends = [arc.stop for arc in self.arcs[:-1]]
        return places, np.searchsorted(ends, places, side="right")

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """Where arcs meet; the last one closes the turn."""
        if not self.whole:
            return ()
        behind = (*self.arcs[1:], self.arcs[0])
        return tuple(_joint(one, two) for one, two in zip(self.arcs, behind, strict=True))

    @property
    def greatest_kink(self) -> float:
        """The greatest kink of a joint [rad], without sign."""
        return max((abs(joint.kink) for joint in self.joints), default=0.0)


def _joint(one: Arc, two: Arc) -> Joint:
    before, behind = frames(one.curve, np.array([one.stop])), frames(two.curve, np.array([two.start]))
    return Joint(
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
        breaks = {0.0, *breaks, *(-one for one in breaks)}
    return tuple(sorted(one for one in breaks if start < one < stop))


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
    short = ROUNDING + 4 * np.finfo(float).eps * abs(stop)
    if start < path.start - short or stop > path.stop + short:
        arc, there = (
            _("{first:.6g} to {last:.6g} deg").format(first=math.degrees(low), last=math.degrees(high))
            for low, high in ((start, stop), (path.start, path.stop))
        )
        what = _("the working arc goes from {arc}, the path from {there}").format(arc=arc, there=there)
        stalled = _("the follower stalls there: take more legs or another law")
        raise InputError(
            "[range]",
            what,
            stalled if path.stall is not None else _("ask for a longer path, or a symmetric law"),
        )
    if not 0 < stop - start < math.tau - ROUNDING:
        what = _("a working arc is longer than zero and shorter than a turn")
        raise InputError("[mover] working_arc" if half is not None else "[range]", what, _("change it"))
    return Arc("working", path, start, stop, breaks_of(path, start, stop))


def mirrored(working: Arc) -> ClosedPath:
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
        raise InputError("", what, _("take {arc:.6g} deg, or a designed return arc").format(arc=nearest))
    arcs = [working]
    images = count - (2 if start != working.start else 1)
    for number in range(1, images + 1):
        arcs.append(_image(working, start, width, number))
    last = arcs[-1]
    arcs[-1] = Arc(last.kind, last.curve, last.start, working.start + math.tau, last.breaks)
    return ClosedPath(tuple(arcs))


def _image(working: Arc, start: float, width: float, number: int) -> Arc:
    """The `number`-th image behind a working arc: mirrored if odd; a symmetric arc's images go in halves."""
    first, stop = start + number * width, start + (number + 1) * width
    odd = bool(number % 2)
    by = 2 * start + (number + 1) * width if odd else number * width
    curve = Turned(working.curve, start, working.stop, by, odd)
    inner = [one for one in working.breaks if start < one < working.stop]
    images = sorted((by - one if odd else by + one) for one in inner)
    return Arc("return", curve, first, stop, tuple(images))
