"""Parts of a cam's results for a report: each computed when its chapter is made, once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.render.document.blocks import Block, Check, Section, Table, shown
from centrode.render.document.rows import rows_table, told
from centrode.report.chapters.forces.tables import Column, over_samples
from centrode.report.telling import listed
from centrode.study.cams.parts import Asked, CamPart
from centrode.study.cams.parts import Table as Told
from centrode.study.cams.results import PARTS
from centrode.views.columns import rows_shown

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.cam import Cam
    from centrode.report.study import ReportStudy

MEGA = 1e-6


def cam_of(study: ReportStudy) -> Cam:
    """The cam, its tables at the instants of the report."""
    if not study.wishes.instants:
        return study.cam
    asked = study.cam.study.model_copy(update={"instants": study.wishes.instants})
    return study.cam.model_copy(update={"study": asked})


def part_of(study: ReportStudy, name: str) -> CamPart | None:
    """One part of the results; None where the description does not ask for it."""
    if not study.is_cam or study.is_plate_cam:
        return None
    # the front of best designs takes longer than all the rest: only where the choice is what is asked for
    front = study.wishes.chapters is not None and "choice" in study.wishes.chapters
    return study.once(("cam", name), lambda: PARTS[name](cam_of(study), Asked(front=front)))


def told_part(study: ReportStudy, part: CamPart) -> tuple[Block, ...]:
    """What the command prints of a part: rows, tables, what the cam cannot do."""
    failures = [Check(told(f"{one}.", study.numbers), False) for one in part.failures]
    return (rows_table(part.rows, study.numbers), *(_listed(study, one) for one in part.tables), *failures)


def _listed(study: ReportStudy, table: Told) -> Table:
    return listed(study.numbers, table.header, table.lines, shown(table.heading))


def course(study: ReportStudy, data: xr.Dataset, columns: list[tuple[str, str]], caption: str) -> Table:
    """Variables of a dataset over the angle of the carrier, at even steps."""
    found = [Column("$phi$", "rad", data["carrier_angle"].to_numpy())]
    for name, letter in columns:
        values, unit = data[name].to_numpy(), str(data[name].attrs["units"])
        scale, shown_unit = (MEGA, "MPa") if unit == "Pa" else (1.0, unit)
        found.append(Column(f"${letter}$", shown_unit, scale * values))
    return over_samples(study.numbers, found, rows_shown(data.sizes["sample"]), caption)


def sections_of(*titled: tuple[str, tuple[Block, ...]]) -> tuple[Section, ...]:
    """Sections with something in them."""
    return tuple(Section(title, blocks) for title, blocks in titled if blocks)
