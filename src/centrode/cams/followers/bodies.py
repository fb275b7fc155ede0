"""A plate cam with its follower: the closed profile, its corners, where it is undercut, and its extremes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from centrode.cams.followers.contact import ORDER, Array, Contact, Face, Motion, Touch
from centrode.cams.followers.guidance import (
    Guidance,
)
from centrode.cams.nodes import inside, nodes_of
from centrode.cams.profiles.equidistants import Undercut
from centrode.numerics.search import Extremes, Function, extremes, roots

KINK = 1e-9
"""Turns of the normal [rad], and steps of the contact over the base radius, that are rounding."""
FLAT = 1e-13
"""Slopes below this share of a value (by radian) are rounding."""
PLACES = 721
WATCHED = {
    "pressure": ("pressure_angle", "pressure_slope"),
    "path_curvature": ("path_curvature", "path_curvature_slope"),
    "stretch": ("stretch", "stretch_slope"),
    "along": ("along", "along_slope"),
}
"""Values of a contact whose extremes are looked for, with their slopes."""


@dataclass(frozen=True)
class Corner:
    """A joint of the motion at which the speed of the lift jumps.

    Attributes
    ----------
    at : float [rad]
    turn : float [rad]
        By how much the normal turns, positive at an outward corner of the path; 0 for a flat face.
    step : float [m]
        By how far the contact steps along the flat face in the sense of the contact's way; 0 otherwise.
    """

    at: float
    turn: float
    step: float = 0.0

    def undercuts(self, roller: float) -> bool:
        """Whether a follower of this roller cuts away the profile on both sides of the corner."""
        return self.step < 0.0 or (self.turn > 0.0 and roller > 0.0)


@dataclass(frozen=True)
class FollowerCam:
    """A plate cam that moves a follower.

    Attributes
    ----------
    motion : Motion
    guide : Translating or Oscillating
    touch : Point or Face
    base_radius : float [m]
        Least radius of the profile, where the lift is 0.
    sense : +1 or -1
        Whether the cam turns counter-clockwise or clockwise.
    """

    motion: Motion
    guide: Guidance
    touch: Touch
    base_radius: float
    sense: float = 1.0

    @property
    def edges(self) -> tuple[float, ...]:
        """Angles [rad] between which the profile is smooth."""
        return self.motion.edges

    def contact(self, phi: Array) -> Contact:
        """The contact at angles (n) [rad] from 0 to a turn, exact to the rounding of the lift's three derivatives."""
        phi = np.asarray(phi, dtype=np.float64)
        with np.errstate(divide="ignore", invalid="ignore"):
            return self.touch.contact(self.guide, phi, self.motion.lift(phi, ORDER), self.sense)

    def in_frame(self, vectors: Array, phi: Array) -> Array:
        """Places or directions (n, 2) of the cam's axes in the axes of the frame, the cam turned by phi (n)."""
        cosine, sine = np.cos(phi), self.sense * np.sin(phi)
        x, y = vectors[..., 0], vectors[..., 1]
        return np.stack([x * cosine - y * sine, y * cosine + x * sine], axis=-1)

    @cached_property
    def corners(self) -> tuple[Corner, ...]:
        """Joints at which the speed of the lift jumps, growing."""
        found = (self._corner(at) for at in self.edges[:-1])
        return tuple(one for one in found if one is not None)

    def _corner(self, at: float) -> Corner | None:
        before = inside(0.0, self.edges[-1] if at == self.edges[0] else at)[1]
        sides = self.contact(np.array([before, at]))
        if isinstance(self.touch, Face):
            step = float(np.sum((sides.place[1] - sides.place[0]) * sides.tangent[1]))
            return Corner(at, 0.0, step) if abs(step) > KINK * self.base_radius else None
        turn = self.sense * math.remainder(sides.normal_angle[1] - sides.normal_angle[0], math.tau)
        return Corner(at, turn) if abs(turn) > KINK else None

    @cached_property
    def undercuts(self) -> list[Undercut]:
        """Where the profile runs back, so that the follower's other places cut it away; corners have no width.

        Ends are cusps, where `stretch` is zero, exact to rounding. What goes over phi = 0 is told in one piece.
        """
        sharp = [Undercut(one.at, one.at) for one in self.corners if one.undercuts(self.touch.roller)]
        smooth = self._running_back()
        # a corner that lies within a stretch is told with it
        alone = [one for one in sharp if not any(two.start <= one.start <= two.stop for two in smooth)]
        return sorted([*smooth, *alone], key=lambda one: one.start)

    def _running_back(self) -> list[Undercut]:
        found: list[Undercut] = []
        for start, stop in self._backwards():
            if found and found[-1].stop == start:
                found[-1] = Undercut(found[-1].start, stop)
            else:
                found.append(Undercut(start, stop))
        if len(found) > 1 and found[0].start == self.edges[0] and found[-1].stop == self.edges[-1]:
            found[-1] = Undercut(found[-1].start, found.pop(0).stop + math.tau)
        return found

    def _backwards(self) -> Iterator[tuple[float, float]]:
        """Stretches between cusps and edges on which the profile runs back."""
        values, _slopes = self._watched("stretch")
        # cusps lie on both sides of the lowest places, however near
        lowest = self.turns("stretch")
        found = roots(values, nodes_of(sorted({*self.edges, *lowest.tolist()})))
        for start, stop in pairwise(self.edges):
            cusps = found[(found > start) & (found < stop)].tolist()
            for low, high in pairwise((start, *cusps, stop)):
                inner = np.linspace(low, high, 9)[1:-1]
                if high > low and float(np.median(self.contact(inner).stretch)) <= 0.0:
                    yield low, high

    @cached_property
    def path_curvature(self) -> Extremes:
        """Extremes of the curvature [1/m] of the path of the roller's centre."""
        return self._extremes("path_curvature")

    @cached_property
    def pressure(self) -> Extremes:
        """Extremes of the pressure angle [rad]."""
        return self._extremes("pressure")

    @cached_property
    def bends(self) -> Extremes:
        """Extremes of the radius of curvature [m] of the profile under a flat face; it has none but these."""
        return self._extremes("stretch")

    @cached_property
    def face(self) -> Extremes:
        """Ends [m] of the stretch of a flat face on which the cam touches it, from the axis or from the pivot."""
        return self._extremes("along")

    def _extremes(self, name: str) -> Extremes:
        """Over the stretches between edges, with what holds before and behind each."""
        return extremes(*self._watched(name), nodes_of(self.edges))

    def turns(self, name: str) -> Array:
        """Angles [rad] between edges at which a value of `WATCHED` is least or greatest, growing."""
        return roots(self._watched(name)[1], nodes_of(self.edges))

    def _watched(self, name: str) -> tuple[Function, Function]:
        """A value of the contact and its slope as functions of the angle."""
        value, slope = WATCHED[name]

        def values(phi: Array) -> Array:
            return np.asarray(getattr(self.contact(phi), value))

        def slopes(phi: Array) -> Array:
            contact = self.contact(phi)
            found = np.asarray(getattr(contact, slope))
            # on a dwell the slope is rounding, whose signs say nothing
            return np.where(np.abs(found) <= FLAT * np.abs(getattr(contact, value)), 0.0, found)

        return values, slopes

    @cached_property
    def least_bend(self) -> tuple[float, float]:
        """Least radius of curvature [m] of the profile where it bulges, and where [rad]; infinite if it never does.

        Zero or less where it is undercut.
        """
        if isinstance(self.touch, Face):
            return self.bends.least, self.bends.at_least
        most, at = self.greatest_roller
        return most - self.touch.roller, at

    @cached_property
    def greatest_roller(self) -> tuple[float, float]:
        """The radius [m] that a roller on this path of its centre has to stay below, and where [rad] it is decided.

        It is the least radius of curvature of the path where it bulges; 0 at a corner, infinite if there is neither.
        """
        sharp = [one.at for one in self.corners if one.turn > 0.0]
        if sharp:
            return 0.0, sharp[0]
        found = self.path_curvature
        return (1.0 / found.greatest if found.greatest > 0.0 else math.inf), found.at_greatest

    @cached_property
    def greatest_cutter(self) -> tuple[float, float]:
        """The radius [m] that a cutter has to stay below to come to the bottom of every hollow, and where [rad].

        Infinite where there is no hollow. At a hollow corner a roller leaves its own arc, a knife edge nothing.
        """
        corners = [(self.touch.roller, one.at) for one in self.corners if one.turn < 0.0]
        if isinstance(self.touch, Face):
            return math.inf, 0.0
        found = self.path_curvature
        hollow = self.touch.roller - 1.0 / found.least if found.least < 0.0 else math.inf
        return min([(hollow, found.at_least), *corners])

    @cached_property
    def overlap(self) -> tuple[float, float]:
        """By how much [m] a roller overlaps the profile elsewhere than it touches it, and at which angle [rad].

        Among 720 places of the roller and of the profile; 0 where it never does, and for other followers.
        """
        if isinstance(self.touch, Face) or self.touch.roller == 0.0:
            return 0.0, 0.0
        phi = np.linspace(self.edges[0], self.edges[-1], PLACES)[:-1]
        found = self.contact(phi)
        apart = np.hypot(*(found.centre[:, None] - found.place).transpose(2, 0, 1)).min(axis=1)
        worst = int(np.argmin(apart))
        depth = self.touch.roller - float(apart[worst])
        scale = float(np.abs(found.centre).max())
        return (depth, float(phi[worst])) if depth > KINK * scale else (0.0, 0.0)
