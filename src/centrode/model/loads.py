"""Loads: forces, torques, springs, dampers, weights, friction; read and checked here, computed in `dynamics`."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
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
from centrode.model.values import (
    READING,
    Angle,
    Heading,
    Name,
    PositiveLength,
    TableColumns,
    not_negative,
    quantity,
    read_heading,
    read_rows,
    read_text,
    si,
)
from centrode.numerics.text_formula import compile_formula

# Which keys the loads of each kind need, and which they may have.

FRICTION_SIZES = ("value", "viscous", "quadratic", "coefficient")
# what friction by a coefficient has besides
_OF_HINGE, _OF_SLIDER = ("radius", "fit", "pin"), ("length", "height")
# a force in a point has a vector, one along a guide a value or a table
_IN_POINT, _ALONG_GUIDE = ("vector", "axes", "while_moving"), ("value", "table")

# kind -> keys that it needs, and keys that it may have; a tuple of alternatives needs exactly one of them.
_ALTERNATIVES: dict[str, tuple[str, ...]] = {
    "force": ("point", "guide"),
    "torque": ("link",),
    "spring": ("points", "link"),
    "damper": ("points", "link"),
    "weight": ("link", "point"),
    "friction": ("link", "guide", "point"),
}
_NEEDED: dict[str, tuple[str, ...]] = {
    "force": (),
    "torque": ("value",),
    "spring": ("stiffness",),
    "damper": ("damping",),
    "weight": (),
    "friction": (),
}
_ALLOWED: dict[str, tuple[str, ...]] = {
    "force": ("vector", "value", "table", "axes", "while_moving"),
    "torque": ("relative_to", "axis"),
    "spring": ("free_length", "free_angle", "relative_to", "axis"),
    "damper": ("relative_to", "axis"),
    "weight": ("value",),
    "friction": (*FRICTION_SIZES, "form", "relative_to", "axis", *_OF_HINGE, *_OF_SLIDER),
}


def load_key_problems(kind: str, given: Mapping[str, Any], defaults: Mapping[str, Any]) -> list[Problem]:
    """What is wrong with the keys of a load of a known kind; `defaults` are those of all its keys."""
    present = {key for key, value in given.items() if value is not None}
    said = {key for key in present if key not in defaults or given[key] != defaults[key]}
    alternatives, needed = _ALTERNATIVES[kind], _NEEDED[kind]
    known = {"kind", "name", *alternatives, *needed, *_ALLOWED[kind]}
    problems = [missing_key(key) for key in needed if key not in present]
    problems += [_foreign(key, kind) for key in defaults if key in said and key not in known]
    acts_on = present & set(alternatives)
    if kind == "friction" and "point" in acts_on:
        acts_on -= {"link"}  # at a hinge it says which of the links rubs
    if len(acts_on) != 1:
        words = ", ".join(alternatives)
        problems.append(Problem(_("a {kind} acts on one of: {keys}").format(kind=kind, keys=words)))
    elif kind == "force":
        problems += _of_force(given, present, said)
    elif kind == "friction":
        problems += _of_friction(given, present, said)
    return problems


def _of_force(given: Mapping[str, Any], present: set[str], said: set[str]) -> list[Problem]:
    """A force in a point has a vector; one along a guide a value or a table."""
    if "point" in present:
        missing = [] if "vector" in present else [missing_key("vector")]
        wrong = [key for key in _ALONG_GUIDE if key in present]
        what = _("{key} belongs to a force along a guide")
        repair = _("give vector, or a guide in place of the point")
    else:
        missing = one_of(given, _ALONG_GUIDE)
        wrong = [key for key in _IN_POINT if key in said]
        what = _("{key} belongs to a force in a point")
        repair = _("give value or table, or a point in place of the guide")
    return missing + [Problem(what.format(key=value_text(key)), repair) for key in wrong]


def _of_friction(given: Mapping[str, Any], present: set[str], said: set[str]) -> list[Problem]:
    """Friction is as great as its keys say together; the plain sum is one of quadratic friction in hinges."""
    amounts = [key for key in FRICTION_SIZES if key in present]
    if not amounts:
        return [Problem(_("one of {keys} is missing").format(keys=", ".join(FRICTION_SIZES)))]
    if "coefficient" in amounts:
        if len(amounts) > 1:
            what = _("{names} are given together").format(names=", ".join(amounts))
            return [Problem(what, _("keep the coefficient, or the others"))]
        return _of_coefficient(present, said)
    wrong = [key for key in ("point", *_OF_HINGE, *_OF_SLIDER) if key in said]
    if wrong:
        what = _("{key} belongs to friction by a coefficient")
        repair = _("give coefficient in place of {keys}").format(keys=", ".join(amounts))
        return [Problem(what.format(key=value_text(key)), repair) for key in wrong]
    if given.get("form") == "plain sum" and (amounts != ["quadratic"] or "link" not in present):
        what = _("the plain sum belongs to quadratic friction in a hinge")
        return [Problem(what, _("take form out, or give quadratic alone"))]
    return []


def _of_coefficient(present: set[str], said: set[str]) -> list[Problem]:
    """A hinge has a point and the radius of its pin; a guide, a slider."""
    problems = []
    if "guide" in present:
        wrong = [key for key in (*_OF_HINGE, "relative_to", "axis", "form") if key in said]
        what, repair = _("{key} belongs to friction in a hinge"), _("take it out, or give point")
    else:
        if "point" not in present:
            what = _("friction by a coefficient in a hinge needs the point of the hinge")
            problems.append(
                Problem(what, _("give point and radius; link says which link rubs, pin which not"))
            )
        elif "radius" not in present:
            problems.append(Problem(_("the radius of the pin is missing"), _("give radius")))
        wrong = [key for key in (*_OF_SLIDER, "relative_to", "axis", "form") if key in said]
        what, repair = _("{key} does not belong to friction by a coefficient there"), _("take it out")
    return problems + [Problem(what.format(key=value_text(key)), repair) for key in wrong]


def _foreign(key: str, kind: str) -> Problem:
    known = (*_ALTERNATIVES[kind], *_NEEDED[kind], *_ALLOWED[kind])
    what = _("{key} does not belong to a {kind}").format(key=value_text(key), kind=kind)
    return Problem(what, _("it has: {keys}").format(keys=", ".join(known)))


LOAD_VARIABLES = ("t", "q", "x", "v")
"""Time, the drive's value, and the coordinate and the speed the load works along, in formulas of loads."""

