"""Loads as efforts: amounts along coordinates, and how great they are in a state."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np

from centrode.dynamics.amounts import Amount, Diagram, Situation
from centrode.dynamics.coordinates import Coordinate
from centrode.dynamics.pulls import Pull
from centrode.dynamics.states import State
from centrode.errors import InputError
from centrode.kinematics.paths import JETS
from centrode.locale import _

Number: TypeAlias = Any

REST = 64.0 * 2.0**-52
"""A speed counts as zero within this share of what rounding can make of it."""


@dataclass(frozen=True)
class Effort:
    """A load's amount along a coordinate; with a `gate` only where that coordinate grows in time.

    It `works` along another coordinate where the source of a formula has it so, against virtual work.
    """

    coordinate: Coordinate
    amount: Amount
    gate: Coordinate | None = None
    works: Coordinate | None = None

    def strength(self, state: State) -> Number:
        """The force [N] or moment [N m] itself."""
        slope = self.coordinate.slope(state).value
        q = np.nan if len(state.mechanism.drives) > 1 else state.parameter
        x, v = self.coordinate.value(state), slope * state.rate
        sense = self._sense(state, v) if self.amount.sensed else 0.0
        now = Situation(state.time, q, x, v, sense, state.m.base)
        amount = self.amount(now)
        if self.gate is None:
            return amount
        if state.m is JETS:
            return np.where(grows(self.gate, state), amount, 0.0)
        speed = self.gate.slope(state).value * state.rate
        return state.m.base.where(state.m.base.less(speed, 0.0), 0.0, amount)

    @property
    def switches(self) -> tuple[Coordinate, ...]:
        """Coordinates at whose turning points the amount may jump."""
        found = (self.gate,) if self.gate is not None else ()
        return (*found, self.coordinate) if self.amount.jumps else found

    @property
    def needs_law(self) -> bool:
        """Whether it depends on how the drive moves in time, and not only on the sense of that."""
        return bool(self.amount.uses & {"t", "v"})

    def along(self, state: State) -> Number:
        """Derivative by the parameter of what it works along."""
        return (self.coordinate if self.works is None else self.works).slope(state).value

    def pulls(self, state: State) -> tuple[Pull, ...]:
        """What one unit of it does to points and links."""
        return (self.coordinate if self.works is None else self.works).pulls(state)

    def _sense(self, state: State, speed: Number) -> Number:
        if state.m is not JETS:
            return state.m.base.sign(speed)
        return np.sign(_going(self.coordinate, state))


def grows(coordinate: Coordinate, state: State) -> Number:
    """Where a coordinate grows in time; where it turns, `state.side` decides."""
    return _going(coordinate, state) >= 0.0


def _going(coordinate: Coordinate, state: State) -> Number:
    """A number with the sign of a coordinate's speed; where it turns that on `state.side`, zero at the place itself."""
    slope = coordinate.slope(state)
    speed, bend = slope.value * state.rate, slope.derivative(1) * state.rate
    reach = np.maximum(1.0, np.abs(state.parameter))
    with np.errstate(invalid="ignore"):
        rest = np.abs(slope.value) <= REST * (np.abs(slope.derivative(1)) * reach + state.scale)
    return np.where(rest, bend * state.side, speed)


@dataclass(frozen=True)
class Acting:
    """A load with the efforts it is made of."""

    label: str
    efforts: tuple[Effort, ...]
    where: str = field(default="", compare=False)

    def moment(self, state: State, known: Number) -> Number:
        """Its reduced moment, or generalised force, by the parameter of the state.

        Raises InputError where it has no finite amount although the positions are `known`.
        """
        return self.along(state, self.strengths(state, known))

    def strengths(self, state: State, known: Number) -> list[Number]:
        """How great each effort is [N or N m]; raises InputError as `moment` does."""
        found = [effort.strength(state) for effort in self.efforts]
        for effort, strength in zip(self.efforts, found, strict=True):
            lacking = known & ~np.isfinite(strength)
            if np.any(lacking):
                raise self._refusal(effort, state, lacking)
        return found

    def _refusal(self, effort: Effort, state: State, lacking: Number) -> InputError:
        """Why an effort has no amount at the first of the samples that lack one."""

        def first(values: Number) -> float:
            return float(np.broadcast_to(values, lacking.shape)[lacking].flat[0])

        if isinstance(effort.amount, Diagram):
            return effort.amount.refusal(first(effort.coordinate.value(state)))
        what = _("it has no finite value at {value:.6g}").format(value=first(state.parameter))
        return InputError(self.where, what, _("correct its formula"))

    def along(self, state: State, strengths: Sequence[Number]) -> Number:
        """What efforts of these strengths do along the parameter of a state: the sum of strength times slope."""
        pairs = zip(self.efforts, strengths, strict=True)
        return sum(strength * effort.along(state) for effort, strength in pairs)
