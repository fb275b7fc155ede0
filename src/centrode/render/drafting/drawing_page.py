"""A page of a drawing: letters in the heights of GOST 2.304, black lines of the two widths of GOST 2.303."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import Collection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon
from matplotlib.text import Text

from centrode.render.drafting.board import CAPITAL
from centrode.render.drafting.recorder import MAIN, POINT, THIN
from centrode.render.pages.page import INCH, Array, Page

A1 = 841.0, 594.0
"""Width and height of the sheet [mm]."""
BINDING, MARGIN = 20.0, 5.0
"""From the edge of the paper to the frame at the left, and on the other sides [mm]."""
SIGNS = 1.7
"""How much larger signs are than on a page of a document."""
HEADING, USUAL, SMALLEST = 5.0, 3.5, 2.5
"""Heights of capital letters [mm]."""
LETTER = 0.92
"""Width of a letter over the height of a capital, on an average with room to spare."""
ABOVE = 8.4
"""Names of figures larger than this [pt] are written in the heading's height, the others in the usual one."""
HEAD, HALF = 4.5, 0.8
"""Length and half width of an arrow's head [mm]."""
GROUND = {"facecolor": "white", "edgecolor": "none", "boxstyle": "square,pad=0.05"}
"""What lies below names."""
FAINT = 0.5
"""What is more transparent than this is a thin line, or no body at all."""


def points_of(height: float) -> float:
    """Size of letters [pt] whose capitals have a height [mm]."""
    return height / (CAPITAL * POINT)


@dataclass(frozen=True)
class SheetField:
    """A rectangle of a sheet [mm]."""

    corner: Array
    size: Array

    @classmethod
    def between(cls, left: float, bottom: float, right: float, top: float) -> SheetField:
        """The field between its sides."""
        return cls(np.array([left, bottom]), np.array([right - left, top - bottom]))

    @property
    def end(self) -> Array:
        """The upper right corner."""
        return np.asarray(self.corner + self.size)

    @property
    def box(self) -> Array:
        """Both corners."""
        return np.array([self.corner, self.end])

    def part(
        self, left: float = 0.0, bottom: float = 0.0, right: float = 0.0, top: float = 0.0
    ) -> SheetField:
        """The field without strips at its sides."""
        return SheetField(self.corner + np.array([left, bottom]), self.size - [left + right, bottom + top])

    def share(self, across: int, column: int, up: int = 1, row: int = 0) -> SheetField:
        """One of equal cells, counted from the left and from below."""
        cell = self.size / [across, up]
        return SheetField(self.corner + cell * [column, row], cell)


@dataclass
class DrawingPage(Page):
    """A page of a drawing: names in the heights of the standard, arrows whose lines end exactly at their ends."""

    def name(
        self, place: Array, text: str, clear: float = 1.5, size: float = 8.0, colour: str = "black"
    ) -> None:
        """Wish for a name; a wish that has a height of the standard keeps it."""
        height = HEADING if size > ABOVE else USUAL
        super().name(place, text, self.signs * clear, points_of(height), colour)

    def write_in(self, height: float, x: float, y: float, text: str, **how: Any) -> Text:
        """A text with capitals of a height [mm]."""
        return self.write(x, y, text, points_of(height), **how)

    def arrow(self, start: Array, end: Array, colour: str, dashes: Any, width: float) -> None:
        """A line from place to place with a head at its end, which is the end."""
        along = np.asarray(end - start, dtype=float)
        length = float(np.hypot(*along))
        if length == 0.0:
            return
        self.overlay.plot(
            *np.array([start, end]).T, color=colour, linewidth=width, linestyle=dashes, zorder=5
        )
        along = along / length
        head = min(HEAD, 0.5 * length)
        across = HALF * head / HEAD * np.array([-along[1], along[0]])
        corners = [end, end - head * along + across, end - head * along - across]
        self.overlay.add_artist(
            Polygon(np.array(corners), closed=True, facecolor=colour, edgecolor="none", zorder=5)
        )

    def line(self, places: Iterable[Any], width: float = MAIN, layer: str = "", **how: Any) -> None:
        """A line through places [mm]; its width is one of the two of the sheet."""
        (drawn,) = self.overlay.plot(
            *np.array(list(places), dtype=float).T,
            color="black",
            linewidth=width / POINT,
            solid_capstyle=how.pop("capstyle", "projecting" if layer else "round"),
            **how,
        )
        if layer:
            drawn.set_gid(layer)

    def fit(
        self,
        field: SheetField,
        text: str,
        heights: Iterable[float],
        layer: str,
        left: bool = False,
        **how: Any,
    ) -> None:
        """A text in a field, in the greatest of some heights at which it goes into it, wrapped where it must be."""
        height = self.largest_height(field, [text], heights)
        self._write_in_field(field, text, height, layer, left, **how)

    def largest_height(self, field: SheetField, texts: Iterable[str], heights: Iterable[float]) -> float:
        """The greatest of some heights at which each of some texts goes into a field; the last where none does."""
        *_others, height = heights = list(heights)
        for text in texts:
            for height in heights:
                drawn = self._write_in_field(field, text, height, "")
                box = self.box_of(drawn)
                drawn.remove()
                if (box[1] - box[0] <= field.size - 0.8).all():
                    break
            heights = heights[heights.index(height) :]
        return height

    def _write_in_field(
        self, field: SheetField, text: str, height: float, layer: str, left: bool = False, **how: Any
    ) -> Text:
        """A text in the middle of a field, or from its left side on."""
        shown = "\n".join(wrapped_lines(text, float(field.size[0]) - 1.6, height))
        x = field.corner[0] + (1.0 if left else field.size[0] / 2)
        y = field.corner[1] + field.size[1] / 2
        return self.overlay.text(
            float(x), float(y), shown, fontsize=points_of(height), color="black",
            ha="left" if left else "center", va="center", linespacing=1.1, gid=layer or None, zorder=9, **how,
        )  # fmt: skip


