"""Loads: forces, torques, springs, dampers, weights, friction; read and checked here, computed in `dynamics`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import pairwise
from math import pi
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, TypeAlias, assert_never, get_args

from pydantic import ConfigDict, PlainValidator, ValidationError, ValidationInfo, field_validator

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.reading import (
    FRAME,
    DescriptionPart,
    Problem,
    Problems,
    bounded_list,
    choice,
    missing_key,
    one_of,
    problems_within,
    read_choice,
    read_name,
    unknown_keys,
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
# what dry friction of a given size has besides: while nothing slips it holds more, and what rubs may be a belt
_OF_DRY, _OF_BELT = ("static",), ("surface_speed",)
# what friction by a coefficient has besides
_OF_HINGE, _OF_SLIDER = ("radius", "fit", "pin"), ("length", "height")
_OF_COEFFICIENT = ("static_coefficient",)
# a force in a point has a vector, one along a guide a value or a table
_IN_POINT, _ALONG_GUIDE = ("vector", "axes", "while_moving"), ("value", "table")
# what says how a table is meant
_OF_TABLE, _OF_PISTON = ("over", "measured_from"), ("pressure", "diameter")


class LoadKeys(NamedTuple):
    """Keys of a kind of load besides its name: exactly one of what it acts on, what it needs, what it may have."""

    acts_on: tuple[str, ...]
    needed: tuple[str, ...]
    allowed: tuple[str, ...]


_KEYS_OF: Mapping[str, LoadKeys] = {
    "force": LoadKeys(
        ("point", "guide"),
        (),
        ("vector", "value", "table", *_OF_TABLE, *_OF_PISTON, "axes", "while_moving"),
    ),
    "torque": LoadKeys(("link",), (), ("value", "table", "over", "relative_to", "axis")),
    "spring": LoadKeys(
        ("points", "link"), ("stiffness",), ("free_length", "free_angle", "relative_to", "axis")
    ),
    "damper": LoadKeys(("points", "link"), ("damping",), ("relative_to", "axis")),
    "weight": LoadKeys(("link", "point"), (), ("value",)),
    "friction": LoadKeys(
        ("link", "guide", "point"),
        (),
        (
            *FRICTION_SIZES,
            *_OF_COEFFICIENT,
            *_OF_DRY,
            *_OF_BELT,
            "form",
            "relative_to",
            "axis",
            *_OF_HINGE,
            *_OF_SLIDER,
        ),
    ),
}


def load_key_problems(kind: str, given: Mapping[str, Any]) -> list[Problem]:
    """What is wrong with the keys of a load of a known kind; keys that are given as their defaults are not counted."""
    said = {key for key in given if given[key] != LOAD_DEFAULTS[key]}
    alternatives, needed, allowed = _KEYS_OF[kind]
    known = {"kind", "name", *alternatives, *needed, *allowed}
    problems = [missing_key(key) for key in needed if key not in given]
    problems += [_foreign(key, kind) for key in LOAD_DEFAULTS if key in said and key not in known]
    acts_on = set(given) & set(alternatives)
    if kind == "friction" and "point" in acts_on:
        acts_on -= {"link"}  # at a hinge it says which of the links rubs
    if len(acts_on) != 1:
        words = ", ".join(alternatives)
        problems.append(Problem(_("a {kind} acts on one of: {keys}").format(kind=kind, keys=words)))
    elif kind == "force":
        problems += _of_force(given, set(given), said)
    elif kind == "torque":
        problems += one_of(given, ("value", "table"))
        problems += _of_table(given, (DRIVE, TIME))
    elif kind == "friction":
        problems += _of_friction(given, set(given), said)
    return problems


def _of_force(given: Mapping[str, Any], present: set[str], said: set[str]) -> list[Problem]:
    """A force in a point has a vector; one along a guide a value or a table."""
    if "point" in present:
        missing = [] if "vector" in present else [missing_key("vector")]
        wrong = [key for key in (*_ALONG_GUIDE, *_OF_TABLE, *_OF_PISTON) if key in said]
        what = _("{key} is used with a force along a guide only")
        repair = _("give vector, or a guide in place of the point")
    else:
        missing = one_of(given, _ALONG_GUIDE)
        wrong = [key for key in _IN_POINT if key in said]
        what = _("{key} is used with a force in a point only")
        repair = _("give value or table, or a point in place of the guide")
        missing += _of_table(given, OVER)
    return missing + [Problem(what.format(key=value_text(key)), repair) for key in wrong]


def _of_table(given: Mapping[str, Any], may_be: tuple[str, ...]) -> list[Problem]:
    """What says how a table is meant needs one; a pressure needs a piston, and shares of a stroke their end."""
    if given.get("table") is None:
        wrong = [key for key in (*_OF_TABLE, *_OF_PISTON) if given.get(key) is not None]
        what = _("{key} is used with a table only")
        return [Problem(what.format(key=value_text(key)), _("give table, or remove it")) for key in wrong]
    over = given.get("over")
    problems = []
    if over in OVER and over not in may_be:
        what = _("the table of a torque is over {choices}")
        said = what.format(choices=", ".join(map(value_text, may_be)))
        problems.append(Problem(said, _("choose one of them"), ("over",)))
    if given.get("measured_from") is not None and over != STROKE:
        what = _("measured_from is used with a table over the stroke only")
        problems.append(Problem(what, _('remove it, or write over = "stroke"')))
    piston = [key for key in _OF_PISTON if given.get(key) is not None]
    if len(piston) == 1:
        problems.append(missing_key(next(key for key in _OF_PISTON if key not in piston)))
    return problems


def _of_friction(given: Mapping[str, Any], present: set[str], said: set[str]) -> list[Problem]:
    """Friction is as great as its keys say together; the plain sum is one of quadratic friction in hinges."""
    amounts = [key for key in FRICTION_SIZES if key in present]
    if not amounts:
        return [Problem(_("one of {keys} is missing").format(keys=", ".join(FRICTION_SIZES)))]
    problems = _of_dry(given, present)
    if problems:
        return problems
    if "coefficient" in amounts:
        if len(amounts) > 1:
            what = _("{names} are given together").format(names=", ".join(amounts))
            return [Problem(what, _("keep the coefficient, or the others"))]
        return _of_static_coefficient(given) or _of_coefficient(present, said)
    wrong = [key for key in ("point", *_OF_COEFFICIENT, *_OF_HINGE, *_OF_SLIDER) if key in said]
    if wrong:
        what = _("{key} is used with Coulomb friction only")
        repair = _("give coefficient in place of {keys}").format(keys=", ".join(amounts))
        return [Problem(what.format(key=value_text(key)), repair) for key in wrong]
    if given.get("form") == "plain sum" and (amounts != ["quadratic"] or "link" not in present):
        what = _("the plain sum is used with quadratic friction in a hinge only")
        return [Problem(what, _("remove form, or give quadratic alone"))]
    return []


def _of_dry(given: Mapping[str, Any], present: set[str]) -> list[Problem]:
    """What sticks needs dry friction of a given size; a belt runs along a guide."""
    if "static" in present and "value" not in present:
        return [
            Problem(_("static is used with the value of dry friction only"), _("give value, or remove it"))
        ]
    if "surface_speed" in present and "guide" not in present:
        what = _("surface_speed is used with friction in a guide only")
        return [Problem(what, _("remove it, or give guide"))]
    kinetic, static = given.get("value"), given.get("static")
    numbers = [x for x in (kinetic, static) if isinstance(x, int | float) and not isinstance(x, bool)]
    if len(numbers) == 2 and numbers[1] < numbers[0]:
        what = _("static ({static:.9g}) is at least the value ({value:.9g}): what sticks holds more")
        return [Problem(what.format(static=static, value=kinetic), _("exchange or correct them"))]
    return []


def _of_static_coefficient(given: Mapping[str, Any]) -> list[Problem]:
    """What sticks holds at least as much as what slips rubs."""
    kinetic, static = given.get("coefficient"), given.get("static_coefficient")
    numbers = [x for x in (kinetic, static) if isinstance(x, int | float) and not isinstance(x, bool)]
    if len(numbers) == 2 and numbers[1] < numbers[0]:
        what = _(
            "static_coefficient ({static:.9g}) is at least the coefficient ({value:.9g}): what sticks holds more"
        )
        return [Problem(what.format(static=static, value=kinetic), _("exchange or correct them"))]
    return []


def _of_coefficient(present: set[str], said: set[str]) -> list[Problem]:
    """A hinge has a point and the radius of its pin; a guide, a slider."""
    problems = []
    if "guide" in present:
        wrong = [key for key in (*_OF_HINGE, "relative_to", "axis", "form") if key in said]
        what, repair = _("{key} is used with friction in a hinge only"), _("remove it, or give point")
    else:
        if "point" not in present:
            what = _("Coulomb friction in a hinge needs the point of the hinge")
            problems.append(
                Problem(
                    what,
                    _(
                        "give point and radius; link names the link that rubs, pin the link in which the pin is fixed"
                    ),
                )
            )
        elif "radius" not in present:
            problems.append(Problem(_("the radius of the pin is missing"), _("give radius")))
        wrong = [key for key in (*_OF_SLIDER, "relative_to", "axis", "form") if key in said]
        what, repair = _("{key} is not used with Coulomb friction there"), _("remove it")
    return problems + [Problem(what.format(key=value_text(key)), repair) for key in wrong]


def _foreign(key: str, kind: str) -> Problem:
    alternatives, needed, allowed = _KEYS_OF[kind]
    known = (*alternatives, *needed, *allowed)
    what = _("{key} is not used with a {kind}").format(key=value_text(key), kind=kind)
    return Problem(what, _("it has: {keys}").format(keys=", ".join(known)))


LOAD_VARIABLES = ("t", "q", "x", "v")
"""Time, the drive's value, and the coordinate and the speed the load works along, in formulas of loads."""

