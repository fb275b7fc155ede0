"""Forces between cam and follower: formulas with numbers where they are greatest, springs, stress, torque."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.forces import follower_forces
from centrode.locale import _
from centrode.present.cams.curves import cam_forces_figure
from centrode.render.document.blocks import Block, Chapter, Formula, Paragraph, Table
from centrode.render.document.figures import picture
from centrode.render.document.rows import rows_table
from centrode.report.chapters.followers.forces_checks import (
    at_speed_of_jumping,
    by_virtual_work,
    strip_loads,
    with_spring,
)
from centrode.report.chapters.followers.forces_spelled import Worked
from centrode.report.chapters.followers.parts import course, part_of, sections_of, told_failures

if TYPE_CHECKING:
    import xarray as xr

    from centrode.report.study import ReportStudy


def cam_forces_chapter(study: ReportStudy) -> Chapter | None:
    """Forces over a turn; nothing where neither mass nor spring nor load is given, or no size of the cam."""
    part = part_of(study, "forces")
    if part is None:
        return None
    cam, data = study.plate, part.datasets["cam-forces"]
    forces = study.once("follower-forces", lambda: follower_forces(cam))
    worked = Worked(cam, forces, study.numbers)
    figure = picture(cam_forces_figure(cam, data), _("Push, contact force, torque and stress over a turn"))
    known = np.isfinite(data.attrs["greatest_force"])
    sections = sections_of(
        ("", (*_laws(worked), rows_table(part.rows, study.numbers), *told_failures(study, part))),
        (_("Greatest contact force"), tuple(_greatest(worked, data)) if known else ()),
        (_("Contact and spring"), tuple(_keeping(worked, data)) if not forces.led else ()),
        (_("Torque of the camshaft"), tuple(_torque(worked, data)) if known else ()),
        (_("Contact stress"), tuple(_stress(worked, data))),
        (_("Over a turn"), (_table(study, data), figure)),
    )
    return Chapter("cam-forces", _("Forces on cam and follower"), sections)


def _laws(worked: Worked) -> Iterator[Block]:
    """What the cam has to give, in letters."""
    if worked.swings:
        text = _(
            "About the pivot the cam has to give the moment $Q$: preload and stiffness of the spring, the load and what"
            " accelerates the moment of inertia. Along the normal that is the force $N$, about the cam's axis the"
            " torque $T$."
        )
    else:
        text = _(
            "Along the follower the cam has to give the force $Q$: preload and stiffness of the spring, the load and"
            " what accelerates the mass. Along the normal that is the force $N$, about the cam's axis the torque $T$."
        )
    yield Paragraph(text)
    yield Formula(worked.letters())
    if worked.forces.friction:
        yield Paragraph(_(
            "The cam's surface slides on the follower and drags it along with $mu N$; $b_n$ and $b_t$ are what forces"
            " of one along the normal and along the drag do on the follower's way, $g_n$ and $g_t$ their arms about"
            " the cam's axis."
        ))  # fmt: skip


def _greatest(worked: Worked, data: xr.Dataset) -> Iterator[Block]:
    """The greatest force along the normal, from the lift at its angle."""
    at = float(data.attrs["greatest_force_at"])
    told = _("The contact force is greatest at $phi$ = {angle}:")
    yield Paragraph(told.format(angle=worked.numbers.measured(at, "rad")))
    yield Formula((*worked.lift(at), *worked.push(at), *worked.normal(at)))


def _keeping(worked: Worked, data: xr.Dataset) -> Iterator[Block]:
    """The least push, the speed of jumping, the springs that are needed."""
    facts, forces = data.attrs, worked.forces
    text = _("The push has to stay positive: a cam cannot pull. Where it is zero first, the follower jumps.")
    yield Paragraph(text)
    if np.isfinite(facts["least_push"]):
        at = float(facts["least_push_at"])
        told = _("The push is least at $phi$ = {angle}:")
        yield Paragraph(told.format(angle=worked.numbers.measured(at, "rad")))
        yield Formula((*worked.lift(at), *worked.push(at)))
    if np.isfinite(facts["jump_speed"]) and facts["jump_speed"] > 0.0:
        at = float(facts["jump_speed_at"])
        told = _("The least speed at which it becomes zero belongs to $phi$ = {angle}:")
        yield Paragraph(told.format(angle=worked.numbers.measured(at, "rad")))
        yield Formula((*worked.lift(at), *worked.jump(at, facts["jump_speed"])))
        yield at_speed_of_jumping(forces, facts["jump_speed"])
    if np.isfinite(facts["preload_needed"]) and forces.burden.inertia and forces.speed:
        told = _("A spring of this stiffness keeps the contact with at least the preload")
        yield Paragraph(told)
        yield Formula(worked.preload(facts["preload_needed"], float(facts["preload_needed_at"])))
        if facts["preload_needed"] > 0.0:
            yield with_spring(forces, facts["preload_needed"])
        else:
            yield Paragraph(_("As it is not positive, the stiffness alone does it, without preload."))


def _torque(worked: Worked, data: xr.Dataset) -> Iterator[Block]:
    """The greatest and the least torque; negative where the follower drives the cam."""
    for name, told in (
        ("greatest_torque", _("The camshaft has to give its greatest torque at $phi$ = {angle}:")),
        (
            "least_torque",
            _("It is least at $phi$ = {angle}; where it is negative the follower drives the cam:"),
        ),
    ):
        at = float(data.attrs[f"{name}_at"])
        yield Paragraph(told.format(angle=worked.numbers.measured(at, "rad")))
        yield Formula((*worked.slope(at), *worked.push_told(at), *worked.torque(at)))
    yield by_virtual_work(worked.forces)


def _stress(worked: Worked, data: xr.Dataset) -> Iterator[Block]:
    """The line contact after Hertz at its worst angle."""
    stress = data.attrs.get("greatest_stress", np.nan)
    if not np.isfinite(stress):
        return
    at = float(data.attrs["greatest_stress_at"])
    told = _(
        "Along the strip of contact of the length $b$ Hertz's formulas hold; the stress is greatest at $phi$ = {angle}:"
    )
    yield Paragraph(told.format(angle=worked.numbers.measured(at, "rad")))
    yield Formula(worked.stress(at))
    yield strip_loads(worked.forces)


def _table(study: ReportStudy, data: xr.Dataset) -> Table:
    push = "follower_moment" if study.plate.swings else "follower_push"
    columns = [(push, "Q"), ("contact_force", "N"), ("cam_torque", "T")]
    if "contact_stress" in data:
        columns += [("contact_stress", "sigma"), ("contact_half_width", "a")]
    caption = _("Forces over a turn; a dash where the contact is lost or nothing is known")
    return course(study, data, columns, caption, brief=True)
