"""Tolerances of a description: limits of its dimensions, play in its joints, and what has to stay within bounds."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal, TypeAlias

from pydantic import PlainValidator, ValidationError, model_validator

from centrode.errors import InputError
from centrode.locale import _
from centrode.model import reading
from centrode.model.limits_and_fits import ToleranceClass, looks_like_class, tolerance_class
from centrode.model.reading import (
    AS_DICT,
    KEY,
    DescriptionPart,
    FrozenMap,
    Problem,
    Problems,
    at_most_one_of,
    bounded_list,
    choice,
    entries,
    entries_by_path,
    nearest,
    read_name,
    value_text,
)
from centrode.model.values import READING, PositiveMetres, Text, positive, read_text, si

Limits: TypeAlias = tuple[float, float]
"""Lower and upper deviation from the description's own number [SI]."""
Distribution: TypeAlias = Literal["normal", "uniform", "triangular"]
DISTRIBUTIONS = ("normal", "uniform", "triangular")
ROOMS = ("links", "frame", "guides", "gears", "rolling")
"""First words of paths that may have a tolerance: dimensions, and masses of links."""
MOST_PATHS = 100
MOST_OUTPUTS = 50

_EACH_SIDE = re.compile(r"\s*(?:±|\+-|\+/-)\s*(.+)", re.DOTALL)
_MASSES = {"mass": "mass", "inertia": "inertia"}
_ANGLES = ("angle", "direction", "longitude", "latitude")
_COORDINATES = ("x", "y", "longitude", "latitude")


def kind_of_dimension(path: str, space: str) -> str:
    """Kind of the number that a path of one of ROOMS names, by its last word."""
    words = path.split(".")
    last = words[-1]
    if last in _MASSES:
        return last
    if last in _ANGLES:
        return "angle"
    # of links only the radii and the centres of mass are metres on the sphere
    of_mass = words[0] == "links" and (last in ("radius", "centre_radius") or "centre" in words[2:-1])
    return "ratio" if last == "ratio" else "length" if space == "plane" or of_mass else "arc"


def is_size(path: str, space: str) -> bool:
    """Whether a path names the size of a feature, which standard grades are for: no angle, arc, ratio or coordinate."""
    return kind_of_dimension(path, space) == "length" and path.rpartition(".")[2] not in _COORDINATES


def read_limits(value: object, kind: str) -> Limits:
    """Limits [SI] of a kind: "±0.1 mm", a number for as much to each side, or [lower, upper]."""
    if isinstance(value, list | tuple):
        if len(value) != 2:
            what = _("limits are a lower and an upper deviation, got {value}")
            raise Problem(what.format(value=value_text(list(value))), _('write ["-0.1 mm", "0.2 mm"]'))
        lower, upper = si(value[0], kind), si(value[1], kind)
        if lower > upper:
            what = _("the lower limit {lower} lies above the upper one {upper}")
            raise Problem(
                what.format(lower=value_text(value[0]), upper=value_text(value[1])), _("exchange the two")
            )
        return lower, upper
    if isinstance(value, str):
        match = _EACH_SIDE.fullmatch(value)
        if match is None:
            repair = _('write "±{value}", or both limits: ["-0.1 mm", "0.2 mm"]')
            repair = repair.format(value=value.strip().lstrip("+-").strip())
            what = _("it is not clear to which side {value} goes")
            raise Problem(what.format(value=value_text(value)), repair)
        value = match[1]
    width = si(value, kind)
    if width < 0:
        what = _("a tolerance cannot be negative, got {value}")
        raise Problem(what.format(value=value_text(value)), _("give how far the number may lie to each side"))
    return -width, width


def _read_tolerance(value: object, kind: str, size: bool) -> Limits | str:
    """Limits, or the name of a class where the path names a size."""
    if not isinstance(value, str) or not looks_like_class(value):
        return read_limits(value, kind)
    if not size:
        what = _("grades are for lengths of links and radii, not for angles, arcs, ratios or coordinates")
        raise Problem(what, _('give limits: "±0.1 mm"'))
    return str(_class_of(value))


def _class_of(text: str) -> ToleranceClass:
    try:
        return tolerance_class(text)
    except InputError as error:
        raise Problem(error.what, error.repair) from None


