"""What is admissible of a profile under a follower: whether it is kept, the least cam, the best offset, in words."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from centrode.cams.followers.base_circle import (
    Least,
    admissible_of,
    best_offset,
    exact_margin,
    has_bounds,
    layout_of,
    least_base_radius,
)
from centrode.cams.followers.geometry import FollowerCam
from centrode.errors import MotionError
from centrode.locale import _, mark
from centrode.model.follower_cam import PlateCam
from centrode.sheets.sheet import Scalar
from centrode.study.cams.said import Rows, Units

ROUNDING = 1e-9
"""Margins that are rounding."""
DECIDES = {"pressure angle": mark("the pressure angle"), "curvature": mark("the radius of curvature")}


@dataclass
class BoundsTold:
    """Rows, numbers and failures."""

    rows: Rows = field(default_factory=list)
    scalars: dict[str, Scalar] = field(default_factory=dict)
    failures: list[str] = field(default_factory=list)


def bounds_told(cam: PlateCam, body: FollowerCam) -> BoundsTold:
    """What `[bounds]` asks of the profile, the least cam that keeps it, and whether this one does."""
    told = BoundsTold()
    if not has_bounds(cam):
        return told
    layout, kept, units = layout_of(cam), admissible_of(cam), Units(cam)
    told.rows.append((_("admissible"), _admissible(cam, units)))
    least = None
    try:
        least = least_base_radius(layout, body.motion, kept)
        told.rows.append((_("least base radius"), _decided(least, units)))
        free = least.by == "nothing"
        if not free:
            told.scalars["cam_least_base_radius"] = Scalar(least.base_radius, "m")
        if layout.kind == "translating" and (layout.flat or not free):
            _offset(told, best_offset(layout, body.motion, kept), units, flat=layout.flat)
    except MotionError as refusal:
        told.rows.append((_("least base radius"), refusal.what))
    margin = exact_margin(body, layout, kept)
    if margin.least < -ROUNDING:
        text = _("{bound} is not admissible at {at}").format(
            bound=_(DECIDES[margin.by]), at=units.angle(margin.at)
        )
        if least is not None and least.by != "nothing":
            text += "; " + _("take a base radius from {least} on").format(least=units.text(least.base_radius))
        told.failures.append(text)
    return told


def _admissible(cam: PlateCam, units: Units) -> str:
    kept, given = admissible_of(cam), cam.bounds
    texts = []
    if given.pressure_angle is not None:
        texts.append(_("pressure angle up to {angle}").format(angle=units.angle(kept.pressure_angle)))
    if given.return_pressure_angle is not None:
        texts.append(_("on the return up to {angle}").format(angle=units.angle(kept.return_angle)))
    if given.curvature_radius is not None:
        texts.append(_("radius of curvature from {radius}").format(radius=units.text(kept.bend)))
    return ", ".join(texts)


def _decided(least: Least, units: Units) -> str:
    if least.by == "nothing":
        return _("none: no bound decides it")
    return _("{radius}, decided by {bound} at {at}").format(
        radius=units.text(least.base_radius), bound=_(DECIDES[least.by]), at=units.angle(least.at % math.tau)
    )


def _offset(told: BoundsTold, best: Least, units: Units, *, flat: bool) -> None:
    """The offset with which the cam may be least, or which halves the contact along a flat face."""
    text = _("{offset}: base radius from {radius} on")
    if flat:
        text = _("{offset}: the face is touched as far on both sides")
    shown = text.format(
        offset=units.text(best.offset if abs(best.offset) > ROUNDING * best.base_radius else 0.0),
        radius=units.text(best.base_radius),
    )
    told.rows.append((_("best offset"), shown))
    told.scalars["cam_best_offset"] = Scalar(best.offset, "m")
    if not flat:
        told.scalars["cam_best_base_radius"] = Scalar(best.base_radius, "m")
