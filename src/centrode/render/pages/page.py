"""A page of a document: A5 across, measured in millimetres, with drawings at true scale and names that stand free."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch
from matplotlib.text import Text
from numpy.typing import NDArray

from centrode.locale import _
from centrode.render.drawing.style import INK, LEAST_POINTS, MUTED, NAME, SMALL, TITLE, halo
from centrode.render.drawing.texts import plain
from centrode.render.figures.document_canvas import MeasuringCanvas
from centrode.render.figures.files import AS_WRITTEN

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism

Array = NDArray[np.float64]
WIDE, HIGH = 210.0, 148.0
INCH = 25.4
SIDES = 16
RINGS = (0.0, 1.0, 2.2, 3.6, 5.5, 8.0, 11.0, 15.0, 20.0, 26.0, 34.0, 44.0, 60.0)
"""How far beyond its nearest place a name may stand [mm]."""
LEADER = 2.0
"""Names that stand further off than this [mm] get a line to what they name."""
CROSSING = 5.0
"""What standing on a line costs, in millimetres further off."""
THICK = 0.4
"""Half the width of a link's line [mm]."""
GAP = 0.5
"""Room around a name [mm]."""
OVERHANG = 0.5
"""What of a letter may stand before the place where its text begins [mm]."""
BELOW = 4.0
"""Room below a column of lines [mm]."""


@dataclass(frozen=True)
class Wish:
    """A name that is to stand near a place [mm], clear of it by a distance."""

    place: Array
    text: str
    clear: float
    size: float
    colour: str


@dataclass
class Page:
    """A figure whose overlay is measured in millimetres from the lower left corner.

    Names are wished for while things are drawn, and placed at the end, when all lines are known.
    """

    figure: Figure
    overlay: Axes
    segments: list[tuple[Array, Array]] = field(default_factory=list)
    wishes: list[Wish] = field(default_factory=list)
    texts: list[Text] = field(default_factory=list)
    """Texts that are not measured yet: what stands beside a drawing is far from its names."""
    boxes: list[Array] = field(default_factory=list)
    size: tuple[float, float] = (WIDE, HIGH)
    signs: float = 1.0
    """How much larger signs are than on a page of a document."""

    def arrow(self, start: Array, end: Array, colour: str, dashes: Any, width: float) -> None:
        """Draw an arrow between two places [mm]; a short one has a small head."""
        head = min(7.0, 2.5 * float(np.hypot(*(end - start))) + 1.0)
        self.overlay.add_artist(
            FancyArrowPatch(
                (float(start[0]), float(start[1])),
                (float(end[0]), float(end[1])),
                arrowstyle="-|>",
                mutation_scale=head,
                shrinkA=0.0,
                shrinkB=0.0,
                color=colour,
                linewidth=width,
                linestyle=dashes,
                zorder=5,
            )
        )

    def name(
        self, place: Array, text: str, clear: float = 1.5, size: float = NAME, colour: str = INK
    ) -> None:
        """Wish for a name."""
        self.wishes.append(Wish(np.asarray(place, dtype=float), text, clear, size, colour))

    def avoid(self, segments: Iterable[tuple[Array, Array]]) -> None:
        """Lines [mm] that names should not cover."""
        self.segments += [(np.asarray(a, dtype=float), np.asarray(b, dtype=float)) for a, b in segments]

    def write(self, x: float, y: float, text: str, size: float = NAME, **how: Any) -> Text:
        """A text at a place that is given; names keep clear of it."""
        written = self.overlay.text(x, y, text, fontsize=size, color=how.pop("color", INK), **how)
        self.texts.append(written)
        return written

    def forget_texts(self) -> None:
        """Let names stand where they find room, whatever was written before."""
        self.boxes.clear()
        self.texts.clear()

    def write_lines(
        self,
        x: float,
        y: float,
        lines: Iterable[str],
        *,
        letters: int,
        step: float,
        size: float,
        indent: int,
        spelled: Callable[[str], str] = plain,
    ) -> None:
        """Lines below each other, wrapped to so many letters; what does not fit on the page is left out with dots."""
        wrapped = [
            part
            for line in lines
            for part in textwrap.wrap(line, letters_of(line, letters), subsequent_indent=indent * " ") or [""]
        ]
        room = int((y - BELOW) / step)
        if len(wrapped) > room:
            wrapped = [*wrapped[: room - 1], "…"]
        for text in wrapped:
            if text:
                self.write(x, y, spelled(text), size=size, va="top")
            y -= step

    def box_of(self, text: Text) -> Array:
        """Lower left and upper right corner of a text [mm]."""
        canvas: Any = self.figure.canvas
        extent = text.get_window_extent(canvas.get_renderer())
        return np.array([[extent.x0, extent.y0], [extent.x1, extent.y1]]) * INCH / self.figure.dpi

    def place_names(self, room: Array) -> None:
        """Put every wished name where it covers no other and as few lines as can be, inside a room [mm]."""
        self._measure_texts(float(room[1, 0]))
        for wish in self.wishes:
            text = self.overlay.text(
                0, 0, wish.text, fontsize=wish.size, color=wish.colour, ha="center", va="center", zorder=9,
                path_effects=halo(),
            )  # fmt: skip
            low, high = self.box_of(text)
            half = (high - low) / 2 + GAP
            place = self._best(wish, half, room)
            text.set_position((float(place[0]), float(place[1])))
            self.boxes.append(np.array([place - half, place + half]))
            foot = np.clip(wish.place, place - half, place + half)
            if np.hypot(*(foot - wish.place)) > wish.clear + LEADER:
                self.overlay.plot(*np.array([foot, wish.place]).T, color=MUTED, linewidth=0.4, zorder=7.5)
        self.wishes.clear()

    def _measure_texts(self, right: float) -> None:
        """Note where texts stand, except those that begin on the right of all names."""
        beside: list[Text] = []
        for text in self.texts:
            if text.get_horizontalalignment() == "left" and float(text.get_position()[0]) >= right + OVERHANG:
                beside.append(text)
            else:
                self.boxes.append(self.box_of(text))
        self.texts = beside

    def _best(self, wish: Wish, half: Array, room: Array) -> Array:
        """The centre of the cheapest place for a name."""
        turns = np.pi / 2 + 2 * np.pi * np.arange(SIDES) / SIDES
        around = np.stack([np.cos(turns), np.sin(turns)], axis=1)
        boxes = np.array(self.boxes).reshape(-1, 2, 2)
        lines = np.array(self.segments).reshape(-1, 2, 2)
        best, lowest = wish.place, np.inf
        for ring in RINGS:
            if lowest <= ring:
                break
            # so far off that the box stands clear of the place in this direction
            far = np.minimum.reduce(np.divide(half, np.maximum(np.abs(around), 1e-9)), axis=1)
            centres = wish.place + (wish.clear + ring + far)[:, None] * around
            for centre, dear in zip(centres, _costs(centres, half, room, boxes, lines), strict=True):
                cost = ring + float(dear)
                if cost < lowest - 1e-9:
                    best, lowest = centre, cost
        return best


