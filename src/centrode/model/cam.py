"""The description of a cam: one frozen datum that paths, profiles, movers and stresses are derived from."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, TypeVar

from pydantic import Field, PlainValidator, ValidationInfo, field_validator, model_validator

from centrode.errors import InputError
from centrode.locale import _
from centrode.model import reading
from centrode.model.links import part_tables
from centrode.model.reading import (
    KEY,
    DescriptionPart,
    FrozenMap,
    Problem,
    Problems,
    bounded_list,
    choice,
    likely,
    missing_key,
    named_entries,
    nearest,
    value_text,
)
from centrode.model.settings import CamReportWishes, Display, read_samples
from centrode.model.values import (
    READING,
    Angle,
    Flag,
    TableColumns,
    Text,
    not_negative,
    positive,
    quantity,
    read_rows,
    read_text,
    si,
)
from centrode.numerics.text_formula import compile_formula

# Values of a cam's description: points and formulas of curvatures, bounds, parameters to be chosen.

_POINTS = TableColumns(("angle", "curvature"), "[angle, curvature]", 2)
MOST_PARAMETERS = 8
MOST_CONSTANTS = 20
LETTER = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def read_points(value: object) -> tuple[tuple[float, float], ...]:
    """Points of a spline, (phi [rad], K [1/m]), from rows or a CSV file."""
    rows = read_rows(value, _POINTS, READING.get().folder)
    if len(rows) < 2:
        raise Problem(_("a spline needs at least two points of an angle and a curvature"), _("add points"))
    return tuple((row[0], row[1]) for row in rows)


def read_formula(value: object, constants: Iterable[str] = ()) -> str:
    """The text of a formula of phi and of further letters."""
    text = read_text(value)
    try:
        compile_formula(text, ("phi", *constants), "")
    except InputError as error:
        raise Problem(error.what, error.repair) from None
    return text


def read_constants(value: object) -> FrozenMap[str, float]:
    """Letters of a formula with their values in SI."""
    named = named_entries(value, _read_letter, MOST_CONSTANTS)
    return FrozenMap({name: si(number, "ratio") for name, number in named.items()})


def _read_letter(key: object) -> str:
    name = str(key)
    if LETTER.fullmatch(name) and name not in ("phi", "pi", "e"):
        return name
    what = _("{name} cannot be a letter of a formula").format(name=value_text(name))
    raise Problem(
        what, _("use letters, digits and underscores, and begin with a letter; phi, pi and e are reserved")
    )


def read_steepness(value: object, kind: str) -> float:
    """A greatest pressure angle [rad], below a right angle."""
    number = positive(value, kind)
    if number >= math.pi / 2:
        what = _("{key} must be smaller than 90 deg, got {value}").format(key=KEY, value=value_text(value))
        raise Problem(what, _("at 90 deg the follower stalls"))
    return number


def read_poisson(value: object, kind: str) -> float:
    """A Poisson's ratio."""
    number = si(value, kind)
    if not 0 <= number <= 0.5:
        what = _("{key} must lie between 0 and 0.5, got {value}").format(key=KEY, value=value_text(value))
        raise Problem(what, _("it is 0.3 for steel"))
    return number


def whole(least: int, most: int) -> PlainValidator:
    """A whole number between bounds."""

    def read(value: object) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
            what = _("{key} must be a whole number from {least} to {most}, got {value}")
            raise Problem(what.format(key=KEY, least=least, most=most, value=value_text(value)))
        return value

    return PlainValidator(read)


PARAMETERS = {
    "curvature.k0": ("curvature",),
    "curvature.k1": ("per angle", "curvature slope"),
    "start.radius": ("length",),
    "start.pressure_angle": ("angle",),
    "roller.radius": ("length",),
}
"""What may be chosen, and the kinds of quantity it may be."""

POINT = re.compile(r"curvature\.points\.[1-9][0-9]{0,4}")
"""The curvature at one of a spline's points, counted from 1, may be chosen too."""

