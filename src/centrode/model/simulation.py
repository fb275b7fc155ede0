"""What drives a machine that is left to itself, and how its motion is integrated: `[simulation]` of a description."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any, Literal

from pydantic import PlainValidator, ValidationInfo, field_validator

from centrode.errors import InputError
from centrode.locale import _
from centrode.model import reading
from centrode.model.motion_parameter import UNDRIVEN, MotionParameter
from centrode.model.reading import KEY, DescriptionPart, Problem, choice, value_text
from centrode.model.values import READING, PlaceOfMotion, positive, quantity, read_text, si
from centrode.numerics.text_formula import compile_formula

DRIVING_LAW_VARIABLES = ("t", "q", "v")
"""Time [s], the drive's value, and its speed in the sense of the drive, in formulas of what drives it."""

Scheme = Literal["adaptive", "stiff", "runge-kutta-4"]
SCHEMES = ("adaptive", "stiff", "runge-kutta-4")
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
        times = "" if self.ratio == 1.0 else f"{_spelt(self.ratio)}*"
        slip = f"(1 - {times}v/{_spelt(self.idle_speed)})"
        if self.kind == "linear":
            return f"{times}{_spelt(self.starting_moment)}*{slip}"
        # Kloss: 2 M / (s/k + k/s), written without a pole at s = 0
        most = _spelt(self.breakdown_slip)
        return f"{times}2*{_spelt(self.breakdown_moment)}*{most}*{slip}/({slip}^2 + {most}^2)"


def _spelt(value: float | None) -> str:
    """A number as a formula has it: the shortest digits that read back as the same number."""
    return repr(value).removesuffix(".0")


class Simulation(DescriptionPart):
    """A mechanism with one drive that is not led but driven: where it starts, what drives it, how long.

    Attributes
    ----------
    start : float [rad or m]
        Value of the drive at t = 0; the initial one by default.
    speed : float [rad/s or m/s]
        Speed at t = 0, positive in the sense of the drive.
    driving : formula of `t`, `q` and `v` [N m or N]
        Moment of the drive, positive in its sense, as v is; none by default.
    motor : Motor
        In place of `driving`.
    duration : float [s]
    turns : float
        Ends after so many turns of the drive, if it does not end before.
    scheme : "adaptive", "stiff" or "runge-kutta-4"
    steps : int
        Of the fixed-step scheme.
    tolerance : float
        Relative one of the adaptive schemes.
    samples : int
        Of the result, evenly spaced in time.

    Examples
    --------
    >>> import centrode as ct
    >>> settings = ct.Simulation(driving="20 - 2*v", duration="1 s")
    >>> settings.duration
    1.0
    """

    start: PlaceOfMotion | None = None
    speed: float = 0.0
    driving: Annotated[str, PlainValidator(_law)] | None = None
    motor: Motor | None = None
    duration: Annotated[float, quantity("time", positive)] | None = None
    turns: Annotated[float, PlainValidator(_turns)] | None = None
    scheme: Annotated[Scheme, choice(*SCHEMES)] = "adaptive"
    steps: Annotated[int, PlainValidator(lambda value: _count(value, 1, MOST_STEPS))] = DEFAULT_STEPS
    tolerance: Annotated[float, PlainValidator(_tolerance)] = DEFAULT_TOLERANCE
    samples: Annotated[int, PlainValidator(lambda value: _count(value, 2, reading.SAMPLES))] = DEFAULT_SAMPLES

    @field_validator("speed", mode="plain")
    @classmethod
    def _speed(cls, value: object, info: ValidationInfo) -> float:
        return si(value, READING.get().parameter.drives[0].speed_kind)

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given."""
        found = super().key_problems(given)
        if given.get("driving") is not None and given.get("motor") is not None:
            found.append(Problem(_("driving and motor are given together"), _("keep one of them")))
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
