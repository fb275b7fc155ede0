"""Drawings to a true scale on pages: numbered positions, a mechanism at an instant, diagrams of its vectors.

A millimetre on paper stands for a round number of units; the renderer chooses it, and says it on the page.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from centrode.sheets.texts import Sentence, Text

if TYPE_CHECKING:
    import xarray

    from centrode.analysis.graphic.diagrams import Diagram, Diagrams
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
class InstantPage:
    """A mechanism at an instant with its instant centres, the velocities of its points and senses of rotation.

    Attributes
    ----------
    title : what it shows
    diagrams : places, velocities, centres and the scale of the mechanism
    lines : below each other in the column at the right
    """

    title: Sentence
    diagrams: Diagrams
    lines: tuple[Text, ...]


@dataclass(frozen=True)
class VectorDiagramPage:
    """A diagram of velocities or accelerations.

    Attributes
    ----------
    title : what it shows
    diagrams, diagram : everything that is drawn of the instant, and the diagram of it that this page has
    lines : below each other in the column at the right
    """

    title: Sentence
    diagrams: Diagrams
    diagram: Diagram
    lines: tuple[Text, ...]
