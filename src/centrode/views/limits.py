"""Limits of one drive, the others held: what the terminal and the files show; how motions fall short of their range."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.errors import STATUSES_NOT_REACHED
from centrode.sheets.plots import EventKind
from centrode.sheets.sheet import Column, Fact, Failure, Sheet, Table
from centrode.sheets.texts import Counted, Joined, Name, Number, Sentence, Setting, Text
from centrode.views.abscissa import motion_abscissa, reached_part
from centrode.views.instants import place_number

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr

    from centrode.dynamics.motion_results import MotionResults
    from centrode.kinematics.several_inputs.limits import End, Limits
    from centrode.model.mechanism import Mechanism
    from centrode.sheets.plots import Abscissa

SAME = 1e-12
"""Difference of places [rad or m] that are the same but for rounding."""


def sheet(limits: Limits) -> Sheet:
    """Both ends with the groups that lock there, and the change points between them."""
    return Sheet(facts=_facts(limits), tables={"limits": _table(limits)}, record=limits.as_dict())


def _facts(limits: Limits) -> tuple[Fact, ...]:
    parameter, unit = limits.mechanism.motion_parameter, limits.unit
    held = [
        Joined((Name(name), place_number(value, parameter.drive(name).unit)), " = ")
        for name, value in limits.held.items()
    ]
    changes = [Joined((place_number(end.value, unit), Name(end.group)), ", ") for end in limits.change_points]
    return (
        Fact(Sentence("drive"), Name(limits.drive)),
        Fact(Sentence("held drives"), Joined(held) if held else Sentence("none")),
        Fact(Sentence("initial value"), place_number(limits.about, unit)),
        Fact(Sentence("from"), _end(limits.low, unit)),
        Fact(Sentence("to"), _end(limits.high, unit)),
        Fact(Sentence("change points"), Joined(changes, "; ") if changes else Sentence("none")),
    )


def _end(end: End | None, unit: str) -> Text:
    if end is None:
        return Sentence("unlimited")
    return Sentence("{value}, limit of {group}", value=place_number(end.value, unit), group=Name(end.group))


def _table(limits: Limits) -> Table:
    """Both ends and the change points between them in SI; an end that does not exist is empty."""
    ends = [("low", limits.low), *(("change point", end) for end in limits.change_points)]
    ends.append(("high", limits.high))
    values = np.array([np.nan if end is None else end.value for _event, end in ends])
    return Table(
        (
            Column("event", tuple(Name(event) for event, _end in ends)),
            Column(f"drive_{limits.drive}", values, limits.unit, unit_fixed=True),
            Column("group", tuple(Name("" if end is None else end.group) for _event, end in ends)),
        )
    )


# Samples that are not reached


def reached_text(results: MotionResults) -> Text:
    """From where to where a motion is reached, and of which groups the ends are dead positions."""
    status = results.motion["status"].values
    if np.isin(status, STATUSES_NOT_REACHED).all():
        return Sentence("nothing of the range")
    abscissa = motion_abscissa(results.mechanism, results.motion)
    assert abscissa.ends is not None
    first, last = (_reached_end(results, end, abscissa) for end in abscissa.ends)
    gaps = np.isin(reached_part(results.motion)["status"].values, STATUSES_NOT_REACHED).any()
    if gaps:
        return Sentence("parts of {first} to {last}", first=first, last=last)
    return Sentence("{first} to {last}", first=first, last=last)


def _reached_end(results: MotionResults, end: float, abscissa: Abscissa) -> Text:
    """An end of what is reached, with the group whose dead position it is."""
    value = place_number(end, abscissa.label.unit)
    if (end, EventKind.LIMIT) not in abscissa.events:
        return value
    group = next(
        (one.group for one in results.limits if abs(one.value - end) <= SAME * max(1.0, abs(end))), ""
    )
    if not group:
        return Sentence("{value} (dead position)", value=value)
    return Sentence("{value} (dead position of {group})", value=value, group=Name(group))


def unreached_failure(
    mechanism: Mechanism, status: xr.DataArray, limits: Sequence[End], *, single: bool = False
) -> Failure | None:
    """Why a motion is not whole, with the limits that bound it; None where all samples (n) are reached.

    `single` places were asked for, not a range.
    """
    missing = int(np.isin(status.values, STATUSES_NOT_REACHED).sum())
    if not missing:
        return None
    text: Text = Counted(
        "the mechanism locks: {missing} of {all} samples is not reached",
        "the mechanism locks: {missing} of {all} samples are not reached",
        missing,
        missing=Number(missing, digits="d"),
        all=Number(status.size, digits="d"),
    )
    unit = mechanism.motion_parameter.variable.unit
    bounds = [
        Sentence(
            "limit at {value}, {group} in a dead position",
            value=place_number(end.value, unit),
            group=Name(end.group),
        )
        for end in limits
    ]
    if bounds:
        text = Sentence("{value} ({remark})", value=text, remark=Joined(bounds, "; "))
    if single:
        return Failure(text, Sentence("choose positions between the limits"))
    return Failure(text, _repair(mechanism))


def _repair(mechanism: Mechanism) -> Sentence:
    """What to ask for: the range between the limits, by a word where one drive has them."""
    if len(mechanism.drives) > 1:
        return Sentence("choose a range between the limits of the drive, or change the dimensions")
    if not mechanism.motion_parameter.is_uniform:
        return Sentence(
            "choose a range between the limits of the drive, or change a dimension as centrode rotatability proposes"
        )
    return Sentence(
        "choose the range between the limits ({setting}), or change a dimension as centrode rotatability proposes",
        setting=Setting('range = "reachable"', "study", "--range reachable"),
    )
