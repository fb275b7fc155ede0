"""How wheels mesh: the constants of gears and rolling contacts, from the initial angles of the description.

A gear gives the angle of a link; where that link stands initially is what its own `angle` says, else zero. A wheel
that is turned by something else, and so puts its centre or its track somewhere, starts at the line's own point.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.errors import InputError
from centrode.kinematics.evaluate import Choices, Kinematics
from centrode.kinematics.higher_class.guesses import guesses
from centrode.kinematics.turned_links import turn_link
from centrode.kinematics.wheels import equation_at
from centrode.locale import _
from centrode.structure.assur import name_of
from centrode.structure.constraints import (
    Constraint,
    Entity,
    GearRatio,
    Meshing,
    NoSlip,
    Positions,
    Standing,
    angle_links,
    identity_of,
    phase_of,
)
from centrode.structure.groups import (
    AngleEquation,
    AngleGiven,
    Arm,
    Group,
    Meet,
    Meshed,
    Newton,
    Rolloff,
    Train,
    TurnedLink,
    Turning,
)
from centrode.structure.rank import columns_of, independent_rows, match

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


def with_phases(kinematics: Kinematics, phases: Mapping[str, float]) -> Kinematics:
    """The same plan with constants of gears and rolling contacts added to its numbers."""
    if not phases:
        return kinematics
    numbers = kinematics.numbers
    return replace(kinematics, numbers=replace(numbers, gearing=numbers.gearing.with_phases(phases)))


def phases_before(kinematics: Kinematics, group: Group, at: Positions, choices: Choices) -> dict[str, float]:
    """Constants that a group needs before it is solved in the initial position."""
    if isinstance(group, Train):
        return _of_train(kinematics, group, at, choices)
    if not isinstance(group, (TurnedLink, Meet)):
        return {}
    found: dict[str, float] = {}
    link = group.link if isinstance(group, TurnedLink) else group.carriage
    if link is not None and group.turning is not None and not isinstance(group.turning, Turning):
        meshing = group.turning.gear if isinstance(group.turning, Meshed) else group.turning.rolling
        trial = at.copied()
        trial.angles[link] = stated_angle(kinematics, link)
        found[identity_of(meshing)] = float(phase_of(meshing, ARRAYS, kinematics.numbers, trial))
    if isinstance(group, Meet):
        for locus in group.loci:
            if isinstance(locus, Rolloff):
                ahead = with_phases(kinematics, found)
                found[locus.rolling.rolling] = _turn_at_start(ahead, group, locus.rolling, at, choices)
    return found


def phases_after(kinematics: Kinematics, at: Positions) -> dict[str, float]:
    """Constants of what no group needed: gears and rolling contacts that repeat others."""
    known = kinematics.numbers.gearing.phase
    return {
        identity_of(c): float(phase_of(c, ARRAYS, kinematics.numbers, at))
        for c in kinematics.structure.constraints
        if isinstance(c, Meshing) and identity_of(c) not in known
    }


def phases_in(kinematics: Kinematics, group: Newton, at: Positions) -> dict[str, float]:
    """Constants of the gears and rolling contacts in a group of higher class that stands in its initial position."""
    return {
        identity_of(c): float(phase_of(c, ARRAYS, kinematics.numbers, at))
        for c, _row in group.equations
        if isinstance(c, Meshing)
    }


def standing_links(kinematics: Kinematics, group: Newton, at: Positions) -> Newton:
    """A group of higher class in which links stand at their initial angles instead of meshing.

    Of the links that an equation between angles could give, the first is taken that nothing else gives: the
    second wheel of a gear, the wheel that rolls, else any link of the group.
    """
    meshing = [c for c, _row in group.equations if isinstance(c, Meshing)]
    if not meshing:
        return group
    entities = [Entity("point", name) for name in group.points] + [
        Entity("link", name) for name in group.links
    ]
    first, width = columns_of(entities)
    guess = guesses(kinematics.structure.mechanism, kinematics.numbers, group, at)[0]
    kept = [equation for equation in group.equations if not isinstance(equation[0], Meshing)]

    def row(equation: tuple[Constraint, int]) -> Array:
        constraint, which = equation
        found = np.zeros(width)
        for entity, slopes in constraint.rows(kinematics.numbers, guess)[which].items():
            if entity in first:
                found[first[entity] : first[entity] + entity.unknowns] += slopes
        return found

    rows = [row(equation) for equation in kept]
    for constraint in meshing:
        wanted = [link for link in angle_links(constraint) if link in group.links]
        for link in dict.fromkeys([*wanted, *group.links]):
            standing: tuple[Constraint, int] = (Standing(link, stated_angle(kinematics, link)), 0)
            if independent_rows(np.array([*rows, row(standing)]))[-1]:
                rows.append(row(standing))
                kept.append(standing)
                break
    return replace(group, equations=tuple(kept))


def stated_angle(kinematics: Kinematics, link: str) -> float:
    """Initial angle of a link [rad]; zero where the description gives none."""
    return kinematics.structure.mechanism.initial_angle(link) or 0.0


def _turn_at_start(
    kinematics: Kinematics, group: Meet, rolling: NoSlip, at: Positions, choices: Choices
) -> float:
    """Angle of a wheel against its track in the initial position, where its centre is at the line's own point."""
    trial = at.copied()
    link = group.carriage
    if link is not None and group.turning is not None:
        rotor = turn_link(group.turning, link, ARRAYS, kinematics.numbers, trial, choices.continued)
        if link not in trial.angles:
            trial.angles[link] = choices.continued(link, np.arctan2(rotor[1], rotor[0]))
    return float(trial.angles[rolling.link] - trial.angles[rolling.on])


