"""From a description with a follower to its cam."""

from __future__ import annotations

import functools
import importlib
import math
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np

from centrode.cams.followers.geometry import (
    ORDER,
    Array,
    ContactMotion,
    ContactPoint,
    Face,
    FollowerCam,
    FollowerContact,
    Guidance,
    LiftCorner,
    Point,
    Translating,
    oscillating_face,
    oscillating_follower,
    translating_follower,
)
from centrode.cams.followers.motion import follower_motion
from centrode.cams.nodes import nodes_of
from centrode.cams.profiles import Undercut
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.model.cam_files import AnyCam, with_follower
from centrode.model.examples.catalogue import CamSource, cam_of
from centrode.model.follower_cam import PlateCam
from centrode.numerics.search import root, roots

# What a follower is and how it stands to its cam, before the size of the cam is chosen.

# slower to import than NumPy
_optimize = functools.partial(importlib.import_module, "scipy.optimize")

Kind: TypeAlias = Literal["translating", "oscillating"]


@dataclass(frozen=True)
class FollowerLayout:
    """A follower and the sense in which its cam turns.

    Attributes
    ----------
    kind : "translating" or "oscillating"
    touch : Point or Face
    offset : float [m]
        x of the axis of a translating follower.
    arm, distance, face_offset : float [m]
        Of an oscillating follower: of the roller's centre from the pivot; of the pivot from the cam's centre; by how
        much the line of a flat face passes the pivot on the cam's side.
    sense : +1 or -1
        Whether the cam turns counter-clockwise or clockwise.
    """

    kind: Kind
    touch: ContactPoint
    offset: float = 0.0
    arm: float = 0.0
    distance: float = 0.0
    face_offset: float = 0.0
    sense: float = 1.0

    @property
    def flat(self) -> bool:
        return isinstance(self.touch, Face)

    def guide(self, base_radius: float) -> Guidance:
        """How the follower is led on a cam of this base radius [m]; raises InputError where it does not reach it."""
        if self.kind == "translating":
            if self.flat:
                return Translating(base_radius, self.offset)
            return translating_follower(base_radius + self.touch.roller, self.offset)
        if self.flat:
            return oscillating_face(base_radius, self.distance, self.face_offset)
        return oscillating_follower(base_radius + self.touch.roller, self.arm, self.distance)

    def cam(self, motion: ContactMotion, base_radius: float) -> FollowerCam:
        """The cam of this base radius [m] for a motion.

        Raises
        ------
        InputError
            A follower that does not reach the base circle; one that the cam cannot lead all the way: it would have to
            go through the cam's centre or its pivot's line, or turn its face faster than the cam turns.
        """
        cam = FollowerCam(motion, self.guide(base_radius), self.touch, base_radius, self.sense)
        _check_led(cam)
        return cam


def _check_led(cam: FollowerCam) -> None:
    """Raise InputError at the first angle at which the follower cannot be led."""
    phi = nodes_of(cam.edges)
    found = cam.contact(phi)
    turning = found.pace
    bad = np.flatnonzero(~((np.cos(found.pressure_angle) > 0.0) & (turning > 0.0)))
    if not bad.size:
        return
    what = _(
        "the cam cannot drive the follower through {angle:.6g} deg: its pressure angle reaches 90 deg there"
    )
    if not turning[bad[0]] > 0.0:
        what = _("at {angle:.6g} deg the flat face would have to turn faster than the cam")
    told = what.format(angle=math.degrees(phi[bad[0]]))
    raise InputError("[follower]", told, _("choose a smaller lift, a longer segment or a larger base radius"))


def layout_of(cam: PlateCam) -> FollowerLayout:
    """The layout of a description."""
    given = cam.follower
    touch = Face() if given.contact == "flat" else Point(given.roller_radius or 0.0)
    return FollowerLayout(
        given.kind,
        touch,
        given.offset,
        given.arm or 0.0,
        given.pivot_distance or 0.0,
        given.face_offset,
        1.0 if cam.body.turn == "counter-clockwise" else -1.0,
    )


# What is admissible of a cam, and by how much it is kept.

