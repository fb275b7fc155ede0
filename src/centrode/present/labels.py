"""Which side of a point its name goes to, so that it covers no line, no point and no other name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SIDES = 16
RINGS = (1.0, 1.35, 1.7)  # distances from the point; a nearer place is better
WIDE = 0.62  # width of a letter as a part of the height of the text


def label_places(
    anchors: Mapping[str, Array],
    segments: Sequence[tuple[Array, Array]],
    offset: float,
    height: float,
    given: Sequence[tuple[Array, str]] = (),
) -> dict[str, Array]:
    """Centres of the names' texts.

    Parameters
    ----------
    anchors : mapping of name -> (2)
        The points to be named.
    segments : sequence of pairs of (2)
        Lines that a name should not cover.
    offset, height : float
        Distance of a name from its point and height of the text, in the drawing's units.
    given : sequence of (centre, text)
        Texts that already stand.
    """
    around, ring = _directions()
    taken = [spots(np.asarray(centre)[None], text, height)[0] for centre, text in given]
    places: dict[str, Array] = {}
    for name, anchor in anchors.items():
        candidates = anchor + _offsets(name, offset, height)
        tests = spots(candidates, name, height)
        others = [place for other, place in anchors.items() if other != name]
        cost = 0.15 * (ring - 1.0) + crowding(distances(tests, segments), 0.75 * height)
        cost += crowding(gaps(tests, others), 0.9 * height)
        cost += 2.0 * crowding(gaps(tests, list(np.concatenate(taken)) if taken else []), 1.1 * height)
        cost += 0.03 * np.sum(around @ leaving(anchor, segments, 0.1 * height).T, axis=1)
        best = int(np.argmin(np.round(cost, 6)))
        places[name] = candidates[best]
        taken.append(tests[best])
    return places


def steady_offsets(
    moments: Sequence[tuple[Mapping[str, Array], Sequence[tuple[Array, Array]]]], offset: float, height: float
) -> dict[str, Array]:
    """Where names stand beside points that move: for each point one offset that is best over all moments.

    Parameters
    ----------
    moments : sequence of (anchors, segments)
        Each as `label_places` takes them; a point may be missing in some.
    offset, height : float
        As there.
    """
    ring = _directions()[1]
    found: dict[str, Array] = {}
    for name in dict.fromkeys(name for anchors, _segments in moments for name in anchors):
        candidates = _offsets(name, offset, height)
        cost = 0.15 * (ring - 1.0)
        present = [one for one in moments if name in one[0]]
        for anchors, segments in present:
            tests = spots(anchors[name] + candidates, name, height)
            others = [place for other, place in anchors.items() if other != name]
            taken = [
                place
                for other, apart in found.items()
                if other in anchors
                for place in spots((anchors[other] + apart)[None], other, height)[0]
            ]
            near = crowding(distances(tests, segments), 0.75 * height)
            near += crowding(gaps(tests, others), 0.9 * height) + 2.0 * crowding(
                gaps(tests, taken), 1.1 * height
            )
            cost = cost + near / len(present)
        found[name] = candidates[int(np.argmin(np.round(cost, 6)))]
    return found


def _directions() -> tuple[Array, Array]:
    """Unit vectors around a point, and which ring of distances each belongs to."""
    turns = np.pi / 2 + 2 * np.pi * np.arange(SIDES) / SIDES
    around = np.tile(np.stack([np.cos(turns), np.sin(turns)], axis=1), (len(RINGS), 1))
    return around, np.repeat(RINGS, SIDES)


def _offsets(name: str, offset: float, height: float) -> Array:
    """Centres of a name's text about its point: a long name stands further off sideways than above and below."""
    around, ring = _directions()
    half = 0.5 * WIDE * height * len(name)
    reach = offset * ring + np.maximum(0.0, half - 0.3 * height) * np.abs(around[:, 0])
    return np.asarray(reach[:, None] * around)


def leaving(anchor: Array, segments: Sequence[tuple[Array, Array]], slack: float) -> Array:
    """Unit vectors along the segments that end at a point, away from it: (segments, 2)."""
    ends = [(second - first, first) for first, second in segments]
    ends += [(first - second, second) for first, second in segments]
    found = [
        along / np.hypot(*along)
        for along, end in ends
        if np.hypot(*(end - anchor)) < slack < np.hypot(*along)
    ]
    return np.array(found).reshape(-1, 2)


def spots(centres: Array, text: str, height: float) -> Array:
    """Places along a text that must be free: (candidates, spots, 2)."""
    letters = np.arange(len(text)) - (len(text) - 1) / 2
    shifts = np.stack([WIDE * height * letters, np.zeros(len(text))], axis=1)
    return np.asarray(centres[:, None, :] + shifts[None])


def distances(tests: Array, segments: Sequence[tuple[Array, Array]]) -> Array:
    """Distance of each test place from each segment: (candidates, spots, segments)."""
    if not segments:
        return np.empty((*tests.shape[:2], 0))
    start = np.array([first for first, second in segments])
    along = np.array([second for first, second in segments]) - start
    length = np.maximum(np.sum(along**2, axis=1), np.finfo(float).tiny)
    offsets = tests[:, :, None, :] - start
    share = np.clip(np.sum(offsets * along, axis=-1) / length, 0.0, 1.0)
    return np.asarray(np.hypot(*np.moveaxis(offsets - share[..., None] * along, -1, 0)))


def gaps(tests: Array, places: Sequence[Array]) -> Array:
    """Distance of each test place from each other place: (candidates, spots, places)."""
    if not len(places):
        return np.empty((*tests.shape[:2], 0))
    return np.asarray(np.hypot(*np.moveaxis(tests[:, :, None, :] - np.array(places), -1, 0)))


def crowding(distance: Array, clear: float) -> Array:
    """Cost of each candidate: heavy for what is nearer than `clear`, and a light wish to stand far from all."""
    near = np.sum(np.maximum(0.0, 1.0 - distance / clear) ** 2, axis=(1, 2))
    return np.asarray(near + 0.02 * np.sum(clear / (clear + distance), axis=(1, 2)))
