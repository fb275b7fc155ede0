"""The path along which a mechanism is driven: the values of all drives as functions of one parameter.

With one drive the parameter is the drive's own value, so results do not depend on its law; with several it
is time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import dist, frexp, isfinite, tau
from numbers import Integral
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.kinematics.law_jumps import Jump, first_jump
from centrode.laws import Law, ShaftLaw
from centrode.locale import _, ngettext
from centrode.model import reading
from centrode.model.mechanism import Drive, Mechanism
from centrode.model.motion_parameter import MotionParameter, MotionVariable
from centrode.model.placement import chain_of
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions

# How fast several drives move together: the unit of time on which events are looked for, stretch by stretch.
#
# Stretches of time are counted from zero and double in length (dyadic), whatever range is requested, so that
# the mesh belongs to the mechanism: a longer range adds nodes, and moves none.

Array: TypeAlias = npt.NDArray[np.float64]

NODES_PER_TURN = 720
"""Mesh on which events are looked for: two events closer than half a degree may be missed."""
OFF_GRID = 0.37
"""Mesh nodes stand this share of a step away from the initial position: events like to lie at round values."""
RATES = 1000
"""Times at which the rates of the drives are compared on one stretch."""
SHORTEST, LONGEST = -40, 20
"""Powers of two [s] between which the first stretch is chosen."""


@dataclass(frozen=True)
class TimeScale:
    """Units of time in which the fastest drive moves 1 rad, or the mechanism's greatest length.

    Attributes
    ----------
    rates : times [s] -> the fastest drive's rate at each, in units (1 rad, the greatest length) per second
    base : float [s]
        Length of the first stretch, a power of two: the drives move at most a turn on it.
    """

    rates: Callable[[Array], Array]
    base: float
    _units: dict[int, float] = field(default_factory=dict, compare=False, repr=False)

    @classmethod
    def of(cls, rates: Callable[[Array], Array]) -> TimeScale:
        """The time scale of drives with these rates, times [s] -> (n,) in units per second."""
        powers = 2.0 ** np.arange(SHORTEST, LONGEST + 1)
        # only the later half of each stretch [0, power]: the earlier half is that of a lesser power, which
        # `accumulate` adds
        times = powers[:, None] * np.linspace(0.5, 1.0, RATES // 4)
        fastest = np.maximum.accumulate(
            np.max(_finite(rates(times.reshape(-1))).reshape(times.shape), axis=1)
        )
        with np.errstate(over="ignore"):  # a law may grow without bound long after any range
            # the longest stretch on which the fastest drive makes no more than a turn
            slow = np.nonzero(fastest * powers <= tau)[0]
        return cls(rates, float(powers[slow[-1]] if len(slow) else powers[0]))

    def unit_at(self, time: float) -> float:
        """Unit of time [s] of the stretch that a time lies in."""
        return self._unit(self._stretch(time))

    def finest(self, low: float, high: float) -> float:
        """The least unit of the stretches between two times."""
        return min(self._unit(k) for k in self._stretches(low, high))

    def turns(self, low: float, high: float) -> float:
        """Turns of the fastest drive, at its greatest rate on each stretch, between two times [s]."""
        total = 0.0
        for k in self._stretches(low, high):
            first, last = _ends(k, self.base)
            total += max(0.0, min(high, last) - max(low, first)) / (tau * self._unit(k))
        return total

    def beyond(self, low: float, high: float, units: float) -> tuple[float, float]:
        """A range with so many units added at both ends; those of the next stretches count where they are near."""
        return self._advance(low, -units), self._advance(high, units)

    def nodes(self, low: float, high: float) -> Array:
        """Mesh nodes from the last one below `low` to the first one above `high`."""
        stretches = []
        # a tenth of a unit on both sides: nodes of the next stretch may be those just beyond the ends
        for k in self._stretches(self._advance(low, -0.1), self._advance(high, 0.1)):
            first, last = _ends(k, self.base)
            step = self._unit(k) * tau / NODES_PER_TURN
            # two more at both ends, so that rounding of the quotient loses none; those of other stretches are
            # cut off below
            least = max(0, int(np.floor((low - first) / step)) - 2)
            most = int(np.ceil((min(high, last) - first) / step)) + 2
            nodes = first + (np.arange(least, most + 1, dtype=np.float64) + OFF_GRID) * step
            stretches.append(nodes[nodes < last])
        return np.concatenate(stretches)

    def _advance(self, time: float, units: float) -> float:
        here = self._stretch(time)
        there = here + (1 if units > 0.0 else -1)
        reached = time + units * self._unit(here)
        # the nearer of both stretches' units may be the greater one: the wider range is taken
        return (
            min(reached, time + units * self._unit(there))
            if units < 0.0
            else max(reached, time + units * self._unit(there))
        )

    def _stretch(self, time: float) -> int:
        """Number of the stretch: 0 from zero to the base, then doubling; -1 the base before zero, doubling too."""
        ratio = abs(time) / self.base
        # frexp gives the power of two above the ratio, exactly
        power = max(frexp(ratio)[1], 0) if ratio >= 1.0 else 0
        if time >= 0.0:
            return power
        # a stretch holds its lower end, so a power of two before zero belongs to the stretch nearer to zero
        return -power if frexp(ratio)[0] == 0.5 and ratio >= 1.0 else -power - 1

    def _stretches(self, low: float, high: float) -> range:
        return range(self._stretch(low), self._stretch(high) + 1)

    def _unit(self, stretch: int) -> float:
        if stretch not in self._units:
            first, last = _ends(stretch, self.base)
            fastest = float(np.max(_finite(self.rates(np.linspace(first, last, RATES)))))
            length = last - first
            # drives at rest tell nothing: then the stretch itself has to do
            self._units[stretch] = 1.0 / fastest if fastest * length > 1.0 else length
        return self._units[stretch]


def _ends(stretch: int, base: float) -> tuple[float, float]:
    """First and last time of a stretch."""
    if stretch < 0:
        last, first = _ends(-1 - stretch, base)
        return -first, -last
    return (base * 2.0 ** (stretch - 1) if stretch else 0.0), base * 2.0**stretch


def _finite(rates: Array) -> Array:
    """Rates with those that do not exist counted as rest."""
    return np.where(np.isfinite(rates), rates, 0.0)


def nearest_node(mesh: Array, parameter: Array) -> npt.NDArray[np.intp]:
    """Number of the mesh node nearest to each parameter."""
    # between two nodes, their middle parts those that are nearer to one from those nearer to the other
    return np.searchsorted(0.5 * (mesh[1:] + mesh[:-1]), parameter)


Number: TypeAlias = Any
Namespace: TypeAlias = Any

JETS = JetFunctions(ARRAYS)


@dataclass(frozen=True)
class DrivenBy:
    """A drive with its law: value(t) = start + law(t), of what it drives, whichever coordinate is chosen."""

    drive: Drive
    law: Law
    start: float

    def value(self, m: Namespace, time: Number) -> Number:
        """The drive's value at a time [s], over any algebra."""
        return self.law.jet(m, time) + self.start

    @property
    def initial(self) -> float:
        """The drive's value at time zero: where the initial position is."""
        return float(self.value(ARRAYS, 0.0))


