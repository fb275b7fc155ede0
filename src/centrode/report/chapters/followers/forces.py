"""Forces between cam and follower: formulas with numbers where they are greatest, springs, stress, torque."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.forces import follower_forces, least_push, meeting_of
from centrode.locale import _
from centrode.present.cams.curves import cam_forces_figure
from centrode.render.document.blocks import Block, ChapterBlocks, FormulaBlock, ParagraphBlock, TableBlock
from centrode.render.document.figures import picture
from centrode.render.document.rows import rows_table
from centrode.report.chapters.followers.formulas import Worked
from centrode.report.chapters.followers.parts import ROUNDED, course, part_of, sections_of, told_failures
from centrode.report.chapters.followers.profile import angles
from centrode.report.texts import difference_check

if TYPE_CHECKING:
    import xarray as xr

    from centrode.cams.followers.forces import Burden, FollowerForces
    from centrode.render.document.blocks import CheckBlock
    from centrode.report.study import ReportStudy

# Second routes to the forces of a follower: virtual work with its friction, springs put in, loads of strips.

NODES = 16
"""Of the rule of Gauss and Chebyshev, which integrates an ellipse exactly."""
FLAT_TOP = 1e-9
"""What the place of an extreme, known to some 1e-8 of its stretch, leaves of a value that vanishes."""


def by_virtual_work(forces: FollowerForces) -> CheckBlock:
    """The torque against what push and friction do on the follower's way and where surfaces slide."""
    phi = angles()
    rows, found = forces.body.motion.lift(phi, 2), forces.at(phi)
    met = meeting_of(forces.body, rows)
    carried = met.sense * np.stack([-met.place[:, 1], met.place[:, 0]], axis=1)
    slid = np.sum(met.slip * (carried - met.lever * rows[1][:, None]), axis=1)
    lost = forces.friction * found.normal * slid
    apart = np.abs(found.torque - (found.push * rows[1] + lost))
    known = np.isfinite(apart)
    size = float(np.max(np.abs(found.normal[known]), initial=0.0)) * float(np.abs(met.place).max())
    text = _(
        "At 720 angles the moment of the contact force about the cam's axis is what virtual work asks for, to {share}"
        " of force times radius."
    )
    if forces.friction:
        text = _(
            "At 720 angles the moment of the contact force about the cam's axis does what the push and the friction do"
            " on their ways, to {share} of force times radius."
        )
    return difference_check(text, float(np.max(apart[known], initial=0.0)), size, ROUNDED)


def at_speed_of_jumping(forces: FollowerForces, speed: float) -> CheckBlock:
    """The least push at the speed of jumping, which is zero."""
    return _vanishes(
        forces,
        forces.burden,
        speed,
        _("At this speed the least push over the turn is {share} of the greatest."),
    )


def with_spring(forces: FollowerForces, preload: float) -> CheckBlock:
    """The least push with the preload that is needed, which is zero."""
    text = _("With this preload the least push over the turn is {share} of the greatest.")
    return _vanishes(forces, replace(forces.burden, preload=preload), forces.speed, text)


def _vanishes(forces: FollowerForces, burden: Burden, speed: float, text: str) -> CheckBlock:
    motion = forces.body.motion
    least = least_push(motion, burden, speed).value
    rows = motion.lift(angles(), 2)
    size = float(np.abs(burden.needed(rows, speed)).max())
    return difference_check(text, abs(least), size, FLAT_TOP)


def strip_loads(forces: FollowerForces) -> CheckBlock:
    """Pressures of the strip added up over its width against the load that it carries."""
    found = forces.at(angles())
    strip, width = found.strip, forces.width
    assert strip is not None and width is not None
    load = np.abs(found.normal) / width
    # the pressures of a strip lie on an ellipse
    across = math.pi * np.arange(1, NODES + 1) / (NODES + 1)
    ellipse = math.pi / (NODES + 1) * float(np.sum(np.sin(across) ** 2))
    apart = np.abs(ellipse * strip.half_width * strip.pressure - load)
    known = np.isfinite(apart)
    text = _("The elliptic pressures, added up across the strip, carry the load to {share} of it.")
    share = (
        float(np.max(apart[known] / load[known], initial=0.0, where=load[known] > 0.0))
        if known.any()
        else math.nan
    )
    return difference_check(text, share, 1.0, ROUNDED)


