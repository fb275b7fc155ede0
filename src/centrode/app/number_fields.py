"""Numbers that a field or a drag changes: which key of the text holds them, and what follows from them."""

from __future__ import annotations

import math
from typing import Any

from centrode.app.edit_drags import (
    STANDS,
    Assignment,
    follow,
    follows_from_points,
    reshape,
    value_at_place,
    written_position,
)
from centrode.app.patches import Operation, Patch
from centrode.app.quantity_texts import read_field, typed_quantity, with_decimal_point
from centrode.app.sketch import SketchParts, Vector, drive_name, on_unit_sphere
from centrode.app.text_changes import spelled_value
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.description import coordinate_of_drive
from centrode.model.reading import Place, value_text
from centrode.model.units import number_and_unit
from centrode.model.values import tangent_towards, unit_vector

AXES = {"x": 0, "y": 1, "longitude": 0, "latitude": 1}
KINDS = {"length": "length", "angle": "angle", "mass": "mass", "inertia": "inertia", "radius": "length"}
"""Key of a link -> kind of quantity."""


def set_number(patch: Patch, operation: Operation) -> None:
    """Give a number another value; what has to follows."""
    path, value = operation.get("path"), operation.get("value")
    if not isinstance(path, str) or len(path) > 300:
        raise InputError("", _("the path is a text"))
    sketch = patch.sketch
    place, kind = place_of_path(sketch, path)
    if kind is None:
        patch.write((place, written_like(value_at_place(sketch.tables, place), value)))
        return
    number = read_field(sketch, value, kind)
    if path in sketch.marks["locked"]:
        raise InputError(str(place[1]), _("this length is locked"), _("unlock it first"))
    if place[-1] == "length" and not number > 0.0:
        what = _("{key} must be positive, got {value}").format(key="length", value=value_text(value))
        raise InputError(str(place[1]), what)
    mechanism = sketch.document.mechanism
    geometric = place[0] in ("links", "frame", "guides", "drives", "points") and kind in (
        "length",
        "angle",
    )
    if place[0] == "points" and len(place) == 3:
        point = str(place[1])
        to = [*sketch.numbers_of(sketch.places[point])]
        to[int(place[2])] = number
        drop_point(patch, point, unit_vector((to[0], to[1])) if sketch.on_sphere else tuple(to))
        return
    if geometric and mechanism is not None and sketch.document.prepared is not None:
        _follow(patch, sketch, path, place, number, value, kind)
        return
    if place[0] == "links" and place[-1] == "length" and follows_from_points(sketch, str(place[1])):
        _stretch(patch, sketch, str(place[1]), number)
        return
    old = value_at_place(sketch.tables, place)
    patch.write((place, typed_quantity(sketch, old, value, number, kind)))


def _stretch(patch: Patch, sketch: SketchParts, link: str, length: float) -> None:
    """Another length of a link that cannot move yet: its second point goes, or its first where that one is free."""
    first, second = sketch.links[link][:2]
    if second in sketch.frame_points or (
        len(sketch.owners(second)) > 1 and len(sketch.owners(first)) < 2 and first not in sketch.frame_points
    ):
        first, second = second, first
    if sketch.on_sphere:
        drop_point(patch, second, along_arc(sketch.places[first], sketch.places[second], length))
        return
    (x, y), (u, v) = sketch.places[first][:2], sketch.places[second][:2]
    share = length / math.hypot(u - x, v - y)
    drop_point(patch, second, (x + share * (u - x), y + share * (v - y)))


def _follow(
    patch: Patch, sketch: SketchParts, path: str, place: Place, number: float, value: Any, kind: str
) -> None:
    """Another number of a mechanism that moves: its initial position follows on the same side."""
    old = value_at_place(sketch.tables, place)
    prepared = follow(sketch, path, number)
    own: tuple[Assignment, ...] = ()
    if old is not None or place[0] == "drives":
        own = ((place, typed_quantity(sketch, old, value, number, kind)),)
    patch.write(*own, *written_position(sketch, prepared, {place}))


def along_arc(start: Vector, towards: Vector, way: float) -> Vector:
    """The place on the sphere at a distance [rad] from another one, on the arc to a third."""
    (x, y, z), (u, v, w) = start, towards
    tangent = tangent_towards((x, y, z), (u, v, w))
    return tuple(
        math.cos(way) * one + math.sin(way) * other for one, other in zip(start, tangent, strict=True)
    )


def move_point(patch: Patch, operation: Operation) -> None:
    """Put a joint at another place."""
    drop_point(patch, patch.point_of(operation), patch.place_of(operation, "to"))


def drop_point(patch: Patch, point: str, to: Vector) -> None:
    """Put a joint at another place, as near as locks and guides let it."""
    sketch = patch.sketch
    reshaped = reshape(sketch, point, to, patch.folder)
    patch.write(*reshaped.assignments)
    if not _stands_there(sketch, reshaped.places[point], to):
        patch.held = reshaped.held


