"""What drives a machine that is left to itself, and how its motion is integrated: `[simulation]` of a description."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import PlainValidator, ValidationInfo, field_validator

from centrode.errors import InputError
from centrode.locale import _
from centrode.model import reading
from centrode.model.motion_parameter import UNDRIVEN, MotionParameter
from centrode.model.reading import (
    AS_DICT,
    KEY,
    DescriptionPart,
    FrozenMap,
    Problem,
    Problems,
    bounded_list,
    choice,
    entries,
    entries_by_path,
    nearest,
    read_name,
    value_text,
)
from centrode.model.values import READING, Name, not_negative, positive, quantity, read_axes, read_text, si
from centrode.numerics.text_formula import compile_formula

DRIVING_LAW_VARIABLES = ("t", "q", "v")
"""Time [s], the drive's value, and its speed in the sense of the drive, in formulas of what drives it."""

Scheme = Literal["adaptive", "stiff", "runge-kutta-4"]
SCHEMES = ("adaptive", "stiff", "runge-kutta-4")
Equations = Literal["reduced", "multibody"]
EQUATIONS = ("reduced", "multibody")
"""The reduced equation of motion of one drive, or the equations of all links with their constraints."""
MOST_STEPS = 1_000_000
"""Fixed steps: with some 400 bytes each about 0.5 GB."""
DEFAULT_STEPS, DEFAULT_SAMPLES, DEFAULT_TOLERANCE = 1000, 1001, 1e-9
LEAST_TOLERANCE, GREATEST_TOLERANCE = 1e-13, 1e-2
MOST_TURNS = 5000
"""Turns of the drive in one simulation: on each the integration takes dozens of steps, and events are looked for."""


def _law(value: object) -> str:
    text = read_text(value)
    try:
        compile_formula(text, DRIVING_LAW_VARIABLES, "")
    except InputError as error:
        raise Problem(error.what, error.repair) from None
    return text


