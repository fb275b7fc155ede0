"""JSON Schema of the description, for editors that complete and check TOML files."""

from __future__ import annotations

from typing import Any

from centrode.laws import SEGMENT_CURVES
from centrode.model import limits, segments
from centrode.model.asked import Assembly, Display, Study
from centrode.model.bodies import RING_AND_POINT, SHAPES, Frame, Link
from centrode.model.description import Description
from centrode.model.driving import Drive
from centrode.model.loads import FITS, FORMS, KINDS, Load
from centrode.model.machines import SHAFTS, FlywheelShape, Machine, Shaft
from centrode.model.pairs import Gear, Guide, Rolling, Track
from centrode.model.part import Part
from centrode.model.segments import Segment
from centrode.model.simulations import MOST_STEPS, SCHEMES, Motor, Simulation
from centrode.model.units import KINDS as QUANTITIES

Schema = dict[str, Any]


def _quantity(kind: str) -> Schema:
    """A number in SI, or a text with a unit."""
    named = QUANTITIES[kind]
    text = f"{named.name} in {named.unit}, or a text with a unit" if named.unit else named.name
    bounded = {"type": "string", "maxLength": limits.QUANTITY_LENGTH}
    return {"description": text, "anyOf": [{"type": "number"}, bounded]}


def _above_zero(kind: str) -> Schema:
    schema = _quantity(kind)
    schema["anyOf"][0] = {"type": "number", "exclusiveMinimum": 0}
    return schema


def _list(item: Schema, least: int, most: int) -> Schema:
    return {"type": "array", "items": item, "minItems": least, "maxItems": most}


def _table(entry: Schema, most: int) -> Schema:
    return {"type": "object", "additionalProperties": entry, "maxProperties": most}


def _ref(part: type[Part]) -> Schema:
    return {"$ref": f"#/$defs/{part.__name__}"}


_NAME: Schema = {"type": "string", "minLength": 1, "maxLength": limits.NAME_LENGTH}
_TEXT: Schema = {"type": "string", "maxLength": limits.TEXT_LENGTH}
_NAMES = _list(_NAME, 2, 2)
_COORDINATES = _list(_quantity("length"), 2, 3)
_PAIR = _list(_quantity("ratio"), 2, 2)
_HEADING = _list(_quantity("ratio"), 2, 3)
_MOMENTS = _list(_quantity("inertia"), 3, 3)
_INERTIA: Schema = {"anyOf": [*_quantity("inertia")["anyOf"], _MOMENTS, _list(_MOMENTS, 3, 3)]}
_PLACED: Schema = {
    "type": "object",
    "properties": {"placed": _COORDINATES},
    "required": ["placed"],
    "additionalProperties": False,
}
_POSITION: Schema = {"anyOf": [_COORDINATES, {"const": "placed"}, _PLACED]}
_THROUGH: Schema = {"anyOf": [_COORDINATES, {"const": "placed"}, _PLACED, _NAME]}
_DIRECTION: Schema = {"anyOf": [_PAIR, *_quantity("angle")["anyOf"]]}
_AMOUNT: Schema = {
    "anyOf": [{"type": "number"}, _TEXT],
    "description": "a number in SI, a text with a unit, a formula",
}
_POINTS: Schema = {"anyOf": [_table(_COORDINATES, limits.POINTS), _list(_NAME, 1, 2)]}
_SIDES: Schema = {"enum": ["left", "right", "ahead", "behind"]}

