"""A cam as a body: its closed path, the profile that its roller leaves, and what has to be said of them."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Literal, TypeAlias

import numpy as np

from centrode.cams.nodes import mesh, nodes_of
from centrode.cams.path_series import path_of
from centrode.cams.return_arc import (
    Arc,
    ArcBounds,
    ArcJoint,
    ClosedPath,
    Returned,
    breaks_of,
    design_return,
    mirror_arc,
    working_arc,
)
from centrode.cams.roller_path import Array, Frames, PolarCurve, RollerPath, frames, stalls_of
from centrode.cams.walking_wheel import Shoe
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.model.cam import Cam, Return
from centrode.model.cam_files import AnyCam, require_curvature_cam
from centrode.numerics.outline_pieces import OutlinePiece
from centrode.numerics.search import extremes, roots

# Equidistants of a roller's path: the cam's profile one radius inside, the wall of a groove one radius
# outside.
#
# A point of the equidistant at distance d along the outward normal has the curvature K/(1 + d K), K that of
# the path. Where 1 + d K is not positive the equidistant runs back on itself: the profile is undercut, the
# roller's own circle cuts it away. Towards the inside (d = -r) this happens on convex stretches, towards the
# outside (d = r) in hollows.

Side: TypeAlias = Literal["inner", "outer"]


@dataclass(frozen=True)
class Equidistant:
    """A curve at a constant distance from another, at the angles of that one's frames.

    Attributes
    ----------
    place : (n, 2) [m]
    polar_radius, polar_angle : (n) [m], [rad]
        The angle counted as phi is, without jumps between neighbours.
    curvature : (n) [1/m]
        Positive where it bends towards the cam's centre; infinite at a cusp.
    bend : (n) [m]
        Radius of curvature 1/K + d with its sign; infinite where the path is straight.
    speed : (n) [m/rad]
        ds/dphi; negative where it runs back.
    """

    place: Array
    polar_radius: Array
    polar_angle: Array
    curvature: Array
    bend: Array
    speed: Array


@dataclass(frozen=True)
class Undercut:
    """A stretch [rad] of the path whose equidistant runs back; its ends are cusps unless the path ends there."""

    start: float
    stop: float


def signed_distance(radius: float, side: Side) -> float:
    """The distance along the outward normal: -radius inside, radius outside."""
    if not (math.isfinite(radius) and radius > 0):
        raise InputError("[roller] radius", _("it has to be positive and finite"), _("correct it"))
    return -radius if side == "inner" else radius


def equidistant(frame: Frames, distance: float) -> Equidistant:
    """The curve at a distance [m] along the outward normals."""
    place = frame.place + distance * frame.normal
    stretch = 1.0 + distance * frame.curvature
    with np.errstate(divide="ignore", invalid="ignore"):
        curvature, bend = frame.curvature / stretch, 1.0 / frame.curvature + distance
    # the angle between a path's point and its equidistant's is less than half a turn as long as the centre is inside
    across = np.sum(place * np.stack([np.cos(frame.phi), -np.sin(frame.phi)], axis=-1), axis=-1)
    along = np.sum(place * np.stack([np.sin(frame.phi), np.cos(frame.phi)], axis=-1), axis=-1)
    angle = frame.phi + np.arctan2(across, along)
    return Equidistant(
        place, np.hypot(place[:, 0], place[:, 1]), angle, curvature, bend, frame.speed * stretch
    )


def undercut(
    curve: PolarCurve, edges: Sequence[float], radius: float, side: Side = "inner"
) -> list[Undercut]:
    """Stretches on which the equidistant of a curve at the roller's radius runs back.

    Parameters
    ----------
    edges : sequence of float [rad]
        Ends and breaks of the curve, growing.
    radius : float [m]
        Of the roller.

    Returns
    -------
    list of Undercut
        Growing, exact to rounding; one that goes over the end of a closed path is told in one piece. A stretch
        narrower than a hundredth of a radian may be missed.
    """
    distance = signed_distance(radius, side)

    def stretch(phi: Array) -> Array:
        return 1.0 + distance * frames(curve, phi).curvature

    cuts = [edges[0], *roots(stretch, nodes_of(edges)).tolist(), edges[-1]]
    found: list[Undercut] = []
    for start, stop in pairwise(cuts):
        if stop <= start or float(np.median(stretch(mesh(start, stop)[1:-1]))) > 0.0:
            continue
        if found and found[-1].stop == start:
            found[-1] = Undercut(found[-1].start, stop)
        else:
            found.append(Undercut(start, stop))
    if len(found) > 1 and found[0].start == edges[0] and _is_turn(edges) and found[-1].stop == edges[-1]:
        found[-1] = Undercut(found[-1].start, found.pop(0).stop + math.tau)
    return found


def greatest_roller(curve: PolarCurve, edges: Sequence[float], side: Side = "inner") -> tuple[float, float]:
    """The radius [m] that a roller has to stay below, and where [rad] it is decided; infinite if nothing bounds it.

    It is the least radius of curvature of the path's convex stretches for the inner side, of its hollows for the
    outer one. Exact to rounding.
    """
    sign = 1.0 if side == "inner" else -1.0
    found = extremes(
        lambda phi: sign * frames(curve, phi).curvature,
        lambda phi: sign * frames(curve, phi).curvature_slope,
        nodes_of(edges),
    )
    if found.greatest <= 0.0:
        return math.inf, found.at_greatest
    return 1.0 / found.greatest, found.at_greatest


def check_roller_fits(curve: PolarCurve, edges: Sequence[float], radius: float, side: Side) -> None:
    """Raise InputError where a roller is too large for the path's curvature on one side: for its hollows outside.

    The message gives the greatest radius that fits and where.
    """
    signed_distance(radius, side)
    most, at = greatest_roller(curve, edges, side)
    if radius < most:
        return
    text = {
        "inner": _("a roller of {radius:.6g} mm undercuts the profile at {at:.6g} deg"),
        "outer": _("a roller of {radius:.6g} mm is larger than the hollow at {at:.6g} deg"),
    }[side]
    raise InputError(
        "[roller] radius",
        text.format(radius=1e3 * radius, at=math.degrees(at)),
        _("stay below {most:.6g} mm").format(most=1e3 * most),
    )


def _is_turn(edges: Sequence[float]) -> bool:
    return abs(edges[-1] - edges[0] - math.tau) < 1e-9


LEAST_BEND = 0.1
"""Least radius of curvature of a designed profile over the roller's radius, where the description gives none."""
LEAST_ROOM = 1.5
"""Least polar radius of a designed path over the roller's radius, where the description gives none."""
PLACES = 721
CLOSED = 1e-9
"""Share of the radius by which a path of a whole turn may miss its beginning."""


