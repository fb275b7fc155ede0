"""A drawing as SVG in millimetres, one group for each layer."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np

from centrode.render.drafting.board import (
    CAPITAL,
    CHAIN,
    LAYERS,
    LEAST,
    PAPER,
    Array,
    BoardWords,
    Drawing,
    Ring,
    Stroke,
    visible,
)

MARGIN = 0.04
"""Room around the drawing, as a part of its longer side."""
FONT = "DejaVu Sans, Arial, sans-serif"
DIGITS = 6
"""Of coordinates, in the size of the drawing."""


@dataclass(frozen=True)
class _Sheet:
    """Where a drawing lies on its sheet: the upper left corner [mm], and decimals of coordinates."""

    origin: Array
    decimals: int

    def place(self, place: Array) -> str:
        x, y = place[0] - self.origin[0], self.origin[1] - place[1]
        return f"{x:.{self.decimals}f},{y:.{self.decimals}f}"


def drawing_svg(drawing: Drawing) -> str:
    """A drawing as SVG, one user unit a millimetre; the same drawing gives the same text.

    Large and very small drawings have lines in proportion to their size, so that they can be seen at any.
    """
    strokes, rings = visible(drawing)
    low, high = drawing.box()
    size = float(np.max(high - low)) or 1.0
    low, high = low - MARGIN * size, high + MARGIN * size
    width, height = (high - low).tolist()
    root = ET.Element(
        "svg", xmlns="http://www.w3.org/2000/svg", width=f"{width:.6g}mm", height=f"{height:.6g}mm",
        viewBox=f"0 0 {width:.6g} {height:.6g}",
    )  # fmt: skip
    sheet = _Sheet(np.array([low[0], high[1]]), max(0, DIGITS - math.floor(math.log10(size))))
    thick = size / PAPER if size > PAPER or size < LEAST else 1.0
    for layer, look in LAYERS.items():
        group = _group(root, layer, look.width * thick, look.colour, look.kind == CHAIN)
        drawn = [
            *_lines(group, [stroke for stroke in strokes if stroke.layer == layer], sheet),
            *_circles(group, [ring for ring in rings if ring.layer == layer], sheet),
            *_texts(group, [words for words in drawing.words if words.layer == layer], sheet),
        ]
        if not drawn:
            root.remove(group)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def write_drawing_svg(drawing: Drawing, path: str | Path) -> None:
    """Write a drawing as SVG."""
    Path(path).write_text(drawing_svg(drawing), encoding="utf-8", newline="\n")


def _group(root: ET.Element, layer: str, width: float, colour: str, chain: bool) -> ET.Element:
    look = {
        "id": layer, "fill": "none", "stroke": colour, "stroke-width": f"{width:.4g}",
        "stroke-linecap": "round", "stroke-linejoin": "round",
    }  # fmt: skip
    if chain:
        look["stroke-dasharray"] = " ".join(f"{part * width:.4g}" for part in (24, 6, 3, 6))
    return ET.SubElement(root, "g", look)


def _lines(group: ET.Element, strokes: Sequence[Stroke], sheet: _Sheet) -> list[ET.Element]:
    return [
        ET.SubElement(group, "polyline", points=" ".join(sheet.place(place) for place in stroke.places))
        for stroke in strokes
    ]


def _circles(group: ET.Element, rings: Sequence[Ring], sheet: _Sheet) -> list[ET.Element]:
    found = []
    for ring in rings:
        x, y = sheet.place(np.array(ring.centre)).split(",")
        one = ET.SubElement(group, "circle", cx=x, cy=y, r=f"{ring.radius:.6g}")
        if ring.filled:
            one.set("fill", LAYERS[ring.layer].colour)
        found.append(one)
    return found


def _texts(group: ET.Element, words: Sequence[BoardWords], sheet: _Sheet) -> list[ET.Element]:
    found = []
    for one in words:
        below = 0.0 if one.left else 0.5 * one.height
        x, y = sheet.place(np.array(one.place) - [0.0, below]).split(",")
        text = ET.SubElement(group, "text", {
            "x": x, "y": y, "font-family": FONT, "font-size": f"{one.height / CAPITAL:.6g}", "stroke": "none",
            "fill": LAYERS[one.layer].colour, "text-anchor": "start" if one.left else "middle",
        })  # fmt: skip
        text.text = one.text
        found.append(text)
    return found
