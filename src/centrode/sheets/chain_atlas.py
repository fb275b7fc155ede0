"""Sketches of kinematic chains and Assur groups side by side, each with what stands below it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.texts import Sentence, Text


@dataclass(frozen=True)
class AtlasCell:
    """A sketch.

    Attributes
    ----------
    name : stands below it
    places : (joints, 2) of the joints, a side being some 1 long
    outlines : of each link its joints in the order round it
    outer : joints towards what does not belong to the sketch, drawn filled
    """

    name: Text
    places: NDArray[np.float64]
    outlines: tuple[tuple[int, ...], ...]
    outer: tuple[int, ...] = ()


@dataclass(frozen=True)
class ChainAtlas:
    """Sketches in rows, all to one scale; the key says what signs mean that do not speak for themselves."""

    title: Sentence
    key: Text
    cells: tuple[AtlasCell, ...]
