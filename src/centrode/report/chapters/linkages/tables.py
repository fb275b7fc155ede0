"""The motion as tables: the instants one by one, then evenly spaced rows as the assignment prints them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import STATUSES_OF_MOTION, Status
from centrode.locale import _, ngettext
from centrode.quantities import QUANTITIES, status_word
from centrode.report.blocks import Block, Chapter, Check, Paragraph, Section, Table, shown
from centrode.report.chapters.linkages.identities import identity_checks
from centrode.report.moments import Moment, moments_of
from centrode.report.numbers import NOTHING, respelled
from centrode.report.rows import told
from centrode.report.study import ReportStudy
from centrode.report.vectors import symbol

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
    sections.append(Section(_("The whole motion"), tuple(_whole(study))))
    sections.append(Section(_("Checks"), tuple(_checks(study))))
    return Chapter("tables", _("Tables of the motion"), tuple(sections))


def _range(study: ReportStudy) -> Iterator[Block]:
    """From where to where, what is reached, where the mechanism stops."""
    words, status = study.study.words, study.motion["status"].to_numpy()
    counts = [(each, int((status == each).sum())) for each in STATUSES_OF_MOTION]
    yield Table(
        (_("what"), _("value")),
        (
            (_("range"), told(words.range())),
            (_("limits"), told(words.events("limit"))),
            (_("change points"), told(words.events("change point"))),
            (_("samples"), ", ".join(f"{status_word(each)} {count}" for each, count in counts if count)),
        ),
        _("Range of the motion"),
    )
    if study.study.failure is not None:
        yield Paragraph(told(study.study.failure[:1].upper() + study.study.failure[1:] + "."))
    for note in study.study.notes:
        yield Paragraph(told(note[:1].upper() + note[1:] + "."))


def _instant(study: ReportStudy, moment: Moment) -> Iterator[Block]:
    """Links and points at one instant, and their kinematic coefficients."""
    if not moment.reached:
        yield Paragraph(moment.missing)
        return
    data = moment.data.isel(sample=moment.sample)
    mechanism, numbers = study.mechanism, study.numbers
    heads = [(_("angle"), "phi", "rad"), (_("angular velocity"), "omega", "rad/s"), (_("angular acceleration"), "epsilon", "rad/s^2")]
    head = tuple(numbers.head(f"${letter}$", unit) for _word, letter, unit in heads)
    columns = [
        numbers.column(_known(data[name]), unit)
        for name, (_word, _letter, unit) in zip(("angle", "angular_velocity", "angular_acceleration"), heads, strict=True)
    ]
    names = [shown(name) for name in mechanism.link_names]
    numbered = [str(k) for k in range(1, len(names) + 1)]
    yield Table(
        (_("number"), _("link"), *head), tuple(zip(numbered, names, *columns, strict=True)),
        _("Links: angle $phi$, angular velocity $omega$, angular acceleration $epsilon$").replace("$", ""),
        (True, False, True, True, True),
    )  # fmt: skip
    yield _points(study, data)
    if mechanism.guides:
        yield _guides(study, data)
    if "velocity_coefficient" in data:
        yield _coefficients(study, data)


def _points(study: ReportStudy, data: xr.Dataset) -> Table:
    numbers, names = study.numbers, list(study.mechanism.moving_points)
    own = data.sel(point=names)
    place, rate, second = (own[name].to_numpy() for name in ("position", "velocity", "acceleration"))
    columns = [numbers.column(place[:, k], "m") for k in (0, 1)]
    columns += [numbers.column(rate[:, k], "m/s") for k in (0, 1)]
    columns.append(numbers.column(np.hypot(*rate.T), "m/s"))
    columns += [numbers.column(second[:, k], "m/s^2") for k in (0, 1)]
    columns.append(numbers.column(np.hypot(*second.T), "m/s^2"))
    letters = (("x", "m"), ("y", "m"), ("v_x", "m/s"), ("v_y", "m/s"), ("v", "m/s"))
    letters += (("a_x", "m/s^2"), ("a_y", "m/s^2"), ("a", "m/s^2"))
    head = tuple(numbers.head(f"${letter}$", unit) for letter, unit in letters)
    rows = tuple(zip([shown(name) for name in names], *columns, strict=True))
    caption = _("Points: place, velocity and acceleration by components and size")
    return Table((_("point"), *head), rows, caption, (False, *(True,) * 8))


def _guides(study: ReportStudy, data: xr.Dataset) -> Table:
    numbers = study.numbers
    units = ("m", "m/s", "m/s^2")
    names = ("slide", "slide_velocity", "slide_acceleration")
    columns = [numbers.column(_known(data[name]), unit) for name, unit in zip(names, units, strict=True)]
    head = tuple(numbers.head(f"${letter}$", unit) for letter, unit in zip(("s", "dot(s)", "dot.double(s)"), units, strict=True))
    rows = tuple(zip([shown(guide.id) for guide in study.mechanism.guides], *columns, strict=True))
    return Table((_("guide"), *head), rows, _("Displacements along the guides"), (False, True, True, True))


def _coefficients(study: ReportStudy, data: xr.Dataset) -> Table:
    """Derivatives by the drive's value: the analogs of velocity and acceleration."""
    numbers = study.numbers
    unit = "rad" if study.mechanism.drives[0].kind == "angle" else "m"
    rows: list[tuple[str, ...]] = []
    for name in study.mechanism.link_names:
        one = data.sel(link=name)
        values = [one[f"angular_{word}_coefficient"] for word in ("velocity", "acceleration")]
        rows.append((f"${symbol('φ', name)}$", *(_analog(study, v) for v in values)))
    for name in study.mechanism.moving_points:
        for axis in ("x", "y"):
            one = data.sel(point=name, axis=axis)
            values = [one[f"{word}_coefficient"] for word in ("velocity", "acceleration")]
            rows.append((f"${symbol(axis, name)}$", *(_analog(study, v) for v in values)))
    _factor, length = numbers.shown("m")
    units = (f"1, {length}/{unit}", f"1/{unit}, {length}/{unit}²") if unit == "rad" else (f"rad/m, {length}/m", f"rad/m², {length}/m²")
    head = (_("quantity"), _("first, {unit}").format(unit=units[0]), _("second, {unit}").format(unit=units[1]))
    caption = _("Kinematic coefficients: derivatives by the value of the drive (analogs of velocity and acceleration)")
    return Table(head, tuple(rows), caption, (False, True, True))


