"""JSON Schema of the description, for editors that complete and check TOML files."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from centrode import laws
from centrode.laws import MOST_DEGREE, SEGMENT_CURVES
from centrode.model import reading, segments
from centrode.model.cam import (
    CONSTANT,
    LAWS,
    LEAST_LEGS,
    LETTER,
    MEASURED,
    MINIMISED,
    MOST_LEGS,
    MOST_TERMS,
    PARAMETERS,
    POINT,
    Cam,
    CamContact,
    CamMover,
    CamStudy,
    Choose,
    Curvature,
    Material,
    NumberRange,
    Return,
    Roller,
    Start,
)
from centrode.model.contacts import DOINGS, MOST_CONTACTS, Clamp, EventCondition, Stop
from centrode.model.description import Description
from centrode.model.drives import Drive
from centrode.model.explanatory_note import (
    FIRST_YEAR,
    LAST_YEAR,
    LINE_LENGTH,
    MOST_SOURCES,
    PROSE_LENGTH,
    SOURCE_LENGTH,
    TitlePage,
)
from centrode.model.follower_cam import (
    CONTACTS,
    MOST,
    MOST_RATES,
    TURNS,
    CamBody,
    Follower,
    FollowerBounds,
    FollowerStudy,
    LiftSegment,
    PlateCam,
    Spring,
    Tool,
)
from centrode.model.follower_cam import KINDS as FOLLOWER_KINDS
from centrode.model.gear_pairs import (
    APPLICATIONS,
    FEWEST_TEETH,
    KIND,
    MOST_TEETH,
    PURPOSES,
    RACK,
    GearPair,
    Rack,
)
from centrode.model.gear_trains import FEWEST_TEETH as FEWEST_IN_TRAIN
from centrode.model.gear_trains import KIND as TRAIN_KIND
from centrode.model.gear_trains import (
    MOST_PLANETS,
    TRAIN_SCHEMES,
    GearTrain,
    MeshLosses,
)
from centrode.model.gear_trains import MOST_TEETH as MOST_IN_TRAIN
from centrode.model.gears import Gear
from centrode.model.links import (
    MASSES,
    RING_AND_POINT,
    SHAPES,
    Frame,
    Guide,
    Link,
    PartMass,
    Rolling,
    Track,
)
from centrode.model.loads import FITS, FORMS, KINDS, OVER, STROKE_ENDS, Load
from centrode.model.motors import (
    MOST_CONTROLLERS,
    MOST_STATES,
    MOTOR_KINDS,
    TARGETS,
    Controller,
    ControllerState,
    DriveMotor,
)
from centrode.model.motors import MOST_ROWS as MOST_MOTOR_ROWS
from centrode.model.page_standards import STANDARDS
from centrode.model.reading import DescriptionPart
from centrode.model.segments import MOST_THROUGH, Segment
from centrode.model.settings import (
    AGAINST,
    ALONG,
    LEAST_DIGITS,
    LEAST_ROWS,
    MOST_CHAPTERS,
    MOST_DIGITS,
    MOST_POSITIONS,
    MOST_RK4_STEPS,
    MOST_ROWS,
    REACHABLE,
    SHAFTS,
    Assembly,
    CamReportWishes,
    ChapterText,
    ChosenCoordinate,
    Display,
    FlywheelShape,
    GearReportWishes,
    Machine,
    ReportWishes,
    Shaft,
    Study,
)
from centrode.model.simulation import EQUATIONS, MOST_STEPS, SCHEMES, Motor, Simulation
from centrode.model.tolerances import (
    DISTRIBUTIONS,
    MOST_OUTPUTS,
    MOST_PATHS,
    Clearance,
    Correlation,
    ToleranceOutput,
    Tolerances,
)
from centrode.model.units import KINDS as QUANTITIES
from centrode.numerics.text_formula import TEXT_LENGTH
from centrode.quantities import ANGULAR_ACCELERATIONS, ANGULAR_VELOCITIES

# What schemas of descriptions are made of: quantities, names, lists, tables, and the whole of one.

Schema = dict[str, Any]


def quantity_schema(kind: str) -> Schema:
    """A number in SI, or a text with a unit."""
    named = QUANTITIES[kind]
    text = f"{named.name} in {named.unit}, or a text with a unit" if named.unit else named.name
    bounded = {"type": "string", "maxLength": reading.QUANTITY_LENGTH}
    return {"description": text, "anyOf": [{"type": "number"}, bounded]}


def above_zero(kind: str) -> Schema:
    """The same, positive where it is a number."""
    schema = quantity_schema(kind)
    schema["anyOf"][0] = {"type": "number", "exclusiveMinimum": 0}
    return schema


def list_of(item: Schema, least: int, most: int) -> Schema:
    """A list with bounds of its length."""
    return {"type": "array", "items": item, "minItems": least, "maxItems": most}


def table_of(entry: Schema, most: int) -> Schema:
    """A table of at most so many entries of one kind."""
    return {"type": "object", "additionalProperties": entry, "maxProperties": most}


def reference_to(part: type[DescriptionPart]) -> Schema:
    """Where the schema of a part stands."""
    return {"$ref": f"#/$defs/{part.__name__}"}


NAME: Schema = {"type": "string", "minLength": 1, "maxLength": reading.NAME_LENGTH}
TEXT: Schema = {"type": "string", "maxLength": reading.TEXT_LENGTH}
AMOUNT: Schema = {
    "anyOf": [{"type": "number"}, TEXT],
    "description": "a number in SI, a text with a unit, a formula",
}


FOLLOWING = {(LiftSegment, "angle")}
"""Keys that every part has, but that may follow from others: the angle of a segment from its share or its time."""


def schema_of(
    title: str, whole: type[DescriptionPart], properties: Mapping[type[DescriptionPart], Schema]
) -> Schema:
    """JSON Schema of a file that one part describes, with the parts inside it as definitions."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": title,
        **_object(whole, properties),
        "$defs": {part.__name__: _object(part, properties) for part in properties if part is not whole},
    }


