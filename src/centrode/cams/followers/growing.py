"""A cam made larger until it keeps what is asked of it: the least base circle of one offset."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from centrode.cams.followers.bodies import FollowerCam
from centrode.cams.followers.contact import ORDER, Array, Motion
from centrode.cams.followers.layouts import Layout
from centrode.cams.followers.margins import Admissible, Margin, margin
from centrode.cams.nodes import nodes_of
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.numerics.search import root, roots

SMALLEST, GREATEST = 1e-4, 1e4
"""Ends of the search over the size of the lift."""
STEP = 1.05
"""Neighbouring base radii among which the first that keeps the bounds is looked for."""
NEAR = 1e-3
"""By how much of itself a radius found on the mesh may differ from the exact one."""
STEEPEST = 1e6
"""Tangents of pressure angles from which on a bound is none."""
BACK = 0.8
"""Share of the least radius for one offset from which on that for the next is looked for."""
UNDECIDED = 1e-6
"""A margin of the least cam that is greater is none of rounding: no bound decides that radius."""
REACHED = 1e-9
"""From which share of the least radius that a follower reaches on a cam is tried."""


@dataclass(frozen=True)
class Nodes:
    """Angles (n) [rad] at which bounds are looked at, and the lift with its derivatives there."""

    phi: Array
    lift: Array


def looked_at(layout: Layout, motion: Motion, kept: Admissible) -> Nodes:
    """The mesh of a lift, and the angles at which a bound may decide."""
    phi = np.append(nodes_of(motion.edges), _decisive(layout, motion, kept))
    return Nodes(phi, motion.lift(phi, ORDER))


def _decisive(layout: Layout, motion: Motion, kept: Admissible) -> list[float]:
    """Angles at which a bound of the pressure angle may decide, whatever the offset and the radius.

    A straight line of the slope tan(bound) touches the curve of s over s' there.
    """
    if layout.kind == "oscillating" or layout.flat:
        return []
    bounds = {math.tan(one) for one in (kept.pressure_angle, kept.return_angle)}
    found: list[float] = []
    for steep in (sign * one for one in bounds if one < STEEPEST for sign in (1.0, -1.0)):

        def touches(phi: Array, steep: float = steep) -> Array:
            _lift, slope, second = motion.lift(phi, 2)
            return np.asarray(second - steep * slope)

        found += roots(touches, nodes_of(motion.edges)).tolist()
    return found


class Tried:
    """Cams of several base radii on the same nodes."""

    def __init__(self, layout: Layout, motion: Motion, kept: Admissible, nodes: Nodes | None = None) -> None:
        self.layout, self.motion, self.kept = layout, motion, kept
        nodes = nodes or looked_at(layout, motion, kept)
        self.phi, self.lift = nodes.phi, nodes.lift
        self.size = float(np.abs(self.lift[0]).max())
        if layout.kind == "oscillating":
            self.size *= layout.distance

    def cam(self, base: float) -> FollowerCam:
        return FollowerCam(self.motion, self.layout.guide(base), self.layout.touch, base, self.layout.sense)

    def margin(self, base: float) -> Margin:
        try:
            guide = self.layout.guide(base)
        except InputError:
            return Margin(-math.inf, 0.0, "reach")
        with np.errstate(divide="ignore", invalid="ignore"):
            contact = self.layout.touch.contact(guide, self.phi, self.lift, self.layout.sense)
        return margin(contact, self.lift[1], self.layout, self.kept)

    def reaches(self, base: float) -> bool:
        return self.margin(base).least > -math.inf

    def first(self, near: float = 0.0) -> float:
        """The first base radius, from below, that keeps the bounds on the mesh; from `near` on if that breaks them."""
        best, before, lowest = Margin(-math.inf, 0.0, "reach"), 0.0, self._lowest()
        for base in self._radii(near if near > lowest and self.margin(near).least < 0.0 else lowest):
            found = self.margin(base)
            if found.least >= 0.0:
                return self._between(before, float(base))
            best = max(best, found, key=lambda one: one.least)
            before = base if found.least > -math.inf else 0.0
        raise self._none(best)

    def _between(self, broken: float, kept: float) -> float:
        """The least radius that keeps the bounds, from one that breaks them, or 0, to one that keeps them."""
        if not broken:
            broken = max(self._reached(), kept / STEP) * (1.0 + REACHED)
        least = self.margin(broken).least
        if not broken < kept or least >= 0.0:
            return min(broken, kept)
        if least == -math.inf:
            return kept
        return root(lambda one: self.margin(one).least, broken, kept)

    def _reached(self) -> float:
        """The least base radius that the follower reaches; 0 of a flat face."""
        layout = self.layout
        if layout.flat:
            return 0.0
        apart = layout.offset if layout.kind == "translating" else layout.distance - layout.arm
        return max(abs(apart) - layout.touch.roller, 0.0)

    def _radii(self, least: float) -> Array:
        count = 2 + int(math.log(max(GREATEST * self.size / least, STEP)) / math.log(STEP))
        return np.asarray(least * STEP ** np.arange(count), dtype=np.float64)

    def _lowest(self) -> float:
        """A radius below which none keeps the bounds."""
        layout, small = self.layout, SMALLEST * self.size
        if layout.kind == "oscillating":
            return max(small, self._reached())
        if layout.flat:
            return small
        heights = self._heights()
        return max(small, math.hypot(heights, layout.offset) * (1.0 - 1e-12) - layout.touch.roller)

    def _heights(self) -> float:
        """The least height of the roller's centre at lift 0 that keeps the pressure angles at every sample."""
        lift, slope = self.lift[:2]
        across = np.abs(slope - self.layout.sense * self.layout.offset)
        rise, fall = (
            np.max(across[here] / math.tan(most) - lift[here], initial=0.0)
            for here, most in ((slope >= 0, self.kept.pressure_angle), (slope <= 0, self.kept.return_angle))
        )
        return float(max(rise, fall))

    def _none(self, best: Margin) -> MotionError:
        what = _("no base radius keeps the bounds: {bound} is broken at {angle:.6g} deg at least")
        bounds = {
            "pressure angle": _("the pressure angle"),
            "curvature": _("the radius of curvature"),
            "reach": _("the follower's reach"),
        }
        told = what.format(bound=bounds[best.by], angle=math.degrees(best.at))
        return MotionError("[bounds]", told, _("admit more, or change the follower"))