CONSTANT = re.compile(r"curvature\.constants\.[A-Za-z][A-Za-z0-9_]*")
"""And a letter of a formula, in SI."""


def read_parameters(value: object) -> FrozenMap[str, tuple[float, float]]:
    """Names of `PARAMETERS`, each with its least and greatest value in SI."""
    named = named_entries(value, _read_parameter, MOST_PARAMETERS)
    if not named:
        raise Problem(
            _("at least one parameter is to be chosen"),
            _("known are: {names}").format(names=", ".join(PARAMETERS)),
        )
    return FrozenMap({name: _read_bounds(name, pair) for name, pair in named.items()})


def _read_parameter(key: object) -> str:
    if isinstance(key, str) and (key in PARAMETERS or POINT.fullmatch(key) or CONSTANT.fullmatch(key)):
        return key
    what = _("{name} cannot be chosen").format(name=value_text(key))
    names = ", ".join([*PARAMETERS, "curvature.points.1", "curvature.constants.a"])
    known = _("known are: {names}").format(names=names)
    raise Problem(what, (likely(key, PARAMETERS) if isinstance(key, str) else "") or known)


def _read_bounds(name: str, pair: object) -> tuple[float, float]:
    if not isinstance(pair, list | tuple) or len(pair) != 2:
        what = _("expected {form}, got {value}").format(form=_("[least, greatest]"), value=value_text(pair))
        raise Problem(what, at=(name,))
    try:
        low, high = (_of_kinds(end, _kinds_of(name)) for end in pair)
    except Problem as problem:
        raise Problem(problem.what, problem.repair, (name,)) from None
    if not low < high:
        what = _("the least value has to be below the greatest: {low:g}, {high:g}").format(low=low, high=high)
        raise Problem(what, at=(name,))
    return low, high


def _kinds_of(name: str) -> tuple[str, ...]:
    return PARAMETERS.get(name, ("ratio",) if CONSTANT.fullmatch(name) else ("curvature",))


def _of_kinds(value: object, kinds: tuple[str, ...]) -> float:
    """A quantity of the first kind that fits."""
    for kind in kinds[:-1]:
        try:
            return si(value, kind)
        except Problem:
            continue
    return si(value, kinds[-1])


Curved = Annotated[float, quantity("curvature", positive)]
Stress = Annotated[float, quantity("pressure", positive)]
Size = Annotated[float, quantity("length", positive)]
Steepness = Annotated[float, quantity("angle", read_steepness)]


# Parts of a cam's description: curvature law, start, range, roller, return arc, mover, contact, choice,
# study.

LAWS = ("constant", "exponential", "linear", "spline", "formula")
_NEEDED: dict[str, tuple[str, ...]] = {
    "constant": ("k0",),
    "exponential": ("k0", "k1"),
    "linear": ("k0", "k1"),
    "spline": ("points",),
    "formula": ("formula",),
}
MOST_TERMS = 2000
"""Terms of a power series; the recursions cost their square."""

LEAST_LEGS, MOST_LEGS = 3, 24
MINIMISED = ("size", "stress", "pressure_angle")
OF_WHEELS = ("gap", "step")
"""Measures that a walking wheel has."""
MEASURED = (*MINIMISED, "lift", *OF_WHEELS)