def _stands_there(sketch: SketchParts, place: Vector, wished: Vector) -> bool:
    """Whether a joint stands where it was put, but for rounded numbers."""
    return (
        math.dist(place, on_unit_sphere(wished) or place if sketch.on_sphere else wished)
        <= STANDS * sketch.size
    )


def lock(patch: Patch, operation: Operation) -> None:
    """Let a length, or a joint, hold; or free it."""
    path, on = operation.get("path"), bool(operation.get("on", True))
    sketch = patch.sketch
    if path in sketch.points:
        patch.set_mark("fixed", str(path), on)
        return
    if path not in {f"links.{name}.length" for name in sketch.links if sketch.length(name) is not None}:
        raise InputError("", _("only a link of two points has a length to lock"))
    patch.set_mark("locked", str(path), on)


# The key that a path names.


def place_of_path(sketch: SketchParts, path: str) -> tuple[Place, str | None]:
    """Place of a path such as links.OA.length, and the kind of quantity there; None where only its spelling is known.

    Raises InputError for a path that leads nowhere.
    """
    room, _dot, rest = path.partition(".")
    match room:
        case "points":
            name, _dot, axis = rest.rpartition(".")
            if axis in AXES and name in sketch.tables.get("points", {}):
                return ("points", name, AXES[axis]), "angle" if sketch.on_sphere else "length"
        case "frame":
            name, _dot, axis = rest.removeprefix("points.").rpartition(".")
            if axis in AXES and name in sketch.frame_points:
                if sketch.is_short_form and name in sketch.tables["points"]:
                    return ("points", name, AXES[axis]), "angle" if sketch.on_sphere else "length"
                return ("frame", "points", name, AXES[axis]), "length"
        case "links":
            place = _place_in_link(sketch, rest)
            if place is not None:
                return place
        case "drives":
            name, _dot, key = rest.rpartition(".")
            for k, drive in enumerate(sketch.drives):
                if name == drive_name(drive):
                    coordinate = coordinate_of_drive(drive, sketch.space)
                    kinds = {"start": str(coordinate.kind), "speed": str(coordinate.speed_kind)}
                    if key in kinds:
                        return ("drives", k, key), kinds[key]
        case "guides":
            name, _dot, key = rest.rpartition(".")
            for k, guide in enumerate(sketch.guides):
                if name == guide.get("name", guide.get("point")) and key in ("direction", "angle"):
                    return ("guides", k, key), "angle"
                if name == f"{guide.get('name', guide.get('point'))}.through" and key in AXES:
                    return ("guides", k, "through", AXES[key]), "length"
    return _literal(sketch, path), None


def _place_in_link(sketch: SketchParts, rest: str) -> tuple[Place, str | None] | None:
    for name in sorted(sketch.links, key=len, reverse=True):
        if not rest.startswith(f"{name}."):
            continue
        key = rest.removeprefix(f"{name}.")
        if key in KINDS:
            arcs = sketch.on_sphere and key == "length"
            return ("links", name, key), "angle" if arcs else KINDS[key]
        point, _dot, axis = key.removeprefix("points.").rpartition(".")
        if key.startswith("points.") and axis in AXES and point in sketch.links[name]:
            return ("links", name, "points", point, AXES[axis]), "length"
    return None


def _literal(sketch: SketchParts, path: str) -> Place:
    place: list[Any] = []
    value: Any = sketch.tables
    for word in path.split("."):
        key: Any = int(word) if isinstance(value, list) and word.isdecimal() else word
        place.append(key)
        known = (isinstance(value, dict) and key in value) or (
            isinstance(value, list) and isinstance(key, int) and key < len(value)
        )
        value = value[key] if known else None
    if value is None and value_at_place(sketch.tables, tuple(place[:-1])) is None and len(place) > 1:
        what = _("there is no {word} in the path {path}")
        raise InputError("", what.format(word=value_text(place[-1]), path=value_text(path)))
    return tuple(place)


def written_like(old: Any, value: Any) -> Any:
    """What somebody writes into a field, as a value of the kind that stands there; a number keeps the old unit."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise InputError("", _("a number is needed"))
    if isinstance(value, str):
        text = value.strip()
        number = number_and_unit(with_decimal_point(text))
        if number is None:
            if isinstance(old, int | float) and not isinstance(old, bool):
                raise InputError("", _("a number is needed"))
            return text
        if number[1]:
            return " ".join(number)
        value = float(number[0])
    if isinstance(old, str):
        known = number_and_unit(old)
        if known is None:
            raise InputError("", _("a text is needed"))
        return f"{spelled_value(float(value))} {known[1]}".strip()
    return float(value)
