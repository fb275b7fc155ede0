"""How each layer of a cam's outlines is drawn, in files and figures alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape

import numpy as np

if TYPE_CHECKING:
    from centrode.cams.profiles import CamOutline
    from centrode.present.scene import Array


@dataclass(frozen=True)
class OutlineStroke:
    """Colour, width [mm] and dashes [mm] of a layer; its number among AutoCAD's colours."""

    colour: str
    width: float
    dashes: tuple[float, ...] = ()
    number: int = 7

    @property
    def svg(self) -> Mapping[str, object]:
        """Attributes of SVG."""
        dashes = {"stroke-dasharray": " ".join(f"{one:g}" for one in self.dashes)} if self.dashes else {}
        return {"stroke": self.colour, "stroke-width": f"{self.width:g}", **dashes}

    @property
    def drawn(self) -> dict[str, Any]:
        """Arguments of matplotlib."""
        points = self.width * 72.0 / 25.4
        dashes = (0, tuple(one / self.width for one in self.dashes)) if self.dashes else "-"
        return {"color": self.colour, "linewidth": points * 1.4, "linestyle": dashes}


BLUE, VERMILION, GREEN, GREY = "#0072B2", "#D55E00", "#009E73", "#8A8A8A"
"""Colours of figures (style), said here anew: files for machines are written without a library for figures."""

STROKES: Mapping[str, OutlineStroke] = {
    "path": OutlineStroke(GREY, 0.25, (4.0, 1.0, 0.6, 1.0), 8),
    "cutter": OutlineStroke(VERMILION, 0.25, (3.0, 1.2), 1),
    "profile": OutlineStroke(BLUE, 0.5, (), 5),
    "profile-working": OutlineStroke(BLUE, 0.5, (), 5),
    "profile-return": OutlineStroke(VERMILION, 0.5, (3.0, 1.2), 1),
    "groove-working": OutlineStroke(BLUE, 0.35, (), 4),
    "groove-return": OutlineStroke(VERMILION, 0.35, (3.0, 1.2), 30),
    "shoe": OutlineStroke(GREEN, 0.5, (), 3),
}


def group_by_layer(outlines: Sequence[CamOutline]) -> dict[str, list[CamOutline]]:
    """Outlines by their layers, in the order of `STROKES`."""
    return {layer: found for layer in STROKES if (found := [one for one in outlines if one.layer == layer])}


# Outlines of a cam or a shoe as SVG in true size, for cutters and viewers: cubic curves with exact slopes.

MARGIN = 5.0
"""Room around the outlines [mm]."""
CENTRE = 4.0
"""Half the length of the strokes of a centre mark [mm]."""


def write_outlines_svg(outlines: Sequence[CamOutline], path: Path, title: str = "") -> None:
    """Write outlines as SVG, one millimetre a millimetre, y up, one group a layer, the centre marked.

    A piece goes through its points with its own slopes as cubic Bezier curves: between points an angle h apart it
    departs by some h^4 / 384 of the size. The same outlines give the same bytes.
    """
    groups = group_by_layer(outlines)
    places = np.concatenate([1e3 * one.places for one in outlines] + [np.zeros((1, 2))])
    low, high = places.min(axis=0) - MARGIN - CENTRE, places.max(axis=0) + MARGIN + CENTRE
    width, height = high - low
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.6f}mm" height="{height:.6f}mm" '
        f'viewBox="{low[0]:.6f} {-high[1]:.6f} {width:.6f} {height:.6f}">',
        f"<title>{escape(title)}</title>",
        '<g fill="none" stroke-linejoin="round">',
        *(line for layer, pieces in groups.items() for line in _group(layer, pieces)),
        f'<path id="centre" stroke="#404040" stroke-width="0.18" d="{_cross()}"/>',
        "</g>",
        "</svg>",
    ]
    Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")


def _group(layer: str, pieces: Sequence[CamOutline]) -> list[str]:
    stroke: Mapping[str, object] = STROKES[layer].svg
    attributes = " ".join(f'{name}="{value}"' for name, value in stroke.items())
    paths = [f'<path d="{bezier(1e3 * one.places, 1e3 * one.slopes, one.phi)}"/>' for one in pieces]
    return [f'<g id="{layer}" {attributes}>', *paths, "</g>"]


def bezier(places: Array, slopes: Array, phi: Array) -> str:
    """The path through points with slopes, y turned down as SVG counts it."""
    down = np.array([1.0, -1.0])
    third = (np.diff(phi) / 3.0)[:, None]
    controls = np.stack(
        [places[:-1] + third * slopes[:-1], places[1:] - third * slopes[1:], places[1:]], axis=1
    )
    curves = " ".join(" ".join(_pair(point) for point in one) for one in controls * down)
    return f"M{_pair(places[0] * down)} C{curves}"


def _cross() -> str:
    return f"M{-CENTRE:g},0H{CENTRE:g}M0,{-CENTRE:g}V{CENTRE:g}"


def _pair(point: Array) -> str:
    x, y = np.round(point, 7) + 0.0
    return f"{x:.7f},{y:.7f}"
