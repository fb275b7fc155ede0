"""The kinematic scheme of a mechanism: conventional signs, numbers of the links, dimensions, the arrow of the drive."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from centrode.locale import _
from centrode.model.labels import body_name, sliders_of
from centrode.model.mechanism import FRAME
from centrode.model.settings import shown_as
from centrode.render.drawing.figure_room import figure_width
from centrode.render.drawing.globe import arcs_on_paper, draw_globe
from centrode.render.drawing.linkage import draw_mechanism, used_points
from centrode.render.drawing.style import GROUND, INK, MUTED, pens
from centrode.render.drawing.tags import Tag, lines, write_tags
from centrode.render.drawing.texts import plain
from centrode.render.figures.curves import columns_above, legend_width, write_legend
from centrode.render.figures.linkages import read_scene
from centrode.scenes.places import Array, LinkageScene, corners
from centrode.scenes.sphere import Globe, great_arc

if TYPE_CHECKING:
    from centrode.model.links import Guide
    from centrode.model.settings import Display
    from centrode.sheets.linkages import SchemePair, SchemePicture

Paper: TypeAlias = LinkageScene | Globe

WIDTH, HEIGHT = 6.3, 4.1
"""Greatest size of the drawing [inches]."""
PAIR_WIDTH, PAIR_HEIGHT, PAIR_GAP = 3.05, 3.6, 0.2
"""Greatest size of each of two drawings side by side, and what is between them [inches]."""
MARK_INCHES, ROW_INCHES = 0.28, 0.22
"""Height of the marks a) and b), and of a row of the key below them [inches]."""
CHANGED = "#C00000"
"""Colour of a dimension that is changed."""
LEAST_HEIGHT = 2.0
KEY = 1.3
"""Least width of the key of the links [inches]."""
ROOM = 0.55
"""Around what is drawn, for dimensions and names [inches]."""
TEXT, NUMBER = 9.5, 9.0
"""Heights of names and dimensions, and of the numbers of links [pt]."""
REACH = 6.0
"""Radius about a place that its text keeps clear of [pt]."""
LEAST_SHARE = 0.045
"""Of the extent: a shorter piece of a link has no dimension of its own on paper, it is among the data."""
MOST_LEVELS = 5
"""Points of the frame and guides at different places across or up, beyond which the frame has no dimensions."""
CIRCLE = 2.0
"""Radius of the circle of a link's number, in the size of the signs."""
DIMENSION = "dimension"
"""Name of the lines of dimensions, which texts keep clear of."""
SAME = 1e-9
"""Part of the extent by which coordinates differ that are the same."""


def scheme_figure(picture: SchemePicture, display: Display) -> Figure:
    """The scheme at the sample of the picture, as large as its paper allows, beside the key of the links."""
    scene = read_scene(picture.mechanism, picture.motion)
    key = _key(scene)
    room = max(KEY, legend_width([text for _line, text in key], HEIGHT))
    scene, size = _on_paper(scene, picture.sample, (min(WIDTH, figure_width()) - room, HEIGHT))
    figure = Figure(figsize=(size[0] + room, size[1]))
    axes = figure.add_axes((0.0, 0.0, size[0] / (size[0] + room), 1.0))
    _draw_scheme(axes, scene, picture, display)
    write_legend(axes, key, inches=size[1] - 0.2)
    return figure


