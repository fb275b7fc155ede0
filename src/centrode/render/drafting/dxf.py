"""A drawing as DXF in millimetres, one layer for each kind of line."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from centrode.render.drafting.board import (
    CHAIN,
    CONTINUOUS,
    DASHED,
    LAYERS,
    LEAST,
    PAPER,
    Drawing,
    Look,
    visible,
)
from centrode.render.dxf_files import dxf_document

HUNDREDTHS = 100.0
"""Of a millimetre, in which DXF has the widths of lines."""
BY_LAYER = 256
"""The colour of a layer."""
PATTERNS = {CHAIN: [15.0, 9.0, -2.5, 1.0, -2.5], DASHED: [6.0, 4.5, -1.5]}
"""Whole length, then strokes, gaps and dots [mm]."""


def write_drawing_dxf(
    drawing: Drawing, path: str | Path, layers: Mapping[str, Look] = LAYERS, line_scale: float | None = None
) -> None:
    """Write a drawing as DXF (AutoCAD 2010), one unit a millimetre; the same drawing gives the same bytes.

    Parameters
    ----------
    layers : layers of the drawing, in the order in which they are drawn
    line_scale : of the patterns of lines; in proportion to a large or very small drawing if None

    Raises
    ------
    InputError
        The extra `drawings` is not installed.
    """
    strokes, rings = visible(drawing)
    used = (
        {one.layer for one in strokes} | {one.layer for one in rings} | {one.layer for one in drawing.words}
    )
    with dxf_document(Path(path)) as (library, document):
        low, high = drawing.box()
        scale = _scale(float((high - low).max())) if line_scale is None else line_scale
        document.header["$LTSCALE"] = scale
        for kind in [CHAIN, *sorted({layers[layer].kind for layer in used} - {CHAIN, CONTINUOUS})]:
            document.linetypes.add(kind.upper(), PATTERNS[kind])
        for layer, look in layers.items():
            if layer in used:
                width = round(HUNDREDTHS * look.width)
                document.layers.add(layer, color=look.number, lineweight=width, linetype=look.kind.upper())
        space = document.modelspace()
        for stroke in sorted(strokes, key=lambda stroke: list(layers).index(stroke.layer)):
            space.add_lwpolyline(stroke.places.tolist(), dxfattribs={"layer": stroke.layer})
            if stroke.filled:
                body = space.add_hatch(color=BY_LAYER, dxfattribs={"layer": stroke.layer})
                body.paths.add_polyline_path(stroke.places.tolist(), is_closed=True)
        for ring in rings:
            space.add_circle(ring.centre, ring.radius, dxfattribs={"layer": ring.layer})
            if ring.filled:
                dot = space.add_hatch(color=BY_LAYER, dxfattribs={"layer": ring.layer})
                dot.paths.add_edge_path().add_arc(ring.centre, ring.radius, 0.0, 360.0)
        places = library.enums.TextEntityAlignment
        for words in drawing.words:
            attributes = {"layer": words.layer} | ({"rotation": words.angle} if words.angle else {})
            text = space.add_text(words.text, height=words.height, dxfattribs=attributes)
            text.set_placement(words.place, align=places.LEFT if words.left else places.MIDDLE_CENTER)


def _scale(size: float) -> float:
    """Of the patterns of lines."""
    return size / PAPER if size > PAPER or 0.0 < size < LEAST else 1.0
