"""A spherical mechanism at one instant: links as great arcs, thin and dashed where they run behind the sphere."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon

from centrode.render.drawing import signs
from centrode.render.drawing.linkage import frame_axes, write_names
from centrode.render.drawing.style import GROUND, HAIR, HIDDEN, INK, Pen, marker_options, pens
from centrode.scenes.places import corners
from centrode.scenes.sphere import STEPS, Array, Globe, great_arc

RIM, SHADE, GRID = "#B0B0B0", "#ECECEC", "#D2D2D2"
SHADES = 6
"""Discs that make the sphere lighter towards the light."""


def draw_globe(
    axes: Axes,
    globe: Globe,
    sample: int,
    *,
    faded: Iterable[int] = (),
    colour: str | None = None,
    names: bool = True,
) -> None:
    """Draw a spherical mechanism, whose motion `globe_of` has read; all else is as `draw_mechanism` has it."""
    links = pens(globe.mechanism.link_names)
    if colour is not None:
        links = dict.fromkeys(links, Pen(colour))
    frame_globe(axes, globe)
    faded = list(faded)
    for number, other in enumerate(faded):
        draw_arcs(axes, globe, other, links, alpha=0.14 + 0.16 * (number + 1) / len(faded))
    draw_circles(axes, globe, sample, links)
    draw_arcs(axes, globe, sample, links)
    draw_points(axes, globe, sample, links)
    if colour is None:
        draw_turns(axes, globe, sample)
    if names:
        draw_names(axes, globe, sample)


def frame_globe(axes: Axes, globe: Globe) -> None:
    """The outline of the sphere, equal scales, and limits that hold the whole motion."""
    frame_axes(axes, globe)
    axes.grid(False)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.spines[:].set_visible(False)
    axes.add_artist(Circle((0.0, 0.0), 1.0, facecolor=SHADE, edgecolor=RIM, linewidth=1.0, zorder=0.5))
    # lighter towards the light, which falls from the upper left
    for number in range(1, SHADES + 1):
        share = number / SHADES
        middle = (-0.28 * share, 0.28 * share)
        axes.add_artist(
            Circle(middle, 1.0 - 0.6 * share, facecolor="white", alpha=0.22, linewidth=0.0, zorder=0.51)
        )
    seen = [np.where(globe.in_front(one)[:, None], globe.flat(one), np.nan) for one in graticule()]
    axes.plot(*np.concatenate(seen).T, color=GRID, linewidth=HAIR, zorder=0.9)


def graticule() -> Iterator[Array]:
    """Meridians and parallels each 30 degrees about the frame's third axis, as places with a gap at the end."""
    around = np.append(np.linspace(0.0, 2.0 * np.pi, 4 * STEPS + 1), np.nan)
    for longitude in np.radians(np.arange(0, 180, 30)):
        level = np.array([np.cos(longitude), np.sin(longitude), 0.0])
        yield np.cos(around)[:, None] * level + np.sin(around)[:, None] * np.array([0.0, 0.0, 1.0])
    for latitude in np.radians([-60, -30, 0, 30, 60]):
        yield np.stack(
            [
                np.cos(latitude) * np.cos(around),
                np.cos(latitude) * np.sin(around),
                np.full(len(around), np.sin(latitude)),
            ],
            axis=1,
        )


def draw_line(axes: Axes, globe: Globe, places: Array, colour: str, width: float, **more: Any) -> None:
    """A line on the sphere: in front as it is, behind thin and dashed."""
    flat, front = globe.flat(places), globe.in_front(places)
    level = more.pop("zorder", 2.0)
    for seen, style, share in ((front, more.pop("linestyle", "-"), 1.0), (~front, HIDDEN, 0.6)):
        # the piece that crosses the rim belongs to both sides
        near = seen | np.append(seen[1:], False) | np.insert(seen[:-1], 0, False)
        shown = np.where(near[:, None], flat, np.nan)
        if seen.any():
            axes.plot(
                *shown.T, color=colour, linewidth=share * width, linestyle=style, zorder=level * share, **more
            )


def draw_circles(axes: Axes, globe: Globe, sample: int, links: Mapping[str, Pen]) -> None:
    """The circles of guides."""
    for guide in globe.mechanism.guides:
        circle = globe.circle(guide, sample)
        if circle is not None:
            colour = GROUND if guide.on == "frame" else links[guide.on].colour
            draw_line(axes, globe, circle, colour, 1.0)


