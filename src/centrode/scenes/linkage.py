"""From a motion to the scene that drawings read."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from centrode.model.mechanism import FRAME
from centrode.model.settings import shown_as
from centrode.scenes.places import Array, LinkageScene, Samples, box, span, turn_vectors

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Drive, Gear, Mechanism, Rolling

# what computes cams is not loaded for a linkage without any
_driving_cams = functools.partial(importlib.import_module, "centrode.scenes.driving_cams")

# Where rolling wheels, their tracks and cylinders are drawn, in the units of the display.

BARREL = 0.8  # length of a barrel as a part of the shortest length of its cylinder
OVER = 0.4  # how far a straight track goes on beyond the contacts, in radii of the wheel
CORNERS = 24  # of a polygon that stands for a circle


@dataclass(frozen=True)
class Disc:
    """A circle with the direction of its spoke."""

    centre: Array
    radius: float
    angle: float = 0.0

    @property
    def outline(self) -> Array:
        """Corners around it."""
        turns = np.linspace(0.0, 2.0 * np.pi, CORNERS, endpoint=False)
        return np.asarray(self.centre + self.radius * np.stack([np.cos(turns), np.sin(turns)], axis=1))


def wheel_at(scene: LinkageScene, wheel: Rolling, sample: int) -> Disc | None:
    """A wheel at a sample; nothing if it has no position."""
    centre, angle = scene.tracks[wheel.centre][sample], scene.turns[wheel.link][sample]
    if not np.isfinite(centre).all() or not np.isfinite(angle):
        return None
    return Disc(centre, scene.factor * wheel.radius, float(angle))


def round_track(scene: LinkageScene, wheel: Rolling, sample: int) -> Disc | None:
    """The circle a wheel rolls on; nothing for a line, or where its link has no position."""
    circle = wheel.along.radius
    if circle is None:
        return None
    centre = wheel.along.centre
    local = scene.mechanism.points_of(wheel.on)[centre] if isinstance(centre, str) else centre
    place = scene.carried_places(wheel.on, local or (0.0, 0.0), sample)
    return None if place is None else Disc(place, scene.factor * circle)


def straight_track(scene: LinkageScene, wheel: Rolling, sample: Samples) -> tuple[Array, Array] | None:
    """The part of a line that its wheel rolls over, as two ends in its direction; nothing for a circle."""
    through = wheel.along.through
    if through is None:
        return None
    start = scene.carried_places(wheel.on, through, sample)
    if start is None:
        return None
    way = span(slides(scene, wheel))
    over = OVER * scene.factor * wheel.radius
    along = turn_vectors(np.asarray(wheel.along.unit, dtype=float), heading(scene, wheel, sample))
    return start + (way[0] - over) * along, start + (way[1] + over) * along


def slides(scene: LinkageScene, wheel: Rolling) -> Array:
    """Way of a wheel's centre along its line at every sample."""
    through = scene.carried_places(wheel.on, wheel.along.through or (0.0, 0.0), slice(None))
    along = turn_vectors(np.asarray(wheel.along.unit, dtype=float), heading(scene, wheel, slice(None)))
    centre = scene.tracks[wheel.centre]
    offset = centre - (np.nan * centre if through is None else through)
    return np.asarray(np.sum(offset * along, axis=-1))


def heading(scene: LinkageScene, wheel: Rolling, sample: Samples) -> Array | float:
    """Angle of the link that carries a track."""
    return 0.0 if wheel.on == "frame" else scene.turns[wheel.on][sample]


def cylinders(scene: LinkageScene, sample: int) -> Iterator[tuple[Drive, Array, Array, Array]]:
    """Each cylinder with its foot, the end of its barrel and the end of its rod."""
    for drive in scene.mechanism.drives:
        if drive.distance is None:
            continue
        first, second = (scene.tracks[point] for point in drive.distance)
        shortest = span(np.hypot(*(second - first).T))[0]
        foot, end = first[sample], second[sample]
        length = float(np.hypot(*(end - foot)))
        if np.isfinite(length) and length > 0.0:
            yield drive, foot, foot + BARREL * shortest * (end - foot) / length, end


