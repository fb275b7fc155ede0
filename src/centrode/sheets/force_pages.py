"""Pages of forces by hand: a group of links with its force polygon, and Zhukovsky's lever, all to scale."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from centrode.sheets.texts import Sentence, Text

if TYPE_CHECKING:
    from centrode.dynamics.force_polygons.polygons import ForcePolygons


@dataclass(frozen=True)
class GroupPage:
    """A group taken out of its mechanism with the forces on it, its polygon of forces, and a column of texts.

    Attributes
    ----------
    title : what the page shows
    heading : what the group is, above the column
    forces : of the whole mechanism at the instant, with the sheet of paper
    group : number of the group in it
    lines : of the column; the page itself adds every force with its length on paper
    """

    title: Sentence
    heading: Text
    forces: ForcePolygons
    group: int
    lines: tuple[Text, ...]


@dataclass(frozen=True)
class LeverPage:
    """Zhukovsky's lever of one drive with all forces on it, and a column of texts.

    Attributes
    ----------
    title, heading, forces, lines : as of a group
    lever : number of the lever among those of the drives
    """

    title: Sentence
    heading: Text
    forces: ForcePolygons
    lever: int
    lines: tuple[Text, ...]
