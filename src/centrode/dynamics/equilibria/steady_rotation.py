"""Steady motions of one drive: all coordinates run at constant speeds, as those of a governor or a rotor with arms.

Where the mechanism looks the same from the drive at all times, its coordinates can have constant speeds v in a position
q: then g(q) = 0, dg/dt = 0, d2g/dt2 = 0 and F(q, v) = G' lambda hold with no acceleration. Small motions about it have
constant coefficients (relative equilibrium: J. E. Marsden and T. S. Ratiu, Introduction to Mechanics and Symmetry,
2nd ed., 1999, section 4.4).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares

from centrode.dynamics.equilibria.equilibrium_search import walked_positions
from centrode.dynamics.equilibria.linear_equations import LoadedMechanism
from centrode.dynamics.equilibria.small_motions import UNSTABLE, SmallMotions, small_motions
from centrode.errors import MotionError
from centrode.locale import _
from centrode.model.motion_parameter import constant_speed_of

Array: TypeAlias = npt.NDArray[np.float64]

STEADY = 1e-9
"""Shares of the forces and of squares of speeds that may be left in a steady motion."""
LATER = 0.37
"""Turn of the drive [rad, or way in lengths] after which coefficients have to be the same."""
STARTS = 12
MOST_TRIALS = 300


def steady_rotation(loaded: LoadedMechanism) -> SmallMotions:
    """Small motions about the steady motion of a drive that keeps its speed, of those that are found a stable one.

    Raises MotionError where none is found, or where it does not look the same at all times.
    """
    found = []
    for place, speeds in _steady_states(loaded):
        (motions,) = small_motions(loaded, place[None], speeds[None])
        if _stays(loaded, motions):
            found.append(motions)
            if motions.stability != UNSTABLE:
                return motions
    if found:
        return found[0]
    what = _("no motion is found in which all coordinates have constant speeds")
    raise MotionError(
        "",
        what,
        _("hold the drive (hold: DRIVE=VALUE) for the modes at rest, or simulate it and look at its regime"),
    )


def _steady_states(loaded: LoadedMechanism) -> Iterator[tuple[Array, Array]]:
    """States of constant speeds from many positions: everything turns with the drive, or as little as can."""
    angles = loaded.angles
    constant = (constant_speed_of(one.driven.law) for one in loaded.equations.kept)
    speed = next(found for found in constant if found is not None)
    begin = loaded.at(loaded.start[None])
    inertia = np.max(np.abs(begin.mass[0] * np.outer(loaded.units, loaded.units)), initial=0.0)
    heavy = float(inertia) * speed**2 + float(np.max(np.abs(begin.force * loaded.units), initial=0.0))
    units = loaded.equation_units

    def together(_place: Array) -> Array:
        return np.where(angles, speed, 0.0)

    def least(place: Array) -> Array:
        return _least_speeds(loaded, place)

    for speeds in (together, least):

        def left(x: Array, speeds: Callable[[Array], Array] = speeds) -> Array:
            place = x * loaded.units
            found = loaded.at(place[None], speeds=speeds(place)[None])
            return np.concatenate(
                [
                    found.residual[0] * loaded.units / heavy, found.closures[0] / units,
                    found.drift[0] / units / speed, found.bias[0] / units / speed**2,
                ]
            )  # fmt: skip

        for place in walked_positions(loaded)[::97][:STARTS]:
            solved = least_squares(
                left,
                place / loaded.units,
                method="lm",
                max_nfev=MOST_TRIALS,
                xtol=1e-15,
                ftol=1e-15,
                gtol=1e-15,
            )
            if np.max(np.abs(solved.fun)) <= STEADY:
                yield solved.x * loaded.units, speeds(solved.x * loaded.units)


def _least_speeds(loaded: LoadedMechanism, place: Array) -> Array:
    """The least speeds that keep the closures and the drive."""
    found = loaded.at(place[None])
    return np.asarray(-np.linalg.pinv(found.rows[0]) @ found.drift[0])


def _stays(loaded: LoadedMechanism, motions: SmallMotions) -> bool:
    """Whether the coefficients are the same later."""
    fast = float(np.max(np.abs(motions.speeds) / loaded.units, initial=1e-300))
    later = motions.place + motions.speeds * (LATER / fast)
    (other,) = small_motions(loaded, later[None], motions.speeds[None])
    here, there = motions.eigenvalues, other.eigenvalues
    if len(here) != len(there):
        return False
    scale = float(np.max(np.abs(here), initial=1e-300))
    # each has its partner there
    apart = np.min(np.abs(here[:, None] - there[None, :]), axis=1)
    return bool(np.all(apart <= 1e-6 * scale))
