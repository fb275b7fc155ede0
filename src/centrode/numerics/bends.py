"""Numbers that bound their own second derivative over a cell: formulas tell how far they can stray from their tangent.

A cell is the stretch of the variable that lies within `half` of its centre. A bent number carries value and slope at
the centre, as a jet of first order has them, and a bound of the size of its second derivative anywhere in the cell,
its bend B. Taylor's formula then holds it between x + x' t - B t^2/2 and x + x' t + B t^2/2, so

    |x(t)| <= |x| + |x'| half + B half^2/2,    |x'(t)| <= |x'| + B half,    |x(t)| >= |x| - |x'| half - B half^2/2,

and rules for sums, products, quotients and roots follow from those of second derivatives. The bend of a quotient or
of a meeting point appears in its own bound; such inequalities hold as long as their least fixed point exists, by
continuity from the centre outwards. Where it does not, and where a divisor or radicand may be zero, the bend is
infinite or NaN: nothing is known, and comparisons with what it bounds fail. Bends are computed in floating point;
whoever compares them leaves room for rounding.

Slope and value are bounded from the centre again at every step and only bends are carried on from formula to formula,
so what is overestimated is multiplied by half^2/2, some 1e-5 of a cell of half a degree. Textbooks: Moore, Kearfott,
Cloud, Introduction to Interval Analysis (2009), chapter 6 (mean value forms); Neumaier, Interval Methods for Systems
of Equations (1990), chapter 2.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

from centrode.numerics import jets
from centrode.numerics.jets import Jet, JetFunctions

Number: TypeAlias = Any
Namespace: TypeAlias = Any


def is_zero(x: Number) -> bool:
    """Whether a number is the plain float zero, which costs nothing to leave out."""
    return type(x) is float and x == 0.0


def plus(a: Number, b: Number) -> Number:
    """Sum in which plain zeros cost nothing."""
    return b if is_zero(a) else a if is_zero(b) else a + b


def times(a: Number, b: Number) -> Number:
    """Product in which plain zeros cost nothing; an infinite factor is left out with them."""
    return 0.0 if is_zero(a) or is_zero(b) else a * b


@dataclass(frozen=True)
class Cells:
    """Cells by half their width, over a namespace with `abs`, `sqrt`, `less` and `where`.

    `holds` keeps the direction in which a fixed link holds a point: each group takes more operations, and bounds do not
    grow from group to group.
    """

    half: Number
    m: Namespace
    holds: bool = False

    @cached_property
    def sagitta(self) -> Number:
        """Factor of a bend that bounds the distance of a number from its tangent: half the squared half width."""
        return 0.5 * self.half * self.half

    def size(self, x: Number) -> Number:
        """Bound of the size of a plain number: no bound of what only happens to be known at the centre."""
        return 0.0 if is_zero(x) else self.m.abs(x)


@dataclass(frozen=True)
class VectorBend:
    """Bound of the length of a vector's second derivative over a cell, and a closer one along a unit vector."""

    length: Number
    direction: tuple[Number, ...] | None = None
    along: Number = None