@dataclass(frozen=True)
class ProfileBody:
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
        return equidistant(frames(self.closed, phi), signed_distance(self.roller, side))

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
        check_roller_fits(self.closed, self.closed.edges, self.roller, "outer")

    def _corner(self, number: int) -> Undercut | None:
        """The stretch about an outward corner of mirror images that the roller does not follow; None elsewhere.

        The profiles before and behind the corner meet on the ray to it.
        """
        joint, arc = self.closed.joints[number], self.closed.arcs[number]
        if self.returned is not None or len(self.closed.arcs) == 1 or joint.kink > -CLOSED:
            return None

        def beyond(phi: Array) -> Array:
            off = equidistant(frames(arc.curve, phi), signed_distance(self.roller, "inner"))
            return np.asarray(off.polar_angle - joint.at)

        inner = roots(beyond, nodes_of(arc.edges))
        start = float(inner[-1]) if inner.size else arc.start
        return Undercut(start, 2.0 * joint.at - start)

    @property
    def kinks(self) -> tuple[ArcJoint, ...]:
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


def cam_body(cam: AnyCam) -> ProfileBody:
    """The cam of a description: closed by its return arc, open where it has neither that nor a mover.

    Raises
    ------
    InputError
        No roller; a working arc or bounds that do not fit; a path of a whole turn that does not close.
    MotionError
        The follower stalls on the working arc; no return arc within the bounds was found.
    """
    return _body(require_curvature_cam(cam))