def reaches(scene: LinkageScene) -> list[Array]:
    """Corners of what wheels and tracks need of the drawing's box."""
    found: list[Array] = []
    for wheel in scene.mechanism.rolling:
        around = scene.factor * wheel.radius * np.array([[-1.0, -1.0], [1.0, 1.0]])
        found += [scene.tracks[wheel.centre] + corner for corner in around]
        line = straight_track(scene, wheel, slice(None))
        found += [] if line is None else [np.atleast_2d(end) for end in line]
        if wheel.along.radius is not None:
            circle = round_track(scene, wheel, 0) if wheel.on == "frame" else None
            found += [] if circle is None else [circle.outline]
    return found


# Pitch circles of meshing wheels, in the units of the display.

COAXIAL = 1e-9
"""Shafts nearer than this share of the drawing are one: no pitch circles tell their ratio."""


def pitch_circles(scene: LinkageScene, sample: int) -> Iterator[tuple[str, Disc]]:
    """Each meshing wheel by its link, with its circle; none of gears whose shafts the carrier does not hold.

    The circles touch where they mesh: r1 omega1 = -+ r2 omega2 against the carrier, the distance of the shafts
    being r1 + r2 or, of a wheel in a ring, the difference.
    """
    for gear in scene.mechanism.gears:
        shafts = [_shaft(scene, gear, link, sample) for link in gear.links]
        if any(shaft is None for shaft in shafts):
            continue
        distance = float(np.hypot(*(shafts[1] - shafts[0])))  # type: ignore[operator]
        if not np.isfinite(distance) or distance < COAXIAL * scene.extent:
            continue
        second = distance / abs(gear.ratio - 1.0)
        for link, shaft, radius in zip(gear.links, shafts, (abs(gear.ratio) * second, second), strict=True):
            assert shaft is not None
            turn = 0.0 if link == FRAME else float(scene.turns[link][sample])
            yield link, Disc(shaft, radius, turn)


def _shaft(scene: LinkageScene, gear: Gear, link: str, sample: int) -> Array | None:
    """Where a wheel turns on the carrier: the point that both have."""
    held = scene.mechanism.points_of(gear.carrier)
    shared = [point for point in scene.mechanism.points_of(link) if point in held]
    return scene.tracks[shared[0]][sample] if shared else None


def scene_of(mechanism: Mechanism, dataset: xarray.Dataset) -> LinkageScene:
    """Read a motion for drawing.

    Parameters
    ----------
    mechanism : Mechanism
        The description, with every "placed" resolved.
    dataset : Dataset
        Its motion, without batch dimensions.
    """
    factor = shown_as("m", mechanism.display)[0]
    samples = dataset.sizes["sample"]
    tracks = {
        name: np.tile(factor * np.asarray(place, dtype=float), (samples, 1))
        for name, place in mechanism.frame.coordinates.items()
    }
    for name in dataset["point"].values.tolist():
        if name not in tracks:
            tracks[name] = factor * dataset["position"].sel(point=name).values
    turns = {name: dataset["angle"].sel(link=name).values for name in dataset["link"].values.tolist()}
    travels = {
        guide.id: factor * span(dataset["slide"].sel(guide=guide.id).values) for guide in mechanism.guides
    }
    low, high = box(list(tracks.values()))
    led_by_cam = any(drive.cam is not None for drive in mechanism.drives)
    scene = LinkageScene(
        mechanism=mechanism,
        tracks=tracks,
        turns=turns,
        travels=travels,
        low=low,
        high=high,
        factor=factor,
        cams=_driving_cams().driving_cams(mechanism, dataset, factor) if led_by_cam else (),
    )
    lines = [scene.guide_line(guide, slice(None)) for guide in mechanism.guides if guide.on != "frame"]
    ends = [end for line in lines if line is not None for end in line]
    rims = [disc.outline for sample in range(samples) for _link, disc in pitch_circles(scene, sample)]
    cams = [cam.reach() for cam in scene.cams]
    low, high = box([*tracks.values(), *ends, *reaches(scene), *rims, *cams])
    return replace(scene, low=low, high=high)
