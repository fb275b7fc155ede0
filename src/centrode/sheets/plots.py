"""Plots: curves over an abscissa in panels, and diagrams of one quantity over another; data without a look."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.texts import NOTHING, Sentence, Symbol, Text, Title

Array = NDArray[np.float64]


class EventKind(Enum):
    """What a mark on the abscissa stands for."""

    LIMIT = "limit"
    CHANGE_POINT = "change point"


@dataclass(frozen=True)
class AxisLabel:
    """What an axis shows.

    Attributes
    ----------
    text : what it is; nothing where the symbol says it
    symbol : its letter, or a text in its place
    unit : SI unit of the values; the renderer converts them to the unit of the display
    unit_fixed : the unit stays whatever the display says
    """

    text: Text = NOTHING
    symbol: Symbol | None = None
    unit: str = "1"
    unit_fixed: bool = False


@dataclass(frozen=True)
class Abscissa:
    """What curves are drawn over.

    Attributes
    ----------
    label : of the axis
    values : (sample), in the unit of the label, in drawing order
    order : (sample) numbers of the samples in drawing order
    breaks : places in that order before which a limit parts two samples: no line joins them
    cut : (sample) True where a sample is cut off from the initial position
    events : values at which something happens, with its kind
    """

    label: AxisLabel
    values: Array
    order: NDArray[np.intp]
    breaks: NDArray[np.intp] = field(default_factory=lambda: np.array([], dtype=np.intp))
    cut: NDArray[np.bool_] = field(default_factory=lambda: np.array([], dtype=np.bool_))
    events: tuple[tuple[float, EventKind], ...] = ()


@dataclass(frozen=True)
class Curve:
    """One curve of a panel.

    Attributes
    ----------
    name : in the legend
    values : (sample), in the unit of the panel; NaN is a gap
    place : its place among the things of its kind, which have the same pen in every figure
    approximate : drawn beside the exact curve, dashed
    """

    name: Text
    values: Array
    place: int
    approximate: bool = False


@dataclass(frozen=True)
class CurvePanel:
    """Curves of one quantity.

    Attributes
    ----------
    label : of the vertical axis; its unit is that of the curves
    curves : in the order of the legend
    scale : what counts as a great value [unit of the label]; parts in 10^9 of it are rounding
    legend : whether the names stand beside the panel
    """

    label: AxisLabel
    curves: tuple[Curve, ...]
    scale: float = 0.0
    legend: bool = True


@dataclass(frozen=True)
class Plot:
    """Panels in rows and columns over one abscissa.

    Attributes
    ----------
    title : what it shows
    mechanism : of which mechanism
    """

    title: Sentence
    mechanism: Title
    abscissa: Abscissa
    rows: tuple[tuple[CurvePanel, ...], ...]


class TraceKind(Enum):
    """How a trace of a diagram is drawn."""

    CURVE = "curve"
    LINE = "line"
    SEGMENT = "segment"


@dataclass(frozen=True)
class Trace:
    """A curve, a straight line or a segment of a diagram; points of it that are marked.

    Attributes
    ----------
    name : in the legend
    x, y : (n), in the units of the diagram's labels
    kind : curve, line across the diagram, or segment on an axis
    marks : (n, 2) points on it
    """

    name: Text
    x: Array
    y: Array
    kind: TraceKind = TraceKind.CURVE
    marks: Array = field(default_factory=lambda: np.empty((0, 2)))


@dataclass(frozen=True)
class Diagram:
    """One quantity over another.

    Attributes
    ----------
    title, mechanism : as of a plot
    x, y : labels of the axes
    traces : in the order of the legend
    across : least and greatest x shown
    """

    title: Sentence
    mechanism: Title
    x: AxisLabel
    y: AxisLabel
    traces: tuple[Trace, ...]
    across: tuple[float, float]


@dataclass(frozen=True)
class SpanPanel:
    """Curves of one quantity over an abscissa that is parted into spans.

    Attributes
    ----------
    label : of the vertical axis; its unit is that of the curves
    curves : in the order of the legend
    jumps : (abscissa, from, to) of curves that jump where spans meet
    bounds : values that are admissible at most or at least
    heading : above the panel
    """

    label: AxisLabel
    curves: tuple[Curve, ...]
    jumps: tuple[tuple[float, float, float], ...] = ()
    bounds: tuple[float, ...] = ()
    heading: Text = NOTHING


@dataclass(frozen=True)
class SpanPlot:
    """Panels below each other over an abscissa that is parted into spans: the segments of a cam, one rise.

    Attributes
    ----------
    title, mechanism : as of a plot
    label : of the abscissa
    values : (place) in the unit of the label; where two places are equal a span ends, and no line joins them
    ends : (spans + 1) where spans begin, and the last one ends
    names : of the spans; none where there is one alone
    panels : from the top
    """

    title: Sentence
    mechanism: Title
    label: AxisLabel
    values: Array
    ends: tuple[float, ...]
    names: tuple[Text, ...]
    panels: tuple[SpanPanel, ...]


Figures = Mapping[str, "Plot | Diagram | SpanPlot"]
