"""How far one drive can go while the others are held."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf, isfinite, pi
from typing import Any

import numpy as np

from centrode.errors import InputError
from centrode.kinematics.branches import Event
from centrode.kinematics.events import Scan
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.ready import Ready, ready
from centrode.kinematics.several_drives.holding import (
    Value,
    check_closed,
    held_path,
    held_values,
    initial_values,
    named_drive,
    starting_at,
    value_of,
)
from centrode.kinematics.solve import SEARCH, TURNS
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.structure.steps import name_of


@dataclass(frozen=True)
class End:
    """A value of a drive [rad or m] and the group at whose limit or change point it lies."""

    value: float
    group: str


@dataclass(frozen=True)
class Limits:
    """Between which values a drive can move while the others are held.

    Attributes
    ----------
    mechanism : Mechanism
    drive : its name
    unit : "rad" or "m"
    about : the value from which it moves
    held : values of the other drives [rad or m]
    low, high : End, or None where there is no limit within two turns (four times the greatest length)
    change_points : those between the limits
    """

    mechanism: Mechanism = field(compare=False, repr=False)
    drive: str
    unit: str
    about: float
    held: Mapping[str, float]
    low: End | None
    high: End | None
    change_points: tuple[End, ...]

    @property
    def interval(self) -> tuple[float, float]:
        """The ends as numbers; infinite where there is no limit."""
        return (self.low.value if self.low else -inf), (self.high.value if self.high else inf)

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        ends = {name: vars(end) if end else None for name, end in (("low", self.low), ("high", self.high))}
        return {
            "drive": self.drive,
            "unit": self.unit,
            "about": self.about,
            "held": dict(self.held),
            **ends,
            "change_points": [vars(end) for end in self.change_points],
        }


def limits(
    mechanism: Mechanism,
    drive: str | None = None,
    held: Mapping[str, Value] | None = None,
    about: Value | None = None,
) -> Limits:
    """Limits of one drive about a value of it, with the others held.

    Parameters
    ----------
    drive : str
        Which drive moves; may be left out where there is one.
    held : drive -> value [rad or m, or a text with a unit]
        Values of the others; those not named keep their initial ones.
    about : float or text
        The value from which it moves; its initial one if left out.

    Returns
    -------
    Limits
        Exact to rounding: the radicand of a group is followed to its zero. The assembly is that with the signs of
        the initial position; one with a group of higher class is brought there from the initial position, all
        drives together.

    Raises
    ------
    InputError
        There is no such drive, or the mechanism does not close at the values given.
    NotComputedYet
        As `motion` does.
    """
    prepared = ready(mechanism)
    moving = chosen_drive(mechanism, drive)
    others = held_values(prepared, (moving,), held)
    chosen = named_drive(mechanism, moving, "drive")
    start = initial_values(prepared)[moving]
    start = start if about is None else value_of(prepared, chosen, about, "about")
    return limits_about(prepared, moving, others, start)


def chosen_drive(mechanism: Mechanism, drive: str | None) -> str:
    """The drive that moves, the only one if none is named."""
    names = [one.id for one in mechanism.drives]
    if drive is not None:
        return named_drive(mechanism, drive, "drive").id
    if len(names) == 1:
        return names[0]
    raise InputError(
        "drive",
        _("the mechanism has {n} drives").format(n=len(names)),
        _("say which one moves: {names}").format(names=", ".join(names)),
    )


def has_one_drive(mechanism: Mechanism) -> bool:
    """Whether limits need no choice of the drive."""
    return len(mechanism.drives) == 1


def limits_about(prepared: Ready, drive: str, held: Mapping[str, float], about: float) -> Limits:
    """The same for a mechanism made ready before."""
    path = held_path(prepared, drive, about, held)
    continuation = starting_at(prepared, path)
    angular = path.driven[0].drive.kind == "angle"
    extent = 2.0 * pi * TURNS if angular else SEARCH * path.unit
    Scan(continuation, mesh_of(path, np.array([about - extent, about + extent]))).run()
    check_closed(continuation)
    low, high = continuation.branches.reach(0)
    if path.driven[0].drive.kind == "distance":
        low = max(low, 0.0)  # a cylinder is not shorter than zero, whatever its formulas say

    def end(value: float) -> End | None:
        if not isfinite(value):
            return None
        groups = _groups(prepared, continuation.branches.events, value)
        return End(value, groups or _("cylinder {name} of no length").format(name=drive))

    inside = [
        End(event.at, name_of(prepared.structure.groups[event.group]))
        for event in continuation.branches.events
        if event.kind == "change point" and low <= event.at <= high and abs(event.at - about) <= extent
    ]
    unit = path.parameter.variable.unit
    found = tuple(sorted(inside, key=lambda one: one.value))
    return Limits(prepared.mechanism, drive, unit, about, dict(held), end(low), end(high), found)


def _groups(prepared: Ready, events: list[Event], value: float) -> str:
    """Names of the groups that lock at a value."""
    which = dict.fromkeys(event.group for event in events if event.kind == "limit" and event.at == value)
    return ", ".join(name_of(prepared.structure.groups[group]) for group in which)
