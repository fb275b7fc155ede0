"""The picture of a description as data: points, links, guides, drives, loads, and what each may be made into."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from centrode.app.dimensions import dimension_rows
from centrode.app.sketch import Sketch, Vector, coordinates, list_of_tables, number
from centrode.locale import _
from centrode.model.description import coordinate_of_drive
from centrode.model.placement import rotate_vector
from centrode.model.reading import FRAME
from centrode.quantities import ANGLES, LENGTHS

MARGIN = 0.1
"""Room around a drawing, as a part of its extent."""
FORCE = 100.0
"""Size of a load [N] that a row adds."""


def scene_of(sketch: Sketch) -> dict[str, Any]:
    """The scene of a mechanism, whether it can move or not."""
    display = sketch.tables.get("display")
    display = display if isinstance(display, dict) else {}
    length, angle = display.get("length", "m"), display.get("angle", "rad")
    return {
        "title": _text(sketch.tables.get("title")),
        "kind": "sphere" if sketch.on_sphere else "plane",
        "unit": length if length in LENGTHS else "m",
        "display": {
            "length": {"unit": length, "factor": LENGTHS.get(length, 1.0)},
            "angle": {"unit": angle, "factor": ANGLES.get(angle, 1.0)},
        },
        "size": _box(sketch),
        "points": [_point(sketch, name) for name in sketch.points],
        "links": [_link(sketch, k, name) for k, name in enumerate(sketch.links)],
        "guides": list(_guides(sketch)),
        "drives": list(_drives(sketch)),
        "wheels": list(_wheels(sketch)),
        "gears": [
            {"links": list(gear.get("links", ())), "carrier": gear.get("carrier", FRAME)}
            for gear in list_of_tables(sketch.tables, "gears")
        ],
        "cylinders": [list(drive["distance"]) for drive in sketch.drives if drive.get("distance")],
        "loads": list(_loads(sketch)),
        "rows": rows_of(sketch),
        "dimensions": dimension_rows(sketch),
    }


def _text(value: object) -> str:
    return _(value) if isinstance(value, str) else ""


def _box(sketch: Sketch) -> list[list[float]]:
    """Two corners of the room that the drawing needs [m]."""
    at = list(sketch.places.values())
    if not at:
        return [[-1.0, -1.0], [1.0, 1.0]]
    margin = MARGIN * sketch.size
    low, high = ([pick(x) for x in zip(*at, strict=True)] for pick in (min, max))
    return [[x - margin for x in low], [x + margin for x in high]]


def _point(sketch: Sketch, name: str) -> dict[str, Any]:
    owners = sketch.owners(name)
    fixed = name in sketch.fixed
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


def edit_refusal(sketch: Sketch, name: str) -> str:
    """Why a point cannot be dragged to change lengths; empty where it can."""
    if sketch.on_sphere:
        return _("on the sphere lengths and angles are changed in the text or in the fields")
    if name in sketch.marks["fixed"]:
        return _("this joint is held: switch Fixed off to drag it")
    if name not in sketch.places:
        return _("its place is not known: correct the description first")
    wheels = list_of_tables(sketch.tables, "rolling")
    turned = {wheel.get("centre") for wheel in wheels}
    if name in turned:
        return _("the centre of a rolling wheel follows from its track: change the radii in the text")
    return ""


def move_refusal(sketch: Sketch, name: str) -> str:
    """Why a point cannot be dragged to move the mechanism; empty where it can."""
    if name in sketch.fixed:
        return _("a point of the frame does not move")
    if sketch.document.prepared is None:
        return _("the mechanism cannot move yet")
    return ""


def _link(sketch: Sketch, index: int, name: str) -> dict[str, Any]:
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


def guide_name(sketch: Sketch, number_of_guide: int) -> str:
    """How the workbench names a guide: not as its point, which is an object of its own."""
    return f"guide {number_of_guide + 1}"


def _guides(sketch: Sketch) -> Iterator[dict[str, Any]]:
    for k, guide in enumerate(sketch.guides):
        through, direction = guide_line(sketch, k)
        point = guide.get("point")
        yield {
            "name": guide_name(sketch, k),
            "point": point,
            "on": guide.get("on", FRAME),
            "through": None if through is None else list(through),
            "direction": direction,
            "link": guide.get("link"),
            "slider": not guide.get("link"),
            "drive": bool(sketch.drives_of(str(guide.get("name", point)))),
        }


def guide_line(sketch: Sketch, number_of_guide: int) -> tuple[Vector | None, float | None]:
    """A place on the line of a guide [m] and its angle [rad], both in the axes of the frame."""
    guide = sketch.guides[number_of_guide]
    on, point = guide.get("on", FRAME), str(guide.get("point"))
    direction = direction_angle(guide.get("direction"))
    given = guide.get("through")
    here = sketch.places.get(point)
    if on == FRAME:
        through = sketch.places.get(given) if isinstance(given, str) else coordinates(given)
        return (here if through is None else through), direction
    if on not in sketch.poses:
        return here, None
    origin, angle = sketch.poses[on]
    turned = None if direction is None else direction + angle
    if isinstance(given, str):
        return sketch.places.get(given, here), turned
    local = coordinates(given)
    if local is None:
        return here, turned
    x, y = rotate_vector(local, angle)
    return (origin[0] + x, origin[1] + y), turned


def direction_angle(value: object) -> float | None:
    """Angle [rad] of a direction that is given as [x, y] or as an angle."""
    if isinstance(value, list):
        place = coordinates(value)
        return None if place is None else math.atan2(place[1], place[0])
    return number(value, "angle")


def _drives(sketch: Sketch) -> Iterator[dict[str, Any]]:
    prepared = sketch.document.prepared
    for drive in sketch.drives:
        name = next((drive[key] for key in ("link", "guide") if isinstance(drive.get(key), str)), "")
        points = drive.get("distance")
        name = name or "-".join(points or ())
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


def _wheels(sketch: Sketch) -> Iterator[dict[str, Any]]:
    for wheel in list_of_tables(sketch.tables, "rolling"):
        along = wheel.get("along")
        yield {
            "link": wheel.get("link"),
            "centre": wheel.get("centre"),
            "radius": number(wheel.get("radius"), "length"),
            "on": wheel.get("on", FRAME),
            "track": number(along.get("radius"), "length") if isinstance(along, dict) else None,
        }


def _loads(sketch: Sketch) -> Iterator[dict[str, Any]]:
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


def load_name(number_of_load: int) -> str:
    """How the workbench names a load."""
    return f"load {number_of_load + 1}"


# What each object may be made into.


def rows_of(sketch: Sketch) -> dict[str, dict[str, dict[str, Any]]]:
    """State rows of every object: whether each is on, whether it may be switched, and why not."""
    rows = {name: _rows_of_point(sketch, name) for name in sketch.points}
    rows |= {name: _rows_of_link(sketch, name) for name in sketch.links if name not in rows}
    rows |= {guide_name(sketch, k): _rows_of_guide(sketch, k) for k in range(len(sketch.guides))}
    return rows


def _row(on: bool, why: str = "", **more: Any) -> dict[str, Any]:
    return {"on": on, "allowed": not why, "why": why, **more}


def _sphere_words(sketch: Sketch) -> str:
    return _("on the sphere this is changed in the text") if sketch.on_sphere else ""


def _rows_of_point(sketch: Sketch, name: str) -> dict[str, dict[str, Any]]:
    sphere = _sphere_words(sketch)
    fixed, guided = name in sketch.fixed, bool(sketch.guides_of(name))
    unplaced = "" if name in sketch.places else _("its place is not known: correct the description first")
    of_guide = [k for k in sketch.guides_of(name) if sketch.guides[k].get("on", FRAME) == FRAME]
    driven = guided and bool(sketch.drives_of(_guide_id(sketch, sketch.guides_of(name)[0])))
    loads = [one for one in list_of_tables(sketch.tables, "loads") if one.get("point") == name]
    value = next(
        (number_list(one.get("vector"), "force") for one in loads if one.get("kind") == "force"), None
    )
    ground = sphere or unplaced
    if not ground and not fixed and guided:
        ground = _("this point slides in a guide: remove the guide first")
    if not ground and fixed and not sketch.owners(name):
        ground = _("no link has this point: delete it instead")
    slide = sphere or unplaced
    if not slide and not guided and fixed:
        slide = _("a point of the frame does not slide: switch Ground off first")
    direction = guide_line(sketch, of_guide[0])[1] if of_guide else None
    return {
        "ground": _row(fixed, ground),
        "guide": _row(guided, slide, value=direction),
        "drive": _row(driven, sphere or ("" if guided else _("only a link or a sliding point is driven"))),
        "fixed": _row(name in sketch.marks["fixed"], sphere),
        "trace": _row(name in sketch.marks["traced"], _("a point of the frame has no path") if fixed else ""),
        "mass": _row(False, _("masses belong to links: select one")),
        "load": _row(
            bool(loads),
            sphere or (_("a force on the frame does no work") if fixed else ""),
            value=value,
            unit="N",
        ),
    }


def number_list(value: object, kind: str) -> list[float | None] | None:
    """Numbers in SI of a list."""
    return [number(one, kind) for one in value] if isinstance(value, list) else None


def _guide_id(sketch: Sketch, k: int) -> str:
    guide = sketch.guides[k]
    return str(guide.get("name", guide.get("point")))


def _rows_of_link(sketch: Sketch, name: str) -> dict[str, dict[str, Any]]:
    sphere = _sphere_words(sketch)
    driven = sketch.drives_of(name)
    link = sketch.tables["links"][name]
    mass = number(link.get("mass"), "mass")
    path = f"links.{name}.length"
    pivots = [point for point in sketch.links[name] if point in sketch.fixed]
    loose = [point for point in sketch.links[name] if len(sketch.owners(point)) < 2]
    drive = ""
    if not driven and not pivots and not loose:
        drive = _("a driven link turns about a point of the frame: switch Ground on at one of its joints")
    length = sketch.length(name)
    no_point = _("this belongs to points: select one")
    return {
        "ground": _row(False, no_point),
        "guide": _row(False, no_point),
        "drive": _row(
            bool(driven),
            sphere or drive,
            value=number(sketch.drives[driven[0]].get("speed"), "angular speed") if driven else None,
            unit="rad/s",
        ),
        "fixed": _row(
            path in sketch.marks["locked"],
            "" if length is not None else _("only a link of two points has a length to lock"),
        ),
        "trace": _row(False, no_point),
        "mass": _row(mass is not None or bool(link.get("masses")), sphere, value=mass, unit="kg"),
        "load": _row(False, no_point),
    }


def _rows_of_guide(sketch: Sketch, k: int) -> dict[str, dict[str, Any]]:
    sphere, only = _sphere_words(sketch), _("this belongs to points and links: select one")
    driven = sketch.drives_of(_guide_id(sketch, k))
    rows = {row: _row(False, only) for row in ("ground", "fixed", "trace", "mass", "load")}
    return {
        **rows,
        "guide": _row(True, sphere, value=guide_line(sketch, k)[1]),
        "drive": _row(
            bool(driven),
            sphere,
            value=number(sketch.drives[driven[0]].get("speed"), "speed") if driven else None,
            unit="m/s",
        ),
    }
