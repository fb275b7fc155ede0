"""State rows: what each object may be made into, and what the text says when a row is switched."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from centrode.app.drawing_operations import guide_point, written_direction
from centrode.app.edit_drags import Assignment, follows_from_points, value_at_place
from centrode.app.patches import Operation, Patch
from centrode.app.quantity_texts import is_number, read_field, written_quantity
from centrode.app.sketch import SketchParts, guide_line, guide_name, list_of_tables, number
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.description import coordinate_of_drive
from centrode.model.reading import FRAME, Place

SPEED = 1.0
"""Speed [rad/s or m/s] of a drive that a row adds."""
MASS = 1.0
"""Mass [kg] that a row adds."""
FORCE = 100.0
"""Size of a load [N] that a row adds."""


def rows_of(sketch: SketchParts) -> dict[str, dict[str, dict[str, Any]]]:
    """State rows of every object: whether each is on, whether it may be switched, and why not."""
    rows = {name: _rows_of_point(sketch, name) for name in sketch.points}
    rows |= {name: _rows_of_link(sketch, name) for name in sketch.links if name not in rows}
    rows |= {guide_name(sketch, k): _rows_of_guide(sketch, k) for k in range(len(sketch.guides))}
    return rows


def _row(on: bool, why: str = "", **more: Any) -> dict[str, Any]:
    return {"on": on, "allowed": not why, "why": why, **more}


def _sphere_words(sketch: SketchParts) -> str:
    measured = sketch.on_sphere and not sketch.is_short_form
    return _("on the sphere this is changed in the text") if measured else ""


def _rows_of_point(sketch: SketchParts, name: str) -> dict[str, dict[str, Any]]:
    sphere = _sphere_words(sketch)
    fixed, guided = name in sketch.frame_points, bool(sketch.guides_of(name))
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


def _guide_id(sketch: SketchParts, k: int) -> str:
    guide = sketch.guides[k]
    return str(guide.get("name", guide.get("point")))


def _rows_of_link(sketch: SketchParts, name: str) -> dict[str, dict[str, Any]]:
    sphere = _sphere_words(sketch)
    driven = sketch.drives_of(name)
    link = sketch.tables["links"][name]
    mass = number(link.get("mass"), "mass")
    path = f"links.{name}.length"
    pivots = [point for point in sketch.links[name] if point in sketch.frame_points]
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


def _rows_of_guide(sketch: SketchParts, k: int) -> dict[str, dict[str, Any]]:
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


# What the text says when one is switched.


def set_row(patch: Patch, operation: Operation) -> None:
    """Switch a state row of an object, or give it another number."""
    sketch = patch.sketch
    name, row, on = operation.get("object"), operation.get("row"), bool(operation.get("on", True))
    rows = rows_of(sketch)
    if not isinstance(name, str) or name not in rows or row not in rows[name]:
        raise InputError("", _("the server does not know this object"))
    state, value = rows[name][row], operation.get("value")
    if not state["allowed"]:
        raise InputError(name, state["why"])
    if state["on"] == on and (not on or value is None):
        return
    guide = next((k for k in range(len(sketch.guides)) if guide_name(sketch, k) == name), None)
    match row:
        case "ground":
            set_ground(patch, name, on)
        case "guide":
            _set_guide(patch, name, guide, on, value)
        case "drive":
            _set_drive(patch, name, guide, on, value)
        case "fixed":
            mark = "fixed" if name in sketch.points else "locked"
            patch.set_mark(mark, name if mark == "fixed" else f"links.{name}.length", on)
        case "trace":
            patch.set_mark("traced", name, on)
        case "mass":
            _set_mass(patch, name, on, value)
        case "load":
            _set_load(patch, name, on, value)


def set_ground(patch: Patch, point: str, on: bool) -> None:
    """Make a point one of the frame, or a moving one."""
    sketch = patch.sketch
    frame = sketch.tables.get("frame", {}).get("points")
    if on:
        if sketch.is_short_form and point in sketch.tables["points"]:
            if isinstance(frame, Mapping):
                patch.write((("frame", "points", point), sketch.tables["points"][point]))
            elif frame is None and "frame" not in sketch.tables:
                patch.add_table(("frame",), {"points": [point]})
            else:
                patch.write((("frame", "points"), [*(frame or ()), point]))
        elif point in sketch.places:
            patch.write((("frame", "points", point), patch.pair(sketch.places[point])))
        else:
            raise InputError(point, _("its place is not known: correct the description first"))
        return
    if isinstance(frame, list):
        patch.write((("frame", "points"), [one for one in frame if one != point]))
    else:
        patch.remove(("frame", "points", point))


def _set_guide(patch: Patch, name: str, guide: int | None, on: bool, value: Any) -> None:
    sketch = patch.sketch
    numbers = [guide] if guide is not None else sketch.guides_of(name)
    if on and not numbers:
        angle = value if isinstance(value, int | float) and not isinstance(value, bool) else 0.0
        guide_point(patch, name, float(angle))
    elif on:
        angle = read_field(sketch, value, "angle")
        on_link = sketch.guides[numbers[0]].get("on", FRAME)
        angle -= sketch.poses[on_link][1] if on_link != FRAME else 0.0
        patch.write((("guides", numbers[0], "direction"), written_direction(patch, angle)))
    else:
        remove_guides(patch, numbers)


def remove_guides(patch: Patch, numbers: Sequence[int]) -> None:
    """Take out guides, their drives and their sides."""
    sketch = patch.sketch
    gone = {str(sketch.guides[k].get("name", sketch.guides[k].get("point"))) for k in numbers}
    drives = [k for k, drive in enumerate(sketch.drives) if drive.get("guide") in gone]
    sides = [
        ("assembly", "sides", one)
        for one in gone
        if one in sketch.tables.get("assembly", {}).get("sides", {}) and one not in sketch.points
    ]
    patch.remove(*(("guides", k) for k in numbers), *(("drives", k) for k in drives), *sides)


def _set_drive(patch: Patch, name: str, guide: int | None, on: bool, value: Any) -> None:
    sketch = patch.sketch
    if guide is None and name in sketch.points:
        guide = next(iter(sketch.guides_of(name)), None)
    key = "link" if guide is None else "guide"
    subject = name
    if guide is not None:
        subject = str(sketch.guides[guide].get("name", sketch.guides[guide].get("point")))
    present = sketch.drives_of(subject)
    if not on:
        patch.remove(*(("drives", k) for k in present))
        return
    kind = coordinate_of_drive({key: subject}, sketch.space).speed_kind
    speed = SPEED if value is None else read_field(sketch, value, kind)
    if present:
        place: Place = ("drives", present[0], "speed")
        old = value_at_place(sketch.tables, place)
        if old is None:
            raise InputError(name, _("this drive has a law of its own: change it in the text"))
        patch.write((place, value if isinstance(value, str) and not is_number(value) else speed))
        return
    if key == "link":
        _ground_pivot(patch, name)
    entries: dict[str, Any] = {key: subject}
    sketch = patch.sketch
    if key == "link" and not follows_from_points(sketch, name) and sketch.angle(name) is None:
        if name not in sketch.poses:
            raise InputError(name, _("its place is not known: correct the description first"))
        entries["start"] = patch.angle(sketch.poses[name][1])
    if key == "guide" and guide is not None:
        slide = _slide(patch, sketch, guide)
        if abs(slide) > 1e-9 * sketch.size:
            entries["start"] = patch.length(slide)
    entries["speed"] = value if isinstance(value, str) and not is_number(value) else speed
    patch.add_entry("drives", entries)


def _slide(patch: Patch, sketch: SketchParts, guide: int) -> float:
    """Displacement of the point of a guide from the place that its line goes through."""
    point = str(sketch.guides[guide].get("point"))
    start, direction = guide_line(sketch, guide)
    if start is None or direction is None or point not in sketch.places:
        return 0.0
    x, y = sketch.places[point][0] - start[0], sketch.places[point][1] - start[1]
    return x * math.cos(direction) + y * math.sin(direction)


def _ground_pivot(patch: Patch, link: str) -> None:
    """A driven link turns about a point of the frame: where it has none, its loose end becomes one."""
    sketch = patch.sketch
    points = sketch.links[link]
    if any(point in sketch.frame_points for point in points):
        return
    loose = [point for point in points if len(sketch.owners(point)) < 2 and not sketch.guides_of(point)]
    if len(loose) == len(points) > 1:
        loose = loose[:1]
    if len(loose) != 1:
        what = _("a driven link turns about a point of the frame: switch Ground on at one of its joints")
        raise InputError(link, what)
    set_ground(patch, loose[0], True)


def ensure_references(patch: Patch) -> None:
    """On the sphere the angle of a drive is measured from an arc to a further point of the frame: where a drawing has
    none although nothing hangs loose, a pole becomes one.
    """
    sketch = patch.sketch
    if not (sketch.on_sphere and sketch.is_short_form) or sketch.loose_points():
        return
    for drive in sketch.drives:
        link = drive.get("link")
        if drive.get("relative_to", FRAME) != FRAME or link not in sketch.links:
            continue
        first = sketch.places.get(sketch.links[link][0])
        others = [sketch.places[point] for point in sketch.frame_points if point in sketch.places]
        if first is None or any(1e-6 < sketch.distance(first, other) < math.pi - 1e-6 for other in others):
            continue
        pole = (0.0, 0.0, 1.0) if abs(first[2]) < 0.9 else (1.0, 0.0, 0.0)
        set_ground(patch, patch.new_point(pole), True)
        return


def _set_mass(patch: Patch, link: str, on: bool, value: Any) -> None:
    sketch = patch.sketch
    table = sketch.tables["links"][link]
    if not on:
        keys = [key for key in ("mass", "centre", "inertia", "shape", "radius", "masses") if key in table]
        patch.remove(*(("links", link, key) for key in keys))
        return
    mass = MASS if value is None else read_field(sketch, value, "mass")
    place: Place = ("links", link, "mass")
    if "mass" in table:
        text = isinstance(value, str) and not is_number(value)
        patch.write((place, value if text else written_quantity(sketch, table["mass"], mass, "mass")))
        return
    entries: list[Assignment] = [(place, value if isinstance(value, str) and not is_number(value) else mass)]
    if len(sketch.links[link]) == 2 and not isinstance(table.get("points"), Mapping):
        entries.append((("links", link, "shape"), "arc" if sketch.on_sphere else "rod"))
    patch.write(*entries)


def _set_load(patch: Patch, point: str, on: bool, value: Any) -> None:
    sketch = patch.sketch
    present = [k for k, one in enumerate(list_of_tables(sketch.tables, "loads")) if one.get("point") == point]
    if not on:
        patch.remove(*(("loads", k) for k in present))
        return
    axes = 3 if sketch.on_sphere else 2
    vector: list[Any] = [*([0] * (axes - 1)), -FORCE]
    if value is not None:
        if not isinstance(value, list) or len(value) != axes:
            what = _("a force is two numbers") if axes == 2 else _("a force on the sphere is three numbers")
            raise InputError(point, what)
        vector = [read_field(sketch, x, "force") for x in value]
    forces = [k for k in present if list_of_tables(sketch.tables, "loads")[k].get("kind") == "force"]
    if forces:
        patch.write((("loads", forces[0], "vector"), vector))
    else:
        patch.add_entry("loads", {"kind": "force", "point": point, "vector": vector})
