"""Outlines in true size as SVG and DXF; how each layer is drawn, in files and figures alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape

import numpy as np

from centrode.render.dxf_files import dxf_document
from centrode.render.spelling import PlainSpelling

if TYPE_CHECKING:
    from centrode.numerics.outline_pieces import OutlinePiece
    from centrode.scenes.places import Array
    from centrode.sheets.outlines import OutlineSet

_interpolate = partial(import_module, "scipy.interpolate")  # off the cold path


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


def group_by_layer(outlines: Sequence[OutlinePiece]) -> dict[str, list[OutlinePiece]]:
    """Outlines by their layers, in the order of `STROKES`."""
    return {layer: found for layer in STROKES if (found := [one for one in outlines if one.layer == layer])}


def write_outlines(outlines: OutlineSet, path: Path) -> None:
    """Write outlines as SVG, and as DXF where its library is installed; `path` is without its ending."""
    title = PlainSpelling(None).text(outlines.title)
    write_outlines_svg(outlines.pieces, path.with_suffix(".svg"), title)
    if writes_dxf():
        write_outlines_dxf(outlines.pieces, path.with_suffix(".dxf"), title)


def writes_dxf() -> bool:
    """Whether the library that writes DXF is installed."""
    return find_spec("ezdxf") is not None


# Outlines of a cam or a shoe as SVG in true size, for cutters and viewers: cubic curves with exact slopes.

MARGIN = 5.0
"""Room around the outlines [mm]."""
CENTRE = 4.0
"""Half the length of the strokes of a centre mark [mm]."""


def write_outlines_svg(outlines: Sequence[OutlinePiece], path: Path, title: str = "") -> None:
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


def _group(layer: str, pieces: Sequence[OutlinePiece]) -> list[str]:
    stroke: Mapping[str, object] = STROKES[layer].svg
    attributes = " ".join(f'{name}="{value}"' for name, value in stroke.items())
    paths = [f'<path d="{bezier(1e3 * one.places, 1e3 * one.slopes, one.parameter)}"/>' for one in pieces]
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


# Outlines as DXF: splines and the points they go through, in layers, in millimetres.

DEGREE = 3
TEXT = 3.5
"""Height of the title [mm]."""
CREASE = 1e-9
"""Pieces whose ends are nearer than this share of a metre are one polyline."""


def write_outlines_dxf(outlines: Sequence[OutlinePiece], path: Path, title: str = "") -> None:
    """Write outlines as DXF (AutoCAD 2010), one unit a millimetre.

    Each piece is a cubic spline through its points with its own slopes at both ends, on the layer of its name; the
    points stand as polylines on the layer `points-` of it. The centre is marked, the title stands below. The same
    outlines give the same bytes.

    Raises
    ------
    InputError
        The extra `drawings` is not installed.
    """
    with dxf_document(path) as (_library, document):
        space = document.modelspace()
        for layer, pieces in group_by_layer(outlines).items():
            stroke = STROKES[layer]
            document.layers.add(layer, color=stroke.number)
            document.layers.add(f"points-{layer}", color=stroke.number)
            for piece in pieces:
                _spline(space, piece, layer)
            for places in _join_pieces(pieces):
                space.add_lwpolyline(places.tolist(), dxfattribs={"layer": f"points-{layer}"})
        _centre(document, space)
        _title(document, space, outlines, title)


def _spline(space: Any, piece: OutlinePiece, layer: str) -> None:
    ends = 1e3 * piece.slopes[[0, -1]]
    angles = piece.parameter - piece.parameter[0]  # knots that begin at 0: some readers know no others
    curve = _interpolate().make_interp_spline(
        angles, 1e3 * piece.places, k=DEGREE, bc_type=([(1, ends[0])], [(1, ends[1])])
    )
    controls = np.column_stack([curve.c, np.zeros(len(curve.c))])
    space.add_open_spline(
        controls.tolist(), degree=DEGREE, knots=curve.t.tolist(), dxfattribs={"layer": layer}
    )


def _join_pieces(pieces: Sequence[OutlinePiece]) -> list[np.ndarray[Any, Any]]:
    """Points [mm] of pieces, those end to end together."""
    found: list[np.ndarray[Any, Any]] = []
    for piece in pieces:
        places = 1e3 * piece.places
        if found and np.abs(found[-1][-1] - places[0]).max() < 1e3 * CREASE:
            found[-1] = np.concatenate([found[-1], places[1:]])
        else:
            found.append(places)
    return found


def _centre(document: Any, space: Any) -> None:
    document.layers.add("centre", color=7)
    for end in ((CENTRE, 0.0), (0.0, CENTRE)):
        space.add_line((-end[0], -end[1]), end, dxfattribs={"layer": "centre"})


def _title(document: Any, space: Any, outlines: Sequence[OutlinePiece], title: str) -> None:
    if not title:
        return
    document.layers.add("title", color=7)
    places = 1e3 * np.concatenate([one.places for one in outlines])
    left, bottom = float(places[:, 0].min()), float(places[:, 1].min())
    text = space.add_text(title, height=TEXT, dxfattribs={"layer": "title"})
    text.set_placement((left, bottom - 3.0 * TEXT))
