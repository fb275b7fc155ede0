"""Where everything stands, in the units of the display: what the drawings read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from centrode.model.mechanism import Guide, Link, Mechanism
    from centrode.scenes.driving_cams import DrivingCam

# What every drawing of a motion knows: its points, its corners and its size on paper.

Array = NDArray[np.float64]
SIGN_INCHES = 0.06  # radius of a hinge's circle on paper


@dataclass(frozen=True, kw_only=True)
class MotionPlaces:
    """Places over a motion, ready to draw.

    Attributes
    ----------
    mechanism : Mechanism
        The description.
    tracks : mapping of point -> (sample, axis)
        NaN where a point has no position.
    low, high : (2)
        Corners of the drawing.
    inches : float
        Length on paper of its longer side.
    """

    mechanism: Mechanism
    tracks: Mapping[str, Array]
    low: Array
    high: Array
    inches: float = 6.0

    @property
    def extent(self) -> float:
        """The longer side of the drawing."""
        return float(np.max(self.high - self.low))

    @property
    def sign(self) -> float:
        """Radius of a hinge's circle; the other signs are measured by it."""
        return SIGN_INCHES / self.inches * self.extent

    def at(self, sample: int) -> dict[str, Array]:
        """Places at a sample, of the points that have one."""
        places = {name: track[sample] for name, track in self.tracks.items()}
        return {name: place for name, place in places.items() if np.isfinite(place).all()}


@dataclass(frozen=True)
class View:
    """The part of the plane that pictures show, in drawing units; the same over a whole animation.

    Attributes
    ----------
    low, high : (2)
        Corners of what is shown.
    per_inch : float
        Drawing units to an inch of paper.
    """

    low: Array
    high: Array
    per_inch: float

    @property
    def inches(self) -> float:
        """Length on paper of the longer side of what is shown."""
        return float(np.max(self.high - self.low)) / self.per_inch

    @property
    def sign(self) -> float:
        """Radius of a hinge's circle; the other signs are measured by it."""
        return SIGN_INCHES * self.per_inch


Samples = int | slice
FLATTEST = 0.3  # least ratio of the sides of a drawing


@dataclass(frozen=True, kw_only=True)
class LinkageScene(MotionPlaces):
    """A planar motion on its sheet, in display units of length; points of the frame are rows without change.

    Attributes
    ----------
    turns : mapping of link -> (sample) [rad]
    travels : mapping of guide -> (2) [display unit of length]
        The least and the greatest displacement along the guide.
    factor : float
        Display units of length in a metre.
    cams : tuple of DrivingCam
        The cams that drive it.
    """

    turns: Mapping[str, Array]
    travels: Mapping[str, Array]
    factor: float
    cams: tuple[DrivingCam, ...] = ()

    def carried_places(self, link: str, local: Sequence[float], sample: Samples) -> Array | None:
        """Where a place in a link's own axes is at a sample or samples; nothing if the link has no position."""
        if link == "frame":
            return self.factor * np.asarray(local, dtype=float)
        for name, own in self.mechanism.links[link].coordinates.items():
            offset = turn_vectors(np.subtract(local, own), self.turns[link][sample])
            place = self.tracks[name][sample] + self.factor * offset
            if np.isfinite(place).any():
                return np.asarray(place)
        return None

    def guide_line(self, guide: Guide, sample: Samples) -> tuple[Array, Array] | None:
        """The part of a guide that its point travels, as two ends; nothing if its link has no position."""
        start = self.carried_places(guide.on, self.mechanism.through(guide), sample)
        if start is None:
            return None
        turn = np.zeros(()) if guide.on == "frame" else self.turns[guide.on][sample]
        along = turn_vectors(np.asarray(guide.unit, dtype=float), turn)
        least, most = self.travels[guide.id]
        return start + least * along, start + most * along


def turn_vectors(vector: Array, angle: Array | float) -> Array:
    """A vector turned by an angle, or by each of several."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.stack([cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1]], axis=-1)


def span(values: Array) -> Array:
    """The least and the greatest of the values that exist; zeros if none does."""
    known = values[np.isfinite(values)]
    return np.array([known.min(), known.max()]) if known.size else np.zeros(2)


def box(tracks: Sequence[Array]) -> tuple[Array, Array]:
    """Corners of a box around the places that exist, of a shape that can be drawn: never empty nor very flat."""
    places = np.concatenate([*tracks, np.empty((0, 2))])
    places = places[np.isfinite(places).all(axis=1)]
    if not len(places):
        return np.array([-0.5, -0.5]), np.array([0.5, 0.5])
    low, high = places.min(axis=0), places.max(axis=0)
    extent = float(np.max(high - low)) or max(1.0, float(np.abs(low).max()))
    room = np.maximum(0.0, FLATTEST * extent - (high - low)) / 2
    return low - room, high + room


def corners(link: Link) -> list[str]:
    """The points of a link that its outline passes, around; two for points in a row."""
    names = list(link.coordinates)
    places = np.array([link.coordinates[name] for name in names], dtype=float)
    if len(names) <= 2:
        return names
    order = sorted(range(len(names)), key=lambda k: (places[k, 0], places[k, 1]))
    lower, upper = half_hull(order, places), half_hull(order[::-1], places)
    return [names[k] for k in lower[:-1] + upper[:-1]]


def half_hull(order: list[int], places: Array) -> list[int]:
    """One side of the convex hull of places in order (Andrew's monotone chain)."""
    slack = 1e-9 * float(np.ptp(places, axis=0).max()) ** 2
    chain: list[int] = []
    for k in order:
        while len(chain) >= 2:
            first, second = places[chain[-1]] - places[chain[-2]], places[k] - places[chain[-2]]
            if first[0] * second[1] - first[1] * second[0] > slack:
                break
            chain.pop()
        chain.append(k)
    return chain