def _of_train(kinematics: Kinematics, group: Train, at: Positions, choices: Choices) -> dict[str, float]:
    """Constants of a train's equations: each lets one link of its own stand at its initial angle."""
    bearing = {equation: meshing for equation in group.equations if (meshing := _meshing(equation))}
    blank = with_phases(kinematics, {identity_of(meshing): 0.0 for meshing in bearing.values()})
    rows = {
        equation: equation_at(equation, ARRAYS, blank.numbers, at, choices.continued)
        for equation in group.equations
    }
    owner = match(
        {e: _preferred(kinematics, e, rows[e][0], group) for e in sorted(rows, key=lambda e: e in bearing)}
    )
    matrix, right = np.zeros((len(rows), len(rows))), np.zeros(len(rows))
    for k, (link, equation) in enumerate(owner.items()):
        if equation in bearing:
            matrix[k, group.links.index(link)] = 1.0
            right[k] = stated_angle(kinematics, link)
        else:
            factors, value = rows[equation]
            right[k] = float(value)
            for name, factor in factors.items():
                if name in group.links:
                    matrix[k, group.links.index(name)] = factor
                else:
                    right[k] -= factor * float(at.angles[name])
    try:
        angles = dict(zip(group.links, np.linalg.solve(matrix, right).tolist(), strict=True))
    except np.linalg.LinAlgError:
        raise InputError(
            name_of(group),
            _("its initial angles do not say how the wheels mesh"),
            _("give the initial angle of: {links}").format(links=", ".join(group.links)),
        ) from None
    everything = {**at.angles, **angles}
    return {
        identity_of(meshing): float(
            sum(factor * everything[name] for name, factor in rows[equation][0].items()) - rows[equation][1]
        )
        for equation, meshing in bearing.items()
    }


def _meshing(equation: AngleEquation) -> Meshing | None:
    if isinstance(equation, AngleGiven):
        return None
    return equation.rolling if isinstance(equation, Arm) else equation


def _preferred(
    kinematics: Kinematics, equation: AngleEquation, factors: Mapping[str, Number], group: Train
) -> list[str]:
    """Links whose initial angle an equation may rest on: those that state one, then the second wheel first."""
    own = [link for link, factor in factors.items() if link in group.links and factor != 0.0]
    if isinstance(equation, GearRatio):
        own.sort(key=lambda link: (equation.second, equation.first, equation.carrier).index(link))
    links = kinematics.structure.mechanism.links
    return sorted(own, key=lambda link: links[link].angle is None)
