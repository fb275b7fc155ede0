"""The smallest change after which a mechanism turns fully, verified by its geometry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi, sin
from typing import Any

import numpy as np

from centrode.analysis.repairing.candidates import Candidates
from centrode.analysis.repairing.impossible import impossible
from centrode.analysis.repairing.searching import Progress, Search
from centrode.analysis.repairing.varying import Bounds, Value, Varying, varyings
from centrode.analysis.rotatability import Rotatability, rotatability
from centrode.errors import CentrodeError, InputError, NotComputedYet
from centrode.kinematics.prepared import Ready, ready
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.units import to_si
from centrode.structure.groups import Aim, Newton

DEFAULT_ANGLE = pi / 180
"""Least transmission angle asked for where none is given: 0 would be a mechanism at the brink of locking."""
CANDIDATES = 3072
"""Candidates of the first spread."""
TIGHTENINGS = 4
"""How often a change is corrected by what its exact least angle lacks."""
ENOUGH = 1e-9
"""By how much [rad] the verified least transmission angle may fall short of the one asked for."""

_PARTS = ("mechanism", "changes", "varying", "before", "after")


@dataclass(frozen=True)
class Change:
    """One number before and after.

    Attributes
    ----------
    unit : "rad", "m" or "1"
    size : its part of the change: radians of an angle, of a length the change over the length
    """

    path: str
    before: float
    after: float
    unit: str
    size: float


@dataclass(frozen=True)
class Repair:
    """What was found.

    Attributes
    ----------
    found : whether a mechanism was found that turns fully with the transmission angle asked for
    mechanism : it; the one given if that turns already; None if none was found
    changes : of every number that may vary
    size : root of the sum of the squares of the changes' sizes
    varying : what could change, with its bounds
    least_transmission_angle, reached : asked for, and that of the mechanism found (exact) [rad]
    tried : candidates evaluated
    spread, turning : candidates of the first spread over the bounds, and how many of these turn
    impossible : why there can be none, with the inequality; empty where nothing says so
    before, after : Rotatability of the mechanism given and of the one found
    """

    found: bool
    mechanism: Mechanism | None
    changes: tuple[Change, ...]
    size: float
    varying: tuple[Varying, ...]
    least_transmission_angle: float
    reached: float | None
    tried: int
    spread: int
    turning: int
    impossible: str
    before: Rotatability
    after: Rotatability | None

    def as_dict(self) -> dict[str, Any]:
        """For JSON, in SI."""
        plain = {k: v for k, v in vars(self).items() if k not in _PARTS}
        return {
            **plain,
            "changes": [vars(change) for change in self.changes],
            "varying": [vars(one) for one in self.varying],
            "before": self.before.as_dict(),
            "after": self.after.as_dict() if self.after else None,
        }


def repair(
    mechanism: Mechanism,
    vary: Sequence[str] | None = None,
    bounds: Bounds | None = None,
    least_transmission_angle: Value | None = None,
    progress: Progress | None = None,
) -> Repair:
    """The smallest change that was found after which a mechanism turns fully.

    Parameters
    ----------
    vary : paths of numbers that may change
        Initial angles (where they place something), lengths, coordinates, directions. Left out: the initial
        angles of all links that are not driven, where these place something, otherwise all lengths.
    bounds : path -> (least, greatest) value [rad, m, or texts with units]
        Left out: half a turn to both sides, half to double of a length, half the greatest length to both sides of
        a coordinate.
    least_transmission_angle : float [rad] or text
        What every dyad keeps all over the turn; 1 degree if left out.
    progress : called with (candidates evaluated, candidates in all at most)

    Returns
    -------
    Repair
        A change is as large as the root of the sum of squares of radians (angles) and of changes over lengths.
        What is returned is verified by `rotatability`: it turns, with the exact least transmission angle. It is
        the smallest change found, a local minimum; smaller ones elsewhere are not excluded.

    Raises
    ------
    InputError
        A path or bound is wrong, the drive is no angle or not the only one.
    NotComputedYet
        Groups of higher class, gears and rolling wheels.
    """
    prepared = ready(mechanism)
    _check_repairable(prepared)
    least_angle = _angle(least_transmission_angle)
    varying = varyings(prepared, vary, bounds)
    before = rotatability(mechanism)
    asked = Repair(False, None, (), 0.0, varying, least_angle, None, 0, 0, 0, "", before, None)
    if turns_well(before, least_angle):
        return replace(asked, found=True, mechanism=mechanism, reached=_reached(before), after=before)
    candidates = Candidates(prepared, varying)
    reason = impossible(candidates, least_angle)
    if reason:
        return replace(asked, impossible=reason)
    return _searched(candidates, asked, progress)


def turns_well(found: Rotatability, least_angle: float) -> bool:
    """Whether a mechanism turns fully with at least a transmission angle in every dyad."""
    return found.turns_fully is True and _reached(found) >= least_angle - ENOUGH


def _reached(found: Rotatability) -> float:
    return min((one.least for one in found.one.transmissions), default=pi / 2)


def _angle(given: Value | None) -> float:
    if given is None:
        return DEFAULT_ANGLE
    try:
        value = to_si(given, "angle")
    except InputError as error:
        raise InputError("least_transmission_angle", error.what, error.repair) from None
    if not 0.0 < value < pi / 2:
        raise InputError(
            "least_transmission_angle",
            _("it lies between 0 and 90 deg, got {value:.6g} deg").format(value=np.degrees(value)),
            _('write "20 deg"'),
        )
    return value


def _check_repairable(prepared: Ready) -> None:
    mechanism = prepared.mechanism
    if len(mechanism.drives) != 1:
        raise InputError(
            "[[drives]]",
            _("a repair makes one drive turn; {n} are given").format(n=len(mechanism.drives)),
            _("give one drive"),
        )
    if mechanism.drives[0].kind != "angle":
        raise InputError("[[drives]]", _("a displacement cannot turn fully"), _("drive the angle of a link"))
    groups = prepared.structure.groups
    on_sphere = mechanism.space == "sphere"
    lacking = [
        (any(isinstance(group, Newton) for group in groups), _("groups of higher class")),
        (bool(mechanism.gears or mechanism.rolling), _("gears and rolling wheels")),
        (
            on_sphere and any(isinstance(group, Aim) for group in groups),
            _("guides on moving links of a sphere"),
        ),
    ]
    for found, what in lacking:
        if found:
            raise NotComputedYet(
                "--repair", _("no repair is computed of {what}").format(what=what), _("change it by hand")
            )


def _searched(candidates: Candidates, asked: Repair, progress: Progress | None) -> Repair:
    """The smallest change that the geometry confirms."""
    least_angle = asked.least_transmission_angle
    search = Search(candidates, sin(least_angle + ENOUGH) ** 2, progress)
    options = search.run(CANDIDATES)
    effort = replace(asked, spread=search.spread, turning=search.turning)
    for change in options:
        confirmed = _confirmed(search, change, least_angle)
        if confirmed is not None:
            change, mechanism, after = confirmed
            return replace(
                effort,
                found=True,
                mechanism=mechanism,
                changes=_changes(candidates.varying, change),
                size=float(np.linalg.norm(change)),
                reached=_reached(after),
                tried=search.tried,
                after=after,
            )
    return replace(effort, tried=search.tried)


def _confirmed(search: Search, change: Any, least_angle: float) -> tuple[Any, Mechanism, Rotatability] | None:
    """A change whose mechanism turns as asked by its geometry, corrected by what the exact least angle lacks."""
    for _attempt in range(TIGHTENINGS):
        try:
            mechanism = search.candidates.mechanism(change)
            after = rotatability(mechanism)
        except CentrodeError:
            return None
        if turns_well(after, least_angle):
            return change, mechanism, after
        lack = search.target - sin(_reached(after)) ** 2 if after.turns_fully else 0.1 * search.target
        change = search.raised(change, max(lack, 0.0) + 1e-9 * search.target)
    return None


def _changes(varying: Sequence[Varying], change: Any) -> tuple[Change, ...]:
    return tuple(
        Change(one.path, one.before, one.before + float(x) * one.scale, one.unit, float(x))
        for one, x in zip(varying, change, strict=True)
    )