Amount = float | str
Kinds = Literal["force", "torque", "spring", "damper", "weight", "friction"]
KINDS: tuple[Kinds, ...] = get_args(Kinds)

Form = Literal["virtual work", "plain sum"]
VIRTUAL_WORK: Form = "virtual work"
PLAIN_SUM: Form = "plain sum"
FORMS = (VIRTUAL_WORK, PLAIN_SUM)
Fit = Literal["clearance", "new", "worn-in"]
CLEARANCE: Fit = "clearance"
FITS = (CLEARANCE, "new", "worn-in")
LEAST_ROWS = 2
Over = Literal["displacement", "stroke", "drive", "time"]
DISPLACEMENT, STROKE, DRIVE, TIME = OVER = get_args(Over)
"""What the rows of a table are given over: along the guide, its share of the stroke, the value of the drive, time."""
StrokeEnd = Literal["least", "greatest"]
LEAST, GREATEST = STROKE_ENDS = get_args(StrokeEnd)
"""Displacement at which the share of the stroke is zero."""

_KEYS = (
    *("kind", "name", "point", "link", "guide", "points", "vector", "axes", "value"),
    *("over", "measured_from", "pressure", "diameter", "table", "stiffness"),
    *(
        "damping",
        "viscous",
        "quadratic",
        "static",
        "surface_speed",
        "coefficient",
        "static_coefficient",
        "radius",
        "fit",
        "pin",
        "length",
        "height",
        "form",
    ),
    *("free_length", "free_angle", "relative_to", "axis", "while_moving"),
)
LOAD_DEFAULTS: Mapping[str, str | None] = dict.fromkeys(_KEYS) | {
    "axes": FRAME,
    "fit": CLEARANCE,
    "form": VIRTUAL_WORK,
    "relative_to": FRAME,
}
"""Every key that some load has, in the order of a file, with what it is where it is left out."""


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