def letters_width(text: str, height: float) -> float:
    """Width of a line of letters [mm], and of a space behind it."""
    return (len(text) + 1) * LETTER * height


def wrapped_lines(text: str, room: float, height: float) -> list[str]:
    """Lines of a text for a width [mm]; what is one line stays one."""
    letters = max(4, int(room / (LETTER * height)))
    return [part for line in text.split("\n") for part in textwrap.wrap(line, letters) or [""]]


def new_drawing_page(size: tuple[float, float] = A1) -> DrawingPage:
    """An empty sheet of a size [mm]; made inside `house_style`."""
    wide, high = size
    figure = Figure(figsize=(wide / INCH, high / INCH), dpi=72)
    FigureCanvasAgg(figure)
    figure.patch.set_visible(False)
    overlay = figure.add_axes((0.0, 0.0, 1.0, 1.0), zorder=2)
    overlay.set_axis_off()
    overlay.set_xlim(0.0, wide)
    overlay.set_ylim(0.0, high)
    overlay.set_autoscale_on(False)
    overlay.patch.set_alpha(0.0)
    return DrawingPage(figure, overlay, size=size, signs=SIGNS)


# Everything on a sheet is black, and its lines have two widths.


def blacken(figure: Figure) -> None:
    """Give lines and bodies of a figure the looks of a drawing: black, of two widths, bodies white or black."""
    for artist in {id(one): one for one in figure.findobj()}.values():
        _blacken(artist)


def _blacken(artist: Artist) -> None:
    alpha = artist.get_alpha()
    faint = isinstance(alpha, int | float) and alpha < FAINT
    if isinstance(artist, Line2D):
        faint = faint or artist.get_linestyle() not in ("-", "None", "solid")
        artist.set_alpha(None)
        artist.set_color("black")
        artist.set_markerfacecolor("black")
        artist.set_markeredgecolor("black")
        artist.set_linewidth(_width(artist.get_linewidth(), faint))
        if artist.get_marker() not in ("o", "", None, "None"):
            artist.set_marker("")
    elif isinstance(artist, Text):
        artist.set_color("black")
        if artist.get_path_effects():  # a name, about which lines are cut
            artist.set_path_effects([])
            artist.set_bbox(GROUND)
    elif isinstance(artist, Patch):
        face, edge = to_rgba(artist.get_facecolor()), to_rgba(artist.get_edgecolor())
        artist.set_alpha(None)
        white = face[:3] == (1.0, 1.0, 1.0)
        shown = face[3] >= FAINT and artist.get_visible()
        artist.set_facecolor(("white" if white else "black") if shown else "none")
        artist.set_edgecolor("black" if edge[3] > 0.0 else "none")
        artist.set_linewidth(_width(artist.get_linewidth(), faint) if edge[3] > 0.0 else 0.0)
    elif isinstance(artist, Collection):
        artist.set_alpha(None)
        artist.set_edgecolor("black")
        artist.set_linewidth([_width(float(width), faint) for width in np.atleast_1d(artist.get_linewidth())])


MATHEMATICS = re.compile(r"\$[^$]*\$")
PRIMES = {r"{}^{\prime}": "′", r"^{\prime}": "′", "'''": "‴", "''": "″", "'": "′"}


def with_primes(text: str) -> str:
    """A text whose primes in formulas are letters of the font: those of mathematics come from one without names."""
    return MATHEMATICS.sub(lambda found: _primed_formula(found[0]), text)


def _primed_formula(formula: str) -> str:
    for written, prime in PRIMES.items():
        formula = formula.replace(written, prime)
    return formula


BOLD = 0.95
"""Lines of figures from this width [pt] on are main lines of a drawing."""


def _width(width: float, faint: bool) -> float:
    """Width of a line on a sheet [pt]: of a main or of a thin one."""
    return (THIN if faint or width < BOLD else MAIN) / POINT
