"""A spherical motion on its sheet: the sphere seen from far away, places on paper, curves in the axes of bodies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from centrode.model.labels import sliders_of
from centrode.model.values import unit_vector
from centrode.scenes.places import MotionPlaces, box

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Guide, Mechanism

Array = NDArray[np.float64]
STEPS = 48  # pieces of an arc on paper
WHOLE = 0.7  # extent of a linkage from which on the whole sphere is drawn
ABOVE = np.array([0.55, 0.35, 0.45])  # added to the direction of sight: a view straight on shows no depth


@dataclass(frozen=True, kw_only=True)
class Globe(MotionPlaces):
    """A spherical motion on its sheet; the tracks are unit vectors (sample, 3).

    Attributes
    ----------
    view : (3, 3)
        To the right, up and towards the eye, as rows.
    """

    view: Array

    def flat(self, places: Array) -> Array:
        """Places on paper (..., 2) of unit vectors (..., 3)."""
        return np.asarray(places @ self.view[:2].T)

    def in_front(self, places: Array) -> NDArray[np.bool_]:
        """Whether places lie on the side of the sphere that is seen."""
        return np.asarray(places @ self.view[2] >= 0.0)

    def carried_places(self, link: str, local: Array, sample: int) -> Array | None:
        """Where places (..., 3) in a link's own axes are; nothing if it has no position, or one point alone."""
        if link == "frame":
            return local
        inside = [np.array(unit_vector(at)) for at in self.mechanism.links[link].coordinates.values()]
        outside = [self.tracks[name][sample] for name in self.mechanism.links[link].coordinates]
        if len(inside) < 2 or not np.isfinite(outside[:2]).all():
            return None
        turned = np.column_stack(_three(outside)) @ np.linalg.inv(np.column_stack(_three(inside)))
        return np.asarray(local @ turned.T)

    def circle(self, guide: Guide, sample: int) -> Array | None:
        """The circle of a guide (steps, 3); nothing if the link that carries it has no position."""
        pole = guide.pole
        if isinstance(pole, str):
            pole = self.mechanism.points_of(guide.on)[pole]
        centre = self.carried_places(guide.on, np.array(unit_vector(pole)), sample)  # type: ignore[arg-type]
        if centre is None:
            return None
        across = np.cross(centre, np.eye(3)[int(np.argmin(np.abs(centre)))])
        across /= np.linalg.norm(across)
        turn = np.linspace(0.0, 2.0 * np.pi, 4 * STEPS + 1)[:, None]
        ring = np.cos(turn) * across + np.sin(turn) * np.cross(centre, across)
        return np.asarray(np.cos(guide.arc) * centre + np.sin(guide.arc) * ring)


def _three(places: Sequence[Array]) -> list[Array]:
    return [places[0], places[1], np.cross(places[0], places[1])]


def great_arc(start: Array, end: Array) -> Array:
    """The shorter great arc between two places (steps, 3)."""
    angle = np.arctan2(np.linalg.norm(np.cross(start, end)), start @ end)
    share = np.linspace(0.0, 1.0, STEPS + 1)[:, None]
    if angle < 1e-12:
        return np.repeat(start[None], STEPS + 1, axis=0)
    return np.asarray((np.sin((1 - share) * angle) * start + np.sin(share * angle) * end) / np.sin(angle))


def globe_of(mechanism: Mechanism, dataset: xarray.Dataset) -> Globe:
    """Read a spherical motion for drawing: seen so that most of it lies in front."""
    names = dataset["point"].values.tolist()
    tracks = {name: dataset["position"].sel(point=name).values for name in names}
    samples = dataset.sizes["sample"]
    for name, place in mechanism.frame.coordinates.items():
        tracks[name] = np.tile(unit_vector(place), (samples, 1))
    view = view_of(tracks)
    low, high = box([places @ view[:2].T for places in tracks.values()])
    if float(np.max(high - low)) > WHOLE:
        low, high = np.array([-1.0, -1.0]), np.array([1.0, 1.0])
    return Globe(mechanism=mechanism, tracks=tracks, view=view, low=low, high=high)


def whole(globe: Globe) -> Globe:
    """The same with the whole sphere in view: axes lie anywhere on it."""
    return replace(globe, low=np.array([-1.0, -1.0]), high=np.array([1.0, 1.0]))


def view_of(tracks: Mapping[str, Array]) -> Array:
    """To the right, up and towards the eye: over the middle of what moves, with the poles upright."""
    places = np.concatenate([*tracks.values(), np.empty((0, 3))])
    places = places[np.isfinite(places).all(axis=1)]
    middle = places.mean(axis=0) if len(places) else np.zeros(3)
    spread = float(np.abs(places - middle).max()) if len(places) else 1.0
    eye = middle + min(spread, 1.0) * 0.5 * ABOVE
    eye = eye / np.linalg.norm(eye) if np.linalg.norm(eye) > 1e-3 else ABOVE / np.linalg.norm(ABOVE)
    upright = np.array([0.0, 0.0, 1.0]) if abs(eye[2]) < 0.95 else np.array([0.0, 1.0, 0.0])
    right = np.cross(upright, eye)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(eye, right), eye])


def laid(globe: Globe, body: str, curve: Array, sample: int) -> Array | None:
    """A curve in the axes of a body (samples, 3) as it lies at a sample; nothing where the body has no position."""
    guide = sliders_of(globe.mechanism).get(body)
    if guide is None:
        return globe.carried_places(body, curve, sample)
    pole = guide.pole
    if isinstance(pole, str):
        pole = globe.mechanism.points_of(guide.on)[pole]
    inside = unit_vector(pole)  # type: ignore[arg-type]
    longitude, latitude = pole  # type: ignore[misc]
    north = np.array(unit_vector((longitude, latitude + np.pi / 2)))
    frame = globe.carried_places(guide.on, np.eye(3), sample)
    if frame is None:
        return None
    point = frame @ globe.tracks[guide.point][sample]
    angle = np.arctan2(point @ np.cross(inside, north), point @ north)
    axis = np.array(inside)
    turned = (
        np.cos(angle) * curve
        + np.sin(angle) * np.cross(axis, curve)
        + (1.0 - np.cos(angle)) * (curve @ axis)[:, None] * axis
    )
    return globe.carried_places(guide.on, turned, sample)
