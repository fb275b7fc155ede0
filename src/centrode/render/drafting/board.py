"""A drawing board that the conventional signs draw on as they draw on axes."""

from __future__ import annotations

import functools
import unicodedata
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba
from matplotlib.patches import Circle, FancyArrowPatch, Patch, Polygon
from numpy.typing import NDArray

# What a drawing is made of: strokes, circles and words in millimetres, each on a layer.

Array: TypeAlias = NDArray[np.float64]

CONTINUOUS, CHAIN, DASHED = "continuous", "chain", "dashed"
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
    """A line through places (n, 2) [mm]; `level` says what covers what; a `filled` one is a black body."""

    layer: str
    places: Array
    level: float = 0.0
    filled: bool = False


@dataclass(frozen=True)
class Ring:
    """A circle [mm]; `filled`, a dot."""

    layer: str
    centre: tuple[float, float]
    radius: float
    level: float = 0.0
    filled: bool = False


@dataclass(frozen=True)
class BoardWords:
    """A line of text, its middle at a place or, where `left`, its left end; height of capital letters [mm].

    `angle` is its direction [deg].
    """

    layer: str
    text: str
    place: tuple[float, float]
    height: float
    left: bool = False
    angle: float = 0.0

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

    @functools.cached_property
    def low(self) -> Array:
        """The least coordinates of its corners."""
        return np.asarray(self.corners.min(axis=0))

    @functools.cached_property
    def high(self) -> Array:
        """The greatest coordinates of its corners."""
        return np.asarray(self.corners.max(axis=0))


@dataclass
class Drawing:
    """A drawing: strokes, circles, words and what covers them."""

    strokes: list[Stroke] = field(default_factory=list)
    rings: list[Ring] = field(default_factory=list)
    words: list[BoardWords] = field(default_factory=list)
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


WHITE = to_rgba("white")
ROUND = 48
"""Corners of a circle that covers."""
HEAD = (7.0, 2.2)
"""Length and half width of an arrow's head, in points of the letters."""
OPEN, CLOSED = "hinges", "pitch-circles"
ROLLING = ("cams",)
"""Layers whose open circles are rollers, not hinges."""


class Board:
    """Takes what `signs` adds to axes, and keeps it as strokes on the layer chosen.

    Parameters
    ----------
    scale : float
        Millimetres in a unit of what is drawn.
    """

    def __init__(self, scale: float) -> None:
        self.scale = scale
        self.layer = "links"
        self.drawing = Drawing()

    @contextmanager
    def on(self, layer: str) -> Iterator[None]:
        """Draw on a layer."""
        before, self.layer = self.layer, layer
        try:
            yield
        finally:
            self.layer = before

    def add_artist(self, patch: Patch) -> None:
        """A circle, a polygon or an arrow."""
        level = float(patch.get_zorder())
        if isinstance(patch, Circle):
            self._circle(patch, level)
        elif isinstance(patch, FancyArrowPatch):
            self._arrow(patch, level)
        elif isinstance(patch, Polygon):
            corners = self.scale * np.asarray(patch.get_xy(), dtype=float)
            if _is_drawn(patch.get_edgecolor()):
                self.drawing.strokes.append(Stroke(self.layer, corners, level))
            if tuple(patch.get_facecolor()) == WHITE:
                self.drawing.covers.append(Cover(corners[:-1], level))

    def _circle(self, patch: Circle, level: float) -> None:
        x, y = self.scale * np.asarray(patch.center, dtype=float)
        radius = self.scale * patch.radius
        white = tuple(patch.get_facecolor()) == WHITE
        open_hinge = white and self.layer not in ROLLING
        layer = OPEN if open_hinge else CLOSED if patch.get_linestyle() not in ("-", "solid") else self.layer
        filled = not (white or _is_faint(patch.get_facecolor()))
        if filled or _is_drawn(patch.get_edgecolor()):
            self.drawing.rings.append(Ring(layer, (float(x), float(y)), float(radius), level, filled))
        if white:
            turns = np.linspace(0.0, 2.0 * np.pi, ROUND, endpoint=False)
            corners = np.array([x, y]) + radius * np.stack([np.cos(turns), np.sin(turns)], axis=1)
            self.drawing.covers.append(Cover(corners, level))

    def _arrow(self, patch: FancyArrowPatch, level: float) -> None:
        """A line with a head at its end."""
        outline: Any = patch
        places = self.scale * np.array(outline._path_original.vertices, dtype=np.float64)
        along = places[-1] - places[-2]
        along /= float(np.hypot(*along))
        across = np.array([-along[1], along[0]])
        length, half = (self.letters * points for points in HEAD)
        back, tip = places[-1] - 0.5 * length * along, places[-1] + 0.5 * length * along
        head = [tip, back + half * across, back - half * across, tip]
        self.drawing.strokes += [Stroke(self.layer, places, level), Stroke(self.layer, np.array(head), level)]

    def add_collection(self, collection: LineCollection, autolim: bool = True) -> None:
        """Lines."""
        level = float(collection.get_zorder())
        for segment in collection.get_segments():
            self.drawing.strokes.append(
                Stroke(self.layer, self.scale * np.asarray(segment, dtype=float), level)
            )

    def plot(self, x: Sequence[float], y: Sequence[float], **how: Any) -> None:
        """A line through places; no markers, which tell colours apart that a drawing for machines does not have."""
        if "marker" in how:
            return
        places = self.scale * np.stack([np.asarray(x, dtype=float), np.asarray(y, dtype=float)], axis=1)
        self.drawing.strokes.append(Stroke(self.layer, places, float(how.get("zorder", 2.0))))

    def text(self, x: float, y: float, text: str, *, fontsize: float, **how: Any) -> None:
        """Words; the size of the letters is in points on paper, drawings want the height of their capitals."""
        height = CAPITAL * fontsize * self.letters
        self.drawing.words.append(BoardWords(self.layer, text, (self.scale * x, self.scale * y), height))

    letters: float = 1.0
    """Millimetres in a point of the letters' size."""

    def set_aspect(self, *_ratio: object, **_how: object) -> None:
        """Nothing: a drawing has equal scales."""

    def set_xlim(self, *_limits: object) -> None:
        """Nothing: a drawing is as large as what is on it."""

    def set_ylim(self, *_limits: object) -> None:
        """Nothing: a drawing is as large as what is on it."""