def _costs(centres: Array, half: Array, room: Array, boxes: Array, lines: Array) -> Array:
    """What it costs to stand at places (n, 2): forbidden over another name or outside, dear over lines (k, 2, 2)."""
    low, high = centres - half, centres + half
    taken = (low[:, None] < boxes[:, 1]).all(axis=2) & (high[:, None] > boxes[:, 0]).all(axis=2)
    forbidden = np.any(low < room[0], axis=1) | np.any(high > room[1], axis=1) | np.any(taken, axis=1)
    costs = np.full(len(centres), 1e6)
    free = ~forbidden
    if np.any(free):
        costs[free] = CROSSING * count_crossings(low[free] - THICK, high[free] + THICK, lines)
    return costs


def count_crossings(low: Array, high: Array, segments: Array) -> NDArray[np.int_]:
    """How many segments (k, 2, 2) pass through each of some boxes, whose corners are (n, 2) (Liang and Barsky)."""
    start, along = segments[:, 0], segments[:, 1] - segments[:, 0]
    low, high = low[:, None], high[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (low - start) / along, (high - start) / along
    inside = (start >= low) & (start <= high)
    enter = np.where(along == 0, np.where(inside, -np.inf, np.inf), np.minimum(one, other)).max(axis=2)
    leave = np.where(along == 0, np.where(inside, np.inf, -np.inf), np.maximum(one, other)).min(axis=2)
    return np.asarray(np.sum((enter <= leave) & (enter <= 1.0) & (leave >= 0.0), axis=1))


def new_page(size: tuple[float, float] = (WIDE, HIGH)) -> Page:
    """An empty page of a size [mm]; made inside `house_style`."""
    wide, high = size
    figure = Figure(figsize=(wide / INCH, high / INCH), dpi=150)
    MeasuringCanvas(figure)
    overlay = figure.add_axes((0.0, 0.0, 1.0, 1.0), zorder=2)
    overlay.set_axis_off()
    overlay.set_xlim(0.0, wide)
    overlay.set_ylim(0.0, high)
    overlay.set_autoscale_on(False)
    overlay.patch.set_alpha(0.0)
    return Page(figure, overlay, size=size)


@dataclass(frozen=True)
class PageView:
    """A rectangle of a page that shows a plane at true scale.

    Attributes
    ----------
    corner, size : lower left corner and sides of the rectangle [mm]
    low : what stands at the corner, in the plane's own units
    scale : the plane's units to a millimetre
    """

    corner: Array
    size: Array
    low: Array
    scale: float

    @classmethod
    def about(cls, corner: Array, size: Array, places: Array, scale: float) -> PageView:
        """A view with a set of places in its middle."""
        middle = (places.min(axis=0) + places.max(axis=0)) / 2
        return cls(corner, size, middle - scale * size / 2, scale)

    def mm(self, place: Array) -> Array:
        """Where on the page a place of the plane is [mm]."""
        return np.asarray(self.corner + (np.asarray(place, dtype=float) - self.low) / self.scale)

    def axes(self, page: Page) -> Axes:
        """Axes in the plane's own units."""
        x, y = self.corner / page.size
        wide, high = self.size / page.size
        axes = page.figure.add_axes((float(x), float(y), float(wide), float(high)), zorder=1)
        axes.set_axis_off()
        axes.set_xlim(float(self.low[0]), float(self.low[0] + self.scale * self.size[0]))
        axes.set_ylim(float(self.low[1]), float(self.low[1] + self.scale * self.size[1]))
        axes.set_autoscale_on(False)
        return axes


# What pages with vectors have in common: where things stand, arrows, symbols, the head and the column.

CORNER, SIZE = np.array([6.0, 6.0]), np.array([128.0, 128.0])
COLUMN, TOP = 138.0, 140.0
BESIDE = COLUMN - SIZE[0]
"""What is on the left and on the right of the drawing, the column left out [mm]."""
NAMES = 8.0
"""Room of names about what is drawn on a screen [mm]."""
LINE = 3.8
"""From line to line of the column at the right [mm]."""
COLUMNS = 49
"""Letters in a line of it."""
CYRILLIC = re.compile(r"[\u0400-\u04ff]")
NARROWER = 0.9
"""Mean width of Latin letters over that of Cyrillic ones."""
MARKS = {"normal": "ⁿ", "tangential": "ᵗ", "coriolis": "ᵏ", "driven": "ʳ", "sliding": "ʳ"}
LETTERS = {"ⁿ": "n", "ᵗ": "t", "ᵏ": "k", "ʳ": "r"}
GREEK = {"ω": r"\omega", "ε": r"\varepsilon", "μ": r"\mu"}
TERM = re.compile(r"(?<!\w)([vapωεμP])([ⁿᵗᵏʳ]?)_([A-Za-zЀ-ӿ0-9′]+)")


def letters_of(line: str, latin: int) -> int:
    """How many letters of a line fit where so many Latin ones do."""
    return int(NARROWER * latin) if CYRILLIC.search(line) else latin


def flat(places: Sequence[complex]) -> Array:
    """Complex numbers as rows of x and y."""
    return np.array([[place.real, place.imag] for place in places])


def arrow(page: Page, start: Array, end: Array, colour: str, dashes: Any = "-", width: float = 1.0) -> None:
    """An arrow on the page [mm], with names kept off it; a short one has a small head."""
    page.arrow(start, end, colour, dashes, width)
    page.avoid([(start, end)])


def symbol(letter: str, name: str, kind: str = "relative") -> str:
    """v_BA, a^n_BA as text of a figure."""
    return typeset(f"{letter}{MARKS.get(kind, '')}_{name}")


def typeset(text: str) -> str:
    """The symbols of an equation as mathematical text; names with letters that this does not know stay as they are."""
    return TERM.sub(_typeset, plain(text))


def _typeset(found: re.Match[str]) -> str:
    letter, mark, name = found.groups()
    below = name if name.replace("′", "").isascii() else rf"\mathrm{{{name}}}"  # Cyrillic words stand upright
    below = below.replace("′", r"{}^{\prime}")
    above = f"^{{{LETTERS[mark]}}}" if mark else ""
    return rf"${GREEK.get(letter, letter)}{above}_{{{below}}}$"


def write_head(
    page: Page, title: str, mechanism: Mechanism, head: Sequence[str], lines: Sequence[str]
) -> None:
    """Title and mechanism above, at the right what the page is about and how it was drawn."""
    page.write(6.0, TOP, title, size=TITLE, va="bottom")
    name = textwrap.shorten(plain(_(mechanism.title)), 60, placeholder=" …")
    page.write(COLUMN, TOP, textwrap.fill(name, 40), size=SMALL, va="bottom", label=AS_WRITTEN)
    y = TOP - 6.0
    for text in head:
        page.write(COLUMN, y, text if "$" in text else typeset(text), size=NAME, va="top")
        y -= 1.4 * LINE
    y -= 0.5 * LINE
    page.write_lines(
        COLUMN, y, lines, letters=COLUMNS, step=LINE, size=LEAST_POINTS, indent=4, spelled=typeset
    )
