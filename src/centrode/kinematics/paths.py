"""The path along which a mechanism is driven: the values of all drives as functions of one parameter.

With one drive the parameter is the drive's own value, so results do not depend on its law; with several it
is time.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite, tau
from typing import Any, TypeAlias

import numpy as np

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.errors import InputError
from centrode.laws import Law
from centrode.locale import _
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
    """The value that the links' initial angles say an angle drive has."""
    if drive.kind != "angle" or drive.link is None:
        return None
    angle = mechanism.links[drive.link].angle
    if mechanism.links[drive.link].reference is not None:
        return angle  # it is measured where the drive's is
    reference = 0.0 if drive.relative_to == "frame" else mechanism.initial_angle(drive.relative_to)
    return None if angle is None or reference is None else angle - reference


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
