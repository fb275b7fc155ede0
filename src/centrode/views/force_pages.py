"""Pages of forces by hand: which places, forces and lines of a group, of its polygon and of a lever are drawn."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from centrode.sheets.force_pages import (
    ConstructionPoint,
    DrawnPolygon,
    ForceSign,
    ForceStroke,
    GroupPage,
    GuideSign,
    LeverPage,
)
from centrode.sheets.texts import Name, Number, Sentence

if TYPE_CHECKING:
    from centrode.dynamics.force_polygons.polygons import (
        ForcePolygons,
        GroupForces,
        Lever,
        Polygon,
        PolygonVector,
    )
    from centrode.dynamics.force_polygons.statics import Action
    from centrode.sheets.texts import Text

RIGHT_ANGLE = Number(90.0, "deg", unit_fixed=True)
TINY = 1e-12
"""Moments smaller than this part of the greatest about the pole are none."""
IN_LINE = 1e-9
"""Sine of the angle up to which a place lies on a line through two hinges."""


def group_page(found: ForcePolygons, group: GroupForces, heading: Text, lines: tuple[Text, ...]) -> GroupPage:
    """A group with what acts on it, and its polygon."""
    actions = [*group.actions, *group.reactions]
    hinges = tuple(joint.name for joint in group.joints if joint.kind == "hinge")
    together = group.kind == "together"
    by_links = together and len(group.bodies) > 1
    polygons = (
        [polygon for polygon in group.link_polygons if polygon.vectors] if by_links else [group.polygon]
    )
    return GroupPage(
        Sentence("Force polygon"),
        heading,
        found.mechanism,
        found.exact,
        found.paper_size,
        tuple(zip(group.numbers, group.bodies, strict=True)),
        hinges,
        frozenset({*hinges, *(one.label for one in group.actions if one.source == "reaction")}),
        tuple(_guides(found, group)),
        tuple(_marks(found, group)),
        tuple(ForceSign(one.symbol, one.place, one.force, link=_link(found, one)) for one in actions),
        tuple(_moment(found, one) for one in actions if one.moment != 0.0),
        tuple(_drawn(found, polygon, by_links) for polygon in polygons),
        together,
        tuple(_sizes(group)),
        corners_of(_places(found, group)),
        corners_of(found.places.values()),
        lines,
    )


def lever_page(found: ForcePolygons, lever: Lever, lines: tuple[Text, ...]) -> LeverPage:
    """The lever with its forces; at the pole none turns it, moments stand in the middle of their links."""
    greatest = max((abs(one.moment) for one in lever.forces), default=0.0)
    moments = []
    for one in lever.forces:
        if abs(one.couple) > TINY * greatest:
            middle = _middle([lever.images[point] for point in lever.links.get(one.body, ())])
            moments.append(ForceSign(one.name, middle, moment=one.couple))
    if lever.unit == "N m" and abs(lever.balancing) > TINY * greatest:
        moments.append(ForceSign("Mb", 0j, moment=lever.balancing))
    return LeverPage(
        Sentence("Zhukovsky's lever of drive {drive}", drive=Name(lever.drive)),
        Sentence("Velocity diagram turned by {angle} clockwise", angle=RIGHT_ANGLE),
        found.mechanism,
        found.exact,
        found.paper_size,
        lever.drive,
        lever.unit,
        corners_of([0j, *lever.images.values(), *(one.image for one in lever.forces)]),
        lever.images,
        tuple(
            ForceSign(one.name, one.image, one.force)
            for one in lever.forces
            if one.force != 0 and one.image != 0
        ),
        tuple(moments),
        lines,
    )


def corners_of(places: Iterable[complex]) -> tuple[complex, complex]:
    """The least and the greatest coordinates of places."""
    places = list(places)
    across, up = [place.real for place in places], [place.imag for place in places]
    return complex(min(across), min(up)), complex(max(across), max(up))


def _places(found: ForcePolygons, group: GroupForces) -> Iterator[complex]:
    """Points of the group, its joints, where forces act, and corners around rolling wheels."""
    for body in group.bodies:
        if body in found.mechanism.links:
            yield from (found.places[point] for point in found.mechanism.links[body].coordinates)
    yield from (one.place for one in (*group.actions, *group.reactions) if one.force != 0)
    yield from (joint.place for joint in group.joints if joint.kind in ("hinge", "guide", "rolling"))
    for wheel in found.mechanism.rolling:
        if wheel.link in group.bodies:
            yield from (found.places[wheel.centre] + wheel.radius * corner for corner in (1 + 1j, -1 - 1j))


def _link(found: ForcePolygons, one: Action | PolygonVector) -> str:
    """The link in whose colour a reaction is drawn; loads have none."""
    return one.body if one.source == "reaction" and one.body in found.mechanism.links else ""


def _moment(found: ForcePolygons, one: Action) -> ForceSign:
    """A moment: beside its force, at its drive, else in the middle of its link."""
    links = found.mechanism.links
    place = one.place
    if one.source != "drive" and one.force == 0:
        points = links[one.body].coordinates if one.body in links else ()
        place = _middle([found.places[point] for point in points])
    name = one.symbol if one.force == 0 else f"M{one.symbol.removeprefix('R')}"
    return ForceSign(name, place, moment=one.moment, link=_link(found, one))


def _middle(places: list[complex]) -> complex:
    return sum(places, 0j) / max(1, len(places))


def _guides(found: ForcePolygons, group: GroupForces) -> Iterator[GuideSign]:
    """Guides of the group, in the description's order."""
    joints = {joint.name: joint for joint in reversed(group.joints) if joint.kind == "guide"}
    for guide in found.mechanism.guides:
        if guide.id in joints:
            carrier = joints[guide.id].other(guide.on)
            slider = found.names.index(carrier) if carrier in group.bodies else None
            yield GuideSign(guide.id, joints[guide.id].along, guide.on in group.bodies, slider)


