"""Inertia forces and moments of the links at an instant."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.dynamics.link_motions import motions_of_links
from centrode.locale import _
from centrode.render.document.blocks import Block, Table, shown
from centrode.render.document.formulas import in_si
from centrode.report.chapters.forces.results import motion_at_instants, reactions_at_instants

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy

ROUNDING = 1e-12


def inertia_at(study: ReportStudy, k: int) -> list[Block]:
    """Inertia of every link with mass; in the plane with the accelerations that it comes from."""
    here = reactions_at_instants(study).isel(sample=k)
    names = [str(name) for name in here["link"].to_numpy()]
    if not names:
        return []
    columns: list[tuple[str, str, np.ndarray]] = []
    if study.is_planar and study.mechanism.motion_parameter.is_uniform and "drive_rate" in here:
        columns += _accelerations(study, float(here["drive_rate"]), k)
    force, moment = here["inertia_force"].to_numpy(), here["inertia_moment"].to_numpy()
    axes = here["axis"].to_numpy().tolist()
    if np.isfinite(force).all() and force.any():
        columns += [(f"$Phi_{axis}$", "N", force[:, n]) for n, axis in enumerate(axes)]
    if moment.ndim == 1:
        columns.append(("$M_Phi$", "N m", moment))
    else:
        columns += [(f"$M_(Phi {axis})$", "N m", moment[:, n]) for n, axis in enumerate(axes)]
    return [_table(study, names, columns)]


def _accelerations(study: ReportStudy, rate: float, k: int) -> list[tuple[str, str, np.ndarray]]:
    """Accelerations of the centres and of the links at the constant rate of the drive."""
    links = motions_of_links(study.mechanism, motion_at_instants(study).isel(sample=k))
    centres = np.array([one.acceleration * rate**2 for one in links])
    return [
        ("$a_x$", "m/s^2", centres.real),
        ("$a_y$", "m/s^2", centres.imag),
        ("$epsilon$", "rad/s^2", np.array([one.bending * rate**2 for one in links])),
    ]


def _table(study: ReportStudy, names: list[str], columns: list[tuple[str, str, np.ndarray]]) -> Table:
    """In SI: products of the columns are to be found in them."""
    numbers = in_si(study.numbers)
    heads, texts = [_("link")], [tuple(map(shown, names))]
    for head, unit, values in columns:
        heads.append(numbers.head(head, unit))
        least = ROUNDING * float(np.max(np.abs(values), where=np.isfinite(values), initial=0.0))
        texts.append(numbers.column(values, unit, least))
    caption = _("Inertia forces and moments")
    if study.is_planar:
        caption = _("Accelerations of the centres of mass, inertia forces and moments")
    flags = (False,) + (True,) * len(columns)
    return Table(tuple(heads), tuple(zip(*texts, strict=True)), caption, flags)
