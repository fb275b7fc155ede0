"""The motion as tables: the instants one by one, then evenly spaced rows as the assignment prints them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import STATUSES_OF_MOTION, Status
from centrode.locale import _, ngettext
from centrode.model.mechanism import FRAME, Mechanism
from centrode.quantities import QUANTITIES, status_word
from centrode.render.document.blocks import (
    Block,
    ChapterBlocks,
    CheckBlock,
    ParagraphBlock,
    SectionBlocks,
    TableBlock,
    shown,
)
from centrode.render.document.numbers import NOTHING, Numbers
from centrode.render.document.rows import rows_table, sentence, small
from centrode.render.document.typst import word
from centrode.render.document.vectors import symbol
from centrode.report.study import Moment, ReportStudy, moments_of

# Kinematic coefficients of one instant: derivatives by the drive's value, the analogs of velocity and
# acceleration.


def coefficient_tables(study: ReportStudy, data: xr.Dataset) -> Iterator[TableBlock]:
    """One table of the links, one of the points; `data` is a sample of a motion with one drive."""
    yield _of_links(study, data)
    yield _of_points(study, data)


def _of_links(study: ReportStudy, data: xr.Dataset) -> TableBlock:
    heads, columns = [], []
    for order, kind in enumerate(("velocity", "acceleration"), start=1):
        values = data[f"angular_{kind}_coefficient"]
        unit = str(values.attrs["units"])
        columns.append(study.numbers.column(np.asarray(values), unit))
        heads.append(study.numbers.head(f"$phi{order * chr(39)}$", unit))
    names = [shown(name) for name in study.mechanism.link_names]
    caption = _("Kinematic coefficients of the links: derivatives of their angles by the value of the drive")
    return TableBlock(
        (_("link"), *heads), tuple(zip(names, *columns, strict=True)), caption, (False, True, True)
    )


def _of_points(study: ReportStudy, data: xr.Dataset) -> TableBlock:
    heads, columns = [], []
    points = list(study.mechanism.moving_points)
    for order, kind in enumerate(("velocity", "acceleration"), start=1):
        values = data[f"{kind}_coefficient"].sel(point=points)
        unit = str(values.attrs["units"])
        for axis in ("x", "y"):
            columns.append(study.numbers.column(np.asarray(values.sel(axis=axis)), unit))
            heads.append(study.numbers.head(f"${axis}{order * chr(39)}$", unit))
    names = [shown(name) for name in points]
    caption = _("Kinematic coefficients of the points: analogs of their velocities and accelerations")
    return TableBlock(
        (_("point"), *heads), tuple(zip(names, *columns, strict=True)), caption, (False, *(True,) * 4)
    )


# Checks of a motion by identities that it was not computed from: rigid bodies, differences, return after a
# turn.

Array = npt.NDArray[np.float64]
EPS = float(np.finfo(float).eps)
MENDED = (1e-10, 1e-8)
"""Errors of velocities and accelerations about change points, where motions are interpolated (docs: conventions)."""
ROUNDED = 1 << 20
"""Rounding of a rate is multiplied by this at a transmission angle of 0.06 deg: one over the square of its sine."""


def identity_checks(study: ReportStudy) -> Iterator[CheckBlock]:
    """Theorems on the velocities and accelerations of rigid bodies, over all samples that are reached."""
    data = study.motion
    reached = data["status"].to_numpy() == Status.OK
    if not reached.any():
        return
    data = data.isel(sample=np.flatnonzero(reached))
    mended = bool(study.motion["event_kind"].to_numpy().any())
    for order, text in (
        (
            1,
            _(
                "Euler's theorem: for all points of each link the velocity is that of another point and the rotation "
                "about it; the greatest difference is {off} of the greatest velocity, {allowed} is allowed."
            ),
        ),
        (
            2,
            _(
                "The same for accelerations, with their normal and tangential parts: the greatest difference is {off} "
                "of the greatest acceleration, {allowed} is allowed."
            ),
        ),
    ):
        worst = off_rigid(study.mechanism, data, order)
        if worst is None:
            continue
        allowed = ROUNDED * EPS + (MENDED[order - 1] if mended else 0.0)
        told = text.format(off=small(worst), allowed=small(allowed))
        yield CheckBlock(told, worst <= allowed)


def off_rigid(mechanism: Mechanism, data: xr.Dataset, order: int) -> float | None:
    """Greatest difference from the rotation about another point of the link, over the greatest rate.

    None where no link has two points, or nothing moves.
    """
    name = "velocity" if order == 1 else "acceleration"
    worst, size = 0.0, 0.0
    pairs = 0
    for link, described in mechanism.links.items():
        points = list(described.coordinates)
        turn, second = (
            data[f"angular_{word}"].sel(link=link).to_numpy()[:, None]
            for word in ("velocity", "acceleration")
        )
        for point in points[1:]:
            arm = _of(data, "position", point) - _of(data, "position", points[0])
            apart = _of(data, name, point) - _of(data, name, points[0])
            square = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
            rotation = turn * square if order == 1 else second * square - turn**2 * arm
            worst = max(worst, float(np.nanmax(np.abs(apart - rotation))))
            size = max(
                size, float(np.nanmax(np.abs(_of(data, name, point)))), float(np.nanmax(np.abs(rotation)))
            )
            pairs += 1
    return worst / size if pairs and size else None


def _of(data: xr.Dataset, name: str, point: str) -> Array:
    return np.asarray(data[name].sel(point=point).to_numpy(), dtype=np.float64)


# Tables over the whole motion, in evenly spaced rows, as assignments print them.

ROWS = 37
"""Rows of a table over the whole motion: every ten degrees of a turn."""
WIDE = 9
"""Columns of a table that still fit across a page."""
STILL = 1e-12
"""Part of the greatest number of its kind by which a number may change that stays the same."""


class MotionColumn(NamedTuple):
    """A head with its cells."""

    head: str
    cells: tuple[str, ...]
    is_number: bool = True


class Course(NamedTuple):
    """One quantity over the whole motion, and at the rows of the tables."""

    letter: str
    unit: str
    every: Array
    rows: Array


def known(values: xr.DataArray) -> Array:
    """The numbers of a variable."""
    return np.asarray(values.to_numpy(), dtype=np.float64)


def chosen_rows(study: ReportStudy) -> list[int]:
    """Samples of the table, evenly spread over the motion, both ends included."""
    count = int(study.motion.sizes["sample"])
    if count <= ROWS:
        return list(range(count))
    step = next((k for k in range(-(-(count - 1) // (ROWS - 1)), count) if (count - 1) % k == 0), 1)
    if (count - 1) // step < ROWS // 3:
        return [int(k) for k in np.unique(np.linspace(0, count - 1, ROWS).astype(int))]
    return list(range(0, count, step))


def long_tables(study: ReportStudy) -> Iterator[Block]:
    """Angles and rates of the links, then places and rates of the points that are asked for."""
    samples = chosen_rows(study)
    numbers, names = study.numbers, study.mechanism.link_names
    front = _front(study, study.motion.isel(sample=samples))
    groups = [
        [
            _course(study, symbol(letter, str(k)), name, samples, link=link)
            for k, link in enumerate(names, start=1)
        ]
        for name, letter in (("angle", "φ"), ("angular_velocity", "ω"), ("angular_acceleration", "ε"))
    ]
    numbered = ", ".join(f"{k} {shown(name)}" for k, name in enumerate(names, start=1))
    caption = _("Links: angles $phi$, angular velocities $omega$, angular accelerations $epsilon$ ({links})")
    yield from _tables(numbers, front, groups, caption.format(links=numbered))
    groups = []
    for point in study.points:
        groups.append([])
        for name, letter in (("position", ""), ("velocity", "v"), ("acceleration", "a")):
            for axis in ("x", "y"):
                head = f"{letter}_({word(point)} {axis})" if letter else symbol(axis, point)
                groups[-1].append(_course(study, head, name, samples, point=point, axis=axis))
    yield from _tables(numbers, front, groups, _("Points: places, velocities, accelerations"))


def _course(study: ReportStudy, letter: str, name: str, samples: list[int], **where: str) -> Course:
    every = known(study.motion[name].sel(where))
    return Course(letter, QUANTITIES[name].unit, every, every[samples])


def _tables(
    numbers: Numbers, front: Sequence[MotionColumn], groups: Sequence[Sequence[Course]], caption: str
) -> Iterator[Block]:
    """What moves as tables, what belongs together side by side; what stays the same as a sentence."""
    moving: list[list[MotionColumn]] = []
    still: list[str] = []
    for group in groups:
        sizes: dict[str, float] = {}
        for one in group:
            sizes[one.unit] = max(sizes.get(one.unit, 0.0), float(np.nanmax(np.abs(one.every), initial=0.0)))
        moving.append([])
        for one in group:
            rounding = STILL * sizes[one.unit]
            values = one.every[np.isfinite(one.every)]
            if values.size and float(np.ptp(values)) <= rounding:
                value = 0.0 if abs(values[0]) <= rounding else float(values[0])
                still.append(f"${one.letter}$ = {numbers.measured(value, one.unit)}")
            else:
                head = numbers.head(f"${one.letter}$", one.unit)
                moving[-1].append(MotionColumn(head, numbers.column(one.rows, one.unit, least=rounding)))
    yield from _split_columns(front, moving, caption)
    if still:
        yield ParagraphBlock(_("The same at all samples: {quantities}.").format(quantities=", ".join(still)))


def _front(study: ReportStudy, data: xr.Dataset) -> list[MotionColumn]:
    """Time, values of drives that are no angles of links, and the status where not all samples are reached."""
    numbers = study.numbers
    found = [MotionColumn(numbers.head("$t$", "s"), numbers.column(known(data["time"]), "s"))]
    for k, drive in enumerate(study.mechanism.drives):
        unit = study.mechanism.motion_parameter.drive(drive.id).unit
        if drive.link is not None and drive.relative_to == FRAME:
            continue  # its angle stands among those of the links
        values = known(data["drive_value"])[:, k]
        found.append(MotionColumn(numbers.head(shown(drive.id), unit), numbers.column(values, unit)))
    status = data["status"].to_numpy()
    if (status != Status.OK).any():
        found.append(MotionColumn(_("status"), tuple(status_word(int(each)) for each in status), False))
    return found


def _split_columns(
    front: Sequence[MotionColumn], groups: Sequence[Sequence[MotionColumn]], caption: str
) -> Iterator[TableBlock]:
    """Groups of columns in as few tables as a page is wide for, each with the front; long groups are cut."""
    room = max(1, WIDE - len(front))
    parts: list[list[MotionColumn]] = []
    for group in groups:
        count = -(-len(group) // room)
        for number in range(count):
            piece = group[number * len(group) // count : (number + 1) * len(group) // count]
            if parts and len(parts[-1]) + len(piece) <= room:
                parts[-1] += piece
            else:
                parts.append(list(piece))
    for number, part in enumerate(parts):
        columns = [*front, *part]
        rows = tuple(zip(*(column.cells for column in columns), strict=True))
        more = _("{caption} (continued)").format(caption=caption) if number else caption
        yield TableBlock(
            tuple(one.head for one in columns), rows, more, tuple(one.is_number for one in columns)
        )


CLOSED = 1e-9
"""Residual over the greatest length below which a sample is closed."""


def tables_chapter(study: ReportStudy) -> ChapterBlocks | None:
    """Statuses and limits, tables of the instants, tables over the motion, checks."""
    if not study.is_planar:
        return None
    sections = [SectionBlocks(_("Range"), tuple(_range(study)))]
    sections += [SectionBlocks(moment.title, tuple(_instant(study, moment))) for moment in moments_of(study)]
    sections.append(SectionBlocks(_("The whole motion"), tuple(long_tables(study))))
    sections.append(SectionBlocks(_("Checks"), tuple(_checks(study))))
    return ChapterBlocks("tables", _("Tables of the motion"), tuple(sections))


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
        yield ParagraphBlock(sentence(study.study.failure, study.numbers))
    for note in study.study.notes:
        yield ParagraphBlock(sentence(note, study.numbers))


def _instant(study: ReportStudy, moment: Moment) -> Iterator[Block]:
    """Links and points at one instant, and their kinematic coefficients."""
    if not moment.reached:
        yield ParagraphBlock(moment.missing)
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
    yield TableBlock(
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


def _points(study: ReportStudy, data: xr.Dataset) -> TableBlock:
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
    return TableBlock((_("point"), *head), rows, caption, (False, *(True,) * 8))


def _guides(study: ReportStudy, data: xr.Dataset) -> TableBlock:
    numbers = study.numbers
    units = ("m", "m/s", "m/s^2")
    names = ("slide", "slide_velocity", "slide_acceleration")
    columns = [numbers.column(known(data[name]), unit) for name, unit in zip(names, units, strict=True)]
    head = tuple(
        numbers.head(f"${letter}$", unit)
        for letter, unit in zip(("s", "dot(s)", "dot.double(s)"), units, strict=True)
    )
    rows = tuple(zip([shown(guide.id) for guide in study.mechanism.guides], *columns, strict=True))
    return TableBlock(
        (_("guide"), *head), rows, _("Displacements along the guides"), (False, True, True, True)
    )


def _checks(study: ReportStudy) -> Iterator[Block]:
    """Residuals, identities of rigid bodies, return after a full turn."""
    data, words = study.motion, study.study.words
    residual = float(data.attrs["worst_residual"])
    text = _(
        "All constraints hold at every sample that is reached; the worst residual is {value} "
        "of the greatest length ({constraint})."
    )
    yield CheckBlock(
        text.format(value=small(residual), constraint=shown(words.solved.worst_constraint.label)),
        residual <= CLOSED,
    )
    yield from identity_checks(study)
    status = data["status"].to_numpy()
    rows = chosen_rows(study)
    yield ParagraphBlock(
        ngettext(
            "The tables show {rows} row of {samples} samples; {sign} stands where nothing is known.",
            "The tables show {rows} rows of {samples} samples; {sign} stands where nothing is known.",
            len(rows),
        ).format(rows=len(rows), samples=len(status), sign=NOTHING)
    )
