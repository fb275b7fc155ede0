"""The chapters on the contact of a cam and its roller, and on the design that was chosen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.locale import _
from centrode.present.cams.choice import choice_figures
from centrode.present.cams.curves import contact_figure
from centrode.render.document.blocks import Chapter, Formula, Paragraph
from centrode.render.document.figures import picture
from centrode.report.chapters.cams.parts import cam_of, course, part_of, sections_of, told_part

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy


def cam_contact_chapter(study: ReportStudy) -> Chapter | None:
    """Hertzian stress between roller and cam."""
    part = part_of(study, "contact")
    if part is None:
        return None
    text = _(
        "Roller and cam touch along a line of the length $b$; the force $P$ along the follower makes the normal force"
        " $P \\/ cos gamma$. With the curvature $K$ of the path"
    )
    lines = (
        ("w", "frac(P, b cos gamma)"),
        ("kappa", "1/r + 1/R", "frac(1, r (1 - r K))"),
        ("1/E^*", "frac(1 - nu_1^2, E_1) + frac(1 - nu_2^2, E_2)"),
        ("sigma", "sqrt(frac(w kappa E^*, pi))"),
        ("a", "sqrt(frac(4 w, pi kappa E^*))"),
    )
    cam, data = cam_of(study), part.datasets["cam-contact"]
    if cam.contact is not None and cam.contact.outer:
        lines = (lines[0], ("kappa", "1/r - 1/R", "frac(1, r (1 + r K))"), *lines[2:])
    columns = [
        ("cam_curvature_radius", "R"), ("contact_half_width", "a"), ("contact_stress", "sigma"),
        ("contact_shear", "tau"),
    ]  # fmt: skip
    table = course(study, data, columns, _("The contact over the working arc"))
    sections = sections_of(
        ("", (Paragraph(text), Formula(lines), *told_part(study, part))),
        (_("Over the working arc"), (table,)),
        (_("Figures"), (picture(contact_figure(cam, data), _("Contact stress over the working arc")),)),
    )
    return Chapter("contact", _("Contact of roller and cam"), sections)


def cam_choice_chapter(study: ReportStudy) -> Chapter | None:
    """The parameters that make one measure least while others keep their bounds."""
    part = part_of(study, "choice")
    if part is None:
        return None
    text = _(
        "The numbers named below are chosen so that one measure is least while the others keep their bounds; the rest"
        " of this document is about the description as it is given, not about the choice."
    )
    figures = choice_figures(part.objects["choice"])
    captions = {"cam-choice": _("What a bound costs: the best values over the bound that is moved")}
    drawn = tuple(
        picture(figure, captions.get(name, _("The chosen cam"))) for name, figure in figures.items()
    )
    sections = sections_of(("", (Paragraph(text), *told_part(study, part))), (_("Figures"), drawn))
    return Chapter("choice", _("Chosen parameters"), sections)
