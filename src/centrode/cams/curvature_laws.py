"""Curvature K(phi) [1/m] of the path of a roller's centre: the laws a cam may be designed by."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from centrode.errors import InputError
from centrode.laws.laws import Cubic, TableLaw, spline
from centrode.locale import _
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.search import bisect
from centrode.numerics.text_formula import TextFormula, compile_formula

Array = NDArray[np.float64]
Number = Any
JETS = JetFunctions(ARRAYS)


class CurvatureLaw(Protocol):
    """A curvature as a function of the carrier's angle phi [rad].

    Attributes
    ----------
    span : (first, last) [rad]
        Where it is defined; infinite where it is everywhere.
    breaks : tuple of float [rad]
        Places between which it is analytic, growing: knots of a spline, kinks of a formula. No series goes across.
    """

    @property
    def span(self) -> tuple[float, float]: ...

    @property
    def breaks(self) -> tuple[float, ...]: ...

    def series(self, phi: Number, order: int, side: int = 1) -> list[Number]:
        """Taylor coefficients [1/m/rad^k] about phi, a number or an array, of orders 0 to `order`.

        At a break those of the stretch behind it (`side` 1) or before it (-1).
        """

    def along(self, angles: list[Number], side: int = 1) -> list[Number]:
        """Coefficients of K(phi(s)) from those of phi(s)."""


class Analytic:
    """A law by one formula: what follows from `jet`, its value over the algebra of `m`."""

    span: tuple[float, float] = (-math.inf, math.inf)
    breaks: tuple[float, ...] = ()

    def jet(self, m: Any, phi: Number) -> Number:
        raise NotImplementedError

    def series(self, phi: Number, order: int, side: int = 1) -> list[Number]:
        # phi itself as a series: its slope is 1 and all else zero
        return self.along([phi, 1.0, *([0.0] * (order - 1))][: order + 1], side)

    def along(self, angles: list[Number], side: int = 1) -> list[Number]:
        with np.errstate(all="ignore"):
            return full(self.jet(JETS, Jet(angles)), angles[0], len(angles))


def full(found: Number, like: Number, count: int) -> list[Number]:
    """Coefficients of a jet, the zeros of constants with the shape of `like`."""
    coefficients = found.coefficients if isinstance(found, Jet) else (found,)
    zero = 0.0 * like
    # constants have coefficients of the shape of the places, so that arrays stack
    return [zero + c for c in coefficients] + [zero] * (count - len(coefficients))


def derivatives(law: CurvatureLaw, phi: Array, order: int = 0) -> Array:
    """K and its derivatives (order + 1, n) [1/m/rad^k]; NaN outside the law's span."""
    inside = (phi >= law.span[0]) & (phi <= law.span[1])
    # laws may be called with NaN and give it, but not with places outside their span
    at = np.where(inside, phi, np.nan)
    rates = [math.factorial(k) * c for k, c in enumerate(law.series(at, order))]
    return np.where(inside, np.asarray(rates), np.nan)


@dataclass(frozen=True)
class ConstantCurvature(Analytic):
    """K = k0 [1/m]: the path is a circle."""

    k0: float

    def __post_init__(self) -> None:
        positive(self.k0)

    def jet(self, m: Any, phi: Number) -> Number:
        return self.k0


@dataclass(frozen=True)
class ExponentialCurvature(Analytic):
    """K = k0 exp(k1 phi), k0 [1/m], k1 [1/rad]: the law of the paper, (27)."""

    k0: float
    k1: float

    def __post_init__(self) -> None:
        positive(self.k0)
        finite(self.k1)

    def jet(self, m: Any, phi: Number) -> Number:
        return m.exp(phi * self.k1) * self.k0


@dataclass(frozen=True)
class LinearCurvature(Analytic):
    """K = k0 + k1 phi, k0 [1/m], k1 [1/m/rad]."""

    k0: float
    k1: float

    def __post_init__(self) -> None:
        positive(self.k0)
        finite(self.k1)

    def jet(self, m: Any, phi: Number) -> Number:
        return phi * self.k1 + self.k0


