"""What is drawn: links, points on links, guides."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from centrode.app.edit_drags import follows_from_points, local_place
from centrode.app.patches import Operation, Patch
from centrode.app.sketch import Vector, guide_name, on_unit_sphere
from centrode.app.text_changes import TextChanges
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.reading import FRAME, two_points, value_text
from centrode.model.values import cross

QUARTER = math.pi / 2


def add_link(patch: Patch, operation: Operation) -> None:
    """Draw a link from one place or point to another; a place on a link becomes a point of that link."""
    ends = [patch.place_of(operation, "at"), patch.place_of(operation, "to")]
    names = [_end_of(patch, operation, key, end) for key, end in zip(("from", "to"), ends, strict=True)]
    sketch = patch.drawn_sketch()
    for k, end_name in enumerate(names):
        if end_name is not None:
            if end_name not in sketch.places:
                raise InputError(end_name, _("its place is not known: correct the description first"))
            ends[k] = sketch.places[end_name]
    if names[0] is not None and names[0] == names[1]:
        raise InputError("", _("a link joins two different points"), _("drop it on another point"))
    for link, points in sketch.links.items():
        if names[0] in points and names[1] in points:
            what = _("points {first} and {second} both belong to {link}")
            raise InputError("", what.format(first=names[0], second=names[1], link=link), "")
    if math.dist(*ends) <= 1e-6 * sketch.size:
        raise InputError("", _("the link is too short"), _("draw it longer"))
    if patch.sketch.draws_points:
        first, second = (name or patch.new_point(end) for name, end in zip(names, ends, strict=True))
        _add_link_of_points(patch, first, second)
        return
    _add_measured_link(patch, names, ends)


def _end_of(patch: Patch, operation: Operation, key: str, place: Vector) -> str | None:
    """The point at an end of a link that is drawn: one that was there, a new one of the link below, or None."""
    if operation.get(f"{key}_point") is not None:
        return patch.point_of(operation, f"{key}_point")
    if operation.get(f"{key}_link") is None:
        return None
    add_point(patch, {"link": operation[f"{key}_link"], "at": list(place)})
    return patch.named[-1]


def _add_link_of_points(patch: Patch, first: str, second: str) -> None:
    name = patch.link_name(first, second)
    patch.add_table(("links", name), {} if two_points(name) else {"points": [first, second]})
    patch.named.append(name)


def _add_measured_link(patch: Patch, names: list[str | None], ends: list[Vector]) -> None:
    """A link with a length and an angle, from a point whose place is known."""
    if names[0] is None and names[1] is not None:
        names, ends = names[::-1], ends[::-1]
    free = patch.free_names()
    first, second = names
    if first is None:
        first = next(free)
        patch.write((("frame", "points", first), patch.pair(ends[0])))
        patch.named.append(first)
    if second is None:
        second = next(name for name in free if name != first)
        patch.named.append(second)
    (x, y), (u, v) = ends[0][:2], ends[1][:2]
    name = patch.link_name(first, second)
    entries: dict[str, Any] = {} if two_points(name) else {"points": [first, second]}
    entries["length"] = patch.length(math.hypot(u - x, v - y))
    entries["angle"] = patch.angle(math.atan2(v - y, u - x))
    patch.add_table(("links", name), entries)
    patch.named.append(name)


def add_point(patch: Patch, operation: Operation) -> None:
    """Give a link a further point: a new one at a place, or one that is there already and is hinged to it."""
    sketch = patch.drawn_sketch()
    link, point = operation.get("link"), operation.get("point")
    if not isinstance(link, str) or link not in sketch.links:
        raise InputError("", _("unknown link {name}").format(name=value_text(link)))
    name = next(patch.free_names()) if point is None else patch.point_of(operation)
    if point is not None and name not in sketch.places:
        raise InputError(name, _("its place is not known: correct the description first"))
    place = patch.place_of(operation, "at") if point is None else sketch.places[name]
    if name in sketch.links[link]:
        raise InputError("", _("link {link} has this point already").format(link=link))
    points = sketch.links[link]
    if any(sketch.guides[k].get("on", FRAME) == link for k in sketch.guides_of(name)):
        raise InputError(name, _("this point slides in a guide: remove the guide first"))
    if f"links.{link}.length" in sketch.marks["locked"]:
        patch.set_mark("locked", f"links.{link}.length", False)  # of more than two points none is the length
    if follows_from_points(sketch, link):
        if point is None:
            patch.new_point(place, name)
        patch.write((("links", link, "points"), [*points, name]))
    elif link not in sketch.poses:
        raise InputError(link, _("its place is not known: correct the description first"))
    else:
        if point is None:
            patch.named.append(name)
        local = sketch.local(link)
        own = patch.pair(local_place(sketch.poses[link], place))
        table = sketch.tables["links"][link].get("points")
        if isinstance(table, Mapping):
            patch.write((("links", link, "points", name), own))
        else:
            length = sketch.tables["links"][link].get("length")
            written = {one: patch.pair(at) for one, at in local.items()}
            if length is not None and len(points) == 2:
                written[points[1]] = [length, 0]
            changes = TextChanges(patch.text)
            if length is not None:
                changes.set(("links", link, "length"), 0)
                changes.rename_key(("links", link, "length"), "points") if table is None else None
            if table is not None:
                changes.remove(("links", link, "length")) if length is not None else None
            changes.set(("links", link, "points"), {**written, name: own})
            patch.text = changes.text
            patch.changed.append(f"links.{link}.points")


def add_guide(patch: Patch, operation: Operation) -> None:
    """Draw a line in which a point slides, of the frame or of a link; on the sphere a great circle of the frame."""
    sketch = patch.drawn_sketch()
    on = operation.get("on", FRAME)
    if on != FRAME and (sketch.on_sphere or on not in sketch.links):
        raise InputError("", _("unknown link {name}").format(name=value_text(on)))
    place = patch.place_of(operation, "at")
    direction = operation.get("direction", 0.0)
    pole: Vector | None = None
    if sketch.on_sphere:
        pole = _pole(place, patch.place_of(operation, "to"))
    elif isinstance(direction, list):
        x, y = patch.place_of(operation, "direction")
        direction = math.atan2(y, x)
    if isinstance(direction, bool) or not isinstance(direction, int | float) or not math.isfinite(direction):
        raise InputError("", _("a direction is an angle"))
    if operation.get("point") is None:
        if not patch.sketch.draws_points:
            raise InputError("", _("a guide needs a point that slides in it"), _("begin it at a joint"))
        name = patch.new_point(place)
    else:
        name = patch.point_of(operation)
    guide_point(patch, name, float(direction), pole, on)


def _pole(one: Vector, other: Vector) -> Vector:
    """Pole of the great circle through two places."""
    (x, y, z), (u, v, w) = one, other
    pole = on_unit_sphere(cross((x, y, z), (u, v, w)))
    if pole is None:
        raise InputError("", _("the line is too short"), _("draw it longer"))
    return pole


def guide_point(
    patch: Patch, point: str, direction: float, pole: Vector | None = None, on: str = FRAME
) -> None:
    """Let a point slide in a straight line through it at an angle [rad] of the frame or of a link, or in the circle
    about a pole.
    """
    sketch = patch.sketch
    if on == FRAME and point in sketch.frame_points:
        raise InputError(point, _("a point of the frame does not slide: switch Ground off first"))
    if on != FRAME and point in sketch.links[on]:
        raise InputError(point, _("this point belongs to {link}: it does not slide in it").format(link=on))
    if sketch.guides_of(point):
        raise InputError(point, _("this point slides in a guide already"))
    if on != FRAME and on not in sketch.poses:
        raise InputError(on, _("its place is not known: correct the description first"))
    entries: dict[str, Any] = {"point": point, "on": on}
    if sketch.on_sphere:
        # the circle about a pole goes through the point: to the east where nobody says
        place = sketch.places.get(point, (1.0, 0.0, 0.0))
        entries["pole"] = patch.pair(pole or _pole(place, (-place[1], place[0], 0.0)))
        _add_guide_entry(patch, entries)
        return
    if not (sketch.is_short_form and point in sketch.tables["points"]):
        if point not in sketch.places:
            raise InputError(point, _("its place is not known: correct the description first"))
        place = sketch.places[point]
        entries["through"] = patch.pair(place if on == FRAME else local_place(sketch.poses[on], place))
    turned = 0.0 if on == FRAME else sketch.poses[on][1]
    entries["direction"] = written_direction(patch, direction - turned)
    _add_guide_entry(patch, entries)


def _add_guide_entry(patch: Patch, entries: Mapping[str, Any]) -> None:
    patch.add_entry("guides", entries)
    patch.named.append(guide_name(patch.sketch, len(patch.sketch.guides) - 1))


def written_direction(patch: Patch, angle: float) -> Any:
    """A direction as the file writes it: axes as vectors, others as angles."""
    for turn, pair in ((0.0, [1, 0]), (QUARTER, [0, 1])):
        if abs(math.remainder(angle - turn, math.pi)) < 1e-6:
            return pair
    return patch.angle(math.remainder(angle, math.pi))
