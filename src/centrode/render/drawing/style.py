"""The style sheet of all figures: sizes on paper, sizes of texts, widths of lines, colours that all can tell apart.

A figure is drawn at the size that it has on paper, so that a size in points is that size in print.
"""

from __future__ import annotations

import functools
import logging
import re
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import matplotlib
from matplotlib.artist import Artist
from matplotlib.collections import Collection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import AbstractPathEffect, withStroke
from matplotlib.text import Text
from matplotlib.ticker import ScalarFormatter

from centrode.render.drawing.colours import GROUND as GROUND
from centrode.render.drawing.colours import INK as INK
from centrode.render.drawing.colours import MARKERS as MARKERS
from centrode.render.drawing.colours import MUTED as MUTED
from centrode.render.drawing.colours import PALETTE as PALETTE
from centrode.render.drawing.looks import RGB, dark_area, dark_line

APPROXIMATE: Any = (0, (5, 1.2))
CUT: Any = (0, (3, 2))
JUMP: Any = (0, (2, 1.5))
CENTRE_LINE: Any = (0, (6, 2, 1.5, 2))
DOTS: Any = (0, (1, 1.5))
HIDDEN: Any = (0, (4, 3))
"""Dashes, each of one meaning: what another curve is compared with, what is cut off, a jump, limits and axes, change
points, what lies behind."""
MATHTEXT = logging.getLogger("matplotlib.mathtext")
BACKEND = ("backend", "backend_fallback")
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

# Sizes [inch] and [pt] on paper, and widths of lines [pt].

LEAST_POINTS = 7.0
"""No text is smaller."""
TITLE, LABEL, NAME, SMALL = 10.0, 8.5, 8.0, 7.2
"""Titles; labels of axes; names beside places, ticks and legends; notes, and numbers along a curve."""
LETTER = 0.0083
"""Width of a letter, on an average [inch], over the size of the text in points."""
CURVE, THIN, HAIR, LINK = 1.5, 0.9, 0.6, 2.4
"""Curves; marks across a panel and what is compared; lines of zero and construction lines; links."""

SETTINGS: dict[str, Any] = {
    "axes.edgecolor": "#606060",
    "axes.formatter.limits": (-3, 4),
    "axes.formatter.useoffset": False,
    "axes.grid": True,
    "axes.linewidth": 0.7,
    "axes.labelsize": LABEL,
    "axes.titlesize": LABEL + 0.5,
    "figure.dpi": 150,
    "font.family": ["DejaVu Sans"],
    "font.size": LABEL,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6,
    "legend.fontsize": NAME,
    "legend.frameon": False,
    "lines.linewidth": CURVE,
    "mathtext.fontset": "dejavusans",
    "svg.fonttype": "path",
    "svg.hashsalt": "centrode",
    "xtick.labelsize": NAME,
    "ytick.labelsize": NAME,
}


@dataclass(frozen=True)
class Pen:
    """Colour and marker of one link, point or guide, the same in every figure; dashes of what is approximate."""

    colour: str
    dashes: Any = "-"
    marker: str = ""


def halo(ground: Any = "white") -> list[AbstractPathEffect]:
    """An edge of the ground's colour about the letters of a name, so that it can be read over a line."""
    return [withStroke(linewidth=2.0, foreground=ground)]


@functools.cache
def _checked_settings() -> dict[str, Any]:
    """All settings of figures, checked by matplotlib once: a report is in this context some 150 times."""
    settings: Any = matplotlib.rcParamsDefault | SETTINGS
    # Even to ask for the backend would load pyplot and choose one.
    with matplotlib.rc_context({name: value for name, value in settings.items() if name not in BACKEND}):
        return {name: dict.__getitem__(matplotlib.rcParams, name) for name in settings if name not in BACKEND}


@contextmanager
def house_style() -> Iterator[None]:
    """Context in which figures are made: matplotlib's defaults and ours, whatever the user has set.

    A letter that the font lacks (a title may be in any language) becomes a box, without a warning.
    """
    with matplotlib.rc_context(), warnings.catch_warnings():
        settings: Any = matplotlib.rcParams
        dict.update(settings, _checked_settings())
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")
        MATHTEXT.addFilter(_is_no_missing_letter)
        try:
            yield
        finally:
            MATHTEXT.removeFilter(_is_no_missing_letter)


