"""What a description asks for besides the mechanism: display, assembly, study."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, PlainValidator

from centrode.errors import InputError
from centrode.locale import _
from centrode.model import reading
from centrode.model.explanatory_note import ExplanatoryNote, read_prose
from centrode.model.reading import (
    AS_DICT,
    KEY,
    DescriptionPart,
    FrozenMap,
    Problem,
    bounded_list,
    choice,
    read_name,
    table,
    value_text,
)
from centrode.model.values import (
    READING,
    Angle,
    Flag,
    InstantOfMotion,
    Name,
    Text,
    angular_speed,
    not_negative,
    positive,
    quantity,
    read_text,
    si,
)
from centrode.numerics.text_formula import compile_formula
from centrode.quantities import ANGLES, ANGULAR_ACCELERATIONS, ANGULAR_VELOCITIES, LENGTHS, display_unit

REACHABLE = "reachable"
"""The range that a drive reaches from its initial position."""

Side = Literal["left", "right", "ahead", "behind"]


def read_samples(value: object) -> int:
    """A number of samples."""
    if isinstance(value, bool) or not isinstance(value, int):
        raise Problem(_("{key} must be a whole number, got {value}").format(key=KEY, value=value_text(value)))
    if not 1 <= value <= reading.SAMPLES:
        what = _("{key} must lie between 1 and {most}, got {value}")
        repair = _("choose fewer samples") if value > 0 else _("choose more samples")
        raise Problem(what.format(key=KEY, most=reading.SAMPLES, value=value_text(value)), repair)
    return value


class Display(DescriptionPart):
    """Units in which tables and figures show lengths and angles.

    Attributes
    ----------
    length, angle : str
    angular_velocity, angular_acceleration : str
        By the unit of angles if left out.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.Display(angle="deg", angular_velocity="rad/s").angular_velocity
    'rad/s'
    """

    length: Annotated[str, choice(*LENGTHS)] = "m"
    angle: Annotated[str, choice(*ANGLES)] = "rad"
    angular_velocity: Annotated[str, choice(*ANGULAR_VELOCITIES)] | None = None
    angular_acceleration: Annotated[str, choice(*ANGULAR_ACCELERATIONS)] | None = None

    @property
    def refuses_bare_angles(self) -> bool:
        """Whether a text of an angle needs its unit: angles are shown in another one than that of numbers."""
        return self.angle != "rad"


def shown_as(unit: str, display: Display | None) -> tuple[float, str]:
    """Factor and unit in which a quantity of this SI unit is shown; SI itself where no display is given.

    Inside, everything is SI and radians. Lengths and angles change their unit wherever they stand ("m/s^2" becomes
    "mm/s^2", "rad/s" becomes "deg/s"), except that kinematic coefficients stay per radian of the drive: only so are
    they the analogs of velocity and acceleration that textbooks print. Angular velocities and accelerations may have
    units of their own; higher derivatives by time go with the accelerations.
    """
    if display is None or unit in ("", "1"):
        return 1.0, unit
    if unit == "rad/s" and display.angular_velocity is not None:
        return ANGULAR_VELOCITIES[display.angular_velocity], display.angular_velocity
    angle = "rad" if "/rad" in unit else str(display.angle)
    if unit.startswith("rad/s^") and display.angular_acceleration is not None:
        angle = display.angular_acceleration.removesuffix("/s^2")
    return display_unit(unit, str(display.length), angle)


class Assembly(DescriptionPart):
    """Which way groups are assembled, and what happens at change points.

    Attributes
    ----------
    sides : mapping of a group's point, link or guide to "left", "right", "ahead" or "behind"
        Left or right of the line between the group's two known points, in description order; ahead or
        behind along a guide. Needed where the initial position does not tell.
    continuation : "smooth" or "keep"
        Run through change points smoothly, or keep the sign of the assembly.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.Assembly(sides={"B": "left"}).sides["B"]
    'left'
    """

    sides: Annotated[
        Mapping[str, Annotated[Side, choice("left", "right", "ahead", "behind")]],
        table(read_name, reading.POINTS),
        AfterValidator(FrozenMap[str, Side]),
        AS_DICT,
    ] = FrozenMap({})
    continuation: Annotated[Literal["smooth", "keep"], choice("smooth", "keep")] = "smooth"


ALONG = ("counter-clockwise", "along")
"""Senses in which a coordinate grows with the angle, or with the displacement or distance."""
AGAINST = ("clockwise", "against")
"""Senses in which it falls."""


def _read_zero(value: object) -> float:
    return si(value, READING.get().parameter.drives[0].kind)


class ChosenCoordinate(DescriptionPart):
    r"""The generalised coordinate to which results belong, where its author chooses zero and sense.

    It stands in place of the value of the one drive: the drive's motion stays what it is.

    Attributes
    ----------
    link, guide : str
        What is driven, for the reader; a cylinder needs neither.
    zero : float [rad or m]
        The angle, displacement or distance at which the coordinate is zero.
    sense : "counter-clockwise" or "clockwise" of an angle, "along" or "against" of a displacement or distance

    Examples
    --------
    >>> import centrode as ct
    >>> press = ct.mechanism_text(ct.example("six-bar-press"))
    >>> chosen = 'coordinate = { link = "OA", zero = "219.1 deg", sense = "clockwise" }'
    >>> press = ct.parse_mechanism(press.replace("[study]", f"[study]\n{chosen}"))
    >>> motion = ct.motion(press, at=["99.1 deg"])
    >>> round(float(motion.velocity_coefficient.sel(point="H", axis="x")[0]), 3)
    0.675
    """

    link: Name | None = None
    guide: Name | None = None
    zero: Annotated[float, PlainValidator(_read_zero)] = 0.0
    sense: Annotated[str, choice(*ALONG, *AGAINST)] | None = None

    @property
    def way(self) -> float:
        """+1.0 where the coordinate grows with what is driven, -1.0 where it falls."""
        return -1.0 if self.sense in AGAINST else 1.0


class Study(DescriptionPart):
    """What is to be computed.

    Attributes
    ----------
    samples : int
        Number of samples.
    instants : tuple of float [rad or m; s if the drive is a law of time or there are several]
        Values of the drive, or times, at which positions are shown.
    start, stop : float [rad or m; s if the drive is a law of time or there are several]
        Range of the drive's value; "from" and "to" in a file.
    range : "reachable"
        In place of these: between the limits about the initial position, without limits one turn.
    coordinate : ChosenCoordinate or None
        Zero and sense of the generalised coordinate; left out, it is the value of the drive.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.Study(samples=73, stop="90 deg").samples
    73
    """

    samples: Annotated[int, PlainValidator(read_samples)] | None = None
    instants: Annotated[tuple[InstantOfMotion, ...], bounded_list(reading.INSTANTS)] = ()
    start: Annotated[InstantOfMotion | None, Field(alias="from")] = None
    stop: Annotated[InstantOfMotion | None, Field(alias="to")] = None
    range: Annotated[Literal["reachable"], choice(REACHABLE)] | None = None
    coordinate: ChosenCoordinate | None = None

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given, by the rules of this part."""
        ends = [key for key in ("from", "start", "to", "stop") if given.get(key) is not None]
        wrong = super().key_problems(given)
        if given.get("range") is not None and ends:
            names = ", ".join(("range", *ends))
            wrong.append(Problem(_("{names} are given together").format(names=names), _("keep one of them")))
        return wrong


