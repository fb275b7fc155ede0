"""Segments of a drive: curves and dwells one after the other, as a file gives them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextvars import ContextVar
from itertools import pairwise
from typing import Annotated, Any

from pydantic import PlainValidator, ValidationError, ValidationInfo, field_validator, model_validator

from centrode import laws
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.reading import (
    KEY,
    DescriptionPart,
    Problem,
    Problems,
    choice,
    entries,
    input_error,
    missing_key,
    value_text,
)
from centrode.model.values import numbers, positive, si

MOST = 500
"""Segments of a drive."""

MOST_THROUGH = {laws.POLYNOMIAL: 10, laws.B_SPLINE: 200}
"""Points on the way: the degree of a polynomial grows with them, that of a B-spline does not."""

AT_START = ("speed_at_start", "acceleration_at_start", "jerk_at_start")
AT_END = ("speed_at_end", "acceleration_at_end", "jerk_at_end")
_BY_CONDITIONS = (*AT_START, *AT_END, "through")
_NOTHING: tuple[object, ...] = (None, (), [])
UNITS = {"angle": "rad", "length": "m"}

DRIVEN: ContextVar[str] = ContextVar("DRIVEN", default="length")
"""Kind of what is driven, "angle" or "length": it decides what the numbers of a segment mean."""


def rate(value: object, kind: str, order: int) -> float:
    """The derivative of that order by time, in SI, of an angle or a length: a number or a text such as "5 mm/s^2"."""
    if order == 1:
        return si(value, "angular speed" if kind == "angle" else "speed")
    if not isinstance(value, str):
        return si(value, "ratio")
    try:
        # An acceleration times a time squared is a length: units of every order are read by that.
        return si(value.strip() + order * "*s", kind)
    except Problem:
        return plain_rate(value, f"{UNITS[kind]}/s^{order}")


class Segment(DescriptionPart):
    """A stretch of a drive's law; see `centrode.laws.Segment`.

    Attributes
    ----------
    to : float [rad or m]
        The law's value at its end; a dwell has none.
    time : float [s], positive
    curve : str
        A curve by its name, "dwell" or "polynomial".
    speed_at_start, acceleration_at_start, jerk_at_start, speed_at_end, acceleration_at_end, jerk_at_end : float
        Conditions on a polynomial or a B-spline, each with those of lower order.
    through : tuple of (time [s], value [rad or m])
        Values of these on the way, at times from the segment's start.
    degree : int
        Of a B-spline.
    """

    to: float | None = None
    time: Annotated[float, PlainValidator(lambda value: positive(value, "time"))]
    curve: Annotated[str, choice(*laws.SEGMENT_CURVES, other_names=laws.CURVE_SYNONYMS)]
    speed_at_start: float | None = None
    acceleration_at_start: float | None = None
    jerk_at_start: float | None = None
    speed_at_end: float | None = None
    acceleration_at_end: float | None = None
    jerk_at_end: float | None = None
    through: tuple[tuple[float, float], ...] = ()
    degree: int | None = None

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given, by the rules of this part."""
        wrong = super().key_problems(given) + problems_of_end(given)
        return wrong + foreign_keys(given, _BY_CONDITIONS) + _gaps(given, AT_START) + _gaps(given, AT_END)

    @field_validator("to", mode="plain")
    @classmethod
    def _value(cls, value: object) -> float | None:
        return None if value is None else si(value, DRIVEN.get())

    @field_validator(*AT_START, *AT_END, mode="plain")
    @classmethod
    def _rate(cls, value: object, info: ValidationInfo) -> float | None:
        if value is None:
            return None
        keys = AT_START if info.field_name in AT_START else AT_END
        return rate(value, DRIVEN.get(), 1 + keys.index(info.field_name or ""))

    @field_validator("through", mode="plain")
    @classmethod
    def _through(cls, value: object, info: ValidationInfo) -> tuple[tuple[float, float], ...]:
        return read_through(value, info, "time", "[time, value]")

    @field_validator("degree", mode="plain")
    @classmethod
    def _degree(cls, value: object) -> int | None:
        return None if value is None else read_degree(value)

    @model_validator(mode="after")
    def _lawful(self) -> Segment:
        try:
            self.law.pieces(0.0, 0.0)
        except InputError as error:
            raise Problem(error.what, error.repair) from None
        return self

    @property
    def law(self) -> laws.LawSegment:
        """The segment of the law; raises InputError where its times do not increase."""
        return laws.LawSegment(
            self.time,
            self.to,
            self.curve,
            self._rates(AT_START),
            self._rates(AT_END),
            self.through,
            laws.DEGREE if self.degree is None else self.degree,
        )

    def _rates(self, keys: tuple[str, ...]) -> tuple[float, ...]:
        return tuple(number for key in keys if (number := getattr(self, key)) is not None)


