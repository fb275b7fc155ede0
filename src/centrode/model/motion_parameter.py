"""The parameter of a motion: time or the value of the one drive; its kind, unit, symbol, and what states an instant.

With one drive the parameter is the value of that drive, so positions do not depend on its law; with several drives it
is time. An instant of a motion is a value of the drive where one drive runs at constant speed. Otherwise it is a time,
because a law of time may pass the same value more than once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal, TypeAlias

from centrode.errors import InputError
from centrode.laws import Law, Uniform
from centrode.locale import _
from centrode.model.reading import nearest, value_text
from centrode.model.units import KINDS, read_quantity

Kind: TypeAlias = Literal["time", "angle", "length"]
"""A kind of quantity by its name in `units.KINDS`."""

Number: TypeAlias = Any

SPEED_KINDS: Mapping[Kind, str] = {"angle": "angular speed", "length": "speed"}
"""Kind of the value of a drive -> kind of its speed."""
FORCE_UNITS: Mapping[Kind, str] = {"angle": "N m", "length": "N"}
"""Kind of the value of a drive -> SI unit of what it gives: a moment along an angle, a force along a length."""
SYMBOLS: Mapping[str, str] = {"angle": "φ", "displacement": "s", "distance": "l"}
"""What is driven -> letter of its value in figures."""


@dataclass(frozen=True)
class MotionVariable:
    """Time, or the value of a drive.

    Attributes
    ----------
    kind : "time", "angle" or "length"
    symbol : letter in figures
    refuses_bare : whether a text of an angle needs a unit, because the description displays degrees
    """

    kind: Kind
    symbol: str
    refuses_bare: bool = field(default=False, kw_only=True)

    @property
    def unit(self) -> str:
        """SI unit: "s", "rad" or "m"."""
        return KINDS[self.kind].unit

    def read(self, text: float | str, where: str) -> float:
        """Value [s, rad or m] of a number in SI or of a text with a unit ("30 deg").

        Raises InputError, which names `where`, for a text that is no number or has a unit of another kind, or no unit
        where it may mean degrees.
        """
        return read_quantity(text, self.kind, where, refuses_bare=self.refuses_bare)

    def read_all(self, values: Any, where: str) -> Any:
        """Values [s, rad or m] of numbers in SI and texts with a unit, several or one alone; anything else as it is.

        Raises InputError as `read`.
        """
        if isinstance(values, str | int | float):
            return [self.read(values, where)]
        # an array of numbers is not walked through
        if (
            not isinstance(values, Sequence)
            and getattr(getattr(values, "dtype", None), "kind", "") not in "OU"
        ):
            return values
        if not any(isinstance(value, str) for value in values):
            return values
        return [self.read(value, where) if isinstance(value, str) else value for value in values]


TIME = MotionVariable("time", "t")
ANGLE = MotionVariable("angle", "φ")
"""Of a cam or of its carrier: what the motion of a cam is a function of."""


@dataclass(frozen=True)
class DriveCoordinate(MotionVariable):
    """The value of one drive as a coordinate of the mechanism; on the sphere a displacement is an arc, so an angle.

    Attributes
    ----------
    name : id of the drive
    driven : "angle" of a link, "displacement" along a guide, "distance" of two points
    speed : float [rad/s or m/s], where it is constant; None for every other law of time
    zero : float [rad or m]
        The angle, displacement or distance at which the coordinate is zero.
    sense : +1.0 or -1.0
        Whether it grows with that quantity or against it.
    is_chosen : bool
        Whether the author of the description chose zero and sense; else the coordinate is the quantity itself.
    """

    name: str
    driven: str
    speed: float | None
    zero: float = field(default=0.0, kw_only=True)
    sense: float = field(default=1.0, kw_only=True)
    is_chosen: bool = field(default=False, kw_only=True)

    def measured_from(self, zero: float, sense: float) -> DriveCoordinate:
        """The same quantity with a chosen zero [rad or m] and sense."""
        speed = None if self.speed is None else sense * self.speed
        return replace(self, speed=speed, zero=zero, sense=sense, is_chosen=True)

    def value_of(self, measure: Number) -> Number:
        """Value of the coordinate where the angle, displacement or distance is `measure`, over any algebra."""
        if not self.is_chosen:
            return measure
        return measure - self.zero if self.sense > 0.0 else self.zero - measure

    def measure_at(self, value: Number) -> Number:
        """The angle, displacement or distance at a value of the coordinate, over any algebra."""
        if not self.is_chosen:
            return value
        return value + self.zero if self.sense > 0.0 else self.zero - value

    @property
    def label(self) -> str:
        """What stands before a value: the drive's id, or the letter of a coordinate that is chosen."""
        return self.symbol if self.is_chosen else self.name

    @property
    def speed_kind(self) -> str:
        """Kind of the speed by its name in `units.KINDS`."""
        return SPEED_KINDS[self.kind]

    @property
    def speed_unit(self) -> str:
        """SI unit of the speed: "rad/s" or "m/s"."""
        return KINDS[self.speed_kind].unit

    @property
    def force_unit(self) -> str:
        """SI unit of what the drive gives: "N m" or "N"."""
        return FORCE_UNITS[self.kind]

    @property
    def turns(self) -> bool:
        """Whether a full turn of the value brings the driven link back: only the angle of a link does that."""
        return self.driven == "angle"


