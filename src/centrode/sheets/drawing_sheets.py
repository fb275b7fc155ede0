"""Drawings on sheets of paper with a title block: what stands on each of them, as data.

The renderer places the drawings, chooses their scales from the standard ones, and says them below each drawing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.force_pages import GroupPage, LeverPage
from centrode.sheets.pages import PositionsPage, VectorDiagramPage
from centrode.sheets.plots import AxisLabel
from centrode.sheets.texts import Sentence, Text

Array: TypeAlias = NDArray[np.float64]


@dataclass(frozen=True)
class TitleBlock:
    """What a title block says besides the number, the name and the scale of its sheet; empty what nobody gave.

    Attributes
    ----------
    designation : of the whole work; the renderer appends the number of the sheet
    title : of the work
    author, teacher : who drew and who checked
    organisation : lines of the lower right field
    """

    designation: str
    title: str
    author: str
    teacher: str
    organisation: tuple[str, ...]


@dataclass(frozen=True)
class ScaledCurve:
    """A curve of a diagram.

    Attributes
    ----------
    name : beside it; nothing where the axis says it
    across, up : (n), in the SI units of the axes
    """

    name: Text
    across: Array
    up: Array


@dataclass(frozen=True)
class ScaledDiagram:
    """Curves over an axis that starts at zero, drawn to round scales of both axes.

    Attributes
    ----------
    title : what it shows
    across, up : the axes; their symbols index the scales
    curves : over each other
    ticks : (m) places of numbered positions on the axis across, counted from 0
    """

    title: Sentence
    across: AxisLabel
    up: AxisLabel
    curves: tuple[ScaledCurve, ...]
    ticks: tuple[float, ...] = ()


@dataclass(frozen=True)
class EnergyMassDiagram:
    """Wittenbauer's diagram with the two diagrams that it is drawn from.

    Attributes
    ----------
    work : work of drive and loads over the turn of the drive, T
    inertia : reduced inertia of the links over the turn of the drive, J
    energy_mass : T over J
    slopes, intercepts : of the tangents of the least and of the greatest speed [rad^2/s^2], [J], or none
    touching : (J, T) where they touch [kg m^2], [J]
    needed : inertia [kg m^2] that the tangents give; None without a flywheel
    """

    work: ScaledDiagram
    inertia: ScaledDiagram
    energy_mass: ScaledDiagram
    slopes: tuple[float, ...] = ()
    intercepts: tuple[float, ...] = ()
    touching: tuple[tuple[float, float], ...] = ()
    needed: float | None = None


@dataclass(frozen=True)
class MotionSheet:
    """Mechanism in its positions, diagrams of its output, plans of velocities and accelerations at some instants."""

    name: Sentence
    positions: PositionsPage
    diagrams: tuple[ScaledDiagram, ...]
    plans: tuple[VectorDiagramPage, ...]


@dataclass(frozen=True)
class DiagramSheet:
    """Diagrams of the output alone, below each other: of a linkage on the sphere, which has no plan of positions."""

    name: Sentence
    diagrams: tuple[ScaledDiagram, ...]


@dataclass(frozen=True)
class VectorSheet:
    """Plans of velocities and accelerations at several instants."""

    name: Sentence
    plans: tuple[VectorDiagramPage, ...]


@dataclass(frozen=True)
class EnergySheet:
    """Diagrams of moments and works, and the energy-mass diagram."""

    name: Sentence
    diagrams: tuple[ScaledDiagram, ...]
    energy_mass: EnergyMassDiagram


@dataclass(frozen=True)
class ForceSheet:
    """Groups with the forces on them and their force polygons; Zhukovsky's levers."""

    name: Sentence
    groups: tuple[GroupPage | LeverPage, ...]


DrawingSheet: TypeAlias = MotionSheet | DiagramSheet | VectorSheet | EnergySheet | ForceSheet


@dataclass(frozen=True)
class DrawingSet:
    """The sheets of one work with what their title blocks share.

    Attributes
    ----------
    block : of all sheets
    sheets : in their order
    missing : why sheets are missing that the description asks for
    absent : drawings that there are none of for a mechanism of this kind; empty where it has all
    """

    block: TitleBlock
    sheets: tuple[DrawingSheet, ...]
    missing: tuple[str, ...] = ()
    absent: str = ""
