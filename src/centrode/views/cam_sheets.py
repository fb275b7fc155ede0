"""The sheet of a cam: diagrams of its follower's motion, the choice of its radius, its profile by inversion."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.base_circle import admissible_of
from centrode.cams.followers.closed_forms import ClosedForms
from centrode.cams.followers.geometry import Array, Face, Oscillating, Translating
from centrode.cams.followers.inversion import (
    centres_in_frame,
    directions_in_frame,
    in_cam,
    numbered_angles,
    velocity_ends,
)
from centrode.cams.followers.motion import extremes_of, follower_motion, motion_names, stretches
from centrode.cams.nodes import inside, nodes_of
from centrode.quantities import QUANTITIES
from centrode.sheets.drawing_sheets import (
    GeometricDrawing,
    GeometryAngle,
    GeometryCircle,
    GeometryFrame,
    GeometryLine,
    GeometryName,
    LineLook,
    ProfileSheet,
    ScaledCurve,
    ScaledDiagram,
)
from centrode.sheets.plots import AxisLabel
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Symbol, Text, Unit
from centrode.views.followers import CONTACTS, KINDS, curve_name
from centrode.views.geometric_drawings import (
    CENTRE,
    PLACES,
    angle_axis,
    angle_between,
    greatest_angle_text,
    in_degrees,
    length_facts,
    mesh_with,
    mirror_image,
    numbered_names,
    point_of,
    ticks_of,
)

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.model.drives import Drive
    from centrode.model.follower_cam import PlateCam
    from centrode.model.settings import Display

BEYOND = 0.12
"""How far faces, rays and axes go on beyond what they are drawn for, over the base radius."""
WALLS, ABOVE, STEM = 0.15, 0.3, 0.1
"""Over the base radius: between the highest place and the guide; length of the guide; the stem above it."""
RAY = 0.4
"""How far a line at the admissible angle goes on beyond the foot of the cam's centre, over the base radius."""
ARC = 0.55
"""Radius of the arc of an angle over the base radius."""
RADIUS_AT = math.radians(215.0)
"""Direction of the radius of the base circle that is named, where most followers leave room."""
MOST_FACTS = 8
"""Segments that are listed."""
TITLES = {
    False: (
        Sentence("Lift of the follower"),
        Sentence("Velocity coefficient of the follower"),
        Sentence("Acceleration coefficient of the follower"),
    ),
    True: (
        Sentence("Angle of the follower"),
        Sentence("Angular velocity coefficient of the follower"),
        Sentence("Angular acceleration coefficient of the follower"),
    ),
}


def cam_sheet(cam: PlateCam, body: FollowerCam, positions: int) -> ProfileSheet:
    """The sheet of a cam with its follower in about so many positions."""
    phi = np.array(numbered_angles(cam, positions))
    choice: GeometricDrawing | ScaledDiagram
    if not isinstance(body.touch, Face):
        choice = _velocity_diagram(cam, body, phi)
    elif isinstance(body.guide, Translating):
        choice = _acceleration_diagram(cam, body, phi)
    else:
        choice = _bend_diagram(body, phi)
    return ProfileSheet(
        Sentence("Synthesis of the cam mechanism"),
        tuple(_motion_diagrams(cam, phi)),
        choice,
        _profile(cam, body, phi),
        tuple(_facts(cam, body)),
        cam.display,
    )


def driving_cam_sheet(drive: Drive, sheet: ProfileSheet, display: Display) -> ProfileSheet:
    """The sheet of a cam as it stands in the linkage that it drives, in the units of the linkage.

    An oscillating follower lifts clockwise on the sheet of its cam alone. Where the lift turns the link of the linkage
    counter-clockwise, the cam is the mirror image and turns the other way.
    """
    facts = ((Sentence("drive"), Name(drive.id)), *sheet.facts)
    sheet = replace(sheet, facts=facts, display=display)
    if drive.cam is None or not drive.cam.swings or drive.lowers:
        return sheet
    choice = mirror_image(sheet.choice) if isinstance(sheet.choice, GeometricDrawing) else sheet.choice
    return replace(sheet, choice=choice, profile=mirror_image(sheet.profile))


