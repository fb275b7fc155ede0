"""Numbers of loads, contacts, controllers, the machine, the simulation and gravity by their paths."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.contacts import Clamp, Stop
from centrode.model.description import Description
from centrode.model.loads import (
    AnyLoad,
    BearingFriction,
    GuideForce,
    GuideFriction,
    HingeDamper,
    HingeFriction,
    HingeSpring,
    LinkWeight,
    PointDamper,
    PointForce,
    PointSpring,
    PointWeight,
    SliderFriction,
    Torque,
    numbered_names,
)
from centrode.model.reading import nearest, value_text

ROOMS = ("loads", "machine", "simulation", "gravity", "stops", "clamps", "controllers")
"""First words of these paths."""

FORMULA = "formula"
"""Kind of a text of a formula that may be one number alone."""
COUNT = "count"
"""Kind of a whole number."""

KINDS_OF_LOADS: Mapping[type, Mapping[str, str]] = {
    PointForce: {},
    GuideForce: {"value": "force", "pressure": "pressure", "diameter": "length"},
    Torque: {"value": "torque"},
    PointSpring: {"stiffness": "stiffness", "free_length": "length"},
    HingeSpring: {"stiffness": "angular stiffness", "free_angle": "angle"},
    PointDamper: {"damping": "damping"},
    HingeDamper: {"damping": "angular damping"},
    LinkWeight: {"value": "force"},
    PointWeight: {"value": "force"},
    HingeFriction: {
        "value": "torque",
        "static": "torque",
        "surface_speed": "angular speed",
        "viscous": "angular damping",
        "quadratic": "angular quadratic damping",
    },
    GuideFriction: {
        "value": "force",
        "static": "force",
        "surface_speed": "speed",
        "viscous": "damping",
        "quadratic": "quadratic damping",
    },
    BearingFriction: {"coefficient": "ratio", "static_coefficient": "ratio", "radius": "length"},
    SliderFriction: {
        "coefficient": "ratio",
        "static_coefficient": "ratio",
        "surface_speed": "speed",
        "length": "length",
        "height": "length",
    },
}
"""Numbers of each load and the kind of each; a force in a point has the components of its vector."""

NUMBERS_OF_CONTROLLERS: Mapping[str, str] = {
    "target": FORMULA, "proportional": "ratio", "integral": "ratio", "derivative": "ratio", "most": "ratio",
}  # fmt: skip
"""Numbers of a controller and the kind of each; gains have the unit of its output per unit of what it measures."""

_SHAFT = {"inertia": "inertia", "ratio": "ratio"}
_PARTS: Mapping[str, Mapping[str, str]] = {
    "machine": {"mean_speed": "angular speed", "fluctuation": "ratio"},
    "machine.flywheel": {
        "ratio": "ratio",
        "inertia": "inertia",
        "density": "density",
        "width": "ratio",
        "inner": "ratio",
        "rim_speed": "speed",
    },
    "simulation": {
        "start": "place",
        "speed": "speed",
        "driving": FORMULA,
        "duration": "time",
        "turns": "ratio",
        "tolerance": "ratio",
        "steps": COUNT,
        "samples": COUNT,
    },
    "simulation.motor": {
        "idle_speed": "angular speed",
        "starting_moment": "torque",
        "breakdown_moment": "torque",
        "breakdown_slip": "ratio",
        "ratio": "ratio",
    },
}
"""Numbers of the tables of a machine and of a simulation, and the kind of each."""


class PlaceOfNumber(NamedTuple):
    """A table or list of a description, the key or index in it, and the kind of the number."""

    container: Any
    key: Any
    kind: str


def place_of_number(mechanism: Description, tables: dict[str, Any], path: str) -> PlaceOfNumber:
    """Where the number of a path stands in the tables of a description; raises InputError where there is none."""
    room, _dot, rest = path.partition(".")
    if tables.get(room) is None and room != "simulation":
        what = _("the description has no {room}: {path} is not a number of it")
        raise InputError("", what.format(room=room, path=value_text(path)), _("write one in the description"))
    if room == "gravity":
        return _component(tables, "gravity", rest, path, "acceleration")
    if room in ("stops", "clamps"):
        return _of_contact(mechanism, tables[room], room, rest, path)
    if room == "controllers":
        return _of_controller(mechanism, tables[room], rest, path)
    if room == "loads":
        return _of_load(mechanism, tables["loads"], rest, path)
    return _of_part(mechanism, tables, room, rest, path)


def with_number(place: PlaceOfNumber, value: float | str) -> float | int | str:
    """A value as its key takes it: a formula as a text, a count as a whole number."""
    if isinstance(value, float) and place.kind == FORMULA:
        return repr(value)
    if isinstance(value, float) and place.kind == COUNT and value.is_integer():
        return int(value)
    return value


def kind_of_place(mechanism: Description, place: PlaceOfNumber, path: str) -> str:
    """Kind of quantity ("force", "time", ...) of what stands at a place."""
    if path.startswith("controllers.") and place.kind == FORMULA:
        return "ratio"
    if path.startswith("simulation."):
        drive = mechanism.motion_parameter.drives[0]
        if place.kind == FORMULA:
            return {"N m": "torque", "N": "force"}[drive.force_unit]
        if path == "simulation.start":
            return drive.kind
        if path == "simulation.speed":
            return drive.speed_kind
    return "ratio" if place.kind == COUNT else place.kind


def _of_load(mechanism: Description, tables: list[dict[str, Any]], rest: str, path: str) -> PlaceOfNumber:
    names = numbered_names([load.label for load in mechanism.loads])
    for name in sorted(names, key=len, reverse=True):
        if not rest.startswith(f"{name}."):
            continue
        number = names.index(name)
        table, key, load = tables[number], rest[len(name) + 1 :], mechanism.loads[number]
        if isinstance(load, PointForce):
            vector, _dot, axis = key.partition(".")
            if vector != "vector":
                raise _unknown(path, key, _keys_of(load))
            return _component(table, "vector", axis, path, "force")
        known = KINDS_OF_LOADS[type(load)]
        if key not in known:
            raise _unknown(path, key, _keys_of(load))
        return PlaceOfNumber(table, key, known[key])
    if rest in names:
        # the load is there, and the path says nothing of it
        raise _unknown(path, "", _keys_of(mechanism.loads[names.index(rest)]))
    raise _unknown(path, rest.partition(".")[0], names)


def _of_contact(
    mechanism: Description, tables: list[dict[str, Any]], room: str, rest: str, path: str
) -> PlaceOfNumber:
    """A number of a stop or a clamp, which is named by what results call it."""
    contacts: Sequence[Stop | Clamp] = mechanism.stops if room == "stops" else mechanism.clamps
    names = [contact.label for contact in contacts]
    for name in sorted(names, key=len, reverse=True):
        if not rest.startswith(f"{name}."):
            continue
        number = names.index(name)
        known, key = numbers_of_contact(contacts[number], mechanism.space), rest[len(name) + 1 :]
        if key not in known:
            raise _unknown(path, key, list(known))
        return PlaceOfNumber(tables[number], key, known[key])
    raise _unknown(path, rest if rest in names else rest.partition(".")[0], names)


def _of_controller(
    mechanism: Description, tables: list[dict[str, Any]], rest: str, path: str
) -> PlaceOfNumber:
    """A gain, the target or the bound of a controller, by its name."""
    names = [one.name for one in mechanism.controllers]
    for name in sorted(names, key=len, reverse=True):
        if rest.startswith(f"{name}."):
            key = rest[len(name) + 1 :]
            if key not in NUMBERS_OF_CONTROLLERS:
                raise _unknown(path, key, list(NUMBERS_OF_CONTROLLERS))
            return PlaceOfNumber(tables[names.index(name)], key, NUMBERS_OF_CONTROLLERS[key])
    raise _unknown(path, "" if rest in names else rest.partition(".")[0], names)


def numbers_of_contact(contact: Stop | Clamp, space: str) -> Mapping[str, str]:
    """Numbers of a stop or a clamp, and the kind of each."""
    if isinstance(contact, Clamp):
        return {"until": "time"}
    angular, place = ("angular ", "angle") if contact.measures_angle(space) else ("", "length")
    return {
        "least": place,
        "most": place,
        "restitution": "ratio",
        "stiffness": f"{angular}stiffness",
        "damping": f"{angular}damping",
    }


def _keys_of(load: AnyLoad) -> list[str]:
    """What may stand behind the name of a load."""
    return ["vector.x", "vector.y"] if isinstance(load, PointForce) else list(KINDS_OF_LOADS[type(load)])


def _of_part(
    mechanism: Description, tables: dict[str, Any], room: str, rest: str, path: str
) -> PlaceOfNumber:
    """A number of the machine or of the simulation, of one of its shafts, of its flywheel or of its motor."""
    words = rest.split(".")
    if room == "machine" and words[0] == "shafts":
        return _of_shaft(tables["machine"].get("shafts", []), words[1:], path)
    part, key = ".".join([room, *words[:-1]]), words[-1]
    parts = {name: keys for name, keys in _PARTS.items() if name.startswith(room)}
    if part not in parts or (part == room and key not in parts[room]):
        inner = [name.removeprefix(f"{room}.") for name in parts if name != room]
        # a part that is there is named with the numbers that it has
        numbers = [f"{key}.{one}" for one in parts.get(f"{room}.{key}", ())] if part == room else []
        known = [*_PARTS[room], *inner, *(["shafts"] if room == "machine" else [])]
        raise _unknown(path, "" if numbers else words[0], numbers or known)
    if key not in parts[part]:
        raise _unknown(path, key, list(parts[part]))
    table = tables.get(room)
    if table is None:
        table = tables[room] = {}
    if len(words) > 1:
        if words[0] == "motor" and "motor" not in table:
            what = _("the description has no {room}: {path} is not a number of it")
            raise InputError(
                "", what.format(room=part, path=value_text(path)), _("write one in the description")
            )
        table = table.setdefault(words[0], {})
    if mechanism.motion_parameter.drives or room == "machine":
        return PlaceOfNumber(table, key, parts[part][key])
    raise InputError("", _("{path} needs a drive").format(path=value_text(path)), _("give [[drives]]"))


def _of_shaft(shafts: list[dict[str, Any]], words: list[str], path: str) -> PlaceOfNumber:
    """A shaft by its name, else by its number, counted from 1."""
    names = [str(shaft.get("name") or number) for number, shaft in enumerate(shafts, start=1)]
    shaft, key = ".".join(words[:-1]), words[-1] if words else ""
    if ".".join(words) in names:
        shaft, key = ".".join(words), ""
    if shaft not in names:
        raise _unknown(path, shaft or key, names)
    if key not in _SHAFT:
        raise _unknown(path, key, list(_SHAFT))
    return PlaceOfNumber(shafts[names.index(shaft)], key, _SHAFT[key])


def _component(table: dict[str, Any], key: str, axis: str, path: str, kind: str) -> PlaceOfNumber:
    """A component of a vector in a table."""
    table[key] = list(table[key])
    axes = "xyz"[: len(table[key])]
    if len(axis) != 1 or axis not in axes:
        raise _unknown(path, axis or key, [f"{key}.{one}" for one in axes])
    return PlaceOfNumber(table[key], axes.index(axis), kind)


def _unknown(path: str, word: str, known: Sequence[str]) -> InputError:
    what = _("there is no {word} in the path {path}").format(word=value_text(word), path=value_text(path))
    return InputError("", what, nearest(word, list(known)))
