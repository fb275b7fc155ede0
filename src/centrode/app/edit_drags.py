"""A joint dragged to another place: which lengths, coordinates and angles of the description change with it."""

from __future__ import annotations

import copy
import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from operator import mul
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeAlias

from centrode.app.quantity_texts import written_quantity
from centrode.app.sketch import (
    Pose,
    SketchParts,
    Vector,
    guide_circle,
    guide_line,
    list_of_tables,
    number,
    on_unit_sphere,
)
from centrode.app.sphere_drags import sphere_assignments
from centrode.errors import CentrodeError, InputError
from centrode.kinematics.preparation import Ready, ready
from centrode.locale import _
from centrode.model.description import coordinate_of_drive
from centrode.model.files import value_at, with_values
from centrode.model.mechanism import Mechanism
from centrode.model.placement import rotate_vector
from centrode.model.reading import FRAME, Place
from centrode.model.toml import bare_angles_of, validated_tables

from pydantic import ValidationError  # isort: skip

Assignment: TypeAlias = tuple[Place, Any]
"""A key of the description and its new value, as the file holds it."""

STANDS = 2e-4
"""So far [of the extent] a joint may stand from where it was dragged to: numbers of a file are rounded."""
ON_LINE = 3e-5
"""Points nearer than this [of the extent] to the line of two joints keep their ratio on it, as numbers are rounded."""
APART = 1e-9
"""Places farther apart than this [of the extent] are two."""
SHORTEST = 1e-9
"""Shortest link [of the extent]."""
OTHER_SIDE = {"left": "right", "right": "left", "ahead": "behind", "behind": "ahead"}


@dataclass(frozen=True)
class ReshapedDescription:
    """A description after a drag.

    Attributes
    ----------
    assignments : what is to be written
    tables : of the description with that
    prepared : the mechanism in its initial position; None while it cannot move
    places : of its points [m]
    values : path -> number [SI], for who drags
    held : why the joint does not follow the cursor; empty if it does
    """

    assignments: tuple[Assignment, ...]
    tables: Mapping[str, Any]
    prepared: Ready | None
    places: Mapping[str, Vector]
    values: Mapping[str, float]
    held: str = ""


def reshape(
    sketch: SketchParts, point: str, to: Vector, folder: Path, *, exactly: bool = False
) -> ReshapedDescription:
    """The description with a joint at another place, or as near to it as locks and guides let it come.

    Raises InputError for a point that cannot be dragged.
    """
    why = edit_refusal(sketch, point)
    if why:
        raise InputError(point, why)
    if sketch.on_sphere:
        goal = on_unit_sphere(to) if len(to) == 3 else None
        if goal is None:
            raise InputError(point, _("a place on the sphere is three numbers"))
        allowed, held = allowed_on_sphere(sketch, point, goal)
    elif len(to) != 2 or not all(map(math.isfinite, to)):
        raise InputError(point, _("a place is two numbers"))
    else:
        allowed, held = allowed_place(sketch, point, (to[0], to[1]))
    return reshaped_by(sketch, moved_with(sketch, point, allowed), folder, held=held, exactly=exactly)


def reshaped_by(
    sketch: SketchParts,
    moved: Mapping[str, Vector],
    folder: Path,
    *,
    held: str = "",
    exactly: bool = False,
    also: Mapping[Place, Any] = MappingProxyType({}),
) -> ReshapedDescription:
    """The description with some points at other places, everything else standing but what is `also` written.

    Raises InputError where it would not assemble so.
    """
    assignments = tuple(
        (place, value)
        for place, value in {**dict(reshaping_assignments(sketch, moved, exactly=exactly)), **also}.items()
        if value != value_at_place(sketch.tables, place)
    )
    tables: Mapping[str, Any] = with_assignments(sketch.tables, assignments)
    if sketch.document.prepared is None:
        places = {**sketch.places, **moved}
        return ReshapedDescription(assignments, tables, None, places, _values(sketch, places, moved), held)
    try:
        prepared, assignments, tables = _assemble(sketch, assignments, tables, moved, folder)
    except CentrodeError:
        if exactly:
            raise
        # at a limit, and with redundant constraints, rounded numbers may not close
        return reshaped_by(sketch, moved, folder, held=held, exactly=True, also=also)
    at = prepared.assembled.positions.points
    places = {name: tuple(map(float, at[name])) for name in sketch.points if name in at}
    return ReshapedDescription(assignments, tables, prepared, places, _values(sketch, places, moved), held)


