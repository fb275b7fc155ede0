"""Friction by coefficients in a free motion: sizes that reactions make which depend on them, at one state.

The reaction of a joint is straight in the forces f of friction, r = r_0 + G f, and so is f = -s c (w r) where the
weights w of what presses are known: the sign of a normal force, the direction of the force of a pin. Signs are modes of
the motion, between whose events they stay; directions follow by Newton's method from those of the step before, whose
correction is to take the weights of the last reaction. (F. Pfeiffer and C. Glocker, Multibody Dynamics with Unilateral
Contacts, 1996, chapter 6; for guides that press from both sides: B. Brogliato, Nonsmooth Mechanics, 3rd ed., 2016,
section 5.6.)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

from centrode.dynamics.forward_dynamics.contacts import Contact, ContactMode
from centrode.dynamics.forward_dynamics.elimination import is_zero, times

Number: TypeAlias = Any
Namespace: TypeAlias = Any
Pair: TypeAlias = tuple[Number, Number]

CORRECTIONS = 4
"""Of directions: from a step away each doubles the digits."""
UNSETTLED = 1e-14
"""Square of the last correction [rad^2] above which directions have not been found."""


@dataclass(frozen=True)
class PressedJoint:
    """A joint with friction by a coefficient at one state.

    Attributes
    ----------
    contact, mode : whose friction it is
    base : its reaction without friction by coefficients [N or N m]
    gains : number of a contact -> what a unit of that one's force adds to it
    """

    contact: Contact
    mode: ContactMode
    base: tuple[Number, ...]
    gains: Mapping[int, tuple[Number, ...]]

    @property
    def factor(self) -> Number:
        """Force over what presses, with the sense in which it slips; zero where it sticks."""
        assert self.contact.pressing is not None
        return times(self.mode.sense, self.contact.pressing.kinetic)

    def parts(self, reaction: Sequence[Number]) -> Pair:
        """The two numbers of a reaction [N] that count where it slips."""
        assert self.contact.pressing is not None
        return self.contact.pressing.parts(reaction, self.mode.sense, self.contact.pressing.kinetic)

    def reaction(self, forces: Mapping[int, Number]) -> tuple[Number, ...]:
        """Its reaction at forces of friction."""
        found = []
        for j, base in enumerate(self.base):
            total = base
            for number, gain in self.gains.items():
                term = times(gain[j], forces[number])
                if not is_zero(term):
                    total = term if is_zero(total) else total + term
            found.append(total)
        return tuple(found)


class FoundFriction(NamedTuple):
    """Friction at one state, by the numbers of contacts.

    Attributes
    ----------
    forces : along their coordinates [N or N m]
    reactions : of their joints with them
    weights : of what presses
    unsettled : sum of the squares of the last corrections of directions [rad^2]
    """

    forces: dict[int, Number]
    reactions: dict[int, tuple[Number, ...]]
    weights: dict[int, Pair]
    unsettled: Number


def friction_forces(m: Namespace, joints: Mapping[int, PressedJoint]) -> FoundFriction:
    """Friction that fits the reactions; directions are corrected as often as they need from those of a step before."""
    weights: dict[int, Pair] = {k: (joint.mode.first, joint.mode.second) for k, joint in joints.items()}
    turning = [k for k, joint in joints.items() if _is_round(joint)]
    forces, reactions = _at_weights(joints, weights)
    for _correction in range(CORRECTIONS if turning else 0):
        for k in turning:
            weights[k] = _direction(m, reactions[k])
        forces, reactions = _at_weights(joints, weights)
    unsettled: Number = 0.0
    for k in turning:
        x, y = _direction(m, reactions[k])
        unsettled = unsettled + (x - weights[k][0]) ** 2 + (y - weights[k][1]) ** 2
        weights[k] = x, y
    return FoundFriction(forces, reactions, weights, unsettled)


def _is_round(joint: PressedJoint) -> bool:
    return joint.contact.pressing is not None and joint.contact.pressing.is_round


def _direction(m: Namespace, reaction: Sequence[Number]) -> Pair:
    """The unit vector along a reaction; nothing of none."""
    x, y = reaction
    square = x * x + y * y
    length = m.sqrt(m.where(m.less(0.0, square), square, 1.0))
    return x / length, y / length


def _at_weights(
    joints: Mapping[int, PressedJoint], weights: Mapping[int, Pair]
) -> tuple[dict[int, Number], dict[int, tuple[Number, ...]]]:
    """Solution f of f + s c w (r_0 + G f) = 0."""
    matrix: dict[tuple[int, int], Number] = {}
    right: dict[int, Number] = {}
    for k, joint in joints.items():
        first, second = weights[k]

        def press_along_weights(
            reaction: Sequence[Number], joint: PressedJoint = joint, w: Pair = (first, second)
        ) -> Number:
            x, y = joint.parts(reaction)
            one, other = times(w[0], x), times(w[1], y)
            return other if is_zero(one) else one if is_zero(other) else one + other

        right[k] = -times(joint.factor, press_along_weights(joint.base))
        for number, gain in joint.gains.items():
            matrix[k, number] = times(joint.factor, press_along_weights(gain))
        matrix[k, k] = 1.0 + matrix[k, k]
    forces = _solve(list(joints), matrix, right)
    return forces, {k: joint.reaction(forces) for k, joint in joints.items()}


def _solve(
    order: Sequence[int], matrix: dict[tuple[int, int], Number], right: dict[int, Number]
) -> dict[int, Number]:
    """Elimination in this order: diagonals prevail where friction has one solution."""
    for at, k in enumerate(order):
        for i in order[at + 1 :]:
            if is_zero(matrix[i, k]):
                continue
            share = matrix[i, k] / matrix[k, k]
            for j in order[at + 1 :]:
                matrix[i, j] = matrix[i, j] - times(share, matrix[k, j])
            right[i] = right[i] - times(share, right[k])
    found: dict[int, Number] = {}
    for at in range(len(order) - 1, -1, -1):
        k = order[at]
        rest = right[k]
        for j in order[at + 1 :]:
            rest = rest - times(matrix[k, j], found[j])
        found[k] = rest / matrix[k, k]
    return found


def greatest_press(m: Namespace, contact: Contact, reaction: Sequence[Number], sense: Number) -> Number:
    """The most [N or N m] that a contact holds which would slip in a sense."""
    assert contact.pressing is not None
    x, y = contact.pressing.parts(reaction, sense, contact.pressing.static)
    return contact.pressing.static * pressing_force(m, contact, x, y)


def pressing_force(m: Namespace, contact: Contact, x: Number, y: Number) -> Number:
    """What presses [N]: the length of the two numbers of a reaction, or the greater of them."""
    assert contact.pressing is not None
    if contact.pressing.is_round:
        square = x * x + y * y
        positive = m.less(0.0, square)
        return m.where(positive, m.sqrt(m.where(positive, square, 1.0)), 0.0)
    return m.abs(x) if is_zero(y) else m.max(m.abs(x), m.abs(y))


def mode_margin(m: Namespace, joint: PressedJoint, reaction: Sequence[Number]) -> Number:
    """By how much the number that presses a slider is greater than any other [N]: it changes where that is zero."""
    x, y = joint.parts(reaction)
    first, second = joint.mode.first, joint.mode.second
    if is_zero(y):
        return first * x
    one, other = first * x, second * y
    tilts = m.less(0.5, m.abs(second))
    own = m.where(tilts, other, one)
    return m.min(own, own - m.where(tilts, m.abs(x), m.abs(y)))


def uniqueness(m: Namespace, joints: Mapping[int, PressedJoint]) -> Number:
    """The least pivot of I - B, B being the most that forces of friction add to each other: one solution if positive.

    With one contact that slips there are none or several where it is not positive; with more there may be.
    """
    order = list(joints)
    matrix: dict[tuple[int, int], Number] = {}
    for k, joint in joints.items():
        for number, gain in joint.gains.items():
            x, y = joint.parts(gain)
            # what sticks feeds nothing
            slips = m.abs(joint.mode.sense)
            matrix[k, number] = -(m.abs(joint.factor) * pressing_force(m, joint.contact, x, y)) * slips
        matrix[k, k] = 1.0 + matrix[k, k]
    least: Number = 1.0
    for at, k in enumerate(order):
        pivot = matrix[k, k]
        least = m.min(least, pivot)
        safe = m.where(m.less(0.0, pivot), pivot, 1.0)
        for i in order[at + 1 :]:
            share = matrix[i, k] / safe
            for j in order[at + 1 :]:
                matrix[i, j] = matrix[i, j] - share * matrix[k, j]
    return least
