"""Free coordinates of groups of higher class as expressions: their names, and how they move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Operand, variable
from centrode.geometry.plane import Vector, turned
from centrode.kinematics.compiled.turns import TURN, whole_turns
from centrode.kinematics.higher_class.chains import Chain, Posture

Number: TypeAlias = Any


@dataclass(frozen=True)
class Names:
    """Names of what is handed on from step to step; `group` is the number of the group in the plan."""

    group: int
    chain: Chain

    @property
    def labels(self) -> Posture:
        """The names of the free coordinates."""
        links, own = self.chain.group.links, f"group {self.group}"
        hanging = [f.entity.name for f in self.chain.pattern.follows if f.by is None]
        return Posture(
            {link: (f"{own} cosine {link}", f"{own} sine {link}") for link in links},
            {link: f"{own} angle {link}" for link in links},
            {name: (f"{own} x {name}", f"{own} y {name}") for name in hanging},
        )

    @property
    def posture(self) -> Posture:
        """The free coordinates as variables."""
        labels = self.labels
        return Posture(
            {name: (variable(x), variable(y)) for name, (x, y) in labels.rotors.items()},
            {name: variable(x) for name, x in labels.angles.items()},
            {name: (variable(x), variable(y)) for name, (x, y) in labels.places.items()},
        )

    def derivatives(self, order: int) -> list[str]:
        """Names of derivatives of the free coordinates."""
        return [f"group {self.group} derivative {order} of {k}" for k in range(self.chain.pattern.free)]

    def of_matrix(self, i: int, j: int) -> str:
        """Name of a number of the matrix."""
        return f"group {self.group} matrix {i} {j}"


def numbers_of(posture: Posture) -> list[Number]:
    """All numbers of a posture in one order."""
    pairs = [x for vector in (*posture.rotors.values(), *posture.places.values()) for x in vector]
    return [*pairs, *posture.angles.values()]


def moved(chain: Chain, posture: Posture, by: Sequence[Operand], far: bool = False) -> Posture:
    """A posture with its free coordinates changed by small numbers, or by such as stand in `far`."""
    rotors, angles, places = dict(posture.rotors), dict(posture.angles), dict(posture.places)
    for follow in chain.pattern.follows:
        name = follow.entity.name
        if follow.entity.kind == "link":
            turn = by[follow.turn]
            rotors[name] = _righted(turned(rotors[name], _rotor(turn, far)))
            angles[name] = angles[name] + turn
        if follow.by is None:
            x, y = places[name]
            by_x, by_y = by[follow.first : follow.first + 2]
            places[name] = x + chain.unit * by_x, y + chain.unit * by_y
    return Posture(rotors, angles, places)


def with_turns(posture: Posture) -> Posture:
    """The same posture with the angles of its rotors, on the turn on which they are counted."""
    angles = {}
    for link, (cosine, sine) in posture.rotors.items():
        angle = EXPRESSIONS.atan2(sine, cosine)
        angles[link] = angle + TURN * whole_turns(posture.angles[link], angle)
    return Posture(posture.rotors, angles, posture.places)


def _rotor(turn: Operand, far: bool) -> Vector:
    """Rotor of an angle, but for its length: of a small one; with `far` to the sixth power of any that is no turn."""
    if not far:
        return 1.0, turn
    square = turn * turn
    return (
        1.0 - square * (0.5 - square * (1.0 / 24.0)),
        turn * (1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0))),
    )


def _righted(rotor: Vector) -> Vector:
    """A rotor of nearly unit length made one: 1 / sqrt(1 + e) by its tangent."""
    cosine, sine = rotor
    factor = 1.5 - 0.5 * (cosine * cosine + sine * sine)
    return cosine * factor, sine * factor