# Diagrams over the angle of the cam


def _motion_diagrams(cam: PlateCam, phi: Array) -> Iterator[ScaledDiagram]:
    """Lift and its two derivatives; where a derivative jumps its curve goes straight up or down."""
    motion = follower_motion(cam)
    parts = stretches(motion.law)
    meshes = [mesh_with(*part.ends, phi) for part in parts]
    rows = np.concatenate(
        [part.derivatives(mesh, 2) for part, mesh in zip(parts, meshes, strict=True)], axis=1
    )
    across = np.concatenate(meshes)
    names = motion_names(motion.swings)[0]
    for title, name, values in zip(TITLES[motion.swings], names, rows, strict=False):
        quantity = QUANTITIES[name]
        up = AxisLabel(symbol=Symbol(quantity.symbol), unit=quantity.unit)
        curve = ScaledCurve(NOTHING, across, values)
        yield ScaledDiagram(title, angle_axis(), up, (curve,), ticks_of(phi))


def _bend_diagram(body: FollowerCam, phi: Array) -> ScaledDiagram:
    """The radius of curvature under an oscillating face, which has to stay positive."""
    across = _around(body, phi)
    up = AxisLabel(symbol=Symbol("ρ"), unit="m")
    curve = ScaledCurve(NOTHING, across, body.contact(across).bend)
    title = Sentence("Radius of curvature of the profile")
    return ScaledDiagram(title, angle_axis(), up, (curve,), ticks_of(phi))


def _around(body: FollowerCam, phi: Array) -> Array:
    """Angles of a turn [rad], both sides of every edge and the numbered positions among them."""
    edges = body.edges
    parts = [mesh_with(*inside(start, stop), phi) for start, stop in pairwise(edges)]
    return np.concatenate(parts)


# The choice of the least radius


def _velocity_diagram(cam: PlateCam, body: FollowerCam, phi: Array) -> GeometricDrawing:
    """Turned velocity coefficients laid off from the roller's centre, the centre of the cam, and bounds of it."""
    around = _around(body, phi)
    starts, ends = centres_in_frame(body, phi), velocity_ends(body, phi)
    path = centres_in_frame(body, np.linspace(0.0, math.tau, PLACES))
    bounds = list(_bound_lines(cam, body, phi))
    lines = [
        GeometryLine(velocity_ends(body, around), LineLook.MAIN),
        *(GeometryLine(np.stack(pair)) for pair in zip(starts, ends, strict=True) if math.dist(*pair) > 0.0),
        *_guidance_lines(body, path, starts),
        *(GeometryLine(line) for line, _bound in bounds),
        GeometryLine(np.array([CENTRE, tuple(starts[0])]), head=True),
    ]
    radius: Text = Symbol("r", "0", slanted=True)
    if body.touch.roller:
        radius = Joined((radius, Symbol("r")), " + ")
    names = [
        *numbered_names(ends, np.hypot(*(ends - starts).T) > 0.0),
        GeometryName(CENTRE, Symbol("O")),
        GeometryName(point_of(0.5 * starts[0]), radius),
        *_bound_names(bounds),
    ]
    hinges = [CENTRE]
    if isinstance(body.guide, Oscillating):
        hinges.append((body.guide.distance, 0.0))
        names.append(GeometryName(hinges[1], Symbol("A")))
    elif body.guide.offset:
        names.append(GeometryName((0.5 * body.guide.offset, 0.0), Symbol("e")))
    title = Sentence("Choice of the least radius by the pressure angle")
    angles = tuple(_pressure_angles(body))
    lines += [GeometryLine(np.array([CENTRE, one.apex]), LineLook.DASHED) for one in angles]
    return GeometricDrawing(title, tuple(lines), (), tuple(names), angles, GeometryFrame(tuple(hinges)))