@dataclass(frozen=True)
class Path:
    """Motion of the drives along one parameter.

    Attributes
    ----------
    initial : float
        Parameter of the initial position.
    parameter : MotionParameter
        What the path is run along: time or the value of the one drive.
    forward : +1.0 or -1.0
        Sense in which the parameter runs from there.
    unit : float
        Change of the parameter that counts as large (1 rad, the mechanism's scale, or a time).
    scale : float [m]
        The mechanism's greatest length.
    pace : TimeScale
        Of several drives: what time counts as large, stretch by stretch.
    held : drive -> its value, constant along the path; of a batch of paths arrays (lanes, 1)

    With one drive the parameter is its coordinate (`DriveCoordinate`); what it drives has its own measure.
    """

    driven: tuple[DrivenBy, ...]
    parameter: MotionParameter
    initial: float
    forward: float
    unit: float
    scale: float = 1.0
    pace: TimeScale | None = None
    held: Mapping[str, Number] = field(default_factory=dict)

    @property
    def by_time(self) -> bool:
        """Whether the parameter is time."""
        return self.parameter.by_time

    @property
    def start(self) -> float:
        """Value of the one drive's coordinate at t = 0, without the law's own value there."""
        return float(self.parameter.drives[0].value_of(self.driven[0].start))

    @property
    def turns(self) -> bool:
        """Whether the parameter is an angle."""
        return self.parameter.turns

    @property
    def step(self) -> float:
        """Distance of mesh nodes."""
        return self.unit * tau / NODES_PER_TURN

    def unit_at(self, parameter: float) -> float:
        """Unit of the parameter near a value of it: a change that counts as large."""
        return self.unit if self.pace is None else self.pace.unit_at(parameter)

    def within(self, low: float, high: float) -> Path:
        """Path with one unit for all of a range of the parameter: the finest that counts in it."""
        return self if self.pace is None else replace(self, unit=self.pace.finest(low, high))

    def take(self, take: Callable[[Number], Number]) -> Path:
        """The paths of chosen mechanisms of a batch."""
        if not self.held:
            return self
        return replace(self, held={drive: take(value) for drive, value in self.held.items()})

    def drive_values(self, m: Namespace, parameter: Number) -> dict[str, Number]:
        """What all drives give at a parameter, over any algebra: angles, displacements and distances."""
        if not self.by_time:
            return {self.driven[0].drive.id: self.parameter.drives[0].measure_at(parameter), **self.held}
        return {driven.drive.id: driven.value(m, parameter) for driven in self.driven}

    def coordinates(self, m: Namespace, parameter: Number) -> dict[str, Number]:
        """Values of the coordinates of all drives at a parameter, over any algebra."""
        if not self.by_time:
            return {self.driven[0].drive.id: parameter, **self.held}
        return self.drive_values(m, parameter)

    def possible(self, low: float, high: float) -> tuple[float, float]:
        """The part of a range of the one drive's coordinate in which a cylinder is not shorter than zero."""
        if self.driven[0].drive.kind != "distance":
            return low, high
        coordinate = self.parameter.drives[0]
        least = coordinate.value_of(0.0)
        # whatever its formulas say
        return (max(low, least), high) if coordinate.sense > 0.0 else (low, min(high, least))

    def impossible(self, parameter: Any) -> Any:
        """Where a cylinder would be shorter than zero: the mechanism is open there, whatever its formulas say."""
        negative = np.zeros(np.shape(parameter), dtype=bool)
        if any(driven.drive.kind == "distance" for driven in self.driven):
            values = self.drive_values(ARRAYS, parameter)
            for driven in self.driven:
                if driven.drive.kind == "distance":
                    negative |= values[driven.drive.id] <= 0.0
        return negative


