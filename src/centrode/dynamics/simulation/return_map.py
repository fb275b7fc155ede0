"""The return map of a machine: from the speed at one value of the drive to that a period later, and its fixed point."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, tau

import numpy as np

from centrode.dynamics.simulation.course import RATE, VALUE, Course
from centrode.dynamics.simulation.field import Field
from centrode.dynamics.simulation.setting import Setting
from centrode.dynamics.simulation.stepping import Stepper
from centrode.dynamics.simulation.watching import Until
from centrode.errors import InputError, MotionError
from centrode.locale import _

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

    def __init__(self, setting: Setting, period: float) -> None:
        self.setting, self.period = setting, period
        self.count = 0

    def __call__(self, speed: float) -> float:
        """The speed after a period; NaN where it does not get there."""
        course = self.course(speed)
        return self._speed(course) if course.ended == "turns" else np.nan

    def course(self, speed: float) -> Course:
        """One period from a speed at the section."""
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
                _("there is no steady regime: it comes to rest with the drive at {value:.6g}").format(
                    value=float(states[VALUE, 0])
                ),
                _("give it more moment, inertia or speed at the start"),
            )
        return self._speed(course)

    def _run(self, speed: float, periods: int) -> Course:
        setting = self.setting
        stiff = setting.settings.scheme == "stiff"
        until = Until(inf, periods * self.period)
        stepper = Stepper(setting.field, until, TOLERANCE, stiff, most=MOST_STEPS)
        return stepper.run(setting.start, setting.rows.sense * speed)

    def _speed(self, course: Course) -> float:
        return float(course.at(np.array([course.last]))[0][RATE, 0]) * self.setting.rows.sense


def period_of(setting: Setting) -> float:
    """Angle after which everything repeats."""
    field = setting.field
    if field.of_time:
        raise InputError(
            "[simulation]",
            _("drive or loads depend on time: a speed that repeats is not looked for"),
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
            if abs(a - b) > 1e-7 * (abs(a) + abs(b) + one.inertia):
                return False
    return True


def fixed_point(maps: Callable[[float], float], speed: float) -> float:
    """The speed that comes back, by the secant method; plain iteration where that leads astray."""
    before, missed_before = speed, maps(speed) - speed
    if abs(missed_before) <= SETTLED * speed:
        return speed
    here = before + missed_before
    for _k in range(MOST_MAPS):
        back = maps(here) if here > 0.0 else np.nan
        missed = back - here
        if not np.isfinite(missed):
            break
        if abs(missed) <= SETTLED * here * min(1.0, abs(1.0 - _slope(before, here, missed_before, missed))):
            return here
        slope = _slope(before, here, missed_before, missed)
        ahead = here - missed / (slope - 1.0) if slope != 1.0 else back
        if not 0.2 * here < ahead < 5.0 * here:
            ahead = back
        before, missed_before, here = here, missed, ahead
    raise unsettled(speed, here)


def unsettled(first: float, last: float) -> MotionError:
    """The failure of a speed that does not come back."""
    return MotionError(
        "[simulation]",
        _("the speed does not settle: it goes from {first:.6g} to {last:.6g} rad/s, and on").format(
            first=first, last=last
        ),
        _("let drive or loads depend on the speed, or give another start"),
    )


def _slope(before: float, here: float, missed_before: float, missed: float) -> float:
    """Derivative of the return map by two of its values."""
    return 1.0 + (missed - missed_before) / (here - before) if here != before else 1.0
