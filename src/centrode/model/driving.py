"""Drives: an angle, a displacement or a distance that is given as a law of time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import PlainValidator, ValidationInfo, field_validator

from centrode.errors import InputError
from centrode.laws import Law, TableLaw, TextLaw, Uniform
from centrode.locale import _
from centrode.model.names import FRAME
from centrode.model.part import Part, one_of
from centrode.model.problems import Problem
from centrode.model.segments import Segment, read_repeat, read_segments, segmented
from centrode.model.tables import Columns, read_rows
from centrode.model.values import READING, Name, listed, read_text, si

_LAWS = ("speed", "law", "table", "segments")


def _read_law(value: object) -> str:
    text = read_text(value)
    try:
        TextLaw(text)
    except InputError as error:
        raise Problem(error.what, error.repair) from None
    return text


class Drive(Part):
    """A given motion of one degree of freedom: value(t) = start + law(t).

    Attributes
    ----------
    link, guide, distance : str, str, two points
        One of them: the link's angle, the displacement along the guide, the distance of the points.
    relative_to : str
        The link an angle is measured from.
    start : float [rad or m]
        Value at t = 0, without the law's own value there; from the initial position if left out.
    speed, law, table, segments : float [rad/s or m/s], formula in t, rows of (time, value), tuple of Segment
        One of them. In a file, `table` may be the path of a CSV file beside it.
    repeat : bool
        Whether the segments follow each other again and again.
    """

    link: Name | None = None
    guide: Name | None = None
    distance: Annotated[tuple[Name, ...], listed(2)] | None = None
    relative_to: Name = FRAME
    start: float | None = None
    speed: float | None = None
    law: Annotated[str, PlainValidator(_read_law)] | None = None
    table: tuple[tuple[float, float], ...] | None = None
    segments: tuple[Segment, ...] | None = None
    repeat: Annotated[bool, PlainValidator(read_repeat)] = False

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given, by the rules of this part."""
        wrong = one_of(given, ("link", "guide", "distance")) + one_of(given, _LAWS)
        if given.get("link") is None and given.get("relative_to", FRAME) != FRAME:
            repair = _("take it out; a guide's displacement is along the link it is on")
            wrong.append(Problem(_("relative_to belongs to the drive of a link's angle"), repair))
        if given.get("repeat") and given.get("segments") is None:
            wrong.append(Problem(_("repeat belongs to segments"), _("take it out, or give segments")))
        return super().key_problems(given) + wrong

    @field_validator("start", "speed", mode="plain")
    @classmethod
    def _number(cls, value: object, info: ValidationInfo) -> float | None:
        if value is None:
            return None
        return si(value, _kind(info, rate=info.field_name == "speed"))

    @field_validator("table", mode="plain")
    @classmethod
    def _rows(cls, value: object, info: ValidationInfo) -> tuple[tuple[float, float], ...] | None:
        if value is None:
            return None
        columns = Columns(("time", _kind(info)), "[time, value]", 2)
        rows = read_rows(value, columns, READING.get().folder)
        try:
            TableLaw(*zip(*rows, strict=True))
        except InputError as error:
            raise Problem(error.what, error.repair) from None
        return tuple((time, number) for time, number in rows)

    @field_validator("segments", mode="plain")
    @classmethod
    def _segments(cls, value: object, info: ValidationInfo) -> tuple[Segment, ...] | None:
        return None if value is None else read_segments(value, _kind(info))

    @property
    def kind(self) -> str:
        """What is driven: "angle", "displacement" or "distance"."""
        return "angle" if self.link else "displacement" if self.guide else "distance"

    @property
    def id(self) -> str:
        """The link's name, the guide's id, or the two points as "A-B"."""
        return self.link or self.guide or "-".join(self.distance or ())

    @property
    def motion_law(self) -> Law:
        """s(t) [rad or m]; the drive's value is start + s(t)."""
        if self.speed is not None:
            return Uniform(self.speed)
        if self.law is not None:
            return TextLaw(self.law)
        if self.segments is not None:
            return segmented(self.segments, self.repeat)
        times, values = zip(*self.table or (), strict=True)
        return TableLaw(times, values)


def _kind(info: ValidationInfo, rate: bool = False) -> str:
    angular = info.data.get("link") is not None or READING.get().space == "sphere"
    if rate:
        return "angular speed" if angular else "speed"
    return "angle" if angular else "length"
