"""Tables over the whole motion, in evenly spaced rows, as assignments print them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import Status
from centrode.locale import _
from centrode.model.mechanism import FRAME
from centrode.present.equations.typst import word
from centrode.quantities import QUANTITIES, status_word
from centrode.render.document.blocks import Block, Paragraph, Table, shown
from centrode.render.document.numbers import Numbers
from centrode.render.document.vectors import symbol
from centrode.report.study import ReportStudy

Array = npt.NDArray[np.float64]

ROWS = 37
"""Rows of a table over the whole motion: every ten degrees of a turn."""
WIDE = 9
"""Columns of a table that still fit across a page."""
STILL = 1e-12
"""Part of the greatest number of its kind by which a number may change that stays the same."""


class Column(NamedTuple):
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
    numbers: Numbers, front: Sequence[Column], groups: Sequence[Sequence[Course]], caption: str
) -> Iterator[Block]:
    """What moves as tables, what belongs together side by side; what stays the same as a sentence."""
    moving: list[list[Column]] = []
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
                moving[-1].append(Column(head, numbers.column(one.rows, one.unit, least=rounding)))
    yield from _parted(front, moving, caption)
    if still:
        yield Paragraph(_("The same at all samples: {quantities}.").format(quantities=", ".join(still)))


def _front(study: ReportStudy, data: xr.Dataset) -> list[Column]:
    """Time, values of drives that are no angles of links, and the status where not all samples are reached."""
    numbers = study.numbers
    found = [Column(numbers.head("$t$", "s"), numbers.column(known(data["time"]), "s"))]
    for k, drive in enumerate(study.mechanism.drives):
        unit = study.mechanism.motion_parameter.drive(drive.id).unit
        if drive.link is not None and drive.relative_to == FRAME:
            continue  # its angle stands among those of the links
        values = known(data["drive_value"])[:, k]
        found.append(Column(numbers.head(shown(drive.id), unit), numbers.column(values, unit)))
    status = data["status"].to_numpy()
    if (status != Status.OK).any():
        found.append(Column(_("status"), tuple(status_word(int(each)) for each in status), False))
    return found


def _parted(front: Sequence[Column], groups: Sequence[Sequence[Column]], caption: str) -> Iterator[Table]:
    """Groups of columns in as few tables as a page is wide for, each with the front; long groups are cut."""
    room = max(1, WIDE - len(front))
    parts: list[list[Column]] = []
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
        yield Table(tuple(one.head for one in columns), rows, more, tuple(one.is_number for one in columns))
