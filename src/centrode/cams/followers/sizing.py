"""The least cam that keeps a pressure angle and a radius of curvature, and the offset that makes it least."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from scipy.optimize import minimize_scalar

from centrode.cams.followers.bodies import FollowerCam
from centrode.cams.followers.contact import Motion
from centrode.cams.followers.growing import BACK, NEAR, UNDECIDED, Tried, looked_at
from centrode.cams.followers.layouts import Layout
from centrode.cams.followers.margins import Admissible, breaks, exact_margin
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.numerics.search import root

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
    by : "pressure angle", "curvature" or "nothing"
        What decides it there; where nothing does, smaller cams keep the bounds too, and the radius is the least that
        was tried.
    offset : float [m]
        Of a translating follower.
    """

    base_radius: float
    at: float
    by: str
    offset: float = 0.0


def _check_corners(cam: FollowerCam, layout: Layout, kept: Admissible) -> None:
    """Raise MotionError where the speed of the lift jumps so that every cam has a sharp corner."""
    for corner in cam.corners:
        if breaks(corner, layout, kept):
            what = _("at {angle:.6g} deg the speed of the lift jumps: every radius leaves a sharp corner")
            told = what.format(angle=math.degrees(corner.at))
            raise MotionError("[[segments]]", told, _("join the segments there with equal slopes"))


def least_base_radius(layout: Layout, motion: Motion, kept: Admissible) -> Least:
    """The least base radius [m] with which a cam keeps what is admissible.

    Radii are tried upwards, each a twentieth greater, the first that keeps the bounds is refined to rounding.

    Raises
    ------
    MotionError
        None does; what comes nearest is told.
    """
    tried = Tried(layout, motion, kept)
    found = tried.first()
    _check_corners(tried.cam(found), layout, kept)

    def exact(base: float) -> float:
        return exact_margin(tried.cam(base), layout, kept).least

    low, high = found * (1.0 - NEAR), found * (1.0 + NEAR)
    if tried.reaches(low) and exact(low) < 0.0 <= exact(high):
        found = root(exact, low, high)
    at = exact_margin(tried.cam(found), layout, kept)
    return Least(found, at.at, at.by if at.least < UNDECIDED else "nothing", layout.offset)


def best_offset(layout: Layout, motion: Motion, kept: Admissible) -> Least:
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
        before = Tried(replace(layout, offset=offset), motion, kept, nodes).first(BACK * before)
        return before + layout.touch.roller

    speeds = float(nodes.lift[1].min()), float(nodes.lift[1].max())
    sides = sorted(layout.sense * one for one in speeds)
    # the best axis lies where neither the rise nor the fall alone would put it farther
    found = minimize_scalar(
        radius,
        bounds=(sides[0], sides[1]),
        method="bounded",
        options={"xatol": OFFSET * (sides[1] - sides[0])},
    )
    return least_base_radius(replace(layout, offset=float(found.x)), motion, kept)