@dataclass(frozen=True)
class SplineCurvature:
    """The cubic spline through points of angle [rad] and curvature [1/m]; NaN outside them."""

    angles: tuple[float, ...]
    values: tuple[float, ...]
    cubics: tuple[Cubic, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        for number, (before, after) in enumerate(pairwise(self.angles), start=2):
            if not before < after:
                what = _(
                    "the angles of a spline must increase; they do not at point {number}: {before:.6g}, then "
                    "{after:.6g} deg"
                )
                told = what.format(number=number, before=math.degrees(before), after=math.degrees(after))
                raise InputError("[curvature] points", told, _("sort the points"))
        TableLaw(self.angles, self.values)  # its further checks are those of any table
        object.__setattr__(self, "cubics", tuple(spline(self.angles, self.values)))

    @property
    def span(self) -> tuple[float, float]:
        return self.angles[0], self.angles[-1]

    @property
    def breaks(self) -> tuple[float, ...]:
        return self.angles[1:-1]

    def series(self, phi: Number, order: int, side: int = 1) -> list[Number]:
        return self.along([phi, 1.0, *([0.0] * (order - 1))][: order + 1], side)

    def along(self, angles: list[Number], side: int = 1) -> list[Number]:
        phi = np.real(angles[0])  # a place beside the real axis belongs to the stretch below it
        places = np.searchsorted(self.angles, phi, side="right" if side > 0 else "left") - 1
        places = np.clip(places, 0, len(self.cubics) - 1)
        c0, c1, c2, c3 = np.moveaxis(np.asarray(self.cubics)[places], -1, 0)
        # the distance from the knot as a series: the cubic over it has any derivatives
        u = Jet([angles[0] - np.asarray(self.angles)[places], *angles[1:]])
        return full(((u * c3 + c2) * u + c1) * u + c0, angles[0], len(angles))


def positive(number: float) -> None:
    """Raise InputError unless a curvature is positive and finite."""
    if not (math.isfinite(number) and number > 0):
        what = _("a curvature has to be positive and finite, got {value:.9g} 1/m").format(value=number)
        raise InputError("", what, _("the path bends towards the cam's centre where it is positive"))


def finite(number: float) -> None:
    """Raise InputError unless a number is finite."""
    if not math.isfinite(number):
        raise InputError("", _("a curvature law must contain finite numbers only"), _("correct them"))


# A curvature by a formula written as text, parted where `abs`, `sign`, `min` or `max` bend it.

NODES_OF_A_TURN = 2880
MOST_KINKS = 1000


class _Watched(JetFunctions):
    """Jets that keep the values whose signs `abs`, `sign`, `min` and `max` ask for, in the order they do."""

    def __init__(self) -> None:
        super().__init__(ARRAYS)
        self.asked: list[Array] = []

    def sign(self, x: Number) -> Number:
        if isinstance(x, Jet):
            self.asked.append(np.asarray(x.value))
        return super().sign(x)

    def abs(self, x: Number) -> Number:
        return x * self.sign(x) if isinstance(x, Jet) else super().abs(x)


class _Signed(JetFunctions):
    """Jets with these signs given: the formula of one stretch, which goes on beyond its ends."""

    def __init__(self, signs: list[Array]) -> None:
        super().__init__(ARRAYS)
        self.signs = iter(signs)

    def sign(self, x: Number) -> Number:
        return next(self.signs) if isinstance(x, Jet) else super().sign(x)

    def abs(self, x: Number) -> Number:
        return x * self.sign(x) if isinstance(x, Jet) else super().abs(x)


@dataclass(frozen=True)
class TextCurvature:
    """K [1/m] by a formula of phi [rad], such as "10*exp(0.75*phi)".

    Kinks are looked for from `start` to `stop` on a mesh of an eighth of a degree and bisected to rounding; two of
    them within one cell of the mesh are missed.

    Attributes
    ----------
    constants : tuple of (name, value)
        Further letters of the formula.
    breaks : tuple of float [rad]
        Where the formula bends or jumps.
    signs : (stretches, functions)
        What `abs`, `sign`, `min` and `max` decide on each stretch between them.

    Raises
    ------
    InputError
        No formula of phi, or more kinks than `MOST_KINKS`.
    """

    text: str
    start: float
    stop: float
    constants: tuple[tuple[str, float], ...] = ()
    formula: TextFormula = field(init=False, repr=False, compare=False)
    breaks: tuple[float, ...] = field(init=False, repr=False, compare=False)
    signs: Array = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "formula", self._formula())
        breaks = self._kinks()
        edges = np.array(
            [min(self.start, *breaks), *breaks, max(self.stop, *breaks)]
            if breaks
            else [self.start, self.stop]
        )
        object.__setattr__(self, "breaks", breaks)
        # in the middle of a stretch, far from the zeros at its ends
        asked = self._condition_values(0.5 * (edges[:-1] + edges[1:]))
        object.__setattr__(self, "signs", np.sign(asked).T)

    def _formula(self) -> TextFormula:
        names = ("phi", *(name for name, _value in self.constants))
        return compile_formula(self.text, names, "[curvature] formula")

    @property
    def span(self) -> tuple[float, float]:
        """Defined everywhere, as far as is known before it is computed."""
        return -math.inf, math.inf

    def series(self, phi: Number, order: int, side: int = 1) -> list[Number]:
        return self.along([phi, 1.0, *([0.0] * (order - 1))][: order + 1], side)

    def along(self, angles: list[Number], side: int = 1) -> list[Number]:
        # at a break the stretch on the side that is requested
        stretch = np.searchsorted(self.breaks, np.real(angles[0]), side="right" if side > 0 else "left")
        functions = _Signed(list(np.moveaxis(self.signs[stretch], -1, 0)))
        with np.errstate(all="ignore"):
            return full(self._value(functions, Jet(angles)), angles[0], len(angles))

    def _value(self, functions: JetFunctions, phi: Jet) -> Any:
        try:
            return self.formula(functions, phi=phi, **dict(self.constants))
        except ZeroDivisionError:
            return math.inf

    def _condition_values(self, places: Array) -> Array:
        """Values (functions, n) whose signs are requested."""
        watched = _Watched()
        with np.errstate(all="ignore"):
            self._value(watched, Jet([places]))
        return np.asarray([np.broadcast_to(value, places.shape) for value in watched.asked]).reshape(
            -1, len(places)
        )

    def _kinks(self) -> tuple[float, ...]:
        count = 3 + math.ceil((self.stop - self.start) / math.tau * NODES_OF_A_TURN)
        # a mesh over the whole range: three cells at least
        places = np.linspace(self.start, self.stop, count)
        above = self._condition_values(places) >= 0
        functions, cells = np.nonzero(above[:, :-1] != above[:, 1:])
        if len(cells) > MOST_KINKS:
            what = _("the formula has corners at more than {most} places").format(most=MOST_KINKS)
            raise InputError("[curvature] formula", what, _("remove abs, sign, min and max"))
        if not len(cells):
            return ()
        first, column = above[functions, cells], np.arange(len(cells))

        def before(phi: Array) -> NDArray[np.bool_]:
            return np.asarray((self._condition_values(phi) >= 0)[functions, column] == first)

        _last, high = bisect(before, places[cells], places[cells + 1])
        rounding = 4 * np.finfo(np.float64).eps * (self.stop - self.start)
        high = np.where(np.abs(high) < rounding, 0.0, high)  # what is meant by abs(phi)
        return tuple(np.unique(high[(high > self.start) & (high < self.stop)]).tolist())


