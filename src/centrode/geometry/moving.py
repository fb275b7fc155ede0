"""Points that move: what a locus says of a point's next coefficient, the ones before being known.

What the k-th derivative of a locus says of the k-th coefficient of a point is linear in it, and the gradients are
the same for all orders: those of the velocities. So no closed form needs to be differentiated, and derivatives of
any order cost a third of what that would take. Textbook: Uicker, Pennock, Shigley, Theory of Machines and
Mechanisms, the method of kinematic coefficients (loop equations differentiated); any order: Griewank and Walther,
Evaluating Derivatives (2nd ed., 2008), chapters 13 and 15.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Protocol, TypeAlias

from centrode.algebra.jets import Jet
from centrode.geometry.plane import is_literal_zero

Number: TypeAlias = Any
Place: TypeAlias = Sequence[Number]


class Moving(Protocol):
    """A locus that a moving point stays on."""

    @property
    def gradient(self) -> Place:
        """What the locus multiplies every coefficient of the point by."""

    def next(self, k: int) -> Number:
        """The gradient multiplied by the point's k-th coefficient, those before being known."""

    def add(self, coefficient: Place, k: int) -> None:
        """Take the point's k-th coefficient."""


class AtDistance:
    """A point at a distance from a centre: arm . arm = distance^2, the arm from the centre to the point."""

    def __init__(self, centre: Place, squared: Number, place: Place) -> None:
        self.centre, self.squared = centre, squared
        self.arm = [apart(place, values(centre))]
        self.gradient = self.arm[0]

    def next(self, k: int) -> Number:
        known = dot(self.gradient, coefficients(self.centre, k))
        inner = total(dot(self.arm[i], self.arm[k - i]) for i in range(1, k))
        return total((known, times(0.5, less(coefficient(self.squared, k), inner))))

    def add(self, coefficient: Place, k: int) -> None:
        self.arm.append(apart(coefficient, coefficients(self.centre, k)))


class OnLine:
    """A point on a line in the plane: normal . arm = 0, the arm from a point of the line to the point."""

    def __init__(self, through: Place, direction: Place, place: Place) -> None:
        self.through, self.direction = through, direction
        self.arm = [apart(place, values(through))]
        self.gradient = self._normal(0)

    def next(self, k: int) -> Number:
        known = dot(self.gradient, coefficients(self.through, k))
        return less(known, total(dot(self._normal(i), self.arm[k - i]) for i in range(1, k + 1)))

    def add(self, coefficient: Place, k: int) -> None:
        self.arm.append(apart(coefficient, coefficients(self.through, k)))

    def _normal(self, k: int) -> Place:
        x, y = coefficients(self.direction, k)
        return less(0.0, y), x


def followed(
    place: Place, loci: Sequence[Moving], solved: Callable[[Sequence[Number]], Place], order: int
) -> tuple[Jet, ...]:
    """A place as series, one for each axis; `solved` gives the vector whose products with the gradients are known."""
    found = [tuple(place)]
    for k in range(1, order + 1):
        found.append(tuple(solved([locus.next(k) for locus in loci])))
        for locus in loci:
            locus.add(found[k], k)
    return tuple(Jet(axis) for axis in zip(*found, strict=True))


def value(x: Number) -> Number:
    """A number without its derivatives."""
    return x.value if isinstance(x, Jet) else x


def values(place: Place) -> tuple[Number, ...]:
    """A place without its derivatives."""
    return tuple(value(x) for x in place)


def coefficient(x: Number, k: int) -> Number:
    """The k-th coefficient; plainly zero of what stands still."""
    if isinstance(x, Jet):
        return x.coefficients[k]
    return 0.0 if k else x


def coefficients(place: Place, k: int) -> tuple[Number, ...]:
    """The k-th coefficient of a place."""
    return tuple(coefficient(x, k) for x in place)


# arithmetic in which what is plainly zero costs nothing


def times(a: Number, b: Number) -> Number:
    """Product."""
    return 0.0 if is_literal_zero(a) or is_literal_zero(b) else a * b


def less(a: Number, b: Number) -> Number:
    """Difference."""
    if is_literal_zero(b):
        return a
    return -b if is_literal_zero(a) else a - b


def total(terms: Iterable[Number]) -> Number:
    """Sum."""
    found: Number = 0.0
    for term in terms:
        found = term if is_literal_zero(found) else found if is_literal_zero(term) else found + term
    return found


def dot(a: Place, b: Place) -> Number:
    """Scalar product."""
    return total(times(x, y) for x, y in zip(a, b, strict=True))


def apart(a: Place, b: Place) -> tuple[Number, ...]:
    """Vector from b to a."""
    return tuple(less(x, y) for x, y in zip(a, b, strict=True))