def path_of(mechanism: Mechanism, scale: float) -> Path:
    """The path that a description's drives take; `scale` is the mechanism's greatest length [m]."""
    driven = tuple(_driven_by(mechanism, drive) for drive in mechanism.drives)
    parameter = mechanism.motion_parameter
    if parameter.by_time:
        pace = TimeScale.of(lambda times: _fastest(driven, scale, times))
        return Path(driven, parameter, 0.0, 1.0, pace.unit_at(0.0), scale, pace)
    unit = unit_of(driven[0].drive, scale)
    coordinate = parameter.drives[0]
    initial = float(coordinate.value_of(driven[0].initial))
    return Path(driven, parameter, initial, coordinate.sense * _sense_at_start(driven[0]), unit, scale)


def unit_of(drive: Drive, scale: float) -> float:
    """Change of a drive's value that counts as large: 1 rad, or the mechanism's greatest length."""
    return 1.0 if drive.kind == "angle" else scale


def _sense_at_start(driven: DrivenBy) -> float:
    """Sense in which the drive sets out: that of its first derivative that is not zero."""
    with np.errstate(all="ignore"):
        # at a rest the first derivatives of a law are zero: the first one that is not says which way it goes
        # on
        jet = driven.value(JETS, Jet.variable(np.float64(0.0), 6))
    if isinstance(jet, Jet):
        for order in range(1, jet.order + 1):
            slope = float(jet.derivative(order))
            if isfinite(slope) and slope != 0.0:
                return 1.0 if slope > 0.0 else -1.0
    return 1.0


def _fastest(driven: tuple[DrivenBy, ...], scale: float, times: Array) -> Array:
    """The greatest rate of several drives at times, in their units per second."""
    fastest = np.zeros(len(times))
    with np.errstate(all="ignore"):
        for each in driven:
            value = each.value(JETS, Jet.variable(times, 1))
            if isinstance(value, Jet):
                fastest = np.fmax(fastest, np.abs(value.derivative(1)) / unit_of(each.drive, scale))
    return fastest


