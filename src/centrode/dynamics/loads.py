"""Loads of a mechanism as efforts: amounts along coordinates."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from math import hypot
from typing import Any, TypeAlias

import numpy as np

from centrode.algebra.arrays import ARRAYS
from centrode.dynamics.amounts import (
    Amount,
    Constant,
    Damper,
    Diagram,
    Formula,
    Friction,
    Situation,
    Square,
    StraightSpring,
    TorsionSpring,
)
from centrode.dynamics.coordinates import Component, Coordinate, Distance, HalfSquare, Slide, Travel
from centrode.dynamics.masses import Given, Mass, centre_of
from centrode.dynamics.states import State
from centrode.dynamics.turning import turning_of
from centrode.errors import InputError, NotComputedYet
from centrode.kinematics.paths import JETS
from centrode.locale import _
from centrode.model.loads import PLAIN_SUM, Load
from centrode.model.mechanism import FRAME, Mechanism

Number: TypeAlias = Any
Namespace: TypeAlias = Any

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

    def _sense(self, state: State, speed: Number) -> Number:
        if state.m is not JETS:
            return state.m.base.sign(speed)
        return np.where(grows(self.coordinate, state), 1.0, -1.0) * (state.rate != 0.0)


def grows(coordinate: Coordinate, state: State) -> Number:
    """Where a coordinate grows in time; where it turns, `state.side` decides."""
    slope = coordinate.slope(state)
    speed, bend = slope.value * state.rate, slope.derivative(1) * state.rate
    reach = np.maximum(1.0, np.abs(state.parameter))
    with np.errstate(invalid="ignore"):
        rest = np.abs(slope.value) <= REST * (np.abs(slope.derivative(1)) * reach + state.scale)
    beside = bend * state.side >= 0.0
    return np.where(rest, beside, speed >= 0.0)


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


def loads_of(
    mechanism: Mechanism, masses: Sequence[Mass], given: Given | None = None, m: Namespace = ARRAYS
) -> tuple[Acting, ...]:
    """Loads of the description, then the weights that gravity adds; each with a label of its own.

    Raises
    ------
    InputError
        A weight without direction or amount.
    NotComputedYet
        Friction by a coefficient.
    """
    labels = _labels(mechanism.loads, mechanism, masses)
    described = [
        Acting(label, tuple(_efforts(mechanism, load, masses, where, given, m)), where)
        for label, load in zip(labels, mechanism.loads, strict=False)
        for where in [f"[[loads]] {label}"]
    ]
    weights = [
        Acting(label, (_weight(mechanism, mass, mass.mass * _strength(mechanism)),), f"[links.{mass.link}]")
        for label, mass in zip(labels[len(described) :], _weighing(mechanism, masses), strict=True)
    ]
    return (*described, *weights)


def _weighing(mechanism: Mechanism, masses: Iterable[Mass]) -> list[Mass]:
    """Links that gravity acts on and whose weight the description does not give itself."""
    if not mechanism.gravity or not _strength(mechanism):
        return []
    given = {load.link for load in mechanism.loads if load.kind == "weight"}
    return [mass for mass in masses if mass.weighs and mass.link not in given]


def _labels(loads: Sequence[Load], mechanism: Mechanism, masses: Iterable[Mass]) -> list[str]:
    names = [load.label for load in loads]
    names += [f"weight {mass.link}" for mass in _weighing(mechanism, masses)]
    found: list[str] = []
    for name in names:
        number, label = 1, name
        while label in found:
            number += 1
            label = f"{name} {number}"
        found.append(label)
    return found


def _efforts(
    mechanism: Mechanism,
    load: Load,
    masses: Sequence[Mass],
    where: str,
    given: Given | None,
    m: Namespace,
) -> Iterable[Effort]:
    if load.kind == "friction":
        return [_friction(mechanism, load, where)]
    if load.kind == "weight":
        return [_given_weight(mechanism, load, masses, where, given, m)]
    if load.kind == "force":
        return _force(load, where)
    if load.kind == "torque":
        amount = _amount(load.value, where)
        return [Effort(turning_of(mechanism, load, where, "x" in amount.uses), amount)]
    return [_between(mechanism, load, where)]


def _force(load: Load, where: str) -> list[Effort]:
    if load.guide is not None:
        amount = Diagram(where, load.table) if load.table is not None else _amount(load.value, where)
        return [Effort(Slide(load.guide), amount)]
    assert load.point is not None
    assert load.vector is not None
    point, axes = load.point, load.axes
    gate = None if load.while_moving is None else Component(point, load.while_moving, axes)
    if all(isinstance(value, float) for value in load.vector):
        vector = tuple(float(value) for value in load.vector)
        size = hypot(*vector)
        return [Effort(Component(point, vector, axes), Constant(size), gate)] if size else []
    count = len(load.vector)
    units = [tuple(float(i == k) for i in range(count)) for k in range(count)]
    return [
        Effort(Component(point, unit, axes), _amount(value, where), gate)
        for unit, value in zip(units, load.vector, strict=True)
        if value != 0.0
    ]


def _friction(mechanism: Mechanism, load: Load, where: str) -> Effort:
    """Friction of a given size: dry, and parts that grow with the speed and its square."""
    if load.coefficient is not None:
        what = _("friction by a coefficient needs the reactions")
        raise NotComputedYet(where, what, _("give value, viscous or quadratic in place of coefficient"))
    dry = _amount(load.value, where)
    if load.guide is not None:
        amount = Friction(dry, load.viscous or 0.0, load.quadratic or 0.0)
        return Effort(Slide(load.guide), amount)
    turn = turning_of(mechanism, load, where, "x" in dry.uses)
    if load.form == PLAIN_SUM:
        if len(mechanism.drives) > 1:
            what = _("the plain sum belongs to mechanisms with one drive")
            raise InputError(where, what, _("take form out: virtual work serves any number of drives"))
        return Effort(turn, Square(load.quadratic or 0.0), works=Travel())
    return Effort(turn, Friction(dry, load.viscous or 0.0, load.quadratic or 0.0))


def _between(mechanism: Mechanism, load: Load, where: str) -> Effort:
    """A spring or a damper, between two points or in a hinge."""
    if load.link is not None:
        turn = turning_of(mechanism, load, where, load.kind == "spring")
        if load.kind == "damper":
            return Effort(turn, Damper(load.damping or 0.0))
        return Effort(turn, TorsionSpring(load.stiffness or 0.0, load.free_angle or 0.0))
    assert load.points is not None
    first, second = load.points
    if load.kind == "damper":
        return Effort(Distance(first, second), Damper(load.damping or 0.0))
    return Effort(HalfSquare(first, second), StraightSpring(load.stiffness or 0.0, load.free_length or 0.0))


def _amount(value: float | str | None, where: str) -> Amount:
    return Formula.of(value, where) if isinstance(value, str) else Constant(value or 0.0)


def _strength(mechanism: Mechanism) -> float:
    return hypot(*mechanism.gravity) if mechanism.gravity else 0.0


def _down(mechanism: Mechanism, where: str) -> tuple[float, ...]:
    if mechanism.gravity is None or not _strength(mechanism):
        what = _("a weight has no direction without gravity")
        example = "[0, 0, -9.81]" if mechanism.space == "sphere" else "[0, -9.81]"
        raise InputError(where, what, _("give gravity, such as gravity = {example}").format(example=example))
    return mechanism.gravity


def _weight(mechanism: Mechanism, mass: Mass, size: Number) -> Effort:
    return Effort(Component(mass.centre, _down(mechanism, mass.link)), Constant(size))


def _given_weight(
    mechanism: Mechanism,
    load: Load,
    masses: Sequence[Mass],
    where: str,
    given: Given | None,
    m: Namespace,
) -> Effort:
    """A weight of its own value, or of mass times gravity, at a link's centre or a point."""
    down = _down(mechanism, where)
    if load.point is not None:
        if load.value is None:
            what = _("a point has no mass of its own")
            raise InputError(where, what, _("give the weight's value, or name a link that has a mass"))
        return Effort(Component(load.point, down, FRAME), _amount(load.value, where))
    assert load.link is not None
    mass = next((mass for mass in masses if mass.link == load.link and mass.weighs), None)
    if load.value is not None:
        at = centre_of(mechanism, load.link, given, m) if mass is None else mass.centre
        return Effort(Component(at, down, FRAME), _amount(load.value, where))
    if mass is None:
        what = _("link {link} has no mass").format(link=load.link)
        raise InputError(where, what, _("give its mass, or the weight's value"))
    return _weight(mechanism, mass, mass.mass * _strength(mechanism))
