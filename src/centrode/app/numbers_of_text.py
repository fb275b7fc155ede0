"""Which key of a text a path of the workbench names, and what kind of number stands there."""

from __future__ import annotations

import re
from typing import Any

from centrode.app.edit_drags import value_at_place
from centrode.app.quantity_texts import plain
from centrode.app.sketch import Sketch
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.description import coordinate_of_drive
from centrode.model.reading import Place, value_text

AXES = {"x": 0, "y": 1}
KINDS = {"length": "length", "angle": "angle", "mass": "mass", "inertia": "inertia", "radius": "length"}
"""Key of a link -> kind of quantity."""

_TEXT = re.compile(r"\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)\s*(.*)", re.DOTALL)


def place_of_path(sketch: Sketch, path: str) -> tuple[Place, str | None]:
    """Place of a path such as links.OA.length, and the kind of quantity there; None where only its spelling is known.

    Raises InputError for a path that leads nowhere.
    """
    room, _dot, rest = path.partition(".")
    match room:
        case "points":
            name, _dot, axis = rest.rpartition(".")
            if axis in AXES and name in sketch.tables.get("points", {}):
                return ("points", name, AXES[axis]), "length"
        case "frame":
            name, _dot, axis = rest.removeprefix("points.").rpartition(".")
            if axis in AXES and name in sketch.fixed:
                if sketch.is_short_form and name in sketch.tables["points"]:
                    return ("points", name, AXES[axis]), "length"
                return ("frame", "points", name, AXES[axis]), "length"
        case "links":
            place = _place_in_link(sketch, rest)
            if place is not None:
                return place
        case "drives":
            name, _dot, key = rest.rpartition(".")
            for k, drive in enumerate(sketch.drives):
                if name in (drive.get("link"), drive.get("guide"), "-".join(drive.get("distance") or ())):
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


def _place_in_link(sketch: Sketch, rest: str) -> tuple[Place, str | None] | None:
    for name in sorted(sketch.links, key=len, reverse=True):
        if not rest.startswith(f"{name}."):
            continue
        key = rest.removeprefix(f"{name}.")
        if key in KINDS:
            return ("links", name, key), KINDS[key]
        point, _dot, axis = key.removeprefix("points.").rpartition(".")
        if key.startswith("points.") and axis in AXES and point in sketch.links[name]:
            return ("links", name, "points", point, AXES[axis]), "length"
    return None


def _literal(sketch: Sketch, path: str) -> Place:
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
        number = _TEXT.fullmatch(text.replace(",", ".") if re.fullmatch(r"[+-]?\d+,\d+.*", text) else text)
        if number is None:
            if isinstance(old, int | float) and not isinstance(old, bool):
                raise InputError("", _("a number is needed"))
            return text
        if number.group(2):
            return f"{number.group(1)} {number.group(2)}"
        value = float(number.group(1))
    if isinstance(old, str):
        unit = _TEXT.fullmatch(old)
        if unit is None:
            raise InputError("", _("a text is needed"))
        return f"{plain(float(value))} {unit.group(2)}".strip()
    return float(value)