def _resistance(kind: str) -> PlainValidator:
    """A number of a kind that is not negative, or none."""
    return PlainValidator(lambda value: None if value is None else not_negative(value, kind))


def _amount_or_none(kind: str) -> PlainValidator:
    """An amount of a kind, or none."""
    return PlainValidator(lambda value: None if value is None else _amount(value, kind))


def _dry_friction(kind: str) -> PlainValidator:
    """An amount of a kind that is not negative where it is a number, or none."""

    def read(value: object) -> Amount | None:
        if value is None:
            return None
        amount = _amount(value, kind)
        return amount if isinstance(amount, str) else not_negative(amount, kind)

    return PlainValidator(read)


Rows = tuple[tuple[float, ...], ...]


def _read_diagram(value: object, over: Over, kind: str) -> Rows | None:
    """Rows of a table; `kind` is that of its forces."""
    if value is None:
        return None
    rows = read_rows(value, _columns_over(over, kind), READING.get().folder)
    if len(rows) < LEAST_ROWS or any(not low[0] < high[0] for low, high in pairwise(rows)):
        what = _("a diagram needs two rows or more, with displacements that increase")
        repair = _("sort the rows, and keep one of equal displacements")
        if over != DISPLACEMENT:
            what = _("a table needs two rows or more, with first numbers that increase")
            repair = _("sort the rows, and keep one of equal first numbers")
        raise Problem(what, repair)
    if over == STROKE and (rows[0][0], rows[-1][0]) != (0.0, 1.0):
        what = _("a table over the stroke begins at 0 and ends at 1")
        raise Problem(what, _("give shares of the stroke, from 0 to 1"))
    return rows


