"""What an animation is made of: layers, each of which draws one thing, and the view that all of them share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from numpy.typing import NDArray

from centrode.present.sheet import SIGN_INCHES

Array = NDArray[np.float64]
NOTHING: Array = np.empty((0, 2))
WHOLE: Array = np.array([[-1.0, -1.0], [1.0, 1.0]])
"""Corners of the whole sphere."""


@dataclass(frozen=True)
class View:
    """What the pictures show, in drawing units; the same over the whole animation.

    Attributes
    ----------
    low, high : (2)
        Corners of what the layers need.
    per_inch : float
        Drawing units to an inch of paper.
    """

    low: Array
    high: Array
    per_inch: float

    @property
    def inches(self) -> float:
        """Length on paper of the longer side of what the layers need."""
        return float(np.max(self.high - self.low)) / self.per_inch

    @property
    def sign(self) -> float:
        """Radius of a hinge's circle; the other signs are measured by it."""
        return SIGN_INCHES * self.per_inch


@dataclass(frozen=True)
class ScaleArrow:
    """An arrow below the pictures that tells what the vectors of a layer are worth.

    Attributes
    ----------
    length : float
        In drawing units.
    text : str
        What is shown, and what an arrow of this length is worth.
    colour : Any
    """

    length: float
    text: str
    colour: Any


class Layer:
    """One thing that an animation shows; a layer overrides what it needs.

    The stage asks every layer for its `reach`, tells all of them the view, has their `ground` drawn once, and then
    `draw` for each frame: whatever that puts on the axes is taken away again before the next frame.
    """

    def reach(self) -> Array:
        """Places (n, 2) that the view has to hold, over all frames."""
        return NOTHING

    def stand(self, view: View) -> None:
        """Take the view that was chosen, before anything is drawn."""

    def ground(self, axes: Axes) -> None:
        """Draw what does not move, below everything that does."""

    def draw(self, axes: Axes, frame: int) -> None:
        """Draw what moves, as it is in a frame."""

    def entries(self) -> Sequence[tuple[Artist, str]]:
        """Entries of the legend."""
        return ()

    def scales(self) -> Sequence[ScaleArrow]:
        """What the lengths of its vectors are worth."""
        return ()

    def notes(self) -> Sequence[str]:
        """Sentences about what could not be shown."""
        return ()
