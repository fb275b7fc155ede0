"""Figures on dark ground: the same hues, light where they were dark."""

from __future__ import annotations

import colorsys
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis, Tick
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

GROUND, INK = 0.10, 0.93
"""Lightness of what was white, and of what was black."""
PARTS = ("color", "facecolor", "edgecolor", "markerfacecolor", "markeredgecolor")


def in_dark(figure: Figure) -> Figure:
    """Turn a figure to dark ground, in place: every colour keeps its hue and changes its lightness; returns it."""
    for artist in figure.findobj(Artist):
        if isinstance(artist, Figure | Axes | Axis | Tick):
            continue  # their parts are met by themselves
        for part in PARTS:
            read, change = getattr(artist, f"get_{part}", None), getattr(artist, f"set_{part}", None)
            if read is not None and change is not None and not _double(artist, part):
                change(_darkened(read()))
    return figure


def _double(artist: Artist, part: str) -> bool:
    """Whether `color` of an artist is only another word for its other colours."""
    return part == "color" and hasattr(artist, "get_facecolor")


def _darkened(colour: Any) -> Any:
    """A colour, or rows of colours, turned; "none" and "auto" stay."""
    if isinstance(colour, str) and colour in ("none", "auto", "inherit"):
        return colour
    rows = np.asarray(colour) if not isinstance(colour, str | tuple) else None
    if rows is not None and rows.ndim == 2:
        return [_turned(tuple(row)) for row in rows]
    return _turned(colour)


def _turned(colour: Any) -> tuple[float, float, float, float]:
    red, green, blue, alpha = to_rgba(colour)
    hue, light, strength = colorsys.rgb_to_hls(red, green, blue)
    return (*colorsys.hls_to_rgb(hue, INK + (GROUND - INK) * light, strength), alpha)