PROPERTIES: dict[type[Part], Schema] = {
    Display: {"length": _TEXT, "angle": _TEXT},
    Frame: {"points": _table(_POSITION, limits.POINTS)},
    Link: {
        "points": _POINTS,
        "length": _above_zero("length"),
        "angle": _quantity("angle"),
        "mass": _quantity("mass"),
        "centre": {"anyOf": [_COORDINATES, _NAME]},
        "inertia": _INERTIA,
        "shape": {"enum": list(SHAPES)},
        "radius": _above_zero("length"),
        "centre_radius": _quantity("length"),
        "model": {"enum": [RING_AND_POINT]},
        "reference": _NAMES,
    },
    Guide: {
        "point": _NAME,
        "on": _NAME,
        "through": _THROUGH,
        "direction": _DIRECTION,
        "link": _NAME,
        "angle": _quantity("angle"),
        "name": _NAME,
        "pole": _THROUGH,
        "radius": _above_zero("arc"),
    },
    Gear: {"links": _NAMES, "ratio": _quantity("ratio"), "carrier": _NAME, "name": _NAME},
    Track: {
        "through": _COORDINATES,
        "direction": _DIRECTION,
        "centre": _THROUGH,
        "radius": _above_zero("length"),
        "inside": {"type": "boolean"},
    },
    Rolling: {
        "link": _NAME,
        "centre": _NAME,
        "radius": _above_zero("length"),
        "along": _ref(Track),
        "on": _NAME,
        "name": _NAME,
    },
    Drive: {
        "link": _NAME,
        "guide": _NAME,
        "distance": _NAMES,
        "relative_to": _NAME,
        "start": _AMOUNT,
        "speed": _AMOUNT,
        "law": {**_TEXT, "description": "a formula in t [s], such as 0.3*sin(2*t)"},
        "table": {"anyOf": [_TEXT, _list(_list(_AMOUNT, 2, 2), 2, limits.TABLE_ROWS)]},
        "segments": _list(_ref(Segment), 1, segments.MOST),
        "repeat": {"type": "boolean"},
    },
    Segment: {
        "to": _AMOUNT,
        "time": _above_zero("time"),
        "curve": {"enum": list(SEGMENT_CURVES)},
        **dict.fromkeys((*segments.AT_START, *segments.AT_END), _AMOUNT),
        "through": _list(_list(_AMOUNT, 2, 2), 0, segments.MOST_THROUGH),
    },
    Assembly: {"sides": _table(_SIDES, limits.POINTS), "continuation": {"enum": ["smooth", "keep"]}},
    Load: {
        "kind": {"enum": list(KINDS)},
        "name": _NAME,
        "point": _NAME,
        "link": _NAME,
        "guide": _NAME,
        "points": _NAMES,
        "vector": _list(_AMOUNT, 2, 3),
        "axes": _NAME,
        "value": _AMOUNT,
        "table": {"anyOf": [_TEXT, _list(_list(_AMOUNT, 2, 3), 2, limits.TABLE_ROWS)]},
        "stiffness": _quantity("stiffness"),
        "damping": _quantity("damping"),
        "viscous": _quantity("damping"),
        "quadratic": _quantity("quadratic damping"),
        "coefficient": _quantity("ratio"),
        "radius": _above_zero("length"),
        "fit": {"enum": list(FITS)},
        "pin": _NAME,
        **dict.fromkeys(("length", "height"), _above_zero("length")),
        "form": {"enum": list(FORMS)},
        "free_length": _quantity("length"),
        "free_angle": _quantity("angle"),
        "relative_to": _NAME,
        "axis": {"anyOf": [_NAME, _HEADING]},
        "while_moving": _HEADING,
    },
    Machine: {
        "mean_speed": _above_zero("angular speed"),
        "fluctuation": _above_zero("ratio"),
        "shafts": _list(_ref(Shaft), 0, SHAFTS),
        "flywheel": _ref(FlywheelShape),
        "driving": {**_TEXT, "description": "a formula in q [rad] and v [rad/s]"},
    },
    Shaft: {"inertia": _quantity("inertia"), "ratio": _quantity("ratio"), "name": _TEXT},
    FlywheelShape: {
        "ratio": _quantity("ratio"),
        "density": _above_zero("density"),
        "width": _above_zero("ratio"),
        "inner": _quantity("ratio"),
        "rim_speed": _above_zero("speed"),
    },
    Motor: {
        "kind": {"enum": ["linear", "asynchronous"]},
        "idle_speed": _above_zero("angular speed"),
        "starting_moment": _above_zero("torque"),
        "breakdown_moment": _above_zero("torque"),
        "breakdown_slip": _above_zero("ratio"),
        "ratio": _above_zero("ratio"),
    },
    Simulation: {
        "start": _AMOUNT,
        "speed": _AMOUNT,
        "driving": {**_TEXT, "description": "a formula in t [s], q and v"},
        "motor": _ref(Motor),
        "duration": _above_zero("time"),
        "turns": _above_zero("ratio"),
        "scheme": {"enum": list(SCHEMES)},
        "steps": {"type": "integer", "minimum": 1, "maximum": MOST_STEPS},
        "tolerance": _above_zero("ratio"),
        "samples": {"type": "integer", "minimum": 2, "maximum": limits.SAMPLES},
    },
    Study: {
        "samples": {"type": "integer", "minimum": 1, "maximum": limits.SAMPLES},
        "instants": _list(_AMOUNT, 0, limits.INSTANTS),
        "from": _AMOUNT,
        "to": _AMOUNT,
    },
    Description: {
        "title": _TEXT,
        "space": {"enum": ["plane", "sphere"]},
        "gravity": _list(_quantity("acceleration"), 2, 3),
        "radius": _above_zero("length"),
        "display": _ref(Display),
        "frame": _ref(Frame),
        "links": _table(_ref(Link), limits.LINKS),
        "guides": _list(_ref(Guide), 0, limits.GUIDES),
        "gears": _list(_ref(Gear), 0, limits.LINKS),
        "rolling": _list(_ref(Rolling), 0, limits.LINKS),
        "drives": _list(_ref(Drive), 0, limits.DRIVES),
        "assembly": _ref(Assembly),
        "loads": _list(_ref(Load), 0, limits.LOADS),
        "machine": _ref(Machine),
        "simulation": _ref(Simulation),
        "study": _ref(Study),
    },
}
"""Keys of every part as a file spells them; a test compares them with the parts themselves."""


def mechanism_schema() -> Schema:
    """JSON Schema (draft 2020-12) of a description's file; what parts say about each other is not in it."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "centrode mechanism",
        **_object(Description),
        "$defs": {part.__name__: _object(part) for part in PROPERTIES if part is not Description},
    }


def _object(part: type[Part]) -> Schema:
    required = [key for key, name in part.keys().items() if part.model_fields[name].is_required()]
    schema: Schema = {"type": "object", "properties": PROPERTIES[part], "additionalProperties": False}
    return {**schema, "required": required} if required else schema
