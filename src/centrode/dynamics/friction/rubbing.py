"""Friction at the samples of a motion: as great as reactions make it that depend on it themselves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.friction.contacts import Bearing, Contact
from centrode.dynamics.friction.following import EPSILON, Followed, Law, Outcome, Rule, followed
from centrode.dynamics.kinetostatics.sides import Side, side_forces
from centrode.dynamics.kinetostatics.solution import Forces, Kinetostatics
from centrode.dynamics.kinetostatics.stacking import column
from centrode.dynamics.loads import REST
from centrode.dynamics.pulls import Pull, couple
from centrode.dynamics.states import State
from centrode.structure.constraints import Constraint, NoTurning, PointOnGuide

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Codes: TypeAlias = npt.NDArray[np.int8]
Number: TypeAlias = Any


@dataclass(frozen=True)
class Size:
    """One size of friction: the moment in a bearing, the force along a guide, or the moment of that about its line.

    Attributes
    ----------
    pulls : what a size of one does
    factor : size over measure, without the sense of the motion
    """

    contact: Contact
    pulls: tuple[Pull, ...]
    factor: float
    rule: Rule


@dataclass(frozen=True)
class Rubbed:
    """Friction of all contacts.

    Attributes
    ----------
    amounts : (n, contacts)
        Moment on the link [N m], or force on the slider [N] along the guide's direction.
    arms : (n, contacts)
        Moment on the slider that the height of a slider brings with it [N m].
    slopes : (n, contacts)
        Derivative of what rubs by the path's parameter; 0 where it turns round.
    turns : (n, contacts)
        Where a contact stands for an instant: what is told holds just after it.
    standing : labels of contacts that do not move
    """

    contacts: tuple[Contact, ...]
    sizes: tuple[Size, ...]
    solution: Followed
    amounts: Array
    arms: Array
    slopes: Array
    turns: Mask
    standing: tuple[str, ...]

    @property
    def pulls(self) -> list[Pull]:
        """Friction as forces and moments on links and pins."""
        found = self.solution.sizes
        return [
            pull.times(found[None, :, k].copy()) for k, size in enumerate(self.sizes) for pull in size.pulls
        ]

    @property
    def moment(self) -> Array:
        """What friction does along the path's parameter (n)."""
        return np.asarray((self.amounts * self.slopes).sum(axis=1))


def rubbed(
    state: State, free: Forces, contacts: Sequence[Contact], acceleration: Array, useful: Mask
) -> Rubbed:
    """Friction of the contacts, from the reactions without it, at the samples where these are of use."""
    system = free.system
    motions = [_motion(contact, state, system, acceleration) for contact in contacts]
    senses = np.stack([sense for sense, _slope, _turns in motions], axis=1)
    slopes = np.stack([slope for _sense, slope, _turns in motions], axis=1)
    turns = np.stack([turn for _sense, _slope, turn in motions], axis=1)
    sizes = [size for contact in contacts for size in _sizes(contact, state)]
    owner = [contacts.index(size.contact) for size in sizes]
    solution = _where_known(_law(free, sizes, senses[:, owner]), useful)
    amounts, arms = np.zeros(senses.shape), np.zeros(senses.shape)
    for k, size in enumerate(sizes):
        (arms if size.rule is Rule.FIRST else amounts)[:, owner[k]] += solution.sizes[:, k]
    still = tuple(c.label for c, sense in zip(contacts, senses.T, strict=True) if not np.any(sense))
    return Rubbed(tuple(contacts), tuple(sizes), solution, amounts, arms, slopes, turns, still)