STILL = 1e-12
"""Slopes of the lift below this share of the greatest are those of a dwell."""


@dataclass(frozen=True)
class Admissible:
    """What a cam has to keep.

    Attributes
    ----------
    pressure_angle, return_angle : float [rad]
        Greatest pressure angles where the follower rises, where it falls; where it dwells both.
    bend : float [m]
        Least radius of curvature of the profile where it bulges; at 0 it must not be undercut.
    roller_to_curvature, roller_to_radius : float
        Greatest ratios of a roller's radius to the least radius of curvature of the path of its centre where that
        bulges, and to the least distance of this path from the cam's centre.
    """

    pressure_angle: float = math.pi / 2
    return_angle: float = math.pi / 2
    bend: float = 0.0
    roller_to_curvature: float = 1.0
    roller_to_radius: float = 1.0


@dataclass(frozen=True)
class Margin:
    """By how much bounds are kept at worst, where, and which; negative where they are not."""

    least: float
    at: float
    by: str


def margin(contact: FollowerContact, slope: Array, layout: FollowerLayout, kept: Admissible) -> Margin:
    """What is left at the worst of some contacts, `slope` (n) the lift's there.

    Of pressure angles in radians; of curvature 1 - (r + bend) K of a roller, (R - bend)/r0 of a flat face; where the
    roller's ratio asks for more, 1 - r K/ratio.
    """
    curved = "curvature"
    still = STILL * float(np.abs(slope).max())
    steepness = np.abs(contact.pressure_angle)
    pressure = np.minimum(
        np.where(slope >= -still, kept.pressure_angle - steepness, math.inf),
        np.where(slope <= still, kept.return_angle - steepness, math.inf),
    )
    if layout.flat:
        size = float(np.abs(contact.place).max())
        bent = np.where(contact.pace > 0.0, (contact.bend - kept.bend) / size, -math.inf)
    else:
        radius, by_ratio = (
            layout.touch.roller + kept.bend,
            layout.touch.roller / kept.roller_to_curvature,
        )
        if by_ratio > radius:
            radius, curved = by_ratio, "roller to curvature"
        bent = 1.0 - radius * contact.path_curvature
    bent = np.where(np.isfinite(bent), bent, -math.inf)
    first, second = int(np.argmin(pressure)), int(np.argmin(bent))
    if pressure[first] <= bent[second]:
        return Margin(float(pressure[first]), float(contact.phi[first]), "pressure angle")
    return Margin(float(bent[second]), float(contact.phi[second]), curved)


def size_margin(layout: FollowerLayout, base_radius: float, kept: Admissible) -> Margin:
    """What is left of a roller's ratio to the least distance of the path of its centre: 1 - r/(ratio (r0 + r))."""
    roller = layout.touch.roller
    if layout.flat or roller == 0.0 or kept.roller_to_radius >= 1.0:
        return Margin(math.inf, 0.0, "roller to radius")
    return Margin(1.0 - roller / (kept.roller_to_radius * (base_radius + roller)), 0.0, "roller to radius")


def least_size(layout: FollowerLayout, kept: Admissible) -> float:
    """The base radius [m] with which a roller has just its ratio to the least distance of the path of its centre."""
    roller = layout.touch.roller
    return 0.0 if layout.flat else roller / kept.roller_to_radius - roller


def exact_margin(cam: FollowerCam, layout: FollowerLayout, kept: Admissible) -> Margin:
    """`margin` over the whole turn, extremes found to rounding."""
    names = ("pressure", "stretch" if layout.flat else "path_curvature")
    phi = np.concatenate([nodes_of(cam.edges), *(cam.turns(name) for name in names)])
    found = min(
        margin(cam.contact(phi), cam.motion.lift(phi, 1)[1], layout, kept),
        size_margin(layout, cam.base_radius, kept),
        key=lambda one: one.least,
    )
    sharp = [one.at for one in cam.corners if breaks(one, layout, kept)]
    return Margin(-math.inf, sharp[0], "curvature") if sharp else found


