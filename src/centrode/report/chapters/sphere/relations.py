"""Equations of a linkage on the sphere, as `centrode equations` prints them."""

from __future__ import annotations

from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.present.equations import page
from centrode.present.equations.typst import TypstSpelling
from centrode.render.document.blocks import Chapter, Paragraph, Section
from centrode.report.equation_blocks import section_of
from centrode.report.study import ReportStudy
from centrode.report.topics import left_out


def sphere_equations_chapter(study: ReportStudy) -> Chapter | None:
    """Closures of the dyads, their derivatives, Cramer's rule, normal form, accelerations."""
    if not study.is_spherical:
        return None
    try:
        found = page.sections(study.equations, TypstSpelling(), study.points)
    except CentrodeError as reason:
        if study.wishes.chapters is not None:
            raise
        return left_out("equations", _("Constraint equations"), reason)
    text = _(
        "Each dyad brings a new point: the law of cosines in the triangle of its two centres and that point gives its"
        " angle, the angle of its other arc to its path follows."
    )
    sections = [Section("", (Paragraph(text),)), *map(section_of, found)]
    return Chapter("equations", _("Constraint equations"), tuple(sections))
