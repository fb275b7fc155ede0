"""What derivatives of the lift do where segments meet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.algebra.rounding import ROUNDED, SAFETY, Rounded
from centrode.cams.followers.motion import FollowerMotion

ORDER = 4
"""Highest derivative that is looked at."""
_BOUNDED = JetFunctions(ROUNDED)


@dataclass(frozen=True)
class Joint:
    """Where one segment ends and the next begins.

    Attributes
    ----------
    number : int
        Of the segment that ends, counted from 0.
    angle : float [rad]
        Of the cam; a turn for the end of the last segment, where the first one begins.
    before, after : tuple of float [m/rad^k or rad/rad^k]
        Lift and derivatives from both sides.
    jumps : tuple of float
        What they change by; exactly 0 where rounding explains the difference.
    """

    number: int
    angle: float
    before: tuple[float, ...]
    after: tuple[float, ...]
    jumps: tuple[float, ...]

    @property
    def first_jump(self) -> int | None:
        """The lowest derivative that jumps; None if all that were looked at are continuous."""
        return next((order for order, jump in enumerate(self.jumps) if jump), None)


def joints_of(motion: FollowerMotion, order: int = ORDER) -> tuple[Joint, ...]:
    """All joints of a turn, that of the last segment with the first at its end.

    Notes
    -----
    Both sides are computed with a bound of their rounding error, numbers of the description counting as rounded
    ones; what these bounds explain is no jump.
    """
    return tuple(_joint(motion, number, order) for number in range(len(motion.law.ends)))


def _joint(motion: FollowerMotion, number: int, order: int) -> Joint:
    angle = motion.law.ends[number]
    place = Jet.variable(Rounded.of(np.float64(angle)), order)
    sides = motion.law.at_joint(number, _BOUNDED, place)
    before, after = ([Rounded.of(side.derivative(k)) for k in range(order + 1)] for side in sides)
    return Joint(
        number,
        angle,
        tuple(float(one.value) for one in before),
        tuple(float(one.value) for one in after),
        tuple(_jump(one, other) for one, other in zip(before, after, strict=True)),
    )


def _jump(before: Rounded, after: Rounded) -> float:
    jump = float(after.value) - float(before.value)
    return jump if abs(jump) > SAFETY * float(before.bound + after.bound) else 0.0


def first_jump(motion: FollowerMotion) -> int | None:
    """The lowest derivative, up to the fourth, that jumps anywhere in the turn; None if none does."""
    inside = [segment.inner_jump for segment in motion.law.segments]
    found = [joint.first_jump for joint in joints_of(motion)]
    known = [order for order in (*inside, *found) if order is not None and order <= ORDER]
    return min(known, default=None)
