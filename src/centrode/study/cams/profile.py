"""The profile of a cam in words: how it closes, what its return arc keeps, undercut."""

from __future__ import annotations

import math

from centrode.cams.profiles import ProfileBody, Undercut, cam_body
from centrode.cams.results import count_of, profile_dataset
from centrode.errors import MotionError
from centrode.locale import _
from centrode.model.cam import Cam
from centrode.sheets.sheet import Scalar
from centrode.study.cams.said import Asked, CamPart, Rows, Units


def profile_part(cam: Cam, asked: Asked) -> CamPart | None:
    """The profile that the roller leaves; nothing without a roller."""
    if cam.roller is None:
        return None
    heading = _("Profile of the cam")
    try:
        body = cam_body(cam)
    except MotionError as refusal:
        return CamPart(
            heading, [(_("return arc"), _("none"))], {}, failures=(f"{refusal.what}; {refusal.repair}",)
        )
    units = Units(cam)
    rows = [
        (_("roller"), _("radius {radius}").format(radius=units.text(body.roller))),
        *_closing(body, units),
        *_bends(body, units),
    ]
    dataset = profile_dataset(body, count_of(cam, asked.samples), groove=asked.groove)
    return CamPart(heading, rows, _scalars(body), {"cam-profile": dataset}, objects={"body": body})


def _closing(body: ProfileBody, units: Units) -> Rows:
    """The working arc, the return arc, and how they join."""
    working = body.closed.arcs[0]
    ends = {"first": units.angle(working.start), "last": units.angle(working.stop)}
    rows = [(_("working arc"), _("{first} to {last}").format(**ends))]
    if not body.closed.whole:
        return [*rows, (_("closure"), _("open: give [return] or [mover] to close it"))]
    if body.returned is None:
        return [*rows, (_("closure"), _kinks(body, units))]
    found = body.returned
    size = _(
        "ρ {least} to {greatest}, radius of curvature from {bend}, pressure angle up to {steepest}"
    ).format(
        least=units.text(found.radius.least),
        greatest=units.text(found.radius.greatest),
        bend=units.text(1.0 / found.curvature.greatest),
        steepest=units.angle(max(-found.pressure_angle.least, found.pressure_angle.greatest), 5),
    )
    shape = _("convex") if found.curvature.least >= 0.0 else _hollow(found.curvature.least, units)
    way = _("the smoothest by itself") if not found.additions else _("the smoothest within the bounds")
    joined = _(
        "joined in value, slope and curvature: gap {gap:.1g} m, kink {kink:.1g} rad, curvature {jump:.1g}"
    )
    gaps = max(abs(joint.gap) for joint in body.closed.joints)
    return [
        *rows,
        (_("return arc"), f"{way}, {shape}"),
        ("", size),
        ("", joined.format(gap=gaps, kink=body.closed.greatest_kink, jump=body.greatest_jump)),
    ]


def _hollow(curvature: float, units: Units) -> str:
    return _("hollow with a radius from {radius}").format(radius=units.text(-1.0 / curvature))


def _kinks(body: ProfileBody, units: Units) -> str:
    """How a path closes that was not designed to."""
    if not body.kinks:
        return _("closed without a kink")
    places = ", ".join(f"{math.degrees(math.remainder(one.at, math.tau)):.6g}" for one in body.kinks)
    worst = max(body.kinks, key=lambda one: abs(one.kink))
    text = _("kinks of {kink} outwards at {places} deg")
    if worst.kink > 0:
        text = _("kinks of {kink} inwards at {places} deg")
    return text.format(kink=units.angle(abs(worst.kink), 6), places=places)


def _bends(body: ProfileBody, units: Units) -> Rows:
    """Undercut, and the roller that would be too large."""
    most, at = body.greatest_roller
    least = most - body.roller
    rows = []
    if math.isfinite(most):
        text = _("from {radius} where it is convex, at {at}").format(
            radius=units.text(least), at=units.angle(at)
        )
        rows.append((_("radius of curvature of the profile"), text))
        rows.append((_("greatest roller"), _("below {radius}").format(radius=units.text(most))))
    if body.undercuts:
        text = ", ".join(_stretch(one) for one in body.undercuts)
        rows.append((_("undercut"), _("from {stretches} deg").format(stretches=text)))
    else:
        rows.append((_("undercut"), _("none")))
        depth, place = body.overlap
        if depth:
            text = _("the roller at {place} overlaps the cam by {depth} across a waist")
            rows.append(
                (_("overlap"), text.format(place=units.angle(place), depth=units.text(depth, digits=3)))
            )
    return rows


def _stretch(one: Undercut) -> str:
    start = math.degrees(math.remainder(one.start, math.tau))
    stop = start + math.degrees(one.stop - one.start)
    return _("{first:.6g} to {last:.6g}").format(first=start, last=stop)


def _scalars(body: ProfileBody) -> dict[str, Scalar]:
    most, at = body.greatest_roller
    scalars = {
        "cam_closed": Scalar(int(body.closed.whole), "1"),
        "cam_kink": Scalar(body.closed.greatest_kink, "rad"),
        "cam_undercuts": Scalar(len(body.undercuts), "1"),
        "cam_overlap": Scalar(body.overlap[0], "m"),
    }
    if math.isfinite(most):
        scalars["cam_greatest_roller"] = Scalar(most, "m")
        scalars["cam_greatest_roller_at"] = Scalar(at, "rad")
    if body.returned is not None:
        scalars["cam_return_least_radius"] = Scalar(body.returned.radius.least, "m")
        scalars["cam_return_greatest_radius"] = Scalar(body.returned.radius.greatest, "m")
    return scalars