# The machine that a mechanism works in: its speed, what turns with the drive, flywheel and driving moment.

DRIVING_VARIABLES = ("q", "v")
"""The drive's value [rad] and speed [rad/s] in formulas of its moment."""

SHAFTS = 100

LEAST_FLUCTUATION = 1e-6
"""A smaller one is lost in the rounding of the speeds."""


def _ratio(value: object, kind: str) -> float:
    number = si(value, kind)
    if not abs(number) > reading.LEAST:
        raise Problem(_("{key} must not be zero, got {value}").format(key=KEY, value=value_text(value)))
    return number


def _fluctuation(value: object, kind: str) -> float:
    number = positive(value, kind)
    if number < LEAST_FLUCTUATION:
        what = _("{value} is outside the range that can be computed").format(value=value_text(value))
        raise Problem(what, _("stay above {least:g}").format(least=LEAST_FLUCTUATION))
    if number >= 2:
        what = _("{key} must be smaller than 2, got {value}").format(key=KEY, value=value_text(value))
        raise Problem(what, _("it is (greatest minus least speed) over the mean speed, such as 0.05"))
    return number


def _hollow(value: object, kind: str) -> float:
    number = not_negative(value, kind)
    if number >= 1:
        what = _("{key} must be smaller than 1, got {value}").format(key=KEY, value=value_text(value))
        raise Problem(what, _("it is the inner over the outer diameter, such as 0.8"))
    return number