# The curvature of a curve as it is drawn: of the circles through three neighbouring places.


def drawn_curvature(phi: Array, radius: Array) -> Array:
    """Curvature (n) [1/m] of the circle through each place (phi, rho) and the two beside it; NaN at the ends.

    It knows nothing of the equations that gave rho. It differs from the curvature of the path in the order of the
    distances squared where these are equal, else in their first order; rounding is divided by the distance squared.
    """
    curvature = np.full(len(phi), np.nan)
    if len(phi) < 3:
        return curvature
    x, y = radius * np.sin(phi), radius * np.cos(phi)
    ahead, behind = (x[2:] - x[1:-1], y[2:] - y[1:-1]), (x[1:-1] - x[:-2], y[1:-1] - y[:-2])
    across = np.hypot(x[2:] - x[:-2], y[2:] - y[:-2])
    turned = behind[1] * ahead[0] - behind[0] * ahead[1]  # positive clockwise, as phi is
    with np.errstate(all="ignore"):
        # four times the area of a triangle over the product of its sides is 1/R of the circle around it
        curvature[1:-1] = 2.0 * turned / (np.hypot(*ahead) * np.hypot(*behind) * across)
    return curvature


# Whether a curvature is one of a cam over a range: known, finite and positive.

MOST_NODES = 100_000