Amount = float | str
Kinds = Literal["force", "torque", "spring", "damper", "weight", "friction"]
KINDS = ("force", "torque", "spring", "damper", "weight", "friction")

Form = Literal["virtual work", "plain sum"]
VIRTUAL_WORK: Form = "virtual work"
PLAIN_SUM: Form = "plain sum"
FORMS = (VIRTUAL_WORK, PLAIN_SUM)
Fit = Literal["clearance", "new", "worn-in"]
CLEARANCE: Fit = "clearance"
FITS = (CLEARANCE, "new", "worn-in")
LEAST_ROWS = 2


def _amount(value: object, kind: str) -> Amount:
    """A quantity, or the text of a formula in `LOAD_VARIABLES` that gives it in SI."""
    if not isinstance(value, str):
        return si(value, kind)
    text = read_text(value)
    try:
        formula = compile_formula(text, LOAD_VARIABLES, "")
    except InputError as error:
        try:
            return si(text, kind)
        except Problem as problem:
            what = _("{what} (as a formula: {reason})").format(what=problem.what, reason=error.what)
            raise Problem(what, problem.repair) from None
    return text if formula.used else si(text, kind)


def _read_force(value: object) -> tuple[Amount, ...]:
    count, form = (3, "[x, y, z]") if READING.get().space == "sphere" else (2, "[x, y]")
    if not isinstance(value, list | tuple) or len(value) != count:
        raise Problem(_("expected {form}, got {value}").format(form=form, value=value_text(value)))
    return tuple(_amount(entry, "force") for entry in value)


def _read_axis(value: object) -> str | tuple[float, ...]:
    return read_name(value) if isinstance(value, str) else read_heading(value)