def _guidance_lines(body: FollowerCam, path: Array, starts: Array) -> Iterator[GeometryLine]:
    """The way of the roller's centre, and what leads it there."""
    guide = body.guide
    if isinstance(guide, Oscillating):
        yield GeometryLine(path)
        pivot = np.array([guide.distance, 0.0])
        for start in starts:
            yield GeometryLine(np.stack([pivot, start]))
        return
    low, high = np.array([guide.offset, 0.0]), np.array([guide.offset, float(path[:, 1].max())])
    yield GeometryLine(np.stack([low, high + np.array([0.0, BEYOND * body.base_radius])]), LineLook.CHAIN)
    if guide.offset:
        yield GeometryLine(np.array([CENTRE, tuple(low)]))


def _bound_lines(cam: PlateCam, body: FollowerCam, phi: Array) -> Iterator[tuple[Array, float]]:
    """Lines at the admissible pressure angles [rad]: the centre of the cam lies on their far side."""
    kept = admissible_of(cam)
    if cam.bounds.pressure_angle is None and cam.bounds.return_pressure_angle is None:
        return
    bounds = ((1.0, kept.pressure_angle), (-1.0, kept.return_angle))
    for way, bound in bounds:
        if bound >= math.pi / 2:
            continue
        for at in _bounding_angles(cam, body, phi, way, bound):
            end = velocity_ends(body, np.array([at]))[0]
            back = -directions_in_frame(body, np.array([at]))[0]
            turn = body.sense * way * bound
            ray = np.array(
                [
                    back[0] * math.cos(turn) - back[1] * math.sin(turn),
                    back[0] * math.sin(turn) + back[1] * math.cos(turn),
                ]
            )
            far = max(0.0, float(-end @ ray)) + RAY * body.base_radius
            yield np.stack([end, end + far * ray]), bound


def _bound_names(bounds: Sequence[tuple[Array, float]]) -> Iterator[GeometryName]:
    """Each admissible angle once, at the end of its first line."""
    for bound in dict.fromkeys(bound for _line, bound in bounds):
        end = next(line[1] for line, one in bounds if one == bound)
        yield GeometryName(point_of(end), Joined((Symbol("[α]"), in_degrees(bound)), " = "))


def _bounding_angles(
    cam: PlateCam, body: FollowerCam, phi: Array, way: float, bound: float
) -> Sequence[float]:
    """Angles [rad] whose line bounds the centre: of a translating follower where it touches, else at each position."""
    motion = follower_motion(cam)
    slope = way * motion.lift(phi, 1)[1]
    if isinstance(body.guide, Translating):
        tangent = math.tan(bound)
        touching = extremes_of(
            motion.law,
            2,
            lambda rows: (way * rows[1] - tangent * rows[0], way * rows[2] - tangent * rows[1]),
        )
        return [touching.at_greatest % math.tau]
    return [float(at) for at in phi[slope > 1e-9 * np.abs(slope).max()]]


def _pressure_angles(body: FollowerCam) -> Iterator[GeometryAngle]:
    """The greatest pressure angles of the rise and of the return, at the ends of the velocity coefficients."""
    for at, size in _steepest(body):
        end = velocity_ends(body, np.array([at]))[0]
        back = -directions_in_frame(body, np.array([at]))[0]
        yield angle_between(end, back, -end, 0.8 * ARC * body.base_radius, greatest_angle_text(size))


def _steepest(body: FollowerCam) -> Iterator[tuple[float, float]]:
    """Where the pressure angle is greatest, rising and falling, and its size [rad]."""
    phi = np.concatenate([nodes_of(body.edges), body.turns("pressure")])
    slope, size = body.motion.lift(phi, 1)[1], np.abs(body.contact(phi).pressure_angle)
    still = 1e-9 * float(np.abs(slope).max())
    for way in (slope > still, slope < -still):
        if way.any() and float(size[way].max()) > 1e-9:
            worst = int(np.argmax(np.where(way, size, -1.0)))
            yield float(phi[worst]), float(size[worst])


