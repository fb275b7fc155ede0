"""A drawing as DXF in millimetres, one layer for each kind of line."""

from __future__ import annotations

from pathlib import Path

from centrode.render.drafting.board import CHAIN, LAYERS, LEAST, PAPER, Drawing, visible
from centrode.render.dxf_files import dxf_document

HUNDREDTHS = 100.0
"""Of a millimetre, in which DXF has the widths of lines."""
BY_LAYER = 256
"""The colour of a layer."""
CHAIN_PATTERN = [15.0, 9.0, -2.5, 1.0, -2.5]
"""Whole length, then stroke, gap, dot, gap [mm]."""


def write_drawing_dxf(drawing: Drawing, path: str | Path) -> None:
    """Write a drawing as DXF (AutoCAD 2010), one unit a millimetre; the same drawing gives the same bytes.

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
        document.header["$LTSCALE"] = _scale(float((high - low).max()))
        document.linetypes.add(CHAIN.upper(), CHAIN_PATTERN)
        for layer, look in LAYERS.items():
            if layer in used:
                line = CHAIN.upper() if look.kind == CHAIN else "CONTINUOUS"
                width = round(HUNDREDTHS * look.width)
                document.layers.add(layer, color=look.number, lineweight=width, linetype=line)
        space = document.modelspace()
        for stroke in sorted(strokes, key=lambda stroke: list(LAYERS).index(stroke.layer)):
            space.add_lwpolyline(stroke.places.tolist(), dxfattribs={"layer": stroke.layer})
        for ring in rings:
            space.add_circle(ring.centre, ring.radius, dxfattribs={"layer": ring.layer})
            if ring.filled:
                dot = space.add_hatch(color=BY_LAYER, dxfattribs={"layer": ring.layer})
                dot.paths.add_edge_path().add_arc(ring.centre, ring.radius, 0.0, 360.0)
        places = library.enums.TextEntityAlignment
        for words in drawing.words:
            text = space.add_text(words.text, height=words.height, dxfattribs={"layer": words.layer})
            text.set_placement(words.place, align=places.LEFT if words.left else places.MIDDLE_CENTER)


def _scale(size: float) -> float:
    """Of the patterns of lines."""
    return size / PAPER if size > PAPER or 0.0 < size < LEAST else 1.0
