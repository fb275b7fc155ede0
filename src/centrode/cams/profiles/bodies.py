"""A cam as a body: its closed path, the profile that its roller leaves, and what has to be said of them."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from centrode.cams.closed.arcs import Arc, ClosedPath, Joint, breaks_of, mirrored, working_arc
from centrode.cams.closed.bounds import Bounds
from centrode.cams.closed.designing import Returned, designed
from centrode.cams.described import path_of
from centrode.cams.frames import Array, frames
from centrode.cams.nodes import nodes_of
from centrode.cams.path import RollerPath, stalls_of
from centrode.cams.profiles.equidistants import (
    Equidistant,
    Side,
    Undercut,
    equidistant,
    fitting,
    greatest_roller,
    signed,
    undercut,
)
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.model.cams.description import Cam
from centrode.model.cams.files import AnyCam, curved
from centrode.model.cams.parts import Return
from centrode.numerics.search import roots

LEAST_BEND = 0.1
"""Least radius of curvature of a designed profile over the roller's radius, where the description gives none."""
LEAST_ROOM = 1.5
"""Least polar radius of a designed path over the roller's radius, where the description gives none."""
PLACES = 721
CLOSED = 1e-9
"""Share of the radius by which a path of a whole turn may miss its beginning."""


@dataclass(frozen=True)
class CamBody:
    """A cam with the path of its roller's centre.

    Attributes
    ----------
    closed : ClosedPath
        Open where the description asks for no return arc.
    roller : float [m]
        Radius of the roller.
    returned : Returned or None
        The designed return arc; None where the path closes by itself or by mirror images.
    """

    closed: ClosedPath
    roller: float
    returned: Returned | None = None

    def profile(self, phi: Array, side: Side = "inner") -> Equidistant:
        """The profile inside the path, or the wall of a groove outside, at angles (n) [rad]."""
        return equidistant(frames(self.closed, phi), signed(self.roller, side))

    @cached_property
    def undercuts(self) -> list[Undercut]:
        """Where the roller cuts the profile away: where it is bent too much, and at outward corners."""
        found = undercut(self.closed, self.closed.edges, self.roller)
        corners = [self._corner(number) for number in range(len(self.closed.joints))]
        return sorted([*found, *(one for one in corners if one is not None)], key=lambda one: one.start)

    @cached_property
    def greatest_roller(self) -> tuple[float, float]:
        """The radius [m] that the roller has to stay below, and where [rad]."""
        return greatest_roller(self.closed, self.closed.edges)

    @cached_property
    def overlap(self) -> tuple[float, float]:
        """By how much [m] the roller overlaps the profile somewhere, and at which angle [rad]; 0 where it never does.

        Among 720 places of the roller and of the profile: it finds a waist that is too narrow, besides undercut.
        """
        phi = np.linspace(self.closed.start, self.closed.stop, PLACES)
        centres, profile = frames(self.closed, phi).place, self.profile(phi).place
        apart = np.hypot(*(centres[:, None] - profile).transpose(2, 0, 1)).min(axis=1)
        worst = int(np.argmin(apart))
        depth = self.roller - float(apart[worst])
        return (depth, float(phi[worst])) if depth > CLOSED * float(np.abs(centres).max()) else (0.0, 0.0)

    def fit_groove(self) -> None:
        """Raise InputError where the roller is larger than a hollow, which the outer wall would have to follow."""
        fitting(self.closed, self.closed.edges, self.roller, "outer")

    def _corner(self, number: int) -> Undercut | None:
        """The stretch about an outward corner of mirror images that the roller does not follow; None elsewhere.

        The profiles before and behind the corner meet on the ray to it.
        """
        joint, arc = self.closed.joints[number], self.closed.arcs[number]
        if self.returned is not None or len(self.closed.arcs) == 1 or joint.kink > -CLOSED:
            return None

        def beyond(phi: Array) -> Array:
            off = equidistant(frames(arc.curve, phi), signed(self.roller, "inner"))
            return np.asarray(off.polar_angle - joint.at)

        inner = roots(beyond, nodes_of(arc.edges))
        start = float(inner[-1]) if inner.size else arc.start
        return Undercut(start, 2.0 * joint.at - start)

    @property
    def kinks(self) -> tuple[Joint, ...]:
        """Joints where the pressure angle jumps by more than rounding."""
        return tuple(joint for joint in self.closed.joints if abs(joint.kink) > CLOSED)

    @property
    def greatest_jump(self) -> float:
        """The greatest jump of curvature at a joint, over the curvature there."""
        jumps = []
        for joint in self.closed.joints:
            here = frames(self.closed, np.array([joint.at])).curvature[0]
            jumps.append(abs(joint.curvature_jump / here))
        return float(max(jumps, default=0.0))


