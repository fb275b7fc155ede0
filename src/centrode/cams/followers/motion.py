"""The motion of a follower over the angle of its cam: lift and derivatives of any order, and what joints do to them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.errors import InputError
from centrode.laws import SegmentedLaw
from centrode.locale import _
from centrode.model.cams.files import AnyCam, with_follower

Array = npt.NDArray[np.float64]
JETS = JetFunctions(ARRAYS)
MOST_ORDER = 20


@dataclass(frozen=True)
class FollowerMotion:
    """Lift of a follower, periodic in the angle of its cam.

    Attributes
    ----------
    law : SegmentedLaw
        Lift over the angle of the cam; one turn is its period.
    swings : bool
        Whether the lift is an angle [rad], that of an oscillating follower, else a displacement [m].
    speed : float [rad/s] or None
        Of the cam.
    """

    law: SegmentedLaw
    swings: bool = False
    speed: float | None = None

    def lift(self, phi: npt.ArrayLike, order: int = 0) -> Array:
        """Lift and its derivatives by the angle of the cam.

        Parameters
        ----------
        phi : (...) angles [rad], of any turn
        order : highest derivative, 0 to 20

        Returns
        -------
        (order + 1, ...) [m/rad^k or rad/rad^k]
            Exact derivatives of the formulas. At a joint those of the segment that begins there.

        Raises
        ------
        InputError
            An order out of bounds.
        """
        if order not in range(MOST_ORDER + 1):
            raise InputError("order", _("ask for derivatives of order 0 to {most}").format(most=MOST_ORDER))
        places = np.asarray(phi, dtype=np.float64)
        jet = self.law.jet(JETS, Jet.variable(places, order))
        return np.stack([np.broadcast_to(jet.derivative(k), places.shape) for k in range(order + 1)])

    @property
    def period(self) -> float:
        """A turn [rad]."""
        return self.law.period

    @cached_property
    def joints(self) -> tuple[float, ...]:
        """Where segments begin, and the end of the turn: len + 1 angles [rad] from 0."""
        return (0.0, *self.law.ends)

    @cached_property
    def edges(self) -> tuple[float, ...]:
        """Angles [rad] from 0 to the end of the turn between which the lift is one analytic formula."""
        return self.law.whole.breaks

    @property
    def unit(self) -> str:
        """SI unit of the lift."""
        return "rad" if self.swings else "m"


def follower_motion(cam: AnyCam) -> FollowerMotion:
    """The motion of the follower of a cam's description.

    Parameters
    ----------
    cam : PlateCam

    Raises
    ------
    InputError
        A cam that is given by a curvature law.
    """
    plate = with_follower(cam)
    return FollowerMotion(plate.lift_law, plate.swings, plate.body.speed)
