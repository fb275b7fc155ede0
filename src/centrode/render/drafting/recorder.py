"""A figure as strokes, circles and words in millimetres: what a DXF file takes of a drawing that is a figure."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.backend_bases import GraphicsContextBase, RendererBase
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.ft2font import LoadFlags
from matplotlib.mathtext import MathTextParser
from matplotlib.path import Path
from matplotlib.transforms import Affine2D, Transform

from centrode.render.drafting.board import (
    CAPITAL,
    CHAIN,
    DASHED,
    BoardWords,
    Cover,
    Drawing,
    Look,
    Ring,
    Stroke,
    parts_within,
)

POINT = 25.4 / 72.0
"""Millimetres."""
MAIN, THIN = 0.7, 0.25
"""Widths of lines [mm]: s of the main line, s/3 of thin ones (GOST 2.303)."""
WIDE = 1.4
"""Lines of figures from this width [pt] on are main lines."""
LAYERS = {
    "thin": Look(7, "#000000", THIN),
    "dashed": Look(7, "#000000", THIN, DASHED),
    "chain": Look(7, "#000000", THIN, CHAIN),
    "main": Look(7, "#000000", MAIN),
    "names": Look(7, "#000000", THIN),
    "frame": Look(7, "#000000", MAIN),
    "title-block": Look(7, "#000000", THIN),
    "title-block-main": Look(7, "#000000", MAIN),
}
"""In the order in which they are drawn."""
UNHINTED = LoadFlags.NO_HINTING
SCRIPT = 0.01
"""Glyphs whose sizes or base lines differ by less than this share of a size stand in one word."""


class Recorder(RendererBase):
    """Draws a figure of 72 dots an inch as a drawing; artists with the name of a layer as their id go to that layer."""

    def __init__(self, wide: float, high: float) -> None:
        super().__init__()
        self.size = wide, high
        self.drawing = Drawing()
        self._layers: list[str] = []
        self._count = 0
        self._mathematics: Any = MathTextParser("path")

    def get_canvas_width_height(self) -> tuple[float, float]:
        """Width and height of the figure [pt]."""
        return self.size

    def flipy(self) -> bool:
        """No: the vertical axis points upwards."""
        return False

    def open_group(self, s: str, gid: str | None = None) -> None:
        """Begin an artist; its id may name a layer."""
        self._layers.append(gid if gid in LAYERS else self._layers[-1] if self._layers else "")

    def close_group(self, s: str) -> None:
        """End an artist."""
        self._layers.pop()

    def _layer(self, gc: GraphicsContextBase) -> str:
        if self._layers and self._layers[-1]:
            return self._layers[-1]
        _offset, dashes = gc.get_dashes()
        if dashes is not None:
            return "dashed" if np.size(dashes) <= 2 else "chain"
        return "main" if gc.get_linewidth() >= WIDE else "thin"

    def draw_path(
        self, gc: GraphicsContextBase, path: Path, transform: Transform, rgbFace: Any = None
    ) -> None:
        """A line, a circle or a body: white bodies hide what is below them, others are black."""
        self._count += 1
        level = float(self._count)
        edge = (
            gc.get_linewidth() > 0.0 and tuple(gc.get_rgb())[:3] != (1.0, 1.0, 1.0) and gc.get_alpha() != 0.0
        )
        white = rgbFace is not None and tuple(to_rgba(rgbFace)) == (1.0, 1.0, 1.0, 1.0)
        filled = rgbFace is not None and not white
        layer = self._layer(gc)
        circle = _circle(path, transform)
        if circle is not None:
            centre, radius = circle
            if edge or filled:
                self.drawing.rings.append(Ring(layer, centre, radius, level, filled))
            if white:
                turns = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
                around = np.array(centre) + radius * np.stack([np.cos(turns), np.sin(turns)], axis=1)
                self.drawing.covers.append(Cover(around, level))
            return
        clip = gc.get_clip_rectangle()
        for line in path.to_polygons(transform, closed_only=False):
            places = POINT * np.asarray(line, dtype=float)
            if len(places) < 2:
                continue
            if white:
                self.drawing.covers.append(Cover(places[:-1], level))
            if filled:
                self.drawing.strokes.append(Stroke(layer, places, level, filled=True))
            elif edge:
                parts = (
                    [places] if clip is None else parts_within(places, *POINT * np.asarray(clip.get_points()))
                )
                self.drawing.strokes += [Stroke(layer, part, level) for part in parts]

    def draw_text(
        self,
        gc: GraphicsContextBase,
        x: float,
        y: float,
        s: str,
        prop: FontProperties,
        angle: float,
        ismath: Any = False,
        mtext: Any = None,
    ) -> None:
        """Words from their left end; mathematics in pieces of one size and height."""
        layer = self._layers[-1] if self._layers and self._layers[-1] else "names"
        turn = Affine2D().rotate_deg(angle).translate(x, y).scale(POINT)
        size = prop.get_size_in_points()
        parsed = self._mathematics.parse(s, 72, prop) if ismath else None
        for text, letters, right, up in [(s, size, 0.0, 0.0)] if parsed is None else _pieces(parsed.glyphs):
            across, high = turn.transform((right, up)).tolist()
            self.drawing.words.append(
                BoardWords(layer, text, (across, high), CAPITAL * POINT * letters, True, angle)
            )
        for left, low, wide, high in () if parsed is None else parsed.rects:  # bars of fractions
            middle = low + high / 2
            ends = turn.transform([[left, middle], [left + wide, middle]])
            self._count += 1
            self.drawing.strokes.append(Stroke("thin", np.asarray(ends), float(self._count)))


def _pieces(glyphs: Any) -> list[tuple[str, float, float, float]]:
    """Text, size, and place of the pieces of mathematics [pt]: letters of one size on one line are one piece."""
    pieces: list[tuple[str, float, float, float]] = []
    end = 0.0
    for font, size, code, *_glyph, right, up in glyphs:
        letter = chr(code)
        font.set_size(size, 72)
        width = font.load_char(code, flags=UNHINTED).linearHoriAdvance / 65536.0
        if pieces:
            before, letters, place, line = pieces[-1]
            if abs(size - letters) < SCRIPT * size and abs(up - line) < SCRIPT * size and right - end < size:
                gap = " " if right - end > 0.15 * size else ""
                pieces[-1] = before + gap + letter, letters, place, line
                end = right + width
                continue
        pieces.append((letter, float(size), float(right), float(up)))
        end = right + width
    return pieces


def drawing_of_figure(figure: Figure) -> Drawing:
    """A figure as a drawing in millimetres from its lower left corner."""
    before = figure.dpi
    figure.dpi = 72.0
    try:
        wide, high = (72.0 * float(side) for side in figure.get_size_inches())
        recorder = Recorder(wide, high)
        figure.draw(recorder)
    finally:
        figure.dpi = before
    return recorder.drawing


def _circle(path: Path, transform: Transform) -> tuple[tuple[float, float], float] | None:
    """Centre and radius [mm] of a path that is the unit circle to a transform that keeps shapes."""
    circle = Path.unit_circle()
    vertices = np.asarray(path.vertices, dtype=float)
    if path.codes is None or len(vertices) != len(np.asarray(circle.vertices)):
        return None
    scale = float(vertices[:, 0].max())
    if scale <= 0.0 or not np.allclose(
        vertices, scale * np.asarray(circle.vertices), rtol=0.0, atol=1e-12 * scale
    ):
        return None
    middle, right, top = POINT * transform.transform([[0.0, 0.0], [scale, 0.0], [0.0, scale]])
    radius, other = float(np.hypot(*(right - middle))), float(np.hypot(*(top - middle)))
    if abs(radius - other) > 1e-6 * radius:
        return None
    return (float(middle[0]), float(middle[1])), radius