def _assemble(
    sketch: SketchParts,
    assignments: tuple[Assignment, ...],
    tables: Mapping[str, Any],
    moved: Mapping[str, Vector],
    folder: Path,
) -> tuple[Ready, tuple[Assignment, ...], Mapping[str, Any]]:
    """The reshaped mechanism in its initial position, on the sides on which the points stand where they were put."""
    sides = sketch.tables.get("assembly", {}).get("sides", {})
    turned = [(("assembly", "sides", key), OTHER_SIDE.get(side, side)) for key, side in sides.items()]
    failure: CentrodeError | None = None
    # as it is, with one group on its other side, with all of them
    for others in ((), *((one,) for one in turned), tuple(turned)):
        changed = with_assignments(sketch.tables, (*assignments, *others)) if others else tables
        try:
            prepared = prepared_from(changed, folder)
        except CentrodeError as error:
            failure = failure or error
            continue
        if all(_stands(sketch, prepared, point, place) for point, place in moved.items()):
            return prepared, (*assignments, *others), changed
    if failure is not None:
        raise failure
    what = _("with these lengths the joint would not stand there")
    raise InputError(next(iter(moved)), what, _("drag it another way"))


def _stands(sketch: SketchParts, prepared: Ready, point: str, place: Vector) -> bool:
    at = prepared.assembled.positions.points[point]
    return math.dist(tuple(map(float, at)), place) <= STANDS * sketch.size


def prepared_from(tables: Mapping[str, Any], folder: Path) -> Ready:
    """The mechanism of tables in its initial position; InputError where there is none."""
    try:
        return ready(validated_tables(Mechanism, tables, folder, bare_angles_of(tables)))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        raise InputError("", str(first["msg"]).removeprefix("Value error, ")) from None


def with_assignments(tables: Mapping[str, Any], assignments: tuple[Assignment, ...]) -> dict[str, Any]:
    """Tables with other values at some keys."""
    changed: dict[str, Any] = copy.deepcopy(dict(tables))
    for place, value in assignments:
        container: Any = changed
        for key in place[:-1]:
            container = container.setdefault(key, {}) if isinstance(container, dict) else container[key]
        container[place[-1]] = value
    return changed


def _values(
    sketch: SketchParts, places: Mapping[str, Vector], moved: Mapping[str, Vector]
) -> dict[str, float]:
    """Lengths and coordinates that change, by their paths."""
    values: dict[str, float] = {}
    for name, points in sketch.links.items():
        if len(points) == 2 and any(point in moved for point in points) and all(p in places for p in points):
            values[f"links.{name}.length"] = sketch.distance(places[points[0]], places[points[1]])
    for point in moved:
        room = "points" if sketch.is_short_form else "frame.points"
        if sketch.is_short_form or point in sketch.frame_points:
            numbers = zip(sketch.axes, sketch.numbers_of(places[point]), strict=True)
            values |= {f"{room}.{point}.{axis}": x for axis, x in numbers}
    return values


# Another number of a mechanism that moves: the initial position follows on its side.

FOLLOWED = (1, 4, 16, 64)
"""Steps in which a number is changed, until the initial position follows."""


def follow(sketch: SketchParts, path: str, number: float) -> Ready:
    """The mechanism with another number at a path [SI], in the initial position that goes on from the present one.

    Raises InputError where it cannot be assembled on the way, or where the number does not fit.
    """
    mechanism = sketch.document.require_mechanism()
    old = value_at(mechanism, path)
    failure: CentrodeError | None = None
    for steps in FOLLOWED:
        try:
            prepared = sketch.document.require_prepared()
            for k in range(1, steps + 1):
                value = old + (number - old) * k / steps
                prepared = ready(_mechanism_with(prepared, path, value))
            return prepared
        except CentrodeError as error:
            failure = error
    assert failure is not None
    if any(failure.where == f"[links.{name}] angle" for name in sketch.links if sketch.angle(name) is None):
        # that angle is the position of the last step, in which a link jumps where its group comes to its limit
        what = _("before this number is reached, a group of the initial position does not close any more")
        raise InputError("", what, _("take a number nearer to the present one")) from failure
    raise failure


