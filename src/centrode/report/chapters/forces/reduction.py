"""The chapter of the reduction: inertia and loads as the drive feels them."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from centrode.locale import _
from centrode.present.forces.reduction_figures import reduction_figures
from centrode.render.document.blocks import Block, Chapter, Formula, Paragraph, Section, Table
from centrode.report.chapters.forces.places import head_of_places, places_of, unit_of_place
from centrode.report.chapters.forces.reduced_sums import sums_at_instants
from centrode.report.chapters.forces.results import has_forces, reduced
from centrode.report.chapters.forces.tables import Column, over_samples
from centrode.report.telling import facts, listed, pictures
from centrode.study.forces.reducing import reduction_parts, reduction_rows
from centrode.views.columns import rows_shown

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy

Lines: TypeAlias = tuple[tuple[str, ...], ...]
COLUMNS = (("reduced_inertia", "J"), ("reduced_inertia_slope", "J'"), ("reduced_moment", "M"))


def reduction_chapter(study: ReportStudy) -> Chapter | None:
    """Reduced inertia, its derivative and the reduced moment: formulas, numbers at instants, course, figures."""
    if not has_forces(study):
        return None
    mechanism, data = study.mechanism, reduced(study)
    sections = [Section("", (*_meaning(study), facts(study.numbers, reduction_rows(mechanism, data))))]
    if "reduced_inertia" in data:
        sections += sums_at_instants(study)
        sections.append(Section(_("Over the motion"), (_course(study),)))
    header, rows = reduction_parts(data, mechanism)
    own = [[_part(cells[0]), *cells[1:]] for cells in rows]
    sections.append(Section(_("Extremes and means"), (listed(study.numbers, header, own),)))
    captions = {
        "reduced-inertia": _("Reduced inertia with the parts of the links, and its derivative"),
        "reduced-moment": _("Reduced moment with the parts of the loads"),
        "inertia-matrix": _("Elements of the inertia matrix"),
        "generalised-force": _("Generalised forces of the drives"),
    }
    drawn = pictures(reduction_figures(mechanism, data), captions)
    sections.append(Section(_("Figures"), tuple(drawn)))
    return Chapter("reduction", _("Reduction to the drive"), tuple(sections))


def _part(label: str) -> str:
    """A whole as it is, the part of a link or of a load behind a dash."""
    return "– " + label.strip() if label.startswith("  ") else label


def _meaning(study: ReportStudy) -> tuple[Block, ...]:
    if "reduced_inertia" not in reduced(study):
        text = _(
            "With several drives the masses make an inertia matrix and the loads a generalised force of each drive:"
            " kinetic energy and power stay those of the mechanism."
        )
        lines: Lines = (("T", "1/2 sum_(i, k) M_(i k) dot(q)_i dot(q)_k"), ("P", "sum_i Q_i dot(q)_i"))
        return Paragraph(text), Formula(lines)
    text = _(
        "The mechanism is replaced by its drive alone, with an inertia $J(q)$ of the same kinetic energy and a moment"
        " $M(q)$ of the same power. Primes are derivatives by the value $q$ of the drive."
    )
    if study.is_spherical:
        meaning = _(
            "$omega_k$ is the angular velocity of link $k$, $upright(bold(I))_k$ its tensor of inertia about the"
            " centre of the sphere."
        )
        inertia = "sum_k arrow(omega)'_k dot.op upright(bold(I))_k arrow(omega)'_k"
        lines = (("T", "1/2 J dot(q)^2"), ("J", inertia), ("M", "sum_j arrow(M)_j dot.op arrow(omega)'_j"))
        return Paragraph(text), Paragraph(meaning), Formula(lines)
    meaning = _("$v_k$ is the velocity of the centre of mass of link $k$, $phi_k$ the angle of the link.")
    lines = (
        ("T", "1/2 J dot(q)^2"),
        ("J", "sum_k (m_k v'_k^2 + J_k phi'_k^2)"),
        ("J'", "2 sum_k (m_k arrow(v)'_k dot.op arrow(v)''_k + J_k phi'_k phi''_k)"),
        ("M", "sum_j arrow(F)_j dot.op arrow(r)'_j + sum_j M_j phi'_j"),
    )
    return Paragraph(text), Paragraph(meaning), Formula(lines)


def _course(study: ReportStudy) -> Table:
    """A few even samples."""
    data = reduced(study)
    columns = [Column(head_of_places(study), unit_of_place(study), places_of(study, data))]
    for name, symbol in COLUMNS:
        columns.append(Column(f"${symbol}$", str(data[name].attrs["units"]), data[name].to_numpy()))
    caption = _("Reduced inertia, its derivative and the reduced moment at even steps")
    return over_samples(study.numbers, columns, rows_shown(data.sizes["sample"]), caption)
