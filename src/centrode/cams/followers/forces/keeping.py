"""Springs that keep a follower on its cam, and the speed at which it jumps."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from centrode.cams.followers.forces.cycle import Extreme, greatest, least, slope_drops
from centrode.cams.followers.forces.demand import Burden, Lifting

Array = NDArray[np.float64]

LOWEST = 1e-12
"""Share of the greatest lift below which the follower counts as down: a spring's stiffness does nothing there."""


def least_push(motion: Lifting, burden: Burden, speed: float) -> Extreme:
    """The least force along the motion over a turn, and where: below zero the contact is lost.

    Minus infinity where the slope of the lift falls by a step while there is inertia and speed.
    """
    drops = slope_drops(motion) if burden.inertia and speed else []
    if drops:
        return Extreme(-math.inf, drops[0])
    return least(motion, lambda rows: burden.needed(rows, speed))


def jump_speed(motion: Lifting, burden: Burden) -> Extreme:
    """The speed of the cam [rad/s] above which the follower leaves it, and the angle where it does.

    Infinite where it never does, with NaN for the angle; zero where it does at once.
    """
    rest = least(motion, lambda rows: burden.at_rest(rows[0]))
    if rest.value < 0:
        return Extreme(0.0, rest.angle)
    if not burden.inertia:
        return Extreme(math.inf, math.nan)
    drops = slope_drops(motion)
    if drops:
        return Extreme(0.0, drops[0])

    def inverse_square(rows: Array) -> Array:
        """1/speed^2 of losing contact; below zero or NaN where it is not lost at any speed."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(-burden.inertia * rows[2] / burden.at_rest(rows[0]))

    worst = greatest(motion, inverse_square)
    if not worst.value > 0:
        return Extreme(math.inf, math.nan)
    return Extreme(1 / math.sqrt(worst.value), worst.angle)


def preload_needed(motion: Lifting, burden: Burden, speed: float, push: float = 0.0) -> Extreme:
    """The preload of a spring of the burden's stiffness that leaves at least a push [N, or N m] at a speed [rad/s].

    Infinite where no spring does; below zero where the rest of the burden presses more than is needed.
    """
    found = least_push(motion, replace(burden, preload=0.0), speed)
    return Extreme(push - found.value, found.angle)


def stiffness_needed(motion: Lifting, burden: Burden, speed: float, push: float = 0.0) -> Extreme:
    """The stiffness of a spring of the burden's preload that leaves at least a push [N, or N m] at a speed [rad/s].

    Infinite where none does, because too little presses while the follower is down; zero where none is needed.
    """
    plain = replace(burden, stiffness=0.0)
    drops = slope_drops(motion) if burden.inertia and speed else []
    if drops:
        return Extreme(math.inf, drops[0])
    high = greatest(motion, lambda rows: np.abs(rows[0])).value

    def lacking(rows: Array) -> Array:
        return push - plain.needed(rows, speed)

    def when_down(rows: Array) -> Array:
        return np.where(rows[0] <= LOWEST * high, lacking(rows), np.nan)

    def by_lift(rows: Array) -> Array:
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(rows[0] > LOWEST * high, lacking(rows) / rows[0], np.nan)

    down = greatest(motion, when_down)
    if down.value > 0:
        return Extreme(math.inf, down.angle)
    found = greatest(motion, by_lift)
    return found if found.value > 0 else Extreme(0.0, math.nan)
