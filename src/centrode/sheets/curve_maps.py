"""Maps of curves in the plane, each to one scale, with places to pass and with the linkage that draws the curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.plots import AxisLabel
from centrode.sheets.texts import Sentence, Text, Title

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MapCurve:
    """A curve: its name in the legend, places (n, 2) with NaN as a gap, and its place among the pens."""

    name: Text
    places: Array
    place: int


@dataclass(frozen=True, eq=False)
class MapPanel:
    """Curves to one scale.

    Attributes
    ----------
    name : above the panel
    curves : in drawing order
    targets : (n, 2) places to pass, drawn as open dots
    links : polygons (k, 2) of links in one position
    fixed : (m, 2) fixed hinges
    arrows : (n, 2, 2) from and to, of directions at targets
    """

    name: Text
    curves: tuple[MapCurve, ...]
    targets: Array
    links: tuple[Array, ...] = ()
    fixed: Array | None = None
    arrows: Array | None = None


@dataclass(frozen=True, eq=False)
class CurveMap:
    """Panels of maps beside each other.

    Attributes
    ----------
    title, mechanism : what it shows, and of what
    x, y : labels of the axes
    target : name of the dots in the legend
    panels : in rows
    """

    title: Sentence
    mechanism: Title
    x: AxisLabel
    y: AxisLabel
    target: Text
    panels: tuple[MapPanel, ...]
