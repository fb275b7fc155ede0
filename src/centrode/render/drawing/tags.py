"""Names beside places, placed by the boxes of their texts: none covers another, nor a place that has one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from centrode.render.drawing import signs
from centrode.render.drawing.style import INK, MUTED, halo
from centrode.render.figures.document_canvas import MeasuringCanvas
from centrode.scenes.linkage import Disc, cylinders, round_track, straight_track, wheel_at
from centrode.scenes.places import Array, LinkageScene, corners

if TYPE_CHECKING:
    from centrode.model.mechanism import Guide

SIDES = 24
STEP = 0.45  # between the rings on which a text is tried, in its height
RINGS = 26
GAP = 2.0  # between texts [pixels at 72 dpi]
RING, SOLID, THIN = 0.35, 1.6, 0.5  # cost of each ring further out, of a line under a text, of a thin one
LEADER = 1.5  # a text farther than so many of its heights gets a thin line to its place


@dataclass(frozen=True)
class Tag:
    """A text that belongs to a place."""

    place: Array
    text: str
    colour: str = INK


def write_tags(
    axes: Axes,
    tags: Sequence[Tag],
    solid: Sequence[tuple[Array, Array]],
    thin: Sequence[tuple[Array, Array]],
    size: float,
    reach: float,
) -> None:
    """Write texts beside their places, in points of `size`, clear of each other and where possible of lines.

    Solid lines are avoided more than thin ones. `reach` is the radius of the sign at a place [pt]. The axes have
    to stand where they will be drawn.
    """
    figure = axes.figure
    assert isinstance(figure, Figure)
    axes.apply_aspect()
    pixel = figure.dpi / 72.0
    lines = np.array([[axes.transData.transform(end) for end in segment] for segment in (*solid, *thin)])
    lines = lines.reshape(-1, 2, 2)
    weights = np.repeat([SOLID, THIN], [len(solid), len(thin)])
    anchors = [np.asarray(axes.transData.transform(tag.place)) for tag in tags]
    room = axes.get_window_extent()
    taken: list[Array] = []
    for number, tag in enumerate(tags):
        extent = _extent(figure, tag.text, size)
        signs = [_square(anchor, reach * pixel) for k, anchor in enumerate(anchors) if k != number]
        others = np.array([*taken, *signs]).reshape(-1, 4)
        box = _best(
            _candidates(anchors[number], extent, reach * pixel, pixel), others, (lines, weights), room, pixel
        )
        taken.append(box)
        _write(axes, tag, box, anchors[number], size)


def _extent(figure: Figure, text: str, size: float) -> Array:
    """Width and height of a text [pixel]."""
    written = figure.text(0.5, 0.5, text, fontsize=size, linespacing=1.05)
    canvas: Any = MeasuringCanvas(figure)
    box = written.get_window_extent(canvas.get_renderer())
    written.remove()
    return np.array([float(box.width), float(box.height)])


def _square(anchor: Array, radius: float) -> Array:
    return np.concatenate([anchor - radius, anchor + radius])


def _candidates(anchor: Array, extent: Array, reach: float, pixel: float) -> Array:
    """Boxes (rings * sides, 4) about a place, the nearest ring first: lower left and upper right corners."""
    half = 0.5 * extent
    turns = np.pi / 4 + 2 * np.pi * np.arange(SIDES) / SIDES
    ways = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    # the box touches a circle about the place from outside, whichever side it stands on
    sides = np.min(half / np.maximum(np.abs(ways), 1e-9), axis=1)
    away = reach + GAP * pixel + 2.0 * STEP * half[1] * np.arange(RINGS)
    centres = anchor + ways * (away[:, None, None] + sides[:, None])
    centres = centres.reshape(-1, 2)
    return np.concatenate([centres - half, centres + half], axis=1)


def _best(boxes: Array, others: Array, lines: tuple[Array, Array], room: Bbox, pixel: float) -> Array:
    """The box of the least cost: free of all others, near its place, on few lines."""
    padded = boxes + GAP * pixel * np.array([-1.0, -1.0, 1.0, 1.0])
    cost = RING * np.repeat(np.arange(RINGS), SIDES) + _weight_below(padded, *lines)
    low, high = padded[:, None, :2], padded[:, None, 2:]
    apart = np.asarray(((low >= others[:, 2:]) | (high <= others[:, :2])).any(axis=2))
    covers = ~apart.all(axis=1)
    outside = (boxes[:, :2] < room.p0).any(axis=1) | (boxes[:, 2:] > room.p1).any(axis=1)
    return np.asarray(boxes[int(np.argmin(np.round(cost + 1000.0 * covers + 300.0 * outside, 6)))])


def _weight_below(boxes: Array, lines: Array, weights: Array) -> Array:
    """Weights of the segments that pass through each box (slab method)."""
    start, along = lines[:, 0], lines[:, 1] - lines[:, 0]
    along = np.where(np.abs(along) < 1e-12, 1e-12, along)
    enter: Array = np.full((len(boxes), len(lines)), -np.inf)
    leave: Array = np.full((len(boxes), len(lines)), np.inf)
    for axis in (0, 1):
        low, high = ((boxes[:, None, axis + side] - start[:, axis]) / along[:, axis] for side in (0, 2))
        enter, leave = np.maximum(enter, np.minimum(low, high)), np.minimum(leave, np.maximum(low, high))
    return np.asarray(((enter < leave) & (leave > 0.0) & (enter < 1.0)) @ weights)


def _write(axes: Axes, tag: Tag, box: Array, anchor: Array, size: float) -> None:
    """A text in its box, with a thin line to its place where that is far."""
    place = axes.transData.inverted().transform(0.5 * (box[:2] + box[2:]))
    axes.text(
        place[0],
        place[1],
        tag.text,
        fontsize=size,
        color=tag.colour,
        ha="center",
        va="center",
        linespacing=1.05,
        zorder=9,
        gid="tag",
        path_effects=halo(),
    )
    nearest = np.clip(anchor, box[:2], box[2:])
    if np.hypot(*(nearest - anchor)) > LEADER * size * axes.figure.dpi / 72.0:
        ends = axes.transData.inverted().transform([anchor, nearest])
        axes.plot(ends[:, 0], ends[:, 1], color=MUTED, linewidth=0.5, zorder=8.5)


# Which side of a point its name goes to, so that it covers no line, no point and no other name.

LABEL_SIDES = 16
LABEL_RINGS = (1.0, 1.35, 1.7)  # distances from the point; a nearer place is better
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
    turns = np.pi / 2 + 2 * np.pi * np.arange(LABEL_SIDES) / LABEL_SIDES
    around = np.tile(np.stack([np.cos(turns), np.sin(turns)], axis=1), (len(LABEL_RINGS), 1))
    return around, np.repeat(LABEL_RINGS, LABEL_SIDES)


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


# What the names in a drawing keep clear of: every line of it, as segments.

Segments = list[tuple[Array, Array]]
OUTLINE = 8
"""Every so many places of a cam's outline are corners of the polygon that names keep clear of."""