def breaks(corner: LiftCorner, layout: FollowerLayout, kept: Admissible) -> bool:
    """Whether a corner leaves the profile undercut, or with a sharp edge where a radius of curvature is asked for."""
    return corner.undercuts(layout.touch.roller) or (corner.turn > 0.0 and kept.bend > 0.0)


# A cam made larger until it keeps what is asked of it: the least base circle of one offset.

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


def looked_at(layout: FollowerLayout, motion: ContactMotion, kept: Admissible) -> Nodes:
    """The mesh of a lift, and the angles at which a bound may decide."""
    phi = np.append(nodes_of(motion.edges), _decisive(layout, motion, kept))
    return Nodes(phi, motion.lift(phi, ORDER))


def _decisive(layout: FollowerLayout, motion: ContactMotion, kept: Admissible) -> list[float]:
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


class BaseCircleTrial:
    """Cams of several base radii on the same nodes."""

    def __init__(
        self, layout: FollowerLayout, motion: ContactMotion, kept: Admissible, nodes: Nodes | None = None
    ) -> None:
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
        found = margin(contact, self.lift[1], self.layout, self.kept)
        return min(found, size_margin(self.layout, base, self.kept), key=lambda one: one.least)

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
            broken = max(self._least_base_radius(), kept / STEP) * (1.0 + REACHED)
        least = self.margin(broken).least
        if not broken < kept or least >= 0.0:
            return min(broken, kept)
        if least == -math.inf:
            return kept
        return root(lambda one: self.margin(one).least, broken, kept)

    def _least_base_radius(self) -> float:
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
        layout = self.layout
        small = max(SMALLEST * self.size, least_size(layout, self.kept) * (1.0 - REACHED))
        if layout.kind == "oscillating":
            return max(small, self._least_base_radius())
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
        what = _("no base radius satisfies the bounds: {bound} is always violated at {angle:.6g} deg")
        bounds = {
            "pressure angle": _("the pressure angle"),
            "curvature": _("the radius of curvature"),
            "roller to curvature": _(
                "the ratio of the roller's radius to the radius of curvature of its path"
            ),
            "roller to radius": _("the ratio of the roller's radius to the least radius of its path"),
            "reach": _("the follower's reach"),
        }
        told = what.format(bound=bounds[best.by], angle=math.degrees(best.at))
        return MotionError("[bounds]", told, _("relax the bounds, or change the follower"))


# The least cam that keeps a pressure angle and a radius of curvature, and the offset that makes it least.

OFFSET = 1e-9
"""A best offset is looked for to this share of the speed of the lift."""


@dataclass(frozen=True)
class Least:
    """The least cam.

    Attributes
    ----------
    base_radius : float [m]
    at : float [rad]
        The angle that decides it.
    by : "pressure angle", "curvature", "roller to curvature", "roller to radius" or "nothing"
        What decides it there, of the last two the ratio of the roller's radius; where nothing does, smaller cams keep
        the bounds too, and the radius is the least that was tried.
    offset : float [m]
        Of a translating follower.
    """

    base_radius: float
    at: float
    by: str
    offset: float = 0.0


def _check_corners(cam: FollowerCam, layout: FollowerLayout, kept: Admissible) -> None:
    """Raise MotionError where the speed of the lift jumps so that every cam has a sharp corner."""
    for corner in cam.corners:
        if breaks(corner, layout, kept):
            what = _(
                "at {angle:.6g} deg the velocity of the lift jumps: every base radius leaves a sharp corner"
            )
            told = what.format(angle=math.degrees(corner.at))
            raise MotionError("[[segments]]", told, _("join the segments there with equal slopes"))


def least_base_radius(layout: FollowerLayout, motion: ContactMotion, kept: Admissible) -> Least:
    """The least base radius [m] with which a cam keeps what is admissible.

    Radii are tried upwards, each a twentieth greater, the first that keeps the bounds is refined to rounding.

    Raises
    ------
    MotionError
        None does; what comes nearest is told.
    """
    tried = BaseCircleTrial(layout, motion, kept)
    found = tried.first()
    _check_corners(tried.cam(found), layout, kept)

    def exact(base: float) -> float:
        return exact_margin(tried.cam(base), layout, kept).least

    low, high = found * (1.0 - NEAR), found * (1.0 + NEAR)
    if tried.reaches(low) and exact(low) < 0.0 <= exact(high):
        found = root(exact, low, high)
    at = exact_margin(tried.cam(found), layout, kept)
    return Least(found, at.at, at.by if at.least < UNDECIDED else "nothing", layout.offset)