def _object(part: type[DescriptionPart], properties: Mapping[type[DescriptionPart], Schema]) -> Schema:
    required = [
        key
        for key, name in part.keys().items()
        if name in part.model_fields and part.model_fields[name].is_required()
        if (part, key) not in FOLLOWING
    ]
    schema: Schema = {"type": "object", "properties": properties[part], "additionalProperties": False}
    if part.among_keys:
        # entries of that field stand among the keys
        schema["additionalProperties"] = properties[part][part.among_keys]["additionalProperties"]
    return {**schema, "required": required} if required else schema


CHAPTERS = list_of(NAME, 0, MOST_CHAPTERS)
CHAPTER_TEXT: dict[str, Schema] = {
    key: {"type": "string", "maxLength": PROSE_LENGTH} for key in ("before", "after")
}
REPORT_DIGITS: Schema = {"type": "integer", "minimum": LEAST_DIGITS, "maximum": MOST_DIGITS}
_LINE: Schema = {"type": "string", "minLength": 1, "maxLength": LINE_LENGTH}
_PARAGRAPHS: Schema = {
    "type": "string",
    "minLength": 1,
    "maxLength": PROSE_LENGTH,
    "description": "paragraphs in Markdown",
}
TITLE_PAGE: dict[str, Schema] = {
    **dict.fromkeys(("ministry", "institution", "faculty", "department", "work", "course", "title"), _LINE),
    "variant": {"anyOf": [{"type": "integer"}, _LINE]},
    **dict.fromkeys(("author", "group", "teacher", "city"), _LINE),
    "year": {"type": "integer", "minimum": FIRST_YEAR, "maximum": LAST_YEAR},
    "designation": _LINE,
}
NOTE: dict[str, Schema] = {
    "standard": {"enum": list(STANDARDS)},
    "title_page": reference_to(TitlePage),
    **dict.fromkeys(("task", "abstract", "introduction", "conclusions"), _PARAGRAPHS),
    "sources": list_of({"type": "string", "minLength": 1, "maxLength": SOURCE_LENGTH}, 0, MOST_SOURCES),
}
_NAMES = list_of(NAME, 2, 2)
_COORDINATES = list_of(quantity_schema("length"), 2, 3)
_PAIR = list_of(quantity_schema("ratio"), 2, 2)
_HEADING = list_of(quantity_schema("ratio"), 2, 3)
_MEASURED: Schema = {
    **dict.fromkeys(("name", "link", "guide"), NAME),
    "points": _NAMES,
    "point": NAME,
    "direction": _HEADING,
    "relative_to": NAME,
}
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
_POINTS: Schema = {"anyOf": [table_of(_COORDINATES, reading.POINTS), list_of(NAME, 1, reading.POINTS)]}
_SIDES: Schema = {"enum": ["left", "right", "ahead", "behind"]}

