"""What a drawing is made of: strokes, circles and words in millimetres, each on a layer."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]

CONTINUOUS, CHAIN = "continuous", "chain"
PAPER = 250.0
"""Longer side of a drawing [mm] up to which lines have the widths of their layers; beyond, they grow with it."""
LEAST = 25.0
"""Longer side [mm] below which they shrink with it."""
CAPITAL = 0.72
"""Height of capital letters as a part of the size of the letters."""


@dataclass(frozen=True)
class Look:
    """How the lines of a layer are drawn: number of the colour in DXF, colour in SVG, width [mm], kind of line."""

    number: int
    colour: str
    width: float
    kind: str = CONTINUOUS


LAYERS = {
    "paths": Look(3, "#009E73", 0.25),
    "centrodes": Look(6, "#CC79A7", 0.35),
    "frame": Look(8, "#404040", 0.35),
    "pitch-circles": Look(5, "#0072B2", 0.25, CHAIN),
    "cams": Look(4, "#332288", 0.5),
    "links": Look(7, "#202020", 0.7),
    "hinges": Look(7, "#202020", 0.35),
    "drive": Look(1, "#D55E00", 0.35),
    "names": Look(7, "#202020", 0.25),
    "title": Look(7, "#202020", 0.25),
}
"""In the order in which they are drawn."""


@dataclass(frozen=True)
class Stroke:
    """A line through places (n, 2) [mm]; `level` says what covers what."""

    layer: str
    places: Array
    level: float = 0.0


@dataclass(frozen=True)
class Ring:
    """A circle [mm]; `filled`, a dot."""

    layer: str
    centre: tuple[float, float]
    radius: float
    level: float = 0.0
    filled: bool = False


@dataclass(frozen=True)
class Words:
    """A line of text, its middle at a place or, where `left`, its left end; height of capital letters [mm]."""

    layer: str
    text: str
    place: tuple[float, float]
    height: float
    left: bool = False

    def box(self) -> Array:
        """Two corners of the room that it takes [mm]."""
        width = self.height * sum(_width(letter) for letter in self.text)
        half = np.array([0.5 * width, 0.7 * self.height])
        middle = np.array(self.place) + (np.array([half[0], 0.5 * self.height]) if self.left else 0.0)
        return np.stack([middle - half, middle + half])


@dataclass(frozen=True)
class Cover:
    """A white body that hides strokes of lower levels: corners of a convex polygon [mm]."""

    corners: Array
    level: float


@dataclass
class Drawing:
    """A drawing: strokes, circles, words and what covers them."""

    strokes: list[Stroke] = field(default_factory=list)
    rings: list[Ring] = field(default_factory=list)
    words: list[Words] = field(default_factory=list)
    covers: list[Cover] = field(default_factory=list)

    def box(self) -> tuple[Array, Array]:
        """Corners of the drawing [mm]."""
        places = [stroke.places for stroke in self.strokes]
        for ring in self.rings:
            centre = np.array(ring.centre)
            places.append(np.stack([centre - ring.radius, centre + ring.radius]))
        places += [words.box() for words in self.words]
        if not places:
            return np.zeros(2), np.zeros(2)
        every = np.concatenate(places)
        every = every[np.isfinite(every).all(axis=1)]
        return every.min(axis=0), every.max(axis=0)


def _width(letter: str) -> float:
    """Room for a letter, in heights of capitals: rather too much than too little, whatever the font."""
    if unicodedata.east_asian_width(letter) in ("W", "F"):
        return 1.4
    if letter.isupper():
        return 1.2
    return 0.8 if letter.isascii() else 1.0
