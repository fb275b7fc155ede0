"""Operations of the workbench on the text of a description: each is written as a person would write it."""

from __future__ import annotations

import math
import string
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import count
from pathlib import Path
from typing import Any

from centrode.app.documents import Document, read_document
from centrode.app.edit_drags import (
    Assignment,
    follow,
    follows_from_points,
    local_place,
    reshape,
    reshaped_by,
    value_at_place,
    written_position,
)
from centrode.app.numbers_of_text import place_of_path, written_like
from centrode.app.quantity_texts import is_number, read_field, typed_quantity, written_quantity
from centrode.app.references import key_places, references
from centrode.app.scene import FORCE, guide_line, guide_name, load_name, rows_of
from centrode.app.sketch import Sketch, Vector, list_of_tables, marked_names, with_mark
from centrode.app.text_changes import TextChanges
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.description import coordinate_of_drive
from centrode.model.reading import FRAME, Place, read_link_name, read_name, two_points, value_text

Operation = Mapping[str, Any]

OBJECTS = 200
"""Objects of one operation."""
QUARTER = math.pi / 2
SPEED = 1.0
"""Speed [rad/s or m/s] of a drive that a row adds."""
MASS = 1.0
"""Mass [kg] that a row adds."""


def apply_operations(text: str, folder: Path, operations: Sequence[Operation]) -> Patch:
    """A text after operations, one after the other; InputError where one is refused."""
    patch = Patch(text, folder)
    for operation in operations:
        patch.apply(operation)
    return patch


