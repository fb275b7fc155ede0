"""Instant centres of all pairs of bodies at the instants, constructed by Kennedy's theorem and from velocities."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np

from centrode.analysis.instant_centres.centres import instant_centres
from centrode.analysis.instant_centres.kennedy import MOST_BODIES, Construction, construct_centres
from centrode.locale import _, ngettext
from centrode.model.labels import body_name
from centrode.model.mechanism import Mechanism
from centrode.present.centres import centres_figure
from centrode.render.document.blocks import Block, Chapter, Check, Paragraph, Section, Table, shown
from centrode.render.document.figures import picture
from centrode.render.document.rows import small, told
from centrode.report.moments import Moment, moments_of
from centrode.report.study import ReportStudy
from centrode.study.centres import body_names, centres_header, centres_rows

MOST_ROWS = 60
"""Centres of one instant that are told; of more those against the frame."""
CONSTRUCTED = 4
"""Column of the table that tells how a centre was constructed."""
SYMBOL = re.compile(r"\bP(\d+(?:,\d+)?)\b")
ALLOWED = float(np.finfo(float).eps) * (1 << 20)
"""Rounding times what lines that meet at an angle of 0.06 deg lose."""


def centres_chapter(study: ReportStudy) -> Chapter | None:
    """For each instant the table of centres with their constructions, and the drawing."""
    if not study.is_planar:
        return None
    names = body_names(study.mechanism)
    numbered = ", ".join(f"{number} {body_name(study.mechanism, name)}" for number, name in enumerate(names))
    first = Section("", (Paragraph(told(_("Bodies: {names}.").format(names=numbered), study.numbers)),))
    instants = [Section(moment.title, tuple(_instant(study, moment, names))) for moment in moments_of(study)]
    return Chapter("centres", _("Instant centres of velocity"), (first, *instants))


def _instant(study: ReportStudy, moment: Moment, names: tuple[str, ...]) -> Iterator[Block]:
    if not moment.reached:
        yield Paragraph(moment.missing)
        return
    data = moment.data.isel(sample=[moment.sample])
    pairs = len(names) * (len(names) - 1) // 2
    frame = [(name, names[0]) for name in names[1:]]
    found = instant_centres(data, None if pairs <= MOST_ROWS else frame)
    made = construct_centres(data, 0) if len(names) <= MOST_BODIES else None
    rows = centres_rows(study.mechanism, found, 0, names, made)
    labels = [str(label).split(",") for label in found["pair"].values]
    cells = tuple(
        (
            _cell(symbol, 0, study),
            _bodies(label, study.mechanism),
            *(_cell(text, k, study) for k, text in enumerate(others, start=2)),
        )
        for label, (symbol, _said, *others) in zip(labels, rows, strict=True)
    )
    yield Table(tuple(centres_header(found)), cells, _("Instant centres"))
    if pairs > MOST_ROWS:
        yield Paragraph(
            ngettext(
                "Of {n} centre those against the frame are told.",
                "Of {n} centres those against the frame are told.",
                pairs,
            ).format(n=pairs)
        )
    if made is not None:
        yield _judged(made)
        yield picture(
            centres_figure(study.mechanism, data, made), _("Instant centres and how they were found")
        )


def _bodies(names: Sequence[str], mechanism: Mechanism) -> str:
    return " – ".join(shown(body_name(mechanism, name)) for name in names)


def _cell(text: str, column: int, study: ReportStudy) -> str:
    """A cell; centres by their symbols in the first column and where constructions are told."""
    cell = told(text, study.numbers)
    if text == "0.0e+00":
        return "0"
    if column in (0, CONSTRUCTED):
        return SYMBOL.sub(r'$P_("\1")$', cell)
    return cell


def _judged(made: Construction) -> Check:
    """How fast bodies still move against each other where the construction puts their centre."""
    worst = max(made.mismatch.values(), default=0.0)
    text = _(
        "The centres were constructed from places alone; with the velocities of the motion the bodies move against "
        "each other there at {off} of the greatest velocity at most, {allowed} is allowed."
    )
    return Check(
        text.format(off=small(worst), allowed=small(ALLOWED)),
        bool(worst <= ALLOWED),
    )