def best_offset(layout: FollowerLayout, motion: ContactMotion, kept: Admissible) -> Least:
    """The offset [m] of a translating follower with which the base radius may be least.

    Of a flat face, whose offset moves nothing but the place of contact, that with which the face has to be least
    long on its longer side.

    Raises
    ------
    InputError
        An oscillating follower.
    MotionError
        As `least_base_radius`.
    """
    if layout.kind != "translating":
        raise InputError("[follower] kind", _("only a translating follower has an offset"))
    if layout.flat:
        least = least_base_radius(layout, motion, kept)
        ends = layout.cam(motion, least.base_radius).face
        return replace(least, offset=layout.offset + 0.5 * (ends.least + ends.greatest))
    nodes = looked_at(layout, motion, kept)

    before = 0.0

    def radius(offset: float) -> float:
        nonlocal before
        before = BaseCircleTrial(replace(layout, offset=offset), motion, kept, nodes).first(BACK * before)
        return before + layout.touch.roller

    speeds = float(nodes.lift[1].min()), float(nodes.lift[1].max())
    sides = sorted(layout.sense * one for one in speeds)
    # the best axis lies where neither the rise nor the fall alone would put it farther
    found = _optimize().minimize_scalar(
        radius,
        bounds=(sides[0], sides[1]),
        method="bounded",
        options={"xatol": OFFSET * (sides[1] - sides[0])},
    )
    return least_base_radius(replace(layout, offset=float(found.x)), motion, kept)


def follower_cam(cam: CamSource) -> FollowerCam:
    """The cam of a description with a follower.

    Where `[cam] base_radius` is omitted it is the least that `[bounds]` admits.

    Raises
    ------
    InputError
        A cam that is given by a curvature law; neither a base radius nor bounds that decide one; a follower that
        cannot be led; a profile that is undercut, unless `[study] show_undercut` is set: the least radius that is not
        is given.
    MotionError
        No base radius satisfies the bounds.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.follower_cam(ct.example("valve-cam")).base_radius
    0.024
    """
    cam = cam_of(cam)
    plate = with_follower(cam)
    body = _body(plate)
    if body.undercuts and not plate.study.show_undercut:
        raise _undercut(plate, body)
    return body


@functools.lru_cache(maxsize=16)
def _body(cam: PlateCam) -> FollowerCam:
    layout, motion, base = layout_of(cam), follower_motion(cam), cam.body.base_radius
    if base is None:
        if not has_bounds(cam):
            what = _("a profile needs the cam's base radius")
            raise InputError("[cam] base_radius", what, _("give it, or write [bounds] that it must satisfy"))
        least = _least(cam)
        if least.by == "nothing":
            what = _("no bound limits the base radius: every base radius satisfies them all")
            raise InputError("[cam] base_radius", what, _("give it, or bound the radius of curvature"))
        base = least.base_radius
    return replace(layout.cam(motion, base), cam=cam)


@functools.lru_cache(maxsize=16)
def _least(cam: PlateCam) -> Least:
    """The least cam, kept for whoever asks next: the cam as it is made has its radius, and its choice tells of it."""
    return least_base_radius(layout_of(cam), follower_motion(cam), chosen_admissible(cam))


def least_cam(cam: AnyCam, *, offset: bool = False) -> Least:
    """The least cam that keeps `[bounds]`: its base radius, what decides it and where.

    Parameters
    ----------
    offset : bool
        Choose the offset of a translating follower too, so that the base radius is least; of a flat face so that it is
        touched as far on both sides. Without bounds the profile is only kept from being undercut.

    Raises
    ------
    InputError
        A cam that is given by a curvature law; an oscillating follower has no offset.
    MotionError
        No base radius satisfies the bounds.
    """
    plate = with_follower(cam)
    if not offset:
        return _least(plate)
    return best_offset(layout_of(plate), follower_motion(plate), chosen_admissible(plate))