@functools.lru_cache(maxsize=16)
def _body(cam: Cam) -> ProfileBody:
    """What a search may have gone into is kept for whoever asks for the same cam next."""
    if cam.roller is None:
        raise InputError("[roller]", _("a profile needs a roller"), _("give [roller] radius"))
    path, asked = path_of(cam), cam.return_arc or Return()
    if cam.return_arc is None and cam.mover is None:
        return ProfileBody(_own_path(path), cam.roller.radius)
    working = _check_stalls(path, working_of(cam, path))
    if asked.kind == "mirrored":
        return ProfileBody(mirror_arc(working), cam.roller.radius)
    found = design_return(working, bounds_of(asked, cam.roller.radius, working))
    return ProfileBody(found.closed, cam.roller.radius, found)


def roller_path_of(cam: Cam) -> ClosedPath:
    """The path of a cam's roller, with its return arc if it has one; of a cam without a roller over its range.

    Raises
    ------
    InputError, MotionError
        As `cam_body`, but for a roller that is missing.
    """
    return _own_path(path_of(cam)) if cam.roller is None else cam_body(cam).closed


def _own_path(path: RollerPath) -> ClosedPath:
    """A path without a return arc: all the way round by itself, else open."""
    whole = path.stop - path.start >= math.tau * (1 - CLOSED)
    return _whole_turn(path) if whole else ClosedPath((_check_stalls(path, working_arc(path)),))


def working_of(cam: Cam, path: RollerPath) -> Arc:
    """The working arc: +-pi/N of a mover or what it says, else the whole path."""
    if cam.mover is None:
        return working_arc(path)
    if cam.mover.working_arc is None:
        return working_arc(path, legs=cam.mover.legs)
    low, high = cam.mover.working_arc
    if abs(low + high) > CLOSED:
        what = _("a leg works over the same angle on both sides of the vertical")
        raise InputError("[mover] working_arc", what, _("give [-a, a], or omit it"))
    return working_arc(path, half=high)


def bounds_of(asked: Return, roller: float, working: Arc) -> ArcBounds:
    """Bounds of the roller's path from those that a description gives of the profile; defaults by the roller.

    Left out, the profile's radius of curvature stays above a tenth of the roller's radius where it is convex, the
    path's above the roller's radius in hollows, and the polar radius above 1.5 of it; where the joints have less,
    above 0.9 of that.
    """
    joints = frames(working.curve, np.array([working.start, working.stop]))
    least = float(min(LEAST_ROOM * roller, 0.9 * joints.radius.min()))
    sharpest = max(float(joints.curvature.max()), 1e-300)
    bend = min((1.0 + LEAST_BEND) * roller, 0.9 / sharpest)
    return ArcBounds(
        least_radius=least if asked.least_radius is None else asked.least_radius,
        greatest_radius=asked.greatest_radius or math.inf,
        least_bend=bend if asked.least_curvature_radius is None else roller + asked.least_curvature_radius,
        convex=asked.convex,
        least_hollow=roller,
        pressure_angle=asked.pressure_angle or math.pi / 2,
    )


def _check_stalls(path: RollerPath, working: Arc) -> Arc:
    """The working arc; MotionError where it ends in a stall, at which the path's direction is that of the ray."""
    reached = [one for one in stalls_of(path) if one in (working.start, working.stop)]
    if not reached:
        return working
    what = _("no profile can guide a roller to {place:.6g} deg, where the follower stalls")
    raise MotionError(
        "[range]", what.format(place=math.degrees(reached[-1])), _("end the range before that angle")
    )


def _whole_turn(path: RollerPath) -> ClosedPath:
    """A path that goes all the way round by itself."""
    start, stop = path.start, path.start + math.tau
    closed = ClosedPath((Arc("working", path, start, stop, breaks_of(path, start, stop)),))
    gap = closed.joints[0].gap
    if abs(gap) > CLOSED * float(path.radius(np.array([start]))[0, 0]):
        what = _("the profile does not close: over one turn the radius changes by {gap:.6g} mm").format(
            gap=-1e3 * gap
        )
        raise InputError("[curvature]", what, _("shorten the range and let a return arc close it"))
    return closed


