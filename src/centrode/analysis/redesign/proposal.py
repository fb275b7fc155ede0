"""The repair that a report proposes: what the assignment itself changes, before other dimensions, in few digits.

Initial angles are the data of an assignment whose frame they place, and its source changes these: first one of them is
sought alone, then several together. Lengths and distances follow in the same order. Every dyad keeps the first of
`LEAST_ANGLES` that is within reach, or the angle that is named.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import floor, log10, sin
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from centrode.analysis.redesign.candidates import Candidates, paths_of_lengths, places_anew, varyings
from centrode.analysis.redesign.repair import (
    FINE,
    Change,
    Repair,
    least,
    least_angle_of,
    over_turn,
    repair,
    squared_sines,
    turns_well,
)
from centrode.analysis.redesign.single_changes import (
    Dimension,
    SingleChanges,
    dimensions_of_design,
)
from centrode.analysis.rotatability.rotatability import rotatability
from centrode.errors import CentrodeError
from centrode.kinematics.motion import motion
from centrode.kinematics.preparation import ready
from centrode.model.files import with_values
from centrode.model.placement import replace_placed
from centrode.model.settings import shown_as

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism

Array = npt.NDArray[np.float64]

SHARE = 0.05
"""Share of a value up to which it is rounded."""
FINER = 4
"""How often a step of rounding is divided by ten where the rounded values are not good enough."""
MOST_ROUNDED = 6
"""Numbers that are rounded up and down in every combination; of more each is rounded to the nearest."""
WITHIN = 1e-12
"""By how much a scaled change may exceed its bound: the rounding of the scale."""
DIGITS = 12
"""Digits of rounded values in SI: no more are meant."""


@dataclass(frozen=True)
class ProposedRepair:
    """The repaired mechanism of a report.

    Attributes
    ----------
    mechanism, repaired : the one given, and the one proposed
    dimensions, changes : what is changed, and its values before and after
    wanted : transmission angle [rad] that every dyad should keep
    angle : the one that it keeps at least: the first of `LEAST_ANGLES` within reach, or the one named [rad]
    least_angle : the exact least one of the repaired mechanism [rad]
    greatest : the greatest within reach, where that is less than the one wanted; else None [rad]
    residual : worst residual of the motion of the repaired mechanism, over its greatest length
    several : the search for several changes, where one alone was not good enough
    """

    mechanism: Mechanism
    repaired: Mechanism
    dimensions: tuple[Dimension, ...]
    changes: tuple[Change, ...]
    wanted: float
    angle: float
    least_angle: float
    greatest: float | None
    residual: float
    several: Repair | None = None


def propose(found: SingleChanges) -> ProposedRepair | None:
    """The repair to propose of a mechanism that locks; None where none was found.

    Examples
    --------
    >>> import centrode as ct
    >>> from centrode.analysis.redesign.proposal import propose
    >>> from centrode.analysis.redesign.single_changes import single_changes
    >>> proposed = propose(single_changes(ct.example("slider-between-cranks-locked")))
    >>> {change.path: change.after for change in proposed.changes}
    {'links.AC.angle': 0.36, 'links.CB.angle': 4.3, 'links.BD.angle': 5.8}
    """
    best = found.changes[0] if found.changes else None
    kept = found.margin if best is not None else 0.0
    of_data = best is not None and best.dimension.kind == "angle"
    # one initial angle is what the source changes; a length alone stands behind several initial angles
    enough = kept >= found.wanted and (of_data or not places_anew(found.mechanism))
    proposed = None if best is None else _single(found)
    if enough or not found.required.turn:
        return proposed
    several = _several(found)
    if several is None or several.least_transmission_angle <= kept * (1 - 1e-9) or several.repaired is None:
        return proposed
    if best is not None and several.least_transmission_angle == kept and not places_anew(found.mechanism):
        return proposed
    return _rounded_repair(several, found.greatest_change)


def _single(found: SingleChanges) -> ProposedRepair:
    best = found.changes[0]
    change = Change(best.dimension.path, best.before, best.after, best.unit, best.size)
    return ProposedRepair(
        found.mechanism,
        best.repaired,
        (best.dimension,),
        (change,),
        found.wanted,
        found.margin,
        best.least_angle,
        found.greatest,
        best.residual,
    )


def _several(single: SingleChanges) -> Repair | None:
    """The change of all initial angles, or of all lengths; of both where that is not enough."""
    mechanism = single.mechanism
    named = single.wanted if single.named else None
    found = []
    paths: list[list[str] | None] = [None]
    if places_anew(mechanism):
        paths.append([*_angles(mechanism), *paths_of_lengths(mechanism).values()])
    for vary in paths:
        try:
            one = repair(mechanism, vary, None, named, greatest_change=single.greatest_change)
        except CentrodeError:
            continue
        if one.found and one.least_transmission_angle >= single.wanted:
            return one
        found.append(one)
    good = [one for one in found if one.found]
    return max(good, key=lambda one: one.least_transmission_angle, default=None)


def _angles(mechanism: Mechanism) -> list[str]:
    return [one.path for one in dimensions_of_design(mechanism) if one.kind == "angle"]


def _rounded_repair(several: Repair, greatest_change: float | None) -> ProposedRepair | None:
    """The same change in as few digits as keep the transmission angle."""
    mechanism = several.mechanism
    prepared = ready(mechanism)
    paths = [change.path for change in several.changes]
    candidates = Candidates(prepared, varyings(prepared, paths, None, greatest_change))
    for values in _roundings(several, candidates, bounded=greatest_change is not None):
        repaired = with_values(
            mechanism, {change.path: value for change, value in zip(several.changes, values, strict=True)}
        )
        repaired = replace_placed(repaired) if places_anew(mechanism) else repaired
        made = _verified_repair(several, repaired, values)
        if made is not None:
            return made
    assert several.repaired is not None
    return _verified_repair(several, several.repaired, [change.after for change in several.changes])


def _roundings(several: Repair, candidates: Candidates, *, bounded: bool) -> Iterator[list[float]]:
    """Rounded values that keep the angle on the nodes of the turn, the coarsest digits first, small changes first.

    `bounded` ones stay within the greatest change.
    """
    if not places_anew(several.mechanism):
        return  # sides and angles of the new position belong to the exact numbers
    target = sin(several.least_transmission_angle) ** 2
    for finer in range(FINER):
        choices = [_choices(change, several, finer) for change in several.changes]
        if len(choices) > MOST_ROUNDED:
            choices = [one[:1] for one in choices]
        values = np.array(list(product(*choices)))
        scaled = np.column_stack(
            [
                (column - one.before) / one.scale
                for column, one in zip(values.T, candidates.varying, strict=True)
            ]
        )
        batch = candidates.batch(scaled)
        good = least(squared_sines(batch, over_turn(batch, FINE))) >= target
        if bounded:
            low, high = candidates.box()
            good &= ((scaled >= low - WITHIN) & (scaled <= high + WITHIN)).all(axis=1)
        order = np.argsort(np.linalg.norm(scaled, axis=1), kind="stable")
        yield from (values[k].tolist() for k in order[good[order]][:1])


def _choices(change: Change, several: Repair, finer: int) -> list[float]:
    """The value rounded to the nearest and away from it, and the present one where it lies within the step."""
    factor, _unit = shown_as(change.unit, several.mechanism.display)
    shown = factor * change.after
    step = 10.0 ** (floor(log10(SHARE * abs(shown))) - finer) if shown else 10.0**-finer
    steps = shown / step
    whole = sorted((np.floor(steps), np.ceil(steps)), key=lambda one: abs(one - steps))
    values = [float(f"{float(one) * step / factor:.{DIGITS}g}") for one in dict.fromkeys(whole)]
    if abs(change.after - change.before) < step / factor:
        values.append(change.before)
    return values


def _verified_repair(several: Repair, repaired: Mechanism, values: Sequence[float]) -> ProposedRepair | None:
    """The proposal, assembled at every sample and analysed; None where it does not keep the angle."""
    try:
        after, course = rotatability(repaired), motion(repaired)
    except CentrodeError:
        return None
    if not turns_well(after, several.least_transmission_angle):
        return None
    known = {one.path: one for one in dimensions_of_design(several.mechanism)}
    changes = [
        replace(change, after=value, size=change.size)
        for change, value in zip(several.changes, values, strict=True)
    ]
    changed = tuple(one for one in changes if one.after != one.before)
    return ProposedRepair(
        several.mechanism,
        repaired,
        tuple(known[one.path] for one in changed),
        changed,
        several.wanted,
        several.least_transmission_angle,
        least_angle_of(after),
        several.greatest,
        float(course.attrs["worst_residual"]),
        several,
    )
