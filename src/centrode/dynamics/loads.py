"""Loads of a mechanism as efforts, from what the description gives."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import hypot
from typing import Any, TypeAlias

from centrode.algebra.arrays import ARRAYS
from centrode.dynamics.amounts import (
    Amount,
    Constant,
    Damper,
    Diagram,
    Formula,
    Friction,
    Square,
    StraightSpring,
    TorsionSpring,
)
from centrode.dynamics.coordinates import Component, Distance, HalfSquare, Slide
from centrode.dynamics.efforts import REST, Acting, Effort, grows
from centrode.dynamics.masses import Given, Mass, centre_of
from centrode.dynamics.turning import Travel, turning_of
from centrode.errors import InputError, NotComputedYet
from centrode.locale import _
from centrode.model.loads import PLAIN_SUM, Load
from centrode.model.mechanism import FRAME, Mechanism

__all__ = ["REST", "Acting", "Effort", "grows", "loads_of"]

Number: TypeAlias = Any
Namespace: TypeAlias = Any


def loads_of(
    mechanism: Mechanism,
    masses: Sequence[Mass],
    given: Given | None = None,
    m: Namespace = ARRAYS,
    described: Sequence[Load] | None = None,
) -> tuple[Acting, ...]:
    """Loads of the description, or some of them, then the weights that gravity adds; each with a label of its own.

    Raises
    ------
    InputError
        A weight without direction or amount.
    NotComputedYet
        Friction by a coefficient.
    """
    loads = mechanism.loads if described is None else described
    labels = _labels(loads, mechanism, masses)
    found = [
        Acting(label, tuple(_efforts(mechanism, load, masses, where, given, m)), where)
        for label, load in zip(labels, loads, strict=False)
        for where in [f"[[loads]] {label}"]
    ]
    weights = [
        Acting(label, (_weight(mechanism, mass, mass.mass * _strength(mechanism)),), f"[links.{mass.link}]")
        for label, mass in zip(labels[len(loads) :], _weighing(mechanism, masses), strict=True)
    ]
    return (*found, *weights)


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
        repair = _("ask for the reactions (ct.reactions, centrode reactions), or give the size by value")
        raise NotComputedYet(where, what, repair)
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
