"""Figures as data: curves, labels, limits and texts of each axes, instead of pixels."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import Collection
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Annotation, Text

from tools.snapshots.artefacts import Artefact


def figure_artefact(figure: Figure, comma: bool = False) -> Artefact:
    """All that a figure shows, less what matplotlib adds by itself at drawing."""
    made = Artefact(comma)
    made.say(
        f"figure {'x'.join(f'{side:.6g}' for side in figure.get_size_inches())} {_colours(figure.get_facecolor())}"
    )
    others = (*figure.texts, *figure.legends, *figure.lines, *figure.patches, *figure.images, *figure.artists)
    for artist in others:
        if artist is not figure.patch:
            _describe(artist, made)
    for number, axes in enumerate(figure.axes, start=1):
        made.say(f"axes {number}")
        _describe_axes(axes, made)
    return made


def _describe_axes(axes: Axes, made: Artefact) -> None:
    titles = [axes.get_title(loc) for loc in ("left", "center", "right")]
    made.say(f"{axes.name} title {' | '.join(titles)} aspect {axes.get_aspect()} on {axes.axison}")
    made.add("limits", [*axes.get_xlim(), *axes.get_ylim()])
    for name in ("x", "y", "z"):
        axis: Any = getattr(axes, f"{name}axis", None)
        if axis is None:
            continue
        made.say(f"{name} {axis.get_scale()} {axis.get_visible()} {axis.get_label_text()}")
        if axes.axison and axis.get_visible():
            made.say("ticks " + " ".join(axis.get_major_formatter().format_ticks(axis.get_majorticklocs())))
            made.say(f"offset {axis.get_major_formatter().get_offset()}")
    skipped = {*axes.spines.values(), axes.patch, axes.title, *axes.child_axes}
    for artist in axes.get_children():
        if artist not in skipped and isinstance(artist, (Line2D, Patch, Collection, Text, Legend, AxesImage)):
            _describe(artist, made)


def _describe(artist: Artist, made: Artefact) -> None:
    if isinstance(artist, Text) and not artist.get_text():
        return
    made.say(
        f"{type(artist).__name__} {artist.get_label()} order {artist.get_zorder()} seen {artist.get_visible()}"
    )
    match artist:
        case Line2D():
            style = f"{artist.get_linestyle()} {artist.get_linewidth()} {artist.get_marker()} {artist.get_markersize()}"
            made.say(f"{_colours(artist.get_color())} {style}")
            spatial = getattr(artist, "_verts3d", None)
            for name, values in zip(
                "xyz", spatial or (artist.get_xdata(orig=False), artist.get_ydata(orig=False)), strict=False
            ):
                made.add(name, np.ma.filled(np.ma.asarray(values, dtype=float), np.nan))
        case Text():
            made.say(artist.get_text())
            aligned = f"{artist.get_horizontalalignment()} {artist.get_verticalalignment()}"
            made.say(f"{_colours(artist.get_color())} {artist.get_fontsize()} {aligned}")
            places = [*map(float, artist.get_position()), float(artist.get_rotation())]
            if isinstance(artist, Annotation):
                places += map(float, artist.xy)
            made.add("at", places)
        case Legend():
            made.say(" | ".join(text.get_text() for text in artist.get_texts()))
        case Patch():
            colours = (artist.get_facecolor(), artist.get_edgecolor())
            made.say(f"{' '.join(map(_colours, colours))} {artist.get_linestyle()} {artist.get_linewidth()}")
            made.add("outline", artist.get_patch_transform().transform(artist.get_path().vertices))
        case Collection():
            shades = [artist.get_facecolor(), artist.get_edgecolor()]
            made.say(" ".join(_colours(one) for shade in shades for one in np.reshape(shade, (-1, 4))))
            made.add("offsets", np.ma.filled(np.ma.asarray(artist.get_offsets(), dtype=float), np.nan))
            outlines = [np.asarray(path.vertices, dtype=float).ravel() for path in artist.get_paths()]
            made.add("outlines", np.concatenate([np.zeros(0), *outlines]))
            if artist.get_array() is not None:
                made.add("values", np.ma.filled(np.ma.asarray(artist.get_array(), dtype=float), np.nan))
        case AxesImage():
            made.add("extent", artist.get_extent())
            made.add("values", np.ma.filled(np.ma.asarray(artist.get_array(), dtype=float), np.nan))


def _colours(colour: Any) -> str:
    return str(to_hex(colour, keep_alpha=True))
