"""What is given of a linkage on the sphere: places of the frame, links, circles, gears, drives."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from centrode.errors import Status
from centrode.locale import _, mark
from centrode.model.mechanism import FRAME, Drive, Link, Mechanism
from centrode.present.figures import motion_figures
from centrode.render.document.blocks import (
    Block,
    ChapterBlocks,
    CheckBlock,
    ParagraphBlock,
    SectionBlocks,
    TableBlock,
    shown,
)
from centrode.render.document.figures import picture
from centrode.render.document.numbers import Numbers
from centrode.report.chapters.forces.places import head_of_places, places_of, unit_of_place
from centrode.report.chapters.forces.tables import ForceColumn, over_samples
from centrode.report.study import Moment, ReportStudy, moments_of
from centrode.report.texts import difference_check, facts
from centrode.study.summary import motion_rows
from centrode.views.columns import rows_shown

if TYPE_CHECKING:
    import xarray as xr


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


# Figures of a motion on the sphere.

CAPTIONS = {
    "mechanism": mark("The mechanism from outside; dashed what is behind"),
    "paths": mark("Paths of the points"),
    "joint-angles": mark("Angles of the links in their hinges"),
    "joint-velocities": mark("Angular velocities in the hinges"),
    "joint-accelerations": mark("Angular accelerations in the hinges"),
    "angular-velocities": mark("Angular velocities of the links"),
    "angular-accelerations": mark("Angular accelerations of the links"),
    "velocities": mark("Velocities of the points"),
    "accelerations": mark("Accelerations of the points"),
    "slides": mark("Motion along the circles"),
    "kinematic-coefficients": mark("Kinematic coefficients"),
}


def sphere_plots_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """The figures that `centrode run` draws."""
    if not study.is_spherical:
        return None
    figures = motion_figures(study.mechanism, study.motion, study.wishes.instants)
    blocks = tuple(picture(figure, _(CAPTIONS[name])) for name, figure in figures.items())
    return ChapterBlocks("plots", _("Plots of the motion"), (SectionBlocks("", blocks),))


# Equations of a linkage on the sphere, as `centrode equations` prints them.


# Tables of a motion on the sphere: the instants, the whole motion, and what every sample has to keep.

ROWS = 37
ROUNDED = 1 << 20
"""Roundings of rates that are left near a limit, or where a motion is interpolated about a change point."""
VECTORS = (("position", "r"), ("velocity", "v"), ("acceleration", "a"))


def sphere_tables_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """Range and statuses, tables of the instants, a table over the motion, checks."""
    if not study.is_spherical:
        return None
    first: list[Block] = [facts(study.numbers, motion_rows(study.study))]
    if study.study.failure is not None:
        first.append(ParagraphBlock(shown(f"{study.study.failure}.")))
    sections = [SectionBlocks(_("Range"), tuple(first))]
    sections += [SectionBlocks(moment.title, tuple(_instant(study, moment))) for moment in moments_of(study)]
    sections.append(SectionBlocks(_("The whole motion"), (_course(study),)))
    sections.append(SectionBlocks(_("Checks"), tuple(_checks(study))))
    return ChapterBlocks("tables", _("Tables of the motion"), tuple(sections))


def _instant(study: ReportStudy, moment: Moment) -> Iterator[Block]:
    if not moment.reached:
        yield ParagraphBlock(moment.missing)
        return
    here = moment.data.isel(sample=moment.sample)
    yield from _joints(study, here)
    yield _link_tables(study, here)
    yield _point_tables(study, here)


def _joints(study: ReportStudy, here: xr.Dataset) -> Iterator[TableBlock]:
    """Angles of the links in their hinges and ways along circles, with rates."""
    numbers = study.numbers
    groups = (
        ("joint", _("link"), _("Angles of the links, from their reference arcs"), "psi"),
        ("guide", _("guide"), _("Ways along the circles"), "s"),
    )
    for dimension, head, caption, letter in groups:
        names = here[dimension].to_numpy().tolist()
        if not names:
            continue
        variables = ("joint_angle", "joint_velocity", "joint_acceleration")
        if dimension == "guide":
            variables = ("slide", "slide_velocity", "slide_acceleration")
        units = ("rad", "rad/s", "rad/s^2")
        letters = (letter, f"dot({letter})", f"dot.double({letter})")
        heads = [numbers.head(f"${one}$", unit) for one, unit in zip(letters, units, strict=True)]
        columns = [
            numbers.column(here[name].to_numpy(), unit, 1e-14)
            for name, unit in zip(variables, units, strict=True)
        ]
        rows = tuple(zip(map(shown, names), *columns, strict=True))
        yield TableBlock((head, *heads), rows, caption, (False, True, True, True))


def _link_tables(study: ReportStudy, here: xr.Dataset) -> TableBlock:
    """Angular velocities and accelerations as vectors in the axes of the frame."""
    numbers = study.numbers
    heads, columns = [_("link")], [tuple(map(shown, here["link"].to_numpy().tolist()))]
    for name, letter, unit in (
        ("angular_velocity", "omega", "rad/s"),
        ("angular_acceleration", "epsilon", "rad/s^2"),
    ):
        values = here[name].to_numpy()
        least = 1e-13 * float(np.nanmax(np.abs(values), initial=0.0))
        for k, axis in enumerate(here["axis"].to_numpy().tolist()):
            heads.append(numbers.head(f"${letter}_{axis}$", unit))
            columns.append(numbers.column(values[:, k], unit, least))
        heads.append(numbers.head(f"${letter}$", unit))
        columns.append(numbers.column(np.linalg.norm(values, axis=1), unit, least))
    rows = tuple(zip(*columns, strict=True))
    caption = _("Angular velocities and accelerations in the axes of the frame")
    return TableBlock(tuple(heads), rows, caption, (False, *(True,) * 8))


def _point_tables(study: ReportStudy, here: xr.Dataset) -> TableBlock:
    """Places, velocities and accelerations on the unit sphere."""
    numbers, names = study.numbers, list(study.mechanism.moving_points)
    own = here.sel(point=names)
    heads, columns = [_("point")], [tuple(map(shown, names))]
    for name, letter in VECTORS:
        values, unit = own[name].to_numpy(), str(own[name].attrs["units"])
        least = 1e-13 * float(np.nanmax(np.abs(values), initial=0.0))
        for k, axis in enumerate(here["axis"].to_numpy().tolist()):
            heads.append(numbers.head(f"${axis}$" if letter == "r" else f"${letter}_{axis}$", unit))
            columns.append(numbers.column(values[:, k], unit, least))
    rows = tuple(zip(*columns, strict=True))
    caption = _("Places, velocities and accelerations of the points on the unit sphere")
    return TableBlock(tuple(heads), rows, caption, (False, *(True,) * 9))


def _course(study: ReportStudy) -> TableBlock:
    """Angles in the hinges and ways along circles with their rates, at even steps."""
    data = study.motion
    columns = [ForceColumn(head_of_places(study), unit_of_place(study), places_of(study, data))]
    for dimension, value, rate, letter in (
        ("joint", "joint_angle", "joint_velocity", "psi"),
        ("guide", "slide", "slide_velocity", "s"),
    ):
        for name in data[dimension].to_numpy().tolist()[:4]:
            one = data.sel({dimension: name})
            below = f'_("{name}")'.replace("$", r"\$")
            columns.append(ForceColumn(f"${letter}{below}$", "rad", one[value].to_numpy()))
            columns.append(ForceColumn(f"$dot({letter}){below}$", "rad/s", one[rate].to_numpy()))
    return over_samples(
        study.numbers, columns, rows_shown(data.sizes["sample"], ROWS), _("The motion at even steps")
    )


def _checks(study: ReportStudy) -> list[CheckBlock]:
    """Closure, arcs that stay what they are, and v = omega x r; none of them is what the motion was found by."""
    data, eps = study.motion, float(np.finfo(float).eps)
    reached = data["status"].to_numpy() == Status.OK
    if not reached.any():
        return []
    place, rate = (data[name].to_numpy()[reached] for name in ("position", "velocity"))
    names = data["point"].to_numpy().tolist()
    turning = data["angular_velocity"].to_numpy()[reached]
    links = data["link"].to_numpy().tolist()
    stretch, slip = 0.0, 0.0
    for number, (link, body) in enumerate(study.mechanism.links.items()):
        points = [names.index(name) for name in body.coordinates]
        if body.length is not None and len(points) == 2:
            chord = np.linalg.norm(place[:, points[0]] - place[:, points[1]], axis=1)
            stretch = max(stretch, float(np.abs(chord - 2.0 * np.sin(body.length / 2.0)).max()))
        if link == links[number] and len(points) > 1:
            for point in points:
                slip = max(
                    slip, float(np.abs(rate[:, point] - np.cross(turning[:, number], place[:, point])).max())
                )
    arcs = _(
        "The arcs of all links stay what they are: their chords are off by {share} of the sphere's radius."
    )
    turns = _(
        "Every point of a link moves as its rotation wants, $arrow(v) = arrow(omega) times arrow(r)$, to {share}."
    )
    size = float(np.abs(rate).max())
    return [
        difference_check(arcs, stretch, 1.0, 64.0 * eps * data.sizes["link"]),
        difference_check(turns, slip, size, ROUNDED * eps),
    ]