def _columns_over(over: Over, kind: str) -> TableColumns:
    """Columns of a table over something, whose forces are of a kind."""
    match over:
        case "displacement":
            return TableColumns(("length", kind, kind), "[displacement, force, force]", 2)
        case "stroke":
            return TableColumns(("ratio", kind, kind), "[s/H, force, force]", 2)
        case "drive":
            return TableColumns((READING.get().parameter.variable.kind, kind), "[drive, force]", 2)
        case "time":
            return TableColumns(("time", kind), "[time, force]", 2)
        case _:
            assert_never(over)


ForceAmount = Annotated[Amount | None, _amount_or_none("force")]
Pressure = Annotated[
    float | None, PlainValidator(lambda value: None if value is None else si(value, "pressure"))
]
Axis = Annotated[str | tuple[float, ...], PlainValidator(_read_axis)] | None
FreeLength = Annotated[float, PlainValidator(lambda value: not_negative(value, "length"))] | None
TwoPoints = Annotated[tuple[Name, ...], bounded_list(2)]

# The loads themselves. Each has the keys that mean something for it, in the order in which a file has them.


class Load(DescriptionPart):
    """What every load has; `AnyLoad` is the union of them.

    Attributes
    ----------
    kind : one of `KINDS`
    name : str or None
        What results call it; left out, its kind and what it acts on.
    """

    # built when the first load is read: most mechanisms have none
    model_config = ConfigDict(defer_build=True)

    kind: Annotated[Kinds, choice(*KINDS)]
    name: Name | None = None

    @classmethod
    def keys(cls) -> dict[str, str]:
        """Field of each key; of what every load has, those of all loads."""
        return {key: key for key in LOAD_DEFAULTS} if cls is Load else super().keys()

    @property
    def place(self) -> str:
        """What it acts on: a point, a link, a guide, or two points."""
        places = (getattr(self, key, None) for key in ("point", "link", "guide", "points"))
        place = next(place for place in places if place is not None)
        return place if isinstance(place, str) else "-".join(place)

    @property
    def label(self) -> str:
        """What it is called where its `name` does not say so: "force H", "spring A-D"."""
        return self.name or f"{self.kind} {self.place}"


class PointForce(Load):
    """A force in a point.

    Attributes
    ----------
    vector : (x, y) [N], each a number or a formula; on the sphere (x, y, z)
    axes : "frame" or the link whose axes `vector` is given in
    while_moving : (x, y); on the sphere (x, y, z)
        The force acts only while its point moves this way.
    """

    kind: Literal["force"]
    point: Name
    vector: Annotated[tuple[Amount, ...], PlainValidator(_read_force)]
    axes: Name = FRAME
    while_moving: Heading | None = None


class GuideForce(Load):
    """A force along a guide, by its value [N] or by an indicator diagram.

    Attributes
    ----------
    over : what the rows of the table are given over
        The displacement along the guide [m], its share of the stroke, the value of the drive [rad or m], or time [s].
    measured_from : "least" or "greatest"
        Over the stroke: the displacement at which the share is 0.
    pressure, diameter : float [Pa], [m]
        The table has pressures as shares of this one, which acts on a piston of this diameter; along the guide where
        the pressure is positive, against it where it is negative.
    table : rows of (displacement [m], force [N]) or (displacement, force forwards, force backwards)
        In a file it may be the path of a CSV file beside it. Over the drive and over time a row has one force.
    """

    kind: Literal["force"]
    guide: Name
    value: ForceAmount = None
    over: Annotated[Over, choice(*OVER)] | None = None
    measured_from: Annotated[StrokeEnd, choice(*STROKE_ENDS)] | None = None
    pressure: Pressure = None
    diameter: PositiveLength | None = None
    table: Rows | None = None

    @field_validator("table", mode="plain")
    @classmethod
    def _table(cls, value: object, info: ValidationInfo) -> Rows | None:
        shares = info.data.get("pressure") is not None
        return _read_diagram(value, info.data.get("over") or DISPLACEMENT, "ratio" if shares else "force")

    @property
    def factor(self) -> float:
        """What a force of the table is multiplied by: 1, or the greatest force on a piston [N]."""
        if self.pressure is None or self.diameter is None:
            return 1.0
        return 0.25 * pi * self.diameter**2 * self.pressure


