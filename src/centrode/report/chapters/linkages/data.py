"""What is given: points of the frame, links, guides, wheels, drives."""

from __future__ import annotations

import math
from collections.abc import Iterator

from centrode.locale import _
from centrode.model.follower_cam import PlateCam
from centrode.model.mechanism import FRAME, Drive, Gear, Guide, Link, Mechanism, Placed, Rolling, Vector
from centrode.render.document.blocks import Block, ChapterBlocks, SectionBlocks, TableBlock, shown
from centrode.render.document.chapters import document_block
from centrode.render.document.numbers import Numbers
from centrode.report.study import ReportStudy
from centrode.views.follower_data import driving_cam


def data_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """Everything the description gives of the geometry and the drives, in the units of the display."""
    if not study.is_planar:
        return None
    made = _Data(study.mechanism, study.numbers)
    blocks: list[Block] = [*made.points(), *made.links(), *made.guides(), *made.wheels(), *made.drives()]
    return ChapterBlocks("data", _("Data"), (SectionBlocks("", tuple(blocks)),))


class _Data:
    """Tables of one description."""

    def __init__(self, mechanism: Mechanism, numbers: Numbers) -> None:
        self.mechanism = mechanism
        self.numbers = numbers

    def length(self, value: float) -> str:
        return self.numbers.plain(value * self.numbers.shown("m")[0] + 0.0)

    def angle(self, value: float) -> str:
        return self.numbers.plain(value * self.numbers.shown("rad")[0] + 0.0)

    def head(self, text: str, unit: str) -> str:
        return self.numbers.head(text, unit)

    def points(self) -> Iterator[TableBlock]:
        """Points of the frame."""
        rows = []
        for name in self.mechanism.frame.points:
            x, y = _resolve(self.mechanism.frame.points[name])
            rows.append((shown(name), self.length(x), self.length(y)))
        if rows:
            head = (_("point"), self.head("$x$", "m"), self.head("$y$", "m"))
            yield TableBlock(head, tuple(rows), _("Points of the frame"), (False, True, True))

    def links(self) -> Iterator[TableBlock]:
        """Moving links with their points; those of more points with coordinates in the link's own axes."""
        rows, local = [], []
        for number, (name, link) in enumerate(self.mechanism.links.items(), start=1):
            points = list(link.coordinates)
            length = "" if len(points) != 2 else self.length(_apart(link))
            angle = self.mechanism.initial_angle(name)
            rows.append(
                (
                    str(number),
                    shown(name),
                    shown(", ".join(points)),
                    length,
                    "" if angle is None else self.angle(float(angle)),
                )
            )
            if len(points) > 2:
                local += [
                    (shown(name), shown(point), self.length(float(x)), self.length(float(y)))
                    for point, (x, y) in link.coordinates.items()
                ]
        head = (
            _("number"), _("link"), _("points"), self.head(_("length"), "m"), self.head(_("initial angle"), "rad")
        )  # fmt: skip
        yield TableBlock(head, tuple(rows), _("Moving links"), (True, False, False, True, True))
        if local:
            own = (_("link"), _("point"), self.head("$xi$", "m"), self.head("$eta$", "m"))
            caption = _("Points of rigid links, in the links' own axes")
            yield TableBlock(own, tuple(local), caption, (False, False, True, True))

    def guides(self) -> Iterator[TableBlock]:
        """Lines on which points are kept."""
        if self.mechanism.guides:
            head = (
                _("guide"), _("point"), _("on"), self.head(_("through $(x; y)$"), "m"),
                self.head(_("direction"), "rad"), _("link that does not turn against it"),
            )  # fmt: skip
            rows = tuple(self._guide(guide) for guide in self.mechanism.guides)
            yield TableBlock(head, rows, _("Guides"), (False, False, False, True, True, False))

    def _guide(self, guide: Guide) -> tuple[str, ...]:
        through = guide.through
        if isinstance(through, str):
            place = shown(through)
        else:
            x, y = _resolve(through)
            place = f"({self.length(x)}; {self.length(y)})"
        on = _("frame") if guide.on == FRAME else shown(guide.on)
        own = "" if guide.link is None else shown(guide.link)
        return (
            shown(guide.id),
            shown(guide.point),
            on,
            place,
            self.angle(guide.direction_angle),
            own,
        )

    def wheels(self) -> Iterator[TableBlock]:
        """Gears and rolling wheels."""
        if self.mechanism.gears:
            head = (_("gear"), _("links"), _("carrier"), _("ratio"))
            yield TableBlock(
                head,
                tuple(self._gear(gear) for gear in self.mechanism.gears),
                _("Gears"),
                (False,) * 3 + (True,),
            )
        if self.mechanism.rolling:
            own = (_("wheel"), _("rolls on"), self.head(_("radius"), "m"))
            rows = tuple(self._rolling(wheel) for wheel in self.mechanism.rolling)
            yield TableBlock(own, rows, _("Rolling wheels"), (False, False, True))

    def _gear(self, gear: Gear) -> tuple[str, ...]:
        links = ", ".join(_("frame") if link == FRAME else shown(link) for link in gear.links)
        carrier = _("frame") if gear.carrier == FRAME else shown(gear.carrier)
        return shown(gear.id), links, carrier, self.numbers.plain(gear.ratio)

    def _rolling(self, wheel: Rolling) -> tuple[str, ...]:
        on = _("frame") if wheel.on == FRAME else shown(wheel.on)
        return shown(wheel.id), on, self.length(float(wheel.radius))

    def drives(self) -> Iterator[Block]:
        """What is given of the motion."""
        head = (_("drive"), _("what is given"), _("initial value"), _("law"))
        rows = tuple(self._drive(drive) for drive in self.mechanism.drives)
        if rows:
            yield TableBlock(head, rows, _("Drives"), (False, False, True, False))
        for drive in self.mechanism.drives:
            if drive.cam is not None:
                yield from self._cam(drive, drive.cam)

    def _cam(self, drive: Drive, cam: PlateCam) -> Iterator[Block]:
        """A cam that drives, with its follower's motion."""
        for block in driving_cam(drive, cam):
            yield document_block(block, self.numbers)

    def _drive(self, drive: Drive) -> tuple[str, ...]:
        coordinate = self.mechanism.motion_parameter.drive(drive.id)
        start = "" if drive.start is None else self.numbers.measured(drive.start, coordinate.unit)
        return shown(drive.id), _given(drive), start, self._law(drive, coordinate.speed_unit)

    def _law(self, drive: Drive, speed_unit: str) -> str:
        if drive.speed is not None:
            rate = self.numbers.measured(drive.speed, speed_unit)
            return _("constant {rate}").format(rate=rate)
        if drive.cam is not None:
            return _("lift of a cam")
        if drive.law is not None:
            return _("{formula}, in SI").format(formula=shown(drive.law))
        if drive.table is not None:
            return _("table of {count} rows").format(count=len(drive.table))
        if drive.segments is None:
            return _("by a cam")
        return _("{count} segments of motion").format(count=len(drive.segments or ()))


def _given(drive: Drive) -> str:
    if drive.link is not None:
        if drive.relative_to == FRAME:
            return _("angle of link {link}").format(link=shown(drive.link))
        return _("angle of link {link} against link {other}").format(
            link=shown(drive.link), other=shown(drive.relative_to)
        )
    if drive.guide is not None:
        return _("displacement along guide {guide}").format(guide=shown(drive.guide))
    first, second = (shown(name) for name in drive.distance or ("", ""))
    return _("distance of {first} and {second}").format(first=first, second=second)


def _resolve(place: Vector | Placed | None) -> tuple[float, float]:
    """Coordinates of a place, of one that the chain places those that it got."""
    at = place.at if isinstance(place, Placed) else place
    x, y = at or (0.0, 0.0)
    return float(x), float(y)


def _apart(link: Link) -> float:
    """Distance of the two points of a link."""
    if link.length is not None:
        return float(link.length)
    (ax, ay), (bx, by) = link.coordinates.values()
    return math.hypot(bx - ax, by - ay)
