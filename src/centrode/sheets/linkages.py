"""A mechanism itself: drawn at instants, with the paths of its points, in motion; data without a look."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from centrode.sheets.texts import Sentence

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism
    from centrode.sheets.plots import Abscissa


@dataclass(frozen=True)
class MechanismPicture:
    """A mechanism at instants side by side; without any in its initial position, over fading pictures of its motion.

    Attributes
    ----------
    title : what it shows
    mechanism : kinds of its links, joints and drives
    motion : its motion, without batch dimensions
    values : instants [rad, m or s]; each is shown at the nearest sample
    instants : the motion exactly there; None where the samples of the motion have to do
    captioned : each drawing says which instant it shows
    """

    title: Sentence
    mechanism: Mechanism
    motion: xarray.Dataset
    values: tuple[float, ...] = ()
    instants: xarray.Dataset | None = None
    captioned: bool = True


@dataclass(frozen=True)
class SchemePicture:
    """The kinematic scheme of a mechanism with numbers of links, dimensions and the arrow of the drive.

    Attributes
    ----------
    title : what it shows, and where
    mechanism, motion : of which motion, without batch dimensions
    sample : of the motion, that is drawn
    changed : link, or the frame, whose dimensions are set off; none if empty
    """

    title: Sentence
    mechanism: Mechanism
    motion: xarray.Dataset
    sample: int
    changed: str = ""


@dataclass(frozen=True)
class SchemePair:
    """Two kinematic schemes side by side to one scale, marked a) and b), with one key of the links.

    Attributes
    ----------
    title : what they show
    schemes : of mechanisms with the same links
    """

    title: Sentence
    schemes: tuple[SchemePicture, SchemePicture]


@dataclass(frozen=True)
class PathsPicture:
    """Paths of the points of a mechanism, with the mechanism faint in its initial position.

    Attributes
    ----------
    title : what it shows
    mechanism, motion : of which motion
    points : whose paths
    abscissa : order of the samples, gaps between them, and which of them are cut off
    """

    title: Sentence
    mechanism: Mechanism
    motion: xarray.Dataset
    points: tuple[str, ...]
    abscissa: Abscissa