def _acceleration_diagram(cam: PlateCam, body: FollowerCam, phi: Array) -> GeometricDrawing:
    """Lift over the acceleration coefficient: a tangent at 45 degrees cuts the least s + s″ off the axis."""
    motion = follower_motion(cam)
    parts = stretches(motion.law)
    rows = np.concatenate([part.derivatives(mesh_with(*part.ends, phi), 2) for part in parts], axis=1)
    sums = extremes_of(motion.law, 3, lambda rows: (rows[0] + rows[2], rows[1] + rows[3]))
    least, at = sums.least, sums.at_least
    lift, _slope, second = (
        row
        for row in min(
            (one.derivatives(np.array([at]), 2)[:, 0] for one in parts if one.ends[0] <= at <= one.ends[1]),
            key=lambda row: row[0] + row[2],
        )
    )
    radius = body.base_radius
    beyond = BEYOND * radius
    left, right = float(rows[2].min()), float(rows[2].max())
    touching = np.array([second, lift])
    cut, centre = np.array([0.0, least]), np.array([0.0, -radius])
    # the tangent goes on beyond both of its ends
    along = np.array([1.0, -1.0]) / math.sqrt(2.0)
    tangent = np.stack([touching - beyond * along, cut + beyond * along])
    aside = np.array([right + beyond, 0.0])
    rest = float(body.least_bend[0])
    lines = (
        GeometryLine(rows[[2, 0]].T, LineLook.MAIN),
        GeometryLine(np.array([[left - beyond, 0.0], [right + 2.0 * beyond, 0.0]]), head=True),
        GeometryLine(np.array([[0.0, -radius], [0.0, float(rows[0].max()) + 2.0 * beyond]]), head=True),
        GeometryLine(tangent),
        GeometryLine(np.array([[-beyond, -radius], [right + 1.5 * beyond, -radius]])),
        GeometryLine(np.stack([aside, aside + centre]), head=True),
        GeometryLine(np.stack([cut, cut + 0.5 * aside])),
        GeometryLine(np.stack([cut + 0.4 * aside, centre + 0.4 * aside]), head=True),
    )
    places = motion.lift(phi, 2)[[2, 0]].T
    names = (
        *numbered_names(places, np.hypot(*places.T) > 0.0),
        GeometryName(point_of(centre), Symbol("O")),
        GeometryName(point_of(aside + 0.5 * centre), Symbol("r", "0", slanted=True)),
        GeometryName(
            point_of(0.5 * (cut + centre) + 0.4 * aside),
            Joined((Symbol("ρ", "min"), Number(rest, "m", ".5g")), " = "),
        ),
        GeometryName((right + 2.0 * beyond, 0.0), Joined((Symbol("s″"), Unit("m/rad^2")))),
        GeometryName((0.0, float(rows[0].max()) + 2.0 * beyond), Joined((Symbol("s"), Unit("m")))),
    )
    angle = angle_between(
        cut, touching - cut, np.array([0.0, 1.0]), 0.7 * ARC * radius, Number(45.0, "deg", unit_fixed=True)
    )
    title = Sentence("Choice of the least radius by the curvature of the profile")
    return GeometricDrawing(title, lines, (), names, (angle,), GeometryFrame((point_of(centre),)))


# The profile by inversion