def cam_forces_chapter(study: ReportStudy) -> ChapterBlocks | None:
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
    return ChapterBlocks("cam-forces", _("Forces on cam and follower"), sections)


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
    yield ParagraphBlock(text)
    yield FormulaBlock(worked.letters())
    if worked.forces.friction:
        yield ParagraphBlock(_(
            "The cam's surface slides on the follower and drags it along with $mu N$; $b_n$ and $b_t$ are what forces"
            " of one along the normal and along the drag do on the follower's way, $g_n$ and $g_t$ their arms about"
            " the cam's axis."
        ))  # fmt: skip


def _greatest(worked: Worked, data: xr.Dataset) -> Iterator[Block]:
    """The greatest force along the normal, from the lift at its angle."""
    at = float(data.attrs["greatest_force_at"])
    told = _("The contact force is greatest at $phi$ = {angle}:")
    yield ParagraphBlock(told.format(angle=worked.numbers.measured(at, "rad")))
    yield FormulaBlock((*worked.lift(at), *worked.push(at), *worked.normal(at)))


def _keeping(worked: Worked, data: xr.Dataset) -> Iterator[Block]:
    """The least push, the speed of jumping, the springs that are needed."""
    facts, forces = data.attrs, worked.forces
    text = _("The push has to stay positive: a cam cannot pull. Where it is zero first, the follower jumps.")
    yield ParagraphBlock(text)
    if np.isfinite(facts["least_push"]):
        at = float(facts["least_push_at"])
        told = _("The push is least at $phi$ = {angle}:")
        yield ParagraphBlock(told.format(angle=worked.numbers.measured(at, "rad")))
        yield FormulaBlock((*worked.lift(at), *worked.push(at)))
    if np.isfinite(facts["jump_speed"]) and facts["jump_speed"] > 0.0:
        at = float(facts["jump_speed_at"])
        told = _("The least speed at which it becomes zero belongs to $phi$ = {angle}:")
        yield ParagraphBlock(told.format(angle=worked.numbers.measured(at, "rad")))
        yield FormulaBlock((*worked.lift(at), *worked.jump(at, facts["jump_speed"])))
        yield at_speed_of_jumping(forces, facts["jump_speed"])
    if np.isfinite(facts["preload_needed"]) and forces.burden.inertia and forces.speed:
        told = _("A spring of this stiffness keeps the contact with at least the preload")
        yield ParagraphBlock(told)
        yield FormulaBlock(worked.preload(facts["preload_needed"], float(facts["preload_needed_at"])))
        if facts["preload_needed"] > 0.0:
            yield with_spring(forces, facts["preload_needed"])
        else:
            yield ParagraphBlock(_("As it is not positive, the stiffness alone does it, without preload."))


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
        yield ParagraphBlock(told.format(angle=worked.numbers.measured(at, "rad")))
        yield FormulaBlock((*worked.slope(at), *worked.push_told(at), *worked.torque(at)))
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
    yield ParagraphBlock(told.format(angle=worked.numbers.measured(at, "rad")))
    yield FormulaBlock(worked.stress(at))
    yield strip_loads(worked.forces)


def _table(study: ReportStudy, data: xr.Dataset) -> TableBlock:
    push = "follower_moment" if study.plate.swings else "follower_push"
    columns = [(push, "Q"), ("contact_force", "N"), ("cam_torque", "T")]
    if "contact_stress" in data:
        columns += [("contact_stress", "sigma"), ("contact_half_width", "a")]
    caption = _("Forces over a turn; a dash where the contact is lost or nothing is known")
    return course(study, data, columns, caption, brief=True)
