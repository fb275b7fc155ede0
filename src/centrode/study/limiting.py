"""What is said of the limits of one drive: rows of a label and a text, and as JSON or CSV."""

from __future__ import annotations

import csv
import io
import json
from typing import TypeAlias

from centrode.errors import InputError
from centrode.kinematics.several_inputs.limits import End, Limits, limits
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.study.wording import value_text

Rows: TypeAlias = list[tuple[str, str]]

KINDS = ("json", "csv")


def limits_rows(mechanism: Mechanism, found: Limits) -> Rows:
    """Drive, values held, both ends and change points, in the units and the language of the reader."""

    def text(end: End | None) -> str:
        if end is None:
            return _("unlimited")
        value = value_text(end.value, found.unit, mechanism.display)
        return _("{value}, limit of {group}").format(value=value, group=end.group)

    held = [
        f"{name} = {value_text(value, mechanism.motion_parameter.drive(name).unit, mechanism.display)}"
        for name, value in found.held.items()
    ]
    changes = [
        _("{value}, {group}").format(
            value=value_text(end.value, found.unit, mechanism.display), group=end.group
        )
        for end in found.change_points
    ]
    return [
        (_("drive"), found.drive),
        (_("held"), ", ".join(held) or _("none")),
        (_("about"), value_text(found.about, found.unit, mechanism.display)),
        (_("from"), text(found.low)),
        (_("to"), text(found.high)),
        (_("change points"), "; ".join(changes) or _("none")),
    ]


def limits_sentence(mechanism: Mechanism) -> str:
    """Where the limits of the only drive lie, and which groups lock there; empty where there are none to tell."""
    if len(mechanism.drives) != 1:
        return ""
    found = limits(mechanism)
    told = _("limit at {value}, where {group} is a dead point")
    ends = [end for end in (found.low, found.high) if end is not None]
    return "; ".join(
        told.format(value=value_text(end.value, found.unit, mechanism.display), group=end.group)
        for end in ends
    )


def limits_text(found: Limits, kind: str) -> str:
    """Limits as the text of a file, "json" or "csv", in SI; raises InputError for another kind."""
    if kind == "json":
        return json.dumps(found.as_dict(), indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    if kind != "csv":
        raise InputError(
            "--out",
            _("{kind} is not a kind of file for limits").format(kind=f'"{kind}"'),
            _("use one of {known}").format(known=", ".join(KINDS)),
        )
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["event", f"drive_{found.drive} [{found.unit}]", "group"])
    ends = [("low", found.low), *(("change point", end) for end in found.change_points), ("high", found.high)]
    for name, end in ends:
        writer.writerow([name, repr(end.value), end.group] if end else [name, "", ""])
    return text.getvalue()
