"""Instantaneous axes on the sphere: where they pierce it, and the great circles on which three of them lie."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from centrode.present.scene import corners
from centrode.present.shown import plain
from centrode.present.sphere.globe import STEPS, Array, Globe, great_arc
from centrode.present.sphere.globe_drawing import (
    draw_arcs,
    draw_circles,
    draw_line,
    draw_points,
    draw_turns,
    frame_globe,
)
from centrode.present.style import pens
from centrode.present.symbols import subscripted
from centrode.present.tags import Tag, write_tags

if TYPE_CHECKING:
    from centrode.analysis.instant_centres.bodies import Pair
    from centrode.analysis.instant_centres.kennedy import Construction, KennedyStep

CENTRE = "#A00000"
FOUND = "#0072B2"
NAMED = 10.0  # size of names [pt]
TOGETHER = 0.5  # places nearer than this share one text, in radii of a hinge


def whole(globe: Globe) -> Globe:
    """The same with the whole sphere in view: axes lie anywhere on it."""
    return replace(globe, low=np.array([-1.0, -1.0]), high=np.array([1.0, 1.0]))


def draw_axes(
    axes: Axes, globe: Globe, needed: Construction, shown: Sequence[Pair], sample: int
) -> dict[Pair, Array]:
    """Draw the mechanism with its axes; returns where on paper the shown ones are.

    Of the two ends of a constructed axis the one that is seen is drawn; a hinge stays where it is.
    """
    globe = whole(globe)
    draw_bodies(axes, globe, sample)
    ends = {step.pair: _end(globe, step) for step in needed.steps if step.place is not None}
    rays: list[tuple[Array, Array]] = []
    for step in needed.steps:
        if step.how == "kennedy" and step.pair in shown:
            rays += _circles(axes, globe, step, ends)
    places = {pair: end for pair, end in ends.items() if pair in shown}
    for end in places.values():
        axes.plot(*globe.flat(end), marker="D", markersize=4.2, color=CENTRE, markeredgecolor="white",
                  markeredgewidth=0.6, alpha=1.0 if globe.in_front(end) else 0.45, zorder=7.5)  # fmt: skip
    flat = {pair: globe.flat(end) for pair, end in places.items()}
    _write(axes, globe, sample, flat, rays, len(needed.bodies))
    return flat


def draw_bodies(axes: Axes, globe: Globe, sample: int) -> None:
    """The mechanism without its names."""
    links = pens(globe.mechanism.link_names)
    frame_globe(axes, globe)
    draw_circles(axes, globe, sample, links)
    draw_arcs(axes, globe, sample, links)
    draw_points(axes, globe, sample, links)
    draw_turns(axes, globe, sample)


def name_points(globe: Globe, sample: int) -> list[Tag]:
    """Tags of the named points."""
    return [Tag(globe.flat(place), plain(name)) for name, place in globe.at(sample).items()]


def arcs_on_paper(globe: Globe, sample: int) -> list[tuple[Array, Array]]:
    """Pieces of the links' arcs, for texts to keep clear of."""
    places = globe.at(sample)
    found: list[tuple[Array, Array]] = []
    for link in globe.mechanism.links.values():
        outline = [places[name] for name in corners(link) if name in places]
        for start, end in pairwise(outline):
            found += list(pairwise(globe.flat(great_arc(start, end))[::6]))
    return found


def _end(globe: Globe, step: KennedyStep) -> Array:
    end = np.array(step.place)
    flipped = step.how not in ("hinge", "guide") and not globe.in_front(end)
    return -end if flipped else end


def _circles(
    axes: Axes, globe: Globe, step: KennedyStep, ends: dict[Pair, Array]
) -> list[tuple[Array, Array]]:
    """The great circles that an axis was found on, drawn; their pieces in front."""
    found: list[tuple[Array, Array]] = []
    for by in step.by:
        legs = [(max(one, by), min(one, by)) for one in step.pair]
        if not all(leg in ends for leg in legs):
            continue
        first, second = (ends[leg] for leg in legs)
        normal = np.cross(first, second)
        across = np.cross(normal / np.linalg.norm(normal), first)
        turn = np.linspace(0.0, 2.0 * np.pi, 4 * STEPS + 1)[:, None]
        circle = np.cos(turn) * first + np.sin(turn) * across
        draw_line(axes, globe, circle, FOUND, 0.8, linestyle=(0, (5, 2.5)), alpha=0.9, zorder=1.2)
        seen = globe.flat(circle)[globe.in_front(circle)][::6]
        found += list(pairwise(seen))
    return found


def _write(
    axes: Axes,
    globe: Globe,
    sample: int,
    centres: dict[Pair, Array],
    rays: Sequence[tuple[Array, Array]],
    bodies: int,
) -> None:
    """Names of points and axes; those in one place share a text."""
    entries = [(globe.flat(place), [plain(name)]) for name, place in globe.at(sample).items()]
    for pair, place in centres.items():
        near = [texts for at, texts in entries if np.hypot(*(at - place)) < TOGETHER * globe.sign]
        if near:
            near[0].append(subscripted(pair, bodies))
        else:
            entries.append((place, [subscripted(pair, bodies)]))
    tags = [Tag(place, ", ".join(texts)) for place, texts in entries]
    reach = 72 * globe.sign * globe.inches / globe.extent
    write_tags(axes, tags, arcs_on_paper(globe, sample), rays, NAMED, reach)
