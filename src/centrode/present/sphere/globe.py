"""The sphere as it is drawn: seen from far away, with what lies behind it apart from what lies in front."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon
from numpy.typing import NDArray

from centrode.model.values import unit_vector
from centrode.present import signs
from centrode.present.displayed_units import plain
from centrode.present.scene import box, corners
from centrode.present.sheet import MotionPlaces
from centrode.present.style import GROUND, INK, Pen, pens
from centrode.present.tags import label_places

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

    def carried(self, link: str, local: Array, sample: int) -> Array | None:
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
        centre = self.carried(guide.on, np.array(unit_vector(pole)), sample)  # type: ignore[arg-type]
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
    names = dataset["point"].to_numpy().tolist()
    tracks = {name: dataset["position"].sel(point=name).to_numpy() for name in names}
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
    guide = slider_guide(globe, body)
    if guide is None:
        return globe.carried(body, curve, sample)
    pole = guide.pole
    if isinstance(pole, str):
        pole = globe.mechanism.points_of(guide.on)[pole]
    inside = unit_vector(pole)  # type: ignore[arg-type]
    longitude, latitude = pole  # type: ignore[misc]
    north = np.array(unit_vector((longitude, latitude + np.pi / 2)))
    frame = globe.carried(guide.on, np.eye(3), sample)
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
    return globe.carried(guide.on, turned, sample)


def slider_guide(globe: Globe, body: str) -> Guide | None:
    """The guide of a slider by the slider's name; none of a link or the frame."""
    if body == "frame" or body in globe.mechanism.links:
        return None
    return next(guide for guide in globe.mechanism.guides if body.startswith(f"slider {guide.id}"))


# A spherical mechanism at one instant: links as great arcs, thin and dashed where they run behind the sphere.

MARGIN = 0.10  # room around the drawing, as a part of its extent
NAME_POINTS = 10.0  # height of the names of points [pt]
HIDDEN = (0, (4, 3))
RIM, SHADE = "#C8C8C8", "#FAFAFA"


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
    room = MARGIN * globe.extent
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlim(globe.low[0] - room, globe.high[0] + room)
    axes.set_ylim(globe.low[1] - room, globe.high[1] + room)
    axes.grid(False)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.spines[:].set_visible(False)
    axes.add_patch(Circle((0.0, 0.0), 1.0, facecolor=SHADE, edgecolor=RIM, linewidth=1.0, zorder=0.5))


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
            draw_line(axes, globe, arc, pen.colour, width, alpha=alpha, linestyle=pen.dashes, zorder=3.0)
        rim = np.concatenate(arcs) if len(arcs) >= 3 else np.empty((0, 3))
        if len(rim) and globe.in_front(rim).all():
            axes.add_patch(
                Polygon(
                    globe.flat(rim), facecolor=pen.colour, edgecolor="none", alpha=0.18 * alpha, zorder=2.0
                )
            )


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
    places = globe.at(sample)
    for drive in globe.mechanism.drives:
        if drive.link is None or drive.relative_to != "frame":
            continue
        pivot, second = list(globe.mechanism.links[drive.link].coordinates)[:2]
        if pivot in places and second in places and globe.in_front(places[pivot]):
            arc = turning_ring(places[pivot], places[second], 4.2 * globe.sign)
            forward = drive.speed is None or drive.speed >= 0
            signs.turning_arrow(axes, globe.flat(arc if forward else arc[::-1]), GROUND)


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
    point = globe.extent / (72.0 * globe.inches)
    segments = []
    for link in globe.mechanism.links.values():
        outline = [places[name] for name in corners(link) if name in places]
        for start, end in pairwise([*outline, *outline[:1]] if len(outline) > 2 else outline):
            segments += list(pairwise(globe.flat(great_arc(start, end))[::6]))
    flat = {name: globe.flat(place) for name, place in places.items()}
    offset = globe.sign + 0.85 * NAME_POINTS * point
    for name, centre in label_places(flat, segments, offset, NAME_POINTS * point).items():
        axes.text(
            centre[0],
            centre[1],
            plain(name),
            fontsize=NAME_POINTS,
            color=INK,
            ha="center",
            va="center",
            zorder=8,
        )


def arcs_on_paper(globe: Globe, sample: int) -> list[tuple[Array, Array]]:
    """Pieces of the links' arcs, for texts to keep clear of."""
    places = globe.at(sample)
    found: list[tuple[Array, Array]] = []
    for link in globe.mechanism.links.values():
        outline = [places[name] for name in corners(link) if name in places]
        for start, end in pairwise(outline):
            found += list(pairwise(globe.flat(great_arc(start, end))[::6]))
    return found
