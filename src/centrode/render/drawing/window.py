"""A drawing of a mechanism with curves that may run far out: its window, its size on paper, places of its bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes

from centrode.model.labels import sliders_of
from centrode.render.drawing.linkage import MARGIN
from centrode.scenes.places import Array, LinkageScene, turn_vectors

BEYOND = 1.0
"""How far out of the mechanism's box other places are shown, as a part of its extent."""


def widen(scene: LinkageScene, places: Array, room: tuple[float, float]) -> LinkageScene:
    """The scene with a box that also holds the places not too far out, at its size in so many inches."""
    reach = BEYOND * scene.extent
    low, high = scene.low - reach, scene.high + reach
    with np.errstate(invalid="ignore"):
        near = places[((places > low) & (places < high)).all(axis=1)]
    corners = np.concatenate([near, [scene.low, scene.high]])
    wide = replace(scene, low=corners.min(axis=0), high=corners.max(axis=0))
    size = (wide.high - wide.low) / wide.extent + 2 * MARGIN
    return replace(wide, inches=float(np.min(np.array(room) / size)))


def within(axes: Axes, place: Array) -> bool:
    """Whether a place lies inside the axes."""
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    return bool(left <= place[0] <= right and bottom <= place[1] <= top)


def carried_by(scene: LinkageScene, body: str, local: Array, sample: int) -> Array:
    """Places (n, 2) [m] in the axes of a body, where they are at a sample, in the units of the display."""
    shown = scene.factor * local
    if body == "frame":
        return np.asarray(shown)
    guide = sliders_of(scene.mechanism).get(body)
    if guide is None:
        point, own = next(iter(scene.mechanism.links[body].coordinates.items()))
        anchor, angle = scene.tracks[point][sample], scene.turns[body][sample]
        shown = shown - scene.factor * np.array(own)
    else:
        anchor = scene.tracks[guide.point][sample]
        angle = 0.0 if guide.on == "frame" else scene.turns[guide.on][sample]
    return np.asarray(anchor + turn_vectors(shown.T, angle))


def segments_of(curves: Sequence[Array]) -> list[tuple[Array, Array]]:
    """Curves as segments for names to keep clear of, not more than some hundred each."""
    found: list[tuple[Array, Array]] = []
    for curve in curves:
        known = curve[np.isfinite(curve).all(axis=1)]
        thin = known[:: max(1, len(known) // 200)]
        found += list(pairwise(thin))
    return found
