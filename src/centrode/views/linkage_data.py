"""What the description of a linkage gives, in the plane and on the sphere, as tables of documents."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from centrode.model.mechanism import FRAME, Placed
from centrode.model.values import TurnsPerMinute
from centrode.sheets.sheet import Block, Chapter, Column, Paragraph, Section, Table
from centrode.sheets.texts import NOTHING, Counted, Expression, Joined, Name, Number, Place, Sentence, Text
from centrode.views.follower_data import driving_cam

if TYPE_CHECKING:
    from centrode.model.mechanism import Drive, Guide, Link, Mechanism, Vector


def data_chapter(mechanism: Mechanism) -> Chapter:
    """Everything the description gives of the geometry and the drives."""
    on_sphere = mechanism.space == "sphere"
    blocks: list[Block] = [
        *(_on_sphere(mechanism) if on_sphere else _in_plane(mechanism)),
        *_drives(mechanism),
    ]
    return Chapter(Sentence("Data"), (Section(NOTHING, tuple(blocks)),))


def _in_plane(mechanism: Mechanism) -> Iterator[Block]:
    places = {name: _resolve(place) for name, place in mechanism.frame.points.items()}
    if places:
        columns = (
            _names(places, Sentence("point")),
            *(
                _cells([place[k] for place in places.values()], "m", Expression(axis))
                for k, axis in enumerate("xy")
            ),
        )
        yield Table(columns, Sentence("Points of the frame"))
    lengths = [_apart(link) if len(link.coordinates) == 2 else None for link in mechanism.links.values()]
    angles = [mechanism.initial_angle(name) for name in mechanism.links]
    yield _links(mechanism, _cells(lengths, "m", Sentence("length")), None, angles)
    bodies = {name: link for name, link in mechanism.links.items() if len(link.coordinates) > 2}
    yield from _bodies(bodies, "m", (Expression("xi"), Expression("eta")))
    yield from _guides(mechanism)
    yield from _gears(mechanism, Sentence("Gears"))
    yield from _wheels(mechanism)


def _on_sphere(mechanism: Mechanism) -> Iterator[Block]:
    yield Paragraph(
        Sentence(
            "Everything moves on a sphere about its centre, where all axes meet. Lengths are arcs; the angle of a link"
            " is measured at its first point from its reference arc, counter-clockwise seen from outside."
        )
    )
    yield _points_on_sphere(mechanism)
    links = mechanism.links.values()
    references = tuple(NOTHING if one.reference is None else Name("–".join(one.reference)) for one in links)
    yield _links(
        mechanism,
        _cells([one.length for one in links], "rad", Sentence("arc")),
        Column("reference", references, head=Sentence("angle is from arc")),
        [one.angle for one in links],
    )
    bodies = {name: link for name, link in mechanism.links.items() if link.length is None}
    yield from _bodies(bodies, "rad", (Sentence("longitude"), Sentence("latitude")))
    if mechanism.guides:
        radii = [math.pi / 2 if guide.radius is None else guide.radius for guide in mechanism.guides]
        columns = (
            *_kept(mechanism.guides),
            Column("pole", tuple(Name(str(guide.pole)) for guide in mechanism.guides), head=Sentence("pole")),
            _cells(radii, "rad", Sentence("radius")),
        )
        yield Table(columns, Sentence("Circles on which points are kept"))
    yield from _gears(mechanism, Sentence("Bevel gears"))


# Columns


def _names(names: Iterable[str], head: Sentence) -> Column:
    return Column("", tuple(map(Name, names)), head=head)


def _cells(values: Sequence[float | None], unit: str, head: Text) -> Column:
    """Numbers that have digits of their own each; an empty cell where nothing is given."""
    texts = tuple(
        NOTHING if value is None else Number(float(value) + 0.0, unit, digits="", unit_hidden=True)
        for value in values
    )
    return Column("", texts, unit, head)


def _body(name: str) -> Text:
    return Sentence("frame") if name == FRAME else Name(name)


# Points, links, guides, wheels


def _points_on_sphere(mechanism: Mechanism) -> Table:
    """Places of the frame, as directions and by longitude and latitude."""
    places = np.array([_angles(place) for place in mechanism.frame.points.values()]).reshape(-1, 2)
    along, up = places.T
    vectors = (np.cos(up) * np.cos(along), np.cos(up) * np.sin(along), np.sin(up))
    columns = (
        _names(mechanism.frame.points, Sentence("point")),
        *(
            Column("", _rounded_numbers(vector), head=Expression(axis))
            for axis, vector in zip("xyz", vectors, strict=True)
        ),
        Column("", _rounded_numbers(along), "rad", Sentence("longitude")),
        Column("", _rounded_numbers(up), "rad", Sentence("latitude")),
    )
    return Table(columns, Sentence("Points of the frame"))


def _rounded_numbers(values: np.ndarray) -> np.ndarray:
    """Numbers without what rounding has left of zero."""
    return np.where(np.abs(values) < 1e-15, 0.0, values)


def _links(
    mechanism: Mechanism, lengths: Column, references: Column | None, angles: Sequence[float | None]
) -> Table:
    numbers = tuple(Number(k, digits="d") for k in range(1, len(mechanism.links) + 1))
    points = tuple(Joined(tuple(map(Name, link.coordinates))) for link in mechanism.links.values())
    columns = (
        Column("number", numbers, head=Sentence("number")),
        _names(mechanism.links, Sentence("link")),
        Column("points", points, head=Sentence("points")),
        lengths,
        *(() if references is None else (references,)),
        _cells(angles, "rad", Sentence("initial angle")),
    )
    return Table(columns, Sentence("Moving links"))


def _bodies(links: dict[str, Link], unit: str, heads: tuple[Text, Text]) -> Iterator[Table]:
    """Points of links that are no plain bars."""
    rows = [
        (name, point, _angles(place))
        for name, link in links.items()
        for point, place in link.coordinates.items()
    ]
    if rows:
        columns = (
            _names([name for name, _point, _place in rows], Sentence("link")),
            _names([point for _name, point, _place in rows], Sentence("point")),
            *(
                _cells([place[k] for _name, _point, place in rows], unit, head)
                for k, head in enumerate(heads)
            ),
        )
        yield Table(columns, Sentence("Points of rigid links, in the links' own axes"))


def _kept(guides: Sequence[Guide]) -> tuple[Column, ...]:
    """Guides, the points they keep, and what carries them."""
    return (
        _names([guide.id for guide in guides], Sentence("guide")),
        _names([guide.point for guide in guides], Sentence("point")),
        Column("on", tuple(_body(guide.on) for guide in guides), head=Sentence("on")),
    )


def _guides(mechanism: Mechanism) -> Iterator[Table]:
    """Lines on which points are kept."""
    guides = mechanism.guides
    if guides:
        through = tuple(
            Name(guide.through) if isinstance(guide.through, str) else Place(_resolve(guide.through))
            for guide in guides
        )
        own = tuple(NOTHING if guide.link is None else Name(guide.link) for guide in guides)
        columns = (
            *_kept(guides),
            Column("through", through, head=Sentence("through $(x, y)$")),
            _cells([guide.direction_angle for guide in guides], "rad", Sentence("direction")),
            Column("link", own, head=Sentence("link that does not turn relative to it")),
        )
        yield Table(columns, Sentence("Guides"))


def _gears(mechanism: Mechanism, caption: Sentence) -> Iterator[Table]:
    gears = mechanism.gears
    if gears:
        links = tuple(Joined(tuple(map(_body, gear.links))) for gear in gears)
        columns = (
            _names([gear.id for gear in gears], Sentence("gear")),
            Column("links", links, head=Sentence("links")),
            Column("carrier", tuple(_body(gear.carrier) for gear in gears), head=Sentence("carrier")),
            _cells([gear.ratio for gear in gears], "1", Sentence("ratio")),
        )
        yield Table(columns, caption)


def _wheels(mechanism: Mechanism) -> Iterator[Table]:
    wheels = mechanism.rolling
    if wheels:
        columns = (
            _names([wheel.id for wheel in wheels], Sentence("wheel")),
            Column("on", tuple(_body(wheel.on) for wheel in wheels), head=Sentence("rolls on")),
            _cells([float(wheel.radius) for wheel in wheels], "m", Sentence("radius")),
        )
        yield Table(columns, Sentence("Rolling wheels"))


# Drives


def _drives(mechanism: Mechanism) -> Iterator[Block]:
    """What is given of the motion, and the cams that drive."""
    drives = mechanism.drives
    if drives:
        coordinates = [mechanism.motion_parameter.drive(drive.id) for drive in drives]
        starts = tuple(
            NOTHING if drive.start is None else Number(drive.start, coordinate.unit, digits="")
            for drive, coordinate in zip(drives, coordinates, strict=True)
        )
        laws = tuple(
            _law(drive, coordinate.speed_unit) for drive, coordinate in zip(drives, coordinates, strict=True)
        )
        columns = (
            _names([drive.id for drive in drives], Sentence("drive")),
            Column("given", tuple(map(_given, drives)), head=Sentence("given quantity")),
            Column("start", starts, head=Sentence("initial value")),
            Column("law", laws, head=Sentence("law")),
        )
        yield Table(columns, Sentence("Drives"))
        yield from _chosen_coordinate(mechanism)
    for drive in drives:
        if drive.cam is not None:
            yield from driving_cam(drive, drive.cam)


def _chosen_coordinate(mechanism: Mechanism) -> Iterator[Block]:
    """What the results belong to, where the author chose zero and sense."""
    drives = mechanism.motion_parameter.drives
    if len(drives) != 1 or not drives[0].is_chosen:
        return
    coordinate = drives[0]
    symbol, quantity = Name(coordinate.symbol), _given(mechanism.drives[0])
    # Translators: {symbol} is the letter of the coordinate, {quantity} such as "angle of link OA", {zero} a value of it
    if coordinate.sense < 0.0:
        text = Sentence(
            "The generalised coordinate {symbol} = {zero} − {quantity} stands in place of the value of the drive."
        )
    elif coordinate.zero < 0.0:
        text = Sentence(
            "The generalised coordinate {symbol} = {quantity} + {zero} stands in place of the value of the drive."
        )
    else:
        text = Sentence(
            "The generalised coordinate {symbol} = {quantity} − {zero} stands in place of the value of the drive."
        )
    size = coordinate.zero if coordinate.sense < 0.0 else abs(coordinate.zero)
    zero = Number(size, coordinate.unit, digits="")
    yield Paragraph(text.fill(symbol=symbol, quantity=quantity, zero=zero))


def _law(drive: Drive, speed_unit: str) -> Text:
    if drive.speed is not None:
        rate: Text = Number(drive.speed, speed_unit, digits="")
        if isinstance(drive.speed, TurnsPerMinute):
            turns = Number(drive.speed.rpm, "rpm", digits="", unit_fixed=True)
            rate = Sentence("{value} ({remark})", value=turns, remark=rate)
        return Sentence("constant {rate}", rate=rate)
    if drive.cam is not None:
        return Sentence("lift of a cam")
    if drive.law is not None:
        return Sentence("{formula}, in SI", formula=Name(drive.law))
    if drive.table is not None:
        return Sentence("table of {count} rows", count=Number(len(drive.table), digits="d"))
    if drive.segments is None:
        return Sentence("by a cam")
    return Counted("{n} segment of motion", "{n} segments of motion", len(drive.segments))


def _given(drive: Drive) -> Text:
    if drive.link is not None:
        link = Name(drive.link)
        if drive.relative_to == FRAME:
            return Sentence("angle of link {link}", link=link)
        return Sentence(
            "angle of link {link} relative to link {other}", link=link, other=Name(drive.relative_to)
        )
    if drive.guide is not None:
        return Sentence("displacement along guide {guide}", guide=Name(drive.guide))
    first, second = map(Name, drive.distance or ("", ""))
    return Sentence("distance of {first} and {second}", first=first, second=second)


# Places


def _resolve(place: Vector | Placed | None) -> tuple[float, float]:
    """Coordinates of a place, of one that the chain places those that it got."""
    at = place.at if isinstance(place, Placed) else place
    x, y = at or (0.0, 0.0)
    return float(x), float(y)


def _angles(place: object) -> tuple[float, float]:
    assert isinstance(place, tuple)
    return float(place[0]), float(place[1])


def _apart(link: Link) -> float:
    """Distance of the two points of a link."""
    if link.length is not None:
        return float(link.length)
    (ax, ay), (bx, by) = link.coordinates.values()
    return math.hypot(bx - ax, by - ay)
