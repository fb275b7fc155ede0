"""What a follower asks of its cam: the force along its motion that accelerates it against spring and load.

A translating follower counts in m, kg, N and N/m, an oscillating one in rad, kg m^2, N m and N m/rad; the formulas are
the same. Angles of the cam are turned in its own sense, so that they grow with time.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Lifting(Protocol):
    """A follower's motion over a turn of its cam."""

    @property
    def edges(self) -> tuple[float, ...]:
        """Angles [rad] from 0 to 2 pi between which the motion is smooth."""

    def lift(self, phi: Array, order: int = 0) -> Array:
        """Lift and its derivatives by the cam's angle (order + 1, n); at an edge those of what begins."""


@dataclass(frozen=True)
class Burden:
    """What resists a follower's motion.

    Attributes
    ----------
    inertia : float [kg, or kg m^2]
    stiffness : float [N/m, or N m/rad]
        Of the spring that presses the follower on the cam.
    preload : float [N, or N m]
        Of the spring, at lift zero.
    load : float [N, or N m]
        Constant, positive where it presses on the cam: weight, work.
    """

    inertia: float = 0.0
    stiffness: float = 0.0
    preload: float = 0.0
    load: float = 0.0

    def at_rest(self, lift: Array) -> Array:
        """What presses on the cam while nothing accelerates."""
        return self.preload + self.load + self.stiffness * lift

    def needed(self, rows: Array, speed: float) -> Array:
        """What the cam has to give along the motion.

        Parameters
        ----------
        rows : (3 or more, n)
            Lift and its derivatives by the cam's angle.
        speed : float [rad/s]
            Of the cam.
        """
        return np.asarray(self.at_rest(rows[0]) + self.inertia * speed**2 * rows[2])