def constant_speed_of(law: Law) -> float | None:
    """Speed [rad/s or m/s] of a drive that keeps a constant one; None by any other law."""
    return law.speed if isinstance(law, Uniform) else None


@dataclass(frozen=True)
class MotionParameter:
    """What a motion is a function of, and what states an instant of it.

    Attributes
    ----------
    drives : the coordinates of the drives, in description order
    by_time : whether the parameter is time; else it is the value of the one drive
    """

    drives: tuple[DriveCoordinate, ...]
    by_time: bool

    @property
    def variable(self) -> MotionVariable:
        """The parameter itself; it gives the places of limits and change points."""
        return TIME if self.by_time or not self.drives else self.drives[0]

    @property
    def instant(self) -> MotionVariable:
        """What states an instant, and counts samples: the value of a drive at constant speed, else time."""
        return self.drives[0] if self.is_uniform else TIME

    @property
    def constant_speed(self) -> float | None:
        """Speed [rad/s or m/s] of the one drive where it is constant; None for another law and for several drives."""
        return None if self.by_time or not self.drives else self.drives[0].speed

    @property
    def is_uniform(self) -> bool:
        """Whether one drive runs at constant speed."""
        return self.constant_speed is not None

    @property
    def states_instants(self) -> bool:
        """Whether the parameter states instants; the value of a drive by a law does not, since it may come again."""
        return self.by_time or self.is_uniform

    @property
    def turns(self) -> bool:
        """Whether the parameter is the angle of a link, so that a full turn brings that link back."""
        return not self.by_time and bool(self.drives) and self.drives[0].turns

    @property
    def units(self) -> list[str]:
        """SI units of the values of all drives."""
        return [one.unit for one in self.drives]

    def drive(self, name: str) -> DriveCoordinate:
        """The coordinate of the drive of an id; InputError where there is no such drive."""
        for one in self.drives:
            if one.name == name:
                return one
        what = _("there is no drive {name}").format(name=value_text(name))
        raise InputError("", what, nearest(name, [one.name for one in self.drives]))

    def along(self, name: str) -> MotionParameter:
        """The parameter of the motion by one drive while the others are held."""
        return MotionParameter((self.drive(name),), by_time=False)

    def in_time(self) -> MotionParameter:
        """The parameter of a motion of the same drives by time, even of a single one."""
        return MotionParameter(self.drives, by_time=True)

    def values(self, motion: Any) -> Any:
        """Values of the parameter (sample) of a dataset with `time` and `drive_value`."""
        return _values(motion, self.variable)

    def instants(self, motion: Any) -> Any:
        """Instants (sample) of a dataset with `time` and `drive_value`, as `at` of the computations takes them."""
        return _values(motion, self.instant)

    def times(self, values: Number, start: float, speed: Any = None) -> Number:
        """Times [s] at which a drive at constant speed passes values; `start` is its value at t = 0.

        `speed` stands in place of the drive's own: the mean speed of a machine. Neither may be zero.
        """
        return (values - start) / (self._speed if speed is None else speed)

    def value_at(self, time: float, start: float) -> float:
        """Value [rad or m] of a drive at constant speed at a time [s]; `start` is its value at t = 0."""
        return start + self._speed * time

    @property
    def _speed(self) -> float:
        speed = self.constant_speed
        assert speed is not None, "only one drive at constant speed converts values and times"
        return speed


def drive_coordinate(
    name: str, driven: str, space: str, speed: float | None, refuses_bare: bool = False
) -> DriveCoordinate:
    """The coordinate of a drive in the plane or on the sphere."""
    kind = kind_of_value(driven, space)
    return DriveCoordinate(kind, SYMBOLS[driven], name, driven, speed, refuses_bare=refuses_bare)


def kind_of_value(driven: str, space: str) -> Kind:
    """Kind of the value of a drive: an angle for the angle of a link, and for every arc on the sphere."""
    return "angle" if driven == "angle" or space == "sphere" else "length"


def parameter_values(motion: Any) -> Any:
    """Values of the parameter (sample) of a labelled motion, by the number of drives that it has."""
    return _values(motion, TIME if motion.sizes["drive"] > 1 else ANGLE)


def _values(motion: Any, variable: MotionVariable) -> Any:
    values = motion["time"] if variable is TIME else motion["drive_value"].isel(drive=0)
    return values.values


UNDRIVEN = MotionParameter((drive_coordinate("", "angle", "plane", 0.0),), by_time=False)
"""Of a description without drives, while it is read: values are those of a link that turns."""
