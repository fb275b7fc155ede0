"""What is asked of a path: its start, its range, that it stays near and smooth."""

from __future__ import annotations

import math

from centrode.errors import InputError
from centrode.locale import _

GREATEST_RANGE = 20 * math.pi
"""Ten turns either way."""

STEEPEST = math.radians(89.0)


MOST_BEND = 1e4
"""Radius at the start over the radius of curvature there."""


MOST_GROWTH = 1e6
"""Rho over rho0 from which on a path is taken to run away."""


def check_bend(rho0: float, curvature: float) -> None:
    """Raise InputError for a path that bends into next to a point at its start."""
    if rho0 * curvature > MOST_BEND:
        what = _("at the start the radius of curvature is more than {times:g} times smaller than the radius")
        raise InputError("[curvature]", what.format(times=MOST_BEND), _("check the units of the curvature"))


def check_start(rho0: float, gamma0: float, start: float, stop: float) -> None:
    """Raise InputError for a start that no path has: radius, pressure angle and range."""
    if not all(math.isfinite(number) for number in (rho0, gamma0, start, stop)):
        raise InputError("[start]", _("finite numbers are needed"), _("correct them"))
    if rho0 <= 0:
        what = _("the radius at the start has to be positive, got {value:g} m").format(value=rho0)
        raise InputError("[start] radius", what)
    if abs(gamma0) > STEEPEST:
        what = _("the pressure angle at the start has to lie within 89 deg, got {angle:.6g} deg")
        told = what.format(angle=math.degrees(gamma0))
        raise InputError("[start] pressure_angle", told, _("at 90 deg the follower stalls"))
    if not start <= 0.0 <= stop or start == stop:
        what = _("the range has to hold the start phi = 0, got {start:.6g} to {stop:.6g} deg")
        told = what.format(start=math.degrees(start), stop=math.degrees(stop))
        raise InputError("[range]", told, _('write [range] with "from" not above 0 and "to" not below'))
    if stop - start > GREATEST_RANGE:
        what = _("the range is longer than {turns:g} turns").format(turns=GREATEST_RANGE / math.tau)
        raise InputError("[range]", what, _("shorten it"))


def no_series(phi: float) -> InputError:
    """What is said of a path that cannot be expanded at an angle."""
    what = _("the path has no Taylor series at {angle:.6g} deg").format(angle=math.degrees(phi))
    repair = _(
        "roots of what vanishes there are not smooth, and what changes too quickly leaves the range of numbers"
    )
    return InputError("[curvature]", what, repair)


def runs_away(phi: float) -> InputError:
    """What is said of a path that leaves the cam."""
    what = _(
        "the path runs away from the cam's centre: at {angle:.6g} deg ρ is {growth:g} times that of the start"
    )
    told = what.format(angle=math.degrees(phi), growth=MOST_GROWTH)
    return InputError("[curvature]", told, _("a greater curvature keeps it near, or a shorter range"))