def problems_of_end(given: Mapping[str, Any]) -> list[Problem]:
    """What is wrong with where a segment leads to: a dwell stays where it is, every other curve needs an end."""
    is_dwell, has_end = given.get("curve") == laws.DWELL, given.get("to") is not None
    if is_dwell and has_end:
        return [Problem(_("the lift stays constant in a dwell, so it has no `to`"), _("remove it"))]
    return [] if is_dwell or has_end else [missing_key("to")]


def foreign_keys(given: Mapping[str, Any], keys: Sequence[str]) -> list[Problem]:
    """Keys of curves by conditions that are given for another curve."""
    wrong = []
    if given.get("curve") not in laws.THROUGH_POINTS:
        repair = _('remove it, or write curve = "polynomial" or "b-spline"')
        what = _("{key} is used with a polynomial or a B-spline only")
        foreign = [key for key in keys if given.get(key) not in _NOTHING]
        wrong = [Problem(what.format(key=key), repair) for key in foreign]
    if given.get("curve") != laws.B_SPLINE and given.get("degree") is not None:
        repair = _("remove it; the degree of a polynomial follows from its conditions")
        wrong.append(Problem(_("degree is used with a B-spline only"), repair))
    return wrong


def read_through(
    value: object, info: ValidationInfo, across: str, form: str
) -> tuple[tuple[float, float], ...]:
    """Values on the way, each with its place: as many as the curve may have."""
    most = MOST_THROUGH.get(str(info.data.get("curve")), max(MOST_THROUGH.values()))
    rows = [numbers(row, (across, DRIVEN.get()), form) for row in entries(value, most)]
    return tuple((place, number) for place, number in rows)


def read_degree(value: object) -> int:
    """Degree of a B-spline."""
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= laws.MOST_DEGREE:
        what = _("{key} must be a whole number from {least} to {most}, got {value}")
        raise Problem(what.format(key=KEY, least=1, most=laws.MOST_DEGREE, value=value_text(value)))
    return value


def plain_rate(text: str, unit: str) -> float:
    """A derivative given as text without a unit, which counts as SI."""
    try:
        return si(text, "ratio")
    except Problem:
        what = _("expected a rate ({unit}), got {value}").format(unit=unit, value=value_text(text))
        repair = _('write a number in {unit}, or a text with a unit such as "{example}"')
        raise Problem(what, repair.format(unit=unit, example=f"5 {unit}")) from None


def read_segments(value: object, kind: str) -> tuple[Segment, ...]:
    """Segments of a drive of an angle or a length, each right in itself and all of them together a law."""
    token = DRIVEN.set(kind)
    try:
        read = [_read_segment(entry, number) for number, entry in enumerate(entries(value, MOST), 1)]
    finally:
        DRIVEN.reset(token)
    wrong = [entry for entry in read if isinstance(entry, Problem)]
    if wrong:
        raise Problems(wrong)
    segments = tuple(entry for entry in read if isinstance(entry, Segment))
    try:
        law_of_segments(segments, False)
    except InputError as error:
        raise Problem(error.what, error.repair) from None
    return segments


def law_of_segments(segments: tuple[Segment, ...], repeat: bool) -> laws.SegmentedLaw:
    """The law of these segments."""
    return laws.SegmentedLaw(tuple(segment.law for segment in segments), repeat)


def _gaps(given: Mapping[str, Any], keys: tuple[str, ...]) -> list[Problem]:
    """Rates that are given without the one of lower order: what they are to mean for a polynomial is open."""
    return [
        Problem(_("{key} needs {lower} as well").format(key=key, lower=lower))
        for lower, key in pairwise(keys)
        if given.get(key) is not None and given.get(lower) is None
    ]


def _read_segment(entry: object, number: int) -> Segment | Problem:
    """A segment, or what is wrong with it and which it is."""
    try:
        return Segment.model_validate(entry)
    except ValidationError as error:
        told = input_error(error, _("segment {number}").format(number=number))
    return Problem(f"{told.where}: {told.what}", told.repair)
