"""One cycle of a machine: its period, and what its links and loads are to the drive over it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import tau
from typing import Protocol

import numpy as np
import numpy.typing as npt

from centrode.dynamics.steady_motion.driving import Shape
from centrode.dynamics.steady_motion.quadrature import Array, Panels, Series, resolved
from centrode.errors import InputError, MotionError, Status
from centrode.kinematics.ready import Ready
from centrode.kinematics.solve import solve
from centrode.kinematics.spans import Span
from centrode.locale import _

PANELS_PER_TURN = 72
TOLERANCES = (1e-13, 1e-13, 1e-8, 1e-13)
"""Of inertia, moment, the inertia's slope, which only locates extremes, and the drive's moment."""
PROBES = 2 * np.pi * np.array([0.0133, 0.137, 0.291, 0.454, 0.618, 0.773, 0.911])
"""Places of the first turn that are looked at again in later turns; loads often jump at its beginning."""
FEW_TURNS, MOST_TURNS = 4, 60
SAME = 1e-7
"""Difference, over the greatest value, up to which two turns are the same: that of interpolated change points."""


class Reduction(Protocol):
    """What a cycle asks of a mechanism reduced to its drive, by the drive's value [rad]."""

    def at(self, values: Array, rate: Array) -> tuple[Array, Array, Array]:
        """Inertia [kg m^2], its derivative, and moment of all loads [N m], at values and rates [rad/s] (n)."""

    def jumps(self, low: float, high: float) -> Sequence[float]:
        """Values of the drive between two where the moment jumps."""


@dataclass(frozen=True)
class Cycle:
    """A period of a machine whose drive turns all the way round.

    Everything counts from the beginning of the cycle, in the sense in which the drive turns: angles turned [rad]
    from 0 to `period`, and moments that drive are positive.

    Attributes
    ----------
    first : float [rad]
        The drive's value at the beginning.
    sense : +1.0 or -1.0
    turns : int
        Whole turns of the drive until everything repeats.
    inertia, slope : Series [kg m^2], [kg m^2/rad]
        Inertia of the links (group II), reduced to the drive, and its derivative.
    moment : Series [N m]
        Of all loads and weights, at the speed the cycle was asked at.
    """

    reduction: Reduction
    first: float
    sense: float
    turns: int
    inertia: Series
    slope: Series
    moment: Series

    @property
    def period(self) -> float:
        """Angle [rad] of a cycle."""
        return tau * self.turns

    @property
    def panels(self) -> Panels:
        """Panels of all series; they end at the jumps of the loads."""
        return self.inertia.panels

    def value(self, turned: Array) -> Array:
        """The drive's value [rad] at an angle turned."""
        return self.first + self.sense * turned

    def at_speed(self, speed: Array) -> Cycle:
        """The same cycle with loads at speeds [rad/s] of the drive at the nodes of the panels."""
        moment = _reduced(self.reduction, self.first, self.sense, self.panels.nodes, speed)[1]
        return replace(self, moment=self.panels.series(moment))


def cycle_of(prepared: Ready, reduction: Reduction, shape: Shape | None, speed: float) -> Cycle:
    """The cycle of a mechanism at a constant speed [rad/s], on panels that fit the shape of the drive too.

    Raises
    ------
    InputError
        Loads or places that do not repeat.
    MotionError
        The mechanism does not turn fully.
    """
    path = prepared.kinematics.path
    first, sense = path.initial, path.forward
    turns = _turns(prepared, reduction, speed)

    def functions(turned: Array) -> Array:
        found = _reduced(reduction, first, sense, turned, np.full(len(turned), speed))
        if not np.isfinite(found).all():
            raise _locks(prepared, turned[~np.isfinite(found).all(axis=0)])
        drive = np.ones(len(turned)) if shape is None else shape.at(first + sense * turned, speed)
        return np.concatenate([found, drive[None]])

    def scales(peaks: Array) -> Array:
        """Moments and slopes count beside what the links' inertia makes of the speed."""
        inertia, moment, slope, drive = peaks
        return np.array([inertia, max(moment, inertia * speed**2), max(slope, inertia), drive])

    panels, values = resolved(functions, _edges(reduction, first, sense, turns), TOLERANCES, scales)
    inertia, moment, slope = (panels.series(row) for row in values[:3])
    return Cycle(reduction, first, sense, turns, inertia, slope, moment)


