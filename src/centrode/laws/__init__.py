"""Motion laws of one variable: what a drive does in time, and how a cam lifts, over any algebra."""

from centrode.laws.laws import ShaftLaw, TableLaw, TextLaw, Uniform
from centrode.laws.rises import CURVES, Law, Piece, RiseCurve
from centrode.laws.segments import (
    B_SPLINE,
    CURVE_SYNONYMS,
    DEGREE,
    DWELL,
    FORMULA,
    LIFT_CURVES,
    MOST_DEGREE,
    POLYNOMIAL,
    SEGMENT_CURVES,
    THROUGH_POINTS,
    LawSegment,
    SegmentedLaw,
)

__all__ = [
    "B_SPLINE",
    "CURVES",
    "CURVE_SYNONYMS",
    "DEGREE",
    "DWELL",
    "FORMULA",
    "LIFT_CURVES",
    "MOST_DEGREE",
    "POLYNOMIAL",
    "Piece",
    "SEGMENT_CURVES",
    "THROUGH_POINTS",
    "RiseCurve",
    "Law",
    "LawSegment",
    "SegmentedLaw",
    "ShaftLaw",
    "TableLaw",
    "TextLaw",
    "Uniform",
]
