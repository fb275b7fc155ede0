"""A joint dragged on the sphere: arcs, coordinates and angles in the description that put it at another place."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeAlias

from centrode.app.sketch import SketchParts, Vector, entries_of, number, unit_vector_of
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.reading import FRAME, Place
from centrode.model.values import (
    Vector3,
    angle_between,
    arc,
    axes,
    makes_arc,
    tangent_towards,
    transfer_vector,
)

Assignment: TypeAlias = tuple[Place, Any]
UNCHANGED = 1e-12
"""Change [rad] below which nothing is written."""


def sphere_assignments(
    sketch: SketchParts,
    moved: Mapping[str, Vector],
    assignment: Callable[[Place, float, str], Assignment],
    pair: Callable[[Place, Vector], Iterator[Assignment]],
) -> Iterator[Assignment]:
    """Keys of links and drives that follow points to other places, everything else standing.

    `assignment` writes a number, `pair` the coordinates of a place. Raises InputError where the points of a link would
    coincide or lie opposite each other.
    """
    places = {name: _vector(place) for name, place in {**sketch.places, **moved}.items()}
    for name, points in sketch.links.items():
        link = sketch.tables["links"][name]
        concerned = len(points) > 1 and any(point in moved for point in points)
        if concerned and not makes_arc(*(places[point] for point in points[:2])):
            raise InputError(f"[links.{name}]", _("its points would coincide"), _("drag it another way"))
        if concerned and isinstance(link.get("points"), Mapping):
            yield from _own_places(sketch, name, places, pair)
        elif concerned and link.get("length") is not None:
            length = arc(*(places[point] for point in points[:2]))
            yield assignment(("links", name, "length"), length, "angle")
        angle = _angle(sketch, name, places)
        turns = concerned or bool(set(entries_of(link.get("reference"))) & set(moved))
        if angle is None or not turns:
            continue
        if link.get("angle") is not None:
            place: Place = ("links", name, "angle")
            yield assignment(place, _near(angle, number(link["angle"], "angle")), "angle")
        yield from _start(sketch, name, angle, assignment)


def _vector(place: Vector) -> Vector3:
    x, y, z = place
    return x, y, z


def _own_places(
    sketch: SketchParts, name: str, places: Mapping[str, Vector3], pair: Callable[..., Iterator[Assignment]]
) -> Iterator[Assignment]:
    """Coordinates in the axes of a link: its first point stays there, the second in its direction."""
    table = sketch.tables["links"][name]["points"]
    local = {point: unit_vector_of(value) for point, value in table.items()}
    first, second = (_vector(local[point] or ()) for point in sketch.links[name][:2])
    pivot, tip = (places[point] for point in sketch.links[name][:2])
    mine, theirs = (
        axes(start, tangent_towards(start, end)) for start, end in ((first, second), (pivot, tip))
    )
    for point, old in local.items():
        own = transfer_vector(places[point], theirs, mine)
        if old is None or arc(own, _vector(old)) > UNCHANGED:
            yield from pair(("links", name, "points", point), own)


def _angle(sketch: SketchParts, name: str, places: Mapping[str, Vector3]) -> float | None:
    """Angle [rad] of a link at its first point from its reference; None where it has none or a place is not known."""
    reference, points = entries_of(sketch.tables["links"][name].get("reference")), sketch.links[name]
    if len(reference) != 2 or len(points) < 2 or not {*reference, *points[:2]} <= places.keys():
        return None
    pivot, towards, tip = places[reference[0]], places[reference[1]], places[points[1]]
    if not (makes_arc(pivot, towards) and makes_arc(pivot, tip)):
        raise InputError(f"[links.{name}]", _("its points would coincide"), _("drag it another way"))
    return angle_between(pivot, towards, tip)


def _start(
    sketch: SketchParts, name: str, angle: float, assignment: Callable[[Place, float, str], Assignment]
) -> Iterator[Assignment]:
    """The value at which the drive of a link starts, where the text states it or nothing else does."""
    link = sketch.tables["links"][name]
    follows = sketch.is_short_form and link.get("length") is None
    for k in sketch.drives_of(name):
        drive = sketch.drives[k]
        start = number(drive.get("start"), "angle")
        if drive.get("link") != name or drive.get("relative_to", FRAME) != FRAME:
            continue
        if start is not None or not (follows or link.get("angle") is not None):
            yield assignment(("drives", k, "start"), _near(angle, start), "angle")


def _near(angle: float, old: float | None) -> float:
    return angle if old is None else angle + math.tau * round((old - angle) / math.tau)