def _is_drawn(colour: Any) -> bool:
    return len(colour) == 4 and colour[3] > 0.0


def _is_faint(colour: Any) -> bool:
    """A filling that only tints."""
    return len(colour) != 4 or colour[3] < 0.5


def on_paper(scene_extent: float, inches: float, scale: float) -> float:
    """Millimetres in a point of a letter's size, where the drawing was meant for so many inches of paper."""
    return scene_extent / (72.0 * inches) * scale


# What white bodies hide: strokes below a hinge's circle or a slider end at its edge, as a draughtsman's do.

CORNERS = 96
"""Of a circle that is partly hidden."""
TOUCH = 1e-9
"""Parts of a stroke shorter than this share of it are left out."""
BORDER = 1e-9
"""What lies no farther outside a border than this lies on it [mm]."""


def visible(drawing: Drawing) -> tuple[list[Stroke], list[Ring]]:
    """Strokes and circles without what is covered; circles that are covered in part become strokes."""
    strokes: list[Stroke] = []
    rings: list[Ring] = []
    for ring in drawing.rings:
        covers = [cover for cover in drawing.covers if cover.level > ring.level]
        turns = np.linspace(0.0, 2.0 * np.pi, CORNERS + 1)
        around = np.array(ring.centre) + ring.radius * np.stack([np.cos(turns), np.sin(turns)], axis=1)
        parts = _visible_parts(around, covers)
        if len(parts) == 1 and len(parts[0]) == len(around):
            rings.append(ring)
        else:
            strokes += [Stroke(ring.layer, part, ring.level) for part in parts]
    for stroke in drawing.strokes:
        covers = [cover for cover in drawing.covers if cover.level > stroke.level]
        if stroke.filled:
            strokes.append(stroke)
            continue
        strokes += [
            Stroke(stroke.layer, part, stroke.level) for part in _visible_parts(stroke.places, covers)
        ]
    return strokes, rings


def _visible_parts(places: Array, covers: list[Cover]) -> list[Array]:
    """The parts of a line through places that no cover hides."""
    parts: list[list[Array]] = []
    open_end = False
    for start, end in pairwise(places):
        if not (np.isfinite(start).all() and np.isfinite(end).all()):
            open_end = False
            continue
        free = _free(start, end, _near(np.array([start, end]), covers))
        for first, last in free:
            begin, finish = start + first * (end - start), start + last * (end - start)
            if open_end and first == 0.0:
                parts[-1].append(finish)
            else:
                parts.append([begin, finish])
            open_end = last == 1.0
        open_end = open_end and bool(free)
    return [np.array(part) for part in parts]


def parts_within(places: Array, low: Array, high: Array) -> list[Array]:
    """The parts of a line through places that lie in a box between its corners, border included."""
    low, high = low - BORDER, high + BORDER
    corners = np.array([low, [high[0], low[1]], high, [low[0], high[1]]])
    parts: list[list[Array]] = []
    open_end = False
    for start, end in pairwise(places):
        within = _inside(start, end, corners) if np.isfinite([start, end]).all() else None
        if within is None:
            open_end = False
            continue
        begin, finish = (start + share * (end - start) for share in within)
        if open_end and within[0] == 0.0:
            parts[-1].append(finish)
        else:
            parts.append([begin, finish])
        open_end = within[1] == 1.0
    return [np.array(part) for part in parts]


def _near(places: Array, covers: list[Cover]) -> list[Cover]:
    """The covers whose box meets that of places."""
    if not covers:
        return covers
    low, high = places.min(axis=0), places.max(axis=0)
    return [cover for cover in covers if (cover.low <= high).all() and (cover.high >= low).all()]


def _free(start: Array, end: Array, covers: list[Cover]) -> list[tuple[float, float]]:
    """Stretches of a segment, as shares of it, that lie under no cover."""
    free = [(0.0, 1.0)]
    for cover in covers:
        hidden = _inside(start, end, cover.corners)
        if hidden is None:
            continue
        low, high = hidden
        free = [
            piece
            for first, last in free
            for piece in ((first, min(last, low)), (max(first, high), last))
            if piece[1] - piece[0] > TOUCH
        ]
    return free


def _inside(start: Array, end: Array, corners: Array) -> tuple[float, float] | None:
    """The stretch of a segment inside a convex polygon, as shares of it (Cyrus and Beck)."""
    low, high, way = 0.0, 1.0, end - start
    sense = np.sign(_area(corners))
    for corner, after in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        side = after - corner
        normal = sense * np.array([-side[1], side[0]])
        height, slope = float(normal @ (start - corner)), float(normal @ way)
        if slope == 0.0:
            if height <= 0.0:
                return None
            continue
        share = -height / slope
        low, high = (max(low, share), high) if slope > 0.0 else (low, min(high, share))
        if high - low <= TOUCH:
            return None
    return low, high


def _area(corners: Array) -> float:
    x, y = corners.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
