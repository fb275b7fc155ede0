"""What white bodies hide: strokes below a hinge's circle or a slider end at its edge, as a draughtsman's do."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from centrode.present.drafting.strokes import Array, Cover, Drawing, Ring, Stroke

CORNERS = 96
"""Of a circle that is partly hidden."""
TOUCH = 1e-9
"""Parts of a stroke shorter than this share of it are left out."""


def visible(drawing: Drawing) -> tuple[list[Stroke], list[Ring]]:
    """Strokes and circles without what is covered; circles that are covered in part become strokes."""
    strokes: list[Stroke] = []
    rings: list[Ring] = []
    for ring in drawing.rings:
        covers = [cover for cover in drawing.covers if cover.level > ring.level]
        turns = np.linspace(0.0, 2.0 * np.pi, CORNERS + 1)
        around = np.array(ring.centre) + ring.radius * np.stack([np.cos(turns), np.sin(turns)], axis=1)
        parts = _uncovered(around, covers)
        if len(parts) == 1 and len(parts[0]) == len(around):
            rings.append(ring)
        else:
            strokes += [Stroke(ring.layer, part, ring.level) for part in parts]
    for stroke in drawing.strokes:
        covers = [cover for cover in drawing.covers if cover.level > stroke.level]
        strokes += [Stroke(stroke.layer, part, stroke.level) for part in _uncovered(stroke.places, covers)]
    return strokes, rings


def _uncovered(places: Array, covers: list[Cover]) -> list[Array]:
    """The parts of a line through places that no cover hides."""
    parts: list[list[Array]] = []
    open_end = False
    for start, end in pairwise(places):
        if not (np.isfinite(start).all() and np.isfinite(end).all()):
            open_end = False
            continue
        free = _free(start, end, covers)
        for first, last in free:
            begin, finish = start + first * (end - start), start + last * (end - start)
            if open_end and first == 0.0:
                parts[-1].append(finish)
            else:
                parts.append([begin, finish])
            open_end = last == 1.0
        open_end = open_end and bool(free)
    return [np.array(part) for part in parts]


def _free(start: Array, end: Array, covers: list[Cover]) -> list[tuple[float, float]]:
    """Stretches of a segment, as shares of it, that lie under no cover."""
    free = [(0.0, 1.0)]
    for cover in covers:
        hidden = _inside(start, end, cover.corners)
        if hidden is None:
            continue
        low, high = hidden
        free = [
            piece
            for first, last in free
            for piece in ((first, min(last, low)), (max(first, high), last))
            if piece[1] - piece[0] > TOUCH
        ]
    return free


def _inside(start: Array, end: Array, corners: Array) -> tuple[float, float] | None:
    """The stretch of a segment inside a convex polygon, as shares of it (Cyrus and Beck)."""
    low, high, way = 0.0, 1.0, end - start
    sense = np.sign(_area(corners))
    for corner, after in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        side = after - corner
        normal = sense * np.array([-side[1], side[0]])
        height, slope = float(normal @ (start - corner)), float(normal @ way)
        if slope == 0.0:
            if height <= 0.0:
                return None
            continue
        share = -height / slope
        low, high = (max(low, share), high) if slope > 0.0 else (low, min(high, share))
        if high - low <= TOUCH:
            return None
    return low, high


def _area(corners: Array) -> float:
    x, y = corners.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
