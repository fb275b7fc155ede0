"""The sheet of a cam by a curvature law: diagrams of its roller's distance, its pressure angle, its profile."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.nodes import inside
from centrode.cams.profiles import cam_body
from centrode.cams.roller_path import Frames, frames
from centrode.quantities import QUANTITIES
from centrode.sheets.drawing_sheets import (
    GeometricDrawing,
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
from centrode.sheets.texts import NOTHING, Joined, Sentence, Symbol, Text, Unit
from centrode.views.geometric_drawings import (
    CENTRE,
    Array,
    angle_axis,
    angle_between,
    greatest_angle_text,
    in_degrees,
    length_facts,
    mesh_with,
    numbered_names,
    point_of,
)

if TYPE_CHECKING:
    from centrode.cams.return_arc import ClosedPath
    from centrode.model.cam import Cam

BEYOND, ARC = 0.12, 0.35
"""How far rays go on beyond what they are drawn for, and radius of an angle's arc, over the path's least radius."""
TITLES = (
    Sentence("Distance of the roller's centre from the cam's centre"),
    Sentence("Velocity coefficient of the roller along the carrier"),
    Sentence("Acceleration coefficient of the roller along the carrier"),
)


def path_sheet(cam: Cam, closed: ClosedPath, positions: int) -> ProfileSheet:
    """The sheet of a cam by a curvature law, its roller in so many evenly spaced positions."""
    phi = np.linspace(closed.start, closed.stop, positions, endpoint=not closed.whole)
    around = np.concatenate([mesh_with(*inside(*ends), phi) for ends in pairwise(closed.edges)])
    around = np.append(around, closed.stop)
    ticks = (*phi.tolist(), *((closed.stop,) if closed.whole else ()))
    rows = closed.radius(around, 2)
    names = "path_radius", "path_radius_slope", "path_radius_second"
    diagrams = []
    for title, name, values in zip(TITLES, names, rows, strict=True):
        up = AxisLabel(symbol=Symbol(QUANTITIES[name].symbol), unit=QUANTITIES[name].unit)
        diagrams.append(
            ScaledDiagram(title, angle_axis(), up, (ScaledCurve(NOTHING, around, values),), ticks)
        )
    found = frames(closed, around)
    return ProfileSheet(
        Sentence("Synthesis of the cam by a curvature law"),
        tuple(diagrams),
        _velocity_diagram(rows, closed.radius(phi, 1), found),
        _profile(cam, closed, found, phi),
        tuple(_facts(cam, found)),
        cam.display,
    )


def _worst(found: Frames) -> int:
    """The place of the greatest pressure angle."""
    return int(np.argmax(np.abs(found.pressure_angle)))


def _velocity_diagram(rows: Array, numbered: Array, found: Frames) -> GeometricDrawing:
    """The distance over its velocity coefficient: a ray from the centre leaves the axis by the pressure angle."""
    curve, places = rows[[1, 0]].T, numbered[[1, 0]].T
    worst, least = _worst(found), float(rows[0].min())
    top = np.array([0.0, float(rows[0].max()) + BEYOND * least])
    side = np.array([BEYOND * least, 0.0])
    left = np.array([min(0.0, float(rows[1].min())), 0.0]) - side
    right = np.array([max(0.0, float(rows[1].max())), 0.0]) + 2.0 * side
    lines = (
        GeometryLine(curve, LineLook.MAIN),
        GeometryLine(np.stack([left, right]), head=True),
        GeometryLine(np.array([CENTRE, point_of(top)]), head=True),
        GeometryLine(np.array([CENTRE, point_of(curve[worst])])),
    )
    names = (
        *numbered_names(places, np.full(len(places), True)),
        GeometryName(CENTRE, Symbol("O")),
        GeometryName(point_of(right), Joined((Symbol("ρ′"), Unit("m/rad")))),
        GeometryName(point_of(top), Joined((Symbol("ρ"), Unit("m")))),
    )
    text = greatest_angle_text(abs(float(found.pressure_angle[worst])), "γ")
    angle = angle_between(np.zeros(2), top, curve[worst], 2.0 * ARC * least, text)
    title = Sentence("The pressure angle by distance and velocity")
    return GeometricDrawing(title, lines, (), names, (angle,), GeometryFrame((CENTRE,)))


def _profile(cam: Cam, closed: ClosedPath, found: Frames, phi: Array) -> GeometricDrawing:
    """The path with the profile and rollers, where there is a roller, and the carrier in its positions."""
    lines, circles, radius = list[GeometryLine](), list[GeometryCircle](), 0.0
    places = frames(closed, phi).place
    if cam.roller is not None:
        radius = cam.roller.radius
        lines.append(GeometryLine(cam_body(cam).profile(found.phi).place, LineLook.MAIN))
        circles += [GeometryCircle(point_of(one), radius) for one in places[1:]]
        circles.append(GeometryCircle(point_of(places[0]), radius, LineLook.MAIN))
    lines.append(GeometryLine(found.place, LineLook.CHAIN if radius else LineLook.MAIN))
    beyond = radius + BEYOND * float(found.radius.min())
    tips = places + beyond * places / np.hypot(*places.T)[:, None]
    for number, tip in enumerate(tips):
        look = LineLook.THIN if number else LineLook.MAIN
        lines.append(GeometryLine(np.array([CENTRE, point_of(tip)]), look))
    worst = _worst(found)
    at, normal = found.place[worst], found.normal[worst]
    way = at / float(np.hypot(*at))
    far = radius + 2.0 * ARC * float(found.radius.min())
    foot = at - radius * normal
    lines += [GeometryLine(np.stack([foot, at + far * normal])), GeometryLine(np.stack([at, at + far * way]))]
    text = greatest_angle_text(abs(float(found.pressure_angle[worst])), "γ")
    names = (*numbered_names(tips), GeometryName(CENTRE, Symbol("O")))
    title = Sentence("Path of the roller's centre")
    if radius:
        title = Sentence("Path of the roller's centre and profile of the cam")
    return GeometricDrawing(
        title,
        tuple(lines),
        tuple(circles),
        names,
        (angle_between(at, normal, way, 0.85 * far, text),),
        GeometryFrame((CENTRE,)),
    )


def _facts(cam: Cam, found: Frames) -> Iterator[tuple[Text, Text]]:
    """Sizes of the path, of the roller, and what is reached."""
    radius = None if cam.roller is None else cam.roller.radius
    yield from length_facts(
        (Sentence("radius of the roller"), radius),
        (Sentence("least radius of the path"), float(found.radius.min())),
        (Sentence("greatest radius of the path"), float(found.radius.max())),
    )
    yield Sentence("greatest pressure angle"), in_degrees(float(np.abs(found.pressure_angle).max()))
    sharpest = float(found.curvature.max())
    if radius is not None and sharpest > 0.0:
        yield from length_facts(
            (Sentence("least radius of curvature of the profile"), 1.0 / sharpest - radius)
        )
    if cam.mover is not None:
        yield from length_facts((Sentence("post of the wheel"), cam.mover.post))