class Bent(Jet):
    """A jet of first order at the centre of a cell with a bound of its second derivative over the cell.

    Components of one vector may share what is known of it as a whole.
    """

    __slots__ = ("bend", "cells", "vector")

    def __init__(
        self, value: Number, slope: Number, bend: Number, cells: Cells, vector: VectorBend | None = None
    ) -> None:
        super().__init__((value, slope))
        self.bend = bend
        self.cells = cells
        self.vector = vector

    def __repr__(self) -> str:
        return f"Bent({self.coefficients!r}, {self.bend!r})"

    @property
    def strays(self) -> Number:
        """Bound on the difference of the number, anywhere in the cell, from its value in the middle."""
        cells = self.cells
        return plus(times(cells.size(self.coefficients[1]), cells.half), times(self.bend, cells.sagitta))

    @property
    def most(self) -> Number:
        """Bound of its size."""
        return plus(self.cells.size(self.coefficients[0]), self.strays)

    @property
    def least(self) -> Number:
        """Lower bound of the number's size over the cell; negative where it may be zero."""
        return self.cells.size(self.coefficients[0]) - self.strays

    @property
    def fastest(self) -> Number:
        """Bound of the size of its slope."""
        return plus(self.cells.size(self.coefficients[1]), times(self.bend, self.cells.half))

    def _with(self, coefficients: Any, bend: Number) -> Bent:
        value, slope = coefficients
        return Bent(value, slope, bend, self.cells)

    def __add__(self, other: Number) -> Jet:
        if isinstance(other, Bent):
            return self._with(Jet.__add__(self, other).coefficients, plus(self.bend, other.bend))
        if isinstance(other, Jet):
            # a plain jet says nothing of its second derivative, so neither does the result: it is a plain jet
            # too
            return Jet.__add__(self, other)
        return (
            self
            if is_zero(other)
            else self._with((self.coefficients[0] + other, self.coefficients[1]), self.bend)
        )

    __radd__ = __add__

    def __neg__(self) -> Bent:
        return self._with([-a for a in self.coefficients], self.bend)

    def __sub__(self, other: Number) -> Jet:
        if isinstance(other, Bent):
            return self._with(Jet.__sub__(self, other).coefficients, plus(self.bend, other.bend))
        if isinstance(other, Jet):
            return Jet.__sub__(self, other)
        return (
            self
            if is_zero(other)
            else self._with((self.coefficients[0] - other, self.coefficients[1]), self.bend)
        )

    def __rsub__(self, other: Number) -> Jet:
        if isinstance(other, Jet):
            return Jet.__sub__(other, self)
        return self._with((other - self.coefficients[0], -self.coefficients[1]), self.bend)

    def __mul__(self, other: Number) -> Jet:
        if isinstance(other, Bent):
            product = jets.product(self.coefficients, other.coefficients)
            # (x x)'' = 2 (x x'' + x'^2): fewer operations than the product of two, and the same bound
            if other is self:
                fastest = self.fastest
                return self._with(product, 2.0 * plus(times(self.most, self.bend), fastest * fastest))
            # (a b)'' = a b'' + 2 a' b' + a'' b, each factor at its greatest in the cell
            carried = plus(times(self.most, other.bend), times(other.most, self.bend))
            return self._with(product, plus(carried, times(2.0 * self.fastest, other.fastest)))
        if isinstance(other, Jet):
            return Jet(jets.product(self.coefficients, other.coefficients))
        scaled = Jet.__mul__(self, other).coefficients
        return self._with(scaled, times(self.bend, self.cells.size(other)))

    def __rmul__(self, other: Number) -> Jet:
        if isinstance(other, Jet):
            return Jet(jets.product(other.coefficients, self.coefficients))
        return self.__mul__(other)

    def __truediv__(self, other: Number) -> Jet:
        if isinstance(other, Bent):
            return _divide_bends(self, other)
        if isinstance(other, Jet):
            return Jet(jets.quotient(self.coefficients, other.coefficients))
        return self._with(
            [a / other for a in self.coefficients], times(self.bend, 1.0 / self.cells.size(other))
        )

    def __rtruediv__(self, other: Number) -> Jet:
        if isinstance(other, Jet):
            return Jet(jets.quotient(other.coefficients, self.coefficients))
        return _divide_bends(Bent(other, 0.0, 0.0, self.cells), self)

    def __pow__(self, exponent: float) -> Jet:
        raise NotImplementedError("no formula of a group has a power")


def _divide_bends(a: Bent, b: Bent) -> Bent:
    """Quotient q: q'' = (a'' - 2 q' b' - q b'') / b, where |q'| and |q| grow with the bound of q'' itself."""
    cells = a.cells
    value, slope = jets.quotient(a.coefficients, b.coefficients)
    # |q| and |q'| at the edge of the cell are those of the centre, grown by Q h^2/2 and Q h with the bound Q
    # = |q''| sought. So Q |b| <= known + Q (2 |b'| h + |b''| h^2/2), and what multiplies Q goes to the left
    # side
    steep = 2.0 * b.fastest
    near = plus(cells.size(value), cells.size(slope) * cells.half)
    known = plus(plus(a.bend, cells.size(slope) * steep), times(near, b.bend))
    rest = b.least - plus(steep * cells.half, times(b.bend, cells.sagitta))
    return Bent(value, slope, least_bound(known, rest, 0.0, cells.m), cells)


