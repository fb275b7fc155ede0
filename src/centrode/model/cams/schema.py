"""JSON Schema of a cam's description."""

from __future__ import annotations

from centrode.model import limits
from centrode.model.asked import Display
from centrode.model.cams.description import Cam
from centrode.model.cams.follower_schema import PLATE_PROPERTIES
from centrode.model.cams.parts import (
    LAWS,
    LEAST_LEGS,
    MEASURED,
    MINIMISED,
    MOST_LEGS,
    MOST_TERMS,
    CamStudy,
    Choose,
    Contact,
    Curvature,
    Material,
    Mover,
    Range,
    Return,
    Roller,
    Start,
)
from centrode.model.cams.plate import PlateCam
from centrode.model.cams.values import CONSTANT, LETTER, PARAMETERS, POINT
from centrode.model.part import Part
from centrode.model.reports import CamReportWishes
from centrode.model.schema import CHAPTERS, PROPERTIES, REPORT_DIGITS
from centrode.model.schema_parts import (
    AMOUNT,
    TEXT,
    Schema,
    above_zero,
    list_of,
    quantity_schema,
    reference_to,
    schema_of,
)

_FLAG: Schema = {"type": "boolean"}
_BOUNDS = list_of(AMOUNT, 2, 2)

CAM_PROPERTIES: dict[type[Part], Schema] = {
    Display: PROPERTIES[Display],
    Curvature: {
        "law": {"enum": list(LAWS)},
        "k0": above_zero("curvature"),
        "k1": AMOUNT,
        "points": {"anyOf": [TEXT, list_of(_BOUNDS, 2, limits.TABLE_ROWS)]},
        "constants": {
            "type": "object",
            "patternProperties": {f"^{LETTER.pattern}$": AMOUNT},
            "additionalProperties": False,
        },
        "formula": {**TEXT, "description": "K [1/m] as a formula of phi [rad]"},
        "symmetric": _FLAG,
    },
    Start: {"radius": above_zero("length"), "pressure_angle": quantity_schema("angle")},
    Range: {"from": quantity_schema("angle"), "to": quantity_schema("angle")},
    Roller: {"radius": above_zero("length")},
    Return: {
        "kind": {"enum": ["designed", "mirrored"]},
        "least_radius": above_zero("length"),
        "greatest_radius": above_zero("length"),
        "least_curvature_radius": above_zero("length"),
        "pressure_angle": above_zero("angle"),
        "convex": _FLAG,
    },
    Mover: {
        "legs": {"type": "integer", "minimum": LEAST_LEGS, "maximum": MOST_LEGS},
        "post": quantity_schema("length"),
        "working_arc": list_of(quantity_schema("angle"), 2, 2),
    },
    Material: {"elasticity": above_zero("pressure"), "poisson": quantity_schema("ratio")},
    Contact: {
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
        "trade_off": {"enum": list(MEASURED)},
    },
    CamStudy: {
        "samples": {"type": "integer", "minimum": 1, "maximum": limits.SAMPLES},
        "terms": {"type": "integer", "minimum": 2, "maximum": MOST_TERMS},
        "instants": list_of(quantity_schema("angle"), 0, limits.INSTANTS),
    },
    CamReportWishes: {
        "chapters": CHAPTERS,
        "instants": list_of(quantity_schema("angle"), 0, limits.INSTANTS),
        "digits": REPORT_DIGITS,
    },
    Cam: {
        "title": TEXT,
        "kind": {"const": "cam"},
        "display": reference_to(Display),
        "curvature": reference_to(Curvature),
        "start": reference_to(Start),
        "range": reference_to(Range),
        "roller": reference_to(Roller),
        "return": reference_to(Return),
        "mover": reference_to(Mover),
        "contact": reference_to(Contact),
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
