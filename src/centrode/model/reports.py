"""What a description wishes of its report: `[report]`."""

from __future__ import annotations

from typing import Annotated

from pydantic import PlainValidator

from centrode.locale import _
from centrode.model import limits
from centrode.model.entries import listed
from centrode.model.part import Part
from centrode.model.problems import KEY, Problem, shown
from centrode.model.values import Angle, Name, PlaceOfMotion

LEAST_DIGITS, MOST_DIGITS, DIGITS = 2, 12, 5
"""Significant digits of a report's numbers: at least, at most, and where nothing is said."""
MOST_CHAPTERS = 100


def read_digits(value: object) -> int:
    """A number of significant digits."""
    if isinstance(value, bool) or not isinstance(value, int):
        raise Problem(_("{key} must be a whole number, got {value}").format(key=KEY, value=shown(value)))
    if not LEAST_DIGITS <= value <= MOST_DIGITS:
        what = _("{key} must lie between {least} and {most}, got {value}")
        raise Problem(what.format(key=KEY, least=LEAST_DIGITS, most=MOST_DIGITS, value=shown(value)))
    return value


class CamReportWishes(Part):
    """What the report of a cam is to hold; what is left out is chosen by the report.

    Attributes
    ----------
    chapters : names of chapters (`centrode report --help` lists them), in any order
    instants : tuple of float [rad]
        Angles of the carrier, or of a cam that turns, that tables show.
    digits : int
        Significant digits of numbers.
    """

    chapters: Annotated[tuple[Name, ...], listed(MOST_CHAPTERS)] = ()
    instants: Annotated[tuple[Angle, ...], listed(limits.INSTANTS)] = ()
    digits: Annotated[int, PlainValidator(read_digits)] | None = None


class ReportWishes(Part):
    """What the report of a mechanism is to hold; what is left out is chosen by the report.

    Attributes
    ----------
    chapters : names of chapters (`centrode report --help` lists them), in any order
    instants : tuple of float [rad or m; s if there are several drives]
        Values of the drive at which tables, diagrams and forces are shown; those of `[study]` if left out.
    points : names of points
        Whose velocities and paths are told.
    digits : int
        Significant digits of numbers.
    """

    chapters: Annotated[tuple[Name, ...], listed(MOST_CHAPTERS)] = ()
    instants: Annotated[tuple[PlaceOfMotion, ...], listed(limits.INSTANTS)] = ()
    points: Annotated[tuple[Name, ...], listed(limits.POINTS)] = ()
    digits: Annotated[int, PlainValidator(read_digits)] | None = None
