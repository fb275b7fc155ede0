"""The profile under a follower in words: pressure angle, curvature, undercut, face, cutter."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import xarray as xr

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
from centrode.cams.followers.forces import dataset_of_forces, follower_forces
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


# Forces between cam and follower in words: contact, springs, torque, stress.

MEGA = 1e-6


def forces_part(cam: PlateCam, asked: Asked) -> CamPart | None:
    """Forces over a turn; nothing where neither mass nor spring nor load is given, or no base radius."""
    follower = cam.follower
    given = follower.mass or follower.inertia or follower.load or follower.spring is not None
    if not given or (cam.body.base_radius is None and not has_bounds(cam)):
        return None
    try:
        forces = follower_forces(cam)
    except MotionError:  # told of the profile
        return None
    found = dataset_of_forces(cam, forces, angles_of(cam, asked.samples))
    heading = _("Forces on cam and follower")
    failures = _failures(cam, found)
    return CamPart(
        heading, forces_rows(cam, found), _force_scalars(cam, found), {"cam-forces": found}, failures=failures
    )


def forces_rows(cam: PlateCam, forces: xr.Dataset) -> Rows:
    """What keeps the contact, how fast the cam may turn, the greatest forces, torque and stress.

    Parameters
    ----------
    cam : PlateCam
    forces : Dataset
        Of `cam_forces`.
    """
    facts, said = forces.attrs, _Said(cam)
    rows = [(_("speed of the cam"), _turns(facts["speed"]) if facts["speed"] else _("none: forces at rest"))]
    rows += _pushing(facts, said)
    if not facts["led"]:
        rows += _springs(facts, said)
    rows += _greatest_force(facts, said)
    return rows


class _Said:
    """Forces and angles as they are shown."""

    def __init__(self, cam: PlateCam) -> None:
        self.units = Units(cam)
        self.swings = cam.swings
        self.push = "N·m" if cam.swings else "N"

    def at(self, text: str, angle: float) -> str:
        return _("{value} at {angle}").format(value=text, angle=self.units.angle(angle))

    def pushed(self, value: float) -> str:
        return f"{value:.6g} {self.push}"

    def stiffness(self, value: float) -> str:
        return f"{value:.6g} N·m/rad" if self.swings else f"{1e-3 * value:.6g} N/mm"


def _pushing(facts: dict[str, float], said: _Said) -> Rows:
    """The least push, and the speed of jumping."""
    if facts["led"]:
        return [
            (
                _("contact of cam and follower"),
                _("nothing presses the follower on the cam: it has to be led both ways"),
            )
        ]
    least = facts["least_push"]
    if least == -math.inf:
        told = _("lost: the speed of the lift falls by a step at {angle}")
        rows = [
            (_("contact of cam and follower"), told.format(angle=said.units.angle(facts["least_push_at"])))
        ]
    elif least < 0:
        told = _("lost: {push} along the follower").format(push=said.pushed(least))
        rows = [(_("contact of cam and follower"), said.at(told, facts["least_push_at"]))]
    else:
        told = _("kept: at least {push} along the follower").format(push=said.pushed(least))
        rows = [(_("contact of cam and follower"), said.at(told, facts["least_push_at"]))]
    return [*rows, (_("the follower jumps"), _jumps(facts, said))]


def _jumps(facts: dict[str, float], said: _Said) -> str:
    speed = facts["jump_speed"]
    if math.isinf(speed):
        return _("at no speed")
    if speed == 0:
        return _("at every speed")
    told = _("from {speed} on").format(speed=_turns(speed))
    return said.at(told, facts["jump_speed_at"])


def _springs(facts: dict[str, float], said: _Said) -> Rows:
    """Springs that would just keep the contact at this speed."""
    preload, stiffness = facts["preload_needed"], facts["stiffness_needed"]
    if math.isinf(preload):
        return [(_("spring needed"), _("none keeps the contact"))]
    told = _("with this stiffness a preload of {value}").format(value=said.pushed(preload))
    if preload <= 0:
        told = _("with this stiffness no preload")
    rows = [(_("spring needed"), told)]
    if math.isinf(stiffness):
        return [*rows, ("", _("with this preload none is stiff enough"))]
    told = _("with this preload a stiffness of {value}").format(value=said.stiffness(stiffness))
    if stiffness <= 0:
        told = _("with this preload no stiffness")
    return [*rows, ("", told)]


def _greatest_force(facts: dict[str, float], said: _Said) -> Rows:
    """Greatest force, torque, stress."""
    if math.isinf(facts["greatest_force"]):
        told = _("without bound: friction locks the follower at {angle}")
        return [
            (_("greatest contact force"), told.format(angle=said.units.angle(facts["greatest_force_at"])))
        ]
    if not math.isfinite(facts["greatest_force"]):
        return [(_("greatest contact force"), _("none is known"))]
    rows = [
        (
            _("greatest contact force"),
            said.at(f"{facts['greatest_force']:.6g} N", facts["greatest_force_at"]),
        ),
        (
            _("torque of the camshaft"),
            _("{least} to {greatest}").format(
                least=said.at(f"{facts['least_torque']:.6g} N·m", facts["least_torque_at"]),
                greatest=said.at(f"{facts['greatest_torque']:.6g} N·m", facts["greatest_torque_at"]),
            ),
        ),
    ]
    if math.isfinite(facts["works_difference"]):
        told = _("by virtual work the torque is the same within {apart:.1g} N·m")
        rows.append(("", told.format(apart=facts["works_difference"])))
    stress = facts.get("greatest_stress", math.nan)
    if math.isfinite(stress):
        told = said.at(f"{MEGA * stress:.6g} MPa", facts["greatest_stress_at"])
        rows.append((_("greatest contact stress"), told + _bound(facts)))
    return rows


def _bound(facts: dict[str, float]) -> str:
    admissible = facts.get("admissible_stress")
    if admissible is None:
        return ""
    if facts["greatest_stress"] <= admissible:
        return _(", admissible {stress}").format(stress=f"{MEGA * admissible:.6g} MPa")
    return _(", more than the admissible {stress}").format(stress=f"{MEGA * admissible:.6g} MPa")


def _turns(speed: float) -> str:
    return _("{turns} rpm").format(turns=f"{speed * 30 / math.pi:.6g}")


def _failures(cam: PlateCam, forces: xr.Dataset) -> tuple[str, ...]:
    """A follower that is pressed on the cam and jumps all the same, or that friction locks."""
    facts, said = forces.attrs, _Said(cam)
    told = []
    if not facts["led"] and facts["least_push"] < 0:
        what = _("the follower jumps off the cam at {angle}").format(
            angle=said.units.angle(facts["least_push_at"])
        )
        speed, preload = facts["jump_speed"], facts["preload_needed"]
        if 0 < speed < math.inf:
            repair = _("turn it slower than {speed}, or preload the spring with {value}")
            what += "; " + repair.format(speed=_turns(speed), value=said.pushed(preload))
        told.append(what)
    if math.isinf(facts["greatest_force"]):
        told.append(_("friction locks the follower: no force of the cam moves it"))
    if facts.get("greatest_stress", math.nan) > facts.get("admissible_stress", math.inf):
        what = _("the contact stress is not admissible at {angle}")
        told.append(what.format(angle=said.units.angle(facts["greatest_stress_at"])))
    return tuple(told)


def _force_scalars(cam: PlateCam, forces: xr.Dataset) -> dict[str, Scalar]:
    push, stiffness = ("N m", "N m/rad") if cam.swings else ("N", "N/m")
    units = {
        "least_push": push,
        "least_push_at": "rad",
        "jump_speed": "rad/s",
        "jump_speed_at": "rad",
        "preload_needed": push,
        "stiffness_needed": stiffness,
        "greatest_force": "N",
        "greatest_force_at": "rad",
        "greatest_torque": "N m",
        "greatest_torque_at": "rad",
        "least_torque": "N m",
        "least_torque_at": "rad",
        "greatest_stress": "Pa",
        "greatest_stress_at": "rad",
    }
    facts = forces.attrs
    return {
        f"cam_{name}": Scalar(facts[name], unit)
        for name, unit in units.items()
        if math.isfinite(facts.get(name, math.nan))
    }
