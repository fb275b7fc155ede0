"""Reduced inertia and moment at the instants: the sums with their numbers, beside the reduction itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.dynamics.link_motion import LinkMotion, motions_of_links
from centrode.locale import _
from centrode.model.spoken import load_name
from centrode.render.document.blocks import Block, Check, Formula, Paragraph, Section, Table, shown
from centrode.render.document.formulas import factor, in_si, indexed, squared, sum_of, with_unit
from centrode.report.chapters.forces.places import not_reached, titles
from centrode.report.chapters.forces.results import motion_at_instants, reduced_at_instants
from centrode.report.telling import measured

if TYPE_CHECKING:
    import xarray as xr

    from centrode.report.study import ReportStudy

Lines = list[tuple[str, ...]]
ROUNDINGS = 64.0
"""Roundings in a share m v^2 + J phi^2 by either route, each of the size of its terms."""


def sums_at_instants(study: ReportStudy) -> list[Section]:
    """A section for each instant."""
    data = reduced_at_instants(study)
    return [
        Section(title, tuple(_at(study, data.isel(sample=k), k))) for k, title in enumerate(titles(study))
    ]


def _at(study: ReportStudy, here: xr.Dataset, k: int) -> list[Block]:
    if not np.isfinite(float(here["reduced_inertia"])):
        return [Paragraph(not_reached())]
    links: list[LinkMotion] = []
    if study.is_planar:
        links = motions_of_links(study.mechanism, motion_at_instants(study).isel(sample=k))
    blocks: list[Block] = [_table_of_links(study, links)] if links else []
    lines = [*_shares(study, links), *_totals(study, here)]
    blocks.append(Formula(tuple(lines)))
    if here.sizes["load"]:
        blocks.append(_table_of_loads(study, here))
    if links:
        blocks += _checks(here, links)
    return blocks


def _table_of_links(study: ReportStudy, links: list[LinkMotion]) -> Table:
    """What the sums are made of: masses and coefficients."""
    numbers, by = in_si(study.numbers), study.mechanism.motion_parameter.drives[0].unit
    units = ("kg", "kg m^2", f"m/{by}" if by == "rad" else "1", "1" if by == "rad" else "rad/m")
    heads = ("$m$", "$J$", "$v'$", "$phi'$")
    columns = [tuple(shown(one.link) for one in links)]
    for values, unit in zip(
        (
            [one.mass for one in links],
            [one.inertia for one in links],
            [abs(one.velocity) for one in links],
            [one.turning for one in links],
        ),
        units,
        strict=True,
    ):
        columns.append(numbers.column(values, unit, 1e-13))
    head = (_("link"), *(numbers.head(name, unit) for name, unit in zip(heads, units, strict=True)))
    caption = _("Masses, and speeds of the links per unit of the drive's speed")
    return Table(head, tuple(zip(*columns, strict=True)), caption, (False, True, True, True, True))


def _shares(study: ReportStudy, links: list[LinkMotion]) -> Lines:
    """J of each link, with its numbers."""
    numbers = in_si(study.numbers)
    lines: Lines = []
    for one in links:
        letters, terms = [], []
        if one.mass:
            letters.append(f"{indexed('m', one.link)} {indexed('v', one.link)}'^2")
            terms.append(f"{factor(numbers, one.mass)} dot.op {squared(numbers, abs(one.velocity))}")
        if one.inertia and one.turning:
            letters.append(f"{indexed('J', one.link)} {indexed('phi', one.link)}'^2")
            terms.append(f"{factor(numbers, one.inertia)} dot.op {squared(numbers, one.turning)}")
        if letters:
            value = numbers.math(one.reduced)
            left = f"{indexed('J', one.link)}^*"
            lines.append((left, " + ".join(letters), " + ".join(terms), value))
    return lines


def _totals(study: ReportStudy, here: xr.Dataset) -> Lines:
    numbers = in_si(study.numbers)
    lines: Lines = []
    for symbol, name, parts in (
        ("J", "reduced_inertia", "reduced_inertia_part"),
        ("J'", "reduced_inertia_slope", "reduced_inertia_slope_part"),
        ("M", "reduced_moment", "reduced_moment_part"),
    ):
        shares, unit = here[parts].to_numpy().tolist(), str(here[name].attrs["units"])
        total = with_unit(numbers, float(here[name]), unit)
        if len(shares) > 1:
            lines.append((symbol, sum_of(numbers, shares), total))
        elif shares:
            lines.append((symbol, total))
    return lines


def _table_of_loads(study: ReportStudy, here: xr.Dataset) -> Table:
    values, unit = here["reduced_moment_part"].to_numpy(), str(here["reduced_moment"].attrs["units"])
    least = 1e-13 * float(np.max(np.abs(values), initial=0.0))
    names = [shown(load_name(study.mechanism, str(name))) for name in here["load"].to_numpy()]
    column = study.numbers.column(values, unit, least)
    head = (_("load"), study.numbers.head("$M$", unit))
    return Table(head, tuple(zip(names, column, strict=True)), _("Share of each load"), (False, True))


def _checks(here: xr.Dataset, links: list[LinkMotion]) -> list[Check]:
    """The sums over the links' own motions beside the reduction."""
    allowed = ROUNDINGS * float(np.finfo(float).eps)
    inertia = sum(one.reduced for one in links)
    off = abs(inertia - float(here["reduced_inertia"]))
    first = _("The inertia, summed up from the motion of the links, is off by {share} of it.")
    found = [measured(first, off, inertia, allowed)]
    slope = sum(one.slope for one in links)
    terms = sum(one.slope_terms for one in links)
    off = abs(slope - float(here["reduced_inertia_slope"]))
    second = _("Its derivative, summed up likewise, is off by {share} of its greatest terms.")
    return [*found, measured(second, off, terms, allowed)]
