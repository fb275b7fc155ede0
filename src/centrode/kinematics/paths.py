"""The path along which a mechanism is driven: the values of all drives as functions of one parameter.

With one drive the parameter is the drive's own value, so results do not depend on its law; with several it
is time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import dist, isfinite, tau
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.errors import InputError
from centrode.kinematics.pace import NODES_PER_TURN, Pace
from centrode.laws import Law
from centrode.locale import _
from centrode.model.chain import chain_of
from centrode.model.mechanism import Drive, Mechanism
from centrode.model.motion_parameter import MotionParameter

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

JETS = JetFunctions(ARRAYS)


@dataclass(frozen=True)
class DrivenBy:
    """A drive with its law: value(t) = start + law(t)."""

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
    """How the drives move.

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
    pace : Pace
        Of several drives: what time counts as large, stretch by stretch.
    held : drive -> its value, constant along the path; of a batch of paths arrays (lanes, 1)
    """

    driven: tuple[DrivenBy, ...]
    parameter: MotionParameter
    initial: float
    forward: float
    unit: float
    scale: float = 1.0
    pace: Pace | None = None
    held: Mapping[str, Number] = field(default_factory=dict)

    @property
    def by_time(self) -> bool:
        """Whether the parameter is time."""
        return self.parameter.by_time

    @property
    def turns(self) -> bool:
        """Whether the parameter is an angle."""
        return self.parameter.turns

    @property
    def step(self) -> float:
        """Distance of mesh nodes."""
        return self.unit * tau / NODES_PER_TURN

    def unit_at(self, parameter: float) -> float:
        """What counts as large near a parameter."""
        return self.unit if self.pace is None else self.pace.unit_at(parameter)

    def within(self, low: float, high: float) -> Path:
        """The same path with the unit that is fit for all of a range."""
        return self if self.pace is None else replace(self, unit=self.pace.finest(low, high))

    def taken(self, take: Callable[[Number], Number]) -> Path:
        """The paths of chosen mechanisms of a batch."""
        if not self.held:
            return self
        return replace(self, held={drive: take(value) for drive, value in self.held.items()})

    def drive_values(self, m: Namespace, parameter: Number) -> dict[str, Number]:
        """Values of all drives at a parameter, over any algebra."""
        if not self.by_time:
            return {self.driven[0].drive.id: parameter, **self.held}
        return {one.drive.id: one.value(m, parameter) for one in self.driven}

    def impossible(self, parameter: Any) -> Any:
        """Where a cylinder would be shorter than zero: the mechanism is open there, whatever its formulas say."""
        found = np.zeros(np.shape(parameter), dtype=bool)
        if any(one.drive.kind == "distance" for one in self.driven):
            values = self.drive_values(ARRAYS, parameter)
            for one in self.driven:
                if one.drive.kind == "distance":
                    found |= values[one.drive.id] <= 0.0
        return found


def path_of(mechanism: Mechanism, scale: float) -> Path:
    """The path that a description's drives take; `scale` is the mechanism's greatest length [m]."""
    driven = tuple(_driven_by(mechanism, drive) for drive in mechanism.drives)
    parameter = mechanism.motion_parameter
    if parameter.by_time:
        pace = Pace.of(lambda times: _fastest(driven, scale, times))
        return Path(driven, parameter, 0.0, 1.0, pace.unit_at(0.0), scale, pace)
    unit = unit_of(driven[0].drive, scale)
    return Path(driven, parameter, driven[0].initial, _sense_at_start(driven[0]), unit, scale)


def unit_of(drive: Drive, scale: float) -> float:
    """Change of a drive's value that counts as large: 1 rad, or the mechanism's greatest length."""
    return 1.0 if drive.kind == "angle" else scale


def _sense_at_start(driven: DrivenBy) -> float:
    """Sense in which the drive sets out: that of its first derivative that is not zero."""
    with np.errstate(all="ignore"):
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
        for one in driven:
            value = one.value(JETS, Jet.variable(times, 1))
            if isinstance(value, Jet):
                fastest = np.fmax(fastest, np.abs(value.derivative(1)) / unit_of(one.drive, scale))
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
            _("nothing says how long the cylinder is in the initial position"),
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
    difference = (value - drawn + tau / 2) % tau - tau / 2
    if abs(difference) > 1e-9:
        raise InputError(
            _("drive of link {link}").format(link=drive.link),
            _("it starts at {value:.9g} rad, but the initial angle says {drawn:.9g} rad").format(
                value=value, drawn=drawn
            ),
            _("leave out one of the two"),
        )