def pair_figure(pair: SchemePair, display: Display) -> Figure:
    """Two schemes side by side to one scale, at one height, marked a) and b), above the key of the links."""
    pictures = pair.schemes
    scenes = [read_scene(one.mechanism, one.motion) for one in pictures]
    each = min(PAIR_WIDTH, (figure_width() - PAIR_GAP) / 2), PAIR_HEIGHT
    per_inch, levels = 0.0, None
    for _pass in range(2):  # first the scale and the heights of each, then the greater ones for both
        drawn = [
            _on_paper(scene, one.sample, each, per_inch, levels)
            for scene, one in zip(scenes, pictures, strict=True)
        ]
        per_inch = max(float(scene.high[0] - scene.low[0]) / size[0] for scene, size in drawn)
        levels = (
            min(float(scene.low[1]) for scene, _size in drawn),
            max(float(scene.high[1]) for scene, _size in drawn),
        )
    height = (levels[1] - levels[0]) / per_inch if levels else LEAST_HEIGHT
    width = sum(size[0] for _scene, size in drawn) + PAIR_GAP
    key = _key(drawn[0][0])
    columns = columns_above([name for _line, name in key], width)
    below = MARK_INCHES + ROW_INCHES * -(-len(key) // columns)
    figure = Figure(figsize=(width, height + below))
    left, whole = 0.0, height + below
    known: frozenset[str] = frozenset()
    for mark, picture, (scene, size) in zip((_("a)"), _("b)")), pictures, drawn, strict=True):
        axes = figure.add_axes((left / width, below / whole, size[0] / width, height / whole))
        known |= _draw_scheme(axes, scene, picture, display, known)
        place = ((left + 0.5 * size[0]) / width, (below - 0.5 * MARK_INCHES) / whole)
        figure.text(*place, mark, ha="center", va="center", fontsize=TEXT)
        left += size[0] + PAIR_GAP
    handles, names = zip(*key, strict=True)
    figure.legend(
        handles, names, loc="lower center", ncols=columns, handlelength=2.2, columnspacing=1.2, frameon=False
    )
    return figure


def _draw_scheme(
    axes: Axes, scene: Paper, picture: SchemePicture, display: Display, known: frozenset[str] = frozenset()
) -> frozenset[str]:
    """The mechanism with all that is written about it, which is returned.

    Dimensions of what is changed are set off, without those that are `known`.
    """
    tags = [
        replace(tag, colour=INK) if tag.text in known else tag for tag in _draw(axes, scene, picture, display)
    ]
    sample = picture.sample
    if isinstance(scene, LinkageScene):
        for number, (_name, guide) in _numbered_sliders(scene):
            place = scene.at(sample)[guide.point]
            _write_number(axes, place + scene.sign * np.array([3.0, 3.0]), number)
    axes.set_axis_off()
    solid = list(arcs_on_paper(scene, sample) if isinstance(scene, Globe) else lines(scene, sample))
    for text in axes.texts:
        solid += _cross(np.array(text.get_position()), scene)
    solid += [_ends(line) for line in axes.lines if line.get_gid() == DIMENSION]
    write_tags(axes, tags, solid, [], TEXT, REACH)
    return frozenset(tag.text for tag in tags)


def _numbered_sliders(scene: LinkageScene) -> Iterator[tuple[int, tuple[str, Guide]]]:
    """The sliders that no link is named for, with numbers behind those of the links."""
    yield from enumerate(sliders_of(scene.mechanism).items(), start=len(scene.mechanism.links) + 1)


def _key(scene: Paper) -> list[tuple[Artist, str]]:
    """Entries of the key of the links."""
    links: list[tuple[Artist, str]] = [
        (Line2D([], [], color=pen.colour, linestyle=pen.dashes, linewidth=2.4), f"{number}  {plain(name)}")
        for number, (name, pen) in enumerate(pens(scene.mechanism.link_names).items(), start=1)
    ]
    if isinstance(scene, Globe):
        return links
    frame = (Line2D([], [], color=GROUND, linewidth=1.2), "0  " + _("frame"))
    sliders = [
        (Line2D([], [], color=INK, linewidth=1.2), f"{number}  {plain(body_name(scene.mechanism, name))}")
        for number, (name, _guide) in _numbered_sliders(scene)
    ]
    return [frame, *links, *sliders]


def _on_paper(
    scene: Paper,
    sample: int,
    most: tuple[float, float],
    per_inch: float = 0.0,
    levels: tuple[float, float] | None = None,
) -> tuple[Paper, tuple[float, float]]:
    """The scene in the window of one sample, its signs in their size on paper, and the size of the paper [inches].

    It is at most so large; or to a scale of so many units to an inch, between two heights.
    """
    least = np.array([min(2.5, most[0]), LEAST_HEIGHT])
    for _pass in range(2):  # the signs reach as far as their size, which depends on the window
        held = _held(scene, sample)
        low, high = held.min(axis=0), held.max(axis=0)
        span = np.maximum(high - low, 1e-3 * float(np.max(high - low)) + np.finfo(float).tiny)
        scale = per_inch or float(np.max(span / (np.array(most) - 2 * ROOM)))
        size = np.maximum(span / scale + 2 * ROOM, least)
        middle = 0.5 * (low + high)
        low, high = middle - 0.5 * size * scale, middle + 0.5 * size * scale
        if levels is not None:
            low[1], high[1] = levels
            size[1] = (levels[1] - levels[0]) / scale
        scene = replace(scene, low=low, high=high, inches=float(np.max(size)))
    return scene, (float(size[0]), float(size[1]))


def _cross(place: Array, scene: Paper) -> list[tuple[Array, Array]]:
    """Strokes through the circle of a link's number, which texts keep clear of."""
    turns = 0.25 * np.pi * np.arange(4)
    ways = CIRCLE * scene.sign * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    return [(place - way, place + way) for way in ways]


def _ends(line: Line2D) -> tuple[Array, Array]:
    """Both ends of a straight line."""
    ends = np.asarray(line.get_xydata())
    return ends[0], ends[-1]


def _held(scene: Paper, sample: int) -> Array:
    """Places (n, 2) that the drawing has to hold."""
    if isinstance(scene, Globe):
        return np.array([[-1.0, -1.0], [1.0, 1.0]]) if scene.low[0] <= -0.99 else _arcs(scene, sample)
    ends = [end for segment in lines(scene, sample) for end in segment]
    ends += list(scene.at(sample).values())
    return np.array(ends)


def _arcs(scene: Globe, sample: int) -> Array:
    ends = [end for segment in arcs_on_paper(scene, sample) for end in segment]
    return np.array([*ends, *(scene.flat(place) for place in scene.at(sample).values())])


def _draw(axes: Axes, scene: Paper, picture: SchemePicture, display: Display) -> Iterator[Tag]:
    """Draw the mechanism and the numbers of its links; what else is written about it."""
    sample = picture.sample
    if isinstance(scene, Globe):
        draw_globe(axes, scene, sample, names=False)
    else:
        draw_mechanism(axes, scene, sample, names=False)
    axes.set_xlim(scene.low[0], scene.high[0])
    axes.set_ylim(scene.low[1], scene.high[1])
    places = scene.at(sample)
    for name, place in places.items():
        yield Tag(_flat(scene, place), plain(name))
    for number, name in enumerate(scene.mechanism.links, start=1):
        colour = CHANGED if name == picture.changed else INK
        for tag in _marked_link(axes, scene, sample, number, name, display):
            yield replace(tag, colour=colour)
    if isinstance(scene, LinkageScene):
        colour = CHANGED if picture.changed == FRAME else INK
        for tag in _frame_dimensions(axes, scene, sample):
            yield replace(tag, colour=colour)


def _flat(scene: Paper, place: Array) -> Array:
    return scene.flat(place) if isinstance(scene, Globe) else place


def _marked_link(
    axes: Axes, scene: Paper, sample: int, number: int, name: str, display: Display
) -> Iterator[Tag]:
    """The number of a link in a circle on its longest piece, and the lengths of its pieces beside them."""
    places = scene.at(sample)
    link = scene.mechanism.links[name]
    outline = [point for point in corners(link) if point in places]
    inside = [point for point in link.coordinates if point in places and point not in outline]
    pieces = list(pairwise([*outline, *outline[:1]] if len(outline) > 2 else outline))
    pieces = [piece for whole in pieces for piece in _part_side(whole, inside, places)]
    if not pieces:
        if outline:
            _write_number(axes, _flat(scene, places[outline[0]]) + scene.sign * np.array([3.0, 3.0]), number)
        return
    longest = max(pieces, key=lambda piece: float(np.linalg.norm(places[piece[1]] - places[piece[0]])))
    for first, second in pieces:
        start, end = places[first], places[second]
        on_paper = float(np.hypot(*(_flat(scene, end) - _flat(scene, start))))
        if on_paper > LEAST_SHARE * scene.extent and len(pieces) <= 3:
            share = 0.5 if (first, second) != longest or on_paper < 0.25 * scene.extent else 0.68
            yield Tag(_between(scene, start, end, share), _length_text(scene, start, end, display))
    share = 0.36 if len(pieces) < 3 else 0.3
    _write_number(axes, _between(scene, places[longest[0]], places[longest[1]], share), number)


def _part_side(
    piece: tuple[str, str], inside: Sequence[str], places: dict[str, Array]
) -> Iterator[tuple[str, str]]:
    """A side of a link, parted at the points of the link that lie on it."""
    start, end = (places[name] for name in piece)
    along = end - start
    length = max(float(along @ along), np.finfo(float).tiny)
    shares = {piece[0]: 0.0, piece[1]: 1.0}
    for name in inside:
        share = float((places[name] - start) @ along) / length
        aside = float(np.linalg.norm(places[name] - start - share * along))
        if 0.0 < share < 1.0 and aside**2 < 1e-6 * length:
            shares[name] = share
    return pairwise(sorted(shares, key=lambda name: shares[name]))


def _between(scene: Paper, start: Array, end: Array, share: float) -> Array:
    """The place on paper of a share of a straight link, or of an arc."""
    if isinstance(scene, Globe):
        arc = great_arc(start, end)
        return scene.flat(arc[round(share * (len(arc) - 1))])
    return np.asarray(start + share * (end - start))


def _length_text(scene: Paper, start: Array, end: Array, display: Display) -> str:
    """The length of a piece in the unit of the display, on the sphere its arc."""
    if isinstance(scene, Globe):
        arc = float(np.arctan2(np.linalg.norm(np.cross(start, end)), start @ end))
        factor, unit = shown_as("rad", display)
        return f"{factor * arc:.5g}{'°' if unit == 'deg' else ''}"
    return f"{float(np.hypot(*(end - start))):.5g}"


def _write_number(axes: Axes, place: Array, number: int) -> None:
    axes.text(
        place[0],
        place[1],
        str(number),
        fontsize=NUMBER,
        color=INK,
        ha="center",
        va="center",
        zorder=8,
        bbox={"boxstyle": "circle,pad=0.22", "facecolor": "white", "edgecolor": INK, "linewidth": 0.8},
    )


# Dimensions of the frame: distances between its hinges, and of guides along an axis, across and up.


def _frame_dimensions(axes: Axes, scene: LinkageScene, sample: int) -> Iterator[Tag]:
    """Chains of dimensions below and on the left."""
    places = scene.at(sample)
    fixed = [
        places[name] for name in scene.mechanism.frame.points if name in places and name in used_points(scene)
    ]
    if not fixed:
        return
    levels: tuple[list[Array], list[Array]] = ([*fixed], [*fixed])
    for guide in scene.mechanism.guides:
        line = scene.guide_line(guide, sample) if guide.on == FRAME else None
        if line is None:
            continue
        x, y = guide.unit
        if abs(y) < SAME:
            levels[1].append(min(line, key=lambda end: float(end[0])))
        elif abs(x) < SAME:
            levels[0].append(min(line, key=lambda end: float(end[1])))
    inch = scene.extent / scene.inches
    for axis in (0, 1):
        base = float((scene.low + 0.28 * inch)[1 - axis])
        yield from _chain(axes, levels[axis], axis, base, scene)


def _chain(axes: Axes, places: Sequence[Array], axis: int, base: float, scene: LinkageScene) -> Iterator[Tag]:
    """Distances between neighbouring places along an axis, on one line at `base` of the other axis."""
    known: list[Array] = []
    for place in sorted(places, key=lambda one: float(one[axis])):
        if not known or place[axis] - known[-1][axis] > SAME * scene.extent:
            known.append(place)
        elif place[1 - axis] < known[-1][1 - axis]:
            known[-1] = place
    if not 1 < len(known) <= MOST_LEVELS:
        return
    stroke = 0.6 * scene.sign
    for place in known:
        foot, head = np.array(place), np.array(place)
        foot[1 - axis], head[1 - axis] = base - stroke, place[1 - axis] - (0.0 if axis else 4.2 * scene.sign)
        if axis:
            head[0] = place[0] - 3.0 * scene.sign
        if head[1 - axis] > foot[1 - axis]:
            axes.plot(*np.array([foot, head]).T, color=MUTED, linewidth=0.5, zorder=1.2, gid=DIMENSION)
        tick = np.array([[-stroke, -stroke], [stroke, stroke]])
        centre = np.array(place)
        centre[1 - axis] = base
        axes.plot(*(centre + tick).T, color=GROUND, linewidth=1.0, zorder=1.3, gid=DIMENSION)
    for first, second in pairwise(known):
        ends = np.array([first, second])
        ends[:, 1 - axis] = base
        axes.plot(*ends.T, color=GROUND, linewidth=0.6, zorder=1.3, gid=DIMENSION)
        length = float(second[axis] - first[axis])
        yield Tag(ends.mean(axis=0), f"{length:.5g}")
