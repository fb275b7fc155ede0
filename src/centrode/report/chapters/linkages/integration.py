"""The second route: the equations in Cauchy form integrated, beside the closed forms."""

from __future__ import annotations

import numpy as np

from centrode.equations.integration import integrate
from centrode.locale import _
from centrode.present.integrations import integration_figures
from centrode.render.document.blocks import Block, Chapter, Check, Section
from centrode.render.document.figures import picture
from centrode.render.document.rows import rows_table, small
from centrode.report.study import ReportStudy
from centrode.study.integrating import closed_motion, integration_rows

AGREE = 1e-6
"""Part of a radian, or of the greatest length, that errors of steps of tolerance 1e-10 stay far below."""


def integration_chapter(study: ReportStudy) -> Chapter | None:
    """The normal form integrated from the initial position, compared with the motion in closed form."""
    if not study.is_planar or not study.equations.unknowns:
        return None
    mechanism = study.mechanism
    found = integrate(mechanism, "adaptive")
    rows = rows_table(integration_rows(mechanism, found), study.numbers)
    worst = float(np.nanmax(np.abs(found["angle_difference"].to_numpy()), initial=0.0))
    check = Check(
        _(
            "Where the equations can be integrated, they give the angles of the closed forms: "
            "the greatest difference is {worst} rad, at a tolerance of {tolerance} for each step."
        ).format(worst=small(worst), tolerance=small(found.attrs["tolerance"])),
        worst <= AGREE,
    )
    blocks: list[Block] = [rows, check]
    figures = integration_figures(mechanism, found, closed_motion(mechanism, found))
    if "integration-errors" in figures:
        blocks.append(
            picture(
                figures["integration-errors"], _("Difference of the integrated motion from the closed forms")
            )
        )
    return Chapter("integration", _("Integration of the equations"), (Section("", tuple(blocks)),))