def cam_body(cam: AnyCam) -> CamBody:
    """The cam of a description: closed by its return arc, open where it has neither that nor a mover.

    Raises
    ------
    InputError
        No roller; a working arc or bounds that do not fit; a path of a whole turn that does not close.
    MotionError
        The follower stalls on the working arc; no return arc within the bounds was found.
    """
    return _body(curved(cam))


@functools.lru_cache(maxsize=16)
def _body(cam: Cam) -> CamBody:
    """What a search may have gone into is kept for whoever asks for the same cam next."""
    if cam.roller is None:
        raise InputError("[roller]", _("a profile needs a roller"), _("give [roller] radius"))
    path, asked = path_of(cam), cam.return_arc or Return()
    if cam.return_arc is None and cam.mover is None:
        whole = path.stop - path.start >= math.tau * (1 - CLOSED)
        closed = _whole_turn(path) if whole else ClosedPath((_reached(path, working_arc(path)),))
        return CamBody(closed, cam.roller.radius)
    working = _reached(path, working_of(cam, path))
    if asked.kind == "mirrored":
        return CamBody(mirrored(working), cam.roller.radius)
    found = designed(working, bounds_of(asked, cam.roller.radius, working))
    return CamBody(found.closed, cam.roller.radius, found)


def working_of(cam: Cam, path: RollerPath) -> Arc:
    """The working arc: +-pi/N of a mover or what it says, else the whole path."""
    if cam.mover is None:
        return working_arc(path)
    if cam.mover.working_arc is None:
        return working_arc(path, legs=cam.mover.legs)
    low, high = cam.mover.working_arc
    if abs(low + high) > CLOSED:
        what = _("a leg works over the same angle on both sides of upright")
        raise InputError("[mover] working_arc", what, _("give [-a, a], or leave it out"))
    return working_arc(path, half=high)


def bounds_of(asked: Return, roller: float, working: Arc) -> Bounds:
    """Bounds of the roller's path from those that a description gives of the profile; defaults by the roller.

    Left out, the profile's radius of curvature stays above a tenth of the roller's radius where it is convex, the
    path's above the roller's radius in hollows, and the polar radius above 1.5 of it; where the joints have less,
    above 0.9 of that.
    """
    joints = frames(working.curve, np.array([working.start, working.stop]))
    least = float(min(LEAST_ROOM * roller, 0.9 * joints.radius.min()))
    sharpest = max(float(joints.curvature.max()), 1e-300)
    bend = min((1.0 + LEAST_BEND) * roller, 0.9 / sharpest)
    return Bounds(
        least_radius=least if asked.least_radius is None else asked.least_radius,
        greatest_radius=asked.greatest_radius or math.inf,
        least_bend=bend if asked.least_curvature_radius is None else roller + asked.least_curvature_radius,
        convex=asked.convex,
        least_hollow=roller,
        pressure_angle=asked.pressure_angle or math.pi / 2,
    )


def _reached(path: RollerPath, working: Arc) -> Arc:
    """The working arc; MotionError where it ends in a stall, at which the path's direction is that of the ray."""
    reached = [one for one in stalls_of(path) if one in (working.start, working.stop)]
    if not reached:
        return working
    what = _("no profile leads a roller to {place:.6g} deg, where the follower stalls")
    raise MotionError(
        "[range]", what.format(place=math.degrees(reached[-1])), _("end the range before that angle")
    )


def _whole_turn(path: RollerPath) -> ClosedPath:
    """A path that goes all the way round by itself."""
    start, stop = path.start, path.start + math.tau
    closed = ClosedPath((Arc("working", path, start, stop, breaks_of(path, start, stop)),))
    gap = closed.joints[0].gap
    if abs(gap) > CLOSED * float(path.radius(np.array([start]))[0, 0]):
        what = _("the law does not close: after a turn the radius is off by {gap:.6g} mm").format(
            gap=-1e3 * gap
        )
        raise InputError("[curvature]", what, _("shorten the range and let a return arc close it"))
    return closed
