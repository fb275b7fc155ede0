"""A text of a description that operations change, and what they all need: free names, places, spelled numbers."""

from __future__ import annotations

import math
import string
from collections.abc import Iterator, Mapping
from itertools import count
from pathlib import Path
from typing import Any, TypeAlias

from centrode.app.documents import Document, read_document
from centrode.app.edit_drags import Assignment, value_at_place
from centrode.app.quantity_texts import written_quantity
from centrode.app.sketch import SketchParts, Vector, on_unit_sphere, with_mark
from centrode.app.text_changes import TextChanges
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.reading import Place, two_points, value_text

Operation: TypeAlias = Mapping[str, Any]
"""What a message wants to be changed."""

OBJECTS = 200
"""Objects of one operation."""


class Patch:
    """A text that operations change.

    Attributes
    ----------
    text : as it is now
    changed : paths of what was changed
    named : names of the objects that operations made
    held : why a joint does not stand where it was put; empty if it does
    """

    def __init__(self, text: str, folder: Path) -> None:
        self.text, self.folder = text, folder
        self.changed: list[str] = []
        self.named: list[str] = []
        self.held = ""

    @property
    def document(self) -> Document:
        """The description as it is now."""
        return read_document(self.text, self.folder)

    @property
    def sketch(self) -> SketchParts:
        """What is drawn of it."""
        return SketchParts(self.document)

    def keep_places(self, before: SketchParts) -> None:
        """Write the angles of links that no position gives any more, so that they stay where they were drawn."""
        while True:
            sketch = self.sketch
            lost = [
                name
                for name in sketch.links
                if name not in sketch.poses and name in before.poses and sketch.local(name)
            ]
            # an angle may place the links behind it too
            if not lost:
                return
            place: Place = ("links", lost[0], "angle")
            if value_at_place(sketch.tables, place) is not None:
                return
            self.write((place, self.angle(before.poses[lost[0]][1])))

    def write(self, *assignments: Assignment) -> None:
        """Give keys their values."""
        changes = TextChanges(self.text)
        for place, value in assignments:
            changes.set(place, value)
            self.changed.append(".".join(map(str, place)))
        self.text = changes.text

    def remove(self, *places: Place) -> None:
        """Take out keys, tables and entries; entries of one list from behind, so that numbers stay those of before."""
        changes = TextChanges(self.text)
        for place in sorted(
            places, key=lambda one: [str(x) if isinstance(x, str) else f"{x:09d}" for x in one], reverse=True
        ):
            changes.remove(place)
            self.changed.append(".".join(map(str, place)))
        self.text = changes.text

    def add_table(self, place: Place, entries: Mapping[str, Any]) -> None:
        """Add a table under a heading of its own."""
        changes = TextChanges(self.text)
        changes.add_table(place, entries)
        self.text = changes.text
        self.changed.append(".".join(map(str, place)))

    def add_entry(self, room: str, entries: Mapping[str, Any]) -> None:
        """Add an entry to a list of tables."""
        changes = TextChanges(self.text)
        changes.add_entry(room, entries)
        self.text = changes.text
        self.changed.append(f"{room}.{len(changes.tables[room]) - 1}")

    def drawn_sketch(self) -> SketchParts:
        """What is drawn; InputError on the sphere where links have arcs in place of points with coordinates."""
        sketch = self.sketch
        if sketch.on_sphere and not sketch.draws_points:
            what = _(
                "on the sphere drawings have coordinates of points, and this description has arcs and angles"
            )
            raise InputError("", what, _("change it in the text"))
        return sketch

    def point_of(self, operation: Operation, key: str = "point") -> str:
        """The point that an operation names; InputError where there is none of this name."""
        name = operation.get(key)
        if name not in self.sketch.points:
            raise InputError("", _("unknown point {name}").format(name=value_text(name)))
        return str(name)

    def place_of(self, operation: Operation, key: str) -> Vector:
        """The place that an operation gives [m]; InputError for anything else."""
        value = operation.get(key)
        numbers = (
            [float(x) for x in value if isinstance(x, int | float) and not isinstance(x, bool)]
            if isinstance(value, list)
            else []
        )
        axes = 3 if self.sketch.on_sphere else 2
        given = len(value) if isinstance(value, list) else 0
        if not (len(numbers) == given == axes and all(map(math.isfinite, numbers))):
            what = _("a place is two numbers") if axes == 2 else _("a place on the sphere is three numbers")
            raise InputError("", what)
        place = tuple(numbers) if axes == 2 else on_unit_sphere(tuple(numbers))
        if place is None:
            raise InputError("", _("a place on the sphere is not its centre"))
        return place

    def objects_of(self, operation: Operation) -> list[str]:
        """The objects that an operation names, each once."""
        objects = operation.get("objects")
        if (
            not isinstance(objects, list)
            or not all(isinstance(one, str) for one in objects)
            or len(objects) > OBJECTS
        ):
            raise InputError("", _("the objects are a list of names"))
        return list(dict.fromkeys(objects))

    def free_names(self) -> Iterator[str]:
        """Names of points that are not taken: A to Z, then A1 and so on."""
        taken = {*self.sketch.points, *self.sketch.links}
        for k in count():
            for letter in string.ascii_uppercase:
                name = f"{letter}{k or ''}"
                if name not in taken:
                    yield name

    def length(self, value: float, old: Any = None) -> Any:
        """A length [m] as the file writes it."""
        return written_quantity(self.sketch, old, value, "length")

    def pair(self, place: Vector) -> list[Any]:
        """Coordinates of a place as the file writes them."""
        sketch = self.sketch
        kind = "angle" if sketch.on_sphere else "length"
        return [written_quantity(sketch, None, x, kind) for x in sketch.numbers_of(place)]

    def angle(self, value: float, old: Any = None) -> Any:
        """An angle [rad] as the file writes it."""
        return written_quantity(self.sketch, old, value, "angle")

    def new_point(self, place: Vector, name: str | None = None) -> str:
        """A point with coordinates in the table of points."""
        name = name or next(self.free_names())
        if self.sketch.is_short_form:
            self.write((("points", name), self.pair(place)))
        else:
            self.add_table(("points",), {name: self.pair(place)})
            self.changed[-1] = f"points.{name}"
        self.named.append(name)
        return name

    def link_name(self, first: str, second: str) -> str:
        """A name for a link of two points: both, where that means these points, else a number."""
        taken = {*self.sketch.links, *self.sketch.points}
        both = first + second
        if two_points(both) == (first, second) and both not in taken and second + first not in taken:
            return both
        return self.numbered_name()

    def set_mark(self, word: str, name: str, on: bool) -> None:
        """Put a name under a mark of the workbench, or take it away."""
        self.text = with_mark(self.text, word, name, on)
        self.changed.append(name)

    def numbered_name(self) -> str:
        """A name for a link that its points do not name."""
        taken = {*self.sketch.links, *self.sketch.points}
        return next(name for name in (f"link {k}" for k in count(1)) if name not in taken)
