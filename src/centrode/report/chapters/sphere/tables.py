"""Tables of a motion on the sphere: the instants, the whole motion, and what every sample has to keep."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.errors import Status
from centrode.locale import _
from centrode.render.document.blocks import Block, Chapter, Check, Paragraph, Section, Table, shown
from centrode.report.chapters.forces.places import head_of_places, places_of, unit_of_place
from centrode.report.chapters.forces.tables import Column, over_samples
from centrode.report.moments import Moment, moments_of
from centrode.report.telling import facts, measured
from centrode.study.summary import motion_rows
from centrode.views.columns import rows_shown

if TYPE_CHECKING:
    import xarray as xr

    from centrode.report.study import ReportStudy

ROWS = 37
ROUNDED = 1 << 20
"""Roundings of rates that are left near a limit, or where a motion is interpolated about a change point."""
VECTORS = (("position", "r"), ("velocity", "v"), ("acceleration", "a"))


def sphere_tables_chapter(study: ReportStudy) -> Chapter | None:
    """Range and statuses, tables of the instants, a table over the motion, checks."""
    if not study.is_spherical:
        return None
    first: list[Block] = [facts(study.numbers, motion_rows(study.study))]
    if study.study.failure is not None:
        first.append(Paragraph(shown(f"{study.study.failure}.")))
    sections = [Section(_("Range"), tuple(first))]
    sections += [Section(moment.title, tuple(_instant(study, moment))) for moment in moments_of(study)]
    sections.append(Section(_("The whole motion"), (_course(study),)))
    sections.append(Section(_("Checks"), tuple(_checks(study))))
    return Chapter("tables", _("Tables of the motion"), tuple(sections))


def _instant(study: ReportStudy, moment: Moment) -> Iterator[Block]:
    if not moment.reached:
        yield Paragraph(moment.missing)
        return
    here = moment.data.isel(sample=moment.sample)
    yield from _joints(study, here)
    yield _links(study, here)
    yield _points(study, here)


def _joints(study: ReportStudy, here: xr.Dataset) -> Iterator[Table]:
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
        yield Table((head, *heads), rows, caption, (False, True, True, True))


def _links(study: ReportStudy, here: xr.Dataset) -> Table:
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
    return Table(tuple(heads), rows, caption, (False, *(True,) * 8))


def _points(study: ReportStudy, here: xr.Dataset) -> Table:
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
    return Table(tuple(heads), rows, caption, (False, *(True,) * 9))


def _course(study: ReportStudy) -> Table:
    """Angles in the hinges and ways along circles with their rates, at even steps."""
    data = study.motion
    columns = [Column(head_of_places(study), unit_of_place(study), places_of(study, data))]
    for dimension, value, rate, letter in (
        ("joint", "joint_angle", "joint_velocity", "psi"),
        ("guide", "slide", "slide_velocity", "s"),
    ):
        for name in data[dimension].to_numpy().tolist()[:4]:
            one = data.sel({dimension: name})
            below = f'_("{name}")'.replace("$", r"\$")
            columns.append(Column(f"${letter}{below}$", "rad", one[value].to_numpy()))
            columns.append(Column(f"$dot({letter}){below}$", "rad/s", one[rate].to_numpy()))
    return over_samples(
        study.numbers, columns, rows_shown(data.sizes["sample"], ROWS), _("The motion at even steps")
    )


def _checks(study: ReportStudy) -> list[Check]:
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
        measured(arcs, stretch, 1.0, 64.0 * eps * data.sizes["link"]),
        measured(turns, slip, size, ROUNDED * eps),
    ]