def _profile(cam: PlateCam, body: FollowerCam, phi: Array) -> GeometricDrawing:
    """The cam at rest, and its follower in its positions about it."""
    contact = body.contact(_around(body, phi))
    profile = np.concatenate([contact.place, contact.place[:1]])
    rolls = 0.0 < body.touch.roller < math.inf
    circles = [GeometryCircle(CENTRE, body.base_radius)]
    lines = [GeometryLine(profile, LineLook.MAIN)]
    places = body.contact(phi)
    if rolls:
        lines.append(GeometryLine(np.concatenate([contact.centre, contact.centre[:1]]), LineLook.CHAIN))
        circles.append(GeometryCircle(CENTRE, body.base_radius + body.touch.roller))
        circles += [GeometryCircle(point_of(one), body.touch.roller) for one in places.centre[1:]]
        circles.append(GeometryCircle(point_of(places.centre[0]), body.touch.roller, LineLook.MAIN))
    frame, more, further, tips = _inverted_motion(body, phi)
    arm = np.array([math.cos(RADIUS_AT), math.sin(RADIUS_AT)]) * body.base_radius
    lines += [*more, GeometryLine(np.array([CENTRE, tuple(arm)]), head=True)]
    names = [
        *numbered_names(tips),
        GeometryName(CENTRE, Symbol("O")),
        GeometryName(point_of(0.6 * arm), Symbol("r", "0", slanted=True)),
    ]
    if isinstance(body.guide, Oscillating):
        names.append(GeometryName((body.guide.distance, 0.0), Symbol("A")))
    angles = list[GeometryAngle]()
    for at, size in sorted(_steepest(body), key=lambda one: -one[1])[:1]:
        found, drawn = _angle_of_pressure(body, at, greatest_angle_text(size))
        angles.append(found)
        lines += drawn
    return GeometricDrawing(
        Sentence("Profile of the cam by the method of inversion"),
        tuple(lines),
        (*circles, *further),
        tuple(names),
        tuple(angles),
        frame,
    )


def _inverted_motion(
    body: FollowerCam, phi: Array
) -> tuple[GeometryFrame, list[GeometryLine], list[GeometryCircle], Array]:
    """What belongs to the frame, lines and circles of the follower's positions, and where their numbers stand."""
    guide, flat = body.guide, isinstance(body.touch, Face)
    if isinstance(guide, Oscillating):
        return _inverted_arms(body, guide, phi)
    beyond = BEYOND * body.base_radius
    roller = 0.0 if flat else body.touch.roller
    centres = centres_in_frame(body, phi)
    tips = centres + np.array([0.0, roller + (2.0 * beyond if flat else beyond)])
    feet = np.stack([np.full(len(phi), guide.offset), np.zeros(len(phi))], axis=1)
    lines = [
        GeometryLine(np.stack(pair))
        for pair in zip(in_cam(body, feet, phi), in_cam(body, tips, phi), strict=True)
    ]
    if flat:
        for number, (at, centre) in enumerate(zip(phi, centres, strict=True)):
            face = centre + np.array([[body.face.least - beyond, 0.0], [body.face.greatest + beyond, 0.0]])
            ends = in_cam(body, face, np.array([at, at]))
            lines.append(GeometryLine(ends, LineLook.THIN if number else LineLook.MAIN))
    circles = [GeometryCircle(CENTRE, abs(guide.offset))] if guide.offset else []
    highest = float(np.max(body.motion.lift(np.linspace(0.0, math.tau, PLACES))[0]))
    low = centres[0] + np.array([0.0, highest + roller + WALLS * body.base_radius])
    high = low + np.array([0.0, ABOVE * body.base_radius])
    stem = np.stack([centres[0], high + np.array([0.0, STEM * body.base_radius])])
    lines.append(GeometryLine(stem, LineLook.MAIN))
    frame = GeometryFrame((CENTRE,), (point_of(low), point_of(high)), body.sense)
    return frame, lines, circles, in_cam(body, tips, phi)