def _mechanism_with(prepared: Ready, path: str, value: float) -> Mechanism:
    """The mechanism of an initial position with another number, its links' angles those of that position."""
    mechanism = prepared.mechanism
    driven = next((link for link in mechanism.links if path == f"drives.{link}.start"), None)
    values: dict[str, float] = {
        f"links.{name}.angle": prepared.assembled.angles[name]
        for name, link in mechanism.links.items()
        if link.angle is not None and name in prepared.assembled.angles
    }
    values |= {path: value}
    if driven is not None and f"links.{driven}.angle" in values:
        values[f"links.{driven}.angle"] = value
    return with_values(mechanism, values)


def written_position(sketch: SketchParts, prepared: Ready, left: Collection[Place]) -> Iterator[Assignment]:
    """What the text says of the initial position, as it is in another one: coordinates of points, angles of links."""
    at = prepared.assembled.positions.points
    for point, place in sketch.places.items():
        now = tuple(map(float, at[point]))
        apart = math.dist(now, place) > APART * sketch.size
        if apart and sketch.is_short_form and point in sketch.tables["points"]:
            place_of_point: Place = ("points", point)
            for key_of_point, number_there in written_place(sketch, place_of_point, now):
                if number_there != value_at_place(sketch.tables, key_of_point):
                    yield key_of_point, number_there
    for name in sketch.links:
        key: Place = ("links", name, "angle")
        old_angle = value_at_place(sketch.tables, key)
        if old_angle is not None and key not in left and name in prepared.assembled.angles:
            angle = near_angle(float(prepared.assembled.angles[name]), sketch.angle(name))
            value = written_quantity(sketch, old_angle, angle, "angle")
            if (
                value != old_angle
                and abs(
                    angle
                    - sketch.poses[name][1]
                    - math.tau * round((angle - sketch.poses[name][1]) / math.tau)
                )
                > 1e-9
            ):
                yield key, value
    for k, drive in enumerate(sketch.drives):
        place_of_start: Place = ("drives", k, "start")
        link = drive.get("link")
        if (
            link
            and drive.get("start") is not None
            and place_of_start not in left
            and drive.get("relative_to", FRAME) == FRAME
        ):
            start = near_angle(float(prepared.assembled.angles[link]), sketch.angle(link))
            value = written_quantity(sketch, drive["start"], start, "angle")
            old_start = number(drive["start"], "angle")
            if old_start is not None and abs(start - old_start) > 1e-9:
                yield place_of_start, value


# Where the joint may stand: guides and locked lengths hold.


def edit_refusal(sketch: SketchParts, name: str) -> str:
    """Why a point cannot be dragged to change lengths; empty where it can."""
    if name in sketch.marks["fixed"]:
        return _("this joint is held: switch Fixed off to drag it")
    if name not in sketch.places:
        return _("its place is not known: correct the description first")
    wheels = list_of_tables(sketch.tables, "rolling")
    turned = {wheel.get("centre") for wheel in wheels}
    if name in turned:
        return _("the centre of a rolling wheel follows from its track: change the radii in the text")
    return ""


def allowed_place(sketch: SketchParts, point: str, to: tuple[float, float]) -> tuple[Vector, str]:
    """The place nearest to a wish at which guides and locked lengths hold, and why it is not the wish itself."""
    lines = [
        (through, direction)
        for k in sketch.guides_of(point)
        for through, direction in [guide_line(sketch, k)]
        if through is not None and direction is not None
    ]
    circles = list(_locked_circles(sketch, point))
    if len(lines) + len(circles) > 2 or len(lines) > 1:
        return sketch.places[point], _("what is locked leaves this joint no freedom")
    if lines and circles:
        return _nearest_of(_on_line_and_circle(lines[0], circles[0]), to, sketch.places[point])
    if len(circles) == 2:
        return _nearest_of(_on_circles(*circles), to, sketch.places[point])
    if lines:
        return on_line(lines[0][0], lines[0][1], to), _("the joint stays on its guide")
    if circles:
        return _on_circle(circles[0], to), _("the locked length holds")
    return to, ""


