"""Closed trains: two planetary sets of sun, planets and ring, two of whose shafts belong to both of them.

Six members and two couplings leave four shafts: one drives, one is driven, one is at rest, and one is inner. Each set k
has R. Willis' equation omega_s + p_k omega_r - (1 + p_k) omega_c = 0 with p_k = z_ring/z_sun; without the speed of the
inner shaft both give the ratio u = N(p_1, p_2)/D(p_1, p_2), N and D of the first degree in each. Moments of a set have
the same coefficients, so losses change the ratio of moments as p_k eta_k^(+-1) in place of p_k does (M. A. Kreines;
E. I. Radzimovsky, 1956).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from centrode.gears.planetary_trains import MeshEfficiency, PlanetaryTrain
from centrode.model.gear_trains import SET_MEMBERS, ClosedShafts, Shaft

Coefficients = NDArray[np.int64]
Value = TypeVar("Value", Fraction, float, NDArray[np.float64])

COEFFICIENTS: Mapping[str, tuple[int, int]] = {"sun": (1, 0), "ring": (0, 1), "carrier": (-1, -1)}
"""Of the speed of each part in Willis' equation, and of its moment over that of the sun: a constant, a share of p."""


def set_of(member: str) -> int:
    """0 of a member of set 1 ("sun 1"), 1 of one of set 2."""
    return int(member.rpartition(" ")[2]) - 1


def willis_coefficient(member: str, ratio: Value) -> Value:
    """Coefficient of the speed of a member in the equation of its set with p = `ratio`."""
    constant, share = COEFFICIENTS[member.rpartition(" ")[0]]
    return constant + share * ratio


def polynomial(coefficients: Coefficients, first: Value, second: Value) -> Value:
    """The sum of c_ij p_1^i p_2^j."""
    constant, of_second, of_first, of_both = (int(value) for value in coefficients.ravel())
    return constant + of_first * first + of_second * second + of_both * first * second


@dataclass(frozen=True)
class WillisRatio:
    """The ratio u = N/D of a closed train over p_1 and p_2.

    Attributes
    ----------
    numerator, denominator : (2, 2), [i, j] the coefficient of p_1^i p_2^j
    """

    numerator: Coefficients
    denominator: Coefficients

    def at(self, first: Value, second: Value) -> Value:
        """U; raises ZeroDivisionError where the driven shaft stands, arrays have infinities there."""
        return polynomial(self.numerator, first, second) / polynomial(self.denominator, first, second)

    def exponents(self, first: Fraction, second: Fraction) -> tuple[int, int]:
        """Kreines' signs of du/dp_k over u: 1 where the sun of set k drives against its carrier, else -1."""
        above, below = (
            [
                polynomial(slope, first, second) / polynomial(coefficients, first, second)
                for slope in _slopes(coefficients)
            ]
            for coefficients in (self.numerator, self.denominator)
        )
        one, other = (1 if rises > falls else -1 for rises, falls in zip(above, below, strict=True))
        return one, other


def _slopes(coefficients: Coefficients) -> tuple[Coefficients, Coefficients]:
    """Coefficients of the derivatives by p_1 and by p_2."""
    by_first, by_second = np.zeros_like(coefficients), np.zeros_like(coefficients)
    by_first[0], by_second[:, 0] = coefficients[1], coefficients[:, 1]
    return by_first, by_second


def willis_ratio(shafts: ClosedShafts) -> WillisRatio:
    """The ratio of shafts, from both equations without the speed of the inner shaft."""
    inner = shafts.inner
    return WillisRatio(-_minor(shafts.shaft(shafts.output), inner), _minor(shafts.shaft(shafts.input), inner))


def _minor(first: Shaft, second: Shaft) -> Coefficients:
    """Determinant of the coefficients of two shafts in both equations, as a polynomial."""
    rows = [[_of_shaft(shaft, number) for number in (0, 1)] for shaft in (first, second)]
    return np.asarray(np.outer(rows[0][0], rows[1][1]) - np.outer(rows[1][0], rows[0][1]))


def _of_shaft(shaft: Shaft, number: int) -> tuple[int, int]:
    """Coefficient of the speed of a shaft in the equation of a set."""
    own = (COEFFICIENTS[member.rpartition(" ")[0]] for member in shaft if set_of(member) == number)
    return next(own, (0, 0))