def _driving_formula(value: object) -> str:
    text = read_text(value)
    try:
        compile_formula(text, DRIVING_VARIABLES, "")
    except InputError as error:
        raise Problem(error.what, error.repair) from None
    return text


class Shaft(DescriptionPart):
    """What turns with the drive at a constant ratio: `ratio` is its speed over the drive's, `inertia` [kg m^2]."""

    inertia: Annotated[float, quantity("inertia", not_negative)]
    ratio: Annotated[float, quantity("ratio", _ratio)] = 1.0
    name: Text = ""


class FlywheelShape(DescriptionPart):
    """Of what and how a flywheel is made.

    Attributes
    ----------
    ratio : float
        Speed of its shaft over the drive's.
    inertia : float [kg m^2]
        Of a flywheel that is there, about its own axis.
    density : float [kg/m^3]
    width, inner : float
        Width, and inner diameter of a rim, over the outer diameter.
    rim_speed : float [m/s]
        Greatest admissible one.
    """

    ratio: Annotated[float, quantity("ratio", _ratio)] = 1.0
    inertia: Annotated[float, quantity("inertia", positive)] | None = None
    density: Annotated[float, quantity("density", positive)] = 7800.0
    width: Annotated[float, quantity("ratio", positive)] = 0.2
    inner: Annotated[float, quantity("ratio", _hollow)] = 0.8
    rim_speed: Annotated[float, quantity("speed", positive)] | None = None


class Machine(DescriptionPart):
    """The machine the mechanism works in.

    Attributes
    ----------
    mean_speed : float [rad/s]
        Of the drive, positive; the sense is that of the drive. 0 where it is not given: then the shafts alone count.
    fluctuation : float
        Coefficient of fluctuation (non-uniformity) that a flywheel has to bring about, below 2.
    shafts : tuple of Shaft
        What else turns with the drive.
    flywheel : FlywheelShape
    driving : formula of `q` and `v`
        How the driving moment goes, up to a factor; constant if left out.
    """

    mean_speed: Annotated[float, PlainValidator(partial(angular_speed, read=positive))] = 0.0
    fluctuation: Annotated[float, quantity("ratio", _fluctuation)] | None = None
    shafts: Annotated[tuple[Shaft, ...], bounded_list(SHAFTS)] = ()
    flywheel: FlywheelShape = FlywheelShape()
    driving: Annotated[str, PlainValidator(_driving_formula)] | None = None

    @property
    def inertia(self) -> float:
        """What turns with the drive besides the links, shafts and a flywheel that is there, reduced to it [kg m^2]."""
        shafts = sum(shaft.inertia * shaft.ratio**2 for shaft in self.shafts)
        wheel = self.flywheel
        return shafts if wheel.inertia is None else shafts + wheel.inertia * wheel.ratio**2


# What a description wishes of its report: `[report]`.

LEAST_DIGITS, MOST_DIGITS, DIGITS = 2, 12, 5
"""Significant digits of a report's numbers: at least, at most, and where nothing is said."""
MOST_CHAPTERS = 100
LEAST_ROWS, MOST_ROWS = 2, 1000
"""Rows of a table over a motion, at least and at most."""
MOST_POSITIONS = 36
"""Positions in one plan: more cannot be distinguished in a drawing."""
MOST_RK4_STEPS = 100_000


def whole_number(least: int, most: int) -> PlainValidator:
    """A whole number between bounds."""

    def read(value: object) -> int:
        if isinstance(value, bool) or not isinstance(value, int):
            what = _("{key} must be a whole number, got {value}")
            raise Problem(what.format(key=KEY, value=value_text(value)))
        if not least <= value <= most:
            what = _("{key} must lie between {least} and {most}, got {value}")
            raise Problem(what.format(key=KEY, least=least, most=most, value=value_text(value)))
        return value

    return PlainValidator(read)


def _acute(value: object, kind: str) -> float:
    number = positive(value, kind)
    if number >= math.pi / 2:
        raise Problem(
            _("{key} must be smaller than 90 deg, got {value}").format(key=KEY, value=value_text(value))
        )
    return number