# Outlines of cams and shoes as pieces of smooth curves, with their slopes: what drawings and files are made
# of.

Layer: TypeAlias = Literal[
    "profile-working",
    "profile-return",
    "groove-working",
    "groove-return",
    "path",
    "shoe",
    "profile",
    "cutter",
]
LEAST_PIECE = 8
"""Least number of spaces between points of a piece."""


def cam_outlines(body: ProfileBody, samples: int, *, groove: bool = False) -> list[OutlinePiece]:
    """The roller's path, the profile, and the outer wall of a groove if asked, each in pieces between breaks.

    Parameters
    ----------
    samples : int
        Spaces between points over the whole turn, about.

    Raises
    ------
    InputError
        The roller is larger than a hollow of the groove.
    """
    if groove:
        body.fit_groove()
    found: list[OutlinePiece] = []
    for arc, phi in pieces(body.closed.arcs, samples):
        frame = frames(arc.curve, phi)
        found.append(OutlinePiece("path", phi, frame.place, frame.speed[:, None] * frame.tangent))
        sides: tuple[Side, ...] = ("inner", "outer") if groove else ("inner",)
        for side in sides:
            off = equidistant(frame, signed_distance(body.roller, side))
            name: Layer
            if side == "inner":
                name = "profile-working" if arc.kind == "working" else "profile-return"
            else:
                name = "groove-working" if arc.kind == "working" else "groove-return"
            found.append(OutlinePiece(name, phi, off.place, off.speed[:, None] * frame.tangent))
        number = body.closed.arcs.index(arc)
        if phi[-1] > arc.edges[-2] and number < len(body.closed.joints):
            found += [one for side in sides for one in _corner(body, number, side, samples)]
    return found


def _corner(body: ProfileBody, number: int, side: Side, samples: int) -> list[OutlinePiece]:
    """The roller's own arc about a corner of the path, on the side where the walls before and behind it part."""
    joint, arc = body.closed.joints[number], body.closed.arcs[number]
    parts: Side = "outer" if joint.kink < 0.0 else "inner"
    if abs(joint.kink) <= CLOSED or side != parts:
        return []
    frame = frames(arc.curve, np.array([arc.stop]))
    count = max(2 * LEAST_PIECE, round(samples * abs(joint.kink) / math.tau))
    turned = np.linspace(0.0, abs(joint.kink), count + 1)
    sense, distance = -math.copysign(1.0, joint.kink), signed_distance(body.roller, side)
    normal = frame.normal_angle + sense * turned
    outwards = np.stack([np.sin(normal), np.cos(normal)], axis=-1)
    along = np.stack([np.cos(normal), -np.sin(normal)], axis=-1)
    layer: Layer = "groove-return" if side == "outer" else "profile-return"
    return [
        OutlinePiece(layer, joint.at + turned, frame.place + distance * outwards, sense * distance * along)
    ]


def shoe_outlines(shoe: Shoe, samples: int) -> list[OutlinePiece]:
    """The profile of a shoe in the leg's axes, in pieces between breaks."""
    found = []
    for _arc, phi in pieces([shoe.arc], samples):
        along = np.stack([np.cos(phi), -np.sin(phi)], axis=-1)
        found.append(OutlinePiece("shoe", phi, shoe.place(phi), shoe.bend(phi)[:, None] * along))
    return found


def pieces(arcs: Sequence[Arc], samples: int) -> list[tuple[Arc, Array]]:
    """Arcs between their breaks, and angles evenly spaced over each."""
    turn = sum(arc.stop - arc.start for arc in arcs)
    found = []
    for arc in arcs:
        for low, high in pairwise(arc.edges):
            count = max(LEAST_PIECE, round(samples * (high - low) / turn))
            # a break belongs to the piece behind it: the end of this one is asked for just before
            found.append((arc, np.append(np.linspace(low, high, count + 1)[:-1], np.nextafter(high, low))))
    return found