def allowed_on_sphere(sketch: SketchParts, point: str, to: Vector) -> tuple[Vector, str]:
    """The same on the sphere: a guide is a circle about its pole, a locked length one about the link's other point."""
    circles: list[tuple[Vector, float]] = []
    for k in sketch.guides_of(point):
        circle = guide_circle(sketch, k)
        if circle is not None:
            circles.append(circle)
    guided = bool(circles)
    circles += _locked_circles(sketch, point)
    if not circles:
        return to, ""
    if len(circles) > 1:
        return sketch.places[point], _("what is locked leaves this joint no freedom")
    pole, radius = circles[0]
    way = on_unit_sphere(tuple(x - sum(map(mul, to, pole)) * y for x, y in zip(to, pole, strict=True)))
    if way is None:
        return sketch.places[point], _("what is locked leaves this joint no freedom")
    allowed = tuple(math.cos(radius) * y + math.sin(radius) * x for x, y in zip(way, pole, strict=True))
    return allowed, _("the joint stays on its guide") if guided else _("the locked length holds")


def _locked_circles(sketch: SketchParts, point: str) -> Iterator[tuple[Vector, float]]:
    """Centre and radius of the circles on which locked lengths keep a point, about the other points of its links."""
    for name in sketch.owners(point):
        length = sketch.length(name)
        if f"links.{name}.length" in sketch.marks["locked"] and length is not None:
            other = next(one for one in sketch.links[name] if one != point)
            if other in sketch.places:
                yield sketch.places[other], length


def on_line(through: Vector, direction: float, to: Vector) -> Vector:
    """The foot of the perpendicular from a place onto a line."""
    cosine, sine = math.cos(direction), math.sin(direction)
    way = (to[0] - through[0]) * cosine + (to[1] - through[1]) * sine
    return through[0] + way * cosine, through[1] + way * sine


def _on_circle(circle: tuple[Vector, float], to: Vector) -> Vector:
    (x, y), radius = circle[0][:2], circle[1]
    apart = math.hypot(to[0] - x, to[1] - y)
    if apart == 0.0:
        return x + radius, y
    return x + radius * (to[0] - x) / apart, y + radius * (to[1] - y) / apart


def _on_line_and_circle(line: tuple[Vector, float], circle: tuple[Vector, float]) -> list[Vector]:
    foot = on_line(line[0], line[1], circle[0])
    rest = circle[1] ** 2 - math.dist(foot, circle[0][:2]) ** 2
    if rest < 0.0:
        return []
    way = math.sqrt(rest)
    cosine, sine = math.cos(line[1]), math.sin(line[1])
    return [(foot[0] + sign * way * cosine, foot[1] + sign * way * sine) for sign in (1.0, -1.0)]


def _on_circles(one: tuple[Vector, float], other: tuple[Vector, float]) -> list[Vector]:
    (x, y), (u, v) = one[0][:2], other[0][:2]
    apart = math.hypot(u - x, v - y)
    if apart == 0.0:
        return []
    along = (apart**2 + one[1] ** 2 - other[1] ** 2) / (2.0 * apart)
    # at the ends of the range rounding may make the square negative
    height = math.sqrt(max(one[1] ** 2 - along**2, 0.0))
    cosine, sine = (u - x) / apart, (v - y) / apart
    return [
        (x + along * cosine - sign * height * sine, y + along * sine + sign * height * cosine)
        for sign in (1.0, -1.0)
    ]


def _nearest_of(places: list[Vector], to: Vector, present: Vector) -> tuple[Vector, str]:
    held = _("what is locked leaves this joint no freedom")
    return (min(places, key=lambda place: math.dist(place, to)) if places else present), held


