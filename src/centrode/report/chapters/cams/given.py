"""What a cam's description gives, as a table."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from centrode.locale import _
from centrode.render.document.blocks import Block, Paragraph, Table, shown
from centrode.render.document.numbers import Numbers

if TYPE_CHECKING:
    from centrode.model.cam import Cam
    from centrode.report.study import ReportStudy


def given_of(study: ReportStudy) -> tuple[Block, ...]:
    """What the cam is, and every number of its description."""
    text = _(
        "A roller rides on a fixed cam, led by a carrier that turns about the cam's centre. The curvature of the path"
        " of its centre is given."
    )
    return Paragraph(text), Table((_("what"), _("value")), tuple(_rows(study.cam, study.numbers)))


def _rows(cam: Cam, numbers: Numbers) -> Iterator[tuple[str, str]]:
    yield _("curvature law"), _law(cam, numbers)
    if cam.curvature.symmetric:
        yield _("symmetry"), _("the same on both sides of $phi = 0$")
    yield _("radius at the start"), numbers.measured(cam.start.radius, "m")
    yield _("pressure angle at the start"), numbers.measured(cam.start.pressure_angle, "rad")
    first, last = (numbers.measured(one, "rad") for one in (cam.range.start, cam.range.stop))
    yield _("range"), _("{first} to {last}").format(first=first, last=last)
    if cam.roller is not None:
        yield _("radius of the roller"), numbers.measured(cam.roller.radius, "m")
    if cam.mover is not None:
        yield _("legs of the wheel"), str(cam.mover.legs)
        yield _("post of a shoe"), numbers.measured(cam.mover.post, "m")
    if cam.return_arc is not None:
        kinds = {"designed": _("designed, without a kink"), "mirrored": _("mirrored")}
        yield _("return arc"), kinds[cam.return_arc.kind]
    yield from _contact(cam, numbers)


def _law(cam: Cam, numbers: Numbers) -> str:
    """The law as mathematics with its numbers, a formula of the user's own as it is written."""
    given = cam.curvature
    k0 = "" if given.k0 is None else f"$k_0$ = {numbers.measured(given.k0, '1/m')}"
    if given.law == "constant":
        return f"$K = k_0$, {k0}"
    if given.law == "exponential":
        return f"$K = k_0 e^(k_1 phi)$, {k0}, $k_1$ = {numbers.measured(given.k1 or 0.0, '1/rad')}"
    if given.law == "linear":
        return f"$K = k_0 + k_1 phi$, {k0}, $k_1$ = {numbers.measured(given.k1 or 0.0, '1/m/rad')}"
    if given.law == "spline":
        return _("spline through {count} points").format(count=len(given.points or ()))
    return shown(f"K = {given.formula}, 1/m")


def _contact(cam: Cam, numbers: Numbers) -> Iterator[tuple[str, str]]:
    contact = cam.contact
    if contact is None:
        return
    yield _("force along the follower"), numbers.measured(contact.force, "N")
    yield _("length of the line of contact"), numbers.measured(contact.width, "m")
    materials = ((_("material of the cam"), contact.cam), (_("material of the roller"), contact.roller))
    for label, material in materials:
        if material is not None:
            modulus = numbers.measured(material.elasticity * 1e-9, "GPa")
            yield label, f"$E$ = {modulus}, $nu$ = {numbers.plain(material.poisson)}"
    if contact.admissible is not None:
        yield _("admissible contact stress"), numbers.measured(contact.admissible * 1e-6, "MPa")