def _share(value: object, kind: str) -> float:
    number = positive(value, kind)
    if number >= 1:
        what = _("{key} must be smaller than 1, got {value}").format(key=KEY, value=value_text(value))
        raise Problem(what, _("write 0.3 for changes of up to 30 %"))
    return number


class ChapterText(DescriptionPart):
    """What the author writes about a chapter of the report, in Markdown.

    Attributes
    ----------
    before, after : what is computed; tags and formulas in them are shown as they are written
    """

    before: Annotated[str, PlainValidator(read_prose)] = ""
    after: Annotated[str, PlainValidator(read_prose)] = ""


ChapterTexts = Annotated[
    Mapping[str, ChapterText],
    table(read_name, MOST_CHAPTERS),
    AfterValidator(FrozenMap[str, ChapterText]),
    AS_DICT,
]


class GearReportWishes(ExplanatoryNote):
    """What the report of a pair or a train of gears is to hold; what is left out is chosen by the report.

    Attributes
    ----------
    chapters : names of chapters (`centrode report --help` lists them), in any order
    digits : int
        Significant digits of numbers.
    full : bool
        Everything there is to show, or the compact form; compact if left out, chapters that are chosen excepted.
    text : names of chapters -> ChapterText
        Own text before and after chapters.
    """

    chapters: Annotated[tuple[Name, ...], bounded_list(MOST_CHAPTERS)] = ()
    digits: Annotated[int, whole_number(LEAST_DIGITS, MOST_DIGITS)] | None = None
    full: Flag | None = None
    text: ChapterTexts = FrozenMap({})


class CamReportWishes(GearReportWishes):
    """What the report of a cam is to hold; what is left out is chosen by the report.

    Attributes
    ----------
    instants : tuple of float [rad]
        Angles of the carrier, or of a cam that turns, that tables show; the rest is as of gears.
    """

    instants: Annotated[tuple[Angle, ...], bounded_list(reading.INSTANTS)] = ()


class ReportWishes(ExplanatoryNote):
    """What the report of a mechanism is to hold; what is left out is chosen by the report.

    Attributes
    ----------
    chapters : names of chapters (`centrode report --help` lists them), in any order
    instants : tuple of float [rad or m; s if the drive is a law of time or there are several]
        Values of the drive, or times, at which tables, diagrams and forces are shown; those of `[study]` if left out.
    points : names of points
        Whose velocities and paths are told.
    digits : int
        Significant digits of numbers.
    full : bool
        Everything there is to show, or the compact form; compact if left out, chapters that are chosen excepted.
    motion : "real" or "mean"
        Of the forces: at the real speed and acceleration of the machine, or at its mean speed; the real one
        where it can be computed if left out.
    rows : int
        Of a table over the motion, at most.
    positions : int
        In the plan of positions.
    rk4_steps : int
        Fixed Runge-Kutta steps, whose rows and errors the chapter on integration has as well.
    angle_step : float [rad]
        To which directions of drawings are read in the graph-analytic check; exactly if left out.
    least_transmission_angle : float [rad]
        What every dyad of a repaired mechanism keeps; 20 degrees, or less where that is out of reach, if left out.
    greatest_change : float
        Greatest change of a repair: of a length over itself, of a coordinate over the greatest length, below 1.
    text : names of chapters -> ChapterText
        Own text before and after chapters.
    """

    chapters: Annotated[tuple[Name, ...], bounded_list(MOST_CHAPTERS)] = ()
    instants: Annotated[tuple[InstantOfMotion, ...], bounded_list(reading.INSTANTS)] = ()
    points: Annotated[tuple[Name, ...], bounded_list(reading.POINTS)] = ()
    digits: Annotated[int, whole_number(LEAST_DIGITS, MOST_DIGITS)] | None = None
    rows: Annotated[int, whole_number(LEAST_ROWS, MOST_ROWS)] | None = None
    positions: Annotated[int, whole_number(2, MOST_POSITIONS)] | None = None
    rk4_steps: Annotated[int, whole_number(1, MOST_RK4_STEPS)] | None = None
    angle_step: Annotated[float, quantity("angle", positive)] | None = None
    least_transmission_angle: Annotated[float, quantity("angle", _acute)] | None = None
    greatest_change: Annotated[float, quantity("ratio", _share)] | None = None
    full: Flag | None = None
    motion: Annotated[Literal["real", "mean"], choice("real", "mean")] | None = None
    text: ChapterTexts = FrozenMap({})
