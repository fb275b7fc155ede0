"""JSON Schema of the description, for editors that complete and check TOML files."""

from __future__ import annotations

from centrode.laws import MOST_DEGREE, SEGMENT_CURVES
from centrode.model import limits, segments
from centrode.model.asked import REACHABLE, Assembly, Display, Study
from centrode.model.bodies import RING_AND_POINT, SHAPES, Frame, Link
from centrode.model.description import Description
from centrode.model.driving import Drive
from centrode.model.loads import FITS, FORMS, KINDS, Load
from centrode.model.machines import SHAFTS, FlywheelShape, Machine, Shaft
from centrode.model.pairs import Gear, Guide, Rolling, Track
from centrode.model.part import Part
from centrode.model.reports import LEAST_DIGITS, MOST_CHAPTERS, MOST_DIGITS, ReportWishes
from centrode.model.schema_parts import (
    AMOUNT,
    NAME,
    TEXT,
    Schema,
    above_zero,
    list_of,
    quantity_schema,
    reference_to,
    schema_of,
    table_of,
)
from centrode.model.segments import Segment
from centrode.model.simulations import MOST_STEPS, SCHEMES, Motor, Simulation

CHAPTERS = list_of(NAME, 0, MOST_CHAPTERS)
REPORT_DIGITS: Schema = {"type": "integer", "minimum": LEAST_DIGITS, "maximum": MOST_DIGITS}
_NAMES = list_of(NAME, 2, 2)
_COORDINATES = list_of(quantity_schema("length"), 2, 3)
_PAIR = list_of(quantity_schema("ratio"), 2, 2)
_HEADING = list_of(quantity_schema("ratio"), 2, 3)
_MOMENTS = list_of(quantity_schema("inertia"), 3, 3)
_INERTIA: Schema = {"anyOf": [*quantity_schema("inertia")["anyOf"], _MOMENTS, list_of(_MOMENTS, 3, 3)]}
_PLACED: Schema = {
    "type": "object",
    "properties": {"placed": _COORDINATES},
    "required": ["placed"],
    "additionalProperties": False,
}
_POSITION: Schema = {"anyOf": [_COORDINATES, {"const": "placed"}, _PLACED]}
_THROUGH: Schema = {"anyOf": [_COORDINATES, {"const": "placed"}, _PLACED, NAME]}
_DIRECTION: Schema = {"anyOf": [_PAIR, *quantity_schema("angle")["anyOf"]]}
_POINTS: Schema = {"anyOf": [table_of(_COORDINATES, limits.POINTS), list_of(NAME, 1, 2)]}
_SIDES: Schema = {"enum": ["left", "right", "ahead", "behind"]}

