"""Pages of forces by hand: a group of links with its force polygon, and Zhukovsky's lever, all to scale.

Places, forces and ends are complex numbers, in metres and newtons; on the lever places are its own.
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
class ForceSign:
    """A force or a moment where it acts.

    Attributes
    ----------
    name : R12, G2, MΦ2
    place : where it acts
    force, moment : [N], [N m]; of a moment the force is nothing
    link : in whose colour it is drawn; empty of none
    """

    name: str
    place: complex
    force: complex = 0j
    moment: float = 0.0
    link: str = ""


@dataclass(frozen=True)
class ForceStroke:
    """A force in a polygon.

    Attributes
    ----------
    name : R12ᵗ, G2, Φ2
    start, force : where its arrow begins, and its components [N]
    kind : "force"; "part", normal or tangential, of a reaction; "sum" of two parts; "chord" of an inner reaction
    whole : of a part, the name of its reaction
    link : in whose colour it is drawn; empty of none
    """

    name: str
    start: complex
    force: complex
    kind: str
    whole: str = ""
    link: str = ""

    @property
    def end(self) -> complex:
        """Where its arrow ends [N]."""
        return self.start + self.force


@dataclass(frozen=True)
class DrawnPolygon:
    """A force polygon.

    Attributes
    ----------
    strokes : forces one behind the other, then sums, then chords
    scale : newtons that a millimetre stands for
    number : of the link that it belongs to, where links have polygons of their own
    """

    strokes: tuple[ForceStroke, ...]
    scale: float
    number: int = 0


@dataclass(frozen=True)
class GuideSign:
    """A guide of a group: its direction, whether its line is of the group, and the number of the slider that is."""

    guide: str
    along: complex
    has_line: bool
    slider: int | None


@dataclass(frozen=True)
class ConstructionPoint:
    """A special point of a construction, and the hinges whose lines meet there."""

    name: str
    place: complex
    hinges: tuple[complex, ...]


@dataclass(frozen=True)
class GroupPage:
    """A group taken out of its mechanism with the forces on it, its polygon of forces, and a column of texts.

    Attributes
    ----------
    title : what the page shows
    heading : what the group is, above the column
    mechanism, instant : whose group, and its motion at the instant
    paper : width and height of the sheet [mm]
    bodies : number and name of its links and sliders
    hinges : points of its hinges; `pins` those that are drawn as hinges
    guides, marks : what else is drawn of its joints, and of the construction
    forces, moments : what acts on it
    polygons : of the group; of its links where they are solved together
    together : whether all its links are solved at once
    sizes : name and size [N] of every force
    corners : least and greatest of the places that the drawing has to hold
    all_corners : those of the whole mechanism, where the group lies in one place
    lines : of the column; the page adds the sizes with their lengths on paper
    """

    title: Sentence
    heading: Text
    mechanism: Mechanism
    instant: xarray.Dataset
    paper: tuple[float, float]
    bodies: tuple[tuple[int, str], ...]
    hinges: tuple[str, ...]
    pins: frozenset[str]
    guides: tuple[GuideSign, ...]
    marks: tuple[ConstructionPoint, ...]
    forces: tuple[ForceSign, ...]
    moments: tuple[ForceSign, ...]
    polygons: tuple[DrawnPolygon, ...]
    together: bool
    sizes: tuple[tuple[str, float], ...]
    corners: tuple[complex, complex]
    all_corners: tuple[complex, complex]
    lines: tuple[Text, ...]


@dataclass(frozen=True)
class LeverPage:
    """Zhukovsky's lever of one drive with all forces on it, and a column of texts.

    Attributes
    ----------
    title, heading, mechanism, instant, paper, lines : as of a group
    drive : whose lever
    unit : of moments about its pole
    corners : least and greatest of its places
    images : point -> its place on the lever, from the pole
    forces, moments : what acts on it
    """

    title: Sentence
    heading: Text
    mechanism: Mechanism
    instant: xarray.Dataset
    paper: tuple[float, float]
    drive: str
    unit: str
    corners: tuple[complex, complex]
    images: Mapping[str, complex]
    forces: tuple[ForceSign, ...]
    moments: tuple[ForceSign, ...]
    lines: tuple[Text, ...]
