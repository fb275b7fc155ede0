"""The steady regime of a machine that is left to itself: the speed that comes back after a period of the mechanism.

Poincare's return map at one value of the drive: from the speed there to that a period later. Its fixed point is found
by the secant method; the derivative of the map there, the multiplier, says how fast deviations die away.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import floor, tau

import numpy as np

from centrode.dynamics.simulation.course import OF_DRIVE, RATE, VALUE, Course
from centrode.dynamics.simulation.return_map import ReturnMap, fixed_point, period_of, unsettled
from centrode.dynamics.simulation.setting import Setting, setting_of
from centrode.model.mechanism import Mechanism
from centrode.model.simulations import Simulation
from centrode.numerics.search import tops

NEUTRAL = 1e-5
"""A multiplier as near to 1 says that any speed comes back, but for the rounding of its differences."""
INDIFFERENT = 1e-4
"""The same of a regime that is found: nothing tells its speed from another."""
PARTS = 2000


@dataclass(frozen=True)
class Regime:
    """A machine whose speed repeats; speeds in the sense of the drive.

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
        Mean over the angle.
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
    return regime_of(setting_of(mechanism, settings))


def regime_of(setting: Setting) -> Regime:
    """The same of a mechanism made ready."""
    period = period_of(setting)
    maps = ReturnMap(setting, period)
    speed = maps.run_in()
    if setting.is_conservative:
        # with the place the energy comes back, and with it any speed
        return _regime(setting, maps.course(speed), speed, 1.0, maps)
    found = fixed_point(maps, speed)
    course = maps.course(found)
    slightly = found * (1.0 + 1e-5)
    multiplier = (maps(slightly) - maps(found)) / (slightly - found)
    if abs(found - speed) > 0.01 * speed and abs(multiplier - 1.0) < NEUTRAL:
        raise unsettled(speed, found)  # it went so far that rounding hides how it grows
    return _regime(setting, course, found, multiplier, maps)


def _regime(setting: Setting, course: Course, speed: float, multiplier: float, maps: ReturnMap) -> Regime:
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
        2.0 * (greatest[1] - least[1]) / (greatest[1] + least[1]),
        float(ended[OF_DRIVE]) / period,
        setting.start,
        speed,
        multiplier,
        maps.count,
    )


def _in_turn(value: float, start: float, period: float, sense: float) -> float:
    """A value within one period from the start."""
    turned = sense * (value - start)
    return start + sense * (turned - period * floor(turned / period))


def _extreme(course: Course, sense: float, sign: float) -> tuple[float, float]:
    """Time and greatest value of `sign` times the speed; the speed there."""
    nodes = np.linspace(course.first, course.last, PARTS)
    times, speeds = tops(lambda t: sign * sense * course.at(t)[0][RATE], nodes, most=1)
    return float(times[0]), sign * float(speeds[0])