def lines(scene: LinkageScene, sample: int) -> Segments:
    """Everything a name should not cover, as segments."""
    places = scene.at(sample)
    found: Segments = []
    for link in scene.mechanism.links.values():
        outline = [places[point] for point in corners(link) if point in places]
        found += around(outline) if len(outline) > 2 else along(outline)
    for guide in scene.mechanism.guides:
        if guide.point in places:
            found += guide_lines(scene, guide, sample, places[guide.point])
    for name in scene.mechanism.frame.points:
        if name in places:
            feet = scene.sign * np.array([[-2.4, -3.6], [0.0, -3.6], [2.4, -3.6]])
            found += [(places[name], places[name] + foot) for foot in feet]
    for arc in drive_arcs(scene, sample):
        found += along(list(arc))
    return found + wheel_lines(scene, sample) + cam_lines(scene, sample)


def cam_lines(scene: LinkageScene, sample: int) -> Segments:
    """Driving cams and their rollers as segments."""
    found: Segments = []
    for cam in scene.cams:
        found += around(list(cam.outline(sample)[::OUTLINE]))
        roller = cam.roller(sample)
        found += [] if roller is None else around(list(Disc(*roller).outline))
    return found


def wheel_lines(scene: LinkageScene, sample: int) -> Segments:
    """Wheels, tracks and cylinders as segments."""
    found: Segments = []
    for wheel in scene.mechanism.rolling:
        for disc in (wheel_at(scene, wheel, sample), round_track(scene, wheel, sample)):
            found += [] if disc is None else around(list(disc.outline))
        line = straight_track(scene, wheel, sample)
        found += [] if line is None else [line]
    for _drive, foot, mouth, end in cylinders(scene, sample):
        found += [*around(list(signs.barrel_outline(foot, mouth, scene.sign))), (mouth, end)]
    return found


