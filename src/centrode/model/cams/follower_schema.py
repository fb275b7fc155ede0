"""JSON Schema of the parts of a cam that is given by its follower's lift."""

from __future__ import annotations

from centrode import laws
from centrode.model import limits
from centrode.model.asked import Display
from centrode.model.cams.followers import (
    CONTACTS,
    KINDS,
    TURNS,
    Bounds,
    CamBody,
    Follower,
    FollowerStudy,
    Spring,
    Tool,
)
from centrode.model.cams.lifting import MOST, MOST_RATES, LiftSegment
from centrode.model.cams.parts import Material
from centrode.model.cams.plate import PlateCam
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
)
from centrode.model.segments import MOST_THROUGH

_RATES = list_of(AMOUNT, 0, MOST_RATES)

PLATE_PROPERTIES: dict[type[Part], Schema] = {
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
        "kind": {"enum": list(KINDS)},
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
        "from": quantity_schema("angle"),
        "to": AMOUNT,
        "curve": {"enum": list(laws.SEGMENT_CURVES)},
        "at_start": _RATES,
        "at_end": _RATES,
        "through": list_of(list_of(AMOUNT, 2, 2), 0, max(MOST_THROUGH.values())),
        "degree": {"type": "integer", "minimum": 1, "maximum": laws.MOST_DEGREE},
    },
    Bounds: {
        "pressure_angle": above_zero("angle"),
        "return_pressure_angle": above_zero("angle"),
        "curvature_radius": above_zero("length"),
        "stress": above_zero("pressure"),
    },
    Tool: {"radius": above_zero("length")},
    FollowerStudy: {
        "samples": {"type": "integer", "minimum": 1, "maximum": limits.SAMPLES},
        "instants": list_of(quantity_schema("angle"), 0, limits.INSTANTS),
        "chord_tolerance": above_zero("length"),
        "show_undercut": {"type": "boolean"},
    },
    CamReportWishes: {
        "chapters": CHAPTERS,
        "instants": list_of(quantity_schema("angle"), 0, limits.INSTANTS),
        "digits": REPORT_DIGITS,
    },
    PlateCam: {
        "title": TEXT,
        "kind": {"const": "cam"},
        "display": reference_to(Display),
        "cam": reference_to(CamBody),
        "follower": reference_to(Follower),
        "segments": list_of(reference_to(LiftSegment), 1, MOST),
        "bounds": reference_to(Bounds),
        "tool": reference_to(Tool),
        "study": reference_to(FollowerStudy),
        "report": reference_to(CamReportWishes),
    },
}
"""Keys of every part as a file spells them; a test compares them with the parts themselves."""