def draw_arcs(axes: Axes, globe: Globe, sample: int, links: Mapping[str, Pen], alpha: float = 1.0) -> None:
    """Links as great arcs between their points, those of three points and more filled."""
    places = globe.at(sample)
    for name, link in globe.mechanism.links.items():
        outline = [places[point] for point in corners(link) if point in places]
        if len(outline) >= 3:
            outline.append(outline[0])
        arcs = [great_arc(start, end) for start, end in pairwise(outline)]
        pen = links[name]
        for arc in arcs:
            width = 2.4 if alpha == 1.0 else 1.4
            draw_line(axes, globe, arc, pen.colour, width, alpha=alpha, zorder=3.0)
            if pen.marker and alpha == 1.0:
                draw_marker(axes, globe, arc[len(arc) // 2], pen, alpha)
        rim = np.concatenate(arcs) if len(arcs) >= 3 else np.empty((0, 3))
        if len(rim) and globe.in_front(rim).all():
            axes.add_artist(
                Polygon(
                    globe.flat(rim), facecolor=pen.colour, edgecolor="none", alpha=0.18 * alpha, zorder=2.0
                )
            )


def draw_marker(axes: Axes, globe: Globe, place: Array, pen: Pen, alpha: float) -> None:
    """The marker of a link at a place of its arc."""
    faint = alpha if globe.in_front(place) else 0.4 * alpha
    axes.plot(*globe.flat(place), color=pen.colour, alpha=faint, zorder=3.1, **marker_options(pen, None))


def draw_points(axes: Axes, globe: Globe, sample: int, links: Mapping[str, Pen]) -> None:
    """Circles where links are hinged, with a dot where the frame holds them, dots at points of one link alone."""
    for name, place in globe.at(sample).items():
        owners = [link for link, body in globe.mechanism.links.items() if name in body.coordinates]
        fixed = name in globe.mechanism.frame.points
        pins = sum(guide.point == name for guide in globe.mechanism.guides)
        alpha, flat = (1.0 if globe.in_front(place) else 0.4), globe.flat(place)
        if len(owners) + pins + fixed >= 2:
            signs.hinge(axes, flat, globe.sign, GROUND if fixed else INK, alpha)
        if fixed or len(owners) + pins < 2:
            colour = GROUND if fixed or not owners else links[owners[0]].colour
            signs.traced_point(axes, flat, globe.sign, colour, alpha)


def draw_turns(axes: Axes, globe: Globe, sample: int) -> None:
    """An arrow around the fixed hinge of each link that is driven against the frame, where it is seen."""
    for arc in drive_rings(globe, sample):
        signs.turning_arrow(axes, arc, GROUND)


def drive_rings(globe: Globe, sample: int) -> Iterator[Array]:
    """The arcs of the drives' arrows on paper, where they are seen."""
    places = globe.at(sample)
    for drive in globe.mechanism.drives:
        if drive.link is None or drive.relative_to != "frame":
            continue
        pivot, second = list(globe.mechanism.links[drive.link].coordinates)[:2]
        if pivot in places and second in places and globe.in_front(places[pivot]):
            arc = turning_ring(places[pivot], places[second], 4.2 * globe.sign)
            forward = drive.speed is None or drive.speed >= 0
            yield globe.flat(arc if forward else arc[::-1])


def turning_ring(pivot: Array, towards: Array, radius: float) -> Array:
    """Part of a circle about a pivot, counter-clockwise seen from outside, beside the way to another place."""
    along = towards - pivot * (pivot @ towards)
    along /= np.linalg.norm(along)
    turn = np.linspace(0.6, 2.1, 15)[:, None]
    ring = np.cos(turn) * along + np.sin(turn) * np.cross(pivot, along)
    return np.asarray(np.cos(radius) * pivot + np.sin(radius) * ring)


def draw_names(axes: Axes, globe: Globe, sample: int) -> None:
    """The points' names beside them, on the side away from the lines."""
    places = globe.at(sample)
    segments = []
    for link in globe.mechanism.links.values():
        outline = [places[name] for name in corners(link) if name in places]
        for start, end in pairwise([*outline, *outline[:1]] if len(outline) > 2 else outline):
            segments += list(pairwise(globe.flat(great_arc(start, end))[::6]))
    flat = {name: globe.flat(place) for name, place in places.items()}
    write_names(axes, globe, flat, segments)


def arcs_on_paper(globe: Globe, sample: int) -> list[tuple[Array, Array]]:
    """Pieces of the links' arcs, for texts to keep clear of."""
    places = globe.at(sample)
    found: list[tuple[Array, Array]] = []
    for link in globe.mechanism.links.values():
        outline = [places[name] for name in corners(link) if name in places]
        for start, end in pairwise(outline):
            found += list(pairwise(globe.flat(great_arc(start, end))[::6]))
    for arc in drive_rings(globe, sample):
        found += list(pairwise(arc))
    return found
