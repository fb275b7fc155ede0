"""The mechanism at one instant, in the conventional signs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from centrode.model.mechanism import FRAME
from centrode.render.drawing import signs
from centrode.render.drawing.cams import draw_cams
from centrode.render.drawing.style import GROUND, INK, LINK, Pen, halo, marker_options, pens
from centrode.render.drawing.tags import drive_arcs, ground_line, label_places, lines, unit
from centrode.render.drawing.texts import plain
from centrode.scenes.linkage import cylinders, pitch_circles, round_track, straight_track, wheel_at
from centrode.scenes.places import Array, LinkageScene, MotionPlaces, corners

if TYPE_CHECKING:
    from centrode.model.mechanism import Guide, Rolling

MARGIN = 0.10  # room around the drawing, as a part of its extent
NAME_POINTS = 9.0  # height of the names of points [pt]


def draw_mechanism(
    axes: Axes,
    scene: LinkageScene,
    sample: int,
    *,
    faded: Iterable[int] = (),
    colour: str | None = None,
    names: bool = True,
) -> None:
    """Draw a mechanism at one sample of its motion, over fading pictures of others.

    Parameters
    ----------
    axes : Axes
        They get equal scales and limits that hold the whole motion.
    scene : LinkageScene
        The motion, read by `scene_of`.
    sample : int
        What cannot be placed at this sample is left out.
    faded : iterable of int
        Samples drawn faintly below.
    colour : str, optional
        One colour for all links; each link its own if left out.
    names : bool
        Write the points' names beside them.
    """
    links = pens(scene.mechanism.link_names)
    if colour is not None:
        links = dict.fromkeys(links, Pen(colour))
    frame_axes(axes, scene)
    faded = list(faded)
    for number, other in enumerate(faded):
        draw_links(axes, scene, other, links, alpha=0.14 + 0.16 * (number + 1) / len(faded))
    draw_bodies(axes, scene, sample, links)
    if colour is None:
        draw_drive(axes, scene, sample)
    if names:
        draw_names(axes, scene, sample)


def draw_bodies(axes: Axes, scene: LinkageScene, sample: int, links: Mapping[str, Pen]) -> None:
    """Frame, cams, links and hinges at a sample, without drives and names."""
    draw_frame(axes, scene, sample)
    draw_cams(axes, scene, sample)
    draw_links(axes, scene, sample, links)
    draw_hinges(axes, scene, sample, links)


def frame_axes(axes: Axes, scene: MotionPlaces) -> None:
    """Equal scales, and limits that hold the whole motion with its signs."""
    room = MARGIN * scene.extent
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlim(scene.low[0] - room, scene.high[0] + room)
    axes.set_ylim(scene.low[1] - room, scene.high[1] + room)


def draw_links(
    axes: Axes, scene: LinkageScene, sample: int, links: Mapping[str, Pen], alpha: float = 1.0
) -> None:
    """Links as lines and filled polygons, their slots, and the sliders."""
    places = scene.at(sample)
    draw_wheels(axes, scene, sample, links, alpha)
    for name, disc in pitch_circles(scene, sample):
        colour = GROUND if name == FRAME else links[name].colour
        signs.pitch_circle(axes, disc.centre, disc.radius, disc.angle, colour, alpha)
    for _drive, foot, mouth, end in cylinders(scene, sample):
        signs.cylinder(axes, foot, mouth, end, scene.sign, alpha)
    slotted = {guide.on for guide in scene.mechanism.guides}
    for name, link in scene.mechanism.links.items():
        outline = [places[point] for point in corners(link) if point in places]
        draw_body(axes, outline, links[name], alpha, name, behind=name in slotted)
    for guide in scene.mechanism.guides:
        line = scene.guide_line(guide, sample)
        if line is None or guide.point not in places:
            continue
        if guide.on != "frame":
            draw_slot(axes, scene, sample, guide, line, links[guide.on], alpha)
        if guide.on == "frame" or guide.link is not None:
            turn = 0.0 if guide.on == "frame" else float(scene.turns[guide.on][sample])
            tint = INK if guide.link is None else links[guide.link].colour
            signs.slider(axes, places[guide.point], turn + guide.direction_angle, scene.sign, tint, alpha)


def draw_wheels(axes: Axes, scene: LinkageScene, sample: int, links: Mapping[str, Pen], alpha: float) -> None:
    """Rolling wheels with a spoke, and the tracks that moving links carry."""
    for wheel in scene.mechanism.rolling:
        disc = wheel_at(scene, wheel, sample)
        if disc is not None:
            signs.wheel(axes, disc.centre, disc.radius, disc.angle, links[wheel.link].colour, alpha)
        if wheel.on == "frame":
            continue
        track, line = round_track(scene, wheel, sample), straight_track(scene, wheel, sample)
        if track is not None:
            signs.circle(axes, track.centre, track.radius, links[wheel.on].colour, alpha)
        if line is not None:
            draw_body(axes, line, links[wheel.on], alpha, wheel.on, behind=True)


def draw_body(
    axes: Axes, outline: Sequence[Array], pen: Pen, alpha: float, name: str, behind: bool = False
) -> None:
    """A link through the given places: a line, or a lightly filled polygon; `behind` the links without slots."""
    level = (2.4 if alpha < 1.0 else 3.0) - (0.2 if behind else 0.0)
    if len(outline) >= 3:
        axes.add_artist(
            Polygon(
                np.array(outline),
                closed=True,
                facecolor=pen.colour,
                edgecolor="none",
                alpha=0.18 * alpha,
                zorder=2,
            )
        )
    if len(outline) >= 2:
        path = np.array([*outline, outline[0]] if len(outline) >= 3 else outline)
        axes.plot(
            path[:, 0],
            path[:, 1],
            color=pen.colour,
            alpha=alpha,
            linewidth=LINK if alpha == 1.0 else 1.4,
            solid_capstyle="round",
            solid_joinstyle="round",
            zorder=level,
            label=name,
        )
        if pen.marker and alpha == 1.0:
            middle = 0.5 * (path[0] + path[1])
            axes.plot(
                middle[:1],
                middle[1:],
                color=pen.colour,
                alpha=alpha,
                zorder=level,
                **marker_options(pen, None),
            )


def draw_slot(
    axes: Axes,
    scene: LinkageScene,
    sample: int,
    guide: Guide,
    line: tuple[Array, Array],
    pen: Pen,
    alpha: float,
) -> None:
    """A slot with round ends, or a rod through the block that slides on it, and what joins it to its link."""
    places = scene.at(sample)
    start, end = line
    own = [places[name] for name in scene.mechanism.links[guide.on].coordinates if name in places]
    if own:
        feet = [nearest(place, start, end) for place in own]
        k = int(np.argmin([np.hypot(*(foot - place)) for foot, place in zip(feet, own, strict=True)]))
        draw_body(axes, [own[k], feet[k]], pen, alpha, guide.on, behind=True)
    if guide.link is None:
        signs.slot(axes, start, end, scene.sign, pen.colour, alpha)
    else:
        along = 3.5 * scene.sign * unit(end - start)
        draw_body(axes, [start - along, end + along], pen, alpha, guide.on, behind=True)


def draw_frame(axes: Axes, scene: LinkageScene, sample: int) -> None:
    """Hatched guides and tracks of the frame and its fixed hinges."""
    used, places = used_points(scene), scene.at(sample)
    for guide in scene.mechanism.guides:
        line = scene.guide_line(guide, sample) if guide.on == "frame" else None
        if line is not None:
            signs.ground(axes, *ground_line(scene, guide, line), scene.sign)
    for wheel in scene.mechanism.rolling:
        if wheel.on == "frame":
            draw_track(axes, scene, wheel)
    for name in scene.mechanism.frame.points:
        if name in used and name in places:
            signs.fixed_hinge(axes, places[name], scene.sign)
        elif name in places:
            signs.traced_point(axes, places[name], scene.sign, GROUND)


def used_points(scene: LinkageScene) -> set[str]:
    """Points that links and cylinders stand on."""
    used = {point for link in scene.mechanism.links.values() for point in link.coordinates}
    return used | {point for drive in scene.mechanism.drives for point in drive.distance or ()}


def draw_track(axes: Axes, scene: LinkageScene, wheel: Rolling) -> None:
    """A line or a circle of the frame, hatched on the side away from its wheel."""
    track, line = round_track(scene, wheel, 0), straight_track(scene, wheel, 0)
    if track is not None:
        signs.round_ground(axes, track.centre, track.radius, not wheel.along.inside, scene.sign)
    if line is not None:
        x, y = wheel.along.unit
        signs.ground(axes, *line, np.array([y, -x]), scene.sign)


def draw_hinges(axes: Axes, scene: LinkageScene, sample: int, links: Mapping[str, Pen]) -> None:
    """Circles where links are hinged, dots at points of one link alone."""
    for name, place in scene.at(sample).items():
        if name in scene.mechanism.frame.points:
            continue
        owners = [link for link, body in scene.mechanism.links.items() if name in body.coordinates]
        pins = [guide for guide in scene.mechanism.guides if guide.point == name and guide.link is None]
        ends = [drive for drive in scene.mechanism.drives if name in (drive.distance or ())]
        if len(owners) + len(pins) + len(ends) >= 2:
            signs.hinge(axes, place, scene.sign)
        else:
            signs.traced_point(axes, place, scene.sign, links[owners[0]].colour if owners else INK)


def draw_drive(axes: Axes, scene: LinkageScene, sample: int) -> None:
    """An arrow around the fixed hinge of each link that is driven against the frame."""
    for arc in drive_arcs(scene, sample):
        signs.turning_arrow(axes, arc, GROUND)


def draw_names(axes: Axes, scene: LinkageScene, sample: int) -> None:
    """The points' names beside them, on the side away from the lines."""
    write_names(axes, scene, scene.at(sample), lines(scene, sample))


def write_names(
    axes: Axes, scene: MotionPlaces, places: Mapping[str, Array], segments: Sequence[tuple[Array, Array]]
) -> None:
    """Names beside their places on paper, clear of the segments."""
    point = scene.extent / (72.0 * scene.inches)
    offset = scene.sign + 0.85 * NAME_POINTS * point
    centres = label_places(places, segments, offset, NAME_POINTS * point)
    for name, centre in centres.items():
        axes.text(
            centre[0],
            centre[1],
            plain(name),
            fontsize=NAME_POINTS,
            color=INK,
            ha="center",
            va="center",
            zorder=8,
            path_effects=halo(),
        )


def nearest(place: Array, start: Array, end: Array) -> Array:
    """The place of a segment nearest to a given one."""
    along = end - start
    length = max(float(along @ along), np.finfo(float).tiny)
    return np.asarray(start + np.clip(float((place - start) @ along) / length, 0.0, 1.0) * along)
