"""Where rolling wheels touch their tracks: the instant centre of each wheel against the body it rolls on."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.kinematics.evaluate import Kinematics
from centrode.kinematics.sampling import Samples
from centrode.structure.constraints import Contact, Positions, contact_point

Array: TypeAlias = npt.NDArray[np.float64]


def contacts_at(kinematics: Kinematics, at: Positions, samples: Samples) -> Array:
    """Contact points (lanes, n, rolling wheels, 2) [m] in description order; NaN where there is no position."""
    wheels = [c for c in kinematics.structure.constraints if isinstance(c, Contact)]
    found = np.empty((*samples.status.shape, len(wheels), 2))
    for k, contact in enumerate(wheels):
        for axis, x in enumerate(contact_point(contact, ARRAYS, kinematics.numbers, at)):
            found[..., k, axis] = x
    found[~np.isfinite(samples.columns[0]).all(axis=0)] = np.nan
    return found
