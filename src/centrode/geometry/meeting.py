"""Meeting points that move: places by closed forms, their derivatives by the linear equations of each order.

What the k-th derivative of a locus says of the k-th coefficient of a point is linear in it, and the matrix is the
same for all orders: that of the velocities. So no closed form is differentiated, and derivatives of any order
cost a third of what that would take. Textbook: Uicker, Pennock, Shigley, Theory of Machines and Mechanisms
(4th ed., 2011), sections 3.4 and 4.3 (loop equations); any order: Griewank and Walther, Evaluating Derivatives
(2nd ed., 2008), section 13.1.
"""

from __future__ import annotations

from collections.abc import Iterable

from centrode.algebra.jets import Jet
from centrode.geometry.plane import (
    Circle,
    Line,
    Number,
    Root,
    Vector,
    circle_meets_line,
    circles_meet,
    is_literal_zero,
    radicand_of_circle_and_line,
    radicand_of_circles,
    subtract,
)


def meet_circles(one: Circle, other: Circle, root: Root) -> Vector:
    """Point where two circles meet, to the left of the way from centre to centre for a positive root."""
    radicand = radicand_of_circles(one, other)
    signed = root(radicand)
    if not isinstance(radicand, Jet):
        return circles_meet(one, other, signed)
    place = circles_meet(_circle(one), _circle(other), _value(signed))
    # the cross product of the arms is half the root
    return _moving(
        place, (_OnCircle(one, place), _OnCircle(other, place)), 2.0 / _value(signed), radicand.order
    )


def meet_circle_and_line(one: Circle, other: Line, root: Root) -> Vector:
    """Point where a circle meets a line, ahead of the foot of its centre for a positive root."""
    radicand = radicand_of_circle_and_line(one, other)
    signed = root(radicand)
    if not isinstance(radicand, Jet):
        return circle_meets_line(one, other, signed)
    line = Line(_values(other.through), _values(other.direction))
    place = circle_meets_line(_circle(one), line, _value(signed))
    # the cross product of the arm and the line's normal is the way from the foot
    return _moving(
        place, (_OnCircle(one, place), _OnLine(other, place)), 1.0 / _value(signed), radicand.order
    )


class _OnCircle:
    """A point on a circle: arm . arm = radius^2, arm from the centre to the point."""

    def __init__(self, circle: Circle, place: Vector) -> None:
        self.circle = circle
        self.arm = [subtract(place, _values(circle.centre))]
        self.gradient = self.arm[0]

    def next(self, k: int) -> Number:
        """The gradient multiplied by the point's k-th coefficient, those before being known."""
        known = _dot(self.gradient, _coefficients(self.circle.centre, k))
        inner = _sum(_dot(self.arm[i], self.arm[k - i]) for i in range(1, k))
        radius = self.circle.radius
        squared = (radius * radius).coefficients[k] if isinstance(radius, Jet) else 0.0
        return _sum((known, _times(0.5, _less(squared, inner))))

    def add(self, coefficient: Vector, k: int) -> None:
        """Take the point's k-th coefficient."""
        self.arm.append(_apart(coefficient, _coefficients(self.circle.centre, k)))


class _OnLine:
    """A point on a line: normal . arm = 0, arm from the line's own point to the point."""

    def __init__(self, line: Line, place: Vector) -> None:
        self.line = line
        self.arm = [subtract(place, _values(line.through))]
        self.gradient = self._normal(0)

    def next(self, k: int) -> Number:
        """The gradient multiplied by the point's k-th coefficient, those before being known."""
        known = _dot(self.gradient, _coefficients(self.line.through, k))
        return _less(known, _sum(_dot(self._normal(i), self.arm[k - i]) for i in range(1, k + 1)))

    def add(self, coefficient: Vector, k: int) -> None:
        """Take the point's k-th coefficient."""
        self.arm.append(_apart(coefficient, _coefficients(self.line.through, k)))

    def _normal(self, k: int) -> Vector:
        x, y = _coefficients(self.line.direction, k)
        return _less(0.0, y), x


def _moving(
    place: Vector, loci: tuple[_OnCircle | _OnLine, _OnCircle | _OnLine], inverse: Number, order: int
) -> Vector:
    """The place as a series; `inverse` is that of the cross product of the gradients."""
    one, other = loci
    found = [place]
    for k in range(1, order + 1):
        found.append(_solved(one.gradient, other.gradient, one.next(k), other.next(k), inverse))
        for locus in loci:
            locus.add(found[k], k)
    return Jet([x for x, _y in found]), Jet([y for _x, y in found])


def _solved(a: Vector, b: Vector, first: Number, second: Number, inverse: Number) -> Vector:
    """The vector whose products with a and b are given; `inverse` is that of their cross product."""
    of_first, of_second = _times(inverse, first), _times(inverse, second)
    return (
        _less(_times(of_first, b[1]), _times(of_second, a[1])),
        _less(_times(of_second, a[0]), _times(of_first, b[0])),
    )


def _value(x: Number) -> Number:
    return x.value if isinstance(x, Jet) else x


def _values(vector: Vector) -> Vector:
    return _value(vector[0]), _value(vector[1])


def _circle(circle: Circle) -> Circle:
    return Circle(_values(circle.centre), _value(circle.radius))


def _coefficients(vector: Vector, k: int) -> Vector:
    x, y = (x.coefficients[k] if isinstance(x, Jet) else x if k == 0 else 0.0 for x in vector)
    return x, y


# What plainly stands still is left out: it costs nothing.
def _times(a: Number, b: Number) -> Number:
    return 0.0 if is_literal_zero(a) or is_literal_zero(b) else a * b


def _less(a: Number, b: Number) -> Number:
    if is_literal_zero(b):
        return a
    return -b if is_literal_zero(a) else a - b


def _sum(terms: Iterable[Number]) -> Number:
    total: Number = 0.0
    for term in terms:
        total = term if is_literal_zero(total) else total if is_literal_zero(term) else total + term
    return total


def _dot(a: Vector, b: Vector) -> Number:
    return _sum((_times(a[0], b[0]), _times(a[1], b[1])))


def _apart(a: Vector, b: Vector) -> Vector:
    return _less(a[0], b[0]), _less(a[1], b[1])
