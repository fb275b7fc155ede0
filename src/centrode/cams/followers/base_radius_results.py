"""The choice of a cam's base radius: what decides it, the best offset, other radii beside it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from centrode.cams.followers.base_circle import (
    Least,
    Margin,
    admissible_of,
    chosen_admissible,
    exact_margin,
    follower_cam,
    has_bounds,
    layout_of,
    least_cam,
)
from centrode.cams.followers.geometry import FollowerCam
from centrode.cams.followers.motion import FollowerMotion, follower_motion
from centrode.cams.nodes import nodes_of
from centrode.errors import CentrodeError, MotionError
from centrode.model.cam_files import with_follower
from centrode.model.examples.catalogue import CamSource, cam_of
from centrode.model.follower_cam import PlateCam

SHARES = (0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 2.0)
"""Base radii beside each other, over the cam's own."""
NEAR = 1e-6
"""By how much of itself a least radius is changed to see that it is one."""
ROUNDING = 1e-12
"""By how much of itself a cam is greater than the least so that its follower reaches it."""


@dataclass(frozen=True)
class BaseRadiusResults:
    """The choice of a cam's base radius.

    Attributes
    ----------
    cam : PlateCam
    motion : FollowerMotion
    body : FollowerCam or None
        The cam as it is made; None where no base radius keeps the bounds that are to give it.
    least : Least or None
        The least cam that keeps the bounds; None where there are none, or no cam keeps them.
    best : Least or None
        The same with the best offset of a translating follower, where a bound decides or the face is flat.
    refusal : MotionError or None
        Why there is no least cam.
    margin : Margin or None
        By how much the cam keeps its bounds; None where there are none.
    """

    cam: PlateCam
    motion: FollowerMotion
    body: FollowerCam | None
    least: Least | None = None
    best: Least | None = None
    refusal: MotionError | None = None
    margin: Margin | None = None

    @property
    def is_free(self) -> bool:
        """Whether no bound decides the base radius."""
        return self.least is not None and self.least.by == "nothing"


@dataclass(frozen=True)
class SizedCam:
    """A cam of another base radius; all but this are NaN where it cannot lead its follower.

    Attributes
    ----------
    base_radius : float [m]
    rising, falling : float [rad]
        Greatest sizes of the pressure angle on the way up and down.
    bend : float [m]
        Least radius of curvature of the profile where it bulges.
    """

    base_radius: float
    rising: float = math.nan
    falling: float = math.nan
    bend: float = math.nan


def choose_base_radius(
    cam: CamSource, samples: int | None = None, *, instants: Sequence[float] | None = None
) -> BaseRadiusResults:
    """What decides the base radius of a cam with a follower.

    `samples` and `instants` are those of every topic of a cam: bounds are kept over the whole turn.

    Raises
    ------
    InputError
        As `follower_cam`.

    Examples
    --------
    >>> import centrode as ct
    >>> chosen = ct.choose_base_radius(ct.example("indexing-cam"))
    >>> round(chosen.least.base_radius, 4), chosen.least.by
    (0.0337, 'pressure angle')
    """
    cam = cam_of(cam)
    del samples, instants
    plate = with_follower(cam)
    motion = follower_motion(plate)
    try:
        body = follower_cam(plate)
    except MotionError as refusal:
        return BaseRadiusResults(plate, motion, None, refusal=refusal)
    found = BaseRadiusResults(plate, motion, body)
    if not has_bounds(plate):
        return found
    margin = exact_margin(body, layout_of(plate), admissible_of(plate))
    found = with_least(replace(found, margin=margin))
    if found.least is None or plate.swings or (found.is_free and plate.follower.contact != "flat"):
        return found
    if found.least.by == "roller to radius":
        return found  # no offset makes the cam smaller
    try:
        return replace(found, best=least_cam(plate, offset=True))
    except MotionError as refusal:
        return replace(found, refusal=refusal)


def with_least(results: BaseRadiusResults) -> BaseRadiusResults:
    """The results with the least cam, or why there is none; without bounds a cam is only kept from being undercut."""
    try:
        return replace(results, least=least_cam(results.cam))
    except MotionError as refusal:
        return replace(results, refusal=refusal)


def cam_of_base_radius(results: BaseRadiusResults, base_radius: float) -> FollowerCam:
    """The cam with another base radius [m]; raises InputError where it cannot lead its follower."""
    return layout_of(results.cam).cam(results.motion, base_radius)


def least_body(results: BaseRadiusResults) -> FollowerCam:
    """The least cam; there has to be one."""
    assert results.least is not None
    return cam_of_base_radius(results, results.least.base_radius * (1.0 + ROUNDING))


def is_least(results: BaseRadiusResults) -> bool:
    """Whether a cam smaller than the least one by `NEAR` breaks the bounds, and one so much greater keeps them."""
    assert results.least is not None
    layout, admissible = layout_of(results.cam), chosen_admissible(results.cam)
    least = results.least.base_radius

    def keeps(base_radius: float) -> bool:
        try:
            body = cam_of_base_radius(results, base_radius)
        except CentrodeError:
            return False
        return exact_margin(body, layout, admissible).least >= 0.0

    return keeps(least * (1.0 + NEAR)) and not keeps(least * (1.0 - NEAR))


def sized_cams(results: BaseRadiusResults) -> list[SizedCam]:
    """Cams whose base radii are `SHARES` of that of the cam as it is made."""
    assert results.body is not None
    return [_sized_cam(results, share * results.body.base_radius) for share in SHARES]


def _sized_cam(results: BaseRadiusResults, base_radius: float) -> SizedCam:
    try:
        body = cam_of_base_radius(results, base_radius)
    except CentrodeError:
        return SizedCam(base_radius)
    phi = np.concatenate([nodes_of(body.edges), body.turns("pressure")])
    slope, steep = body.motion.lift(phi, 1)[1], np.abs(body.contact(phi).pressure_angle)
    # on a dwell the slope is rounding, and counts on both ways
    still = 1e-12 * float(np.abs(slope).max())
    rising, falling = (
        float(np.max(steep, where=way, initial=0.0)) for way in (slope >= -still, slope <= still)
    )
    return SizedCam(base_radius, rising, falling, body.least_bend[0])
