"""The same picture with light lines on a dark ground."""

from __future__ import annotations

import colorsys
from typing import Any

from matplotlib.artist import Artist
from matplotlib.collections import Collection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

Colour = tuple[float, float, float, float]
GROUND = 0.09  # lightness of what was white
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
        lightness = GROUND + (1.0 - GROUND - 0.04) * (1.0 - lightness)
    else:
        lightness = max(lightness, LEAST)
    return (*colorsys.hls_to_rgb(hue, lightness, saturation), alpha)
