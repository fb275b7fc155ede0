"""Drawings on sheets of paper with a title block: what stands on each of them, as data.

The renderer places the drawings, chooses their scales from the standard ones, and says them below each drawing.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.force_pages import GroupPage, LeverPage
from centrode.sheets.pages import PositionsPage, VectorDiagramPage
from centrode.sheets.plots import AxisLabel
from centrode.sheets.texts import Sentence, Text

if TYPE_CHECKING:
    from centrode.model.settings import Display

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
    course : the subject taught, below the designation
    """

    designation: str
    title: str
    author: str
    teacher: str
    organisation: tuple[str, ...]
    course: str = ""


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


class LineLook(Enum):
    """How a line of a geometric drawing is drawn."""

    MAIN = "main"
    THIN = "thin"
    DASHED = "dashed"
    CHAIN = "chain"


@dataclass(frozen=True, eq=False)
class GeometryLine:
    """A line through places (n, 2) [m]; with a `head` it ends in an arrow."""

    places: Array
    look: LineLook = LineLook.THIN
    head: bool = False


@dataclass(frozen=True)
class GeometryCircle:
    """A circle about a centre, lengths in metres."""

    centre: tuple[float, float]
    radius: float
    look: LineLook = LineLook.THIN


@dataclass(frozen=True)
class GeometryName:
    """A text near a place [m], with a dot on the place where it is `dotted`."""

    place: tuple[float, float]
    text: Text
    dotted: bool = False


@dataclass(frozen=True)
class GeometryAngle:
    """An angle between two directions [rad] at a place [m], with its name; its arc has a radius [m]."""

    apex: tuple[float, float]
    first: float
    last: float
    radius: float
    text: Text


@dataclass(frozen=True)
class GeometryFrame:
    """What belongs to the frame: hinges [m], and the middle line of a guide between two places [m], or none.

    `sense` is that in which the body on the first hinge turns, +1 counter-clockwise; 0 without an arrow.
    """

    hinges: tuple[tuple[float, float], ...]
    guide: tuple[tuple[float, float], tuple[float, float]] | None = None
    sense: float = 0.0


@dataclass(frozen=True)
class GeometricDrawing:
    """A drawing of lengths in a plane at one standard scale.

    Attributes
    ----------
    title : what it shows
    lines, circles, names, angles : in drawing order
    frame : hinges and a guide, or none
    """

    title: Sentence
    lines: tuple[GeometryLine, ...]
    circles: tuple[GeometryCircle, ...] = ()
    names: tuple[GeometryName, ...] = ()
    angles: tuple[GeometryAngle, ...] = ()
    frame: GeometryFrame | None = None


@dataclass(frozen=True)
class ProfileSheet:
    """A profile, of a cam or of teeth, from what it is to do.

    Attributes
    ----------
    name : of the sheet
    diagrams : one below the other: of a cam lift, velocity and acceleration coefficients of its follower; of gears
        sliding and pressure
    choice : what decides the profile: the least radius of a cam, as a drawing of lengths or a diagram of a radius of
        curvature; the rack that generates teeth
    profile : a cam with its follower in numbered positions of the inverted motion; teeth in mesh
    facts : what is given and what follows, each as a text with its value
    display : units of the facts
    """

    name: Sentence
    diagrams: tuple[ScaledDiagram, ...]
    choice: GeometricDrawing | ScaledDiagram
    profile: GeometricDrawing
    facts: tuple[tuple[Text, Text], ...]
    display: Display


DrawingSheet: TypeAlias = MotionSheet | DiagramSheet | VectorSheet | EnergySheet | ForceSheet | ProfileSheet


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
