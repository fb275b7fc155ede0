"""What holds or bounds coordinates of a motion that is computed: end stops and ropes, clamps, and user's events."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import PlainValidator, ValidationInfo, field_validator

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.reading import (
    FRAME,
    DescriptionPart,
    Problem,
    bounded_list,
    choice,
    missing_key,
    one_of,
    read_name,
    value_text,
)
from centrode.model.values import READING, Heading, Name, not_negative, positive, read_text, si
from centrode.numerics.text_formula import compile_formula

CONDITION_VARIABLES = ("t", "x", "v")
"""Time [s], the coordinate [rad or m] and its speed, in formulas of events."""
MOST_CONTACTS = 100
"""Stops, clamps and events of one description, each."""
MEASURED = ("link", "guide", "points", "point")
NOTE, END = DOINGS = ("note", "end")
"""What an event does: it is noted, or it ends the simulation."""


class MeasuredPart(DescriptionPart):
    """Something along a coordinate: an angle, a displacement, a distance, or the way of a point in a direction.

    Attributes
    ----------
    name : what results call it; left out, its kind and what it acts on
    link, guide, points, point : one of them
        The angle of the link, the displacement along the guide, the distance of two points, or the way of a point. On
        the sphere the displacement and the distance are angles about its centre.
    relative_to : the link from which the angle of `link` is counted
    direction : (x, y), on the sphere (x, y, z), in which the way of `point` is counted from the origin of the frame
    """

    name: Name | None = None
    link: Name | None = None
    guide: Name | None = None
    points: Annotated[tuple[Name, ...], bounded_list(2)] | None = None
    point: Name | None = None
    direction: Heading | None = None
    relative_to: Name = FRAME

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given."""
        wrong = super().key_problems(given) + one_of(given, MEASURED)
        if given.get("link") is None and given.get("relative_to", FRAME) != FRAME:
            what = _("{key} is used with a link only").format(key=value_text("relative_to"))
            wrong.append(Problem(what, _("remove it, or give link")))
        if (given.get("point") is None) is not (given.get("direction") is None):
            repair = _('write both, such as point = "B" and direction = [1, 0]')
            wrong.append(Problem(_("point and direction belong together"), repair))
        return wrong

    @property
    def label(self) -> str:
        """What results call it."""
        return self.name or self.place

    @property
    def place(self) -> str:
        """What it acts on: a link, a guide, or two points."""
        return self.link or self.guide or self.point or "-".join(self.points or ())

    def measures_angle(self, space: str) -> bool:
        """Whether its coordinate is an angle in a space; on the sphere arcs are angles about the centre."""
        return self.link is not None or (space == "sphere" and self.point is None)


def _is_angular(given: Mapping[str, Any]) -> bool:
    """The same by keys that are read already."""
    on_sphere = READING.get().space == "sphere"
    return given.get("link") is not None or (on_sphere and given.get("point") is None)


def _bound(value: object, info: ValidationInfo) -> float | None:
    if value is None:
        return None
    kind = "angle" if _is_angular(info.data) else "length"
    return not_negative(value, kind) if info.data.get("points") is not None else si(value, kind)


class Stop(MeasuredPart):
    """An end stop: a coordinate is at least or at most so great; of two points with `most` alone, a rope.

    Attributes
    ----------
    least, most : float [rad or m]
        One of them or both; on the sphere an angle but for the way of a point.
    restitution : float, 0 to 1
        Of a rigid stop: relative speed after an impact over that before it; 0 by default.
    stiffness, damping : float [N/m or N m/rad], [N s/m or N m s/rad]
        Of a compliant stop, in place of `restitution`. It pushes and never pulls.
    """

    least: float | None = None
    most: float | None = None
    restitution: float | None = None
    stiffness: float | None = None
    damping: float | None = None

    _bounds = field_validator("least", "most", mode="plain")(_bound)

    @field_validator("restitution", mode="plain")
    @classmethod
    def _restitution(cls, value: object) -> float | None:
        if value is None:
            return None
        number = si(value, "ratio")
        if not 0.0 <= number <= 1.0:
            what = _("restitution lies between 0 and 1, got {value}").format(value=value_text(value))
            raise Problem(what, _("0: it stays at the stop; 1: it bounces without a loss"))
        return number

    @field_validator("stiffness", "damping", mode="plain")
    @classmethod
    def _compliance(cls, value: object, info: ValidationInfo) -> float | None:
        if value is None:
            return None
        angular = "angular " if _is_angular(info.data) else ""
        read = positive if info.field_name == "stiffness" else not_negative
        return read(value, f"{angular}{info.field_name}")

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given: a bound, and one of two kinds of a stop."""
        wrong = super().key_problems(given)
        if given.get("least") is None and given.get("most") is None:
            wrong.append(Problem(_("one of {keys} is missing").format(keys="least, most")))
        if given.get("stiffness") is None:
            if given.get("damping") is not None:
                wrong.append(missing_key("stiffness"))
        elif given.get("restitution") is not None:
            what = _("{names} are given together").format(names="restitution, stiffness")
            wrong.append(
                Problem(what, _("a rigid stop has restitution, a compliant one stiffness and damping"))
            )
        return wrong

    @property
    def label(self) -> str:
        """What results call it."""
        rope = self.points is not None and self.least is None
        return self.name or f"{'rope' if rope else 'stop'} {self.place}"

    @property
    def is_rigid(self) -> bool:
        """Whether it gives no way."""
        return self.stiffness is None


def _until(value: object) -> float | str | None:
    """A time [s], or the name of an event."""
    if value is None:
        return None
    if not isinstance(value, str):
        return not_negative(value, "time")
    try:
        return not_negative(value, "time")
    except Problem:
        return read_name(value)


class Clamp(MeasuredPart):
    """Something that is held where it is at the start.

    Attributes
    ----------
    until : float [s], or the name of an event
        When it lets go; never by default.
    """

    until: Annotated[float | str | None, PlainValidator(_until)] = None

    @property
    def label(self) -> str:
        """What results call it."""
        return self.name or f"clamp {self.place}"


def _condition(value: object) -> str:
    text = read_text(value)
    try:
        formula = compile_formula(text, CONDITION_VARIABLES, "")
    except InputError as error:
        raise Problem(error.what, error.repair) from None
    if not formula.used:
        what = _("the formula {value} is constant: it never changes its sign")
        raise Problem(what.format(value=value_text(text)), _("use t, x or v"))
    return text


class EventCondition(MeasuredPart):
    """An event of a simulation: a formula of time, a coordinate and its speed passes zero.

    Attributes
    ----------
    when : formula of `t` [s], `x` [rad or m] and `v` [rad/s or m/s]
    do : "note" or "end"
    """

    when: Annotated[str, PlainValidator(_condition)]
    do: Annotated[Literal["note", "end"], choice(*DOINGS)] = "note"

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given; a formula of time alone needs no coordinate."""
        problems = super().key_problems(given)
        if any(given.get(key) is not None for key in MEASURED) or not isinstance(given.get("when"), str):
            return problems
        try:
            used = compile_formula(given["when"], CONDITION_VARIABLES, "").used
        except InputError:
            return problems
        needless = {problem.what for problem in one_of(given, MEASURED)}
        return problems if used & {"x", "v"} else [one for one in problems if one.what not in needless]

    @property
    def label(self) -> str:
        """What results call it."""
        return self.name or f"event {self.place}".rstrip()