def _driven_by(mechanism: Mechanism, drive: Drive) -> DrivenBy:
    law = drive.motion_law
    at_zero = _at_zero(drive, law)
    drawn = _drawn_value(mechanism, drive)
    if drive.kind == "distance":
        return DrivenBy(drive, law, _start_of_cylinder(drive, drawn, at_zero))
    if drive.start is None:
        return DrivenBy(drive, law, (0.0 if drawn is None else drawn) - at_zero)
    _check_agreement(drive, drive.start + at_zero, drawn)
    return DrivenBy(drive, law, drive.start)


def _at_zero(drive: Drive, law: Law) -> float:
    """The law's value in the initial position."""
    with np.errstate(all="ignore"):
        value = float(law.jet(ARRAYS, np.float64(0.0)))
    if not isfinite(value):
        raise InputError(
            f"[[drives]] {drive.id}",
            _("its law has no finite value at t = 0, where the initial position is"),
            _("correct the law"),
        )
    return value


def _drawn_value(mechanism: Mechanism, drive: Drive) -> float | None:
    """The value that the links' initial angles say a drive has: of an angle, or of a cylinder they reach."""
    if drive.distance is not None:
        known = chain_of(mechanism).points
        reached = [known[point] for point in drive.distance if point in known]
        return dist(*reached) if len(reached) == 2 else None
    if drive.link is None:
        return None
    angle = mechanism.links[drive.link].angle
    if mechanism.links[drive.link].reference is not None:
        return angle  # it is measured where the drive's is
    reference = 0.0 if drive.relative_to == "frame" else mechanism.initial_angle(drive.relative_to)
    return None if angle is None or reference is None else angle - reference


def _start_of_cylinder(drive: Drive, drawn: float | None, at_zero: float) -> float:
    """Start of a cylinder, by itself or by the initial angles; its length at t = 0 has to be positive."""
    if drive.start is None and drawn is None:
        raise InputError(
            f"[[drives]] {drive.id}",
            _("the initial length of the cylinder is not given"),
            _("give start, or the initial angles of the links between its points"),
        )
    start = drive.start if drive.start is not None else (drawn or 0.0) - at_zero
    if not start + at_zero > 0.0:
        raise InputError(
            f"[[drives]] {drive.id}",
            _("a cylinder shorter than zero: its length at t = 0 is {value:g} m").format(
                value=start + at_zero
            ),
            _("give the distance of the points as start"),
        )
    return start


def _check_agreement(drive: Drive, value: float, drawn: float | None) -> None:
    if drawn is None:
        return
    # a whole turn off is the same place; remainders below 1e-9 rad are rounding of what was typed
    difference = (value - drawn + tau / 2) % tau - tau / 2
    if abs(difference) > 1e-9:
        raise InputError(
            _("drive of link {link}").format(link=drive.link),
            _("it starts at {value:.9g} rad, but the initial angle is {drawn:.9g} rad").format(
                value=value, drawn=drawn
            ),
            _("omit one of the two"),
        )


# Which samples a motion has: values of the drive, or times where the drive is a law.

MAX_TURNS = 500.0
INSIDE = 0.005
"""Share of the reachable range left out at both ends if none is requested: there speeds are infinite."""

LEAST_JUMP = 1e-9
"""Jumps of a law are reported down to this share of 1 rad, or of the greatest length."""


@dataclass(frozen=True)
class SampleGrid:
    """Samples of a path: times, the path's parameter there, and its first two derivatives by time."""

    time: Array
    parameter: Array
    rate: Array
    second_rate: Array

    @property
    def accelerates(self) -> bool:
        """Whether the parameter has a second derivative by time anywhere."""
        return bool(self.second_rate.any())