def _read_dimensions(value: object) -> Mapping[str, Limits | str]:
    """Path -> limits or class; a file may write paths as keys with dots or as tables within each other."""
    assert isinstance(value, Mapping)
    space = READING.get().space
    read: dict[str, Limits | str] = {}
    wrong: list[Problem] = []
    for path, entry in entries_by_path(value):
        try:
            room = path.partition(".")[0]
            if room not in ROOMS:
                known = [*Tolerances.keys(), *ROOMS]
                what = _("unknown key {key}: a tolerance belongs to a dimension or to the mass of a link")
                raise Problem(what.format(key=value_text(path)), nearest(room, known))
            read[path] = _read_tolerance(entry, kind_of_dimension(path, space), is_size(path, space))
        except Problem as problem:
            wrong.append(Problem(problem.what, problem.repair, (path,)))
    entries(list(read), MOST_PATHS)
    if wrong:
        raise Problems(wrong)
    return FrozenMap(read)


def _read_default(value: object) -> Limits | str:
    if isinstance(value, str) and looks_like_class(value):
        return str(_class_of(value))
    return read_limits(value, READING.get().length)


class Clearance(DescriptionPart):
    """Play of a pin in its hole, or of a slider in its guide.

    Attributes
    ----------
    play : float [m], on the sphere an arc [rad]
        How far the pin's centre may lie from that of the hole: half the difference of the diameters; of a slider how
        far it may leave the middle of its guide to each side.
    length : float [m]
        Of a slider that its guide keeps from turning: over which it lies in the guide. Without it the slider does not
        tilt.
    """

    play: Annotated[float, PlainValidator(lambda value: positive(value, READING.get().length))]
    length: PositiveMetres | None = None

    @model_validator(mode="before")
    @classmethod
    def _short(cls, data: Any) -> Any:
        return data if isinstance(data, Mapping | Clearance) else {"play": data}


def _read_clearances(value: object) -> Mapping[str, Clearance]:
    return FrozenMap(_named_parts(value, Clearance, reading.POINTS, _read_joint))


def _read_joint(value: object) -> str:
    """The name of a pin or a guide, or of a pin and a link of it: "B/AB"."""
    pin, slash, link = value.partition("/") if isinstance(value, str) else (value, "", "")
    return f"{read_name(pin)}/{read_name(link)}" if slash else read_name(value)


class ToleranceOutput(DescriptionPart):
    """What tolerances act on: a quantity of the motion, with the bounds that it has to keep.

    Attributes
    ----------
    formula : str
        A quantity ("position.B.x"), or a formula ("range(position_B_x)").
    within : (lower, upper)
        Bounds of its value in the unit of the output [SI]; None where it has none.
    deviation : float
        By how much it may differ from its nominal value to each side, in place of `within` [SI].
    unit : str
        SI unit of a formula's value, for figures; that of the quantity where it is one.
    """

    formula: Annotated[str, PlainValidator(read_text)]
    within: Annotated[Limits | None, PlainValidator(lambda value: _read_bounds(value))] = None
    deviation: Annotated[float | None, PlainValidator(lambda value: _read_deviation(value))] = None
    unit: Text = ""

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given."""
        return super().key_problems(given) + at_most_one_of(given, ("within", "deviation"))

    @model_validator(mode="before")
    @classmethod
    def _short(cls, data: Any) -> Any:
        return data if isinstance(data, Mapping | ToleranceOutput) else {"formula": data}


UNITS_OF_BOUNDS = ("length", "angle", "speed", "angular speed", "force", "torque", "ratio")


def _read_bounds(value: object) -> Limits | None:
    if value is None:
        return None
    if not isinstance(value, list | tuple) or len(value) != 2:
        what = _("bounds are the least and the greatest value, got {value}")
        raise Problem(what.format(value=value_text(value)), _('write ["1.57 m", "1.59 m"]'))
    least, greatest = (_number_of_some_kind(one) for one in value)
    if not least < greatest:
        what = _("the bounds {least} and {greatest} leave nothing between them")
        raise Problem(what.format(least=value_text(value[0]), greatest=value_text(value[1])))
    return least, greatest


def _read_deviation(value: object) -> float | None:
    if value is None:
        return None
    match = _EACH_SIDE.fullmatch(value) if isinstance(value, str) else None
    number = _number_of_some_kind(match[1] if match else value)
    if not number > 0.0:
        raise Problem(_("{key} must be positive, got {value}").format(key=KEY, value=value_text(value)))
    return number


def _number_of_some_kind(value: object) -> float:
    """A number whose kind only the output knows: the first kind that its unit fits."""
    for kind in UNITS_OF_BOUNDS[:-1]:
        try:
            return float(si(value, kind))
        except Problem:
            continue
    return float(si(value, UNITS_OF_BOUNDS[-1]))


def _read_outputs(value: object) -> Mapping[str, ToleranceOutput]:
    return FrozenMap(_named_parts(value, ToleranceOutput, MOST_OUTPUTS, read_name))


def _named_parts(
    value: object, part: type[Any], most: int, read_key: Callable[[object], str]
) -> dict[str, Any]:
    if not isinstance(value, Mapping):
        raise Problem(_("expected a table, got {value}").format(value=value_text(value)))
    entries(list(value), most)
    read: dict[str, Any] = {}
    wrong: list[Problem] = []
    for key, entry in value.items():
        try:
            read[read_key(key)] = entry if isinstance(entry, part) else part.model_validate(entry)
        except ValidationError as error:
            wrong += [Problem(x.what, x.repair, (key, *x.at)) for x in reading.problems_within(error)]
        except Problem as problem:
            wrong.append(Problem(problem.what, problem.repair, (str(key),)))
    if wrong:
        raise Problems(wrong)
    return read


class Correlation(DescriptionPart):
    """Numbers that deviate together, as holes drilled in one setting do.

    Attributes
    ----------
    paths : at least two paths that have tolerances
    value : coefficient of correlation of each two of them, from -1 to 1
    """

    paths: Annotated[tuple[Text, ...], bounded_list(MOST_PATHS)]
    value: Annotated[float, PlainValidator(lambda value: _coefficient(value))]

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given."""
        wrong = super().key_problems(given)
        paths = given.get("paths")
        if not wrong and isinstance(paths, Sequence) and len(set(map(str, paths))) < 2:
            wrong.append(Problem(_("a correlation has two paths or more"), "", ("paths",)))
        return wrong


