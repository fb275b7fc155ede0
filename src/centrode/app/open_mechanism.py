"""The open mechanism as what a synthesis seeks: what it offers, the request with it, an answer in its text."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from centrode.app.documents import Document, plain_tables, read_document
from centrode.app.edit_drags import Assignment, value_at_place, written_position
from centrode.app.number_fields import place_of_path
from centrode.app.patches import Patch
from centrode.app.quantity_texts import written_quantity
from centrode.app.sketch import SketchParts
from centrode.app.text_changes import TextChanges
from centrode.errors import CentrodeError, InputError
from centrode.kinematics.preparation import ready
from centrode.locale import _
from centrode.model.files import mechanism_text, value_at
from centrode.model.mechanism import FRAME, Mechanism
from centrode.synthesis.requests import SYNTHESES, SynthesisTask
from centrode.topics.topic import Lazily

SYNTHESIS = "synthesis"
RANGES = Lazily("centrode.report.mechanism_page.numbers_that_vary", "ranges_of")
JOINTS = Lazily("centrode.report.mechanism_page.numbers_that_vary", "joints_of")
NAME = Lazily("centrode.report.mechanism_page.numbers_that_vary", "name_of")
AROUND = 0.5
"""A point where nothing is hinged may go as far on both sides, in the size of the drawing."""
SAME_PLACE = 1e-4
"""Points of a text and of its answer are apart by less, in the size of the drawing."""
WRITTEN_DIGITS = 10
"""Significant digits of a number that a text gets: what an answer meets exactly it meets to a micrometre still."""
MILLIMETRES = 1e3
DIGITS = 6


def mechanism_offer(text: str, folder: Path) -> dict[str, Any]:
    """What the page asks of the mechanism of a text: its points, links, outputs, and numbers with ranges [mm].

    Raises InputError where the text describes no mechanism of the plane that stands.
    """
    document = described_mechanism(text, folder)
    mechanism = document.require_mechanism()
    driven = {drive.link for drive in mechanism.drives if drive.link is not None}
    moved = [name for name in mechanism.links if name not in driven]
    drive, joints = mechanism.drives[0], JOINTS(mechanism)
    return {
        "title": mechanism.title,
        # first what traces, then where links are hinged
        "points": sorted(
            (name for name in mechanism.points if name not in mechanism.frame.points),
            key=lambda name: name in joints,
        ),
        "links": [*moved, *(name for name in mechanism.links if name in driven)],
        "outputs": [f"angle.{name}" for name in moved] + [f"slide.{guide.id}" for guide in mechanism.guides],
        "crank": drive.link if drive.kind == "angle" else None,
        "drive": "deg" if drive.kind == "angle" else "mm",
        "numbers": list(_numbers(document)),
        "sheet": {**places_of(mechanism), "curve": []},
    }


def described_mechanism(text: str, folder: Path) -> Document:
    """The text without what it wants of a synthesis; InputError where it is no mechanism of the plane that stands."""
    document = read_document(text_without_wishes(text), folder)
    if document.require_mechanism().space != "plane":
        what = _("mechanisms of files are synthesised in the plane")
        raise InputError("", what, _("choose a new mechanism"))
    if document.is_cam or document.position is None or not document.require_mechanism().drives:
        document.require_prepared()
        raise InputError("[[drives]]", _("nothing drives this mechanism"), _("switch Drive on at a link"))
    return document


def text_without_wishes(text: str) -> str:
    """A text without its table [synthesis]: its page asks for it."""
    try:
        if SYNTHESIS not in plain_tables(text):
            return text
        changes = TextChanges(text)
        changes.remove((SYNTHESIS,))
    except (ValueError, CentrodeError, RecursionError):
        return text
    return changes.text


def request_of_mechanism(text: str, folder: Path, wanted: Mapping[str, Any]) -> SynthesisTask:
    """What is wanted of the mechanism of a text; raises InputError that says what is wrong."""
    document = described_mechanism(text, folder)
    wishes = {key: value for key, value in wanted.items() if key != "topology"}
    return SYNTHESES.from_tables({**document.tables, SYNTHESIS: wishes}, "", folder)


def text_with_answer(text: str, folder: Path, names: tuple[str, ...], answer: Mechanism) -> tuple[str, bool]:
    """The text with the numbers of an answer, and whether all else stays as it was written.

    Where its numbers cannot be written so, it is the description of the answer alone.
    """
    patch = Patch(text_without_wishes(text), folder)
    try:
        sketch = patch.sketch
        own = dict(_own_numbers(sketch, names, answer))
        prepared = ready(answer)
        patch.write(*own.items(), *written_position(sketch, prepared, set(own)))
        stands = patch.document.require_prepared().assembled.positions.points
        size = SAME_PLACE * max(sketch.size, patch.sketch.size)
        if all(
            math.dist(map(float, place), map(float, stands[name])) < size
            for name, place in prepared.assembled.positions.points.items()
        ):
            return patch.text, True
    except CentrodeError:
        pass
    return mechanism_text(answer), False


def _own_numbers(sketch: SketchParts, names: tuple[str, ...], answer: Mechanism) -> Iterator[Assignment]:
    """The keys of free numbers with their values in an answer, spelled as the old ones; lengths of points follow."""
    for path in names:
        place, kind = place_of_path(sketch, path)
        old = value_at_place(sketch.tables, place)
        if old is not None:
            value = float(f"{value_at(answer, path):.{WRITTEN_DIGITS}g}")
            yield place, written_quantity(sketch, old, value, kind or "length", exactly=True)


def places_of(mechanism: Mechanism) -> dict[str, Any]:
    """Where everything stands initially [mm], for a picture."""
    at = ready(mechanism).assembled.positions.points
    points = {name: _place(at[name]) for name in (*mechanism.frame.points, *mechanism.points) if name in at}
    return {
        "points": points,
        "fixed": [name for name in mechanism.frame.points if name in points],
        "links": [
            [name for name in link.points if name in points]
            for key, link in mechanism.links.items()
            if key != FRAME
        ],
    }


def _place(place: Any) -> list[float]:
    return [_short(float(part)) for part in place]


def _short(value: float) -> float:
    """Millimetres with the digits of a picture."""
    return float(f"{value * MILLIMETRES:.{DIGITS}g}")


def _numbers(document: Document) -> Iterator[dict[str, Any]]:
    mechanism = document.require_mechanism()
    ranges = dict(RANGES(mechanism))
    dimensions = set(ranges)
    for path in _free_coordinates(mechanism):
        value, reach = value_at(mechanism, path), AROUND * SketchParts(document).size
        ranges[path] = (value - reach, value + reach)
    for path, (least, greatest) in ranges.items():
        yield {
            "path": path,
            "name": NAME(mechanism, path),
            "least": _short(least),
            "greatest": _short(greatest),
            "chosen": path in dimensions and path.startswith("links."),
        }


def _free_coordinates(mechanism: Mechanism) -> Iterator[str]:
    """Coordinates of points where nothing is hinged, as that which traces a path; centres of mass stay."""
    joints = JOINTS(mechanism)
    for name, link in mechanism.links.items():
        for point in () if link.length is not None else link.coordinates:
            if point not in joints and point != link.centre:
                yield from (f"links.{name}.points.{point}.{axis}" for axis in "xy")
