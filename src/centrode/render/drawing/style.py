"""One look for all figures: colours that colour-blind readers can tell apart, line widths, texts."""

from __future__ import annotations

import colorsys
import logging
import re
import warnings
from collections.abc import Iterable, Iterator, Mapping
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
from matplotlib.text import Text
from matplotlib.ticker import ScalarFormatter

# Okabe and Ito, Color Universal Design (2008), without its yellow, which is lost on white paper.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
DASHES: tuple[Any, ...] = ("-", (0, (5, 1.2)), (0, (5, 1.2, 1.2, 1.2)), (0, (1.2, 1.0)))
MUTED = "#8A8A8A"
GROUND = "#404040"
INK = "#202020"
MATHTEXT = logging.getLogger("matplotlib.mathtext")
BACKEND = ("backend", "backend_fallback")
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

SETTINGS: dict[str, Any] = {
    "axes.edgecolor": "#606060",
    "axes.formatter.limits": (-3, 4),
    "axes.formatter.useoffset": False,
    "axes.grid": True,
    "axes.linewidth": 0.7,
    "axes.titlesize": 10,
    "figure.dpi": 150,
    "font.family": ["DejaVu Sans"],
    "font.size": 9.5,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6,
    "legend.fontsize": 9,
    "legend.frameon": False,
    "lines.linewidth": 1.5,
    "mathtext.fontset": "dejavusans",
    "svg.fonttype": "path",
    "svg.hashsalt": "centrode",
}


@dataclass(frozen=True)
class Pen:
    """Colour and dashes of one link, point or guide, the same in every figure."""

    colour: str
    dashes: Any = "-"


@contextmanager
def house_style() -> Iterator[None]:
    """Context in which figures are made: matplotlib's defaults and ours, whatever the user has set.

    A letter that the font lacks (a title may be in any language) becomes a box, without a warning.
    """
    settings: Any = matplotlib.rcParamsDefault | SETTINGS
    # Even to ask for the backend would load pyplot and choose one.
    ours = {name: value for name, value in settings.items() if name not in BACKEND}
    with matplotlib.rc_context(ours), warnings.catch_warnings():
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
    """A pen for each name: colours in turn, then the same colours dashed."""
    return {
        name: Pen(PALETTE[number % len(PALETTE)], DASHES[number // len(PALETTE) % len(DASHES)])
        for number, name in enumerate(names)
    }


class Decimals(ScalarFormatter):
    """Numbers of ticks as plain text, which is laid out many times faster than mathematical text."""

    def get_offset(self) -> str:
        """The common factor of the ticks: "×10⁻⁶"."""
        power = re.fullmatch(r"1e(.?\d+)", super().get_offset().replace("−", "-"))
        return "×10" + power.group(1).translate(RAISED) if power else super().get_offset()


# The same picture with light lines on a dark ground.

Colour = tuple[float, float, float, float]
DARK_GROUND = 0.09  # lightness of what was white
LEAST = 0.58  # lightness that a coloured line gets at least


def darkened(figure: Figure) -> Figure:
    """Turn the colours of a figure round: greys by their lightness, colours made light enough; returns it."""
    for artist in {id(one): one for one in figure.findobj()}.values():  # some are found twice
        recolour(artist)
    return figure


def recolour(artist: Artist) -> None:
    """Turn the colours of one thing round."""
    if isinstance(artist, Line2D):
        _recolour_line(artist)
    elif isinstance(artist, Text):
        artist.set_color(_light(artist.get_color()))
    elif isinstance(artist, Patch):
        _recolour_patch(artist)
    elif isinstance(artist, Collection):
        artist.set_edgecolor([_light(colour) for colour in artist.get_edgecolor()])
        artist.set_facecolor([_light(colour) for colour in artist.get_facecolor()])


def _recolour_line(line: Line2D) -> None:
    own, face, edge = line.get_color(), line.get_markerfacecolor(), line.get_markeredgecolor()
    line.set_color(_light(own))  # markers that follow the line would be turned round twice
    line.set_markerfacecolor(_light(face))
    line.set_markeredgecolor(_light(edge))


def _recolour_patch(patch: Patch) -> None:
    face, edge = patch.get_facecolor(), patch.get_edgecolor()
    patch.set_alpha(None)  # the colours hold it themselves: an empty face stays empty
    patch.set_facecolor(_light(face))
    patch.set_edgecolor(_light(edge))


def _light(colour: Any) -> Any:
    """A colour as it is seen best on the dark ground; none stays none."""
    if isinstance(colour, str) and colour in ("none", "auto"):
        return colour
    red, green, blue, alpha = to_rgba(colour)
    hue, lightness, saturation = colorsys.rgb_to_hls(red, green, blue)
    if saturation < 0.05:
        lightness = DARK_GROUND + (1.0 - DARK_GROUND - 0.04) * (1.0 - lightness)
    else:
        lightness = max(lightness, LEAST)
    return (*colorsys.hls_to_rgb(hue, lightness, saturation), alpha)
