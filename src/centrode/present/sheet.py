"""What every drawing of a motion knows: its points, its corners and its size on paper."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism

Array = NDArray[np.float64]
SIGN_INCHES = 0.07  # radius of a hinge's circle on paper


@dataclass(frozen=True, kw_only=True)
class MotionPlaces:
    """Places over a motion, ready to draw.

    Attributes
    ----------
    mechanism : Mechanism
        The description.
    tracks : mapping of point -> (sample, axis)
        NaN where a point has no position.
    low, high : (2)
        Corners of the drawing.
    inches : float
        Length on paper of its longer side.
    """

    mechanism: Mechanism
    tracks: Mapping[str, Array]
    low: Array
    high: Array
    inches: float = 6.0

    @property
    def extent(self) -> float:
        """The longer side of the drawing."""
        return float(np.max(self.high - self.low))

    @property
    def sign(self) -> float:
        """Radius of a hinge's circle; the other signs are measured by it."""
        return SIGN_INCHES / self.inches * self.extent

    def at(self, sample: int) -> dict[str, Array]:
        """Places at a sample, of the points that have one."""
        places = {name: track[sample] for name, track in self.tracks.items()}
        return {name: place for name, place in places.items() if np.isfinite(place).all()}


@dataclass(frozen=True)
class View:
    """The part of the plane that pictures show, in drawing units; the same over a whole animation.

    Attributes
    ----------
    low, high : (2)
        Corners of what is shown.
    per_inch : float
        Drawing units to an inch of paper.
    """

    low: Array
    high: Array
    per_inch: float

    @property
    def inches(self) -> float:
        """Length on paper of the longer side of what is shown."""
        return float(np.max(self.high - self.low)) / self.per_inch

    @property
    def sign(self) -> float:
        """Radius of a hinge's circle; the other signs are measured by it."""
        return SIGN_INCHES * self.per_inch