def _marks(found: ForcePolygons, group: GroupForces) -> Iterator[ConstructionPoint]:
    """Special points, each with the hinges from which a line leads to it through another."""
    hinges = [found.places[joint.name] for joint in group.joints if joint.kind == "hinge"]
    for name, mark in group.marks:
        arms = [
            hinge
            for hinge in hinges
            if any(other != hinge and _is_in_line(hinge, other, mark) for other in hinges)
        ]
        yield ConstructionPoint(name, mark, tuple(arms))


def _is_in_line(first: complex, second: complex, place: complex) -> bool:
    """Whether a place lies on the line through two others."""
    along, way = second - first, place - first
    return abs((along.conjugate() * way).imag) <= IN_LINE * abs(along) * max(abs(way), abs(along))


def _drawn(found: ForcePolygons, polygon: Polygon, by_links: bool) -> DrawnPolygon:
    """Forces one behind the other, sums of parts, and inner reactions."""

    def stroke(one: PolygonVector, kind: str) -> ForceStroke:
        whole = one.whole if kind == "part" else ""
        return ForceStroke(one.name, one.start, one.force, kind, whole, _link(found, one))

    strokes = [stroke(one, "part" if one.is_part else "force") for one in polygon.vectors]
    strokes += [stroke(one, "sum") for one in polygon.sums]
    strokes += [stroke(one, "chord") for one in polygon.chords]
    return DrawnPolygon(
        tuple(strokes), polygon.scale, found.names.index(polygon.bodies[0]) if by_links else 0
    )


def _sizes(group: GroupForces) -> Iterator[tuple[str, float]]:
    """Every force by its name, once."""
    shown = [*group.polygon.vectors, *group.polygon.sums, *group.polygon.chords]
    if group.kind == "together":
        shown = [vector for polygon in group.link_polygons for vector in polygon.vectors]
    for vector in {vector.name: vector for vector in shown}.values():
        yield vector.name, abs(vector.force)