def _inverted_arms(
    body: FollowerCam, guide: Oscillating, phi: Array
) -> tuple[GeometryFrame, list[GeometryLine], list[GeometryCircle], Array]:
    """Pivots on a circle about the cam, each with its arm or face."""
    pivot = np.array([guide.distance, 0.0])
    pivots = in_cam(body, np.tile(pivot, (len(phi), 1)), phi)
    lines = []
    for number, (at, foot) in enumerate(zip(phi, pivots, strict=True)):
        look = LineLook.THIN if number else LineLook.MAIN
        if isinstance(body.touch, Face):
            psi = guide.start + float(body.motion.lift(np.array([at]))[0, 0])
            normal = np.array([math.sin(psi), math.cos(psi)])
            along = np.array([-normal[1], normal[0]])
            begin = pivot - guide.face_offset * normal
            face = np.stack([pivot, begin, begin + (body.face.greatest + BEYOND * body.base_radius) * along])
            lines.append(GeometryLine(in_cam(body, face, np.full(3, at)), look))
        else:
            centre = in_cam(body, centres_in_frame(body, np.array([at])), np.array([at]))[0]
            lines.append(GeometryLine(np.stack([foot, centre]), look))
    circles = [GeometryCircle(CENTRE, guide.distance)]
    frame = GeometryFrame((CENTRE, (guide.distance, 0.0)), None, body.sense)
    return frame, lines, circles, pivots


def _angle_of_pressure(body: FollowerCam, at: float, name: Text) -> tuple[GeometryAngle, list[GeometryLine]]:
    """The pressure angle in the position where it is greatest, between the normal and the follower's motion."""
    place = np.array([at])
    contact = body.contact(place)
    normal = contact.normal[0]
    if isinstance(body.touch, Face) and isinstance(body.guide, Oscillating):
        pivot = in_cam(body, np.array([[body.guide.distance, 0.0]]), place)[0]
        reach = contact.place[0] - pivot
        way = np.array([reach[1], -reach[0]]) / float(np.hypot(*reach))
        way = way if way @ normal > 0.0 else -way
    else:
        way = in_cam(body, directions_in_frame(body, place), place)[0]
    roller = body.touch.roller if body.touch.roller < math.inf else 0.0
    far = roller + 1.4 * ARC * body.base_radius
    start = contact.centre[0]
    lines = [
        GeometryLine(np.stack([contact.place[0], start + far * normal])),
        GeometryLine(np.stack([start, start + far * way]), head=True),
    ]
    return angle_between(start, normal, way, 0.8 * far, name), lines


# Numbers beside the drawings


def _facts(cam: PlateCam, body: FollowerCam) -> Iterator[tuple[Text, Text]]:
    """What the follower is, its segments, sizes of the cam, what is admissible and what is reached."""
    follower, bounds = cam.follower, cam.bounds
    kind = Sentence("{kind}, with {contact}", kind=KINDS[follower.kind], contact=CONTACTS[follower.contact])
    yield Sentence("follower"), kind
    before = 0.0
    for segment in cam.segments[:MOST_FACTS]:
        turned = Number(math.degrees(segment.angle), "deg", ".5g", unit_fixed=True)
        if segment.to is None:
            yield curve_name(segment.curve), turned
        else:
            way = Sentence("return, {curve}", curve=curve_name(segment.curve))
            if segment.to >= before:
                way = Sentence("rise, {curve}", curve=curve_name(segment.curve))
            lift = Number(segment.to, "rad" if cam.swings else "m", ".5g")
            yield way, Sentence("{angle}, to {lift}", angle=turned, lift=lift)
            before = segment.to
    yield from length_facts(
        (Sentence("base radius"), body.base_radius),
        (Sentence("radius of the roller"), follower.roller_radius),
        (Sentence("offset of the follower's axis"), follower.offset or None),
        (Sentence("length of the arm"), follower.arm),
        (Sentence("pivot from the cam's centre"), follower.pivot_distance),
        (Sentence("offset of the face from the pivot"), follower.face_offset or None),
    )
    if bounds.pressure_angle is not None:
        yield Sentence("admissible pressure angle"), in_degrees(bounds.pressure_angle)
    if bounds.return_pressure_angle is not None:
        yield Sentence("the same on the return"), in_degrees(bounds.return_pressure_angle)
    if ClosedForms(body).has_pressure_angle:
        steepest = max(abs(body.pressure.least), abs(body.pressure.greatest))
        yield Sentence("greatest pressure angle"), in_degrees(steepest)
    bend = body.least_bend[0]
    if math.isfinite(bend):
        yield from length_facts((Sentence("least radius of curvature of the profile"), bend))