def check_span(law: CurvatureLaw, start: float, stop: float) -> None:
    """Raise InputError where a law is not defined over a whole range."""
    first, last = law.span
    if first <= start and stop <= last:
        return
    what = _(
        "the curvature is known from {first:.9g} to {last:.9g} deg, the range is {start:.9g} to {stop:.9g} deg"
    )
    told = what.format(
        first=math.degrees(first), last=math.degrees(last), start=math.degrees(start), stop=math.degrees(stop)
    )
    raise InputError("[curvature]", told, _("add points, or shorten the range"))


def unlawful_place(law: CurvatureLaw, stop: float) -> float | None:
    """The first angle [rad] from 0 towards `stop` at which K is not finite and positive; None where it always is.

    Looked for on a mesh of an eighth of a degree, and at the least values between its nodes.
    """
    places = _mesh(law, stop)
    values, slopes = derivatives(law, places, 1)
    lows = _lows(law, places, slopes)
    places = np.concatenate([places, lows])
    values = np.concatenate([values, derivatives(law, lows)[0]])
    # from 0 outwards, as the cam is designed
    order = np.argsort(np.abs(places), kind="stable")
    places, values = places[order], values[order]
    wrong = np.flatnonzero(~_lawful(values))
    if not wrong.size:
        return None
    first = int(wrong[0])
    # nothing lawful lies before: there is no bracket to bisect
    if not first:
        return float(places[0])
    ends = bisect(
        lambda phi: _lawful(derivatives(law, phi)[0]), places[first - 1 : first], places[first : first + 1]
    )
    return float(ends[1][0])


def lawful(law: CurvatureLaw, phi: float) -> bool:
    """Whether K is finite and positive at an angle."""
    return bool(_lawful(derivatives(law, np.array([phi]))[0])[0])


def refusal(law: CurvatureLaw, phi: float) -> InputError:
    """Error for a curvature that is not one of a cam at an angle [rad]."""
    value = float(derivatives(law, np.array([phi]))[0, 0])
    angle = math.degrees(phi)
    if not math.isfinite(value):
        what = _("the curvature is not a finite number at {angle:.6g} deg").format(angle=angle)
    elif value <= 0 and phi == 0:
        what = _("the curvature at the start is not positive ({value:.4g} 1/m)").format(value=value)
    else:
        what = _("the curvature is not positive from {angle:.6g} deg on").format(angle=angle)
    return InputError("[curvature]", what, _("change the law, or end the range before that angle"))


def _mesh(law: CurvatureLaw, stop: float) -> Array:
    count = min(MOST_NODES, 3 + math.ceil(abs(stop) / (2 * math.pi) * NODES_OF_A_TURN))
    low, high = min(0.0, stop), max(0.0, stop)
    # between knots the slope is smooth: a least value lies there or at a knot
    knots = [place for place in law.breaks if low < place < high]
    places = np.unique(np.concatenate([np.linspace(0.0, stop, count), knots]))
    return places if stop >= 0 else places[::-1]


def _lows(law: CurvatureLaw, places: Array, slopes: Array) -> Array:
    """The places of least curvature between nodes, by bisection where the slope changes its sign."""
    sense = 1.0 if places[-1] >= places[0] else -1.0
    down, up = sense * slopes[:-1] < 0, sense * slopes[1:] > 0
    low, high = places[:-1][down & up], places[1:][down & up]
    return bisect(lambda phi: sense * derivatives(law, phi, 1)[1] < 0, low, high)[1]


def _lawful(values: Array) -> NDArray[np.bool_]:
    return np.isfinite(values) & (values > 0)