class Patch:
    """A text that operations change.

    Attributes
    ----------
    text : as it is now
    changed : paths of what was changed
    named : names of the objects that operations made
    """

    def __init__(self, text: str, folder: Path) -> None:
        self.text, self.folder = text, folder
        self.changed: list[str] = []
        self.named: list[str] = []
        self._operations: dict[str, Callable[[Operation], None]] = {
            "add_link": self._add_link,
            "add_point": self._add_point,
            "add_guide": self._add_guide,
            "set_row": self._set_row,
            "set": self._set,
            "delete": self._delete,
            "duplicate": self._duplicate,
            "mirror": self._mirror,
            "move_point": self._move_point,
            "rename": self._rename,
            "lock": self._lock,
            "join": self._join,
        }

    def apply(self, operation: Operation) -> None:
        """Change the text by an operation; InputError, and nothing changes, where it is refused."""
        name = operation.get("do", operation.get("op"))
        change = self._operations.get(name) if isinstance(name, str) else None
        if change is None:
            raise InputError("", _("the server does not know this operation"))
        before, text = self.document, self.text
        if before.problems and not before.tables and text.strip():
            first = before.problems[0]
            what = _("line {line} cannot be read: {message}").format(line=first.line, message=first.message)
            raise InputError("", what, _("correct it in the text first"))
        try:
            change(operation)
            if before.prepared is not None and self.document.prepared is None:
                self._keep_places(Sketch(before))
            after = self.document
            broken = before.mechanism is not None and after.mechanism is None and after.tables.get("links")
            # a drawing is unfinished on the way; a number or a name that does not fit is a mistake
            if broken and name in ("set", "rename", "move_point", "mirror", "join"):
                first = after.problems[0]
                raise InputError(first.path, first.message, first.repair)
        except (KeyError, IndexError, TypeError, ValueError, AttributeError) as fault:
            self.text = text
            what = _("this part of the text is written in a way that cannot be changed here")
            raise InputError("", what, _("change it in the text")) from fault
        except InputError:
            self.text = text
            raise

    @property
    def document(self) -> Document:
        """The description as it is now."""
        return read_document(self.text, self.folder)

    @property
    def sketch(self) -> Sketch:
        """What is drawn of it."""
        return Sketch(self.document)

    def _keep_places(self, before: Sketch) -> None:
        """Write the angles of links that no position gives any more, so that they stay where they were drawn."""
        while True:
            sketch = self.sketch
            lost = [
                name
                for name in sketch.links
                if name not in sketch.poses and name in before.poses and sketch.local(name)
            ]
            # an angle may place the links behind it too
            for name in lost[:1]:
                place: Place = ("links", name, "angle")
                if value_at_place(sketch.tables, place) is not None:
                    return
                self._write((place, self._angle(before.poses[name][1])))
            if not lost:
                return

    def _write(self, *assignments: Assignment) -> None:
        changes = TextChanges(self.text)
        for place, value in assignments:
            changes.set(place, value)
            self.changed.append(".".join(map(str, place)))
        self.text = changes.text

    def _remove(self, *places: Place) -> None:
        """Take out keys, tables and entries; entries of one list from behind, so that numbers stay those of before."""
        changes = TextChanges(self.text)
        for place in sorted(
            places, key=lambda one: [str(x) if isinstance(x, str) else f"{x:09d}" for x in one], reverse=True
        ):
            changes.remove(place)
            self.changed.append(".".join(map(str, place)))
        self.text = changes.text

    def _add_table(self, place: Place, entries: Mapping[str, Any]) -> None:
        changes = TextChanges(self.text)
        changes.add_table(place, entries)
        self.text = changes.text
        self.changed.append(".".join(map(str, place)))

    def _add_entry(self, room: str, entries: Mapping[str, Any]) -> None:
        changes = TextChanges(self.text)
        changes.add_entry(room, entries)
        self.text = changes.text
        self.changed.append(f"{room}.{len(changes.tables[room]) - 1}")

    # what operations name

    def _plane(self) -> Sketch:
        sketch = self.sketch
        if sketch.on_sphere:
            raise InputError("", _("on the sphere this is changed in the text"))
        return sketch

    def _point_of(self, operation: Operation, key: str = "point") -> str:
        name = operation.get(key)
        if name not in self.sketch.points:
            raise InputError("", _("unknown point {name}").format(name=value_text(name)))
        return str(name)

    def _place_of(self, operation: Operation, key: str) -> Vector:
        value = operation.get(key)
        numbers = (
            [float(x) for x in value if isinstance(x, int | float) and not isinstance(x, bool)]
            if isinstance(value, list)
            else []
        )
        if (
            len(numbers) != 2
            or not isinstance(value, list)
            or len(value) != 2
            or not all(map(math.isfinite, numbers))
        ):
            raise InputError("", _("a place is two numbers"))
        return tuple(numbers)

    def _objects(self, operation: Operation) -> list[str]:
        objects = operation.get("objects")
        if (
            not isinstance(objects, list)
            or not all(isinstance(one, str) for one in objects)
            or len(objects) > OBJECTS
        ):
            raise InputError("", _("the objects are a list of names"))
        return list(dict.fromkeys(objects))

    def _free_names(self) -> Iterator[str]:
        """Names of points that are not taken: A to Z, then A1 and so on."""
        taken = {*self.sketch.points, *self.sketch.links}
        for k in count():
            for letter in string.ascii_uppercase:
                name = f"{letter}{k or ''}"
                if name not in taken:
                    yield name

    def _length(self, value: float, old: Any = None) -> Any:
        return written_quantity(self.sketch, old, value, "length")

    def _pair(self, place: Vector) -> list[Any]:
        return [self._length(x) for x in place[:2]]

    def _angle(self, value: float, old: Any = None) -> Any:
        return written_quantity(self.sketch, old, value, "angle")

    # drawing

    def _is_short(self) -> bool:
        """Whether what is drawn gets coordinates in the table of points: in a new text, and where others have them."""
        sketch = self.sketch
        return sketch.is_short_form or not (sketch.links or sketch.fixed)

    def _new_point(self, place: Vector, name: str | None = None) -> str:
        """A point with coordinates in the table of points."""
        name = name or next(self._free_names())
        if self.sketch.is_short_form:
            self._write((("points", name), self._pair(place)))
        else:
            self._add_table(("points",), {name: self._pair(place)})
        self.named.append(name)
        return name

    def _link_name(self, first: str, second: str) -> str:
        """A name for a link of two points: both, where that means these points, else a number."""
        taken = {*self.sketch.links, *self.sketch.points}
        both = first + second
        if two_points(both) == (first, second) and both not in taken and second + first not in taken:
            return both
        return next(name for name in (f"link {k}" for k in count(1)) if name not in taken)

    def _add_link(self, operation: Operation) -> None:
        sketch = self._plane()
        ends = [self._place_of(operation, "at"), self._place_of(operation, "to")]
        names: list[str | None] = []
        for key in ("from_point", "to_point"):
            names.append(None if operation.get(key) is None else self._point_of(operation, key))
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
        if self._is_short():
            first, second = (name or self._new_point(end) for name, end in zip(names, ends, strict=True))
            self._add_short_link(first, second)
            return
        self._add_measured_link(names, ends)

    def _add_short_link(self, first: str, second: str) -> None:
        name = self._link_name(first, second)
        self._add_table(("links", name), {} if two_points(name) else {"points": [first, second]})
        self.named.append(name)

    def _add_measured_link(self, names: list[str | None], ends: list[Vector]) -> None:
        """A link with a length and an angle, from a point whose place is known."""
        if names[0] is None and names[1] is not None:
            names, ends = names[::-1], ends[::-1]
        free = self._free_names()
        first, second = names
        if first is None:
            first = next(free)
            self._write((("frame", "points", first), self._pair(ends[0])))
            self.named.append(first)
        if second is None:
            second = next(name for name in free if name != first)
            self.named.append(second)
        (x, y), (u, v) = ends[0][:2], ends[1][:2]
        name = self._link_name(first, second)
        entries: dict[str, Any] = {} if two_points(name) else {"points": [first, second]}
        entries["length"] = self._length(math.hypot(u - x, v - y))
        entries["angle"] = self._angle(math.atan2(v - y, u - x))
        self._add_table(("links", name), entries)
        self.named.append(name)

    def _add_point(self, operation: Operation) -> None:
        sketch = self._plane()
        link, place = operation.get("link"), self._place_of(operation, "at")
        if not isinstance(link, str) or link not in sketch.links:
            raise InputError("", _("unknown link {name}").format(name=value_text(link)))
        point = operation.get("point")
        name = next(self._free_names()) if point is None else self._point_of(operation)
        if name in sketch.links[link]:
            raise InputError("", _("link {link} has this point already").format(link=link))
        points = sketch.links[link]
        if follows_from_points(sketch, link):
            if point is None:
                self._new_point(place, name)
            self._write((("links", link, "points"), [*points, name]))
        elif link not in sketch.poses:
            raise InputError(link, _("its place is not known: correct the description first"))
        else:
            if point is None:
                self.named.append(name)
            local = sketch.local(link)
            own = self._pair(local_place(sketch.poses[link], place))
            table = sketch.tables["links"][link].get("points")
            if isinstance(table, Mapping):
                self._write((("links", link, "points", name), own))
            else:
                length = sketch.tables["links"][link].get("length")
                written = {one: self._pair(at) for one, at in local.items()}
                if length is not None and len(points) == 2:
                    written[points[1]] = [length, 0]
                changes = TextChanges(self.text)
                if length is not None:
                    changes.set(("links", link, "length"), 0)
                    changes.rename_key(("links", link, "length"), "points") if table is None else None
                if table is not None:
                    changes.remove(("links", link, "length")) if length is not None else None
                changes.set(("links", link, "points"), {**written, name: own})
                self.text = changes.text
                self.changed.append(f"links.{link}.points")

    def _add_guide(self, operation: Operation) -> None:
        self._plane()
        place = self._place_of(operation, "at")
        direction = operation.get("direction", 0.0)
        if isinstance(direction, list):
            x, y = self._place_of(operation, "direction")
            direction = math.atan2(y, x)
        if (
            isinstance(direction, bool)
            or not isinstance(direction, int | float)
            or not math.isfinite(direction)
        ):
            raise InputError("", _("a direction is an angle"))
        if operation.get("point") is None:
            if not self._is_short():
                raise InputError("", _("a guide needs a point that slides in it"), _("begin it at a joint"))
            name = self._new_point(place)
        else:
            name = self._point_of(operation)
        self._guide_at(name, float(direction))

    def _guide_at(self, point: str, direction: float) -> None:
        sketch = self.sketch
        if point in sketch.fixed:
            raise InputError(point, _("a point of the frame does not slide: switch Ground off first"))
        if sketch.guides_of(point):
            raise InputError(point, _("this point slides in a guide already"))
        entries: dict[str, Any] = {"point": point, "on": FRAME}
        if not (sketch.is_short_form and point in sketch.tables["points"]):
            if point not in sketch.places:
                raise InputError(point, _("its place is not known: correct the description first"))
            entries["through"] = self._pair(sketch.places[point])
        entries["direction"] = self._direction(direction)
        self._add_entry("guides", entries)
        self.named.append(guide_name(self.sketch, len(self.sketch.guides) - 1))

    def _direction(self, angle: float) -> Any:
        for turn, pair in ((0.0, [1, 0]), (QUARTER, [0, 1])):
            if abs(math.remainder(angle - turn, math.pi)) < 1e-6:
                return pair
        return self._angle(math.remainder(angle, math.pi))

    # state rows

    def _set_row(self, operation: Operation) -> None:
        sketch = self.sketch
        name, row, on = operation.get("object"), operation.get("row"), bool(operation.get("on", True))
        rows = rows_of(sketch)
        if not isinstance(name, str) or name not in rows or row not in rows[name]:
            raise InputError("", _("the server does not know this object"))
        state, value = rows[name][row], operation.get("value")
        if not state["allowed"]:
            raise InputError(name, state["why"])
        if state["on"] == on and (not on or value is None):
            return
        guide = next((k for k in range(len(sketch.guides)) if guide_name(sketch, k) == name), None)
        match row:
            case "ground":
                self._set_ground(name, on)
            case "guide":
                self._set_guide(name, guide, on, value)
            case "drive":
                self._set_drive(name, guide, on, value)
            case "fixed":
                mark = "fixed" if name in sketch.points else "locked"
                self._mark(mark, name if mark == "fixed" else f"links.{name}.length", on)
            case "trace":
                self._mark("traced", name, on)
            case "mass":
                self._set_mass(name, on, value)
            case "load":
                self._set_load(name, on, value)

    def _mark(self, word: str, name: str, on: bool) -> None:
        self.text = with_mark(self.text, word, name, on)
        self.changed.append(name)

    def _set_ground(self, point: str, on: bool) -> None:
        sketch = self.sketch
        frame = sketch.tables.get("frame", {}).get("points")
        if on:
            if sketch.is_short_form and point in sketch.tables["points"]:
                if isinstance(frame, Mapping):
                    self._write((("frame", "points", point), sketch.tables["points"][point]))
                elif frame is None and "frame" not in sketch.tables:
                    self._add_table(("frame",), {"points": [point]})
                else:
                    self._write((("frame", "points"), [*(frame or ()), point]))
            elif point in sketch.places:
                self._write((("frame", "points", point), self._pair(sketch.places[point])))
            else:
                raise InputError(point, _("its place is not known: correct the description first"))
            return
        if isinstance(frame, list):
            self._write((("frame", "points"), [one for one in frame if one != point]))
        else:
            self._remove(("frame", "points", point))

    def _set_guide(self, name: str, guide: int | None, on: bool, value: Any) -> None:
        sketch = self.sketch
        numbers = [guide] if guide is not None else sketch.guides_of(name)
        if on and not numbers:
            angle = value if isinstance(value, int | float) and not isinstance(value, bool) else 0.0
            self._guide_at(name, float(angle))
        elif on:
            angle = read_field(sketch, value, "angle")
            on_link = sketch.guides[numbers[0]].get("on", FRAME)
            angle -= sketch.poses[on_link][1] if on_link != FRAME else 0.0
            self._write((("guides", numbers[0], "direction"), self._direction(angle)))
        else:
            self._remove_guides(numbers)

    def _remove_guides(self, numbers: Sequence[int]) -> None:
        sketch = self.sketch
        gone = {str(sketch.guides[k].get("name", sketch.guides[k].get("point"))) for k in numbers}
        drives = [k for k, drive in enumerate(sketch.drives) if drive.get("guide") in gone]
        sides = [
            ("assembly", "sides", one)
            for one in gone
            if one in sketch.tables.get("assembly", {}).get("sides", {}) and one not in sketch.points
        ]
        self._remove(*(("guides", k) for k in numbers), *(("drives", k) for k in drives), *sides)

    def _set_drive(self, name: str, guide: int | None, on: bool, value: Any) -> None:
        sketch = self.sketch
        if guide is None and name in sketch.points:
            guide = next(iter(sketch.guides_of(name)), None)
        key = "link" if guide is None else "guide"
        subject = name
        if guide is not None:
            subject = str(sketch.guides[guide].get("name", sketch.guides[guide].get("point")))
        present = sketch.drives_of(subject)
        if not on:
            self._remove(*(("drives", k) for k in present))
            return
        kind = coordinate_of_drive({key: subject}, sketch.space).speed_kind
        speed = SPEED if value is None else read_field(sketch, value, kind)
        if present:
            place: Place = ("drives", present[0], "speed")
            old = value_at_place(sketch.tables, place)
            if old is None:
                raise InputError(name, _("this drive has a law of its own: change it in the text"))
            self._write((place, value if isinstance(value, str) and not is_number(value) else speed))
            return
        if key == "link":
            self._ground_pivot(name)
        entries: dict[str, Any] = {key: subject}
        sketch = self.sketch
        if key == "link" and not follows_from_points(sketch, name) and sketch.angle(name) is None:
            if name not in sketch.poses:
                raise InputError(name, _("its place is not known: correct the description first"))
            entries["start"] = self._angle(sketch.poses[name][1])
        if key == "guide" and guide is not None:
            slide = self._slide(sketch, guide)
            if abs(slide) > 1e-9 * sketch.size:
                entries["start"] = self._length(slide)
        entries["speed"] = value if isinstance(value, str) and not is_number(value) else speed
        self._add_entry("drives", entries)

    def _slide(self, sketch: Sketch, guide: int) -> float:
        """Displacement of the point of a guide from the place that its line goes through."""
        point = str(sketch.guides[guide].get("point"))
        start, direction = guide_line(sketch, guide)
        if start is None or direction is None or point not in sketch.places:
            return 0.0
        x, y = sketch.places[point][0] - start[0], sketch.places[point][1] - start[1]
        return x * math.cos(direction) + y * math.sin(direction)

    def _ground_pivot(self, link: str) -> None:
        """A driven link turns about a point of the frame: where it has none, its loose end becomes one."""
        sketch = self.sketch
        points = sketch.links[link]
        if any(point in sketch.fixed for point in points):
            return
        loose = [point for point in points if len(sketch.owners(point)) < 2 and not sketch.guides_of(point)]
        if len(loose) == len(points) > 1:
            loose = loose[:1]
        if len(loose) != 1:
            what = _("a driven link turns about a point of the frame: switch Ground on at one of its joints")
            raise InputError(link, what)
        self._set_ground(loose[0], True)

    def _set_mass(self, link: str, on: bool, value: Any) -> None:
        sketch = self.sketch
        table = sketch.tables["links"][link]
        if not on:
            keys = [key for key in ("mass", "centre", "inertia", "shape", "radius", "masses") if key in table]
            self._remove(*(("links", link, key) for key in keys))
            return
        mass = MASS if value is None else read_field(sketch, value, "mass")
        place: Place = ("links", link, "mass")
        if "mass" in table:
            text = isinstance(value, str) and not is_number(value)
            self._write((place, value if text else written_quantity(sketch, table["mass"], mass, "mass")))
            return
        entries: list[Assignment] = [
            (place, value if isinstance(value, str) and not is_number(value) else mass)
        ]
        if len(sketch.links[link]) == 2 and not isinstance(table.get("points"), Mapping):
            entries.append((("links", link, "shape"), "rod"))
        self._write(*entries)

    def _set_load(self, point: str, on: bool, value: Any) -> None:
        sketch = self.sketch
        present = [
            k for k, one in enumerate(list_of_tables(sketch.tables, "loads")) if one.get("point") == point
        ]
        if not on:
            self._remove(*(("loads", k) for k in present))
            return
        vector: list[Any] = [0, -FORCE]
        if value is not None:
            if not isinstance(value, list) or len(value) != 2:
                raise InputError(point, _("a force is two numbers"))
            vector = [read_field(sketch, x, "force") for x in value]
        forces = [k for k in present if list_of_tables(sketch.tables, "loads")[k].get("kind") == "force"]
        if forces:
            self._write((("loads", forces[0], "vector"), vector))
        else:
            self._add_entry("loads", {"kind": "force", "point": point, "vector": vector})

    # numbers

    def _set(self, operation: Operation) -> None:
        path, value = operation.get("path"), operation.get("value")
        if not isinstance(path, str) or len(path) > 300:
            raise InputError("", _("the path is a text"))
        sketch = self.sketch
        place, kind = place_of_path(sketch, path)
        if kind is None:
            self._write((place, written_like(value_at_place(sketch.tables, place), value)))
            return
        number = read_field(sketch, value, kind)
        if path in sketch.marks["locked"]:
            raise InputError(path, _("this length is locked"), _("unlock it first"))
        mechanism = sketch.document.mechanism
        geometric = place[0] in ("links", "frame", "guides", "drives", "points") and kind in (
            "length",
            "angle",
        )
        if place[0] == "points" and len(place) == 3:
            point = str(place[1])
            to = [*sketch.places[point]]
            to[int(place[2])] = number
            self._drop(point, tuple(to))
            return
        if geometric and mechanism is not None and sketch.document.prepared is not None:
            self._follow(sketch, path, place, number, value, kind)
            return
        if place[0] == "links" and place[-1] == "length" and follows_from_points(sketch, str(place[1])):
            self._stretch(sketch, str(place[1]), number)
            return
        old = value_at_place(sketch.tables, place)
        self._write((place, typed_quantity(sketch, old, value, number, kind)))

    def _stretch(self, sketch: Sketch, link: str, length: float) -> None:
        """Another length of a link that cannot move yet: its second point goes, or its first where that one is free."""
        first, second = sketch.links[link][:2]
        if second in sketch.fixed or (
            len(sketch.owners(second)) > 1 and len(sketch.owners(first)) < 2 and first not in sketch.fixed
        ):
            first, second = second, first
        (x, y), (u, v) = sketch.places[first][:2], sketch.places[second][:2]
        share = length / math.hypot(u - x, v - y)
        self._drop(second, (x + share * (u - x), y + share * (v - y)))

    def _follow(self, sketch: Sketch, path: str, place: Place, number: float, value: Any, kind: str) -> None:
        """Another number of a mechanism that moves: its initial position follows on the same side."""
        old = value_at_place(sketch.tables, place)
        prepared = follow(sketch, path, number)
        own: tuple[Assignment, ...] = ()
        if old is not None or place[0] == "drives":
            own = ((place, typed_quantity(sketch, old, value, number, kind)),)
        self._write(*own, *written_position(sketch, prepared, {place}))

    def _move_point(self, operation: Operation) -> None:
        self._plane()
        self._drop(self._point_of(operation), self._place_of(operation, "to"))

    def _drop(self, point: str, to: Vector) -> None:
        reshaped = reshape(self.sketch, point, to, self.folder)
        self._write(*reshaped.assignments)

    def _lock(self, operation: Operation) -> None:
        path, on = operation.get("path"), bool(operation.get("on", True))
        sketch = self.sketch
        if path in sketch.points:
            self._mark("fixed", str(path), on)
            return
        if path not in {f"links.{name}.length" for name in sketch.links if sketch.length(name) is not None}:
            raise InputError("", _("only a link of two points has a length to lock"))
        self._mark("locked", str(path), on)

    # whole objects

    def _delete(self, operation: Operation) -> None:
        for name in self._objects(operation):
            sketch = self.sketch
            guides = {guide_name(sketch, k): k for k in range(len(sketch.guides))}
            loads = {load_name(k): k for k in range(len(list_of_tables(sketch.tables, "loads")))}
            if name in sketch.links:
                self._delete_link(name)
            elif name in sketch.points:
                self._delete_point(name)
            elif name in guides:
                self._remove_guides([guides[name]])
            elif name in loads:
                self._remove(("loads", loads[name]))
            else:
                continue  # it went with another one

    def _delete_link(self, link: str) -> None:
        sketch = self.sketch
        points = sketch.links[link]
        self._remove(("links", link), *self._referring(sketch, link, "link"))
        self.text = marked_names(self.text, {f"links.{link}.length": None})
        self._drop_unused(points)

    def _referring(self, sketch: Sketch, name: str, kind: str) -> list[Place]:
        """What goes with an object: entries that name it, and the key of its side."""
        places: list[Place] = []
        for place in references(sketch.tables, name, kind):
            room = place[0]
            if room in ("guides", "drives", "loads", "gears", "rolling"):
                places.append(place[:2])
            elif room == "links":
                if str(place[1]) == name and kind == "link":
                    continue
                what = _("{place} names {name}").format(
                    place=".".join(map(str, place)), name=value_text(name)
                )
                raise InputError(name, what, _("change it in the text first"))
            elif room == "report":
                places.append(place)
        places += [place for place in key_places(sketch.tables, name, kind) if place[0] == "assembly"]
        return list(dict.fromkeys(places))

    def _drop_unused(self, points: Sequence[str]) -> None:
        """Points that nothing has any more."""
        for point in points:
            sketch = self.sketch
            if point in sketch.points and not sketch.owners(point) and not sketch.guides_of(point):
                self._delete_point(point)
            elif point not in sketch.points:
                self._forget(point)

    def _forget(self, point: str) -> None:
        """What still names a point that is gone."""
        self._remove(*self._referring(self.sketch, point, "point"))
        self.text = marked_names(self.text, {point: None})

    def _delete_point(self, point: str) -> None:
        sketch = self.sketch
        for link in sketch.owners(point):
            rest = [one for one in sketch.links[link] if one != point]
            if len(rest) < 2 or not sketch.tables["links"][link].get("points"):
                self._delete_link(link)
                continue
            place: Place = ("links", link, "points")
            if isinstance(value_at_place(sketch.tables, place), Mapping):
                self._remove((*place, point))
            else:
                self._write((place, rest))
        sketch = self.sketch
        if point not in sketch.points:
            return
        frame = sketch.tables.get("frame", {}).get("points")
        gone: list[Place] = self._referring(sketch, point, "point")
        gone += [
            place for place in key_places(sketch.tables, point, "point") if place[0] in ("points", "frame")
        ]
        if isinstance(frame, list) and point in frame:
            self._write((("frame", "points"), [one for one in frame if one != point]))
        guides = sketch.guides_of(point)
        gone += [
            ("drives", k) for g in guides for k in sketch.drives_of(str(sketch.guides[g].get("name", point)))
        ]
        self._remove(*dict.fromkeys(gone))
        self.text = marked_names(self.text, {point: None})

    def _duplicate(self, operation: Operation) -> None:
        sketch = self._plane()
        by = self._place_of(operation, "by")
        links, points = self._chosen(self._objects(operation))
        for point in points:
            if point not in sketch.places:
                raise InputError(point, _("its place is not known: correct the description first"))
        if not self._is_short():
            self._duplicate_measured(links, points, by)
            return
        new = {
            point: self._new_point((sketch.places[point][0] + by[0], sketch.places[point][1] + by[1]))
            for point in points
        }
        for point in points:
            if point in sketch.fixed:
                self._set_ground(new[point], True)
        for link in links:
            self._copy_link(sketch, link, new)

    def _copy_link(self, sketch: Sketch, link: str, new: Mapping[str, str]) -> None:
        first, *rest = (new[point] for point in sketch.links[link])
        name = self._link_name(first, rest[0]) if len(rest) == 1 else self._plate_name()
        table = dict(sketch.tables["links"][link])
        table.pop("points", None)
        if isinstance(table.get("centre"), str):
            table["centre"] = new[table["centre"]]
        points = sketch.tables["links"][link].get("points")
        if isinstance(points, Mapping):
            entries = {"points": {new[key]: value for key, value in points.items()}, **table}
        else:
            entries = table if two_points(name) else {"points": [first, *rest], **table}
        self._add_table(("links", name), entries)
        self.named.append(name)

    def _plate_name(self) -> str:
        taken = {*self.sketch.links, *self.sketch.points}
        return next(name for name in (f"link {k}" for k in count(1)) if name not in taken)

    def _duplicate_measured(self, links: Sequence[str], points: Sequence[str], by: Vector) -> None:
        """Copies of links with lengths and angles: those of points of the frame are points of the frame."""
        sketch = self.sketch
        anchors = [point for point in points if point in sketch.fixed]
        if not anchors:
            what = _("in this description links have lengths and angles, and the copy would hang on nothing")
            raise InputError("", what, _("choose a link with a point of the frame too"))
        free = self._free_names()
        new = {point: next(free) for point in points}
        self.named += new.values()
        for point in anchors:
            place = sketch.places[point]
            self._write((("frame", "points", new[point]), self._pair((place[0] + by[0], place[1] + by[1]))))
        for link in links:
            self._copy_link(sketch, link, new)
            name = self.named[-1]
            if sketch.angle(link) is None or sketch.tables["links"][link].get("angle") is None:
                self._write((("links", name, "angle"), self._angle(sketch.poses[link][1])))

    def _chosen(self, objects: Sequence[str]) -> tuple[list[str], list[str]]:
        """Links and points that are chosen; links bring their points."""
        sketch = self.sketch
        links = [name for name in objects if name in sketch.links]
        points = [point for link in links for point in sketch.links[link]]
        points += [name for name in objects if name in sketch.points and name not in sketch.links]
        if not points:
            raise InputError("", _("nothing is chosen"), _("choose a point or a link"))
        return links, list(dict.fromkeys(points))

    def _mirror(self, operation: Operation) -> None:
        sketch = self._plane()
        _links, points = self._chosen(self._objects(operation))
        known = [sketch.places[one] for one in points if one in sketch.places]
        if len(known) < len(points):
            raise InputError("", _("its place is not known: correct the description first"))
        (x, y), direction = self._axis(operation.get("axis"), known)
        cosine, sine = math.cos(2.0 * direction), math.sin(2.0 * direction)
        moved: dict[str, Vector] = {}
        for point in points:
            if point in sketch.marks["fixed"]:
                raise InputError(point, _("this joint is held: switch Fixed off to drag it"))
            u, v = sketch.places[point][0] - x, sketch.places[point][1] - y
            moved[point] = (x + u * cosine + v * sine, y + u * sine - v * cosine)
        self._write(*reshaped_by(sketch, moved, self.folder).assignments)

    def _axis(self, axis: Any, places: Sequence[Vector]) -> tuple[Vector, float]:
        """A place on the axis of a mirror, and its direction."""
        if axis in ("x", "horizontal", "y", "vertical", None):
            middle = tuple((min(x) + max(x)) / 2 for x in zip(*places, strict=True))
            return middle, 0.0 if axis in ("x", "horizontal") else QUARTER
        if isinstance(axis, list) and len(axis) == 2:
            first, second = (self._place_of({"axis": one}, "axis") for one in axis)
            if first != second:
                return first, math.atan2(second[1] - first[1], second[0] - first[0])
        raise InputError("", _('an axis is "x", "y" or two places'))

    def _rename(self, operation: Operation) -> None:
        sketch = self.sketch
        old, given = operation.get("object"), operation.get("name")
        try:
            name = read_link_name(given) if old in sketch.links else read_name(given)
        except ValueError as error:
            raise InputError("", getattr(error, "what", str(error)), getattr(error, "repair", "")) from None
        if name == old:
            return
        if name in sketch.links or name in sketch.points:
            raise InputError(
                "", _("{name} is taken already").format(name=value_text(name)), _("choose another name")
            )
        if old in sketch.points and old not in sketch.links:
            self._rename_point(str(old), name)
        elif old in sketch.links:
            self._rename_link(str(old), name)
        else:
            raise InputError("", _("the server does not know this object"))
        self.changed.append(name)

    def _rename_link(self, old: str, name: str) -> None:
        sketch = self.sketch
        changes = TextChanges(self.text)
        table, points = sketch.tables["links"][old], sketch.links[old]
        if not table.get("points") and two_points(name) != points:
            changes.set(("links", old, "points"), list(points))
        for place in references(changes.tables, old, "link"):
            changes.set(place, name)
        for place in [*key_places(changes.tables, old, "link")]:
            changes.rename_key(place, name)
        self.text = marked_names(changes.text, {f"links.{old}.length": f"links.{name}.length"})

    def _rename_point(self, old: str, name: str) -> None:
        sketch = self.sketch
        for link, points in sketch.links.items():
            if old in points and not sketch.tables["links"][link].get("points"):
                first, second = (name if one == old else one for one in points)
                taken = {*sketch.links, *sketch.points}
                if two_points(first + second) == (first, second) and first + second not in taken:
                    # the name of the link is its points: it goes with them
                    changes = TextChanges(self.text)
                    for place in references(changes.tables, link, "link"):
                        changes.set(place, first + second)
                    for place in [*key_places(changes.tables, link, "link")]:
                        changes.rename_key(place, first + second)
                    path = f"links.{link}.length"
                    self.text = marked_names(changes.text, {path: f"links.{first + second}.length"})
                else:
                    self._write((("links", link, "points"), list(points)))
        self._replace_point(old, name)
        changes = TextChanges(self.text)
        for place in [*key_places(changes.tables, old, "point")]:
            changes.rename_key(place, name)
        self.text = marked_names(changes.text, {old: name})

    def _replace_point(self, old: str, name: str) -> None:
        """Name another point wherever a text names this one; a guide without a name is called as its point."""
        changes = TextChanges(self.text)
        kinds = ["point"]
        if any(
            one.get("point") == old and not one.get("name")
            for one in list_of_tables(changes.tables, "guides")
        ):
            kinds.append("guide")
        for kind in kinds:
            for place in references(changes.tables, old, kind):
                changes.set(place, name)
        self.text = changes.text

    def _join(self, operation: Operation) -> None:
        sketch = self._plane()
        points = operation.get("points") or [operation.get("point"), operation.get("to")]
        if not isinstance(points, list) or len(points) != 2 or points[0] == points[1]:
            raise InputError("", _('two different points are needed: ["A", "B"]'))
        old, kept = (self._point_of({"point": one}) for one in points)
        both = [link for link, of_link in sketch.links.items() if old in of_link and kept in of_link]
        if both:
            what = _("points {first} and {second} both belong to {link}")
            raise InputError("", what.format(first=old, second=kept, link=both[0]))
        if old in sketch.fixed or kept not in sketch.places:
            old, kept = kept, old
        if old in sketch.fixed:
            raise InputError("", _("both points belong to the frame"), _("switch Ground off at one of them"))
        if (
            kept in sketch.places
            and old in sketch.places
            and math.dist(sketch.places[kept], sketch.places[old]) > 1e-9 * sketch.size
            and not sketch.is_short_form
        ):
            self._drop(old, sketch.places[kept])
            sketch = self.sketch
        for link, of_link in sketch.links.items():
            if old in of_link and not sketch.tables["links"][link].get("points"):
                self._write((("links", link, "points"), list(of_link)))
        guides = [k for k in sketch.guides_of(old) if sketch.guides_of(kept)]
        if guides:
            self._remove_guides(guides)
        self._replace_point(old, kept)
        changes = TextChanges(self.text)
        for place in [*key_places(changes.tables, old, "point")]:
            if place[0] == "links":
                changes.rename_key(place, kept)
            else:
                changes.remove(place)
        self.text = marked_names(changes.text, {old: None})
        self.changed.append(kept)
