"""Outlines of a cam or a shoe as DXF: splines and the points they go through, in layers, in millimetres."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.interpolate import make_interp_spline

from centrode.present.cams.outlines import STROKES, group_by_layer
from centrode.present.dxf_files import dxf_document

if TYPE_CHECKING:
    from centrode.cams.profiles import CamOutline

DEGREE = 3
CENTRE = 4.0
"""Half the length of the strokes of the centre mark [mm]."""
TEXT = 3.5
"""Height of the title [mm]."""
CREASE = 1e-9
"""Pieces whose ends are nearer than this share of a metre are one polyline."""


def write_outlines_dxf(outlines: Sequence[CamOutline], path: Path, title: str = "") -> None:
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
            for places in _joined(pieces):
                space.add_lwpolyline(places.tolist(), dxfattribs={"layer": f"points-{layer}"})
        _centre(document, space)
        _title(document, space, outlines, title)


def _spline(space: Any, piece: CamOutline, layer: str) -> None:
    ends = 1e3 * piece.slopes[[0, -1]]
    angles = piece.phi - piece.phi[0]  # knots that begin at 0: some readers know no others
    curve = make_interp_spline(angles, 1e3 * piece.places, k=DEGREE, bc_type=([(1, ends[0])], [(1, ends[1])]))
    controls = np.column_stack([curve.c, np.zeros(len(curve.c))])
    space.add_open_spline(
        controls.tolist(), degree=DEGREE, knots=curve.t.tolist(), dxfattribs={"layer": layer}
    )


def _joined(pieces: Sequence[CamOutline]) -> list[np.ndarray[Any, Any]]:
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


def _title(document: Any, space: Any, outlines: Sequence[CamOutline], title: str) -> None:
    if not title:
        return
    document.layers.add("title", color=7)
    places = 1e3 * np.concatenate([one.places for one in outlines])
    left, bottom = float(places[:, 0].min()), float(places[:, 1].min())
    text = space.add_text(title, height=TEXT, dxfattribs={"layer": "title"})
    text.set_placement((left, bottom - 3.0 * TEXT))
