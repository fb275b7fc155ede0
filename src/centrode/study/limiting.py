"""What is said of the limits of one drive: rows of a label and a text, and as JSON or CSV."""

from __future__ import annotations

import csv
import io
import json
from typing import TYPE_CHECKING, Protocol, TypeAlias

import numpy as np

from centrode.errors import InputError, MotionError, Status
from centrode.kinematics.several_inputs.limits import End, Limits, limits
from centrode.locale import _, ngettext
from centrode.model.mechanism import Mechanism
from centrode.study.wording import value_text

if TYPE_CHECKING:
    import xarray as xr

Rows: TypeAlias = list[tuple[str, str]]

KINDS = ("json", "csv")
NOT_REACHED = (Status.OPEN, Status.CUT_OFF, Status.UNCONVERGED)


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


class Sampled(Protocol):
    """A result over the samples of a motion."""

    @property
    def mechanism(self) -> Mechanism:
        """Of which mechanism."""

    @property
    def status(self) -> xr.DataArray:
        """(sample) what each sample is worth."""


def check_reached(result: Sampled) -> None:
    """Raise MotionError where samples are not reached, with the limits that bound the motion."""
    missing = int(np.isin(result.status.to_numpy(), NOT_REACHED).sum())
    if missing:
        what = not_reached_sentence(missing, result.status.size)
        where = limits_sentence(result.mechanism)
        raise MotionError("", f"{what} ({where})" if where else what, repair_of_range(result.mechanism))


def not_reached_sentence(missing: int, samples: int) -> str:
    """How many samples the mechanism does not reach."""
    return ngettext(
        "the mechanism locks: {missing} of {all} samples is not reached",
        "the mechanism locks: {missing} of {all} samples are not reached",
        missing,
    ).format(missing=missing, all=samples)


def repair_of_range(mechanism: Mechanism) -> str:
    """What to ask for where samples are not reached: between the limits, by a word where one drive has them."""
    if not mechanism.motion_parameter.is_uniform:
        return _("ask for a range between the limits, or change the dimensions")
    return _(
        'ask for the range between the limits (range = "reachable" under [study], or --range reachable), or '
        "change the dimensions"
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
