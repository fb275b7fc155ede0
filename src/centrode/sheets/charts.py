"""Charts of other kinds: hodographs of vectors, bars by order, and a linkage with discs on its links."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.plots import AxisLabel
from centrode.sheets.texts import Sentence, Text, Title

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

Array = NDArray[np.float64]


@dataclass(frozen=True)
class HodographCurve:
    """The ends of a vector.

    Attributes
    ----------
    name : in the legend
    ends : (sample, 2), evenly spaced, in the unit of the hodograph's labels
    place : gives it its colour
    approximate : dashed, as what another curve is compared with
    """

    name: Text
    ends: Array
    place: int
    approximate: bool = False


@dataclass(frozen=True)
class Hodograph:
    """Ends of vectors from one origin, to one scale, with a dot every tenth of their way and a great one at its start.

    Attributes
    ----------
    title, mechanism : what it shows, and of which mechanism
    x, y : labels of the components
    curves : in the order of the legend
    """

    title: Sentence
    mechanism: Title
    x: AxisLabel
    y: AxisLabel
    curves: tuple[HodographCurve, ...]


@dataclass(frozen=True)
class Bars:
    """Bars of one kind.

    Attributes
    ----------
    name : in the legend
    positions, heights : (n) in the units of their labels; kinds may have different positions
    place, approximate : as of curves
    """

    name: Text
    positions: Array
    heights: Array
    place: int
    approximate: bool = False


@dataclass(frozen=True)
class BarPanel:
    """Bars of one quantity, those of each kind side by side."""

    label: AxisLabel
    bars: tuple[Bars, ...]


@dataclass(frozen=True)
class BarChart:
    """Panels of bars below each other.

    Attributes
    ----------
    title, mechanism : what it shows, and of which mechanism
    across : what the positions are
    panels : over the same positions
    """

    title: Sentence
    mechanism: Title
    across: Text
    panels: tuple[BarPanel, ...]


@dataclass(frozen=True, eq=False)
class NamedBars:
    """Bars of one thing beside their names, from the top.

    Attributes
    ----------
    label : above the bars: of what these are; nothing where there is one panel
    names : (n) beside the bars
    lengths : (n), in the unit of the chart's axis
    """

    label: Text
    names: tuple[Text, ...]
    lengths: Array


@dataclass(frozen=True)
class NamedBarChart:
    """Panels of bars that lie, below each other, over one axis.

    Attributes
    ----------
    title, mechanism : what it shows, and of which mechanism
    across : of the axis
    panels : from the top
    """

    title: Sentence
    mechanism: Title
    across: AxisLabel
    panels: tuple[NamedBars, ...]


@dataclass(frozen=True, eq=False)
class HistogramPanel:
    """How often a quantity has its values.

    Attributes
    ----------
    x : label of the quantity
    edges, counts : (n + 1) values between which so many (n) lie, in the unit of the label
    levels : names in the legend and values that are marked; those of one name have one pen
    """

    x: AxisLabel
    edges: Array
    counts: Array
    levels: tuple[tuple[Text, float], ...] = ()


@dataclass(frozen=True)
class Histograms:
    """Histograms below each other, each over its own axis.

    Attributes
    ----------
    title, mechanism : what it shows, and of which mechanism
    up : what is counted
    panels : from the top
    """

    title: Sentence
    mechanism: Title
    up: Text
    panels: tuple[HistogramPanel, ...]


@dataclass(frozen=True)
class CarriedDisc:
    """A disc on a link.

    Attributes
    ----------
    link : the link
    base : point of the link from which its arm goes
    place : of its centre in the axes of the link [m]
    radius : [m]; a sign is drawn where it is None
    name : in the legend
    """

    link: str
    base: str
    place: tuple[float, float]
    radius: float | None
    name: Text


@dataclass(frozen=True)
class LinkageWithDiscs:
    """A linkage in its conventional signs at one sample of its motion, with discs on its links.

    Attributes
    ----------
    title, mechanism : what it shows, and of which mechanism
    description : kinds of its links, joints and drives
    motion : coordinates over all samples, which the window holds
    sample : which of them is drawn
    discs : in the order of the legend
    """

    title: Sentence
    mechanism: Title
    description: Mechanism
    motion: xarray.Dataset
    sample: int
    discs: tuple[CarriedDisc, ...]


@dataclass(frozen=True)
class DesignDot:
    """A design at its place (x, y), filled where it keeps its bounds; one that another panel names has no name."""

    name: Text
    x: float
    y: float
    admissible: bool
    chosen: bool


@dataclass(frozen=True, eq=False)
class FrontPanel:
    """A quantity along the front of best designs.

    Attributes
    ----------
    label : of the vertical axis
    values : (n), in the unit of the label
    dots : designs among them
    levels : values that are marked across
    """

    label: AxisLabel
    values: Array
    dots: tuple[DesignDot, ...]
    levels: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class FrontDiagram:
    """Best designs as a bound moves: what is made best in the first panel, below it what leads to them.

    Attributes
    ----------
    title, mechanism : what it shows, and of which mechanism
    x : what the bound is of
    values : (n) of each design, in the unit of that label
    bound : where the bound stands; None where there is none
    panels : from the top
    """

    title: Sentence
    mechanism: Title
    x: AxisLabel
    values: Array
    bound: float | None
    panels: tuple[FrontPanel, ...]