def even_grid(
    path: Path,
    samples: int,
    start: float | None,
    stop: float | None,
    reach: tuple[float, float],
    reachable: bool = False,
) -> SampleGrid:
    """Evenly spaced samples from start to stop: values of the drive [rad or m], or times [s] where the drive is a law.

    `reach` are the nearest limits: the range of a displacement drive where none is requested, and that of any drive
    where the `reachable` range is.
    """
    given: Any = samples  # in Python it may be anything
    if isinstance(given, bool) or not isinstance(given, Integral) or not 1 <= samples <= reading.SAMPLES:
        raise InputError(
            _("samples"),
            ngettext("{n} sample is given", "{n} samples are given", samples).format(n=samples),
            _("give 1 to {most}").format(most=reading.SAMPLES),
        )
    for name, value in (("from", start), ("to", stop)):
        if value is not None and not np.isfinite(value):
            raise InputError(name, _("the range must be finite"))
    if path.parameter.is_uniform:
        ends = _range(path, start, stop, reach, reachable)
        _check_range(path, ends, samples, given=start is not None and stop is not None)
        span = _at_values(path, np.linspace(*ends, samples))
    elif reachable and None in (start, stop):
        raise InputError(
            "[study] range",
            _("the reachable range is defined for one drive at constant speed; here the range is time"),
            _("give from and to, or --from and --to"),
        )
    else:
        span = _even_times(path, samples, start, stop)
    _check_extent(path, span)
    return span


def places_of(variable: MotionVariable, at: npt.ArrayLike) -> Array:
    """Values [rad, m or s] of what `at` gives: numbers in SI or texts with a unit, several or one alone.

    Raises InputError for anything else; whether there are some, finite and in one dimension, is seen later.
    """
    try:
        return np.asarray(variable.read_all(at, "at"), dtype=np.float64)
    except (TypeError, ValueError):
        raise _no_places() from None


def place_of(variable: MotionVariable, at: npt.ArrayLike) -> float:
    """The value [rad, m or s] of one instant, alone or as the only one of several; InputError for another number."""
    places = places_of(variable, at)
    if places.size != 1:
        what = _("{count} instants are given").format(count=places.size)
        raise InputError("at", what, _("give one"))
    return float(places.item())


def _no_places() -> InputError:
    return InputError("at", _("it needs finite values of the drive, one or more, in one dimension"))


def grid_at(path: Path, places: Array) -> SampleGrid:
    """Samples at given places: values of the drive [rad or m], or times [s] where the drive is a law."""
    if places.ndim != 1 or not 1 <= len(places) <= reading.SAMPLES or not np.isfinite(places).all():
        raise _no_places()
    span = _at_values(path, places) if path.parameter.is_uniform else _at_times(path, places)
    _check_extent(path, span)
    return span


def _check_extent(path: Path, span: SampleGrid) -> None:
    """Refuse a law that jumps or has no value, and what a mesh of nodes cannot cover: ends too far from the start."""
    for driven in path.driven:
        jump = _jump(path, driven, span.time)
        # a jump to a finite value is reported before missing values: it says more of what to correct
        if jump is not None and np.isfinite(jump.after):
            what = _("its law jumps at t = {time:.9g} s, from {before:.9g} to {after:.9g}")
            raise InputError(
                f"[[drives]] {driven.drive.id}",
                what.format(time=jump.time, before=jump.before, after=jump.after),
                _("a drive cannot jump: join the parts by a ramp or by segments, or choose another range"),
            )
        if not all(np.isfinite(part).all() for part in _derivatives(driven, span.time)):
            raise InputError(
                f"[[drives]] {driven.drive.id}",
                _("its law has no finite value with two derivatives everywhere in the range"),
                _("correct the law, or choose another range"),
            )
        # a jump to no value is reported last, as the samples themselves may have hit it
        if jump is not None:
            raise InputError(
                f"[[drives]] {driven.drive.id}",
                _("its law has no finite value at t = {time:.9g} s").format(time=jump.time),
                _("correct the law, or choose another range"),
                # lengths count in units, so that 500 turns of the mesh are the same work for a displacement
            )
    if path.pace is not None:
        ends = min(path.initial, float(np.min(span.time))), max(path.initial, float(np.max(span.time)))
        turns = path.pace.turns(*ends)
    else:
        turns = float(np.max(np.abs(span.parameter - path.initial))) / (2.0 * np.pi * path.unit)
    if turns > MAX_TURNS:
        raise InputError(
            _("range"),
            _("it is too long: {turns:.3g} turns").format(turns=turns),
            _("give at most {most:g}").format(most=MAX_TURNS),
        )


def _jump(path: Path, one: DrivenBy, time: Array) -> Jump | None:
    """Where a law first jumps, or has no value, between t = 0, the initial position, and any of the times."""
    least = LEAST_JUMP * unit_of(one.drive, path.scale)
    return first_jump(one.law, min(0.0, float(np.min(time))), max(0.0, float(np.max(time))), least)