def _coefficient(value: object) -> float:
    number = si(value, "ratio")
    if not -1.0 <= number <= 1.0:
        what = _("{key} must lie between {least} and {most}, got {value}")
        raise Problem(what.format(key=KEY, least=-1, most=1, value=value_text(value)))
    return number


class Tolerances(DescriptionPart):
    """Tolerances of a mechanism; a file writes the paths of dimensions among the other keys.

    Attributes
    ----------
    default : limits or class
        Of every length that has none of its own; a class is that of the lengths of links and radii. None: such numbers
        are exact.
    distribution : "normal", "uniform" or "triangular"
        Within the limits; the limits of a normal one lie three standard deviations from its mean.
    dimensions : path -> (lower, upper) [SI], or the name of a class of ISO 286
    clearances : pin, or guide -> play; "B/AB" is the play of link AB on the pin B alone
    correlations : numbers that deviate together
    outputs : name -> what the tolerances act on

    Examples
    --------
    >>> from centrode.model.tolerances import Tolerances
    >>> Tolerances(dimensions={"links.AB.length": "±0.1 mm"}).dimensions["links.AB.length"]
    (-0.0001, 0.0001)
    """

    default: Annotated[Limits | str | None, PlainValidator(lambda value: value and _read_default(value))] = (
        None
    )
    distribution: Annotated[Distribution, choice(*DISTRIBUTIONS)] = "normal"
    dimensions: Annotated[Mapping[str, Limits | str], PlainValidator(FrozenMap), AS_DICT] = FrozenMap({})
    clearances: Annotated[Mapping[str, Clearance], PlainValidator(_read_clearances), AS_DICT] = FrozenMap({})
    correlations: Annotated[tuple[Correlation, ...], bounded_list(MOST_PATHS)] = ()
    outputs: Annotated[Mapping[str, ToleranceOutput], PlainValidator(_read_outputs), AS_DICT] = FrozenMap({})

    among_keys: ClassVar[str] = "dimensions"

    @model_validator(mode="before")
    @classmethod
    def _gather_paths(cls, data: Any) -> Any:
        if not isinstance(data, Mapping):
            return data
        known = cls.keys()
        own = {key: value for key, value in data.items() if key in known}
        paths = {key: value for key, value in data.items() if key not in own}
        given = own.get(cls.among_keys, {})
        if not isinstance(given, Mapping):
            raise Problem(_("expected a table, got {value}").format(value=value_text(given)))
        both = {**given, **paths}
        # read here and not by the field, so that a problem is told at the path as the file has it
        return {**own, cls.among_keys: _read_dimensions(both)} if both else own

    @property
    def is_empty(self) -> bool:
        """Whether nothing has a tolerance or play."""
        return self.default is None and not self.dimensions and not self.clearances
