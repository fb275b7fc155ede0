"""Conditions in symbols: the angle phi of each link by its number in the description, and what vanishes of them."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, pi, remainder

from centrode.geometry.plane import Vector, subtract
from centrode.model.mechanism import Mechanism
from centrode.structure.dimensions import Dimensions

NOTHING = 1e-12
"""An angle [rad] below which a constant is not written down."""
HIGHER = "determinant = 0"
"""The condition of a group whose determinant has no short form."""


@dataclass(frozen=True)
class Bearing:
    """The direction of a line as a sum: symbols of angles, and a constant [rad]."""

    symbols: tuple[str, ...] = ()
    constant: float = 0.0


def symbol_of(mechanism: Mechanism, link: str) -> str:
    """Symbol of a link's angle: links count from 1, in the order of the description."""
    return f"phi{mechanism.link_names.index(link) + 1}"


def bearing_of(mechanism: Mechanism, body: str, direction: Vector) -> Bearing:
    """Bearing of a direction that is given in the axes of a link, or of the frame."""
    constant = atan2(float(direction[1]), float(direction[0]))
    symbols = (symbol_of(mechanism, body),) if body in mechanism.links else ()
    return Bearing(symbols, constant)


def bearing_between(mechanism: Mechanism, numbers: Dimensions, link: str, first: str, last: str) -> Bearing:
    """Bearing of the line from one point of a link to another."""
    local = numbers.local[link]
    return bearing_of(mechanism, link, subtract(local[last], local[first]))


def parallel(one: Bearing, other: Bearing) -> str:
    """The condition that two lines have the same direction, or opposite ones."""
    return _vanishes(one, other, square=False)


def square(one: Bearing, other: Bearing) -> str:
    """The condition that two lines stand square to each other."""
    return _vanishes(one, other, square=True)


def _vanishes(one: Bearing, other: Bearing, *, square: bool) -> str:
    """The sine or cosine of the difference = 0; a quarter turn between the two changes one into the other."""
    plus = [name for name in one.symbols if name not in other.symbols]
    minus = [name for name in other.symbols if name not in one.symbols]
    if not plus and not minus:
        return HIGHER
    constant = one.constant - other.constant
    if not plus:
        plus, minus, constant = minus, plus, -constant
    constant = remainder(constant, pi)  # half a turn changes the sign alone
    if abs(abs(constant) - 0.5 * pi) <= NOTHING:
        constant, square = 0.0, not square
    name = "cos" if square else "sin"
    return f"{name}({_sum(plus, minus, constant)}) = 0"


def _sum(plus: list[str], minus: list[str], constant: float) -> str:
    text = " + ".join(plus) + "".join(f" - {name}" for name in minus)
    if abs(constant) <= NOTHING:
        return text
    return f"{text} {'+' if constant > 0 else '-'} {abs(constant):.6g}"
