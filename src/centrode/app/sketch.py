"""What can be drawn of a description, right or not: its points and where they stand, its links, what is marked."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

from centrode.app.documents import Document, Tables
from centrode.errors import InputError
from centrode.model.placement import rotate_vector
from centrode.model.reading import FRAME, two_points
from centrode.model.units import to_si
from centrode.model.values import arc, longitude_latitude, unit_vector
from centrode.quantities import ANGLES, LENGTHS

Vector: TypeAlias = tuple[float, ...]
Pose: TypeAlias = tuple[Vector, float]

MARKS = ("fixed", "locked", "traced")
"""What the workbench notes in a comment: points that hold, lengths that hold, points that are traced."""

_MARK = re.compile(r"^[ \t]*#[ \t]*workbench:[ \t]*(\w+)[ \t]+(.*?)[ \t]*$", re.MULTILINE)


@dataclass(frozen=True)
class SketchParts:
    """The parts of a description by their names, read without complaint: what cannot be read is left out."""

    document: Document

    @property
    def tables(self) -> Tables:
        """Tables of the text."""
        return self.document.tables

    @property
    def on_sphere(self) -> bool:
        """Whether the mechanism is on the sphere."""
        return self.tables.get("space") == "sphere"

    @property
    def space(self) -> str:
        """The space of the mechanism."""
        return "sphere" if self.on_sphere else "plane"

    @property
    def is_short_form(self) -> bool:
        """Whether points have coordinates in the initial position, from which links follow."""
        return isinstance(self.tables.get("points"), Mapping)

    @property
    def draws_points(self) -> bool:
        """Whether what is drawn gets coordinates in the table of points: in a new text, and where others have them."""
        return self.is_short_form or not (self.links or self.frame_points)

    @cached_property
    def frame_points(self) -> tuple[str, ...]:
        """Points of the frame."""
        return tuple(name for name in entries_of(_table(self.tables, "frame").get("points")))

    @cached_property
    def links(self) -> dict[str, tuple[str, ...]]:
        """Points of each link."""
        links = {}
        for name, link in _table(self.tables, "links").items():
            if isinstance(link, Mapping):
                given = entries_of(link.get("points"))
                links[name] = given or (two_points(name) or ())
        return links

    @cached_property
    def guides(self) -> list[Mapping[str, Any]]:
        """Tables of the guides."""
        return list_of_tables(self.tables, "guides")

    @cached_property
    def drives(self) -> list[Mapping[str, Any]]:
        """Tables of the drives."""
        return list_of_tables(self.tables, "drives")

    @cached_property
    def points(self) -> tuple[str, ...]:
        """Points in the order of a motion where there is one, else of the text."""
        spare = _table(self.tables, "points")  # points that nothing has
        if self.document.mechanism is not None:
            mechanism = self.document.mechanism
            return tuple(dict.fromkeys((*mechanism.frame.points, *mechanism.points, *spare)))
        named = [*self.frame_points, *(point for link in self.links.values() for point in link)]
        named += [str(guide["point"]) for guide in self.guides if isinstance(guide.get("point"), str)]
        return tuple(dict.fromkeys((*named, *spare)))

    def owners(self, point: str) -> list[str]:
        """Moving links that have a point."""
        return [name for name, points in self.links.items() if point in points]

    def loose_points(self) -> list[str]:
        """Points at which a link of which something else would have to hold the end hangs on nothing."""
        loose = []
        for points in self.links.values():
            joined = [
                one
                for one in points
                if len(self.owners(one)) > 1 or one in self.frame_points or self.guides_of(one)
            ]
            if len(joined) < 2 and len(points) > 1:
                loose += [one for one in points if one not in joined]
        return list(dict.fromkeys(loose))

    def guides_of(self, point: str) -> list[int]:
        """Numbers of the guides of a point."""
        return [k for k, guide in enumerate(self.guides) if guide.get("point") == point]

    def drives_of(self, name: str) -> list[int]:
        """Numbers of the drives of a link, or of a guide."""
        return [k for k, drive in enumerate(self.drives) if name in (drive.get("link"), drive.get("guide"))]

    @cached_property
    def marks(self) -> dict[str, tuple[str, ...]]:
        """Names under each mark."""
        return marks_of(self.document.text)

    # where everything stands

    @cached_property
    def _places_and_poses(self) -> tuple[dict[str, Vector], dict[str, Pose]]:
        prepared = self.document.position
        if prepared is not None:
            at = prepared.assembled.positions
            points = {name: tuple(map(float, place)) for name, place in at.points.items()}
            for name, value in _table(self.tables, "points").items():
                place = self.place_of(value)
                if name not in points and place is not None:
                    points[name] = place
            if self.on_sphere:
                return points, {}
            poses = {
                name: (tuple(map(float, pose.origin)), math.atan2(float(pose.rotor[1]), float(pose.rotor[0])))
                for name, pose in at.poses.items()
                if name != FRAME
            }
            return points, poses
        return (self._given_places(), {}) if self.on_sphere else self._chain()

    @property
    def places(self) -> dict[str, Vector]:
        """Place of each point in the initial position [m], as far as it is known."""
        return self._places_and_poses[0]

    @property
    def poses(self) -> dict[str, Pose]:
        """Origin [m] and angle [rad] of the axes of each link in the initial position, as far as they are known."""
        return self._places_and_poses[1]

    def place_of(self, value: object) -> Vector | None:
        """The place that coordinates give: in the plane [m], on the sphere a unit vector; None of what are none."""
        return unit_vector_of(value) if self.on_sphere else coordinates(value)

    def _given_places(self) -> dict[str, Vector]:
        """Places of points with coordinates."""
        places: dict[str, Vector] = {}
        for table in (self.tables.get("points"), _table(self.tables, "frame").get("points")):
            if isinstance(table, Mapping):
                for name, value in table.items():
                    place = self.place_of(value)
                    if place is not None:
                        places.setdefault(name, place)
        return places

    def _chain(self) -> tuple[dict[str, Vector], dict[str, Pose]]:
        """Places from coordinates, and along links whose angles are given."""
        places = self._given_places()
        poses: dict[str, Pose] = {}
        waiting = [name for name in self.links if self.angle(name) is not None]
        while True:
            posed = [name for name in waiting if self._pose(name, places, poses)]
            if not posed:
                break
            waiting = [name for name in waiting if name not in posed]
        for name in self.links:
            if name not in poses:
                self._pose_between(name, places, poses)
        return places, poses

    def _pose(self, name: str, places: dict[str, Vector], poses: dict[str, Pose]) -> bool:
        local, angle = self.local(name), self.angle(name)
        known = next((point for point in local if point in places), None)
        if angle is None or known is None:
            return False
        x, y = rotate_vector((local[known][0], local[known][1]), angle)
        origin = (places[known][0] - x, places[known][1] - y)
        poses[name] = origin, angle
        for point, place in local.items():
            places.setdefault(point, shown_place(poses[name], place))
        return True

    def _pose_between(self, name: str, places: Mapping[str, Vector], poses: dict[str, Pose]) -> None:
        """The axes of a link whose points are known: from its first point towards its second."""
        known = [places[point] for point in self.links[name] if point in places]
        if len(known) >= 2 and not self._has_own_axes(name):
            (x, y), (u, v) = known[0][:2], known[1][:2]
            poses[name] = (x, y), math.atan2(v - y, u - x)

    def _has_own_axes(self, name: str) -> bool:
        return isinstance(_table(self.tables, "links")[name].get("points"), Mapping)

    def local(self, name: str) -> dict[str, tuple[float, float]]:
        """Coordinates of the points of a link in its own axes [m], as far as the text gives them."""
        link, points = _table(self.tables, "links")[name], self.links[name]
        if isinstance(link.get("points"), Mapping):
            read = {point: coordinates(value) for point, value in link["points"].items()}
            return {point: (place[0], place[1]) for point, place in read.items() if place is not None}
        length = number(link.get("length"), "length")
        if len(points) == 2 and length is not None:
            return {points[0]: (0.0, 0.0), points[1]: (length, 0.0)}
        return {points[0]: (0.0, 0.0)} if len(points) == 1 else {}

    def angle(self, name: str) -> float | None:
        """Initial angle of a link [rad] as the text gives it: its own, or the start of its drive."""
        stated = number(_table(self.tables, "links")[name].get("angle"), "angle")
        for drive in self.drives:
            if drive.get("link") == name and drive.get("relative_to", FRAME) == FRAME:
                start = number(drive.get("start"), "angle")
                stated = start if start is not None else stated
        return stated

    def length(self, name: str) -> float | None:
        """Length of a link of two points [m], on the sphere its arc [rad]."""
        points = self.links[name]
        if len(points) != 2:
            return None
        stated = number(
            _table(self.tables, "links")[name].get("length"), "arc" if self.on_sphere else "length"
        )
        if stated is not None:
            return stated
        if self.is_short_form and all(point in self.places for point in points):
            return self.distance(self.places[points[0]], self.places[points[1]])
        return None

    @property
    def axes(self) -> tuple[str, str]:
        """What a file calls the coordinates of a point."""
        return ("longitude", "latitude") if self.on_sphere else ("x", "y")

    def numbers_of(self, place: Vector) -> tuple[float, ...]:
        """Coordinates of a place as a file has them: x, y [m], on the sphere longitude and latitude [rad]."""
        if not self.on_sphere:
            return place[:2]
        x, y, z = place
        return longitude_latitude((x, y, z))

    def distance(self, one: Vector, other: Vector) -> float:
        """Distance of two places [m], on the sphere the arc between them [rad]."""
        if self.on_sphere:
            (x, y, z), (u, v, w) = one, other
            return arc((x, y, z), (u, v, w))
        return math.dist(one, other)

    @property
    def size(self) -> float:
        """Greatest extent of the points [m]; 1 where there is none."""
        at = list(self.places.values())
        spans = [max(x) - min(x) for x in zip(*at, strict=True)] if at else []
        return max(spans, default=0.0) or 1.0


def guide_name(sketch: SketchParts, number_of_guide: int) -> str:
    """How the workbench names a guide: not as its point, which is an object of its own."""
    return f"guide {number_of_guide + 1}"


def guide_line(sketch: SketchParts, number_of_guide: int) -> tuple[Vector | None, float | None]:
    """A place on the line of a guide [m] and its angle [rad], both in the axes of the frame."""
    guide = sketch.guides[number_of_guide]
    on, point = guide.get("on", FRAME), str(guide.get("point"))
    direction = direction_angle(guide.get("direction"))
    given = guide.get("through")
    here = sketch.places.get(point)
    if on == FRAME:
        through = sketch.places.get(given) if isinstance(given, str) else coordinates(given)
        return (here if through is None else through), direction
    if on not in sketch.poses:
        return here, None
    origin, angle = sketch.poses[on]
    turned = None if direction is None else direction + angle
    if isinstance(given, str):
        return sketch.places.get(given, here), turned
    local = coordinates(given)
    if local is None:
        return here, turned
    x, y = rotate_vector(local, angle)
    return (origin[0] + x, origin[1] + y), turned


def guide_circle(sketch: SketchParts, number_of_guide: int) -> tuple[Vector, float] | None:
    """Pole and radius [rad] of a guide of the frame on the sphere; None where they are not known."""
    guide = sketch.guides[number_of_guide]
    pole = guide.get("pole")
    place = sketch.places.get(pole) if isinstance(pole, str) else unit_vector_of(pole)
    on, position = guide.get("on", FRAME), sketch.document.position
    if place is not None and on != FRAME and not isinstance(pole, str):
        # coordinates in the axes of the link that carries it
        pose = None if position is None else position.assembled.positions.poses.get(str(on))
        vectors = [] if pose is None else [tuple(map(float, vector)) for vector in pose]
        place = (
            tuple(sum(x * axis[k] for x, axis in zip(place, vectors, strict=True)) for k in range(3))
            if len(vectors) == 3
            else None
        )
    if place is None:
        return None
    radius = number(guide.get("radius"), "arc")
    point = sketch.places.get(str(guide.get("point")))
    if radius is None and sketch.is_short_form and point is not None:
        radius = sketch.distance(place, point)
    return place, math.pi / 2 if radius is None else radius


def direction_angle(value: object) -> float | None:
    """Angle [rad] of a direction that is given as [x, y] or as an angle."""
    if isinstance(value, list):
        place = coordinates(value)
        return None if place is None else math.atan2(place[1], place[0])
    return number(value, "angle")


def drive_name(drive: Mapping[str, Any]) -> str:
    """How a drive is called: as its link, its guide, or both points of its distance."""
    named = next((drive[key] for key in ("link", "guide") if isinstance(drive.get(key), str)), "")
    return named or "-".join(entries_of(drive.get("distance")))


def load_name(number_of_load: int) -> str:
    """How the workbench names a load."""
    return f"load {number_of_load + 1}"


def display_units(tables: Tables) -> dict[str, dict[str, Any]]:
    """Units in which lengths and angles are shown, with what SI is multiplied by."""
    display = _table(tables, "display")
    units = {}
    for kind, known, usual in (("length", LENGTHS, "m"), ("angle", ANGLES, "rad")):
        unit = display.get(kind, usual)
        unit = unit if unit in known else usual
        units[kind] = {"unit": unit, "factor": known[unit]}
    return units


def shown_place(pose: Pose, local: Vector) -> tuple[float, float]:
    """Where a place in the axes of a pose is in those of the frame."""
    (x, y), angle = pose[0][:2], pose[1]
    u, v = rotate_vector((local[0], local[1]), angle)
    return x + u, y + v


def number(value: object, kind: str) -> float | None:
    """A number in SI; None of what is none."""
    try:
        return to_si(value, kind) if value is not None else None
    except InputError:
        return None


def coordinates(value: object) -> tuple[float, float] | None:
    """Coordinates of a point [m]; None of what are none."""
    if isinstance(value, Mapping):
        value = value.get("placed")
    if not isinstance(value, list) or len(value) != 2:
        return None
    x, y = (number(one, "length") for one in value)
    return None if x is None or y is None else (x, y)


def unit_vector_of(value: object) -> Vector | None:
    """Unit vector of [longitude, latitude] or [x, y, z]; None of what is none."""
    if isinstance(value, Mapping):
        value = value.get("placed")
    if not isinstance(value, list) or len(value) not in (2, 3):
        return None
    numbers = [number(one, "arc" if len(value) == 2 else "ratio") for one in value]
    known = tuple(one for one in numbers if one is not None)
    if len(known) < len(value):
        return None
    return unit_vector(known) if len(known) == 2 else on_unit_sphere(known)


def on_unit_sphere(place: Vector) -> Vector | None:
    """The place on the unit sphere in a direction; None of the centre."""
    size = math.hypot(*place)
    return tuple(x / size for x in place) if size > 0.0 and math.isfinite(size) else None


def entries_of(value: object) -> tuple[str, ...]:
    """Names in a list, or of a table."""
    if not isinstance(value, list | Mapping):
        return ()
    return tuple(dict.fromkeys(name for name in value if isinstance(name, str)))


def _table(tables: Tables, key: str) -> Mapping[str, Any]:
    value = tables.get(key)
    return value if isinstance(value, Mapping) else {}


def list_of_tables(tables: Tables, key: str) -> list[Mapping[str, Any]]:
    """The entries of a list of tables."""
    value = tables.get(key)
    return [one for one in value if isinstance(one, Mapping)] if isinstance(value, list) else []


def marks_of(text: str) -> dict[str, tuple[str, ...]]:
    """Names under each mark, in comments "# workbench: fixed A, B"."""
    marks: dict[str, tuple[str, ...]] = dict.fromkeys(MARKS, ())
    for word, names in _mark_lines(text):
        marks[word] = tuple(dict.fromkeys((*marks[word], *names)))
    return marks


def _mark_lines(text: str) -> Iterator[tuple[str, tuple[str, ...]]]:
    for found in _MARK.finditer(text):
        if found.group(1) in MARKS:
            names = tuple(name.strip() for name in found.group(2).split(",") if name.strip())
            yield found.group(1), names


def with_mark(text: str, word: str, name: str, on: bool) -> str:
    """The text with a name under a mark, or without; the comment stands at the end of the text."""
    names = [one for one in marks_of(text)[word] if one != name] + ([name] if on else [])
    line = f"# workbench: {word} {', '.join(names)}"
    newline = "\r\n" if "\r\n" in text else "\n"
    for found in _MARK.finditer(text):
        if found.group(1) == word:
            if names:
                return text[: found.start()] + line + text[found.end() :]
            after = text.find("\n", found.end())
            return text[: found.start()] + (text[after + 1 :] if after >= 0 else "")
    if not names:
        return text
    parted = text if not text or text.endswith("\n") else text + newline
    return f"{parted}{line}{newline}"


def marked_names(text: str, change: Mapping[str, str | None]) -> str:
    """The text whose marks name other objects: old name -> new name, None for one that is gone."""
    for word, names in marks_of(text).items():
        for name in names:
            if name in change:
                new = change[name]
                text = with_mark(text, word, name, False)
                text = with_mark(text, word, new, True) if new else text
    return text