def _analog(study: ReportStudy, value: xr.DataArray) -> str:
    unit = str(value.attrs["units"])
    return study.numbers.plain(float(value) * study.numbers.shown(unit)[0])


def _known(values: xr.DataArray) -> Array:
    return np.asarray(values.to_numpy(), dtype=np.float64)


def chosen_rows(study: ReportStudy) -> list[int]:
    """Samples of the table, evenly spread over the motion, both ends included."""
    count = int(study.motion.sizes["sample"])
    if count <= ROWS:
        return list(range(count))
    step = next((k for k in range(-(-(count - 1) // (ROWS - 1)), count) if (count - 1) % k == 0), 1)
    if (count - 1) // step < ROWS // 3:
        return np.unique(np.linspace(0, count - 1, ROWS).astype(int)).tolist()
    return list(range(0, count, step))


def _whole(study: ReportStudy) -> Iterator[Block]:
    """Angles and rates of the links, then places and velocities of the points that are asked for."""
    samples = chosen_rows(study)
    data = study.motion.isel(sample=samples)
    mechanism, numbers = study.mechanism, study.numbers
    front = _front(study, data)
    for variables, caption in (
        (("angle", "angular_velocity"), _("Angles and angular velocities of the links")),
        (("angular_acceleration",), _("Angular accelerations of the links")),
    ):
        columns = [
            (numbers.head(f"${symbol(_letter(name), str(k))}$", _unit(name)), numbers.column(_known(data[name].sel(link=link)), _unit(name)))
            for name in variables
            for k, link in enumerate(mechanism.link_names, start=1)
        ]
        yield from _parted(front, columns, caption, len(mechanism.link_names))
    columns = []
    for point in study.points:
        for name in ("position", "velocity", "acceleration"):
            unit = _unit(name)
            for axis in ("x", "y"):
                letter = {"position": axis, "velocity": f"v_{axis}", "acceleration": f"a_{axis}"}[name]
                values = numbers.column(_known(data[name].sel(point=point, axis=axis)), unit)
                columns.append((numbers.head(f"${_of_point(letter, point)}$", unit), values))
    yield from _parted(front, columns, _("Places, velocities and accelerations of points"), 6)


def _of_point(letter: str, point: str) -> str:
    base, _under, axis = letter.partition("_")
    return symbol(base, f"{point} {axis}".rstrip() if axis else point)


def _letter(name: str) -> str:
    return {"angle": "φ", "angular_velocity": "ω", "angular_acceleration": "ε"}[name]


def _unit(name: str) -> str:
    return QUANTITIES[name].unit


Column = tuple[str, tuple[str, ...]]


def _front(study: ReportStudy, data: xr.Dataset) -> list[Column]:
    """Time or the drive's value, and the status where not all samples are reached."""
    numbers = study.numbers
    found: list[Column] = [(numbers.head("$t$", "s"), numbers.column(_known(data["time"]), "s"))]
    for k, drive in enumerate(study.mechanism.drives):
        unit = "rad" if drive.kind == "angle" else "m"
        driven = drive.kind == "angle" and drive.relative_to == "frame"
        if driven and len(study.mechanism.drives) == 1 and unit == "rad" and drive.link is not None:
            continue  # its angle stands among those of the links
        found.append((numbers.head(shown(drive.id), unit), numbers.column(_known(data["drive_value"])[:, k], unit)))
    status = data["status"].to_numpy()
    if (status != Status.OK).any():
        found.append((_("status"), tuple(status_word(int(each)) for each in status)))
    return found


def _parted(front: Sequence[Column], columns: Sequence[Column], caption: str, together: int) -> Iterator[Table]:
    """Columns in as many tables as a page is wide for, each with the front; what belongs together is not parted."""
    room = max(1, WIDE - len(front))
    step = room if together > room else room - room % together
    for first in range(0, len(columns), step):
        part = [*front, *columns[first : first + step]]
        rows = tuple(zip(*(values for _head, values in part), strict=True))
        words = [head == _("status") for head, _values in part]
        more = _("{caption} (continued)").format(caption=caption) if first else caption
        yield Table(tuple(head for head, _values in part), rows, more, tuple(not word for word in words))


def _checks(study: ReportStudy) -> Iterator[Block]:
    """Residuals, identities of rigid bodies, return after a full turn."""
    data, words = study.motion, study.study.words
    residual = float(data.attrs["worst_residual"])
    text = _("All constraints hold at every sample; the worst residual is {value} of the greatest length ({constraint}).")
    yield Check(
        text.format(value=respelled(f"{residual:.1e}"), constraint=shown(words.solved.worst_constraint.label)),
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


