"""The motion as tables: the instants one by one, then evenly spaced rows as the assignment prints them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import STATUSES_OF_MOTION
from centrode.locale import _, ngettext
from centrode.quantities import status_word
from centrode.render.document.blocks import Block, Chapter, Check, Paragraph, Section, Table, shown
from centrode.render.document.numbers import NOTHING
from centrode.render.document.rows import rows_table, sentence, small
from centrode.report.chapters.linkages.analogs import coefficient_tables
from centrode.report.chapters.linkages.identities import identity_checks
from centrode.report.chapters.linkages.long_tables import chosen_rows, known, long_tables
from centrode.report.moments import Moment, moments_of
from centrode.report.study import ReportStudy

ROWS = 37
"""Rows of a table over the whole motion: every ten degrees of a turn."""
WIDE = 9
"""Columns of a table that still fit across a page."""
CLOSED = 1e-9
"""Residual over the greatest length below which a sample is closed."""
Array = npt.NDArray[np.float64]


def tables_chapter(study: ReportStudy) -> Chapter | None:
    """Statuses and limits, tables of the instants, tables over the motion, checks."""
    if not study.is_planar:
        return None
    sections = [Section(_("Range"), tuple(_range(study)))]
    sections += [Section(moment.title, tuple(_instant(study, moment))) for moment in moments_of(study)]
    sections.append(Section(_("The whole motion"), tuple(long_tables(study))))
    sections.append(Section(_("Checks"), tuple(_checks(study))))
    return Chapter("tables", _("Tables of the motion"), tuple(sections))


def _range(study: ReportStudy) -> Iterator[Block]:
    """From where to where, what is reached, where the mechanism stops."""
    words, status = study.study.words, study.motion["status"].to_numpy()
    counts = [(each, int((status == each).sum())) for each in STATUSES_OF_MOTION]
    said = ", ".join(f"{status_word(each)} {count}" for each, count in counts if count)
    rows = (
        (_("range"), words.range()),
        (_("limits"), words.events("limit")),
        (_("change points"), words.events("change point")),
        (_("samples"), f"{len(status)}: {said}"),
    )
    yield rows_table(rows, study.numbers, _("Range of the motion"))
    if study.study.failure is not None:
        yield Paragraph(sentence(study.study.failure, study.numbers))
    for note in study.study.notes:
        yield Paragraph(sentence(note, study.numbers))


def _instant(study: ReportStudy, moment: Moment) -> Iterator[Block]:
    """Links and points at one instant, and their kinematic coefficients."""
    if not moment.reached:
        yield Paragraph(moment.missing)
        return
    data = moment.data.isel(sample=moment.sample)
    mechanism, numbers = study.mechanism, study.numbers
    letters = (
        ("angle", "phi", "rad"),
        ("angular_velocity", "omega", "rad/s"),
        ("angular_acceleration", "epsilon", "rad/s^2"),
    )
    head = [numbers.head(f"${letter}$", unit) for _name, letter, unit in letters]
    columns = [numbers.column(known(data[name]), unit) for name, _letter, unit in letters]
    names = [shown(name) for name in mechanism.link_names]
    numbered = [str(k) for k in range(1, len(names) + 1)]
    yield Table(
        (_("number"), _("link"), *head),
        tuple(zip(numbered, names, *columns, strict=True)),
        _("Links: angle, angular velocity, angular acceleration"),
        (True, False, True, True, True),
    )
    yield _points(study, data)
    if mechanism.guides:
        yield _guides(study, data)
    if "velocity_coefficient" in data:
        yield from coefficient_tables(study, data)


def _points(study: ReportStudy, data: xr.Dataset) -> Table:
    numbers, names = study.numbers, list(study.mechanism.moving_points)
    own = data.sel(point=names)
    place, rate, second = (own[name].to_numpy() for name in ("position", "velocity", "acceleration"))
    columns = [numbers.column(place[:, k], "m") for k in (0, 1)]
    columns += [numbers.column(rate[:, k], "m/s") for k in (0, 1)]
    columns.append(numbers.column(np.hypot(*rate.T), "m/s"))
    columns += [numbers.column(second[:, k], "m/s^2") for k in (0, 1)]
    columns.append(numbers.column(np.hypot(*second.T), "m/s^2"))
    letters = [
        *(("x", "m"), ("y", "m")),
        *(("v_x", "m/s"), ("v_y", "m/s"), ("v", "m/s")),
        *(("a_x", "m/s^2"), ("a_y", "m/s^2"), ("a", "m/s^2")),
    ]
    head = tuple(numbers.head(f"${letter}$", unit) for letter, unit in letters)
    rows = tuple(zip([shown(name) for name in names], *columns, strict=True))
    caption = _("Points: place, velocity and acceleration by components and size")
    return Table((_("point"), *head), rows, caption, (False, *(True,) * 8))


def _guides(study: ReportStudy, data: xr.Dataset) -> Table:
    numbers = study.numbers
    units = ("m", "m/s", "m/s^2")
    names = ("slide", "slide_velocity", "slide_acceleration")
    columns = [numbers.column(known(data[name]), unit) for name, unit in zip(names, units, strict=True)]
    head = tuple(
        numbers.head(f"${letter}$", unit)
        for letter, unit in zip(("s", "dot(s)", "dot.double(s)"), units, strict=True)
    )
    rows = tuple(zip([shown(guide.id) for guide in study.mechanism.guides], *columns, strict=True))
    return Table((_("guide"), *head), rows, _("Displacements along the guides"), (False, True, True, True))


def _checks(study: ReportStudy) -> Iterator[Block]:
    """Residuals, identities of rigid bodies, return after a full turn."""
    data, words = study.motion, study.study.words
    residual = float(data.attrs["worst_residual"])
    text = _(
        "All constraints hold at every sample that is reached; the worst residual is {value} "
        "of the greatest length ({constraint})."
    )
    yield Check(
        text.format(value=small(residual), constraint=shown(words.solved.worst_constraint.label)),
        residual <= CLOSED,
    )
    yield from identity_checks(study)
    status = data["status"].to_numpy()
    rows = chosen_rows(study)
    yield Paragraph(
        ngettext(
            "The tables show {rows} row of {samples} samples; {sign} stands where nothing is known.",
            "The tables show {rows} rows of {samples} samples; {sign} stands where nothing is known.",
            len(rows),
        ).format(rows=len(rows), samples=len(status), sign=NOTHING)
    )
