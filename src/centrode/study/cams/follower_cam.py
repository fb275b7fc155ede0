"""The profile under a follower in words: pressure angle, curvature, undercut, face, cutter."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from centrode.cams.followers.base_circle import (
    Least,
    admissible_of,
    best_offset,
    exact_margin,
    follower_cam,
    has_bounds,
    layout_of,
    least_base_radius,
    stretches_text,
)
from centrode.cams.followers.geometry import Face, FollowerCam, Oscillating
from centrode.cams.followers.manufacture import (
    check_cutter,
    follower_outlines,
    follower_profile,
    points_dataset,
)
from centrode.cams.nodes import nodes_of
from centrode.cams.roller_path import angles_of
from centrode.errors import MotionError
from centrode.locale import _, mark
from centrode.model.follower_cam import PlateCam
from centrode.numerics.search import roots
from centrode.sheets.sheet import Scalar
from centrode.study.cams.parts import Asked, CamPart, Rows, Units

# What is admissible of a profile under a follower: whether it is kept, the least cam, the best offset, in
# words.

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
        told.rows.append((_("least base radius"), _deciding_bound(least, units)))
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


def _deciding_bound(least: Least, units: Units) -> str:
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


def plate_part(cam: PlateCam, asked: Asked) -> CamPart | None:
    """The profile that a follower asks for; nothing where neither a base radius nor bounds are given."""
    if cam.body.base_radius is None and not has_bounds(cam):
        return None
    heading = _("Profile of the cam")
    try:
        body = follower_cam(cam)
    except MotionError as refusal:
        told = f"{refusal.what}; {refusal.repair}"
        return CamPart(heading, [(_("base radius"), _("none"))], {}, failures=(told,))
    cutter = None if cam.tool is None else cam.tool.radius
    outlines = follower_outlines(body, cam.study.chord_tolerance, cutter)
    datasets = {
        "cam-profile": follower_profile(body, angles_of(cam, asked.samples), cutter),
        "cam-points": points_dataset(outlines),
    }
    units, bounds = Units(cam), bounds_told(cam, body)
    rows = [
        *_size(cam, body, units),
        *_pressure(body, units),
        *_curvature(body, units),
        *_undercut(body, units),
        *_face(body, units),
        *_cutter(cam, body, units, len(datasets["cam-points"]["sample"])),
        *bounds.rows,
    ]
    return CamPart(
        heading,
        rows,
        _scalars(body) | bounds.scalars,
        datasets,
        failures=tuple(bounds.failures),
        objects={"plate": body, "plate_outlines": outlines},
    )


def _size(cam: PlateCam, body: FollowerCam, units: Units) -> Rows:
    text = units.text(body.base_radius)
    if cam.body.base_radius is None:
        text = _("{radius}, the least that the bounds admit").format(radius=text)
    return [(_("base radius"), text), (_("greatest radius"), units.text(_greatest(body), digits=5))]


def _greatest(body: FollowerCam) -> float:
    """The greatest polar radius of the profile: it lies where the lift rests, as the normal then meets the centre."""
    nodes = nodes_of(body.edges)
    phi = np.append(nodes, roots(lambda phi: np.asarray(body.motion.lift(phi, 1)[1]), nodes))
    return float(np.hypot(*body.contact(phi).place.T).max())


def _pressure(body: FollowerCam, units: Units) -> Rows:
    if isinstance(body.touch, Face) and not isinstance(body.guide, Oscillating):
        return [(_("pressure angle"), _("0 deg: the face is square to its way"))]
    found = body.pressure
    text = _("{least} at {at_least} to {greatest} at {at_greatest}").format(
        least=units.angle(found.least),
        at_least=units.angle(found.at_least),
        greatest=units.angle(found.greatest),
        at_greatest=units.angle(found.at_greatest),
    )
    return [(_("pressure angle"), text)]


def _curvature(body: FollowerCam, units: Units) -> Rows:
    (bend, at), (hollow, there) = body.least_bend, body.greatest_cutter
    rows, label = [], _("radius of curvature of the profile")
    if math.isfinite(bend):
        text = _("from {radius} where it is convex, at {at}")
        if bend <= 0.0:
            text = _("from {radius} where it is undercut, at {at}")
        rows.append((label, text.format(radius=units.text(bend), at=units.angle(at))))
        label = ""
    if 0.0 < hollow < math.inf:
        text = _("from {radius} where it is hollow, at {at}")
        rows.append((label, text.format(radius=units.text(hollow), at=units.angle(there))))
    return rows


def _undercut(body: FollowerCam, units: Units) -> Rows:
    found = body.undercuts
    told = _("at {stretches} deg").format(stretches=stretches_text(found)) if found else _("none")
    rows = [(_("undercut"), told)]
    depth, at = body.overlap
    if depth and not found:
        text = _("the roller at {place} overlaps the cam by {depth} across a waist")
        shown = text.format(place=units.angle(at), depth=units.text(depth, digits=3))
        rows.append((_("overlap"), shown))
    most, _where = body.greatest_roller
    if 0.0 < body.touch.roller < math.inf and 0.0 < most < math.inf:
        text = _("below {radius} on this path of its centre").format(radius=units.text(most))
        rows.append((_("greatest roller"), text))
    return rows


def _face(body: FollowerCam, units: Units) -> Rows:
    """Where the cam touches a flat face, and how wide that is."""
    if not isinstance(body.touch, Face):
        return []
    ends = body.face
    text = _("{least} to {greatest} from the follower's axis, {width} wide")
    if isinstance(body.guide, Oscillating):
        text = _("{least} to {greatest} from the pivot, {width} wide")
    least, greatest, width = (
        units.text(one) for one in (ends.least, ends.greatest, ends.greatest - ends.least)
    )
    return [(_("contact on the face"), text.format(least=least, greatest=greatest, width=width))]


def _cutter(cam: PlateCam, body: FollowerCam, units: Units, points: int) -> Rows:
    """The tool, and the points for a machine."""
    rows = []
    most, _at = body.greatest_cutter
    if cam.tool is not None:
        check_cutter(body, cam.tool.radius)
        text = _("radius {radius}").format(radius=units.text(cam.tool.radius))
        if math.isfinite(most):
            text = _("radius {radius}, at most {most}").format(
                radius=units.text(cam.tool.radius), most=units.text(most)
            )
        rows.append((_("cutter"), text))
    text = _("{count}, chords within {tolerance}")
    tolerance = units.text(cam.study.chord_tolerance, digits=3)
    return [*rows, (_("points"), text.format(count=points, tolerance=tolerance))]


def _scalars(body: FollowerCam) -> dict[str, Scalar]:
    """Numbers of the profile; what has no bound is left out."""
    numbers: dict[str, tuple[float, str]] = {
        "base_radius": (body.base_radius, "m"),
        "profile_greatest_radius": (_greatest(body), "m"),
        "undercuts": (len(body.undercuts), "1"),
        "overlap": (body.overlap[0], "m"),
    }
    steep = body.pressure
    at, value = max(
        ((steep.at_least, -steep.least), (steep.at_greatest, steep.greatest)), key=lambda one: one[1]
    )
    found = {"greatest_pressure_angle": (abs(value), at, "rad"), "least_bend": (*body.least_bend, "m")}
    if isinstance(body.touch, Face):
        numbers |= {"face_from": (body.face.least, "m"), "face_to": (body.face.greatest, "m")}
    else:
        found["greatest_roller"] = (*body.greatest_roller, "m")
        found["greatest_cutter"] = (*body.greatest_cutter, "m")
    for name, (number, where, unit) in found.items():
        numbers |= {
            name: (number, unit),
            f"{name}_at": (where, "rad") if math.isfinite(number) else (math.inf, ""),
        }
    return {f"cam_{name}": Scalar(*one) for name, one in numbers.items() if math.isfinite(one[0])}