class Curvature(DescriptionPart):
    """The law K(phi) of the curvature of the path of the roller's centre.

    Attributes
    ----------
    law : one of `LAWS`
    k0 : float [1/m]
        The curvature at phi = 0 of a constant, exponential or linear law.
    k1 : float
        K = k0 exp(k1 phi) with k1 [1/rad], or K = k0 + k1 phi with k1 [1/m/rad].
    points : rows of (phi [rad], K [1/m])
        What a spline passes through.
    constants : mapping of letter to number
        Letters of the formula besides phi, in SI.
    formula : str
        K [1/m] as a text formula of phi [rad].
    symmetric : bool
        Whether the law holds for phi >= 0 only, and K(-phi) = K(phi).
    """

    law: Annotated[Literal["constant", "exponential", "linear", "spline", "formula"], choice(*LAWS)]
    k0: Curved | None = None
    k1: float | None = None
    points: Annotated[tuple[tuple[float, float], ...], PlainValidator(read_points)] | None = None
    constants: Annotated[FrozenMap[str, float], PlainValidator(read_constants)] = FrozenMap({})
    formula: str | None = None
    symmetric: Flag = False

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        problems = super().key_problems(given)
        law = given.get("law")
        if law not in LAWS:
            return problems
        for key in ("k0", "k1", "points", "formula"):
            has = given.get(key) is not None
            if key in _NEEDED[law] and not has:
                problems.append(missing_key(key))
            elif has and key not in _NEEDED[law]:
                problems.append(_foreign(law, key))
        if law != "formula" and given.get("constants"):
            problems.append(_foreign(law, "constants"))
        return problems

    @field_validator("formula", mode="plain")
    @classmethod
    def _text(cls, value: object, info: ValidationInfo) -> str | None:
        return None if value is None else read_formula(value, info.data.get("constants", ()))

    @field_validator("k1", mode="plain")
    @classmethod
    def _rate(cls, value: object, info: ValidationInfo) -> float | None:
        if value is None:
            return None
        return si(value, "curvature slope" if info.data.get("law") == "linear" else "per angle")


def _foreign(law: str, key: str) -> Problem:
    what = _("a law of kind {law} has no {key}").format(law=value_text(law), key=value_text(key))
    return Problem(what, _("remove it, or change the law"))


class Start(DescriptionPart):
    """The path at phi = 0: `radius` [m] of the roller's centre, `pressure_angle` [rad] there."""

    radius: Size
    pressure_angle: Angle = 0.0


class NumberRange(DescriptionPart):
    """Ends of the path [rad], "from" and "to" in a file; phi = 0 lies between."""

    start: Annotated[Angle, Field(alias="from")] = 0.0
    stop: Annotated[Angle, Field(alias="to")]


class Roller(DescriptionPart):
    """The follower's roller: `radius` [m]."""

    radius: Size


class Return(DescriptionPart):
    """The arc that brings the roller back from the end of the working arc to its beginning.

    Attributes
    ----------
    kind : "designed" or "mirrored"
        Designed by the program, joined in value, slope and curvature; or the mirror image, with the kink it has.
    least_radius, greatest_radius : float [m]
        Bounds of rho.
    least_curvature_radius : float [m]
        Bound of the radius of curvature of the profile where it is convex.
    pressure_angle : float [rad]
        Greatest admissible one.
    convex : bool
        Whether the path has to stay convex.
    """

    kind: Annotated[Literal["designed", "mirrored"], choice("designed", "mirrored")] = "designed"
    least_radius: Size | None = None
    greatest_radius: Size | None = None
    least_curvature_radius: Size | None = None
    pressure_angle: Steepness | None = None
    convex: Flag = False


class CamMover(DescriptionPart):
    """A wheel that walks on legs.

    Attributes
    ----------
    legs : int
        N; each works over an angle of 2 pi/N.
    post : float [m]
        C, the length of the shoe's post: the hub stands at rho(0) + C.
    working_arc : (from, to) [rad]
        Where the law holds, the return arc goes over the rest; -pi/N to pi/N if left out.
    """

    legs: Annotated[int, whole(LEAST_LEGS, MOST_LEGS)]
    post: Annotated[float, quantity("length", not_negative)] = 0.0
    working_arc: Annotated[tuple[Angle, ...], bounded_list(2)] | None = None


class Material(DescriptionPart):
    """A material: `elasticity` (modulus) [Pa] and Poisson's ratio `poisson`."""

    elasticity: Stress
    poisson: Annotated[float, quantity("ratio", read_poisson)] = 0.3


