"""How well every constraint holds at every sample, redundant constraints and the unit length of rotors included."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.kinematics.evaluate import Kinematics
from centrode.kinematics.sampling import Samples, positions_from
from centrode.locale import _
from centrode.structure.constraints import is_drive

Array: TypeAlias = npt.NDArray[np.float64]


def residuals(kinematics: Kinematics, samples: Samples, parameter: Array) -> tuple[Array, str]:
    """Greatest residual at each sample (lanes, n), and the name of the constraint that is worst of all.

    Lengths are measured in the mechanism's greatest length, angles in rad; NaN where there is no position.
    """
    at = positions_from(kinematics, samples.layout, samples.columns[0])
    scale = kinematics.numbers.scale
    worst = np.zeros(samples.status.shape)
    worst_label, worst_value = "", -1.0
    with np.errstate(all="ignore"):
        for constraint in kinematics.structure.constraints:
            if is_drive(constraint):
                continue
            unit = 1.0 if constraint.angular else scale
            size = [np.abs(r) / unit for r in constraint.residual(ARRAYS, kinematics.numbers, at)]
            found = np.broadcast_to(np.maximum.reduce(size), worst.shape)
            worst = np.maximum(worst, found)
            greatest = float(np.nanmax(found, initial=0.0))
            if greatest > worst_value:
                worst_label, worst_value = constraint.label, greatest
        for link in samples.layout.links:
            rotor = at.poses[link].rotor
            found = np.abs(rotor[0] * rotor[0] + rotor[1] * rotor[1] - 1.0)
            worst = np.maximum(worst, found)
            if float(np.nanmax(found, initial=0.0)) > worst_value:
                worst_value = float(np.nanmax(found, initial=0.0))
                worst_label = _("length of link {link}").format(link=link)
    missing = ~np.isfinite(samples.columns[0]).all(axis=0)
    return np.where(missing, np.nan, worst), worst_label
