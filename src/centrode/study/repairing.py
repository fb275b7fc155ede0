"""What is said of a repair: rows of a label and a text, and as JSON."""

from __future__ import annotations

import json
from dataclasses import replace
from math import degrees
from typing import TypeAlias

from centrode.analysis.redesign.candidates import Candidates, impossible
from centrode.analysis.redesign.repair import Change, Repair
from centrode.analysis.rotatability.rotatability import rotatability
from centrode.kinematics.preparation import ready
from centrode.locale import _, ngettext, speaking
from centrode.model.mechanism import Mechanism
from centrode.study.wording import value_text

Rows: TypeAlias = list[tuple[str, str]]


def repair_rows(mechanism: Mechanism, found: Repair) -> Rows:
    """What changes and by how much, what that reaches, and what was tried."""
    asked = _("turns fully, transmission angles of {angle:.6g} deg or more").format(
        angle=degrees(found.least_transmission_angle)
    )
    rows = [(_("asked for"), asked)]
    if found.impossible:
        return [*rows, (_("found"), _("impossible: {reason}").format(reason=found.impossible))]
    if found.found and not found.changes:
        return [*rows, (_("found"), _("it does so as it is")), _reached(found)]
    if found.found:
        rows += [(_("found"), _("a change of size {size:.6g}").format(size=found.size))]
        rows += [(change.path, _change(mechanism, change)) for change in found.changes]
        rows += [_reached(found)]
    else:
        rows += [(_("found"), _("none within the bounds; that does not say that there is none"))]
    tried = ngettext("{n} candidate", "{n} candidates", found.tried).format(n=found.tried)
    return [
        *rows,
        (
            _("tried"),
            _("{tried}; of the {spread} spread over the bounds {turning} turn so").format(
                tried=tried, spread=found.spread, turning=found.turning
            ),
        ),
    ]


def repair_text(mechanism: Mechanism, found: Repair) -> str:
    """What was found for a mechanism as JSON, in SI and in English, whatever language it was found in."""
    with speaking("en"):
        after = None if found.mechanism is None else rotatability(found.mechanism)
        reason = (
            impossible(Candidates(ready(mechanism), found.varying), found.least_transmission_angle)
            if found.impossible
            else ""
        )
        english = replace(found, before=rotatability(mechanism), after=after, impossible=reason)
        return json.dumps(english.as_dict(), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _reached(found: Repair) -> tuple[str, str]:
    reached = degrees(found.reached or 0.0)
    return _("verified"), _("turns fully, least transmission angle {angle:.6g} deg").format(angle=reached)


def _change(mechanism: Mechanism, change: Change) -> str:
    if change.unit == "1":
        before, after = f"{change.before:.9g}", f"{change.after:.9g}"
    else:
        before, after = (
            value_text(value, change.unit, mechanism.display) for value in (change.before, change.after)
        )
    if change.before == change.after:
        return _("stays {before}").format(before=before)
    return _("from {before} to {after}").format(before=before, after=after)
