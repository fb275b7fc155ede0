"""What a check and a run say of a mechanism: rows of a label and a text, in the chosen language."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from centrode.errors import Status
from centrode.locale import _
from centrode.quantities import status_word
from centrode.structure.assur import AssurGroup
from centrode.study.check import MechanismCheck

if TYPE_CHECKING:
    from centrode.study.run import StudyResults  # brings xarray, which a check does without

Rows: TypeAlias = list[tuple[str, str]]


def check_rows(checked: MechanismCheck) -> Rows:
    """Mobility, redundant constraints, loops, groups and initial position."""
    count = checked.count
    by_formula = _("{rank} by rank; by Chebyshev's formula 3·{n} - 2·{p5} - {p4} = {formula}").format(
        rank=checked.mobility,
        n=count.moving_links,
        p5=count.lower_pairs,
        p4=count.higher_pairs,
        formula=count.mobility,
    )
    rows = [
        (_("mobility"), by_formula),
        (_("drives"), ", ".join(checked.drives)),
        (_("redundant constraints"), "; ".join(checked.redundant) or _("none")),
        (_("independent loops"), str(count.loops)),
        (_("structural formula"), checked.formula),
    ]
    rows += [(_("groups") if not i else "", _group(group)) for i, group in enumerate(checked.groups)]
    closes = _("closes to {residual:.1e} of the greatest length").format(residual=checked.initial_residual)
    return [*rows, (_("initial position"), closes)]


def _group(group: AssurGroup) -> str:
    name = ", ".join(group.members)
    if group.roman == "I":
        return _("{name}: input, class I").format(name=name)
    if group.roman == "0":
        return _("{name}: follows, repeats other links").format(name=name)
    return _("{name}: class {roman}, order {order}, {kind}").format(
        name=name, roman=group.roman, order=group.order, kind=group.kind
    )


def motion_rows(study: StudyResults) -> Rows:
    """Range, events, statuses and worst residual of a motion."""
    words, data = study.words, study.motion
    status = data["status"].values
    counts = [(Status(code), int(np.sum(status == code))) for code in np.unique(status)]
    said = ", ".join(f"{status_word(which)} {number}" for which, number in counts)
    residual = _("{value:.1e} of the greatest length ({constraint})").format(
        value=data.attrs["worst_residual"], constraint=words.solved.worst_constraint.label
    )
    return [
        (_("range"), words.range()),
        (_("limits"), words.events("limit")),
        (_("change points"), words.events("change point")),
        (_("samples"), f"{len(status)}: {said}"),
        (_("worst residual"), residual),
    ]