class CamContact(DescriptionPart):
    """The contact of roller and cam.

    Attributes
    ----------
    force : float [N]
        P, along the follower.
    width : float [m]
        b, length of the line of contact.
    cam, roller : Material
        `roller` is of the cam's material if left out.
    admissible : float [Pa]
        Greatest contact stress.
    outer : bool
        The roller leans on the outer wall of a groove.
    """

    force: Annotated[float, quantity("force", positive)]
    width: Size
    cam: Material
    roller: Material | None = None
    admissible: Stress | None = None
    outer: Flag = False


class Choose(DescriptionPart):
    """Parameters to be chosen so that bounds hold and something is least.

    Attributes
    ----------
    parameters : mapping of name to (least, greatest)
        Names of `PARAMETERS`, numbers in SI.
    minimise : one of `MINIMISED`
    stress : float [Pa], pressure_angle : float [rad], size : float [m]
        Greatest admissible ones; the stress is that of the contact if left out, the size the greatest rho.
    lift, gap, step : float [m]
        Least ones: of rho at the end over that at phi = 0, of the ground between the prints of two shoes, and of the
        hub's travel over one leg of a walking wheel.
    trade_off : one of `MEASURED`
        Its bound is moved, to show what it costs in what is made least.
    """

    parameters: Annotated[FrozenMap[str, tuple[float, float]], PlainValidator(read_parameters)]
    minimise: Annotated[Literal["size", "stress", "pressure_angle"], choice(*MINIMISED)] = "size"
    stress: Stress | None = None
    pressure_angle: Steepness | None = None
    size: Size | None = None
    lift: Size | None = None
    gap: Size | None = None
    step: Size | None = None
    trade_off: Annotated[
        Literal["size", "stress", "pressure_angle", "lift", "gap", "step"] | None, choice(*MEASURED)
    ] = None


class CamStudy(DescriptionPart):
    """What is to be computed.

    Attributes
    ----------
    samples : int
        Evenly spaced over the range, both ends included.
    terms : int
        The power series is cut after a_terms.
    instants : tuple of float [rad]
        Angles of the carrier at which positions are shown.
    """

    samples: Annotated[int, PlainValidator(read_samples)] | None = None
    terms: Annotated[int, whole(2, MOST_TERMS)] = 20
    instants: Annotated[tuple[Angle, ...], bounded_list(reading.INSTANTS)] = ()


SomeCam = TypeVar("SomeCam", bound=DescriptionPart)


class Cam(DescriptionPart):
    """A fixed cam and a carrier that leads a roller about it, by the curvature of the roller's path.

    The arguments are those of a file (docs: cams), as parts or as plain dicts, texts with units included:
    `Cam(kind="cam", curvature={"law": "constant", "k0": "0.01 1/mm"}, start={"radius": "50 mm"}, range={"to": 1})`.
    All numbers it holds are SI.

    Attributes
    ----------
    title : str
    kind : "cam"
    display : Display
    curvature : Curvature
    start : Start
    range : NumberRange
    roller : Roller or None
    return_arc : Return or None
        "return" in a file.
    mover : CamMover or None
    contact : CamContact or None
    choose : Choose or None
    study : CamStudy
    report : CamReportWishes

    Raises
    ------
    InputError
        Anything that is not a description, with its place and the repair.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.example("cam-from-curvature").curvature.k0
    10.0
    """

    title: Text = ""
    kind: Annotated[Literal["cam"], choice("cam")]
    display: Display = Display()
    curvature: Curvature
    start: Start
    range: NumberRange
    roller: Roller | None = None
    return_arc: Annotated[Return | None, Field(alias="return")] = None
    mover: CamMover | None = None
    contact: CamContact | None = None
    choose: Choose | None = None
    study: CamStudy = CamStudy()
    report: CamReportWishes = CamReportWishes()

    if TYPE_CHECKING:

        def __init__(self, **parts: Any) -> None: ...

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        problems = [*_of_range(self), *_of_roller(self), *_of_choice(self)]
        if problems:
            raise Problems(problems)
        return self


