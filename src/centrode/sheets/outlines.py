"""Outlines in true size, for machines and viewers, and drawings of a body between its outlines, to one scale.

Coordinates are in metres in the axes of the body. Strokes of layers, signs and places of texts are the renderer's.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.texts import Sentence, Text, Title

if TYPE_CHECKING:
    from centrode.cams.walking_wheel import WheelMover
    from centrode.numerics.outline_pieces import OutlinePiece

Array = NDArray[np.float64]


@dataclass(frozen=True)
class OutlineSet:
    """Outlines of one file.

    Attributes
    ----------
    title : below them
    pieces : smooth pieces with their slopes, in layers
    """

    title: Title
    pieces: tuple[OutlinePiece, ...]


class LineUse(Enum):
    """What lines of a drawing stand for."""

    NORMAL = "normals"
    UNDERCUT = "undercut"
    AXIS = "axis of a motion"
    FOLLOWER = "follower"


@dataclass(frozen=True, eq=False)
class DrawnLines:
    """Lines of one kind: their entry in the legend, none if empty, and each as its places (n, 2).

    A line of one place is a point.
    """

    use: LineUse
    name: Text
    lines: tuple[Array, ...]


@dataclass(frozen=True, eq=False)
class DrawnRollers:
    """Rollers of one radius about places (n, 2), each with a text beside it; their entry in the legend."""

    name: Text
    radius: float
    places: Array
    texts: tuple[Text, ...]


@dataclass(frozen=True, eq=False)
class OutlineRay:
    """A ray from the origin to a place (2) of a curve, a text beyond that, and the other end (2) of a normal there."""

    text: Text
    place: Array
    inwards: Array


@dataclass(frozen=True, eq=False)
class PathDrawing:
    """A curve about the origin, to one scale, with rays to it and normals of it.

    Attributes
    ----------
    title, mechanism : what it shows, and of which mechanism
    places : (n, 2) of the curve
    path, ray, normal : names in the legend
    rays : in drawing order
    """

    title: Sentence
    mechanism: Title
    places: Array
    path: Text
    rays: tuple[OutlineRay, ...]
    ray: Text
    normal: Text


@dataclass(frozen=True)
class DrawnBaseCircle:
    """The base circle of a cam about the origin, its radius [m] and its entry in the legend."""

    name: Text
    radius: float


@dataclass(frozen=True, eq=False)
class MarkedPlaces:
    """Places (n, 2) that are marked, each with a text about a place (n, 2) of its own; their entry in the legend."""

    name: Text
    places: Array
    texts: tuple[Text, ...]
    text_places: Array


@dataclass(frozen=True)
class DrawnTurning:
    """How a body turns: an arrow about the origin, counter-clockwise where `sense` is positive; its radius [m]."""

    radius: float
    sense: float


@dataclass(frozen=True, eq=False)
class DrawnFollower:
    """What a follower consists of beside its lines.

    Attributes
    ----------
    hinge : radius of a hinge's circle [m]
    pivot : (2) of an oscillating follower; None of another
    walls : (2, 2) ends of the middle of its guide; None without one
    tip : (2) centre of the roller, or the edge; None of a flat face
    roller : radius [m]; zero of an edge
    """

    hinge: float
    pivot: Array | None = None
    walls: Array | None = None
    tip: Array | None = None
    roller: float = 0.0


Shape: TypeAlias = DrawnLines | DrawnRollers | DrawnBaseCircle | MarkedPlaces | DrawnTurning | DrawnFollower
"""What a drawing shows beside the outlines."""


@dataclass(frozen=True)
class OutlineDrawing:
    """A body between its outlines, to one scale, with what belongs to it; its centre is the origin.

    Attributes
    ----------
    title, mechanism : what it shows, and of which mechanism
    pieces : outlines in layers
    layers : names of the layers in the legend
    shapes : in drawing order, and that of the legend
    centre : name of the origin, at the end of the legend
    """

    title: Sentence
    mechanism: Title
    pieces: tuple[OutlinePiece, ...]
    layers: Mapping[str, Text]
    shapes: tuple[Shape, ...]
    centre: Text


@dataclass(frozen=True)
class WheelPositions:
    """A walking wheel at some instants.

    Attributes
    ----------
    title, mechanism : what it shows, and of which mechanism
    wheel : the wheel
    turned : angles [rad] by which its carrier has turned
    """

    title: Sentence
    mechanism: Title
    wheel: WheelMover
    turned: tuple[float, ...]