class Load(DescriptionPart):
    """A load of one kind.

    Attributes
    ----------
    kind : "force", "torque", "spring", "damper", "weight" or "friction"
    name : str or None
        What results call it; left out, its kind and what it acts on.
    point, link, guide, points : str, str, str, two names
        What it acts on: a force on a point or along a guide, a torque on a link, a spring or damper between two
        points or in a link's hinge, friction in a link's hinge or a guide, a weight in a link's centre or a point.
    vector : (x, y) [N], each a number or a formula; on the sphere (x, y, z)
    axes : "frame" or the link whose axes `vector` is given in
    value : float or formula [N m]; along a guide [N]; of a weight [N], where it is not mass times gravity
        Dry friction: the moment in a hinge [N m] or the force in a guide [N], against the motion.
    viscous, quadratic : float [N m s/rad, N m s^2/rad^2]; in a guide [N s/m, N s^2/m^2]
        Friction that grows with the relative speed, and with its square.
    coefficient : float
        Friction that grows with the reaction, in the hinge of a point or in a guide.
    radius, fit, pin : float [m], "clearance", "new" or "worn-in", the name of a link
        Of the pin of that hinge; how its bearings fit; the link that the pin is fixed in.
    length, height : float [m]
        Of the slider in that guide, along and across; by them it tilts, and friction has an arm.
    form : "virtual work" or "plain sum"
        The plain sum takes the moments of quadratic friction from the driving moment as they are, as a source does.
    table : rows of (displacement [m], force [N]) or (displacement, force forwards, force backwards)
        Indicator diagram of a force along a guide. In a file it may be the path of a CSV file beside it.
    stiffness [N/m or N m/rad], damping [N s/m or N m s/rad], free_length [m], free_angle [rad]
    relative_to : "frame" or the link against which a torque, spring, damper or friction works
    axis : a point's name, or (x, y, z) in the axes of the frame
        On the sphere: about what it works, where the links do not share exactly one point.
    while_moving : (x, y); on the sphere (x, y, z)
        The force acts only while its point moves this way.
    """

    kind: Annotated[Kinds, choice(*KINDS)]
    name: Name | None = None
    point: Name | None = None
    link: Name | None = None
    guide: Name | None = None
    points: Annotated[tuple[Name, ...], bounded_list(2)] | None = None
    vector: Annotated[tuple[Amount, ...], PlainValidator(_read_force)] | None = None
    axes: Name = FRAME
    value: Amount | None = None
    table: tuple[tuple[float, ...], ...] | None = None
    stiffness: float | None = None
    damping: float | None = None
    viscous: float | None = None
    quadratic: float | None = None
    coefficient: Annotated[float, quantity("ratio", not_negative)] | None = None
    radius: PositiveLength | None = None
    fit: Annotated[Fit, choice(*FITS)] = CLEARANCE
    pin: Name | None = None
    length: PositiveLength | None = None
    height: PositiveLength | None = None
    form: Annotated[Form, choice(*FORMS)] = VIRTUAL_WORK
    free_length: Annotated[float, PlainValidator(lambda value: not_negative(value, "length"))] | None = None
    free_angle: Angle | None = None
    relative_to: Name = FRAME
    axis: Annotated[str | tuple[float, ...], PlainValidator(_read_axis)] | None = None
    while_moving: Heading | None = None

    @field_validator("value", "stiffness", "damping", "viscous", "quadratic", mode="plain")
    @classmethod
    def _by_what_it_acts_on(cls, value: object, info: ValidationInfo) -> Amount | None:
        if value is None:
            return None
        straight = info.data.get("link") is None or info.data.get("kind") == "weight"
        if info.field_name == "value":
            amount = _amount(value, "force" if straight else "torque")
            if info.data.get("kind") == "friction" and not isinstance(amount, str):
                return not_negative(amount, "force" if straight else "torque")
            return amount
        kind = {"viscous": "damping", "quadratic": "quadratic damping"}.get(
            info.field_name or "", info.field_name
        )
        return not_negative(value, f"{'' if straight else 'angular '}{kind}")

    @field_validator("table", mode="plain")
    @classmethod
    def _rows(cls, value: object) -> tuple[tuple[float, ...], ...] | None:
        if value is None:
            return None
        columns = TableColumns(("length", "force", "force"), "[displacement, force, force]", 2)
        rows = read_rows(value, columns, READING.get().folder)
        if len(rows) < LEAST_ROWS or any(not low[0] < high[0] for low, high in pairwise(rows)):
            what = _("a diagram needs two rows or more, with displacements that increase")
            raise Problem(what, _("sort the rows, and keep one of equal displacements"))
        return rows

    @property
    def label(self) -> str:
        """What it is called where its `name` does not say so: "force H", "spring A-D"."""
        return (
            self.name or f"{self.kind} {self.point or self.link or self.guide or '-'.join(self.points or ())}"
        )

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given, by the rules of this part."""
        problems = super().key_problems(given)
        kind = given.get("kind")
        if problems or kind not in KINDS:
            return problems
        return load_key_problems(kind, given, {key: field.default for key, field in cls.model_fields.items()})