def guide_lines(scene: LinkageScene, guide: Guide, sample: int, place: Array) -> Segments:
    """A guide with its slider or slot, as segments."""
    line = scene.guide_line(guide, sample)
    if line is None:
        return []
    over = 3.0 * scene.sign * unit(line[1] - line[0])
    found = [(line[0] - over, line[1] + over)]
    if guide.on != "frame" and guide.link is None:
        return found + around(list(signs.slot_outline(*line, scene.sign)))
    if guide.on == "frame":
        start, end, away = ground_line(scene, guide, line)
        found += [(start + depth * away, end + depth * away) for depth in (0.0, 0.9 * scene.sign)]
    turn = 0.0 if guide.on == "frame" else float(scene.turns[guide.on][sample])
    return found + around(list(signs.slider_outline(place, turn + guide.direction_angle, scene.sign)))


def ground_line(scene: LinkageScene, guide: Guide, line: tuple[Array, Array]) -> tuple[Array, Array, Array]:
    """Ends of the hatched line that a slider of the frame rests on, and the side of the hatching."""
    along = np.asarray(guide.unit, dtype=float)
    away = down_from(along, 0.5 * (line[0] + line[1]), scene)
    shift, over = 1.7 * scene.sign * away, 4.0 * scene.sign * along
    return line[0] + shift - over, line[1] + shift + over, away


def down_from(along: Array, middle: Array, scene: LinkageScene) -> Array:
    """The side of a guide where the hatching goes: below; beside a steep one, away from the mechanism."""
    normal = np.array([along[1], -along[0]])
    if abs(along[0]) > 0.2:
        return normal if normal[1] < 0 else -normal
    outward = middle - 0.5 * (scene.low + scene.high)
    return normal if float(normal @ outward) >= 0 else -normal


def along(places: Sequence[Array]) -> Segments:
    """The segments of an open polygon."""
    return list(pairwise(places))


def around(places: Sequence[Array]) -> Segments:
    """The segments of a closed polygon."""
    return along([*places, places[0]])


def drive_arcs(scene: LinkageScene, sample: int) -> list[Array]:
    """The arcs of the drives' arrows: in the sense of a uniform drive or a cam, counter-clockwise for a law."""
    places = scene.at(sample)
    found = [signs.turning_arc(cam.hub, 0.0, cam.forward, scene.sign) for cam in scene.cams]
    for drive in scene.mechanism.drives:
        if drive.link is None or drive.relative_to != "frame" or drive.cam is not None:
            continue
        points = [name for name in scene.mechanism.links[drive.link].coordinates if name in places]
        pivots = [name for name in points if name in scene.mechanism.frame.points]
        others = [name for name in points if name not in pivots]
        if len(pivots) == 1 and others:
            arm = places[others[0]] - places[pivots[0]]
            forward = drive.speed is None or drive.speed >= 0
            angle = float(np.arctan2(arm[1], arm[0]))
            found.append(signs.turning_arc(places[pivots[0]], angle, forward, scene.sign))
    return found


def unit(vector: Array) -> Array:
    """A vector of length one, or zero."""
    return np.asarray(vector / max(float(np.hypot(*vector)), np.finfo(float).tiny))
