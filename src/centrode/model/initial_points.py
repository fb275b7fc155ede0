"""Points given by their coordinates in the initial position: lengths and angles of links that follow from them."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Mapping, Sequence
from typing import Any

from centrode.errors import InputError
from centrode.locale import _
from centrode.model import reading
from centrode.model.reading import FRAME, Problem, Problems, named_entries, read_name, two_points, value_text
from centrode.model.units import read_quantity
from centrode.model.values import (
    Axes,
    Vector,
    angle_between,
    arc,
    axes,
    dot,
    longitude_latitude,
    makes_arc,
    read_coordinates,
    tangent_towards,
    unit_vector,
)

Tables = Mapping[str, Any]

AGREES = 1e-9
"""Coordinates, in metres or over a length, that differ by less are those of one point."""
NEAR = 0.02
"""So far [rad] the start of a drive may lie from the angle that rounded coordinates give its link."""


def with_links_between_points(data: Tables) -> Tables:
    """Tables of a mechanism in which links and guides have lengths and angles in place of the table `points`.

    Raises
    ------
    Problems
        A point that is missing or given twice in different places; points that coincide, or lie opposite on the sphere;
        a length, an angle or a start that contradicts them.
    """
    expansion = _SphericalExpansion if data.get("space") == "sphere" else _Expansion
    return expansion(data).tables()


class _Expansion:
    """Tables with the points that they name, and what is wrong with them."""

    def __init__(self, data: Tables) -> None:
        self.data = data
        self.wrong: list[Problem] = []
        self.places: dict[str, Vector] = {}
        for name, value in named_entries(data["points"], read_name, reading.POINTS).items():
            try:
                self.places[name] = read_coordinates(value)
            except Problem as problem:
                self.wrong.append(Problem(problem.what, problem.repair, ("points", name)))
        drives = data.get("drives")
        entries = (
            [one for one in drives if isinstance(one, Mapping)] if isinstance(drives, list | tuple) else []
        )
        self.driven = {_name(one.get("link")) for one in entries if one.get("start") is not None}
        # first point and angle of each link that lies between points
        self.poses: dict[str, tuple[Vector, float]] = {}

    def tables(self) -> Tables:
        """The tables without `points`."""
        changed = {key: value for key, value in self.data.items() if key != "points"}
        if self.wrong:
            raise Problems(self.wrong)
        frame, links = self.data.get("frame"), self.data.get("links")
        if isinstance(frame, Mapping):
            changed["frame"] = {**frame, "points": self._fix_points(frame.get("points", {}))}
        if isinstance(links, Mapping):
            changed["links"] = {name: self._link(name, link) for name, link in links.items()}
        for key, change in (("guides", self._guide), ("drives", self._drive)):
            entries = self.data.get(key)
            if isinstance(entries, list | tuple):
                changed[key] = [change(number, entry) for number, entry in enumerate(entries)]
        if self.wrong:
            raise Problems(self.wrong)
        return changed

    def _fix_points(self, points: Any) -> Any:
        """Points of the frame: those named, and others with coordinates of their own."""
        if isinstance(points, list | tuple):
            names = [_name(point) for point in points]
            for point, name in zip(points, names, strict=True):
                if name is None:
                    what = _("expected a name (text), got {value}").format(value=value_text(point))
                    self._add(what, "", "frame", "points")
            return self._places_of([name for name in names if name is not None], ("frame", "points"))
        if isinstance(points, Mapping):
            for name in points:
                if name in self.places and not self._agrees(name, points[name]):
                    what = _("point {name} is given twice, in different places").format(name=value_text(name))
                    self._add(what, _("keep one of them"), "frame", "points", name)
        return points

    def _agrees(self, name: str, value: Any) -> bool:
        try:
            return self._distance(read_coordinates(value), self.places[name]) <= AGREES
        except Problem:
            return True  # what is wrong with these coordinates is said where they are read

    def _distance(self, one: Vector, other: Vector) -> float:
        return math.dist(one, other)

    def _places_of(self, names: Sequence[str], at: reading.Place) -> dict[str, Vector]:
        """Coordinates of points by their names; those that are missing are problems."""
        for name in names:
            if name not in self.places:
                what = _("the coordinates of point {name} are not given").format(name=value_text(name))
                self._add(what, reading.nearest(name, list(self.places)), *at)
        return {name: self.places[name] for name in names if name in self.places}

    def _link(self, name: str, link: Any) -> Any:
        """A link whose points are named only: its length, or its points in axes of its own, and its angle."""
        if not isinstance(link, Mapping):
            return link
        given = link.get("points")
        if not given and link.get("length") is None:
            given = two_points(str(name))
        if not isinstance(given, list | tuple) or len(given) < 2:
            return link
        names = [one for one in map(_name, given) if one is not None]
        if len(names) < len(given):
            return link  # what is no name is refused where points are read
        at, body = ("links", name), _name(name) or ""
        places = self._places_of(names, (*at, "points"))
        if len(places) < len(names):
            return link
        for key in ("length", "angle"):
            if link.get(key) is not None:
                self._add(_("{key} follows from its points").format(key=key), _("remove it"), *at, key)
        return self._link_between(link, body, names, places, at)

    def _link_between(
        self, link: Tables, body: str, names: Sequence[str], places: Mapping[str, Vector], at: reading.Place
    ) -> Any:
        first, second = places[names[0]], places[names[1]]
        length = math.dist(first, second)
        if length <= AGREES:
            what = _("its points {first} and {second} coincide").format(first=names[0], second=names[1])
            self._add(what, _("correct their coordinates"), *at, "points")
            return link
        self.poses[body] = first, math.atan2(second[1] - first[1], second[0] - first[0])
        if len(names) == 2:
            return {**link, "points": tuple(names), "length": length, **self._angle_of(body)}
        local = {point: self._local(body, place) for point, place in places.items()}
        # exactly on the axis that they make
        local |= {names[0]: (0.0, 0.0), names[1]: (length, 0.0)}
        return {**link, "points": local, **self._angle_of(body)}

    def _angle_of(self, body: str) -> dict[str, str]:
        """The angle of a link; the start of a drive says by itself how that of its link is counted."""
        return {} if body in self.driven else {"angle": _in_radians(self.poses[body][1])}

    def _local(self, link: str, place: Vector) -> Vector:
        """A place in the axes of a link: from its first point towards its second."""
        (x, y), angle = self.poses[link]
        cosine, sine = math.cos(angle), math.sin(angle)
        u, v = place[0] - x, place[1] - y
        return u * cosine + v * sine, v * cosine - u * sine

    def _guide(self, number: int, guide: Any) -> Any:
        """A guide without a line of its own passes through its point, where that is in the initial position."""
        if not isinstance(guide, Mapping):
            return guide
        through, on = guide.get("through"), _name(guide.get("on", FRAME))
        name = _name(guide.get("point") if through is None else through)
        if name not in self.places or on is None or (on != FRAME and on not in self.poses):
            return guide
        place = self.places[name]
        return {**guide, "through": place if on == FRAME else self._local(on, place)}

    def _drive(self, number: int, drive: Any) -> Any:
        """A drive of a link's angle starts where its points are; a start of its own says how the angle is counted."""
        if not isinstance(drive, Mapping) or any(drive.get(key) for key in ("guide", "distance")):
            return drive
        link, base = _name(drive.get("link")), _name(drive.get("relative_to", FRAME))
        if link not in self.poses or base is None or (base != FRAME and base not in self.poses):
            return drive
        angle = self._angle_against(link, base)
        start = drive.get("start")
        if start is None:
            return {**drive, "start": _in_radians(angle)}
        try:
            turned = math.remainder(read_quantity(start, "angle", "") - angle, math.tau)
        except InputError:
            return drive  # what is wrong with the start is said where it is read
        if abs(turned) > NEAR:
            what = _("it starts at {start}, and the points put {link} at {angle:.6g} deg")
            said = what.format(start=value_text(start), link=value_text(link), angle=math.degrees(angle))
            self._add(said, _("correct the start, or the points"), "drives", number, "start")
        return drive

    def _angle_against(self, link: str, base: str) -> float:
        """Angle of a link from the axes of another one, or of the frame."""
        return self.poses[link][1] - (0.0 if base == FRAME else self.poses[base][1])

    def _add(self, what: str, repair: str, *at: Any) -> None:
        self.wrong.append(Problem(what, repair, at))


