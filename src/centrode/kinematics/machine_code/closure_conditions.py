"""Conditions of closure in closed form: whether groups close all along a range of the drive, without a mesh.

Where a group stands on a crank and on the frame, the factors of its radicand and its divisor are trigonometric
polynomials of the drive's angle, mostly of one wave: Grashof's condition and its relatives are statements about their
extremes. A group is clear where all factors of its radicand stay above zero by more than the arrays' search could take
for zero; it opens where a factor whose extremes are exact is below zero somewhere. What lies between is left to the
mesh. Textbooks: Dizioğlu, Getriebelehre (1965), on Grashof's theorem; Chiang, Kinematics of Spherical Mechanisms
(1988).
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.machine_code.trace import Traced
from centrode.kinematics.machine_code.variables import PARAMETER, Pass, least_of
from centrode.kinematics.samples import SUSPECT
from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node
from centrode.numerics.jets import Jet
from centrode.numerics.scans import Reduction
from centrode.numerics.trigonometric_polynomials import (
    PolynomialExtremes,
    factors_of,
    minus,
    plus,
    polynomials_of,
    times,
)

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Number: TypeAlias = Any

m = EXPRESSIONS
SAFE = 2.0
"""Share of its greatest below which a radicand is compared with its rounding error, so many times over."""
APART = 4.0
"""Rounding bounds that a factor keeps from zero: the arrays' own bound of the radicand is then below its value."""
CLEAR, OPENS = "clear in closed form", "opens in closed form"


@dataclass(frozen=True)
class FoundClosure:
    """Of mechanisms (lanes,): which close all along the range, which open for certain; `largest` as of radicands."""

    clear: Mask
    opens: Mask
    largest: dict[str, Array]


@dataclass(frozen=True)
class ClosureConditions:
    """Extremes of all radicands and divisors of a plan over a range of the drive.

    Attributes
    ----------
    radicands : group -> the extremes of its factors
    divisors : group -> its extremes
    """

    radicands: Mapping[int, Sequence[PolynomialExtremes]]
    divisors: Mapping[int, PolynomialExtremes]
    names: tuple[str, ...]

    @classmethod
    def of(cls, traced: Traced, low: float, high: float, names: tuple[str, ...]) -> ClosureConditions | None:
        """The conditions of a plan with one drive between two values; None if a group's are no trigonometric ones."""
        if traced.solved.ready.kinematics.path.by_time or traced.steps:
            return None
        radicands = {group: _value(x) for group, x in traced.radicands.items()}
        divisors = {group: _value(x) for group, x in traced.divisors.items()}
        polynomials = polynomials_of([*radicands.values(), *divisors.values()], PARAMETER)
        factors = {group: factors_of(x, polynomials) for group, x in radicands.items()}
        if not all(x in polynomials for some in (*factors.values(), divisors.values()) for x in some):
            return None

        def ends(node: Node) -> PolynomialExtremes:
            return polynomials[node].extremes(low, high)

        return cls(
            {group: [ends(x) for x in some] for group, some in factors.items()},
            {group: ends(x) for group, x in divisors.items()},
            names,
        )

    def judge(self, values: Mapping[str, Array], kernels: str, threads: int) -> FoundClosure:
        """Judge the mechanisms of a batch."""
        lanes = len(next(iter(values.values())))
        found = self._once.run(values, kernels, threads)
        largest = {name: x for name, x in found.items() if name not in (CLEAR, OPENS)}
        # without any radicand and divisor there is nothing that could open
        clear, opens = (found.get(name, np.full(lanes, sign)) for name, sign in ((CLEAR, 1.0), (OPENS, -1.0)))
        return FoundClosure(clear > 0.0, opens > 0.0, largest)

    @cached_property
    def _once(self) -> Pass:
        """What is judged depends on no place: it is computed once a mechanism."""
        state: dict[str, Node] = {}
        slacks: list[Operand] = []
        depths: list[Operand] = []
        for group, factors in self.radicands.items():
            least = [minus(x.least, times(APART, x.error)) for x in factors]
            greatest = [plus(x.greatest, x.error) for x in factors]
            most = functools.reduce(times, greatest)
            slacks += [*least, minus(functools.reduce(times, least), times(SAFE * SUSPECT, most))]
            depths += [-plus(x.reached, x.error) for x in factors]
            state[f"largest {group}"] = as_node(m.abs(most))
        for x in self.divisors.values():
            away = times(APART, x.error)
            slacks.append(m.max(minus(x.least, away), -plus(x.greatest, away)))
        if slacks:
            state[CLEAR] = least_of([as_node(x) for x in slacks])
        if depths:
            state[OPENS] = as_node(functools.reduce(m.max, depths))
        return Pass(Reduction(state, dict.fromkeys(state, 0.0)), self.names, {})


def _value(number: Number) -> Node:
    return as_node(number.coefficients[0] if isinstance(number, Jet) else number)