def _derivatives(one: DrivenBy, time: Array) -> list[Array]:
    """A drive's value and its first two derivatives by time."""
    with np.errstate(all="ignore"):
        value = one.value(JETS, Jet.variable(time, 2))
    if not isinstance(value, Jet):
        value = Jet((value, 0.0, 0.0))
    return [np.broadcast_to(np.asarray(value.derivative(k), dtype=np.float64), time.shape) for k in range(3)]


def _at_values(path: Path, values: Array) -> SampleGrid:
    # with one drive at constant speed times follow from the values, and the law is not asked
    speed = path.parameter.constant_speed
    ones = np.ones(len(values))
    if not speed:
        # at rest in each of these positions: no time passes between them
        return SampleGrid(0.0 * ones, values, 0.0 * ones, 0.0 * ones)
    return SampleGrid(path.parameter.times(values, path.start), values, speed * ones, 0.0 * ones)


def _range(
    path: Path, start: float | None, stop: float | None, reach: tuple[float, float], reachable: bool
) -> tuple[float, float]:
    """First and last value of the drive; what is not requested is one turn, or the reachable range."""
    if path.turns and not reachable:
        first = path.initial if start is None else start
        return first, first + path.forward * 2.0 * np.pi if stop is None else stop
    if start is not None and stop is not None:
        return start, stop
    first, last = _reachable(path, reach)
    return first if start is None else start, last if stop is None else stop


def _reachable(path: Path, reach: tuple[float, float]) -> tuple[float, float]:
    low, high = reach
    if path.turns and np.isinf([low, high]).all():
        return path.initial, path.initial + path.forward * 2.0 * np.pi
    # a reachable range of more than a turn would show the same positions again
    if path.turns:  # a limit on one side only bounds a turn
        low, high = max(low, high - 2.0 * np.pi), min(high, low + 2.0 * np.pi)
    if not np.isfinite(low) or not np.isfinite(high):
        raise InputError(
            f"[[drives]] {path.driven[0].drive.id}",
            _("its range is unlimited"),
            _("give the ends of the range: --from and --to, or [study] from and to"),
        )
    # next to limits speeds grow without bound: a little is left out at both ends
    inside = INSIDE * (high - low)
    return (low + inside, high - inside) if path.forward > 0 else (high - inside, low + inside)


def _even_times(path: Path, samples: int, start: float | None, stop: float | None) -> SampleGrid:
    spans = [driven.law.span for driven in path.driven if driven.law.span is not None]
    # where every law has a value: the latest beginning and the earliest end
    first = start if start is not None else max((span[0] for span in spans), default=0.0)
    last = stop if stop is not None else min((span[1] for span in spans), default=None)
    if last is None:
        last = _one_turn(path)
    _check_range(path, (first, last), samples, given=not (start is None and stop is None))
    return _at_times(path, np.linspace(first, last, samples))


def _check_range(path: Path, ends: tuple[float, float], samples: int, given: bool) -> None:
    """Refuse many samples of one instant: a slip in a range that somebody gave, whose tables would repeat a row."""
    if given and samples > 1 and ends[0] == ends[1]:
        unit = path.parameter.instant.unit
        what = _("the range is empty: it begins and ends at {value:.9g} {unit}").format(
            value=ends[0], unit=unit
        )
        raise InputError(_("range"), what, _("give different ends; for one position one sample is enough"))


def _at_times(path: Path, time: Array) -> SampleGrid:
    if path.by_time:
        return SampleGrid(time, time, np.ones(len(time)), np.zeros(len(time)))
    value, rate, second = _derivatives(path.driven[0], time)
    coordinate = path.parameter.drives[0]
    if not coordinate.is_chosen:
        return SampleGrid(time, value, rate, second)
    return SampleGrid(time, coordinate.value_of(value), coordinate.sense * rate, coordinate.sense * second)


def _one_turn(path: Path) -> float:
    periods = [driven.law.period for driven in path.driven if isinstance(driven.law, ShaftLaw)]
    # the slowest drive makes one whole turn
    speeds = [
        abs(driven.drive.speed)
        for driven in path.driven
        if driven.drive.kind == "angle" and driven.drive.speed
    ]
    if periods and not speeds:
        return max(periods)
    if not speeds:
        raise InputError(
            "[study]",
            _("the drive is a law of time, and its duration is not given"),
            _('give to = "2 s" under [study], or --to "2 s"'),
        )
    return 2.0 * np.pi / min(speeds)
