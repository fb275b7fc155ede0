"""Motion laws of one variable: what a drive does in time, and how a cam lifts, over any algebra."""

from centrode.laws.curves import CURVES, Curve
from centrode.laws.law import Law
from centrode.laws.pieces import Piece
from centrode.laws.segments import (
    B_SPLINE,
    DEGREE,
    DWELL,
    MOST_DEGREE,
    POLYNOMIAL,
    SEGMENT_CURVES,
    THROUGH_POINTS,
    Segment,
    SegmentedLaw,
)
from centrode.laws.shaft import ShaftLaw
from centrode.laws.table import TableLaw
from centrode.laws.text import TextLaw
from centrode.laws.uniform import Uniform

__all__ = [
    "B_SPLINE",
    "CURVES",
    "DEGREE",
    "DWELL",
    "MOST_DEGREE",
    "POLYNOMIAL",
    "Piece",
    "SEGMENT_CURVES",
    "THROUGH_POINTS",
    "Curve",
    "Law",
    "Segment",
    "SegmentedLaw",
    "ShaftLaw",
    "TableLaw",
    "TextLaw",
    "Uniform",
]