PROPERTIES: dict[type[Part], Schema] = {
    Display: {"length": TEXT, "angle": TEXT},
    Frame: {"points": table_of(_POSITION, limits.POINTS)},
    Link: {
        "points": _POINTS,
        "length": above_zero("length"),
        "angle": quantity_schema("angle"),
        "mass": quantity_schema("mass"),
        "centre": {"anyOf": [_COORDINATES, NAME]},
        "inertia": _INERTIA,
        "shape": {"enum": list(SHAPES)},
        "radius": above_zero("length"),
        "centre_radius": quantity_schema("length"),
        "model": {"enum": [RING_AND_POINT]},
        "reference": _NAMES,
    },
    Guide: {
        "point": NAME,
        "on": NAME,
        "through": _THROUGH,
        "direction": _DIRECTION,
        "link": NAME,
        "angle": quantity_schema("angle"),
        "name": NAME,
        "pole": _THROUGH,
        "radius": above_zero("arc"),
    },
    Gear: {"links": _NAMES, "ratio": quantity_schema("ratio"), "carrier": NAME, "name": NAME},
    Track: {
        "through": _COORDINATES,
        "direction": _DIRECTION,
        "centre": _THROUGH,
        "radius": above_zero("length"),
        "inside": {"type": "boolean"},
    },
    Rolling: {
        "link": NAME,
        "centre": NAME,
        "radius": above_zero("length"),
        "along": reference_to(Track),
        "on": NAME,
        "name": NAME,
    },
    Drive: {
        "link": NAME,
        "guide": NAME,
        "distance": _NAMES,
        "relative_to": NAME,
        "start": AMOUNT,
        "speed": AMOUNT,
        "law": {**TEXT, "description": "a formula in t [s], such as 0.3*sin(2*t)"},
        "table": {"anyOf": [TEXT, list_of(list_of(AMOUNT, 2, 2), 2, limits.TABLE_ROWS)]},
        "segments": list_of(reference_to(Segment), 1, segments.MOST),
        "repeat": {"type": "boolean"},
        "cam": {
            "anyOf": [TEXT, {"type": "object"}],
            "description": "a cam's file, a built-in cam, or its tables",
        },
        "cam_speed": above_zero("angular speed"),
        "cam_angle": quantity_schema("angle"),
        "cam_point": NAME,
        "lowers": {"type": "boolean"},
    },
    Segment: {
        "to": AMOUNT,
        "time": above_zero("time"),
        "curve": {"enum": list(SEGMENT_CURVES)},
        **dict.fromkeys((*segments.AT_START, *segments.AT_END), AMOUNT),
        "through": list_of(list_of(AMOUNT, 2, 2), 0, max(segments.MOST_THROUGH.values())),
        "degree": {"type": "integer", "minimum": 1, "maximum": MOST_DEGREE},
    },
    Assembly: {"sides": table_of(_SIDES, limits.POINTS), "continuation": {"enum": ["smooth", "keep"]}},
    Load: {
        "kind": {"enum": list(KINDS)},
        "name": NAME,
        "point": NAME,
        "link": NAME,
        "guide": NAME,
        "points": _NAMES,
        "vector": list_of(AMOUNT, 2, 3),
        "axes": NAME,
        "value": AMOUNT,
        "table": {"anyOf": [TEXT, list_of(list_of(AMOUNT, 2, 3), 2, limits.TABLE_ROWS)]},
        "stiffness": quantity_schema("stiffness"),
        "damping": quantity_schema("damping"),
        "viscous": quantity_schema("damping"),
        "quadratic": quantity_schema("quadratic damping"),
        "coefficient": quantity_schema("ratio"),
        "radius": above_zero("length"),
        "fit": {"enum": list(FITS)},
        "pin": NAME,
        **dict.fromkeys(("length", "height"), above_zero("length")),
        "form": {"enum": list(FORMS)},
        "free_length": quantity_schema("length"),
        "free_angle": quantity_schema("angle"),
        "relative_to": NAME,
        "axis": {"anyOf": [NAME, _HEADING]},
        "while_moving": _HEADING,
    },
    Machine: {
        "mean_speed": above_zero("angular speed"),
        "fluctuation": above_zero("ratio"),
        "shafts": list_of(reference_to(Shaft), 0, SHAFTS),
        "flywheel": reference_to(FlywheelShape),
        "driving": {**TEXT, "description": "a formula in q [rad] and v [rad/s]"},
    },
    Shaft: {"inertia": quantity_schema("inertia"), "ratio": quantity_schema("ratio"), "name": TEXT},
    FlywheelShape: {
        "ratio": quantity_schema("ratio"),
        "density": above_zero("density"),
        "width": above_zero("ratio"),
        "inner": quantity_schema("ratio"),
        "rim_speed": above_zero("speed"),
    },
    Motor: {
        "kind": {"enum": ["linear", "asynchronous"]},
        "idle_speed": above_zero("angular speed"),
        "starting_moment": above_zero("torque"),
        "breakdown_moment": above_zero("torque"),
        "breakdown_slip": above_zero("ratio"),
        "ratio": above_zero("ratio"),
    },
    Simulation: {
        "start": AMOUNT,
        "speed": AMOUNT,
        "driving": {**TEXT, "description": "a formula in t [s], q and v"},
        "motor": reference_to(Motor),
        "duration": above_zero("time"),
        "turns": above_zero("ratio"),
        "scheme": {"enum": list(SCHEMES)},
        "steps": {"type": "integer", "minimum": 1, "maximum": MOST_STEPS},
        "tolerance": above_zero("ratio"),
        "samples": {"type": "integer", "minimum": 2, "maximum": limits.SAMPLES},
    },
    Study: {
        "samples": {"type": "integer", "minimum": 1, "maximum": limits.SAMPLES},
        "instants": list_of(AMOUNT, 0, limits.INSTANTS),
        "from": AMOUNT,
        "to": AMOUNT,
        "range": {"enum": [REACHABLE]},
    },
    ReportWishes: {
        "chapters": CHAPTERS,
        "instants": list_of(AMOUNT, 0, limits.INSTANTS),
        "points": list_of(NAME, 0, limits.POINTS),
        "digits": REPORT_DIGITS,
    },
    Description: {
        "title": TEXT,
        "space": {"enum": ["plane", "sphere"]},
        "gravity": list_of(quantity_schema("acceleration"), 2, 3),
        "radius": above_zero("length"),
        "display": reference_to(Display),
        "frame": reference_to(Frame),
        "links": table_of(reference_to(Link), limits.LINKS),
        "guides": list_of(reference_to(Guide), 0, limits.GUIDES),
        "gears": list_of(reference_to(Gear), 0, limits.LINKS),
        "rolling": list_of(reference_to(Rolling), 0, limits.LINKS),
        "drives": list_of(reference_to(Drive), 0, limits.DRIVES),
        "assembly": reference_to(Assembly),
        "loads": list_of(reference_to(Load), 0, limits.LOADS),
        "machine": reference_to(Machine),
        "simulation": reference_to(Simulation),
        "study": reference_to(Study),
        "report": reference_to(ReportWishes),
    },
}
"""Keys of every part as a file spells them; a test compares them with the parts themselves."""


def mechanism_schema() -> Schema:
    """JSON Schema (draft 2020-12) of a description's file; what parts say about each other is not in it."""
    return schema_of("centrode mechanism", Description, PROPERTIES)
