"""The motion of a follower: laws of its segments, their numbers, joints, tables, plots."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.motion import joints_of, motion_names
from centrode.locale import _
from centrode.present.cams.motion_drawing import cam_motion_figure
from centrode.quantities import QUANTITIES
from centrode.render.document.blocks import Block, Chapter, Formula, Paragraph, Table
from centrode.render.document.figures import picture
from centrode.render.document.numbers import NOTHING
from centrode.render.document.rows import rows_table
from centrode.report.chapters.followers.curves import CURVES
from centrode.report.chapters.followers.lift_checks import integrated, proved
from centrode.report.chapters.followers.parts import (
    course,
    letter_of,
    motion_of,
    part_of,
    rate,
    sections_of,
    told_failures,
)
from centrode.report.chapters.followers.segments import segment_blocks
from centrode.report.chapters.forces.tables import Column, over_samples

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy


def lift_chapter(study: ReportStudy) -> Chapter | None:
    """Lift and derivatives over a turn."""
    part = part_of(study, "motion")
    if part is None:
        return None
    data, cam = part.datasets["cam-motion"], study.plate
    figure = picture(cam_motion_figure(cam, data), _("Lift, velocity, acceleration and jerk over a turn"))
    sections = sections_of(
        ("", (*_given(study), rows_table(part.rows, study.numbers), *told_failures(study, part))),
        (_("Laws of the segments"), tuple(_laws(study))),
        (_("Numbers of the segments"), tuple(segment_blocks(study))),
        (_("Where segments meet"), (_joints(study),)),
        (_("Tables"), (*_tables(study), integrated(motion_of(study)))),
        (_("Plots"), (figure,)),
    )
    return Chapter("lift", _("Motion of the follower"), sections)


def _given(study: ReportStudy) -> Iterator[Block]:
    """What is given, and how derivatives by the angle become those in time."""
    letter, speed = letter_of(study), study.plate.body.speed
    text = _(
        "The lift ${letter}$ is given over the angle $phi$ of the cam, segment by segment. A prime means a derivative"
        " by $phi$ in radians; in time"
    )
    yield Paragraph(text.format(letter=letter))
    lines: list[tuple[str, ...]] = [
        (name, "omega" + ("" if order == 1 else f"^{order}") + f" {rate(letter, order)}")
        for order, name in enumerate(("dot(psi)", "dot.double(psi)", "dot.triple(psi)") if study.plate.swings
                                     else ("v", "a", "j"), 1)
    ]  # fmt: skip
    if speed is not None:
        rpm = study.numbers.math(speed * 30.0 / math.pi)
        lines.insert(
            0, ("omega", "frac(pi n, 30)", f"frac(pi dot.op {rpm}, 30)", f'{study.numbers.math(speed)} thin "rad/s"')
        )  # fmt: skip
    yield Formula(tuple(lines))


def _laws(study: ReportStudy) -> Iterator[Block]:
    """Every curve that is used, once, in letters."""
    letter = letter_of(study)
    used = [curve for curve in CURVES if any(one.curve == curve for one in study.plate.segments)]
    if not used:
        return
    text = _(
        "A segment begins at the angle $phi_0$ with the lift ${letter}_0$ and rises by $h$ (falls, where $h < 0$) over"
        " the angle $beta$; $u = (phi - phi_0) \\/ beta$ goes from 0 to 1."
    )
    yield Paragraph(text.format(letter=letter))
    for curve in used:
        rules = CURVES[curve]
        yield Paragraph(_("Curve: {curve}").format(curve=_(curve)))
        before = "0"
        for rule in rules:
            if len(rules) > 1:
                yield Paragraph(_("for ${first} <= u <= {last}$").format(first=before, last=rule.mark))
            before = rule.mark
            lift, slope, second = rule.spelled
            lines = (
                (letter, f"{letter}_0 + {lift}"),
                (rate(letter, 1), slope),
                (rate(letter, 2), second),
            )
            yield Formula(lines)
    yield from proved(study.plate, motion_of(study))


def _joints(study: ReportStudy) -> Table:
    """What derivatives change by."""
    motion, numbers = motion_of(study), study.numbers
    units = [QUANTITIES[name].unit for name in motion_names(motion.swings)[0][1:]]
    joints = joints_of(motion)
    rows = [(0.0, joints[-1]), *((one.angle, one) for one in joints[:-1])]
    columns: list[tuple[str, ...]] = [
        tuple(numbers.plain(place * numbers.shown("rad")[0]) for place, _one in rows)
    ]
    for order, unit in enumerate(units, 1):
        jumps = [one.jumps[order] * numbers.shown(unit)[0] for _place, one in rows]
        columns.append(tuple(_signed(numbers.plain(jump), jump) if jump else NOTHING for jump in jumps))
    letter = letter_of(study)
    heads = [f"$Delta {letter}^((4))$" if k == 4 else f"$Delta {rate(letter, k)}$" for k in (1, 2, 3, 4)]
    head = (
        numbers.head("$phi$", "rad"),
        *(numbers.head(one, unit) for one, unit in zip(heads, units, strict=True)),
    )
    caption = _("Jumps of the derivatives where segments meet; a dash: continuous, to rounding")
    return Table(head, tuple(zip(*columns, strict=True)), caption, (True,) * len(head))


def _signed(text: str, value: float) -> str:
    return f"+{text}" if value > 0 else text


def _tables(study: ReportStudy) -> Iterator[Table]:
    """The motion at even steps, and at the instants that are asked for."""
    part = part_of(study, "motion")
    assert part is not None
    data, motion, letter = part.datasets["cam-motion"], motion_of(study), letter_of(study)
    by_angle, in_time = motion_names(motion.swings)
    columns = [(name, rate(letter, order)) for order, name in enumerate(by_angle[:4])]
    caption = _("Lift and derivatives by the angle of the cam; where a derivative jumps, from there on")
    if study.wishes.instants:
        yield _at_instants(study)
    yield course(study, data, columns, caption, brief=True)
    if motion.speed is not None:
        letters = ("dot(psi)", "dot.double(psi)", "dot.triple(psi)") if motion.swings else ("v", "a", "j")
        caption = _("Velocity, acceleration and jerk at the speed of the cam")
        yield course(study, data, list(zip(in_time, letters, strict=True)), caption, brief=True)


def _at_instants(study: ReportStudy) -> Table:
    motion, letter = motion_of(study), letter_of(study)
    phi = np.array(study.wishes.instants)
    columns = [Column("$phi$", "rad", phi)]
    for order, (name, values) in enumerate(
        zip(motion_names(motion.swings)[0], motion.lift(phi, 3), strict=False)
    ):
        columns.append(Column(f"${rate(letter, order)}$", QUANTITIES[name].unit, values))
    return over_samples(study.numbers, columns, range(len(phi)), _("At the chosen angles"))
