"""Plots: curves over an abscissa in panels, and diagrams of one quantity over another; data without a look."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.texts import NOTHING, Number, Sentence, Symbol, Text, Title

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

Array = NDArray[np.float64]


class EventKind(Enum):
    """What a mark on the abscissa stands for."""

    LIMIT = "limit"
    CHANGE_POINT = "change point"


class CurveRole(Enum):
    """What a curve of a panel stands for: a thing by itself, a part of a sum, or the sum, which alone is black.

    A level is a line across for the mean of another curve, black and dashed.
    """

    THING = "thing"
    PART = "part"
    SUM = "sum"
    LEVEL = "level"


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
    values : (place), in the unit of the label, in drawing order
    order : (place) numbers of the samples in drawing order; those beyond a dead position are left out
    breaks : places in that order before which a limit parts two samples: no line joins them
    cut : (sample) True where a sample is cut off from the initial position
    events : values at which something happens, with its kind
    ends : where the axis begins and ends: dead positions lie beyond the samples; the extreme values if None
    samples : places of the samples of a motion, where curves have further places between them; None if all are
    """

    label: AxisLabel
    values: Array
    order: NDArray[np.intp]
    breaks: NDArray[np.intp] = field(default_factory=lambda: np.array([], dtype=np.intp))
    cut: NDArray[np.bool_] = field(default_factory=lambda: np.array([], dtype=np.bool_))
    events: tuple[tuple[float, EventKind], ...] = ()
    ends: tuple[float, float] | None = None
    samples: NDArray[np.intp] | None = None


@dataclass(frozen=True)
class Curve:
    """One curve of a panel.

    Attributes
    ----------
    name : in the legend
    values : (sample), in the unit of the panel; NaN is a gap
    place : its place among the things of its kind, which have the same pen in every figure
    approximate : drawn beside the exact curve, dashed
    role : a thing by itself, a part of a sum, or the sum
    slopes : (sample) derivatives by the abscissa, in the units of both labels, NaN where not known; None if nowhere
    """

    name: Text
    values: Array
    place: int
    approximate: bool = False
    role: CurveRole = CurveRole.THING
    slopes: Array | None = None


@dataclass(frozen=True)
class Band:
    """The area between two curves of a panel.

    Attributes
    ----------
    name : in the legend
    low, high : (sample), in the unit of the panel; NaN is a gap
    place : as of a curve; the area has its colour, pale
    """

    name: Text
    low: Array
    high: Array
    place: int


@dataclass(frozen=True)
class CurvePanel:
    """Curves of one quantity.

    Attributes
    ----------
    label : of the vertical axis; its unit is that of the curves
    curves : in the order of the legend
    scale : what counts as a great value [unit of the label]; parts in 10^9 of it are rounding
    legend : whether the names stand beside the panel
    dots : names in the legend and places (abscissa, value) of single values
    from_zero : the axis begins at zero
    bands : areas behind the curves
    """

    label: AxisLabel
    curves: tuple[Curve, ...]
    scale: float = 0.0
    legend: bool = True
    dots: tuple[tuple[Text, float, float], ...] = ()
    from_zero: bool = False
    bands: tuple[Band, ...] = ()


@dataclass(frozen=True)
class Overlay:
    """Curves of a second route, dashed over those of a plot.

    Attributes
    ----------
    name : of all of them, in the legend
    abscissa : of their own samples
    rows : panels with the same curves as those of the plot
    """

    name: Text
    abscissa: Abscissa
    rows: tuple[tuple[CurvePanel, ...], ...]


@dataclass(frozen=True)
class Plot:
    """Panels in rows and columns over one abscissa.

    Attributes
    ----------
    title : what it shows
    mechanism : of which mechanism
    overlay : what the curves are compared with
    sizes_above : of each curve its size where that is greater, on logarithmic scales; plain scales if None
    places : names of single values of the abscissa, and these, in its unit; they are marked in all panels
    shaded : stretches of the abscissa, in its unit, that are shaded in all panels
    """

    title: Sentence
    mechanism: Title
    abscissa: Abscissa
    rows: tuple[tuple[CurvePanel, ...], ...]
    overlay: Overlay | None = None
    sizes_above: float | None = None
    places: tuple[tuple[Text, float], ...] = ()
    shaded: tuple[tuple[float, float], ...] = ()


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
class CurveDiagram:
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
class HodographPanel:
    """The curve that the end of a vector describes, from an origin that is marked.

    Attributes
    ----------
    name : of the vector, above the panel
    x, y : labels of the axes; their unit is that of the vector
    ends : (sample, 2), NaN where nothing is known
    order, breaks : as of an abscissa
    marks : values that stand beside places of the curve
    """

    name: Text
    x: AxisLabel
    y: AxisLabel
    ends: Array
    order: NDArray[np.intp]
    breaks: NDArray[np.intp]
    marks: tuple[tuple[Number, tuple[float, float]], ...] = ()


