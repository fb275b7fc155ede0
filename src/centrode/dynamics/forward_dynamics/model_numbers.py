"""The numbers of a mechanism as variables: dimensions, masses and loads of one structure are lanes of one kernel."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import numpy as np

from centrode.dynamics.forward_dynamics.broken_lines import BrokenLine
from centrode.dynamics.forward_dynamics.contacts import Contact, JointPressing, SmoothFriction, StopPush
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion, LoadAlong
from centrode.dynamics.load_coordinates import Component
from centrode.dynamics.loads import (
    Constant,
    Damper,
    Friction,
    LoadLaw,
    StraightSpring,
    TorsionSpring,
)
from centrode.dynamics.state import About, Centre, Mass, Radial, Spread
from centrode.numerics.expressions import Node, variable
from centrode.structure.dimensions import Dimensions

Number: TypeAlias = Any
Function: TypeAlias = Callable[[Number], Number]


def map_equations(equations: EquationsOfMotion, function: Function) -> EquationsOfMotion:
    """The equations with every number replaced by function(number), always in the same order."""
    return replace(
        equations,
        numbers=_map_dimensions(equations.numbers, function),
        masses=tuple(_map_mass(mass, function) for mass in equations.masses),
        loads=tuple(_map_load(load, function) for load in equations.loads),
        shafts=tuple(replace(shaft, inertia=function(shaft.inertia)) for shaft in equations.shafts),
        weights=tuple(map(function, equations.weights)),
        references=tuple(map(function, equations.references)),
        contacts=tuple(_map_contact(contact, function) for contact in equations.contacts),
        controls=tuple(
            replace(control, gains={name: function(x) for name, x in control.gains.items()})
            for control in equations.controls
        ),
    )


def _map_contact(contact: Contact, function: Function) -> Contact:
    def known(number: Number | None) -> Number | None:
        # a bound at zero is a number like any other: it is not part of the structure
        return None if number is None else function(number)

    return replace(
        contact,
        least=known(contact.least),
        most=known(contact.most),
        stiffness=function(contact.stiffness),
        damping=function(contact.damping),
        kinetic=None if contact.kinetic is None else _map_law(contact.kinetic, function),
        backwards=None if contact.backwards is None else _map_law(contact.backwards, function),
        static=known(contact.static),
        drift=function(contact.drift),
        pressing=None if contact.pressing is None else _map_pressing(contact.pressing, function),
    )


def _map_pressing(pressing: JointPressing, function: Function) -> JointPressing:
    return replace(
        pressing,
        kinetic=function(pressing.kinetic),
        static=function(pressing.static),
        length=function(pressing.length),
        height=function(pressing.height),
    )


def _map_dimensions(numbers: Dimensions, function: Function) -> Dimensions:
    mapped = numbers.map_numbers(function)

    def unit(vector: tuple[Number, ...], other: tuple[Number, ...]) -> tuple[Number, ...]:
        # along an axis, which is part of the structure, a direction costs nothing
        return vector if len(vector) == 2 and _along_axis(vector) else other

    return replace(
        mapped,
        direction={k: unit(v, mapped.direction[k]) for k, v in numbers.direction.items()},
        turn={k: unit(v, mapped.turn[k]) for k, v in numbers.turn.items()},
    )


def _along_axis(vector: tuple[Number, ...]) -> bool:
    return all(isinstance(x, float) for x in vector) and 0.0 in vector and abs(sum(vector)) == 1.0


def _map_mass(mass: Mass, function: Function) -> Mass:
    inertia = mass.inertia
    if isinstance(inertia, tuple):
        inertia = tuple(_map_part(part, function) for part in inertia)
    else:
        inertia = function(inertia)
    centre = _map_centre(mass.centre, function)
    return replace(mass, mass=function(mass.mass), centre=centre, inertia=inertia)


def _map_centre(centre: Centre | Radial, function: Function) -> Centre | Radial:
    if isinstance(centre, Centre):
        return replace(centre, along=function(centre.along), across=function(centre.across))
    x, y, z = map(function, centre.direction)
    return replace(centre, direction=(x, y, z), distance=function(centre.distance))


def _map_part(part: Spread | About, function: Function) -> Spread | About:
    x, y, z = map(function, part.direction)
    return replace(part, moment=function(part.moment), direction=(x, y, z))


def _map_load(load: LoadAlong, function: Function) -> LoadAlong:
    term = load.term
    coordinate = term.coordinate
    if isinstance(coordinate, Component) and not isinstance(coordinate.at, str):
        coordinate = replace(coordinate, at=_map_centre(coordinate.at, function))
    return replace(load, term=replace(term, coordinate=coordinate, amount=_map_law(term.amount, function)))


def _map_law(law: LoadLaw | BrokenLine | SmoothFriction | StopPush, function: Function) -> Any:
    match law:
        case StopPush():
            least, most = (None if bound is None else function(bound) for bound in (law.least, law.most))
            return StopPush(least, most, function(law.stiffness), function(law.damping))
        case BrokenLine():
            return law.map_numbers(function)
        case Constant():
            return replace(law, value=function(law.value))
        case TorsionSpring() | StraightSpring():
            return replace(law, stiffness=function(law.stiffness), free=function(law.free))
        case Damper():
            return replace(law, damping=function(law.damping))
        case SmoothFriction():
            return replace(
                law,
                viscous=function(law.viscous),
                quadratic=function(law.quadratic),
                drift=function(law.drift),
            )
        case Friction():
            return replace(law, viscous=function(law.viscous), quadratic=function(law.quadratic))
        case _:
            return law


@dataclass
class _Naming:
    """Names for numbers one after the other; plain zeros stay what they are, as they are part of the structure."""

    names: list[str | None] = field(default_factory=list)

    def __call__(self, number: Number) -> Number | Node:
        if isinstance(number, float | int) and number == 0.0:
            self.names.append(None)
            return 0.0
        name = f"number {len(self.names)}"
        self.names.append(name)
        return variable(name)


@dataclass(frozen=True)
class NumbersAsVariables:
    """Equations whose numbers are variables, and the names of these in order.

    Attributes
    ----------
    equations : over expressions
    names : None where a number is zero and stays so
    """

    equations: EquationsOfMotion
    names: tuple[str | None, ...]

    @classmethod
    def of(cls, equations: EquationsOfMotion) -> NumbersAsVariables:
        """The equations of a mechanism with its numbers as variables."""
        naming = _Naming()
        mapped = map_equations(equations, naming)
        return cls(mapped, tuple(naming.names))

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the variables."""
        return tuple(name for name in self.names if name is not None)

    def values(self, equations: EquationsOfMotion) -> np.ndarray[Any, np.dtype[np.float64]]:
        """Values of the variables in equations of the same structure, (variables, lanes)."""
        found: list[Number] = []

        def keep(number: Number) -> Number:
            found.append(number)
            return number

        map_equations(equations, keep)
        rows = [np.ravel(x) for x, name in zip(found, self.names, strict=True) if name is not None]
        lanes = max((len(row) for row in rows), default=1)
        return np.array([np.broadcast_to(row, lanes) for row in rows], dtype=np.float64).reshape(
            len(rows), lanes
        )

    def fits(self, equations: EquationsOfMotion) -> bool:
        """Whether numbers are zero where they were."""
        naming = _Naming()
        map_equations(equations, naming)
        return tuple(naming.names) == self.names
