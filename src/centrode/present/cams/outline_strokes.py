"""How each layer of a cam's outlines is drawn, in files and figures alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from centrode.cams.profiles import CamOutline


@dataclass(frozen=True)
class Stroke:
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

STROKES: Mapping[str, Stroke] = {
    "path": Stroke(GREY, 0.25, (4.0, 1.0, 0.6, 1.0), 8),
    "cutter": Stroke(VERMILION, 0.25, (3.0, 1.2), 1),
    "profile": Stroke(BLUE, 0.5, (), 5),
    "profile-working": Stroke(BLUE, 0.5, (), 5),
    "profile-return": Stroke(VERMILION, 0.5, (3.0, 1.2), 1),
    "groove-working": Stroke(BLUE, 0.35, (), 4),
    "groove-return": Stroke(VERMILION, 0.35, (3.0, 1.2), 30),
    "shoe": Stroke(GREEN, 0.5, (), 3),
}


def grouped(outlines: Sequence[CamOutline]) -> dict[str, list[CamOutline]]:
    """Outlines by their layers, in the order of `STROKES`."""
    return {layer: found for layer in STROKES if (found := [one for one in outlines if one.layer == layer])}
