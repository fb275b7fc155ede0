"""How a driving moment goes over a cycle: a formula of the drive's value and speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.text import TextFormula
from centrode.dynamics.steady_motion.quadrature import Array
from centrode.errors import InputError
from centrode.locale import _


@dataclass(frozen=True)
class Shape:
    """A driving moment up to a factor, by a formula of `q` [rad] and of the speed `v` [rad/s], which is positive."""

    formula: TextFormula

    def at(self, values: Array, speed: Array | float) -> Array:
        """Its values (n) at values and speeds of the drive; raises InputError where it has none."""
        # one speed as an array too: plain numbers would raise where arrays have infinities
        speeds = np.broadcast_to(np.asarray(speed, dtype=np.float64), values.shape)
        with np.errstate(all="ignore"):
            found = self.formula(ARRAYS, q=values, v=speeds)
        found = np.broadcast_to(np.asarray(found, dtype=np.float64), values.shape)
        if not np.isfinite(found).all():
            raise InputError(
                "[machine] driving",
                _("the driving moment has no finite value everywhere in the cycle"),
                _("correct the formula"),
            )
        return found
