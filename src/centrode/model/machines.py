"""The machine that a mechanism works in: its speed, what turns with the drive, flywheel and driving moment."""

from __future__ import annotations

from typing import Annotated

from pydantic import PlainValidator

from centrode.algebra.text import compile_formula
from centrode.errors import InputError
from centrode.locale import _
from centrode.model import limits
from centrode.model.entries import listed
from centrode.model.part import Part
from centrode.model.problems import KEY, Problem, shown
from centrode.model.values import Text, not_negative, positive, quantity, read_text, si

DRIVING_VARIABLES = ("q", "v")
"""The drive's value [rad] and speed [rad/s] in formulas of its moment."""

SHAFTS = 100

LEAST_FLUCTUATION = 1e-6
"""A smaller one is lost in the rounding of the speeds."""


def _ratio(value: object, kind: str) -> float:
    number = si(value, kind)
    if not abs(number) > limits.LEAST:
        raise Problem(_("{key} must not be zero, got {value}").format(key=KEY, value=shown(value)))
    return number


def _fluctuation(value: object, kind: str) -> float:
    number = positive(value, kind)
    if number < LEAST_FLUCTUATION:
        what = _("{value} is beyond what can be computed with").format(value=shown(value))
        raise Problem(what, _("stay above {least:g}").format(least=LEAST_FLUCTUATION))
    if number >= 2:
        what = _("{key} must be smaller than 2, got {value}").format(key=KEY, value=shown(value))
        raise Problem(what, _("it is (greatest less least speed) over the mean one, such as 0.05"))
    return number


def _hollow(value: object, kind: str) -> float:
    number = not_negative(value, kind)
    if number >= 1:
        what = _("{key} must be smaller than 1, got {value}").format(key=KEY, value=shown(value))
        raise Problem(what, _("it is the inner over the outer diameter, such as 0.8"))
    return number


def _driving(value: object) -> str:
    text = read_text(value)
    try:
        compile_formula(text, DRIVING_VARIABLES, "")
    except InputError as error:
        raise Problem(error.what, error.repair) from None
    return text


class Shaft(Part):
    """What turns with the drive at a constant ratio: `ratio` is its speed over the drive's, `inertia` [kg m^2]."""

    inertia: Annotated[float, quantity("inertia", not_negative)]
    ratio: Annotated[float, quantity("ratio", _ratio)] = 1.0
    name: Text = ""


class FlywheelShape(Part):
    """Of what and how a flywheel is made.

    Attributes
    ----------
    ratio : float
        Speed of its shaft over the drive's.
    density : float [kg/m^3]
    width, inner : float
        Width, and inner diameter of a rim, over the outer diameter.
    rim_speed : float [m/s]
        Greatest admissible one.
    """

    ratio: Annotated[float, quantity("ratio", _ratio)] = 1.0
    density: Annotated[float, quantity("density", positive)] = 7800.0
    width: Annotated[float, quantity("ratio", positive)] = 0.2
    inner: Annotated[float, quantity("ratio", _hollow)] = 0.8
    rim_speed: Annotated[float, quantity("speed", positive)] | None = None


class Machine(Part):
    """The machine the mechanism works in.

    Attributes
    ----------
    mean_speed : float [rad/s]
        Of the drive, positive; the sense is that of the drive.
    fluctuation : float
        Coefficient of fluctuation (non-uniformity) that a flywheel has to bring about, below 2.
    shafts : tuple of Shaft
        What else turns with the drive.
    flywheel : FlywheelShape
    driving : formula of `q` and `v`
        How the driving moment goes, up to a factor; constant if left out.
    """

    mean_speed: Annotated[float, quantity("angular speed", positive)]
    fluctuation: Annotated[float, quantity("ratio", _fluctuation)] | None = None
    shafts: Annotated[tuple[Shaft, ...], listed(SHAFTS)] = ()
    flywheel: FlywheelShape = FlywheelShape()
    driving: Annotated[str, PlainValidator(_driving)] | None = None
