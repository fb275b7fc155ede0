"""Numbers of a description that a field of the workbench shows and changes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from centrode.app.quantity_texts import field_text
from centrode.app.sketch import SketchParts, display_units

SIGNS = {False: ("x", "y"), True: ("λ", "β")}
"""Signs of coordinates in the plane, and of longitude and latitude on the sphere."""


def dimension_rows(sketch: SketchParts) -> list[dict[str, Any]]:
    """Each number with its path, its name, its value in the unit of the display, and whether it is locked."""
    return list(_rows(sketch))


def _rows(sketch: SketchParts) -> Iterator[dict[str, Any]]:
    units = display_units(sketch.tables)
    for owner, path, name, value, kind in _numbers(sketch):
        shown = value * units[kind]["factor"]
        yield {
            "of": owner,
            "path": path,
            "name": name,
            "value": shown,
            "unit": units[kind]["unit"],
            "shown": field_text(shown),
            "locked": path in sketch.marks["locked"],
        }


def _numbers(sketch: SketchParts) -> Iterator[tuple[str, str, str, float, str]]:
    for name in sketch.links:
        length = sketch.length(name)
        if length is not None:
            yield name, f"links.{name}.length", "l", length, "angle" if sketch.on_sphere else "length"
        if name in sketch.poses and sketch.drives_of(name):
            angle = math.remainder(sketch.poses[name][1], math.tau)
            start = sketch.drives[sketch.drives_of(name)[0]].get("start")
            if start is not None or sketch.is_short_form:
                yield name, f"drives.{name}.start", "φ", angle, "angle"
    for point in sketch.points:
        if point in sketch.places and (sketch.is_short_form or point in sketch.frame_points):
            room = "points" if point not in sketch.frame_points or sketch.is_short_form else "frame.points"
            if sketch.on_sphere and not sketch.is_short_form:
                continue
            kind = "angle" if sketch.on_sphere else "length"
            for axis, sign, x in zip(
                sketch.axes, SIGNS[sketch.on_sphere], sketch.numbers_of(sketch.places[point]), strict=True
            ):
                yield point, f"{room}.{point}.{axis}", sign, x, kind
