"""Curvature K(phi) [1/m] of the path of a roller's centre: the laws a cam may be designed by."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.errors import InputError
from centrode.laws.laws import Cubic, TableLaw, spline
from centrode.locale import _

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
        return self.along([phi, 1.0, *([0.0] * (order - 1))][: order + 1], side)

    def along(self, angles: list[Number], side: int = 1) -> list[Number]:
        with np.errstate(all="ignore"):
            return full(self.jet(JETS, Jet(angles)), angles[0], len(angles))


def full(found: Number, like: Number, count: int) -> list[Number]:
    """Coefficients of a jet, the zeros of constants with the shape of `like`."""
    coefficients = found.coefficients if isinstance(found, Jet) else (found,)
    zero = 0.0 * like
    return [zero + c for c in coefficients] + [zero] * (count - len(coefficients))


def derivatives(law: CurvatureLaw, phi: Array, order: int = 0) -> Array:
    """K and its derivatives (order + 1, n) [1/m/rad^k]; NaN outside the law's span."""
    inside = (phi >= law.span[0]) & (phi <= law.span[1])
    at = np.where(inside, phi, np.nan)
    found = [math.factorial(k) * c for k, c in enumerate(law.series(at, order))]
    return np.where(inside, np.asarray(found), np.nan)


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
                    "the angles of a spline increase, point {number} does not: {before:.6g}, then {after:.6g} deg"
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
        raise InputError("", _("a curvature law holds finite numbers only"), _("correct them"))
