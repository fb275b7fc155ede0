"""What decides while the initial position is assembled: turns by the description, bounds, one side of a group."""

from __future__ import annotations

from math import tau
from typing import Any, TypeAlias

import numpy as np

from centrode.algebra.rounding import ROUNDED, SAFETY, Rounded
from centrode.errors import InputError
from centrode.kinematics.closure import shortfall
from centrode.kinematics.evaluate import Hooks, Kinematics
from centrode.locale import _
from centrode.structure.assur import name_of
from centrode.structure.constraints import Positions
from centrode.structure.groups import Group

Number: TypeAlias = Any


class Starting(Hooks):
    """Angles in the turn that the description names; of what is no link in (-pi, pi]."""

    def __init__(self, kinematics: Kinematics) -> None:
        self.links = kinematics.structure.mechanism.links

    def continued(self, group: int, key: str, angle: Number) -> Number:
        near = self.links[key].angle if key in self.links else None
        value = float(angle.value if isinstance(angle, Rounded) else angle)
        return angle if near is None else angle + tau * np.round((near - value) / tau)


class Bounding(Starting):
    """A group with rounding bounds: keeps that of its radicand, refuses a divisor that may be zero."""

    def __init__(self, kinematics: Kinematics, group: Group, sign: float) -> None:
        super().__init__(kinematics)
        self.solved = group
        self.sign = sign
        self.bound = 0.0

    def root(self, group: int, radicand: Number) -> Number:
        self.bound = float(np.max(Rounded.of(radicand).bound))  # one place, as an array or not
        return ROUNDED.sqrt(radicand) * self.sign

    def divisor(self, group: int, divisor: Number) -> Number:
        sine = Rounded.of(divisor)
        if abs(sine.value) <= SAFETY * sine.bound:
            raise undetermined(self.solved)
        return sine


class OneSide(Starting):
    """One of a group's two assemblies; refused if it falls short of closing."""

    def __init__(
        self, kinematics: Kinematics, group: Group, known: Positions, sign: float, bound: float
    ) -> None:
        super().__init__(kinematics)
        self.kinematics = kinematics
        self.solved = group
        self.known = known
        self.sign = sign
        self.bound = bound

    def root(self, group: int, radicand: Number) -> Number:
        if radicand < -SAFETY * self.bound:
            raise InputError(
                name_of(self.solved),
                _("it does not close in the initial position: {by_how_much}").format(
                    by_how_much=shortfall(self.solved, self.kinematics.numbers, self.known)
                ),
                _("change a length, or the initial position"),
            )
        return self.sign * np.sqrt(max(radicand, 0.0))


def undetermined(group: Group) -> InputError:
    """The refusal of a group whose initial position its formulas do not determine."""
    return InputError(
        name_of(group),
        _(
            "the initial position is undetermined there: two of its points coincide, or its lines are parallel"
        ),
        _("start the drive elsewhere, or change the dimensions"),
    )