def _count(value: object, least: int, most: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise Problem(_("{key} must be a whole number, got {value}").format(key=KEY, value=value_text(value)))
    if not least <= value <= most:
        what = _("{key} must lie between {least} and {most}, got {value}")
        raise Problem(what.format(key=KEY, least=least, most=most, value=value_text(value)))
    return value


def _turns(value: object) -> float:
    number = positive(value, "ratio")
    if number > MOST_TURNS:
        raise Problem(_("{key} must be at most {most:g}").format(key=KEY, most=MOST_TURNS))
    return number


def _tolerance(value: object) -> float:
    number = positive(value, "ratio")
    if not LEAST_TOLERANCE <= number <= GREATEST_TOLERANCE:
        what = _("{key} must lie between {least:g} and {most:g}, got {value}")
        raise Problem(
            what.format(key=KEY, least=LEAST_TOLERANCE, most=GREATEST_TOLERANCE, value=value_text(value))
        )
    return number


# Initial speeds of parts by their paths: links.OA, guides.B, drives.K-A, points.P.

Speed: TypeAlias = float | tuple[float, ...]
SPEED_ROOMS = ("links", "guides", "drives", "points")
"""First words of the paths of initial speeds."""


def _read_speeds(value: object) -> Mapping[str, Speed]:
    """Speeds [rad/s or m/s] by path; a file may write the paths as keys with dots or as tables within each other."""
    if not isinstance(value, Mapping):
        raise Problem(_("expected a table, got {value}").format(value=value_text(value)))
    given: dict[str, Speed] = {}
    wrong: list[Problem] = []
    for path, entry in entries_by_path(value):
        try:
            name = _speed_path(path)
            if name in given:
                raise Problem(_("{name} is named twice").format(name=value_text(name)), _("keep one of them"))
            given[name] = _read_speed(name, entry)
        except Problem as problem:
            wrong.append(Problem(problem.what, problem.repair, (path,)))
    entries(list(given), reading.POINTS)
    if wrong:
        raise Problems(wrong)
    return FrozenMap(given)


def _speed_path(path: str) -> str:
    room, _dot, name = path.partition(".")
    if room not in SPEED_ROOMS:
        what = _("a speed is that of a link, a guide, a drive or a point, got {path}")
        raise Problem(
            what.format(path=value_text(path)), nearest(room, [f"{one}.NAME" for one in SPEED_ROOMS])
        )
    return f"{room}.{read_name(name)}"


def _read_speed(path: str, value: object) -> Speed:
    room, _dot, name = path.partition(".")
    if room == "points":
        return read_axes(value, "speed")
    if room == "links":
        return si(value, "angular speed")
    if room == "guides":
        return si(value, "angular speed" if READING.get().space == "sphere" else "speed")
    kinds = {one.name: one.speed_kind for one in READING.get().parameter.drives if one.name}
    if name in kinds:
        return si(value, kinds[name])
    # settings made in Python do not know the drives: either kind of speed may be meant
    try:
        return si(value, "angular speed")
    except Problem:
        return si(value, "speed")


def _read_instants(value: object) -> tuple[float, ...]:
    """Instants [s] that grow, from zero on."""
    instants = tuple(not_negative(one, "time") for one in entries(value, reading.SAMPLES))
    if any(late <= early for early, late in pairwise(instants)):
        raise Problem(
            _("{key} must hold instants that grow").format(key=KEY), _("sort them, and name each once")
        )
    return instants


class Motor(DescriptionPart):
    """A motor with a known characteristic, on a shaft that turns `ratio` times as fast as the drive.

    Attributes
    ----------
    kind : "linear" or "asynchronous"
    idle_speed : float [rad/s]
        At which it gives no moment; of an asynchronous motor the synchronous one.
    starting_moment : float [N m]
        Linear: at rest; the moment falls evenly to zero at the idle speed.
    breakdown_moment : float [N m]
        Asynchronous: the greatest one, by Kloss' formula.
    breakdown_slip : float
        Asynchronous: the slip at which it is reached, of the synchronous speed.
    ratio : float
        Speed of the motor's shaft over the drive's.
    """

    kind: Annotated[Literal["linear", "asynchronous"], choice("linear", "asynchronous")]
    idle_speed: Annotated[float, quantity("angular speed", positive)]
    starting_moment: Annotated[float, quantity("torque", positive)] | None = None
    breakdown_moment: Annotated[float, quantity("torque", positive)] | None = None
    breakdown_slip: Annotated[float, quantity("ratio", positive)] | None = None
    ratio: Annotated[float, quantity("ratio", positive)] = 1.0

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given: each kind has its own."""
        found = super().key_problems(given)
        needed = {"linear": ("starting_moment",), "asynchronous": ("breakdown_moment", "breakdown_slip")}
        kind = given.get("kind")
        if found or kind not in needed:
            return found
        known = ("starting_moment", "breakdown_moment", "breakdown_slip")
        for key in known:
            if (given.get(key) is None) is (key in needed[kind]):
                words = ", ".join(needed[kind])
                what = _("a motor of the kind {kind} has {keys}, and no other moments")
                return [Problem(what.format(kind=value_text(kind), keys=words))]
        return found

    @property
    def law(self) -> str:
        """Its moment on the drive [N m] as a formula of the drive's speed v [rad/s]."""
        times = "" if self.ratio == 1.0 else f"{spelt(self.ratio)}*"
        slip = f"(1 - {times}v/{spelt(self.idle_speed)})"
        if self.kind == "linear":
            return f"{times}{spelt(self.starting_moment)}*{slip}"
        # Kloss: 2 M / (s/k + k/s), written without a pole at s = 0
        most = spelt(self.breakdown_slip)
        return f"{times}2*{spelt(self.breakdown_moment)}*{most}*{slip}/({slip}^2 + {most}^2)"


def spelt(value: float | None) -> str:
    """A number as a formula has it: the shortest digits that read back as the same number."""
    return repr(value).removesuffix(".0")


class Simulation(DescriptionPart):
    """A mechanism that is not led but left to its loads: where it starts, what drives it, how long.

    Attributes
    ----------
    start : float [rad or m]
        Value of the first drive at t = 0; the initial one by default.
    speed : float [rad/s or m/s]
        Its speed at t = 0, positive in the sense of the drive.
    speeds : mapping of a path to a speed [rad/s or m/s], of a point to a velocity [m/s]
        Further speeds at t = 0 of links ("links.OA"), along guides ("guides.B"), of drives ("drives.K-A") and of points
        ("points.P"); coordinates that none of them determines start at rest.
    keeps : tuple of ids of drives
        Drives that hold their law; all others are free.
    equations : "reduced" or "multibody"
        The reduced equation of the one drive, or the equations of all links with their constraints; by default the
        reduced one where it is enough.
    driving : formula of `t`, `q` and `v` [N m or N]
        Moment of the drive, positive in its sense, as v is; none by default.
    motor : Motor
        In place of `driving`.
    duration : float [s]
    turns : float
        Ends after so many turns of the drive, if it does not end before.
    scheme : "adaptive", "stiff" or "runge-kutta-4"
        The last one belongs to the reduced equation.
    steps : int
        Of the fixed-step scheme.
    tolerance : float
        Relative one of the adaptive schemes.
    samples : int
        Of the result, evenly spaced in time.
    at : tuple of float [s]
        Instants of the result in place of evenly spaced ones, growing.

    Examples
    --------
    >>> import centrode as ct
    >>> settings = ct.Simulation(driving="20 - 2*v", duration="1 s")
    >>> settings.duration
    1.0
    """

    start: float | None = None
    speed: float = 0.0
    speeds: Annotated[Mapping[str, Speed], PlainValidator(_read_speeds), AS_DICT] = FrozenMap({})
    keeps: Annotated[tuple[Name, ...], bounded_list(reading.DRIVES)] = ()
    equations: Annotated[Equations, choice(*EQUATIONS)] | None = None
    driving: Annotated[str, PlainValidator(_law)] | None = None
    motor: Motor | None = None
    duration: Annotated[float, quantity("time", positive)] | None = None
    turns: Annotated[float, PlainValidator(_turns)] | None = None
    scheme: Annotated[Scheme, choice(*SCHEMES)] = "adaptive"
    steps: Annotated[int, PlainValidator(lambda value: _count(value, 1, MOST_STEPS))] = DEFAULT_STEPS
    tolerance: Annotated[float, PlainValidator(_tolerance)] = DEFAULT_TOLERANCE
    samples: Annotated[int, PlainValidator(lambda value: _count(value, 2, reading.SAMPLES))] = DEFAULT_SAMPLES
    at: Annotated[tuple[float, ...], PlainValidator(_read_instants)] = ()

    @field_validator("start", "speed", mode="plain")
    @classmethod
    def _of_first_drive(cls, value: object, info: ValidationInfo) -> float | None:
        if value is None:
            return None
        first = READING.get().parameter.drives[0]
        return si(value, first.speed_kind if info.field_name == "speed" else first.kind)

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given."""
        found = super().key_problems(given)
        if given.get("driving") is not None and given.get("motor") is not None:
            found.append(Problem(_("driving and motor are given together"), _("keep one of them")))
        if given.get("scheme") == "runge-kutta-4" and given.get("equations") == "multibody":
            what = _("fixed steps are those of the reduced equation")
            found.append(Problem(what, _('write scheme = "adaptive", or equations = "reduced"')))
        return found

    @classmethod
    def for_parameter(cls, parameter: MotionParameter, **values: Any) -> Simulation:
        """Settings whose numbers with units are read as those of a description with this parameter of the motion."""
        known = parameter if parameter.drives else UNDRIVEN
        token = READING.set(replace(READING.get(), parameter=known))
        try:
            return cls(**values)
        finally:
            READING.reset(token)

    @property
    def law(self) -> str:
        """The formula of what drives; "0" without any."""
        if self.motor is not None:
            return self.motor.law
        return self.driving or "0"