def has_bounds(cam: PlateCam) -> bool:
    """Whether the description says what is admissible of the profile."""
    bounds = cam.bounds
    given = (
        bounds.pressure_angle,
        bounds.return_pressure_angle,
        bounds.curvature_radius,
        bounds.roller_to_curvature,
        bounds.roller_to_radius,
    )
    return any(one is not None for one in given)


def has_size(cam: AnyCam) -> bool:
    """Whether a cam with a follower has a base radius, or bounds that are to give it one."""
    return isinstance(cam, PlateCam) and (cam.body.base_radius is not None or has_bounds(cam))


def has_profile(cam: AnyCam) -> bool:
    """Whether a cam with a follower has a size, and one that keeps its bounds where these are to give it.

    Raises InputError as `follower_cam`.
    """
    if not has_size(cam):
        return False
    try:
        follower_cam(cam)
    except MotionError:
        return False
    return True


def admissible_of(cam: PlateCam) -> Admissible:
    """What a description admits; what it leaves out is not bound, except that the profile is not undercut."""
    bounds = cam.bounds
    steep = bounds.pressure_angle or math.pi / 2
    return Admissible(
        steep,
        bounds.return_pressure_angle or steep,
        bounds.curvature_radius or 0.0,
        bounds.roller_to_curvature or 1.0,
        bounds.roller_to_radius or 1.0,
    )


ROLLER_TO_CURVATURE, ROLLER_TO_RADIUS = 0.8, 0.4
"""Ratios that a roller keeps where a base radius is chosen and the description gives none: those of course projects.

With the first the cam is not pointed; with the second the roller's pin has room, and the cam a shaft.
"""


def chosen_admissible(cam: PlateCam) -> Admissible:
    """What the least cam of a description keeps: its bounds, and for a roller the customary ratios of its radius.

    Where bounds are given at all. A least radius of curvature stands in place of the ratio to that of the path.
    """
    found = admissible_of(cam)
    if not has_bounds(cam):
        return found
    bounds = cam.bounds
    if bounds.roller_to_curvature is None and bounds.curvature_radius is None:
        found = replace(found, roller_to_curvature=ROLLER_TO_CURVATURE)
    if bounds.roller_to_radius is None:
        found = replace(found, roller_to_radius=ROLLER_TO_RADIUS)
    return found


def stretches_text(undercuts: list[Undercut]) -> str:
    """Stretches and corners in degrees, in words."""
    texts = []
    for one in undercuts:
        start, stop = math.degrees(one.start), math.degrees(one.stop)
        text = _("{first:.6g} to {last:.6g}").format(first=start, last=stop)
        texts.append(f"{start:.6g}" if start == stop else text)
    return ", ".join(texts)


def _undercut(cam: PlateCam, body: FollowerCam) -> InputError:
    """What is said of a profile that its follower cuts away: where, and what would not."""
    what = _("the follower undercuts the profile at {stretches} deg").format(
        stretches=stretches_text(body.undercuts)
    )
    show = _("[study] show_undercut = true shows it")
    if any(corner.undercuts(body.touch.roller) for corner in body.corners):
        join = _("join the segments with equal slopes there")
        return InputError("[[segments]]", what, f"{join}; {show}")
    ways: list[str] = []
    try:
        least = least_base_radius(layout_of(cam), body.motion, Admissible()).base_radius
        ways.append(_("choose a base radius above {least:.6g} mm").format(least=1e3 * least))
    except MotionError:
        ways.append(_("choose a smaller lift or longer segments"))
    most, _at = body.greatest_roller
    if 0.0 < most < body.touch.roller < math.inf:
        roller = _("a roller below {most:.6g} mm on the same path of its centre")
        ways.append(roller.format(most=1e3 * most))
    return InputError("[cam] base_radius", what, "; ".join([_(" or ").join(ways), show]))
