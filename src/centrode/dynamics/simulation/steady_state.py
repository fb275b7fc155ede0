"""The steady regime of a machine that is left to itself: the speed that comes back after a period of the mechanism.

Poincare's return map at one value of the drive: from the speed there to that a period later. Its fixed point is found
by the secant method; the derivative of the map there, the multiplier, says how fast deviations die away.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import floor, inf, tau

import numpy as np

from centrode.dynamics.simulation.equation_of_motion import OF_DRIVE, RATE, VALUE, Field, ReducedTrajectory
from centrode.dynamics.simulation.integrator import Stepper, Until
from centrode.dynamics.simulation.reduced_motion import ReducedSetting, reduced_setting
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.simulation import Simulation
from centrode.numerics.search import tops

# The return map of a machine: from the speed at one value of the drive to that a period later, and its fixed
# point.

TOLERANCE = 1e-11
"""Relative one of the integration from period to period."""
SETTLED = 1e-9
"""Change of the speed over a period, relative, at which it has come back."""
MOST_MAPS = 60
MOST_STEPS = 60_000
RUN_IN = 2
"""Periods that are run through before the return map is looked at."""
PROBES = tau * np.array([0.0133, 0.291, 0.618, 0.911])


class ReturnMap:
    """The return map of a setting."""

    def __init__(self, setting: ReducedSetting, period: float) -> None:
        self.setting, self.period = setting, period
        self.count = 0

    def __call__(self, speed: float) -> float:
        """The speed after a period; NaN where it does not get there."""
        course = self.course(speed)
        return self._speed(course) if course.ended == "turns" else np.nan

    def course(self, speed: float) -> ReducedTrajectory:
        """ReducedTrajectory over one period from a speed at the section."""
        self.count += 1
        return self._run(speed, 1)

    def run_in(self) -> float:
        """The speed after some periods from the start itself."""
        speed = self.setting.settings.speed
        self.count += RUN_IN
        course = self._run(speed, RUN_IN)
        if course.ended != "turns":
            states = course.at(np.array([course.last]))[0]
            raise MotionError(
                "[simulation]",
                _("there is no steady regime: the machine stops with the drive at {value:.6g}").format(
                    value=float(states[VALUE, 0])
                ),
                _("give it more moment, inertia or speed at the start"),
            )
        return self._speed(course)

    def _run(self, speed: float, periods: int) -> ReducedTrajectory:
        setting = self.setting
        stiff = setting.settings.scheme == "stiff"
        until = Until(inf, periods * self.period)
        stepper = Stepper(setting.field, until, TOLERANCE, stiff, most=MOST_STEPS)
        return stepper.run(setting.start, setting.rows.sense * speed)

    def _speed(self, course: ReducedTrajectory) -> float:
        return float(course.at(np.array([course.last]))[0][RATE, 0]) * self.setting.rows.sense


def period_of(setting: ReducedSetting) -> float:
    """Angle after which everything repeats."""
    field = setting.field
    if field.of_time:
        raise InputError(
            "[simulation]",
            _("the driving moment or the loads depend on time: a periodic regime is not sought"),
            _("use formulas of q, v and x"),
        )
    period = field.tracks.period
    if not period:
        raise MotionError(
            "[simulation]",
            _("a steady regime needs a drive that turns all the way round and loads that repeat"),
            _("simulate it for a time instead"),
        )
    if not _repeats(field, period, setting.rows.sense):
        raise InputError(
            "[simulation]",
            _("drive or loads do not repeat with the motion"),
            _("use formulas that are the same after whole turns"),
        )
    return period


def _repeats(field: Field, period: float, sense: float) -> bool:
    """Whether moments are the same a period later."""
    for probe in PROBES:
        here, there = (field.tracks.first + float(probe) + k * period for k in (0, 1))
        one, other = (field.forces(field.leg(q, sense), 0.0, q, sense) for q in (here, there))
        for name in ("stored", "friction", "other", "driving"):
            a, b = getattr(one, name), getattr(other, name)
            # moments may be small beside what inertia makes of a unit of speed: that counts as their size too
            if abs(a - b) > 1e-7 * (abs(a) + abs(b) + one.inertia):
                return False
    return True


def fixed_point(maps: Callable[[float], float], speed: float) -> float:
    """The speed that comes back, by the secant method; plain iteration where that leads astray."""
    before, missed_before = speed, maps(speed) - speed
    if abs(missed_before) <= SETTLED * speed:
        return speed
    # the first step is the map itself, as one value tells no slope
    here = before + missed_before
    for _k in range(MOST_MAPS):
        back = maps(here) if here > 0.0 else np.nan
        missed = back - here
        if not np.isfinite(missed):
            break
        # the error of the fixed point is what is missed over |1 - slope|
        if abs(missed) <= SETTLED * here * min(1.0, abs(1.0 - _slope(before, here, missed_before, missed))):
            return here
        slope = _slope(before, here, missed_before, missed)
        # where the line through two values of the map meets the diagonal
        ahead = here - missed / (slope - 1.0) if slope != 1.0 else back
        # a step by more than five times leads astray: the map itself is tried instead
        if not 0.2 * here < ahead < 5.0 * here:
            ahead = back
        before, missed_before, here = here, missed, ahead
    raise unsettled_error(speed, here)


def unsettled_error(first: float, last: float) -> MotionError:
    """The failure of a speed that does not come back."""
    return MotionError(
        "[simulation]",
        _(
            "the speed does not settle: it changes from {first:.6g} to {last:.6g} rad/s and keeps changing"
        ).format(first=first, last=last),
        _("let drive or loads depend on the speed, or give another start"),
    )


def _slope(before: float, here: float, missed_before: float, missed: float) -> float:
    """Derivative of the return map by two of its values."""
    return 1.0 + (missed - missed_before) / (here - before) if here != before else 1.0


NEUTRAL = 1e-5
"""A multiplier as near to 1 says that any speed comes back, but for the rounding of its differences."""
INDIFFERENT = 1e-4
"""A multiplier of a found regime as near to 1 says that any other speed would come back as well."""
PARTS = 2000


@dataclass(frozen=True)
class Regime:
    """A machine whose speed repeats; speeds are magnitudes.

    Attributes
    ----------
    turns : int
        Turns of the drive until everything repeats.
    time : float [s]
        Of a period.
    mean_speed : float [rad/s]
        In time: angle of a period over its time.
    least_speed, least_at, least_time : float [rad/s, rad, s]
        The least speed, the drive's value there, and the time from the section.
    greatest_speed, greatest_at, greatest_time : float
    fluctuation : float
        (greatest - least) over half their sum.
    driving_moment : float [N m]
        Mean over the angle, along the coordinate of the drive.
    section, section_speed : float [rad, rad/s]
        Value of the drive at which the map was taken, and the speed that comes back there.
    multiplier : float
        What is left of a deviation after a period; 1 where any speed would come back.
    maps : int
        Periods that were integrated.
    """

    turns: int
    time: float
    mean_speed: float
    least_speed: float
    least_at: float
    least_time: float
    greatest_speed: float
    greatest_at: float
    greatest_time: float
    fluctuation: float
    driving_moment: float
    section: float
    section_speed: float
    multiplier: float
    maps: int

    @property
    def indifferent(self) -> bool:
        """Whether any speed would come back, as of a conservative machine: nothing runs up to this one."""
        return abs(self.multiplier - 1.0) < INDIFFERENT


def steady_regime(mechanism: Mechanism, settings: Simulation | None = None) -> Regime:
    """The steady regime that a machine runs up to from the start of its simulation.

    Raises
    ------
    InputError
        As `simulate`; loads or a drive that depend on time or do not repeat.
    MotionError
        It does not turn all the way round, comes to rest, or its speed does not settle.
    """
    return steady_state_of(reduced_setting(mechanism, settings))


def steady_state_of(setting: ReducedSetting) -> Regime:
    """The steady regime that a setting runs up to; see `steady_regime`."""
    period = period_of(setting)
    maps = ReturnMap(setting, period)
    speed = maps.run_in()
    if setting.is_conservative:
        # with the place the energy comes back, and with it any speed
        return _steady_state(setting, maps.course(speed), speed, 1.0, maps)
    fixed_speed = fixed_point(maps, speed)
    course = maps.course(fixed_speed)
    slightly = fixed_speed * (1.0 + 1e-5)
    # the multiplier by a difference of 1e-5: rounding of the maps, some 1e-11, leaves six digits of it
    multiplier = (maps(slightly) - maps(fixed_speed)) / (slightly - fixed_speed)
    if abs(fixed_speed - speed) > 0.01 * speed and abs(multiplier - 1.0) < NEUTRAL:
        raise unsettled_error(speed, fixed_speed)  # it went so far that rounding hides how it grows
    return _steady_state(setting, course, fixed_speed, multiplier, maps)


def _steady_state(
    setting: ReducedSetting, course: ReducedTrajectory, speed: float, multiplier: float, maps: ReturnMap
) -> Regime:
    sense, period = setting.rows.sense, maps.period
    least, greatest = (_extreme(course, sense, sign) for sign in (-1.0, 1.0))
    ended = course.at(np.array([course.last]))[0][:, 0]
    time = float(course.last - course.first)
    values = [float(course.at(np.array([t]))[0][VALUE, 0]) for t, _speed in (least, greatest)]
    return Regime(
        round(period / tau),
        time,
        period / time,
        least[1],
        _in_turn(values[0], setting.start, period, sense),
        least[0],
        greatest[1],
        _in_turn(values[1], setting.start, period, sense),
        greatest[0],
        # the difference over half the sum
        2.0 * (greatest[1] - least[1]) / (greatest[1] + least[1]),
        float(ended[OF_DRIVE]) / (sense * period),
        setting.start,
        speed,
        multiplier,
        maps.count,
    )


def _in_turn(value: float, start: float, period: float, sense: float) -> float:
    """A value within one period from the start."""
    turned = sense * (value - start)
    return start + sense * (turned - period * floor(turned / period))


def _extreme(course: ReducedTrajectory, sense: float, sign: float) -> tuple[float, float]:
    """Time and greatest value of `sign` times the speed; the speed there."""
    nodes = np.linspace(course.first, course.last, PARTS)
    times, speeds = tops(lambda t: sign * sense * course.at(t)[0][RATE], nodes, most=1)
    return float(times[0]), sign * float(speeds[0])