class _SphericalExpansion(_Expansion):
    """The same on the unit sphere: lengths are arcs, and the angle of a link is measured from an arc.

    Without a `reference` of its own this is the arc from its first point to the first other point of the frame, or of
    the link that its drive counts from.
    """

    def __init__(self, data: Tables) -> None:
        super().__init__(data)
        self.axes: dict[str, Axes] = {}
        drives = data.get("drives")
        entries = drives if isinstance(drives, list | tuple) else ()
        self.bases = {
            _name(one.get("link")): _name(one.get("relative_to", FRAME))
            for one in entries
            if isinstance(one, Mapping)
        }

    def _fix_points(self, points: Any) -> Any:
        fixed = super()._fix_points(points)
        if not isinstance(points, list | tuple):
            return fixed
        return {name: tuple(map(_in_radians, place)) for name, place in fixed.items()}

    def _distance(self, one: Vector, other: Vector) -> float:
        return arc(unit_vector(one), unit_vector(other))

    def _link_between(
        self, link: Tables, body: str, names: Sequence[str], places: Mapping[str, Vector], at: reading.Place
    ) -> Any:
        first, second = unit_vector(places[names[0]]), unit_vector(places[names[1]])
        if not makes_arc(first, second):
            what = _("its points {first} and {second} coincide, or lie opposite")
            self._add(
                what.format(first=names[0], second=names[1]), _("correct their coordinates"), *at, "points"
            )
            return link
        self.axes[body] = axes(first, tangent_towards(first, second))
        reference = link.get("reference") or self._reference(body, names[0])
        turned: dict[str, Any] = {}
        if isinstance(reference, list | tuple) and len(reference) == 2 and self._place_of(reference[1]):
            towards = unit_vector(self._place_of(reference[1]) or (0.0, 0.0))
            if makes_arc(first, towards):
                self.poses[body] = places[names[0]], angle_between(first, towards, second)
                turned = {"reference": reference, **self._angle_of(body)}
        length = arc(first, second)
        if len(names) == 2:
            return {**link, "points": tuple(names), "length": _in_radians(length), **turned}
        local = {point: self._local(body, place) for point, place in places.items()}
        local |= {names[0]: (0.0, 0.0), names[1]: (length, 0.0)}
        spelled = {point: tuple(map(_in_radians, place)) for point, place in local.items()}
        return {**link, "points": spelled, **turned}

    def _place_of(self, point: Any) -> Vector | None:
        return self.places.get(_name(point) or "")

    def _reference(self, body: str, first: str) -> tuple[str, str] | None:
        """The arc from which the angle of a link is measured."""
        base = self.bases.get(body) or FRAME
        table = self.data.get("frame") if base == FRAME else (self.data.get("links") or {}).get(base)
        given = table.get("points") if isinstance(table, Mapping) else None
        names = [_name(one) for one in given or (two_points(base) or ())]
        for name in names:
            place = self.places.get(name or "")
            if name and place and makes_arc(unit_vector(self.places[first]), unit_vector(place)):
                return first, name
        return None

    def _local(self, link: str, place: Vector) -> Vector:
        vector = unit_vector(place)
        x, y, z = (dot(vector, axis) for axis in self.axes[link])
        return longitude_latitude((x, y, z))

    def _guide(self, number: int, guide: Any) -> Any:
        """A guide without a radius of its own passes through its point."""
        if not isinstance(guide, Mapping) or guide.get("radius") is not None or guide.get("pole") is None:
            return guide
        on, place = _name(guide.get("on", FRAME)), self._place_of(guide.get("point"))
        if place is None or on is None or (on != FRAME and on not in self.axes):
            return guide
        try:
            pole = guide["pole"]
            named = self._place_of(pole) if isinstance(pole, str) else None
            if isinstance(pole, str) and named is None:
                return guide  # what it names is looked for where guides are read
            if named is None or on == FRAME:
                here = place if on == FRAME else self._local(on, place)
                there = read_coordinates(pole) if named is None else named
            else:
                here, there = place, named
        except Problem:
            return guide  # what is wrong with these coordinates is said where they are read
        return {**guide, "radius": _in_radians(self._distance(here, there))}

    def _angle_against(self, link: str, base: str) -> float:
        # the reference is an arc of the link that the drive counts from
        return self.poses[link][1]


def _name(value: Any) -> str | None:
    """A name in composed form, as mechanisms hold it; None of what is no text."""
    return unicodedata.normalize("NFC", value) if isinstance(value, str) else None


def _in_radians(angle: float) -> str:
    """An angle as a text with its unit, which reads back exactly: a file may refuse bare angles."""
    return f"{angle!r} rad"
