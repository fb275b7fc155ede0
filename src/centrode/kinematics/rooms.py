"""Everything of some motions that depends on the samples, in one room, so that what is big is written once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.errors import Status
from centrode.kinematics.layout import Layout
from centrode.kinematics.sampling import ORDERS, Samples
from centrode.kinematics.spins import attitudes_of, spins_of
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Room:
    """Arrays of so many motions at so many samples, not yet filled; statuses are ok.

    Attributes
    ----------
    columns : (3, columns of the frame and of the layout, lanes, n)
    angles : (3, angles, lanes, n)
    """

    layout: Layout
    frame: int
    columns: Array
    angles: Array
    status: npt.NDArray[np.int8]

    @classmethod
    def of(cls, layout: Layout, numbers: Dimensions, lanes: int, samples: int) -> Room:
        """The room for mechanisms with as many points of the frame as these dimensions have."""
        frame = layout.axes * len(numbers.frame)
        return cls(
            layout,
            frame,
            np.empty((ORDERS, frame + layout.width, lanes, samples)),
            np.empty((ORDERS, len(layout.angles), lanes, samples)),
            np.zeros((lanes, samples), dtype=np.int8),
        )

    @cached_property
    def samples(self) -> Samples:
        """The room without the frame's part."""
        return Samples(self.layout, self.columns[:, self.frame :], self.angles, self.status)

    def fill_frame(self, numbers: Dimensions) -> None:
        """Points of the frame: their places are constant, absent where the motion is."""
        columns = self.columns[:, : self.frame]
        columns[1:] = 0.0
        fixed = Positions.of_frame(numbers, {}, ARRAYS).points
        for k, place in enumerate(x for at in fixed.values() for x in at):
            columns[0, k] = place
        opened = self.status == Status.OPEN
        if opened.any():
            columns[:, :, opened] = np.nan

    @property
    def all_points(self) -> Array:
        """Points (3, lanes, n, points, axes), the frame's first."""
        points = self.columns[:, : self.frame + self.layout.first_attitude]
        return np.moveaxis(points.reshape(ORDERS, -1, self.layout.axes, *self.status.shape), (1, 2), (3, 4))

    @property
    def turned(self) -> Array:
        """Angles (3, lanes, n, angles)."""
        return np.moveaxis(self.angles, 1, 3)

    @property
    def slides(self) -> Array:
        """Displacements (3, lanes, n, guides)."""
        layout = self.layout
        return np.moveaxis(self.samples.columns[:, layout.first_slide : layout.first_rotor], 1, 3)

    @property
    def spins(self) -> Array | None:
        """How links turn in space (2, lanes, n, links, 3); none in the plane."""
        return spins_of(self.layout, self.samples.columns)

    @property
    def attitudes(self) -> Array | None:
        """Axes of the links (3, lanes, n, links, 3, 3); none in the plane."""
        return attitudes_of(self.layout, self.samples.columns)
