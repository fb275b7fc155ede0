"""Constraint equations in symbols: letters, constraints, their derivatives, what the drives give."""

from __future__ import annotations

import numpy as np

from centrode.equations.instants import Instant, instant_of
from centrode.errors import Status
from centrode.locale import _
from centrode.present.equations import page
from centrode.present.equations.typst import TypstSpelling
from centrode.render.document.blocks import Block, Chapter, Check, Section
from centrode.render.document.rows import small
from centrode.report.equation_blocks import section_of
from centrode.report.study import ReportStudy

EPS = float(np.finfo(float).eps)
SAMPLES = 12
"""Samples at which the constraints are put to the test."""


def page_sections(study: ReportStudy) -> list[page.Section]:
    """The page of the equations, as `centrode equations` prints it, in the report's mathematics."""
    return study.once("page", lambda: page.sections(study.equations, TypstSpelling(), study.points))


def first_sections(study: ReportStudy) -> int:
    """How many sections of the page come before anything is solved."""
    headings = {_("Symbols"), _("Constraints"), _("Differentiated by time"), _("Given by the drives (SI)")}
    return sum(section.heading in headings for section in page_sections(study))


def constraints_chapter(study: ReportStudy) -> Chapter | None:
    """The same relations that `centrode equations` prints, checked on samples of the motion."""
    if not study.is_planar:
        return None
    sections = [section_of(section) for section in page_sections(study)[: first_sections(study)]]
    check = _check(study)
    if check is not None:
        sections.append(Section(_("Check"), (check,)))
    return Chapter("equations", _("Constraint equations"), tuple(sections))


def _check(study: ReportStudy) -> Block | None:
    """The constraints with the numbers of the motion put in: both sides agree to rounding."""
    conditions = [one for group in study.equations.groups for one in group.conditions]
    reached = np.flatnonzero(study.motion["status"].to_numpy() == Status.OK)
    if not conditions or not reached.size:
        return None
    chosen = np.unique(reached[np.linspace(0, reached.size - 1, SAMPLES).astype(int)])
    worst, allowed = 0.0, 0.0
    for sample in chosen.tolist():
        instant = instant_of(study.equations, study.motion, sample)
        scale = _scale(instant)
        worst = max(worst, *(abs(instant.number(one.residual)) for one in conditions))
        allowed = max(allowed, 64 * EPS * scale)
    text = _(
        "With the angles and displacements of the motion in closed form put in, both sides of every constraint "
        "agree to {worst} at {count} positions; rounding allows {allowed} (lengths in m, angles in rad)."
    )
    return Check(
        text.format(worst=small(worst), count=len(chosen), allowed=small(allowed)),
        worst <= allowed,
    )


def _scale(instant: Instant) -> float:
    """Size of what is added up in a constraint: lengths times angles, which carry a rounding of their own size."""
    sizes = [
        abs(value)
        for letter, value in instant.values.items()
        if np.isfinite(value) and not _is_rate(letter.name)
    ]
    return max(1.0, *sizes) ** 2


def _is_rate(name: str) -> bool:
    return name.startswith(("omega", "epsilon", "Delta")) or name.endswith(("_dot", "_ddot"))
