"""Drawings to a true scale on pages: numbered positions, a mechanism at an instant, diagrams of its vectors.

A millimetre on paper stands for a round number of units; the renderer chooses it, and says it on the page.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from centrode.sheets.texts import Sentence, Text

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism


@dataclass(frozen=True)
class PositionsPage:
    """A mechanism in numbered positions over each other, with the paths of its points.

    Attributes
    ----------
    title : what it shows
    mechanism : kinds of its links, joints and drives
    positions, path : the motion at the positions, the first drawn in full; and the motion in between
    numbered : points beside whose places the numbers stand
    note : above the list of the positions
    """

    title: Sentence
    mechanism: Mechanism
    positions: xarray.Dataset
    path: xarray.Dataset
    numbered: tuple[str, ...]
    note: Text


@dataclass(frozen=True)
class MovingPoint:
    """Where a point is [m] and how fast it moves [m/s], or its acceleration [m/s^2], as complex numbers."""

    point: str
    place: complex
    rate: complex


@dataclass(frozen=True)
class CentreOfLink:
    """The instant centre of a link [m], and the places of its points, whose perpendiculars meet there."""

    link: str
    place: complex
    points: tuple[complex, ...]


@dataclass(frozen=True)
class InstantPage:
    """A mechanism at an instant with its instant centres, the velocities of its points and senses of rotation.

    Attributes
    ----------
    title : what it shows
    mechanism : kinds of its links, joints and drives
    instant, course : the motion at the instant, and all of it: slots are as long as their pins travel
    scale : metres that a millimetre stands for
    finest : least velocity [m/s] that a millimetre may stand for
    velocities : of the points that move
    centres : of the links that turn
    senses : link -> whether it turns counter-clockwise
    lines : below each other in the column at the right
    """

    title: Sentence
    mechanism: Mechanism
    instant: xarray.Dataset
    course: xarray.Dataset
    scale: float
    finest: float
    velocities: tuple[MovingPoint, ...]
    centres: tuple[CentreOfLink, ...]
    senses: Mapping[str, bool]
    lines: tuple[Text, ...]


@dataclass(frozen=True)
class InstantsPage:
    """A mechanism at several instants in one drawing, with instant centres, velocities and accelerations.

    Attributes
    ----------
    title : what it shows
    mechanism : kinds of its links, joints and drives
    instants : what each shows, in their order
    accelerations : of the points that move [m/s^2], at each instant
    lines : below each other in the column at the right
    """

    title: Sentence
    mechanism: Mechanism
    instants: tuple[InstantPage, ...]
    accelerations: tuple[tuple[MovingPoint, ...], ...]
    lines: tuple[Text, ...]


@dataclass(frozen=True)
class DiagramStroke:
    """A part of a vector equation, drawn between two ends, as complex numbers from the pole.

    Attributes
    ----------
    kind : "relative", "normal", "tangential", ...: which part it is; an "image" joins the images of a link's points
    name : of which points: "BA" of B against A, "C" of C along its guide
    link : in whose colour it is drawn; empty of none
    """

    start: complex
    end: complex
    kind: str
    name: str
    link: str


@dataclass(frozen=True)
class VectorDiagramPage:
    """A diagram of velocities or accelerations.

    Attributes
    ----------
    title : what it shows
    mechanism, instant : whose, and its motion at the instant
    order : 1 of velocities, 2 of accelerations
    unit : SI unit of its vectors
    scale : what a millimetre stands for, in that unit
    corners : least and greatest of what the whole diagram needs
    strokes : parts of vector equations and images of links
    images : the points' names in small letters, and where their vectors from the pole end
    lines : below each other in the column at the right
    """

    title: Sentence
    mechanism: Mechanism
    instant: xarray.Dataset
    order: int
    unit: str
    scale: float
    corners: tuple[complex, complex]
    strokes: tuple[DiagramStroke, ...]
    images: tuple[tuple[str, complex], ...]
    lines: tuple[Text, ...]
