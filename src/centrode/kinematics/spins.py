"""How links turn in space: angular velocities and accelerations as vectors in the frame's axes."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.layout import Layout

Array: TypeAlias = npt.NDArray[np.float64]


def attitudes_of(layout: Layout, columns: Array) -> Array | None:
    """Axes of the links in those of the frame and their derivatives, (3, lanes, n, links, 3, 3); none in the plane.

    The axis of a link stands before its components.
    """
    if layout.runs_on:
        return None
    taken = columns[:, layout.first_attitude : layout.first_slide]
    axes = taken.reshape(len(columns), len(layout.links), 3, 3, *columns.shape[2:])
    return np.moveaxis(axes, (4, 5), (1, 2))


def spins_of(layout: Layout, columns: Array) -> Array | None:
    """Angular velocity and acceleration per unit of the parameter, (2, lanes, n, links, 3); none in the plane.

    Of a rotation with axes a_k these are half the sums of a_k x a_k' and of a_k x a_k''.
    """
    if layout.runs_on:
        return None
    lanes, samples = columns.shape[2:]
    spins = np.empty((2, lanes, samples, len(layout.links), 3), columns.dtype)
    for k in range(len(layout.links)):
        first = layout.first_attitude + 9 * k
        axes = columns[:, first : first + 9].reshape(3, 3, 3, lanes, samples)
        for order in (1, 2):
            spins[order - 1, :, :, k] = 0.5 * np.cross(axes[0], axes[order], axis=1).sum(axis=0).transpose(
                1, 2, 0
            )
    return spins
