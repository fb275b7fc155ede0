"""The balancing moment of an instant by virtual work, from the reduction, beside the one from the reactions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.render.document.blocks import Block, Formula, Paragraph
from centrode.render.document.formulas import factor, in_si, squared, with_unit
from centrode.report.chapters.forces.results import reactions_at_instants, reduced_at_instants
from centrode.report.telling import measured

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy


def by_virtual_work(study: ReportStudy, k: int) -> list[Block]:
    """The formula with its numbers and the check; nothing where the rate changes or friction grows with reactions."""
    found = reactions_at_instants(study).isel(sample=k)
    if not study.mechanism.motion_parameter.is_uniform or "drive_rate" not in found:
        return []
    try:
        here = reduced_at_instants(study).isel(sample=k)
    except CentrodeError:
        return []  # friction by a coefficient has no reduction without the reactions
    numbers, rate = in_si(study.numbers), float(found["drive_rate"])
    slope, moment = float(here["reduced_inertia_slope"]), float(here["reduced_moment"])
    unit = str(found["balancing"].attrs["units"]).split(", ")[0]
    work = 0.5 * slope * rate**2 - moment
    symbol = "M_upright(b)" if unit == "N m" else "F_upright(b)"
    squares = f"frac(1, 2) dot.op {factor(numbers, slope)} dot.op {squared(numbers, rate)}"
    after = f"{'+' if moment < 0 else '-'} {numbers.math(abs(moment))}"
    line = (symbol, "1/2 J' dot(q)^2 - M", f"{squares} {after}", with_unit(numbers, work, unit))
    text = _("By virtual work, at the constant rate of the drive:")
    blocks: list[Block] = [Paragraph(text), Formula((line,))]
    balancing = float(found["balancing"].to_numpy().flat[0])
    if np.isfinite(balancing):
        size = abs(0.5 * slope * rate**2) + abs(moment)
        loss = float(found["reaction_loss"])
        told = _("The reactions give the same to {share} of its terms.")
        blocks.append(measured(told, abs(work - balancing), size, loss))
    return blocks