class Torque(Load):
    """A torque [N m] on a link, against another, by its value or by a table.

    Attributes
    ----------
    over : "drive" or "time"
        What the rows of the table are given over: the value of the drive [rad or m], if left out, or time [s].
    table : rows of (value of the drive or time, torque [N m])
    relative_to : "frame" or the link against which it works
    axis : a point's name, or (x, y, z) in the axes of the frame
        On the sphere: about what it works, where the links do not share exactly one point.
    """

    kind: Literal["torque"]
    link: Name
    value: Annotated[Amount | None, _amount_or_none("torque")] = None
    over: Annotated[Over, choice(*OVER)] | None = None
    table: Rows | None = None
    relative_to: Name = FRAME
    axis: Axis = None

    @field_validator("table", mode="plain")
    @classmethod
    def _table(cls, value: object, info: ValidationInfo) -> Rows | None:
        return _read_diagram(value, info.data.get("over") or DRIVE, "torque")


class PointSpring(Load):
    """A spring between two points: its stiffness [N/m] and its length without force [m]."""

    kind: Literal["spring"]
    points: TwoPoints
    stiffness: Annotated[float, _resistance("stiffness")]
    free_length: FreeLength = None


class HingeSpring(Load):
    """A spring between two links: its stiffness [N m/rad] and its angle without moment [rad].

    `relative_to` and `axis` are as of a torque.
    """

    kind: Literal["spring"]
    link: Name
    stiffness: Annotated[float, _resistance("angular stiffness")]
    free_angle: Angle | None = None
    relative_to: Name = FRAME
    axis: Axis = None


class PointDamper(Load):
    """A damper between two points [N s/m]."""

    kind: Literal["damper"]
    points: TwoPoints
    damping: Annotated[float, _resistance("damping")]


class HingeDamper(Load):
    """A damper between two links [N m s/rad]; `relative_to` and `axis` are as of a torque."""

    kind: Literal["damper"]
    link: Name
    damping: Annotated[float, _resistance("angular damping")]
    relative_to: Name = FRAME
    axis: Axis = None


class LinkWeight(Load):
    """The weight of a link, in its centre of mass [N]; mass times gravity if `value` is left out."""

    kind: Literal["weight"]
    link: Name
    value: ForceAmount = None


class PointWeight(Load):
    """A weight in a point [N]."""

    kind: Literal["weight"]
    point: Name
    value: ForceAmount = None


class HingeFriction(Load):
    """Friction of a given size between two links.

    Attributes
    ----------
    value : dry friction: its moment against the motion [N m]
    static : the greatest moment by which it holds what does not slip [N m]; that of `value` by default
    viscous, quadratic : what grows with the relative speed and with its square [N m s/rad, N m s^2/rad^2]
    form : "virtual work" or "plain sum"
        The plain sum takes the moments of quadratic friction from the driving moment as they are, as a source does.
    relative_to, axis : as of a torque
    """

    kind: Literal["friction"]
    link: Name
    value: Annotated[Amount | None, _dry_friction("torque")] = None
    viscous: Annotated[float | None, _resistance("angular damping")] = None
    quadratic: Annotated[float | None, _resistance("angular quadratic damping")] = None
    static: Annotated[float | None, _resistance("torque")] = None
    form: Annotated[Form, choice(*FORMS)] = VIRTUAL_WORK
    relative_to: Name = FRAME
    axis: Axis = None

    surface_speed: ClassVar[float] = 0.0


class GuideFriction(Load):
    """Friction of a given size in a guide: dry [N], viscous [N s/m] and quadratic [N s^2/m^2].

    Attributes
    ----------
    static : the greatest force by which it holds what does not slip [N]; that of `value` by default
    surface_speed : of the belt against which it rubs, along the guide [m/s]
    """

    kind: Literal["friction"]
    guide: Name
    value: Annotated[Amount | None, _dry_friction("force")] = None
    viscous: Annotated[float | None, _resistance("damping")] = None
    quadratic: Annotated[float | None, _resistance("quadratic damping")] = None
    static: Annotated[float | None, _resistance("force")] = None
    surface_speed: Annotated[float, quantity("speed")] = 0.0