def moved_with(sketch: SketchParts, point: str, place: Vector) -> dict[str, Vector]:
    """The joint at its new place, and points on the line of two joints of a link, which keep their ratio on it."""
    moved = {point: place}
    if sketch.on_sphere:
        return moved
    for name in sketch.owners(point):
        points = sketch.links[name]
        joints = [
            one
            for one in points
            if len(sketch.owners(one)) > 1 or one in sketch.frame_points or sketch.guides_of(one)
        ]
        if point not in joints or len(joints) != 2:
            continue
        other = next(one for one in joints if one != point)
        if other not in sketch.places:
            continue
        base, tip = sketch.places[other], sketch.places[point]
        span = math.dist(base, tip)
        for third in points:
            if third in joints or third not in sketch.places or span == 0.0:
                continue
            x, y = sketch.places[third][0] - base[0], sketch.places[third][1] - base[1]
            off = ((tip[0] - base[0]) * y - (tip[1] - base[1]) * x) / span
            if abs(off) <= ON_LINE * sketch.size:
                share = ((tip[0] - base[0]) * x + (tip[1] - base[1]) * y) / span**2
                moved[third] = (
                    base[0] + share * (place[0] - base[0]),
                    base[1] + share * (place[1] - base[1]),
                )
    return moved


# What is written.


def reshaping_assignments(
    sketch: SketchParts, moved: Mapping[str, Vector], *, exactly: bool = False
) -> Iterator[Assignment]:
    """Keys of the description with the values that put points at other places, everything else standing."""
    places = {**sketch.places, **moved}

    def assignment(place: Place, value: float, kind: str) -> Assignment:
        return place, written_quantity(
            sketch, value_at_place(sketch.tables, place), value, kind, exactly=exactly
        )

    def pair(place: Place, value: Vector) -> Iterator[Assignment]:
        yield from written_place(sketch, place, value, exactly=exactly)

    for point in moved:
        if sketch.is_short_form and point in sketch.tables["points"]:
            yield from pair(("points", point), places[point])
        frame = sketch.tables.get("frame", {}).get("points", {})
        if isinstance(frame, Mapping) and point in frame:
            yield from pair(("frame", "points", point), places[point])
    if sketch.on_sphere:
        yield from sphere_assignments(sketch, moved, assignment, pair)
        return
    turned: dict[str, float] = {}
    for name, points in sketch.links.items():
        if len(points) < 2 or not any(point in moved for point in points):
            continue  # a link of one point goes with it
        if follows_from_points(sketch, name):
            pose = pose_between(places, points)
            if pose is not None:
                turned[name] = pose[1]
            continue
        link = sketch.tables["links"][name]
        if isinstance(link.get("points"), Mapping):
            pose = new_pose(sketch, name, moved)
            if pose is None:
                continue
            for point in points:
                local = local_place(pose, places[point])
                if math.dist(local, sketch.local(name)[point]) > 1e-12 * sketch.size:
                    yield from pair(("links", name, "points", point), local)
        else:
            pose = pose_between(places, points)
            if pose is None:
                raise InputError(f"[links.{name}]", _("its points would coincide"), _("drag it another way"))
            yield assignment(
                ("links", name, "length"), math.dist(places[points[0]], places[points[1]]), "length"
            )
        turned[name] = near_angle(pose[1], sketch.angle(name))
        if link.get("angle") is not None:
            yield assignment(("links", name, "angle"), turned[name], "angle")
    yield from _starts(sketch, places, turned, moved, assignment)


def written_place(
    sketch: SketchParts, place: Place, value: Vector, *, exactly: bool = False
) -> Iterator[Assignment]:
    """Coordinates at a place of the text as the file writes them: on the sphere longitude and latitude."""
    old = value_at_place(sketch.tables, place)
    if isinstance(old, Mapping):  # the place that follows from initial angles is kept with its key
        place, old = (*place, "placed"), old.get("placed")
    kind, numbers = ("angle" if sketch.on_sphere else "length"), sketch.numbers_of(value)
    if isinstance(old, list) and len(old) == 2:
        for axis, number_at_axis in enumerate(numbers):
            key: Place = (*place, axis)
            yield key, written_quantity(sketch, old[axis], number_at_axis, kind, exactly=exactly)
    else:
        yield place, [written_quantity(sketch, None, x, kind, exactly=exactly) for x in numbers]