_LIMITS: Schema = {
    "anyOf": [
        {"type": "number", "minimum": 0},
        {"type": "string", "maxLength": reading.QUANTITY_LENGTH},
        list_of(AMOUNT, 2, 2),
    ],
    "description": 'limits "±0.1 mm" or [lower, upper], or a class of ISO 286 such as "H7"',
}
_PATHS_WITH_LIMITS: Schema = {
    "type": "object",
    "additionalProperties": {"anyOf": [*_LIMITS["anyOf"], {"type": "object"}]},
    "maxProperties": MOST_PATHS,
}

PROPERTIES: dict[type[DescriptionPart], Schema] = {
    Display: {
        "length": TEXT,
        "angle": TEXT,
        "angular_velocity": {"enum": list(ANGULAR_VELOCITIES)},
        "angular_acceleration": {"enum": list(ANGULAR_ACCELERATIONS)},
    },
    Frame: {"points": {"anyOf": [table_of(_POSITION, reading.POINTS), list_of(NAME, 0, reading.POINTS)]}},
    Link: {
        "points": _POINTS,
        "length": above_zero("length"),
        "angle": quantity_schema("angle"),
        "mass": quantity_schema("mass"),
        "centre": {"anyOf": [_COORDINATES, NAME]},
        "inertia": _INERTIA,
        "shape": {"enum": list(SHAPES)},
        "radius": above_zero("length"),
        "masses": list_of(reference_to(PartMass), 0, MASSES),
        "centre_radius": quantity_schema("length"),
        "model": {"enum": [RING_AND_POINT]},
        "reference": _NAMES,
    },
    PartMass: {
        "mass": quantity_schema("mass"),
        "at": {"anyOf": [_COORDINATES, NAME]},
        "inertia": quantity_schema("inertia"),
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
    Gear: {
        "links": _NAMES,
        "ratio": quantity_schema("ratio"),
        "carrier": NAME,
        "pair": {"anyOf": [NAME, {"type": "object"}]},
        "name": NAME,
    },
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
        "table": {"anyOf": [TEXT, list_of(list_of(AMOUNT, 2, 2), 2, reading.TABLE_ROWS)]},
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
    Assembly: {"sides": table_of(_SIDES, reading.POINTS), "continuation": {"enum": ["smooth", "keep"]}},
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
        "over": {"enum": list(OVER)},
        "measured_from": {"enum": list(STROKE_ENDS)},
        "pressure": quantity_schema("pressure"),
        "diameter": above_zero("length"),
        "table": {"anyOf": [TEXT, list_of(list_of(AMOUNT, 2, 3), 2, reading.TABLE_ROWS)]},
        "stiffness": quantity_schema("stiffness"),
        "damping": quantity_schema("damping"),
        "viscous": quantity_schema("damping"),
        "quadratic": quantity_schema("quadratic damping"),
        "static": AMOUNT,
        "surface_speed": quantity_schema("speed"),
        "coefficient": quantity_schema("ratio"),
        "static_coefficient": quantity_schema("ratio"),
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
    Stop: {
        **_MEASURED,
        **dict.fromkeys(("least", "most"), AMOUNT),
        "restitution": {"type": "number", "minimum": 0, "maximum": 1},
        "stiffness": above_zero("stiffness"),
        "damping": quantity_schema("damping"),
    },
    Clamp: {**_MEASURED, "until": AMOUNT},
    EventCondition: {
        **_MEASURED,
        "when": {**TEXT, "description": "a formula in t [s], x and v that passes zero"},
        "do": {"enum": list(DOINGS)},
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
        "inertia": above_zero("inertia"),
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
    DriveMotor: {
        "kind": {"enum": list(MOTOR_KINDS)},
        "idle_speed": above_zero("angular speed"),
        "starting_moment": above_zero("torque"),
        "breakdown_moment": above_zero("torque"),
        "breakdown_slip": above_zero("ratio"),
        "ratio": above_zero("ratio"),
        "drive": NAME,
        "voltage": quantity_schema("ratio"),
        "resistance": above_zero("ratio"),
        "constant": above_zero("ratio"),
        "table": {"anyOf": [TEXT, list_of(list_of(AMOUNT, 2, 2), 2, MOST_MOTOR_ROWS)]},
    },
    ControllerState: {"rate": {**TEXT, "description": "a formula"}, "start": quantity_schema("ratio")},
    Controller: {
        **dict.fromkeys(("name", "drive", "measures"), NAME),
        "target": AMOUNT,
        "of": {"enum": list(TARGETS)},
        **dict.fromkeys(("proportional", "integral", "derivative"), quantity_schema("ratio")),
        "value": AMOUNT,
        "states": table_of({"anyOf": [TEXT, reference_to(ControllerState)]}, MOST_STATES),
        "most": above_zero("ratio"),
    },
    Simulation: {
        "start": AMOUNT,
        "speed": AMOUNT,
        "speeds": {
            "type": "object",
            "description": "paths of links, guides, drives and points -> their speed at the start",
        },
        "keeps": list_of(NAME, 0, reading.DRIVES),
        "equations": {"enum": list(EQUATIONS)},
        "driving": {**TEXT, "description": "a formula in t [s], q and v"},
        "motor": reference_to(Motor),
        "duration": above_zero("time"),
        "turns": above_zero("ratio"),
        "scheme": {"enum": list(SCHEMES)},
        "steps": {"type": "integer", "minimum": 1, "maximum": MOST_STEPS},
        "tolerance": above_zero("ratio"),
        "samples": {"type": "integer", "minimum": 2, "maximum": reading.SAMPLES},
        "at": list_of(quantity_schema("time"), 0, reading.SAMPLES),
    },
    Study: {
        "samples": {"type": "integer", "minimum": 1, "maximum": reading.SAMPLES},
        "instants": list_of(AMOUNT, 0, reading.INSTANTS),
        "from": AMOUNT,
        "to": AMOUNT,
        "range": {"enum": [REACHABLE]},
        "coordinate": reference_to(ChosenCoordinate),
    },
    ChosenCoordinate: {
        "link": NAME,
        "guide": NAME,
        "zero": AMOUNT,
        "sense": {"enum": [*ALONG, *AGAINST]},
    },
    ChapterText: CHAPTER_TEXT,
    TitlePage: TITLE_PAGE,
    ReportWishes: {
        **NOTE,
        "chapters": CHAPTERS,
        "instants": list_of(AMOUNT, 0, reading.INSTANTS),
        "points": list_of(NAME, 0, reading.POINTS),
        "digits": REPORT_DIGITS,
        "rows": {"type": "integer", "minimum": LEAST_ROWS, "maximum": MOST_ROWS},
        "positions": {"type": "integer", "minimum": 2, "maximum": MOST_POSITIONS},
        "rk4_steps": {"type": "integer", "minimum": 1, "maximum": MOST_RK4_STEPS},
        "angle_step": above_zero("angle"),
        "least_transmission_angle": above_zero("angle"),
        "greatest_change": above_zero("ratio"),
        "full": {"type": "boolean"},
        "motion": {"enum": ["real", "mean"]},
        "text": table_of(reference_to(ChapterText), MOST_CHAPTERS),
    },
    Description: {
        "title": TEXT,
        "space": {"enum": ["plane", "sphere"]},
        "gravity": list_of(quantity_schema("acceleration"), 2, 3),
        "radius": above_zero("length"),
        "display": reference_to(Display),
        "points": table_of(_COORDINATES, reading.POINTS),
        "frame": reference_to(Frame),
        "links": table_of(reference_to(Link), reading.LINKS),
        "guides": list_of(reference_to(Guide), 0, reading.GUIDES),
        "gears": list_of(reference_to(Gear), 0, reading.LINKS),
        "rolling": list_of(reference_to(Rolling), 0, reading.LINKS),
        "drives": list_of(reference_to(Drive), 0, reading.DRIVES),
        "assembly": reference_to(Assembly),
        "loads": list_of(reference_to(Load), 0, reading.LOADS),
        "stops": list_of(reference_to(Stop), 0, MOST_CONTACTS),
        "clamps": list_of(reference_to(Clamp), 0, MOST_CONTACTS),
        "events": list_of(reference_to(EventCondition), 0, MOST_CONTACTS),
        "motors": list_of(reference_to(DriveMotor), 0, reading.DRIVES),
        "controllers": list_of(reference_to(Controller), 0, MOST_CONTROLLERS),
        "machine": reference_to(Machine),
        "simulation": reference_to(Simulation),
        "study": reference_to(Study),
        "report": reference_to(ReportWishes),
        "tolerances": reference_to(Tolerances),
    },
    Tolerances: {
        "default": _LIMITS,
        "distribution": {"enum": list(DISTRIBUTIONS)},
        "dimensions": _PATHS_WITH_LIMITS,
        "clearances": table_of(
            {"anyOf": [*above_zero("length")["anyOf"], reference_to(Clearance)]}, reading.POINTS
        ),
        "correlations": list_of(reference_to(Correlation), 0, MOST_PATHS),
        "outputs": table_of(
            {"anyOf": [{"type": "string", "maxLength": TEXT_LENGTH}, reference_to(ToleranceOutput)]},
            MOST_OUTPUTS,
        ),
    },
    Clearance: {"play": above_zero("length"), "length": above_zero("length")},
    Correlation: {
        "paths": list_of(TEXT, 2, MOST_PATHS),
        "value": {"type": "number", "minimum": -1, "maximum": 1},
    },
    ToleranceOutput: {
        "formula": {"type": "string", "minLength": 1, "maxLength": TEXT_LENGTH},
        "within": list_of(AMOUNT, 2, 2),
        "deviation": AMOUNT,
        "unit": TEXT,
    },
}
"""Keys of every part as a file spells them; a test compares them with the parts themselves."""


def mechanism_schema() -> Schema:
    """JSON Schema (draft 2020-12) of a description's file; what parts say about each other is not in it."""
    return schema_of("centrode mechanism", Description, PROPERTIES)


# JSON Schema of the parts of a cam that is given by its follower's lift.

_RATES = list_of(AMOUNT, 0, MOST_RATES)

_GEAR_REPORT: Schema = {
    **NOTE,
    "chapters": CHAPTERS,
    "digits": REPORT_DIGITS,
    "full": {"type": "boolean"},
    "text": table_of(reference_to(ChapterText), MOST_CHAPTERS),
}
PLATE_PROPERTIES: dict[type[DescriptionPart], Schema] = {
    Display: PROPERTIES[Display],
    Material: {"elasticity": above_zero("pressure"), "poisson": quantity_schema("ratio")},
    CamBody: {
        "base_radius": above_zero("length"),
        "turn": {"enum": list(TURNS)},
        "speed": above_zero("angular speed"),
        "thickness": above_zero("length"),
        "material": reference_to(Material),
    },
    Spring: {"stiffness": AMOUNT, "preload": AMOUNT},
    Follower: {
        "kind": {"enum": list(FOLLOWER_KINDS)},
        "contact": {"enum": list(CONTACTS)},
        "roller_radius": above_zero("length"),
        "offset": quantity_schema("length"),
        "arm": above_zero("length"),
        "pivot_distance": above_zero("length"),
        "face_offset": quantity_schema("length"),
        "mass": quantity_schema("mass"),
        "inertia": quantity_schema("inertia"),
        "spring": reference_to(Spring),
        "load": AMOUNT,
        "friction": quantity_schema("ratio"),
        "material": reference_to(Material),
    },
    LiftSegment: {
        "angle": above_zero("angle"),
        "share": above_zero("ratio"),
        "time": above_zero("time"),
        "from": quantity_schema("angle"),
        "to": AMOUNT,
        "curve": {"enum": list(laws.LIFT_CURVES)},
        "lift": {"type": "string", "minLength": 1, "maxLength": TEXT_LENGTH},
        "at_start": _RATES,
        "at_end": _RATES,
        "through": list_of(list_of(AMOUNT, 2, 2), 0, max(MOST_THROUGH.values())),
        "degree": {"type": "integer", "minimum": 1, "maximum": laws.MOST_DEGREE},
    },
    FollowerBounds: {
        "pressure_angle": above_zero("angle"),
        "return_pressure_angle": above_zero("angle"),
        "curvature_radius": above_zero("length"),
        "roller_to_curvature": above_zero("ratio"),
        "roller_to_radius": above_zero("ratio"),
        "stress": above_zero("pressure"),
    },
    Tool: {"radius": above_zero("length")},
    FollowerStudy: {
        "samples": {"type": "integer", "minimum": 1, "maximum": reading.SAMPLES},
        "instants": list_of(quantity_schema("angle"), 0, reading.INSTANTS),
        "chord_tolerance": above_zero("length"),
        "show_undercut": {"type": "boolean"},
    },
    ChapterText: CHAPTER_TEXT,
    TitlePage: TITLE_PAGE,
    CamReportWishes: {**_GEAR_REPORT, "instants": list_of(quantity_schema("angle"), 0, reading.INSTANTS)},
    PlateCam: {
        "title": TEXT,
        "kind": {"const": "cam"},
        "display": reference_to(Display),
        "cam": reference_to(CamBody),
        "follower": reference_to(Follower),
        "segments": list_of(reference_to(LiftSegment), 1, MOST),
        "bounds": reference_to(FollowerBounds),
        "tool": reference_to(Tool),
        "study": reference_to(FollowerStudy),
        "report": reference_to(CamReportWishes),
    },
}
"""Keys of every part as a file spells them; a test compares them with the parts themselves."""


# JSON Schema of a cam's description.

_FLAG: Schema = {"type": "boolean"}
_TEETH: Schema = {"type": "integer", "minimum": FEWEST_TEETH, "maximum": MOST_TEETH}
_BOUNDS = list_of(AMOUNT, 2, 2)

CAM_PROPERTIES: dict[type[DescriptionPart], Schema] = {
    Display: PROPERTIES[Display],
    Curvature: {
        "law": {"enum": list(LAWS)},
        "k0": above_zero("curvature"),
        "k1": AMOUNT,
        "points": {"anyOf": [TEXT, list_of(_BOUNDS, 2, reading.TABLE_ROWS)]},
        "constants": {
            "type": "object",
            "patternProperties": {f"^{LETTER.pattern}$": AMOUNT},
            "additionalProperties": False,
        },
        "formula": {**TEXT, "description": "K [1/m] as a formula of phi [rad]"},
        "symmetric": _FLAG,
    },
    Start: {"radius": above_zero("length"), "pressure_angle": quantity_schema("angle")},
    NumberRange: {"from": quantity_schema("angle"), "to": quantity_schema("angle")},
    Roller: {"radius": above_zero("length")},
    Return: {
        "kind": {"enum": ["designed", "mirrored"]},
        "least_radius": above_zero("length"),
        "greatest_radius": above_zero("length"),
        "least_curvature_radius": above_zero("length"),
        "pressure_angle": above_zero("angle"),
        "convex": _FLAG,
    },
    CamMover: {
        "legs": {"type": "integer", "minimum": LEAST_LEGS, "maximum": MOST_LEGS},
        "post": quantity_schema("length"),
        "working_arc": list_of(quantity_schema("angle"), 2, 2),
    },
    Material: {"elasticity": above_zero("pressure"), "poisson": quantity_schema("ratio")},
    CamContact: {
        "force": above_zero("force"),
        "width": above_zero("length"),
        "cam": reference_to(Material),
        "roller": reference_to(Material),
        "admissible": above_zero("pressure"),
        "outer": _FLAG,
    },
    Choose: {
        "parameters": {
            "type": "object",
            "properties": dict.fromkeys(PARAMETERS, _BOUNDS),
            "patternProperties": {f"^{one.pattern}$": _BOUNDS for one in (POINT, CONSTANT)},
            "additionalProperties": False,
        },
        "minimise": {"enum": list(MINIMISED)},
        "stress": above_zero("pressure"),
        "pressure_angle": above_zero("angle"),
        "size": above_zero("length"),
        "lift": above_zero("length"),
        "gap": above_zero("length"),
        "step": above_zero("length"),
        "trade_off": {"enum": list(MEASURED)},
    },
    CamStudy: {
        "samples": {"type": "integer", "minimum": 1, "maximum": reading.SAMPLES},
        "terms": {"type": "integer", "minimum": 2, "maximum": MOST_TERMS},
        "instants": list_of(quantity_schema("angle"), 0, reading.INSTANTS),
    },
    ChapterText: CHAPTER_TEXT,
    TitlePage: TITLE_PAGE,
    CamReportWishes: {**_GEAR_REPORT, "instants": list_of(quantity_schema("angle"), 0, reading.INSTANTS)},
    Cam: {
        "title": TEXT,
        "kind": {"const": "cam"},
        "display": reference_to(Display),
        "curvature": reference_to(Curvature),
        "start": reference_to(Start),
        "range": reference_to(NumberRange),
        "roller": reference_to(Roller),
        "return": reference_to(Return),
        "mover": reference_to(CamMover),
        "contact": reference_to(CamContact),
        "choose": reference_to(Choose),
        "study": reference_to(CamStudy),
        "report": reference_to(CamReportWishes),
    },
}
"""Keys of every part as a file spells them; a test compares them with the parts themselves."""


def cam_schema() -> Schema:
    """JSON Schema (draft 2020-12) of a cam's file; what parts say about each other is not in it.

    A file is that of a cam by a curvature law, or of one by its follower's lift.
    """
    curved, plate = (
        schema_of("centrode cam", Cam, CAM_PROPERTIES),
        schema_of("", PlateCam, PLATE_PROPERTIES),
    )
    words = ("$schema", "title")
    kinds = {
        name: {key: one for key, one in whole.items() if key not in (*words, "$defs")}
        for name, whole in (("Cam", curved), ("PlateCam", plate))
    }
    return {
        **{word: curved[word] for word in words},
        "anyOf": [reference_to(Cam), reference_to(PlateCam)],
        "$defs": {**curved["$defs"], **plate["$defs"], **kinds},
    }


# JSON Schema of the description of a pair of gears.

GEAR_PAIR_PROPERTIES: dict[type[DescriptionPart], Schema] = {
    Display: PROPERTIES[Display],
    Rack: {
        "pressure_angle": above_zero("angle"),
        "addendum": {"type": "number", "minimum": 0.3, "maximum": 2},
        "clearance": {"type": "number", "minimum": 0, "maximum": 1},
        "fillet": {"type": "number", "minimum": 0, "maximum": 1.5},
    },
    GearPair: {
        "title": TEXT,
        "kind": {"const": KIND},
        "display": reference_to(Display),
        "module": above_zero("length"),
        "teeth": {
            "type": "array",
            "prefixItems": [_TEETH, {"anyOf": [_TEETH, {"const": RACK}]}],
            "minItems": 2,
            "maxItems": 2,
        },
        "internal": _FLAG,
        "shifts": {"anyOf": [list_of(AMOUNT, 2, 2), {"enum": list(PURPOSES)}]},
        "application": {"enum": list(APPLICATIONS)},
        "centre_distance": above_zero("length"),
        "helix_angle": quantity_schema("angle"),
        "rack": reference_to(Rack),
        "width": above_zero("length"),
        "pin": above_zero("length"),
        "speed": quantity_schema("angular speed"),
        "moment": quantity_schema("torque"),
        "samples": {"type": "integer", "minimum": 2, "maximum": 10_000},
        "report": reference_to(GearReportWishes),
    },
    ChapterText: CHAPTER_TEXT,
    TitlePage: TITLE_PAGE,
    GearReportWishes: _GEAR_REPORT,
}
"""Keys of every part as a file spells them; a test compares them with the parts themselves."""


def gear_pair_schema() -> Schema:
    """JSON Schema (draft 2020-12) of the file of a pair of gears; what parts say about each other is not in it."""
    return schema_of("centrode gear pair", GearPair, GEAR_PAIR_PROPERTIES)


# JSON Schema of the description of a train of gears.

_TWO_TEETH: Schema = {
    "type": "array",
    "items": {"type": "integer", "minimum": FEWEST_IN_TRAIN, "maximum": MOST_IN_TRAIN},
    "minItems": 2,
    "maxItems": 2,
}
GEAR_TRAIN_PROPERTIES: dict[type[DescriptionPart], Schema] = {
    Display: PROPERTIES[Display],
    MeshLosses: {
        "external": {"type": "number", "minimum": 0.5, "maximum": 1},
        "internal": {"type": "number", "minimum": 0.5, "maximum": 1},
    },
    GearTrain: {
        "title": TEXT,
        "kind": {"const": TRAIN_KIND},
        "display": reference_to(Display),
        "scheme": {"enum": list(TRAIN_SCHEMES)},
        "ratio": AMOUNT,
        "input_speed": quantity_schema("angular speed"),
        "output_speed": quantity_schema("angular speed"),
        "pair_behind": _TWO_TEETH,
        "driver": {"enum": ["sun", "carrier"]},
        "planets": {"type": "integer", "minimum": 1, "maximum": MOST_PLANETS},
        "module": above_zero("length"),
        "teeth": _TWO_TEETH,
        "tolerance": {"type": "number", "minimum": 0, "maximum": 0.2},
        "mesh_efficiency": reference_to(MeshLosses),
        "chosen": {"type": "integer", "minimum": 1, "maximum": 1000},
        "report": reference_to(GearReportWishes),
    },
    ChapterText: CHAPTER_TEXT,
    TitlePage: TITLE_PAGE,
    GearReportWishes: _GEAR_REPORT,
}
"""Keys of every part as a file spells them; a test compares them with the parts themselves."""


def gear_train_schema() -> Schema:
    """JSON Schema (draft 2020-12) of the file of a train of gears; what parts say about each other is not in it."""
    return schema_of("centrode gear train", GearTrain, GEAR_TRAIN_PROPERTIES)
