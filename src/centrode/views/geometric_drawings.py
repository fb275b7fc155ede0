"""What views of cams on sheets share: curves over the angle, numbers of positions, angles and lists of sizes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.drawing_sheets import (
    GeometricDrawing,
    GeometryAngle,
    GeometryFrame,
    GeometryName,
)
from centrode.sheets.plots import AxisLabel
from centrode.sheets.texts import Joined, Number, Symbol, Text

Array = NDArray[np.float64]

PLACES = 1441
"""Places of a curve over a turn, beside the numbered ones."""
CENTRE = (0.0, 0.0)


def ticks_of(phi: Array) -> tuple[float, ...]:
    """Numbered positions on the axis of the angle [rad]; the turn's end is the first again."""
    return (*phi.tolist(), math.tau)


def mesh_with(start: float, stop: float, phi: Array) -> Array:
    """Places of a stretch, its ends and the numbered positions in it included."""
    count = 2 + math.ceil(PLACES * (stop - start) / math.tau)
    return np.union1d(np.linspace(start, stop, count), phi[(phi >= start) & (phi <= stop)])


def angle_axis() -> AxisLabel:
    """The axis of the angle of a cam, or of a carrier."""
    return AxisLabel(symbol=Symbol("φ"), unit="rad")


def greatest_angle_text(value: float, letter: str = "α") -> Text:
    """The greatest pressure angle [rad], in degrees behind its letter."""
    degrees = Number(math.degrees(value), "deg", ".4g", unit_fixed=True)
    return Joined((Symbol(letter, "max"), degrees), " = ")


def angle_between(apex: Array, first: Array, last: Array, radius: float, text: Text) -> GeometryAngle:
    """The angle between two directions, the smaller way round."""
    begin = math.atan2(first[1], first[0])
    turn = math.remainder(math.atan2(last[1], last[0]) - begin, math.tau)
    return GeometryAngle(point_of(apex), begin, begin + turn, radius, text)


def numbered_names(places: Array, shown: Array | None = None) -> Iterator[GeometryName]:
    """Numbers of positions beside their places; where not all are shown, these have dots."""
    for number, place in enumerate(places):
        if shown is None or shown[number]:
            yield GeometryName(point_of(place), Number(number, digits="d"), dotted=shown is not None)


def mirror_image(drawing: GeometricDrawing) -> GeometricDrawing:
    """The mirror image of a drawing: left and right exchanged, its texts as they are."""
    axes = np.array([-1.0, 1.0])
    return replace(
        drawing,
        lines=tuple(replace(line, places=line.places * axes) for line in drawing.lines),
        circles=tuple(replace(circle, centre=_exchanged_place(circle.centre)) for circle in drawing.circles),
        names=tuple(replace(name, place=_exchanged_place(name.place)) for name in drawing.names),
        angles=tuple(
            replace(
                angle,
                apex=_exchanged_place(angle.apex),
                first=math.pi - angle.first,
                last=math.pi - angle.last,
            )
            for angle in drawing.angles
        ),
        frame=None if drawing.frame is None else _mirrored_frame(drawing.frame),
    )


def _mirrored_frame(frame: GeometryFrame) -> GeometryFrame:
    """The same of hinges, a guide and the sense in which the body turns."""
    guide = (
        None if frame.guide is None else (_exchanged_place(frame.guide[0]), _exchanged_place(frame.guide[1]))
    )
    return GeometryFrame(tuple(map(_exchanged_place, frame.hinges)), guide, -frame.sense)


def _exchanged_place(place: tuple[float, float]) -> tuple[float, float]:
    return -place[0], place[1]


def point_of(place: Array) -> tuple[float, float]:
    """A place (2) as a pair."""
    x, y = place.tolist()
    return x, y


def length_facts(*lengths: tuple[Text, float | None]) -> Iterator[tuple[Text, Text]]:
    """Names and lengths [m]; those that are not there are left out."""
    for label, value in lengths:
        if value is not None:
            yield label, Number(value, "m", ".5g")


def in_degrees(value: float) -> Number:
    """An angle [rad] in degrees, whatever the display."""
    return Number(math.degrees(value), "deg", ".4g", unit_fixed=True)
