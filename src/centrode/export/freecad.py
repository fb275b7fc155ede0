"""A planar linkage as a macro of FreeCAD: a sketch with constraints, and bars that move as it does."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from centrode.errors import NotComputedYet, Status
from centrode.kinematics.motion import initial_place, motion
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import FRAME, Mechanism
from centrode.version import __version__

if TYPE_CHECKING:
    import xarray

MILLIMETRES = 1000.0
POSITIONS = 121
"""Positions that the bars move through."""

STRAIGHT = 1e-9
"""Sine of the angle below which three points of a link lie on a line."""
Side: TypeAlias = tuple[str, str, str, int]
"""A link, two of its points, and the number of the side on whose line the second lies; -1 where it lies on none."""

MACRO = '''
import math

import FreeCAD
import Part
import Sketcher

V = FreeCAD.Vector
document = FreeCAD.newDocument("Linkage")

# The sketch: a line for each side of a link, hinges by coincidence, lengths as constraints, fixed points held.

sketch = document.addObject("Sketcher::SketchObject", "Scheme")
ends = {}  # point -> (line, end) that stands for it
lines = []
for link, first, second, base in SIDES:
    a, b = PLACES[first], PLACES[second]
    line = sketch.addGeometry(Part.LineSegment(V(a[0], a[1], 0), V(b[0], b[1], 0)), False)
    lines.append(line)
    for end, point in ((1, first), (2, second)):
        if point in ends:
            sketch.addConstraint(Sketcher.Constraint("Coincident", line, end, *ends[point]))
        else:
            ends[point] = (line, end)
for point in FIXED:
    if point in ends:
        x, y = PLACES[point]
        sketch.addConstraint(Sketcher.Constraint("DistanceX", -1, 1, *ends[point], x))
        sketch.addConstraint(Sketcher.Constraint("DistanceY", -1, 1, *ends[point], y))
for (link, first, second, base), line in zip(SIDES, lines):
    length = math.dist(PLACES[first], PLACES[second])
    sketch.addConstraint(Sketcher.Constraint("Distance", line, 1, line, 2, length))
    if base >= 0:  # a point on the line of the first side
        sketch.addConstraint(Sketcher.Constraint("PointOnObject", line, 2, lines[base]))
if sketch.solve() == -2:  # a link too many for the mobility, as the third crank of a parallelogram: its length follows
    sketch.autoRemoveRedundants(True)

# The bars: one body for each link, drawn where it stands initially.

bars = {}
for link, first, second, _base in SIDES:
    a, b = PLACES[first], PLACES[second]
    way = V(b[0] - a[0], b[1] - a[1], 0)
    bar = Part.makeCylinder(THICKNESS, way.Length, V(a[0], a[1], 0), way)
    bars.setdefault(link, []).append(bar)
bodies = {}
for link, shapes in bars.items():
    body = document.addObject("Part::Feature", "Bar")
    body.Label = link
    body.Shape = Part.makeCompound(shapes)
    bodies[link] = body


def show(position):
    """Put all bars where the motion has them; positions count from 0."""
    for link, moves in PLACEMENTS.items():
        x, y, angle = moves[position % len(moves)]
        bodies[link].Placement = FreeCAD.Placement(V(x, y, 0), FreeCAD.Rotation(V(0, 0, 1), math.degrees(angle)))


show(0)
document.recompute()


def play():
    """Move the bars on, ten times a second; play.timer.stop() ends it."""
    from PySide import QtCore

    play.position = 0

    def following():
        play.position += 1
        show(play.position)

    play.timer = QtCore.QTimer()
    play.timer.timeout.connect(following)
    play.timer.start(100)


if FreeCAD.GuiUp:
    import FreeCADGui

    FreeCADGui.ActiveDocument.ActiveView.viewTop()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    play()
'''


def freecad_macro(source: MechanismSource, positions: int = POSITIONS) -> str:
    """A macro that builds a planar linkage in FreeCAD, in millimetres.

    Parameters
    ----------
    source : Mechanism, file or name of an example
    positions : how many positions the bars move through

    Returns
    -------
    str
        Python for FreeCAD 0.20 or newer. The sketch has a line for every side of a link; hinges, lengths and fixed
        points are its constraints, guides and gears are not. Bars stand where the motion has them: `show(k)` puts
        them into a position, `play()` moves them.

    Raises
    ------
    NotComputedYet
        Spherical linkages, and mechanisms none of whose links has two points.

    Examples
    --------
    >>> from centrode.export.freecad import freecad_macro
    >>> "Sketcher.Constraint" in freecad_macro("crank-rocker")
    True
    """
    mechanism = mechanism_of(source)
    if mechanism.space == "sphere":
        what = _("macros of FreeCAD are made of planar linkages")
        raise NotComputedYet("space", what, _("choose a planar linkage"))
    first = motion(mechanism, at=[initial_place(mechanism)])
    moving = motion(mechanism, positions)
    places = _places(first)
    sides: list[Side] = []
    for link, described in mechanism.links.items():
        sides += _sides(link, list(described.coordinates), places, len(sides))
    if not sides:
        raise NotComputedYet("links", _("no link has two points that a bar could join"))
    size = max(math.dist(places[one], places[other]) for _link, one, other, _base in sides)
    data: dict[str, Any] = {
        "PLACES": places,
        "FIXED": list(mechanism.frame.points),
        "SIDES": sides,
        "THICKNESS": 0.02 * size,
        "PLACEMENTS": _placements(mechanism, first, moving, {side[0] for side in sides}),
    }
    title = "".join(c if c.isprintable() else " " for c in mechanism.title or "linkage")
    head = [f"# {title}", f"# A macro of FreeCAD, written by centrode {__version__}. Lengths in mm."]
    return "\n".join([*head, *(f"{name} = {_python(value)}" for name, value in data.items()), MACRO])


def _python(value: Any) -> str:
    """Plain data as Python reads them: JSON has the same numbers, texts, lists and tables."""
    return json.dumps(value, ensure_ascii=True, allow_nan=False)


def _places(first: xarray.Dataset) -> dict[str, tuple[float, float]]:
    """Places of all points in the initial position [mm]."""
    names = first["point"].values.tolist()
    return {
        name: (MILLIMETRES * float(x), MILLIMETRES * float(y))
        for name, (x, y) in zip(names, first["position"].values[0], strict=True)
    }


def _sides(
    link: str, points: Sequence[str], places: Mapping[str, tuple[float, float]], before: int
) -> list[Side]:
    """Sides that keep a link stiff: a fan of triangles over its first one, and points on that as such.

    `before` sides of other links stand in front.
    """
    apart = [point for point in points[1:] if math.dist(places[points[0]], places[point]) > 0.0]
    if not apart:
        return []
    base, second = points[0], apart[0]
    found: list[Side] = [(link, base, second, -1)]
    way = np.subtract(places[second], places[base])
    for point in apart[1:]:
        other = np.subtract(places[point], places[base])
        across = abs(float(way[0] * other[1] - way[1] * other[0]))
        if across <= STRAIGHT * float(np.hypot(*way) * np.hypot(*other)):
            found.append((link, base, point, before))
        else:
            found += [(link, base, point, -1), (link, second, point, -1)]
    return found


def _placements(
    mechanism: Mechanism, first: xarray.Dataset, moving: xarray.Dataset, links: set[str]
) -> dict[str, list[tuple[float, float, float]]]:
    """Of every bar its displacement [mm] and turn [rad] at the positions that are reached."""
    there = moving["status"].values == Status.OK
    found = {}
    for link in mechanism.links:
        if link not in links or link == FRAME:
            continue
        point = next(iter(mechanism.links[link].coordinates))
        start = first["position"].sel(point=point).values[0]
        places = moving["position"].sel(point=point).values[there]
        turn = moving["angle"].sel(link=link).values[there] - float(first["angle"].sel(link=link).values[0])
        # the body is turned about the origin, then moved
        back = np.stack(
            [
                np.cos(turn) * start[0] - np.sin(turn) * start[1],
                np.sin(turn) * start[0] + np.cos(turn) * start[1],
            ],
            axis=1,
        )
        moved = MILLIMETRES * (places - back)
        found[link] = [(float(x), float(y), float(angle)) for (x, y), angle in zip(moved, turn, strict=True)]
    return found