def least_bound(known: Number, linear: Number, squared: Number, m: Namespace) -> Number:
    """The least B >= 0 with linear B = known + squared B^2; NaN or infinite where there is none."""
    if is_zero(squared):
        # a root of what is negative is NaN: so is the bound where nothing holds
        root = m.sqrt(linear)
        return known / (root * root)
    root = m.sqrt(linear)
    linear = root * root
    # the lesser root of the quadratic, in the form that subtracts nothing and stands also for a small
    # `squared`
    return 2.0 * known / (linear + m.sqrt(linear * linear - 4.0 * squared * known))


class BendFunctions:
    """Namespace `m` for bent numbers: what closed forms of groups call. Plain numbers pass through."""

    def __init__(self, base: Namespace) -> None:
        self.base = base
        self.jets = JetFunctions(base)

    def variable(self, value: Number, cells: Cells) -> Bent:
        """The variable itself in cells about values."""
        return Bent(value, 1.0, 0.0, cells)

    def sqrt(self, x: Number) -> Number:
        """Root s: s'' = (x''/2 - s'^2) / s, with s' = x' / 2s."""
        if not isinstance(x, Bent):
            return self.jets.sqrt(x)
        root = jets.square_root(x.coefficients, self.base.sqrt(x.coefficients[0]))
        # the square root of what is not positive is NaN: a cell in which x may be zero has no bound
        least = self.base.sqrt(x.least)
        speed = 0.5 * x.fastest / least
        return x._with(root, plus(0.5 * x.bend if not is_zero(x.bend) else 0.0, speed * speed) / least)

    def sin(self, x: Number) -> Number:
        if not isinstance(x, Bent):
            return self.jets.sin(x)
        return x._with(self._waves(x)[0], self._of_wave(x))

    def cos(self, x: Number) -> Number:
        if not isinstance(x, Bent):
            return self.jets.cos(x)
        return x._with(self._waves(x)[1], self._of_wave(x))

    def _waves(self, x: Bent) -> tuple[list[Number], list[Number]]:
        value = x.coefficients[0]
        return jets.sine_and_cosine(x.coefficients, self.base.sin(value), self.base.cos(value))

    def _of_wave(self, x: Bent) -> Number:
        # (sin x)'' = x'' cos x - x'^2 sin x, with sine and cosine at most 1
        fastest = x.fastest
        return plus(fastest * fastest, x.bend)

    def atan2(self, y: Number, x: Number) -> Number:
        """Angle of a vector z: |angle'| <= |z'|/|z|, |angle''| <= (|z''| + 2 |angle'| |z'|) / |z|."""
        if not isinstance(y, Bent) and not isinstance(x, Bent):
            return self.jets.atan2(y, x)
        cells = (y if isinstance(y, Bent) else x).cells
        y, x = (c if isinstance(c, Bent) else Bent(c, 0.0, 0.0, cells) for c in (y, x))
        flat = self.jets.atan2(Jet(y.coefficients), Jet(x.coefficients))
        length = self.base.sqrt(x.coefficients[0] * x.coefficients[0] + y.coefficients[0] * y.coefficients[0])
        # sizes of a vector are bounded by the sum of those of its two components: no root has to be taken
        strays, speed, bend = (
            plus(a, b) for a, b in ((x.strays, y.strays), (x.fastest, y.fastest), (x.bend, y.bend))
        )
        # NaN where the vector may vanish in the cell: its angle has no bound there
        root = self.base.sqrt(length - strays)
        least = root * root
        return Bent(
            flat.coefficients[0],
            flat.coefficients[1],
            (plus(bend, 2.0 * speed * speed / least)) / least,
            cells,
        )

    def sign(self, x: Number) -> Number:
        return self.base.sign(x.value if isinstance(x, Jet) else x)
