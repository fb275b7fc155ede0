"""What is given of a linkage on the sphere: places of the frame, links, circles, gears, drives."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, pi, sin
from typing import TYPE_CHECKING

from centrode.locale import _
from centrode.model.mechanism import FRAME, Drive, Link, Mechanism
from centrode.render.document.blocks import (
    Block,
    ChapterBlocks,
    ParagraphBlock,
    SectionBlocks,
    TableBlock,
    shown,
)
from centrode.render.document.numbers import Numbers
from centrode.report.study import ReportStudy

if TYPE_CHECKING:
    pass


def sphere_data_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """Everything the description gives of the geometry and the drives; arcs are angles."""
    if not study.is_spherical:
        return None
    mechanism, numbers = study.mechanism, study.numbers
    text = _(
        "Everything moves on a sphere about its centre, where all axes meet. Lengths are arcs; the angle of a link is"
        " measured at its first point from its reference arc, counter-clockwise seen from outside."
    )
    blocks: list[Block] = [ParagraphBlock(text), _points(mechanism, numbers), *_links(mechanism, numbers)]
    blocks += [*_guides(mechanism, numbers), *_gears(mechanism, numbers), _drives(mechanism, numbers)]
    return ChapterBlocks("data", _("Data"), (SectionBlocks("", tuple(blocks)),))


def _points(mechanism: Mechanism, numbers: Numbers) -> TableBlock:
    """Places of the frame, as directions and by longitude and latitude."""
    names = list(mechanism.frame.points)
    places = [_angles(mechanism.frame.points[name]) for name in names]
    vectors = [(cos(b) * cos(a), cos(b) * sin(a), sin(b)) for a, b in places]
    columns = [tuple(map(shown, names))]
    columns += [numbers.column([vector[k] for vector in vectors], "1", 1e-15) for k in range(3)]
    columns += [numbers.column([place[k] for place in places], "rad", 1e-15) for k in range(2)]
    head = (
        _("point"), "$x$", "$y$", "$z$", numbers.head(_("longitude"), "rad"), numbers.head(_("latitude"), "rad")
    )  # fmt: skip
    rows = tuple(zip(*columns, strict=True))
    return TableBlock(head, rows, _("Points of the frame"), (False, *(True,) * 5))


def _angles(place: object) -> tuple[float, float]:
    assert isinstance(place, tuple)
    return float(place[0]), float(place[1])


def _links(mechanism: Mechanism, numbers: Numbers) -> Iterator[TableBlock]:
    rows, bodies = [], []
    for number, (name, link) in enumerate(mechanism.links.items(), start=1):
        arc = "" if link.length is None else _angle(numbers, link.length)
        reference = "" if link.reference is None else shown("–".join(link.reference))
        angle = "" if link.angle is None else _angle(numbers, link.angle)
        points = shown(", ".join(link.coordinates))
        rows.append((str(number), shown(name), points, arc, reference, angle))
        bodies += _body(name, link, numbers)
    head = (
        _("number"), _("link"), _("points"), numbers.head(_("arc"), "rad"), _("angle is from arc"),
        numbers.head(_("initial angle"), "rad"),
    )  # fmt: skip
    yield TableBlock(head, tuple(rows), _("Moving links"), (True, False, False, True, False, True))
    if bodies:
        own = (
            _("link"), _("point"), numbers.head(_("longitude"), "rad"), numbers.head(_("latitude"), "rad")
        )  # fmt: skip
        yield TableBlock(
            own, tuple(bodies), _("Points of rigid links, in the links' own axes"), (False, False, True, True)
        )


def _body(name: str, link: Link, numbers: Numbers) -> list[tuple[str, ...]]:
    """Points of a link that is no plain arc."""
    if link.length is not None:
        return []
    return [
        (shown(name), shown(point), *(_angle(numbers, x) for x in _angles(place)))
        for point, place in link.coordinates.items()
    ]


def _angle(numbers: Numbers, value: float) -> str:
    return numbers.plain(value * numbers.shown("rad")[0] + 0.0)


def _guides(mechanism: Mechanism, numbers: Numbers) -> Iterator[TableBlock]:
    if mechanism.guides:
        head = (_("guide"), _("point"), _("on"), _("pole"), numbers.head(_("radius"), "rad"))
        rows = tuple(
            (
                shown(guide.id),
                shown(guide.point),
                _("frame") if guide.on == FRAME else shown(guide.on),
                shown(str(guide.pole)),
                _angle(numbers, pi / 2 if guide.radius is None else guide.radius),
            )
            for guide in mechanism.guides
        )
        yield TableBlock(
            head, rows, _("Circles on which points are kept"), (False, False, False, False, True)
        )


def _gears(mechanism: Mechanism, numbers: Numbers) -> Iterator[TableBlock]:
    if mechanism.gears:
        head = (_("gear"), _("links"), _("carrier"), _("ratio"))
        rows = tuple(
            (
                shown(gear.id),
                ", ".join(map(shown, gear.links)),
                _("frame") if gear.carrier == FRAME else shown(gear.carrier),
                numbers.plain(gear.ratio),
            )
            for gear in mechanism.gears
        )
        yield TableBlock(head, rows, _("Bevel gears"), (False, False, False, True))


def _drives(mechanism: Mechanism, numbers: Numbers) -> TableBlock:
    head = (_("drive"), _("what is given"), _("initial value"), _("law"))
    rows = tuple(
        (
            shown(drive.id),
            _given(drive),
            "" if drive.start is None else numbers.measured(drive.start, "rad"),
            _law(drive, numbers),
        )
        for drive in mechanism.drives
    )
    return TableBlock(head, rows, _("Drives"), (False, False, True, False))


def _given(drive: Drive) -> str:
    if drive.link is None:
        return _("displacement along guide {guide}").format(guide=shown(str(drive.guide)))
    if drive.relative_to == FRAME:
        return _("angle of link {link}").format(link=shown(drive.link))
    return _("angle of link {link} against link {other}").format(
        link=shown(drive.link), other=shown(drive.relative_to)
    )


def _law(drive: Drive, numbers: Numbers) -> str:
    if drive.speed is not None:
        return _("constant {rate}").format(rate=numbers.measured(drive.speed, "rad/s"))
    if drive.law is not None:
        return _("{formula}, in SI").format(formula=shown(drive.law))
    return _("table of {count} rows").format(count=len(drive.table or ()))