class BearingFriction(Load):
    """Friction in the hinge of a point that grows with the reaction.

    Attributes
    ----------
    link : str or None
        Which link rubs; all but the one with the pin if left out.
    radius, fit, pin : float [m], "clearance", "new" or "worn-in", the name of a link
        Of the pin of the hinge; how its bearings fit; the link that the pin is fixed in.
    static_coefficient : float or None
        Of what sticks in a simulation; `coefficient` if left out.
    """

    kind: Literal["friction"]
    point: Name
    link: Name | None = None
    coefficient: Annotated[float, quantity("ratio", not_negative)]
    static_coefficient: Annotated[float | None, _resistance("ratio")] = None
    radius: PositiveLength
    fit: Annotated[Fit, choice(*FITS)] = CLEARANCE
    pin: Name | None = None

    @property
    def greatest_coefficient(self) -> float:
        """Coefficient of what sticks."""
        return self.coefficient if self.static_coefficient is None else self.static_coefficient


class SliderFriction(Load):
    """Friction in a guide that grows with the reaction.

    Attributes
    ----------
    static_coefficient : float or None
        Of what sticks in a simulation; `coefficient` if left out.
    surface_speed : float [m/s]
        Of the belt against which it rubs, along the guide.
    length, height : float [m]
        Of the slider, along and across; by them it tilts, and friction has an arm.
    """

    kind: Literal["friction"]
    guide: Name
    surface_speed: Annotated[float, quantity("speed")] = 0.0
    coefficient: Annotated[float, quantity("ratio", not_negative)]
    static_coefficient: Annotated[float | None, _resistance("ratio")] = None
    length: PositiveLength | None = None
    height: PositiveLength | None = None

    @property
    def greatest_coefficient(self) -> float:
        """Coefficient of what sticks."""
        return self.coefficient if self.static_coefficient is None else self.static_coefficient


TurningLoad: TypeAlias = Torque | HingeSpring | HingeDamper | HingeFriction
"""Loads along the angle between two links."""
CoefficientFriction: TypeAlias = BearingFriction | SliderFriction
"""Friction that needs the reactions, which need it."""
AnyLoad: TypeAlias = (
    PointForce
    | GuideForce
    | Torque
    | PointSpring
    | HingeSpring
    | PointDamper
    | HingeDamper
    | LinkWeight
    | PointWeight
    | HingeFriction
    | GuideFriction
    | BearingFriction
    | SliderFriction
)


def _class_of(kind: Kinds, given: Mapping[str, Any]) -> type[AnyLoad]:
    """The load that keys without problems describe."""
    match kind:
        case "force":
            return PointForce if "point" in given else GuideForce
        case "torque":
            return Torque
        case "spring":
            return PointSpring if "points" in given else HingeSpring
        case "damper":
            return PointDamper if "points" in given else HingeDamper
        case "weight":
            return PointWeight if "point" in given else LinkWeight
        case "friction":
            if "coefficient" in given:
                return SliderFriction if "guide" in given else BearingFriction
            return GuideFriction if "guide" in given else HingeFriction
        case _:
            assert_never(kind)


def read_load(value: object) -> AnyLoad:
    """A load from the table of a file; raises Problems that say which key is wrong.

    Keys that mean nothing for the load are left out where they are none of its kind's or have their defaults.
    """
    if isinstance(value, AnyLoad):
        return value
    if not isinstance(value, Mapping):
        raise Problem(_("expected a table, got {value}").format(value=value_text(value)))
    given = {key: entry for key, entry in value.items() if entry is not None}
    unknown = unknown_keys(value, LOAD_DEFAULTS)
    if unknown or "kind" not in value:
        raise Problems([*unknown, *([] if "kind" in value else [missing_key("kind")])])
    try:
        kind = read_choice(value["kind"], KINDS)
    except Problem as problem:
        raise Problem(problem.what, problem.repair, ("kind",)) from None
    problems = load_key_problems(kind, given)
    if problems:
        raise Problems(problems)
    load = _class_of(kind, given)
    own = {key: value[key] for key, _field in load.keys().items() if key in value}
    try:
        return load.model_validate(own)
    except ValidationError as error:
        raise Problems(problems_within(error)) from None


def numbered_names(names: Iterable[str]) -> list[str]:
    """Names of loads in results and in paths: those that occur again are numbered ("weight AB 2")."""
    found: list[str] = []
    for name in names:
        number, label = 1, name
        while label in found:
            number += 1
            label = f"{name} {number}"
        found.append(label)
    return found