def _motion(
    contact: Contact, state: State, system: Kinetostatics, acceleration: Array
) -> tuple[Array, Array, Mask]:
    """Sense of what rubs (1, -1, or 0 where it does not move), its derivative, and where it turns round.

    At an instant where it turns, the sense is the one it goes on with.
    """
    jet = contact.motion.slope(state)
    samples = len(state.parameter)
    slope, bend = column(jet.value, samples), column(jet.derivative(1), samples)
    unit = max(1.0, state.scale)
    reach = np.maximum(1.0, np.abs(state.parameter))
    condition = system.inverse.condition[0]
    with np.errstate(all="ignore"):
        noise = REST * (np.abs(bend) * reach + unit) + EPSILON * condition * unit
        rest = ~(np.abs(slope) > noise)
        bends = np.abs(bend) > noise + EPSILON * condition**2 * unit
        speed = np.where(rest, 0.0, slope) * state.rate
        # where the drive itself stands, it is about to move as it is accelerated
        onward = np.where(rest, np.where(bends, bend, 0.0) * state.rate**2, slope * acceleration)
        sense = np.sign(np.where(speed == 0.0, onward, speed))
    sense = np.where(np.isfinite(sense), sense, 0.0)
    return sense, np.where(rest, 0.0, slope), (speed == 0.0) & (sense != 0.0)


def _sizes(contact: Contact, state: State) -> list[Size]:
    pulls = contact.motion.pulls(state)
    if isinstance(contact, Bearing):
        return [Size(contact, pulls, contact.coefficient * contact.radius, Rule.LENGTH)]
    found = [Size(contact, pulls, contact.coefficient, Rule.GREATER)]
    if contact.link is not None and contact.height:
        # the faces that bear lie half the height beside the line, on the side the force comes from
        arm = couple(contact.link, 1.0), couple(contact.on, -1.0)
        found.append(Size(contact, arm, 0.5 * contact.coefficient * contact.height, Rule.FIRST))
    return found


def _law(free: Forces, sizes: Sequence[Size], senses: Array) -> Law:
    samples, count = len(senses), len(sizes)
    gain = np.empty((samples, count, 2, count))
    for k, size in enumerate(sizes):
        gain[..., k] = _measured(free.system.forces(size.pulls), sizes, samples)
    factors = -senses * np.array([size.factor for size in sizes])
    rules = np.array([size.rule for size in sizes], dtype=np.int8)
    return Law(factors, _measured(free, sizes, samples), gain, rules)


def _measured(forces: Forces, sizes: Sequence[Size], samples: int) -> Array:
    """The two numbers (n, sizes, 2) that each size depends on."""
    found = np.zeros((samples, len(sizes), 2))
    for k, size in enumerate(sizes):
        for part, value in enumerate(_pressing(forces, size.contact)):
            found[:, k, part] = column(value, samples)
    return found


def _pressing(forces: Forces, contact: Contact) -> tuple[Number, Number]:
    """Force between pin and bearing; normal force of a guide, and what its moment presses with at both ends."""
    if isinstance(contact, Bearing):
        side = Side(contact.point, contact.link)
        return side_forces(forces, [side])[side]
    constraints = forces.system.scheme.structure.constraints
    normal = next(c for c in constraints if isinstance(c, PointOnGuide) and c.guide == contact.guide)
    if not contact.length:
        return _value(forces, normal), 0.0
    turning = next(c for c in constraints if isinstance(c, NoTurning) and c.guide == contact.guide)
    # N_1, N_2 = N/2 -+ M/l, so that |N_1| + |N_2| is the greater of |N| and 2 |M|/l
    return _value(forces, normal), 2.0 * _value(forces, turning) / contact.length


def _value(forces: Forces, constraint: Constraint) -> Number:
    return forces.multipliers.get((constraint, 0), 0.0)


def _where_known(law: Law, useful: Mask) -> Followed:
    """Solve where all numbers are known; NaN elsewhere."""
    count, width = law.factor.shape
    known = useful & np.isfinite(law.base).all(axis=(1, 2)) & np.isfinite(law.gain).all(axis=(1, 2, 3))
    found = followed(law.at(known))
    sizes, outcome = np.full((count, width), np.nan), np.zeros(count, dtype=np.int8)
    share, residual = np.full(count, np.nan), np.zeros(count)
    sizes[known], outcome[known] = found.sizes, found.outcome
    share[known], residual[known] = found.share, found.residual
    residual[outcome != Outcome.FOUND] = 0.0
    return Followed(sizes, outcome, share, residual, found.tries)
