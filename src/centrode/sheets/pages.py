"""Drawings to a true scale on pages: a mechanism in numbered positions.

A millimetre on paper stands for a round number of units; the renderer chooses it, and says it on the page.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from centrode.sheets.texts import Sentence, Text

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism


@dataclass(frozen=True)
class PositionsPage:
    """A mechanism in numbered positions over each other, with the paths of its points.

    Attributes
    ----------
    title : what it shows
    mechanism : kinds of its links, joints and drives
    positions, path : the motion at the positions, the first drawn in full; and the motion in between
    numbered : points beside whose places the numbers stand
    note : above the list of the positions
    """

    title: Sentence
    mechanism: Mechanism
    positions: xarray.Dataset
    path: xarray.Dataset
    numbered: tuple[str, ...]
    note: Text
