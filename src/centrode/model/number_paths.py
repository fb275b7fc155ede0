"""Numbers of a description by their paths: links.AC.length, frame.points.D.x, guides.C.through.y, drives.OA.speed.

Those of loads, machine and simulation are in `load_paths`.
"""

from __future__ import annotations

from typing import Any

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.description import Description
from centrode.model.load_paths import ROOMS
from centrode.model.reading import PLACED, nearest, value_text

_AXES = {"plane": ("x", "y"), "sphere": ("longitude", "latitude")}
Spot = tuple[Any, Any]
"""A table or list of the document, and the key or index in it."""


def words_of_path(mechanism: Description, path: str) -> list[str]:
    """The path's parts; a name may itself hold dots, so known names are tried first."""
    room, _dot, rest = path.partition(".")
    names: dict[str, list[str]] = {
        "links": list(mechanism.links),
        "frame": ["points"],
        "guides": [guide.id for guide in mechanism.guides],
        "gears": [gear.id for gear in mechanism.gears],
        "rolling": [wheel.id for wheel in mechanism.rolling],
        "drives": [drive.id for drive in mechanism.drives],
    }
    if room not in names:
        raise _unknown(path, room, [*names, *ROOMS])
    name, tail = _first(rest, names[room], path)
    if tail.startswith("points.") or name == "points":
        inner = tail.removeprefix("points.")
        known = list(mechanism.frame.points if room == "frame" else mechanism.links[name].coordinates)
        point, axis = _first(inner, known, path)
        return [room, name, point, axis] if room == "frame" else [room, name, "points", point, axis]
    return [room, name, *tail.split(".")] if tail else [room, name]


def _first(rest: str, known: list[str], path: str) -> tuple[str, str]:
    for name in sorted(known, key=len, reverse=True):
        if rest == name or rest.startswith(name + "."):
            return name, rest[len(name) + 1 :]
    raise _unknown(path, rest.split(".")[0], known)


def _unknown(path: str, word: str, known: list[str]) -> InputError:
    what = _("there is no {word} in the path {path}").format(word=value_text(word), path=value_text(path))
    return InputError("", what, nearest(word, known))


_NUMBERS = {
    "links": ("length", "angle", "mass", "inertia", "radius", "centre_radius"),
    "guides": ("direction", "angle", "radius"),
    "gears": ("ratio",),
    "rolling": ("radius",),
    "along": ("direction", "radius"),
    "drives": ("start", "speed"),
}


def spot_of_path(tables: dict[str, Any], words: list[str], path: str) -> Spot:
    """Where the number of a path, of these words, stands in the tables; raises InputError where there is none."""
    room, name, *rest = words
    axes = _AXES[tables.get("space", "plane")]
    if room == "frame":
        return _coordinate(tables["frame"]["points"], rest, path, axes)
    if room == "links":
        return _in_link(tables["links"][name], words, path, axes)
    entry = next(entry for entry in tables[room] if _identity(room, entry) == name)
    if room == "guides" and rest[:1] in (["through"], ["pole"]):
        return _coordinate(entry, rest, path, axes)
    if room == "rolling" and rest[:1] == ["along"]:
        entry, room, rest = entry["along"], "along", rest[1:]
        if rest[:1] in (["through"], ["centre"]):
            return _coordinate(entry, rest, path, axes)
    return _number(entry, room, rest, path)


def _in_link(link: dict[str, Any], words: list[str], path: str, axes: tuple[str, str]) -> Spot:
    room, name, *rest = words
    if rest[:1] == ["points"]:
        if not isinstance(link.get("points"), dict):
            what = _("the points of link {name} have no coordinates of their own").format(name=name)
            raise InputError("", what, f"links.{name}.length")
        return _coordinate(link["points"], rest[1:], path, axes)
    if rest[:1] == ["centre"]:
        return _coordinate(link, rest, path, axes)
    return _number(link, room, rest, path)


def _identity(room: str, entry: dict[str, Any]) -> str:
    if room == "guides":
        return str(entry.get("name") or entry["point"])
    if room == "gears":
        return str(entry.get("name") or "-".join(entry["links"]))
    if room == "rolling":
        return str(entry.get("name") or entry["link"])
    return str(entry.get("link") or entry.get("guide") or "-".join(entry.get("distance", ())))


def _number(table: dict[str, Any], room: str, rest: list[str], path: str) -> Spot:
    if len(rest) != 1 or rest[0] not in _NUMBERS[room]:
        raise _unknown(path, ".".join(rest), list(_NUMBERS[room]))
    return table, rest[0]


def _coordinate(table: dict[str, Any], rest: list[str], path: str, axes: tuple[str, str]) -> Spot:
    """The list of a point's coordinates and the axis; a placed one becomes given."""
    if len(rest) != 2 or rest[1] not in axes:
        raise _unknown(path, ".".join(rest[1:]), list(axes))
    name, axis = rest
    if isinstance(table.get(name), dict):
        table[name] = table[name][PLACED]
    if not isinstance(table.get(name), list):
        raise InputError("", _("{path} is not a number here").format(path=path), _("give coordinates"))
    return table[name], axes.index(axis)
