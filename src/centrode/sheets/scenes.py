"""Scenes: a linkage in its conventional signs, with marks, lines and curves about it; coordinates and kinds alone.

Coordinates are in metres in the axes of the frame, on the sphere unit vectors. Where something is written, how far a
line goes on and what the window holds is for the renderer to say.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.texts import Sentence, Text, Title

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Linkage:
    """A linkage at one sample of its motion.

    Attributes
    ----------
    description : kinds of its links, joints and drives
    motion : coordinates over all samples, which the window holds
    sample : which of them is drawn; the one nearest to the initial position that shows `Scene.contact` if None
    """

    description: Mechanism
    motion: xarray.Dataset
    sample: int | None = None


class MarkKind(Enum):
    """What a mark stands for."""

    CENTRE = "instant centre"
    POLE = "pole"


@dataclass(frozen=True, eq=False)
class Mark:
    """A place that is marked and named.

    Attributes
    ----------
    place : (2) or (3)
    kind, name : what it is, and what is written beside it
    either_end : one end of an axis through the centre of the sphere; the other one may be drawn in its place
    """

    place: Array
    kind: MarkKind
    name: Text
    either_end: bool = False


class LineKind(Enum):
    """What a straight line (on the sphere a great circle) stands for."""

    CONSTRUCTION = "construction"
    RADIUS = "radius of curvature"


@dataclass(frozen=True)
class StraightLine:
    """A line between the outermost of some places, whether they are marked or not.

    Attributes
    ----------
    through : the places
    direction : (2) unit vector along which the line goes on to the edge; it ends at its places if None
    """

    through: tuple[Mark, ...]
    kind: LineKind
    direction: Array | None = None


class CurveKind(Enum):
    """What a curve stands for."""

    FIXED = "fixed centrode"
    MOVING = "moving centrode"
    INFLECTION = "inflection circle"
    STATIONARY = "cubic of stationary curvature"


@dataclass(frozen=True)
class CarriedCurve:
    """A curve in the axes of a body, drawn where that body is.

    Attributes
    ----------
    body : its name
    places : (n, 2) or (n, 3) in the axes of the body; NaN where it is not there
    pieces : (n) number of the piece; nothing joins one piece to the next, -1 is left out
    """

    kind: CurveKind
    body: str
    places: Array
    pieces: NDArray[np.intp]


@dataclass(frozen=True)
class SceneNote:
    """A line of text beside a scene.

    Attributes
    ----------
    mark : what it is about; where the picture does not show that, the line says so. None if it has no place
    always : write it although the picture shows its mark
    """

    text: Text
    mark: Mark | None = None
    always: bool = True


class ChordKind(Enum):
    """How a centre was found that a chord of a circle diagram stands for."""

    PRIMARY = "shown by a joint"
    CONSTRUCTED = "constructed"
    FIELD = "from the velocity field"


@dataclass(frozen=True)
class CircleDiagram:
    """Bodies on a circle, a chord for each centre.

    Attributes
    ----------
    bodies : name of each body, and what it is called
    chords : numbers of two bodies, and how their centre was found
    """

    bodies: tuple[tuple[str, Text], ...]
    chords: tuple[tuple[tuple[int, int], ChordKind], ...]


@dataclass(frozen=True)
class Scene:
    """A linkage with what belongs to it at an instant.

    Attributes
    ----------
    title, mechanism : what it shows, and of which mechanism
    marks, lines, curves : in drawing order
    legend : kinds that are explained beside the picture, and how
    contact : name of the place where the last curve touches the first at the sample; none if None
    diagram, notes : at the side
    """

    title: Sentence
    mechanism: Title
    linkage: Linkage
    marks: tuple[Mark, ...] = ()
    lines: tuple[StraightLine, ...] = ()
    curves: tuple[CarriedCurve, ...] = ()
    legend: tuple[tuple[MarkKind | LineKind | CurveKind, Text], ...] = ()
    contact: Text | None = None
    diagram: CircleDiagram | None = None
    notes: tuple[SceneNote, ...] = ()