@dataclass(frozen=True)
class SectorRings:
    """Shares of the sectors of a circle, those of one surface inside it and of another outside, to one scale.

    Attributes
    ----------
    name : above the panel
    middles : (sector) directions of the middles of the sectors [rad]
    inside, outside : (sector) shares; NaN where nothing is known
    text : in the middle
    """

    name: Text
    middles: Array
    inside: Array
    outside: Array
    text: Text


@dataclass(frozen=True)
class PanelGrid:
    """Panels of equal size beside and below each other, each with a shape of its own."""

    title: Sentence
    mechanism: Title
    panels: tuple[HodographPanel | SectorRings, ...]


@dataclass(frozen=True)
class VectorOnBody:
    """A vector that acts at a point of a mechanism.

    Attributes
    ----------
    name : beside its end
    point : where it acts
    components : (x, y), NaN where it is not determined
    link : whose colour it has, the frame's too; ink where empty
    """

    name: Text
    point: str
    components: tuple[float, float]
    link: str = ""


@dataclass(frozen=True)
class MomentOnBody:
    """A moment about a point of a mechanism, counter-clockwise where it is positive; `symbol` stands beside its arc."""

    symbol: str
    point: str
    value: float


@dataclass(frozen=True)
class VectorPage:
    """A mechanism at an instant, to scale, with the vectors that act on it to theirs; a column of texts beside it.

    Attributes
    ----------
    title : what it shows
    pose : description, motion and sample of it: what the mechanism looks like
    symbol, unit : letter of the vectors' scale ("μ_F"), and their unit
    vectors, moments : in drawing order
    lines : of the column
    """

    title: Sentence
    pose: tuple[Mechanism, xarray.Dataset, int]
    symbol: str
    unit: str
    vectors: tuple[VectorOnBody, ...]
    moments: tuple[MomentOnBody, ...]
    lines: tuple[Text, ...]


class AreaKind(Enum):
    """What an area of a diagram stands for."""

    MAIN = "main"
    BESIDE = "beside"


@dataclass(frozen=True)
class Area:
    """A part of a grid, with its border.

    Attributes
    ----------
    name : in the legend
    levels : (n, m) positive at the nodes inside; the border is where it passes through zero. Without a node inside the
        area is not there
    kind : what the reader looks for, or what there is beside it
    """

    name: Text
    levels: Array
    kind: AreaKind = AreaKind.MAIN


@dataclass(frozen=True)
class AreaPath:
    """A curve through the areas of a diagram.

    Attributes
    ----------
    name : in the legend
    x, y : (k), in the units of the diagram's labels; NaN is a gap
    kind : as of an area
    pen : its place among paths that are told apart by their pens; None where the kind says enough
    """

    name: Text
    x: Array
    y: Array
    kind: AreaKind = AreaKind.MAIN
    pen: int | None = None


@dataclass(frozen=True)
class AreaDiagram:
    """Areas of the plane of two quantities, paths through them and places in them.

    Attributes
    ----------
    title, mechanism : as of a plot
    x, y : labels of the axes
    across, up : (n) and (m) values at the lines of the grid, in the units of the labels
    areas : in the order of the legend; the first lies over the others
    paths : in the order of the legend
    places : name in the legend, x and y
    """

    title: Sentence
    mechanism: Title
    x: AxisLabel
    y: AxisLabel
    across: Array
    up: Array
    areas: tuple[Area, ...]
    paths: tuple[AreaPath, ...]
    places: tuple[tuple[Text, float, float], ...]


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
    zero_line : a line stands where the quantity is zero
    """

    label: AxisLabel
    curves: tuple[Curve, ...]
    jumps: tuple[tuple[float, float, float], ...] = ()
    bounds: tuple[float, ...] = ()
    heading: Text = NOTHING
    zero_line: bool = True


@dataclass(frozen=True)
class SpanPlot:
    """Panels below each other over an abscissa that is parted into spans: the segments of a cam, one rise.

    Attributes
    ----------
    title, mechanism : as of a plot
    label : of the abscissa
    values : (place) in the unit of the label; where two places are equal a span ends, and no line joins them
    ends : (spans + 1) where spans begin, and the last one ends
    names : of the spans; none where there is one alone, or the panels have headings
    panels : from the top
    """

    title: Sentence
    mechanism: Title
    label: AxisLabel
    values: Array
    ends: tuple[float, ...]
    names: tuple[Text, ...]
    panels: tuple[SpanPanel, ...]