def check_drive(prepared: Ready) -> None:
    """Refuse, with an InputError, what has no drive that turns."""
    drives = prepared.mechanism.drives
    if len(drives) > 1:
        raise InputError(
            "[[drives]]",
            _("steady motion needs one drive, the mechanism has {count}").format(count=len(drives)),
            _("tie the drives by a gear, or leave out [machine]"),
        )
    if drives[0].kind != "angle":
        raise InputError(
            "[[drives]]",
            _("steady motion needs a drive that turns"),
            _("drive the angle of a link, or leave out [machine]"),
        )


def _reduced(reduction: Reduction, first: float, sense: float, turned: Array, speed: Array) -> Array:
    """Inertia, moment and slope (3, n) in the sense of the motion."""
    inertia, slope, moment = reduction.at(first + sense * turned, sense * speed)
    return np.stack([inertia, sense * moment, sense * slope])


def _edges(reduction: Reduction, first: float, sense: float, turns: int) -> Array:
    """Edges of the first panels: evenly, and at the jumps."""
    period = tau * turns
    ends = sorted((first, first + sense * period))
    jumps = sense * (np.array(sorted(reduction.jumps(*ends))) - first)
    jumps = jumps[(jumps > 0.0) & (jumps < period)]
    even = np.linspace(0.0, period, PANELS_PER_TURN * turns + 1)
    inner = even[1:-1]
    if jumps.size:
        inner = inner[np.min(np.abs(inner[:, None] - jumps), axis=1) > 1e-9]
    return np.unique(np.concatenate([even[[0, -1]], inner, jumps]))


def _turns(prepared: Ready, reduction: Reduction, speed: float) -> int:
    """The least number of turns after which places, inertia and loads repeat."""
    path = prepared.kinematics.path
    for most in (FEW_TURNS, MOST_TURNS):
        turned = (PROBES + tau * np.arange(most + 1)[:, None]).reshape(-1)
        places = _places(prepared, turned)
        reduced = _reduced(reduction, path.initial, path.forward, turned, np.full(turned.size, speed))
        if not np.isfinite(reduced).all():
            raise _locks(prepared, turned[~np.isfinite(reduced).all(axis=0)])
        inertia, moment = reduced[:2]
        # a moment that is nothing but rounding repeats
        small = 1e-6 * speed**2 * float(np.max(np.abs(inertia)))
        moves = _repeats(places, most, 0.0) & _repeats(inertia, most, 0.0)
        repeats = moves & _repeats(moment, most, small)
        if repeats.any():
            return 1 + int(np.argmax(repeats))
    if moves.any():
        raise InputError(
            "[machine]",
            _("the loads do not repeat with the motion"),
            _("steady motion needs loads that depend on positions and velocities, not on time or turns"),
        )
    raise InputError(
        "[machine]",
        _("the mechanism is not back in its first position after {turns} turns of the drive").format(
            turns=most
        ),
        _("change the ratios of its gears"),
    )


def _repeats(values: Array, most: int, small: float) -> npt.NDArray[np.bool_]:
    """Whether values at the probes (turns * probes, ...) are the first ones again after 1, 2, ... `most` turns."""
    by_turn = values.reshape(most + 1, -1)
    apart = np.max(np.abs(by_turn[1:] - by_turn[0]), axis=1, initial=0.0)
    return np.asarray(apart <= SAME * (float(np.max(np.abs(values), initial=0.0)) + small))


def _places(prepared: Ready, turned: Array) -> Array:
    """Coordinates of all moving points (n, coordinates)."""
    path = prepared.kinematics.path
    ones = np.ones(len(turned))
    solved = solve(prepared, Span(turned, path.initial + path.forward * turned, ones, 0.0 * ones))
    missing = ~np.isin(solved.status[0], (Status.OK, Status.SINGULAR))
    if missing.any():
        raise _locks(prepared, turned[missing])
    return np.asarray(solved.points[0, 0].reshape(len(turned), -1))


def _locks(prepared: Ready, turned: Array) -> MotionError:
    path = prepared.kinematics.path
    value = path.initial + path.forward * float(turned.min())
    return MotionError(
        "[machine]",
        _("the mechanism does not turn fully: it has no motion at {value:.6g} deg of its drive").format(
            value=np.degrees(value)
        ),
        _("change the dimensions (centrode rotatability says what stops it)"),
    )
