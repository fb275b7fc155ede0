"""The sheet of a pair of gears: teeth in mesh and their generation at standard scales, sliding, dimensions."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.sheets.drawing_sheets import (
    GeometricDrawing,
    GeometryFrame,
    GeometryLine,
    GeometryName,
    LineLook,
    ProfileSheet,
    ScaledCurve,
    ScaledDiagram,
)
from centrode.sheets.plots import AxisLabel
from centrode.sheets.texts import NOTHING, Joined, Number, Sentence, Symbol, Text
from centrode.views.gear_pair import (
    MOST_PRESSURE,
    MOST_SLIDING,
    generation_parts,
    mesh_parts,
    rack_line,
    teeth_in_mesh,
)
from centrode.views.geometric_drawings import in_degrees

if TYPE_CHECKING:
    from centrode.gears.involutes import Array
    from centrode.gears.results import GearPairResults


def gear_sheet(results: GearPairResults) -> ProfileSheet:
    """The sheet of a pair of gears."""
    return ProfileSheet(
        Sentence("Gear pair"),
        tuple(_diagrams(results)),
        _generation(results),
        _mesh(results),
        tuple(_facts(results)),
        results.gear_pair.display,
    )


def _diagrams(results: GearPairResults) -> Iterator[ScaledDiagram]:
    """Sliding and pressure over the way of the contact along the line of action, from its beginning."""
    action = results.line_of_action
    along = action.places - action.places[0]
    across = AxisLabel(symbol=Symbol("s"), unit="m")
    titles = Sentence("Specific sliding of the pinion"), Sentence("Specific sliding of the wheel")
    for number, title in enumerate(titles):
        curve, note = _within(along, action.sliding[:, number], MOST_SLIDING)
        axis = AxisLabel(symbol=Symbol("ϑ", str(number + 1)))
        yield ScaledDiagram(_title_up_to(title, note), across, axis, (curve,))
    curve, note = _within(along, action.pressure, MOST_PRESSURE)
    title = _title_up_to(Sentence("Pressure coefficient"), note)
    yield ScaledDiagram(title, across, AxisLabel(symbol=Symbol("ϑ", "p")), (curve,))


def _within(along: Array, values: Array, most: float) -> tuple[ScaledCurve, float | None]:
    """A curve as far as it is drawn, and up to which size it is where it goes beyond."""
    kept = np.abs(values) <= most
    if kept.all():
        return ScaledCurve(NOTHING, along, values), None
    return ScaledCurve(NOTHING, along[kept], values[kept]), most


def _title_up_to(title: Sentence, most: float | None) -> Sentence:
    """The title, with the size up to which a curve is drawn."""
    if most is None:
        return title
    return Sentence("{title}, drawn up to {most} in size", title=title, most=Number(most))


def _generation(results: GearPairResults) -> GeometricDrawing:
    teeth, positions = generation_parts(results)
    lines = [GeometryLine(piece.places, LineLook.MAIN) for piece in teeth]
    lines += [GeometryLine(outline) for outline in positions]
    return GeometricDrawing(Sentence("Generation by the rack"), tuple(lines))


def _mesh(results: GearPairResults) -> GeometricDrawing:
    """Teeth in mesh, working pitch circles and line of action, with the poles and ends of the action."""
    pair = results.geometry
    pieces, circles, action = mesh_parts(results)
    lines = [GeometryLine(piece.places, LineLook.MAIN) for piece in pieces]
    lines += [GeometryLine(circle, LineLook.CHAIN) for circle in circles]
    lines += [GeometryLine(one.arc(one.wheel.base)) for one in teeth_in_mesh(results)]
    if pair.kind == "rack":
        lines.append(GeometryLine(rack_line(pair), LineLook.MAIN))
    lines.append(GeometryLine(action))
    pitch = (0.0, pair.wheels[0].working_pitch / 2)
    names = [
        GeometryName((float(action[0][0]), float(action[0][1])), Symbol("A"), dotted=True),
        GeometryName((float(action[1][0]), float(action[1][1])), Symbol("B"), dotted=True),
        GeometryName(pitch, Symbol("P"), dotted=True),
    ]
    return GeometricDrawing(
        Sentence("Teeth in mesh"), tuple(lines), (), tuple(names), (), GeometryFrame(((0.0, 0.0),))
    )


def _facts(results: GearPairResults) -> Iterator[tuple[Text, Text]]:
    """What is given and what follows."""
    pair = results.geometry
    first, second = pair.wheels
    teeth = [Number(first.teeth), *([] if second.is_rack else [Number(second.teeth)])]
    yield Sentence("module"), Number(pair.module, "m")
    yield Sentence("numbers of teeth"), Joined(tuple(teeth), "; ")
    yield (
        Sentence("shift coefficients"),
        Joined(tuple(Number(shift, digits=".4g") for shift in pair.shifts), "; "),
    )
    if pair.helix_angle:
        yield Sentence("helix angle"), in_degrees(pair.helix_angle)
    yield (
        Sentence("working pressure angle"),
        Number(math.degrees(pair.working_angle), "deg", ".6g", unit_fixed=True),
    )
    if not second.is_rack:
        yield Sentence("centre distance"), Number(pair.centre_distance, "m", ".6g")
    yield Sentence("contact ratio"), Number(pair.contact_ratio, digits=".4g")
    wheels = [wheel for wheel in pair.wheels if not wheel.is_rack]
    for head, name in (
        (Sentence("pitch diameter"), "pitch"),
        (Sentence("base diameter"), "base"),
        (Sentence("tip diameter"), "tip"),
        (Sentence("root diameter"), "root"),
    ):
        yield head, Joined(tuple(Number(getattr(wheel, name), "m", ".6g") for wheel in wheels), "; ")