def _starts(
    sketch: SketchParts,
    places: Mapping[str, Vector],
    turned: Mapping[str, float],
    moved: Mapping[str, Vector],
    assignment: Any,
) -> Iterator[Assignment]:
    """Values at which drives start."""

    def angle_of(link: str) -> float | None:
        if link == FRAME:
            return 0.0
        if link in turned:
            return turned[link]
        return sketch.poses[link][1] if link in sketch.poses else None

    for k, drive in enumerate(sketch.drives):
        link, base = drive.get("link"), drive.get("relative_to", FRAME)
        place: Place = ("drives", k, "start")
        start = number(drive.get("start"), coordinate_of_drive(drive, sketch.space).kind)
        if isinstance(link, str) and (link in turned or base in turned):
            own, other = angle_of(link), angle_of(str(base))
            stated = start is not None or not (
                follows_from_points(sketch, link) or sketch.tables["links"][link].get("angle") is not None
            )
            if own is not None and other is not None and stated:
                yield assignment(place, near_angle(own - other, start), "angle")
        elif isinstance(drive.get("distance"), list) and any(point in moved for point in drive["distance"]):
            first, second = drive["distance"]
            yield assignment(place, math.dist(places[first], places[second]), "length")
        elif isinstance(drive.get("guide"), str):
            guide = next(
                (
                    k
                    for k, one in enumerate(sketch.guides)
                    if one.get("name", one.get("point")) == drive["guide"]
                ),
                None,
            )
            point = "" if guide is None else str(sketch.guides[guide].get("point"))
            if guide is not None and point in moved and start is not None:
                through, direction = guide_line(sketch, guide)
                if through is not None and direction is not None:
                    x, y = places[point][0] - through[0], places[point][1] - through[1]
                    yield assignment(place, x * math.cos(direction) + y * math.sin(direction), "length")


def follows_from_points(sketch: SketchParts, name: str) -> bool:
    """Whether the length and the angle of a link follow from coordinates of its points."""
    link = sketch.tables["links"][name]
    named = not isinstance(link.get("points"), Mapping) and link.get("length") is None
    return sketch.is_short_form and named and len(sketch.links[name]) > 1


def value_at_place(tables: Mapping[str, Any], place: Place) -> Any:
    """The value at a place; None where there is none."""
    value: Any = tables
    for key in place:
        try:
            value = value[key]
        except (KeyError, IndexError, TypeError):
            return None
    return value


def pose_between(places: Mapping[str, Vector], points: tuple[str, ...]) -> Pose | None:
    """Axes from the first point towards the second; None where they coincide or are not known."""
    if len(points) < 2 or any(point not in places for point in points[:2]):
        return None
    (x, y), (u, v) = places[points[0]][:2], places[points[1]][:2]
    if math.hypot(u - x, v - y) == 0.0:
        return None
    return (x, y), math.atan2(v - y, u - x)


def new_pose(sketch: SketchParts, name: str, moved: Mapping[str, Vector]) -> Pose | None:
    """Axes of a link after a drag: from its first point to the second.

    Where it has coordinates of its own they go on lying along the two points along which they lay.
    """
    places = {**sketch.places, **moved}
    if not isinstance(sketch.tables["links"][name].get("points"), Mapping):
        return pose_between(places, sketch.links[name])
    if name not in sketch.poses:
        return None
    origin, angle = sketch.poses[name]
    local = sketch.local(name)
    if len(local) == 1:  # the link goes with its point
        (place,) = local.values()
        x, y = rotate_vector((place[0], place[1]), angle)
        (there,) = (places[point] for point in local)
        return (there[0] - x, there[1] - y), angle
    at_origin = next((point for point, place in local.items() if place == (0.0, 0.0)), None)
    along = [point for point, place in local.items() if place[0] > 0.0 and place[1] == 0.0]
    joints = [one for one in along if len(sketch.owners(one)) > 1 or one in sketch.frame_points]
    # the farther of them, or the joint: a centre of mass moves with it
    tip = max(joints or along, key=lambda point: local[point][0], default=None)
    if at_origin is None or tip is None or not {at_origin, tip} & set(moved):
        return origin, angle
    return pose_between(places, (at_origin, tip)) or (origin, angle)


def local_place(pose: Pose, place: Vector) -> tuple[float, float]:
    """A place in the axes of a pose."""
    (x, y), angle = pose[0][:2], pose[1]
    return rotate_vector((place[0] - x, place[1] - y), -angle)


def near_angle(angle: float, old: float | None) -> float:
    """An angle in the turn that is nearest to an old one."""
    return angle if old is None else angle + math.tau * round((old - angle) / math.tau)
