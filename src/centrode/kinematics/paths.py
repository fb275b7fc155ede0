"""The path along which a mechanism is driven: the values of all drives as functions of one parameter.

With one drive the parameter is the drive's own value, so results do not depend on its law; with several it
is time.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import dist, isfinite, tau
from typing import Any, TypeAlias

import numpy as np

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.errors import InputError
from centrode.laws import Law
from centrode.locale import _
from centrode.model.chain import chain_of
from centrode.model.mechanism import Drive, Mechanism

Number: TypeAlias = Any
Namespace: TypeAlias = Any

NODES_PER_TURN = 720
"""Mesh on which events are looked for: two events closer than half a degree may be missed."""

RATES = 1000
"""Times at which the rates of several drives are compared."""

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
    forward : +1.0 or -1.0
        Sense in which the parameter runs from there.
    unit : float
        Change of the parameter that counts as large (1 rad, the mechanism's scale, or a time).
    scale : float [m]
        The mechanism's greatest length.
    """

    driven: tuple[DrivenBy, ...]
    initial: float
    forward: float
    unit: float
    scale: float = 1.0

    @property
    def by_time(self) -> bool:
        """Whether the parameter is time."""
        return len(self.driven) > 1

    @property
    def step(self) -> float:
        """Distance of mesh nodes."""
        return self.unit * tau / NODES_PER_TURN

    def drive_values(self, m: Namespace, parameter: Number) -> dict[str, Number]:
        """Values of all drives at a parameter, over any algebra."""
        if not self.by_time:
            return {self.driven[0].drive.id: parameter}
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
    if len(driven) > 1:
        return in_time(Path(driven, 0.0, 1.0, 1.0, scale), 0.0, 1.0)
    unit = 1.0 if driven[0].drive.kind == "angle" else scale
    return Path(driven, driven[0].initial, _sense_at_start(driven[0]), unit)


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


def in_time(path: Path, first: float, last: float) -> Path:
    """The path of several drives with its unit fit for a stretch of time: the fastest drive moves 1 rad, or its scale.

    Where the drives are laws, the mesh on which events are looked for so depends on the time asked for.
    """
    times = np.linspace(min(first, 0.0), max(last, 0.0), RATES)
    fastest = 0.0
    with np.errstate(all="ignore"):
        for one in path.driven:
            value = one.value(JETS, Jet.variable(times, 1))
            rates = np.abs(value.derivative(1)) if isinstance(value, Jet) else np.zeros(1)
            unit = 1.0 if one.drive.kind == "angle" else path.scale
            fastest = max(fastest, float(np.nanmax(rates)) / unit)
    return replace(path, unit=1.0 / fastest) if fastest > 0.0 and isfinite(fastest) else path


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
