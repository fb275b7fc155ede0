"""Copies beside what is chosen, and mirror images in its place."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from operator import mul
from typing import Any

from centrode.app.drawing_operations import written_direction
from centrode.app.edit_drags import local_place, new_pose, reshaped_by, written_place
from centrode.app.patches import Operation, Patch
from centrode.app.sketch import (
    Pose,
    SketchParts,
    Vector,
    coordinates,
    direction_angle,
    guide_name,
    on_unit_sphere,
    shown_place,
)
from centrode.app.state_rows import set_ground
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.reading import FRAME, Place, two_points
from centrode.model.values import cross

QUARTER = math.pi / 2
BESIDE = math.pi / 12
"""Angle [rad] by which a copy stands beside what it is of, on the sphere."""
ON_AXIS = 1e-9
"""Angle [rad] within which a line is its own mirror image."""
FRAME_POSE: Pose = ((0.0, 0.0), 0.0)
"""Axes of the frame."""
POLAR = 1e-6
"""Distance [rad] from a pole within which no direction is east."""


def duplicate(patch: Patch, operation: Operation) -> None:
    """Put copies beside what is chosen: moved `by` a way [m], on the sphere turned `about` an axis by an angle."""
    sketch = patch.drawn_sketch()
    links, points = _links_and_points(patch, patch.objects_of(operation))
    for point in points:
        if point not in sketch.places:
            raise InputError(point, _("its place is not known: correct the description first"))
    if sketch.on_sphere:
        places = _turned_places(patch, operation, {point: sketch.places[point] for point in points})
    else:
        by = patch.place_of(operation, "by")
        if not sketch.draws_points:
            measured = _duplicate_measured(patch, links, points, by)
            _copy_guides(patch, sketch, operation["objects"], *measured, by)
            return
        places = {
            point: (sketch.places[point][0] + by[0], sketch.places[point][1] + by[1]) for point in points
        }
    new = {point: patch.new_point(place) for point, place in places.items()}
    copies: dict[str, str] = {FRAME: FRAME}
    for point in points:
        if point in sketch.frame_points:
            set_ground(patch, new[point], True)
    for link in links:
        _copy_link(patch, sketch, link, new)
        copies[link] = patch.named[-1]
    if not sketch.on_sphere:
        _copy_guides(patch, sketch, operation["objects"], copies, new, by)


def _copy_guides(
    patch: Patch,
    sketch: SketchParts,
    chosen: Sequence[str],
    copies: Mapping[str, str],
    new: Mapping[str, str],
    by: Vector,
) -> None:
    """Copies of the guides that are chosen with their point and the link that carries them, moved `by` a way [m]."""
    for k, guide in enumerate(sketch.guides):
        point, on = str(guide.get("point")), str(guide.get("on", FRAME))
        if guide_name(sketch, k) not in chosen or point not in new or on not in copies:
            continue
        entries = {"point": new[point], "on": copies[on]}
        through = guide.get("through")
        if isinstance(through, str) and through in new:
            entries["through"] = new[through]
        elif through is not None:
            entries["through"] = _moved_place(patch, through, by) if on == FRAME else through
        entries["direction"] = guide["direction"]
        # of a slider that stays behind the copy keeps neither the name nor the angle to the line
        if guide.get("link") in copies:
            entries["link"] = copies[guide["link"]]
            entries |= {"angle": guide["angle"]} if "angle" in guide else {}
        patch.add_entry("guides", entries)
        patch.named.append(guide_name(patch.sketch, len(patch.sketch.guides) - 1))


def _moved_place(patch: Patch, given: Any, by: Vector) -> Any:
    """A place in the frame as the file writes it, moved; a name, or what the initial position gives, stays."""
    place = coordinates(given)
    if place is None:
        return given
    moved = patch.pair((place[0] + by[0], place[1] + by[1]))
    return {"placed": moved} if isinstance(given, Mapping) else moved


def _turned_places(patch: Patch, operation: Operation, places: Mapping[str, Vector]) -> dict[str, Vector]:
    """Places on the sphere, turned; without an axis, along the parallel of their middle."""
    angle = operation.get("angle", BESIDE)
    if isinstance(angle, bool) or not isinstance(angle, int | float) or not math.isfinite(angle):
        raise InputError("", _("a number is needed"))
    _east, north = _directions(_middle(places.values()))
    axis = north if operation.get("about") is None else patch.place_of(operation, "about")
    return {name: rotate_about(place, axis, angle) for name, place in places.items()}


def _middle(places: Iterable[Vector]) -> Vector:
    """The place in the middle of others on the sphere; the first of them where they surround its centre."""
    all_places = list(places)
    total = tuple(map(sum, zip(*all_places, strict=True)))
    return on_unit_sphere(total) or all_places[0]


def _directions(place: Vector) -> tuple[Vector, Vector]:
    """East and north at a place of the sphere; at the poles along the meridian of x."""
    across = on_unit_sphere((-place[1], place[0], 0.0)) if math.hypot(*place[:2]) > POLAR else None
    east = (0.0, 1.0, 0.0) if across is None else across
    return east, _cross(place, east)


def _cross(one: Vector, other: Vector) -> Vector:
    (x, y, z), (u, v, w) = one, other
    return cross((x, y, z), (u, v, w))


def rotate_about(place: Vector, axis: Vector, angle: float) -> Vector:
    """A place of the sphere turned about an axis by an angle [rad] (the formula of Rodrigues)."""
    cosine, sine = math.cos(angle), math.sin(angle)
    along, across = sum(map(mul, place, axis)), _cross(axis, place)
    turned = (
        x * cosine + y * sine + z * along * (1.0 - cosine)
        for x, y, z in zip(place, across, axis, strict=True)
    )
    return tuple(turned)


def reflect_in_plane(place: Vector, normal: Vector) -> Vector:
    """The mirror image of a place of the sphere in the plane through its centre with a unit normal."""
    off = sum(map(mul, place, normal))
    return tuple(x - 2.0 * off * y for x, y in zip(place, normal, strict=True))


def _copy_link(patch: Patch, sketch: SketchParts, link: str, new: Mapping[str, str]) -> None:
    first, *rest = (new[point] for point in sketch.links[link])
    name = patch.link_name(first, rest[0]) if len(rest) == 1 else patch.numbered_name()
    table = dict(sketch.tables["links"][link])
    table.pop("points", None)
    if isinstance(table.get("centre"), str):
        table["centre"] = new[table["centre"]]
    points = sketch.tables["links"][link].get("points")
    if isinstance(points, Mapping):
        entries = {"points": {new[key]: value for key, value in points.items()}, **table}
    else:
        entries = table if two_points(name) else {"points": [first, *rest], **table}
    patch.add_table(("links", name), entries)
    patch.named.append(name)


def _duplicate_measured(
    patch: Patch, links: Sequence[str], points: Sequence[str], by: Vector
) -> tuple[dict[str, str], dict[str, str]]:
    """Copies of links with lengths and angles: each part of them hangs on a point of the frame.

    The names of links and points are given with those of their copies.
    """
    sketch = patch.sketch
    anchors = [point for point in points if point in sketch.frame_points]
    # a part that no point of the frame carries gets one: everything else hangs on it by lengths and angles
    anchors += [part[0] for part in _parts(sketch, links, points) if not set(part) & set(anchors)]
    free = patch.free_names()
    new = {point: next(free) for point in points}
    patch.named += new.values()
    for point in anchors:
        place = sketch.places[point]
        patch.write((("frame", "points", new[point]), patch.pair((place[0] + by[0], place[1] + by[1]))))
    copies = {FRAME: FRAME}
    for link in links:
        _copy_link(patch, sketch, link, new)
        name = copies[link] = patch.named[-1]
        if sketch.angle(link) is None or sketch.tables["links"][link].get("angle") is None:
            patch.write((("links", name, "angle"), patch.angle(sketch.poses[link][1])))
    return copies, new


def _parts(sketch: SketchParts, links: Sequence[str], points: Sequence[str]) -> list[list[str]]:
    """Points that links join with each other, part by part."""
    parts: list[list[str]] = [[point] for point in points]
    for link in links:
        joined = [part for part in parts if set(part) & set(sketch.links[link])]
        parts = [part for part in parts if part not in joined] + [
            [point for part in joined for point in part]
        ]
    return parts


def _links_and_points(patch: Patch, objects: Sequence[str]) -> tuple[list[str], list[str]]:
    """Links and points that are chosen; links bring their points."""
    sketch = patch.sketch
    links = [name for name in objects if name in sketch.links]
    points = [point for link in links for point in sketch.links[link]]
    points += [name for name in objects if name in sketch.points and name not in sketch.links]
    if not points:
        raise InputError("", _("nothing is chosen"), _("choose a point or a link"))
    return links, list(dict.fromkeys(points))


def mirror(patch: Patch, operation: Operation) -> None:
    """Put what is chosen at its mirror image in a line, on the sphere in a great circle."""
    sketch = patch.sketch
    _links, points = _links_and_points(patch, patch.objects_of(operation))
    known = [sketch.places[one] for one in points if one in sketch.places]
    if len(known) < len(points):
        raise InputError("", _("its place is not known: correct the description first"))
    for point in points:
        if point in sketch.marks["fixed"]:
            raise InputError(point, _("this joint is held: switch Fixed off to drag it"))
    guides: dict[Place, Any] = {}
    if sketch.on_sphere:
        normal = _circle_of_mirror(patch, operation.get("axis"), known)
        moved = {point: reflect_in_plane(sketch.places[point], normal) for point in points}
    else:
        axis, direction = _axis(patch, operation.get("axis"), known)
        moved = {point: _reflect_in_line(sketch.places[point], axis, direction) for point in points}
        guides = dict(_mirrored_guides(patch, moved, axis, direction))
    patch.write(*reshaped_by(sketch, moved, patch.folder, also=guides).assignments)


def _mirrored_guides(
    patch: Patch, moved: Mapping[str, Vector], axis: Vector, direction: float
) -> Iterator[tuple[Place, Any]]:
    """Lines of the points that are mirrored: of the frame, and of links that are mirrored whole."""
    sketch = patch.sketch
    for k, guide in enumerate(sketch.guides):
        point, on = str(guide.get("point")), str(guide.get("on", FRAME))
        if point not in moved or not (on == FRAME or set(sketch.links.get(on, (FRAME,))) <= set(moved)):
            continue
        before: Pose | None = FRAME_POSE
        after: Pose | None = FRAME_POSE
        if on != FRAME:
            # the axes of a link may be mirrored with it, or stay as they are
            before, after = sketch.poses.get(on), new_pose(sketch, on, moved)
        angle, through = direction_angle(guide.get("direction")), coordinates(guide.get("through"))
        if angle is None or before is None or after is None:
            continue
        turn = 2.0 * direction - before[1] - after[1]
        if abs(math.remainder(turn - 2.0 * angle, math.pi)) > ON_AXIS:
            written = written_direction(patch, turn - angle)
            yield ("guides", k, "direction"), written
            angle = direction_angle(written) or 0.0
        if through is None:
            continue
        image = local_place(after, _reflect_in_line(shown_place(before, through), axis, direction))
        yield from written_place(sketch, ("guides", k, "through"), image)
        for drive in sketch.drives_of(str(guide.get("name", point))) if on == FRAME else ():
            slide = math.cos(angle) * (moved[point][0] - image[0]) + math.sin(angle) * (
                moved[point][1] - image[1]
            )
            if sketch.drives[drive].get("start") is not None:
                yield ("drives", drive, "start"), patch.length(slide, sketch.drives[drive]["start"])


def _reflect_in_line(place: Vector, axis: Vector, direction: float) -> tuple[float, float]:
    """The mirror image of a place in a line through another one, at an angle [rad]."""
    cosine, sine = math.cos(2.0 * direction), math.sin(2.0 * direction)
    u, v = place[0] - axis[0], place[1] - axis[1]
    return axis[0] + u * cosine + v * sine, axis[1] + u * sine - v * cosine


def _circle_of_mirror(patch: Patch, axis: Any, places: Sequence[Vector]) -> Vector:
    """Pole of the great circle that mirrors: through the middle of places, or through two places."""
    if axis in ("x", "horizontal", "y", "vertical", None):
        east, north = _directions(_middle(places))
        return north if axis in ("x", "horizontal") else east
    if isinstance(axis, list) and len(axis) == 2:
        first, second = (patch.place_of({"axis": one}, "axis") for one in axis)
        pole = on_unit_sphere(_cross(first, second))
        if pole is not None:
            return pole
    raise InputError("", _('an axis is "x", "y" or two places'))


def _axis(patch: Patch, axis: Any, places: Sequence[Vector]) -> tuple[Vector, float]:
    """A place on the axis of a mirror, and its direction."""
    if axis in ("x", "horizontal", "y", "vertical", None):
        middle = tuple((min(x) + max(x)) / 2 for x in zip(*places, strict=True))
        return middle, 0.0 if axis in ("x", "horizontal") else QUARTER
    if isinstance(axis, list) and len(axis) == 2:
        first, second = (patch.place_of({"axis": one}, "axis") for one in axis)
        if first != second:
            return first, math.atan2(second[1] - first[1], second[0] - first[0])
    raise InputError("", _('an axis is "x", "y" or two places'))