def _is_no_missing_letter(record: logging.LogRecord) -> bool:
    """False of what the mathematics of figures says of letters that its font lacks."""
    return "does not have a glyph" not in str(record.msg) and "substituting with" not in str(record.msg)


def pens(names: Iterable[str]) -> Mapping[str, Pen]:
    """A pen for each name: colours in turn, then the same colours with markers."""
    return {name: numbered_pen(number) for number, name in enumerate(names)}


def numbered_pen(number: int, colours: Sequence[str] = PALETTE) -> Pen:
    """The pen of a thing by its place among its kind."""
    marker = MARKERS[number // len(colours) % len(MARKERS)]
    return Pen(colours[number % len(colours)], marker=marker)


def marker_options(pen: Pen, at: Any = 0.12) -> dict[str, Any]:
    """The marker of a pen for a line of matplotlib: along a curve, or in the places `at` of it; nothing without one."""
    if not pen.marker:
        return {}
    return {"marker": pen.marker, "markersize": 4.0, "markevery": at, "markeredgewidth": 0.6}


class Decimals(ScalarFormatter):
    """Numbers of ticks as plain text, which is laid out many times faster than mathematical text."""

    def get_offset(self) -> str:
        """The common factor of the ticks: "×10⁻⁶"."""
        power = re.fullmatch(r"1e(.?\d+)", super().get_offset().replace("−", "-"))
        return "×10" + power.group(1).translate(RAISED) if power else super().get_offset()


# The same picture with light lines on a dark ground.


def darken(figure: Figure) -> Figure:
    """Turn the colours of a figure round: greys by their lightness, colours made light enough; returns it."""
    axes: list[Any] = figure.axes
    axis = [one for pair in axes for one in (pair.xaxis, pair.yaxis)]
    # marks that this size of the figure does not need are kept for another one
    marks = [tick for one in axis for tick in (*one.majorTicks, *one.minorTicks)]
    artists = [*figure.findobj(), *(part for tick in marks for part in tick.findobj())]
    for artist in {id(one): one for one in artists}.values():  # some are found twice
        recolour(artist)
    for one in axis:
        for which, ticks in (("major", one.majorTicks), ("minor", one.minorTicks)):
            if ticks:  # marks that are made later are as these are
                line, label, grid = ticks[0].tick1line, ticks[0].label1, ticks[0].gridline
                one.set_tick_params(
                    which=which,
                    color=line.get_color(),
                    labelcolor=label.get_color(),
                    grid_color=grid.get_color(),
                )
    return figure


def recolour(artist: Artist) -> None:
    """Turn the colours of one thing round."""
    if isinstance(artist, Line2D):
        _recolour_line(artist)
    elif isinstance(artist, Text):
        artist.set_color(_light(artist.get_color()))
        if artist.get_path_effects():
            artist.set_path_effects(halo(_light("white")))
    elif isinstance(artist, Patch):
        _recolour_patch(artist)
    elif isinstance(artist, Collection):
        artist.set_edgecolor([_light(colour) for colour in artist.get_edgecolor()])
        artist.set_facecolor([_ground(colour) for colour in artist.get_facecolor()])


def _recolour_line(line: Line2D) -> None:
    own, face, edge = line.get_color(), line.get_markerfacecolor(), line.get_markeredgecolor()
    line.set_color(_light(own))  # markers that follow the line would be turned round twice
    line.set_markerfacecolor(_light(face))
    line.set_markeredgecolor(_light(edge))


def _recolour_patch(patch: Patch) -> None:
    face, edge = patch.get_facecolor(), patch.get_edgecolor()
    patch.set_alpha(None)  # the colours hold it themselves: an empty face stays empty
    patch.set_facecolor(_ground(face))
    patch.set_edgecolor(_light(edge))


def _ground(colour: Any) -> Any:
    """The colour of an area on the dark ground; none stays none."""
    return _recolour(colour, dark_area)


def _light(colour: Any) -> Any:
    """The colour of a line or of letters on the dark ground; none stays none."""
    return _recolour(colour, dark_line)


def _recolour(colour: Any, by: Callable[[RGB], RGB]) -> Any:
    if isinstance(colour, str) and colour in ("none", "auto"):
        return colour
    red, green, blue, alpha = to_rgba(colour)
    return (*by((red, green, blue)), alpha)