def _of_range(cam: Cam) -> list[Problem]:
    low, high = cam.range.start, cam.range.stop
    if not low <= 0 <= high or low == high:
        what = _("the range must contain phi = 0, where the path starts")
        return [Problem(what, _('"from" must be 0 or below, "to" 0 or above'), ("range",))]
    if cam.curvature.symmetric and low:
        what = _("a symmetric law gives the path on both sides of phi = 0")
        return [Problem(what, _('omit "from"'), ("range", "from"))]
    if cam.curvature.symmetric and cam.start.pressure_angle:
        what = _("a symmetric path has a kink at phi = 0 unless the pressure angle there is zero")
        return [Problem(what, _("set it to 0, or omit symmetric"), ("start", "pressure_angle"))]
    return []


def _of_roller(cam: Cam) -> list[Problem]:
    needs = {"return": cam.return_arc, "mover": cam.mover, "contact": cam.contact}
    if cam.roller is None:
        return [
            Problem(_("{key} needs a roller").format(key=f"[{name}]"), _("give [roller] radius"), (name,))
            for name, part in needs.items()
            if part is not None
        ]
    if cam.roller.radius >= cam.start.radius:
        what = _("the roller reaches the cam's centre: its radius is not below that of its path")
        return [Problem(what, _("make it smaller"), ("roller", "radius"))]
    return []


def _of_choice(cam: Cam) -> list[Problem]:
    """What is chosen is a number that the description has; a stress is asked of a contact."""
    if cam.choose is None:
        return []
    problems = []
    for name in cam.choose.parameters:
        if not _has(cam, name):
            what = _("the cam has no {name}").format(name=value_text(name))
            problems.append(
                Problem(what, _("choose parameters that the description contains"), ("choose", "parameters"))
            )
    stressed = cam.choose.stress is not None or "stress" in (cam.choose.minimise, cam.choose.trade_off)
    if stressed and cam.contact is None:
        what = _("the contact stress needs the force, the width and the materials")
        problems.append(Problem(what, _("write a table [contact]"), ("choose",)))
    if cam.choose.trade_off == cam.choose.minimise:
        what = _("a trade-off needs two different measures")
        problems.append(Problem(what, _("name another one"), ("choose", "trade_off")))
    return problems


def _has(cam: Cam, name: str) -> bool:
    """Whether a description gives the number of a parameter's name."""
    table, _dot, key = name.partition(".")
    if POINT.fullmatch(name):
        return int(key[7:]) <= len(cam.curvature.points or ())
    if CONSTANT.fullmatch(name):
        return key[10:] in cam.curvature.constants
    return getattr(getattr(cam, table), key, None) is not None


def vary_cam(cam: SomeCam, values: Mapping[str, float | str]) -> SomeCam:
    """The cam with other numbers [SI], or texts with a unit, at paths such as "curvature.k0".

    Raises InputError for a path that it does not have.
    """
    tables = part_tables(cam)
    for path, value in values.items():
        table, _dot, key = path.partition(".")
        if not isinstance(tables.get(table), dict) or not key:
            raise InputError(
                "", _("the cam has no {name}").format(name=value_text(path)), nearest(path, tables)
            )
        if POINT.fullmatch(path):
            _put_point(tables[table], path, value)
        elif CONSTANT.fullmatch(path):
            tables[table].setdefault("constants", {})[path.rpartition(".")[2]] = value
        else:
            tables[table][key] = value
    return type(cam)(**tables)


def _put_point(curvature: dict[str, Any], path: str, value: float | str) -> None:
    points = [list(point) for point in curvature.get("points", ())]
    number = int(path.rpartition(".")[2])
    if number > len(points):
        what = _("the cam has no {name}").format(name=value_text(path))
        raise InputError("", what, _("points of a spline are counted from 1"))
    points[number - 1][1] = value
    curvature["points"] = points
