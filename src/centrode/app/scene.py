"""The picture of a description as data: points, links, guides, drives, loads, and what each may be made into."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from centrode.app.edit_drags import edit_refusal
from centrode.app.move_drags import move_refusal
from centrode.app.quantity_texts import field_text
from centrode.app.sketch import (
    SketchParts,
    coordinates,
    direction_angle,
    display_units,
    drive_name,
    guide_circle,
    guide_line,
    guide_name,
    list_of_tables,
    load_name,
    number,
    on_unit_sphere,
    shown_place,
)
from centrode.app.state_rows import rows_of
from centrode.locale import _
from centrode.model.description import coordinate_of_drive
from centrode.model.gears import Gear
from centrode.model.reading import FRAME

SIGNS = {False: ("x", "y"), True: ("λ", "β")}
"""Signs of coordinates in the plane, and of longitude and latitude on the sphere."""
COAXIAL = 1e-9
"""Shafts nearer than this share of the extent are one: no pitch circles tell their ratio."""
MARGIN = 0.1
"""Room around a drawing, as a part of its extent."""


def scene_of(sketch: SketchParts) -> dict[str, Any]:
    """The scene of a mechanism, whether it can move or not."""
    return {
        "title": _text(sketch.tables.get("title")),
        "kind": "sphere" if sketch.on_sphere else "plane",
        "draws": sketch.draws_points or not sketch.on_sphere,
        "display": display_units(sketch.tables),
        "size": _box(sketch),
        "points": [_point(sketch, name) for name in sketch.points],
        "links": [_link(sketch, k, name) for k, name in enumerate(sketch.links)],
        "guides": list(_guides(sketch)),
        "drives": list(_drives(sketch)),
        "wheels": list(_wheels(sketch)),
        "cylinders": [list(drive["distance"]) for drive in sketch.drives if drive.get("distance")],
        "loads": list(_loads(sketch)),
        "rows": rows_of(sketch),
        "dimensions": dimension_rows(sketch),
    }


def _text(value: object) -> str:
    return _(value) if isinstance(value, str) else ""


def _box(sketch: SketchParts) -> list[list[float]]:
    """Two corners of the room that the drawing needs [m]."""
    at = list(sketch.places.values())
    if not at:
        return [[-1.0, -1.0], [1.0, 1.0]]
    margin = MARGIN * sketch.size
    low, high = ([pick(x) for x in zip(*at, strict=True)] for pick in (min, max))
    return [[x - margin for x in low], [x + margin for x in high]]


def _point(sketch: SketchParts, name: str) -> dict[str, Any]:
    owners = sketch.owners(name)
    fixed = name in sketch.frame_points
    joint = len(owners) > 1 or bool(sketch.guides_of(name))
    place = sketch.places.get(name)
    edit, move = edit_refusal(sketch, name), move_refusal(sketch, name)
    return {
        "name": name,
        "at": None if place is None else list(place),
        "kind": "fixed" if fixed else "moving" if joint else "coupler",
        "links": owners,
        "traced": name in sketch.marks["traced"],
        "held": name in sketch.marks["fixed"],
        "handles": {"edit": not edit, "move": not move, "why": edit or move},
    }


def _link(sketch: SketchParts, index: int, name: str) -> dict[str, Any]:
    points, path = sketch.links[name], f"links.{name}.length"
    length = sketch.length(name)
    kinds = {1: "slider", 2: "bar"}
    return {
        "name": name,
        "points": list(points),
        "shape": kinds.get(len(points), "plate"),
        "length": length,
        "path": path if length is not None else None,
        "locked": path in sketch.marks["locked"],
        "drive": bool(sketch.drives_of(name)),
        "colour": index,
        "angle": sketch.poses[name][1] if name in sketch.poses else None,
        "held": [point for point in points if point in sketch.marks["fixed"]],
    }


def _guides(sketch: SketchParts) -> Iterator[dict[str, Any]]:
    for k, guide in enumerate(sketch.guides):
        through, direction = guide_line(sketch, k)
        point = guide.get("point")
        yield {
            "name": guide_name(sketch, k),
            "point": point,
            "on": guide.get("on", FRAME),
            "through": None if through is None else list(through),
            "direction": direction,
            "circle": _circle(sketch, k),
            "link": guide.get("link"),
            "slider": not guide.get("link"),
            "drive": bool(sketch.drives_of(str(guide.get("name", point)))),
        }


def _circle(sketch: SketchParts, number_of_guide: int) -> dict[str, Any] | None:
    """The circle of a guide on the sphere."""
    circle = guide_circle(sketch, number_of_guide) if sketch.on_sphere else None
    return None if circle is None else {"pole": list(circle[0]), "radius": circle[1]}


def _drives(sketch: SketchParts) -> Iterator[dict[str, Any]]:
    prepared = sketch.document.position
    for drive in sketch.drives:
        name, points = drive_name(drive), drive.get("distance")
        coordinate = coordinate_of_drive(drive, sketch.space)
        start = None if prepared is None else prepared.assembled.positions.drives.get(name)
        yield {
            "name": name,
            "kind": coordinate.kind,
            "link": drive.get("link"),
            "guide": drive.get("guide"),
            "points": points,
            "start": None if start is None else float(start),
            "speed": number(drive.get("speed"), coordinate.speed_kind),
            "law": next(
                (key for key in ("speed", "law", "table", "segments", "cam") if drive.get(key) is not None),
                None,
            ),
        }


def _wheels(sketch: SketchParts) -> Iterator[dict[str, Any]]:
    """Rolling wheels with what they roll on, and pitch circles of meshing ones, which touch where they mesh."""
    for wheel in list_of_tables(sketch.tables, "rolling"):
        along = wheel.get("along")
        yield {
            "link": wheel.get("link"),
            "centre": wheel.get("centre"),
            "radius": number(wheel.get("radius"), "length"),
            "pitch": False,
            "track": _track(sketch, wheel, along) if isinstance(along, Mapping) else None,
        }
    mechanism = sketch.document.mechanism
    for gear in () if mechanism is None else mechanism.gears:
        yield from _pitch_circles(sketch, gear)


def _track(sketch: SketchParts, wheel: Mapping[str, Any], along: Mapping[str, Any]) -> dict[str, Any] | None:
    """The circle or the line that a wheel rolls on, where it lies in the initial position."""
    on = str(wheel.get("on", FRAME))
    pose = ((0.0, 0.0), 0.0) if on == FRAME else sketch.poses.get(on)
    given = along.get("centre", along.get("through"))
    local = coordinates(given)
    place = sketch.places.get(given) if isinstance(given, str) else None
    if pose is None or (local is None and place is None):
        return None
    if place is None and local is not None:
        place = shown_place(pose, local)
    direction = direction_angle(along.get("direction"))
    return {
        "on": on,
        "at": list(place or ()),
        "radius": number(along.get("radius"), "length"),
        "direction": None if direction is None else direction + pose[1],
    }


def _pitch_circles(sketch: SketchParts, gear: Gear) -> Iterator[dict[str, Any]]:
    """Each wheel of a gear by the point in which it turns on the carrier; none where both turn about one axis."""
    held = sketch.frame_points if gear.carrier == FRAME else sketch.links.get(gear.carrier, ())
    of_links = [sketch.frame_points if link == FRAME else sketch.links.get(link, ()) for link in gear.links]
    shafts = [next((point for point in points if point in held), "") for points in of_links]
    places = [sketch.places[shaft] for shaft in shafts if shaft in sketch.places]
    if len(places) < len(shafts):
        return
    distance = sketch.distance(places[0], places[1])
    if distance < COAXIAL * sketch.size:
        return
    if sketch.on_sphere:
        # the wheels touch along the axis about which they roll
        contact = on_unit_sphere(tuple(x - gear.ratio * y for x, y in zip(*places, strict=True)))
        if contact is None:
            return
        radii = [sketch.distance(place, contact) for place in places]
        if radii[1] > math.pi / 2:
            # an axis pierces the sphere twice: they mesh at the place on the side of the second wheel
            radii = [math.pi - radius for radius in radii]
    else:
        second = distance / abs(gear.ratio - 1.0)
        radii = [abs(gear.ratio) * second, second]
    for link, shaft, radius in zip(gear.links, shafts, radii, strict=True):
        yield {"link": link, "centre": shaft, "radius": radius, "pitch": True, "track": None}


def _loads(sketch: SketchParts) -> Iterator[dict[str, Any]]:
    for k, load in enumerate(list_of_tables(sketch.tables, "loads")):
        vector = load.get("vector")
        yield {
            "name": load_name(k),
            "kind": load.get("kind"),
            "point": load.get("point"),
            "link": load.get("link"),
            "points": load.get("points"),
            "vector": [number(x, "force") for x in vector] if isinstance(vector, list) else None,
        }


# Numbers that a field of the workbench shows and changes.


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