@dataclass(frozen=True)
class MemberPower:
    """What a member of a set carries where the driving shaft has the moment 1 and the speed 1.

    Attributes
    ----------
    member : "sun 1", ...
    speed, moment : over those of the driving shaft; the moment acts on the set
    """

    member: str
    speed: float
    moment: float

    @property
    def power(self) -> float:
        """Into the set, over that which drives."""
        return self.speed * self.moment + 0.0  # no minus zero of a member at rest


@dataclass(frozen=True)
class ClosedTrain:
    """Two planetary sets of which two shafts belong to both.

    Attributes
    ----------
    shafts : ClosedShafts
    stages : set 1 and set 2, of planets with one rim; which of their members rests is said by the shafts alone
    """

    shafts: ClosedShafts
    stages: tuple[PlanetaryTrain, PlanetaryTrain]

    @cached_property
    def formula(self) -> WillisRatio:
        """The ratio over p_1 and p_2."""
        return willis_ratio(self.shafts)

    @property
    def set_ratios(self) -> tuple[Fraction, Fraction]:
        """p_k = z_ring/z_sun of both sets."""
        first, second = self.stages
        return -first.fixed_carrier_ratio, -second.fixed_carrier_ratio

    @cached_property
    def ratio(self) -> Fraction:
        """Speed of what drives over that of what is driven."""
        return self.formula.at(*self.set_ratios)

    @property
    def teeth(self) -> tuple[int, ...]:
        """Those of both sets, in their order."""
        return self.stages[0].teeth + self.stages[1].teeth

    @cached_property
    def diameter(self) -> float:
        """The greater one of both sets, in modules."""
        return max(stage.diameter for stage in self.stages)

    @cached_property
    def speeds(self) -> Mapping[str, Fraction]:
        """Of all six members over that of the driving shaft."""
        shafts = self.shafts
        known = {shafts.input: Fraction(1), shafts.output: 1 / self.ratio, shafts.fixed: Fraction(0)}
        speeds = {member: speed for end, speed in known.items() for member in shafts.shaft(end)}
        # The inner shaft turns in both sets: its speed follows from the equation of the first.
        own, ratio = shafts.inner[0], self.set_ratios[0]
        others = sum(
            (
                willis_coefficient(member, ratio) * speed
                for member, speed in speeds.items()
                if set_of(member) == 0
            ),
            Fraction(0),
        )
        speeds |= dict.fromkeys(shafts.inner, -others / willis_coefficient(own, ratio))
        return {member: speeds[member] for member in SET_MEMBERS}

    @property
    def exponents(self) -> tuple[int, int]:
        """1 for a set whose sun drives against its carrier, -1 where the sun is driven."""
        return self.formula.exponents(*self.set_ratios)

    def lossy_ratios(self, meshes: MeshEfficiency) -> tuple[float, float]:
        """p_k eta_k^(+-1) of both sets, with which moments are transmitted."""
        loss = meshes.external * meshes.internal
        first, second = (
            float(ratio) * loss**exponent
            for ratio, exponent in zip(self.set_ratios, self.exponents, strict=True)
        )
        return first, second

    def efficiency(self, meshes: MeshEfficiency) -> float:
        """Efficiency from what drives to what is driven; not positive where the train locks itself."""
        return self.formula.at(*self.lossy_ratios(meshes)) / float(self.ratio)

    def powers(self, meshes: MeshEfficiency | None = None) -> tuple[MemberPower, ...]:
        """What all six members carry, with the losses of the meshes, or without losses."""
        first, second = map(float, self.set_ratios) if meshes is None else self.lossy_ratios(meshes)
        ratios = first, second
        inner = [willis_coefficient(member, ratios[set_of(member)]) for member in self.shafts.inner]
        whole = polynomial(self.formula.denominator, first, second)
        # Moments of the suns: no moment is left on the inner shaft, and 1 acts on the driving one.
        suns = inner[1] / whole, -inner[0] / whole
        return tuple(
            MemberPower(
                member,
                float(speed),
                suns[set_of(member)] * willis_coefficient(member, ratios[set_of(member)]),
            )
            for member, speed in self.speeds.items()
        )

    @cached_property
    def circulating_power(self) -> float:
        """Power without losses that goes round in the loop of both joined shafts, over that which drives.

        0 where power branches, or where both sets are in series.
        """
        # At the joined shaft that drives or is driven power flows into both sets, or out of both; what flows in the
        # opposite sense has gone round.
        for end, sense in ((self.shafts.input, 1), (self.shafts.output, -1)):
            shaft = self.shafts.shaft(end)
            if len(shaft) == 2:
                return max(0.0, *(-sense * one.power for one in self.powers() if one.member in shaft))
        return 0.0
