"""Counterweights with the least greatest effects: shaking force, shaking moment, moment of the drive, weighted.

With bases in the frame the force depends linearly on the products of mass and radius, and the least greatest force is
found with a proof (`minimax`). Inertias and the masses on moving bases bend this: then linear problems are solved one
after the other within a region of trust, from several beginnings.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from centrode.dynamics.balancing.counterweights import PARAMETERS, Spot, columns_of, parameters
from centrode.dynamics.balancing.full import SAME, full_balance
from centrode.dynamics.balancing.inertial import Array, Complex, Effects
from centrode.dynamics.balancing.making import LEAST
from centrode.dynamics.balancing.minimax import CLOSED, Term, least, within
from centrode.dynamics.balancing.turning import Turning, tops

INSTANTS = 180
WIDE = 20.0
"""Products of mass and radius are looked for up to so many times all masses times the greatest length."""
STEPS, EXCHANGES = 60, 8
CONVERGED, ROUGHLY = 1e-9, 1e-3
"""Gain that a linear problem still promises, over the value, at which a search ends, and a first look."""
NEARBY, LEAST_TRUST = 1e-2, 1e-9
"""Region of trust about an answer that more instants change a little, and the least one."""
CRUMB = 1e-6
"""Product over `unit` of a counterweight that is tried to be left out."""
PULL = 1e-9
"""Weight of the greatest product over `unit`: of counterweights that do the same the smaller ones are taken."""
BETWEEN = 1e-9
"""By how much a top between instants may stand out, over the value, before it becomes an instant."""


@dataclass(frozen=True)
class Aim:
    """Weights of greatest shaking force, shaking moment and moment of the drive, each over that of before."""

    force: float = 1.0
    moment: float = 0.0
    driving: float = 0.0

    @property
    def parts(self) -> list[tuple[str, float]]:
        """Names and weights of what counts."""
        named = (("force", self.force), ("moment", self.moment), ("driving", self.driving))
        return [(name, weight) for name, weight in named if weight > 0.0]


@dataclass(frozen=True)
class Lightest:
    """Products of mass and radius (spots), the value reached, and what none can go below (None where not proved)."""

    products: Complex
    value: float
    bound: float | None


@dataclass(frozen=True)
class Problem:
    """Spots on a turning mechanism, looked at at some values of the drive; unknowns are products over `unit`."""

    turning: Turning
    spots: tuple[Spot, ...]
    aim: Aim
    sizes: tuple[float, ...]
    values: Array

    @cached_property
    def own(self) -> Effects:
        """Effects of the links."""
        return self.turning.effects(self.values)

    @cached_property
    def columns(self) -> list[Effects]:
        """Effects of the parameters of each counterweight."""
        return self.columns_at(self.values)

    def columns_at(self, values: Array) -> list[Effects]:
        """The same at other values of the drive."""
        state, pace = self.turning.instants.state(values), self.turning.instants.pace(values)
        return [columns_of(state, spot, pace, self.turning.about) for spot in self.spots]

    @property
    def unit(self) -> float:
        """What products are measured by [kg m]: all masses times the greatest length."""
        scale = self.turning.instants.ready.kinematics.path.scale
        return scale * (sum(one.mass for one in self.turning.masses) or 1.0)

    @property
    def linear(self) -> bool:
        """Whether effects that count depend linearly on the products."""
        return all(name == "force" for name, _weight in self.aim.parts) and all(
            spot.fixed for spot in self.spots
        )

    @cached_property
    def pull(self) -> float:
        """Weight of the greatest product, where several counterweights may do the same."""
        if not self.linear:
            return PULL
        rows = np.concatenate([column.force[1:3] for column in self.columns]).T
        parts = np.concatenate([rows.real, rows.imag])
        return (
            0.0 if np.linalg.matrix_rank(parts, tol=SAME * np.linalg.norm(parts)) == parts.shape[1] else PULL
        )

    def products(self, x: Array) -> Complex:
        """Products [kg m] of the unknowns, which are real pairs."""
        return np.asarray(self.unit * (x[::2] + 1j * x[1::2]))

    def effects(self, x: Array, own: Effects, columns: Sequence[Effects]) -> Effects:
        """Effects of links and counterweights."""
        whole = own
        for spot, product, column in zip(self.spots, self.products(x), columns, strict=True):
            whole = whole + column.times(parameters(spot.making.made(abs(product)), product))
        return whole

    def terms(self, x: Array) -> list[Term]:
        """What counts, linear about some unknowns."""
        whole = self.effects(x, self.own, self.columns)
        slopes = [
            self._slopes(spot, product) for spot, product in zip(self.spots, self.products(x), strict=True)
        ]
        found = []
        for (name, weight), size in zip(self.aim.parts, self.sizes, strict=True):
            rows = np.concatenate(
                [slope @ getattr(column, name) for slope, column in zip(slopes, self.columns, strict=True)]
            ).T
            rows = rows * (self.unit / size)
            found.append(Term(weight, np.asarray(getattr(whole, name) / size - rows @ x), rows))
        if not self.pull:
            return found
        pairs = len(self.spots)
        small = np.zeros((pairs, 2 * pairs), dtype=np.complex128)
        small[np.arange(pairs), 2 * np.arange(pairs)] = 1.0
        small[np.arange(pairs), 2 * np.arange(pairs) + 1] = 1j
        return [*found, Term(self.pull, np.zeros(pairs, dtype=np.complex128), small)]

    def _slopes(self, spot: Spot, product: complex) -> Array:
        """Derivatives of the parameters by the product's components (2, PARAMETERS)."""
        made = spot.making.made(abs(product), LEAST * self.unit)
        towards = product / abs(product) if product else 0j
        slopes = np.zeros((2, PARAMETERS))
        slopes[:, 0] = made.mass_slope * towards.real, made.mass_slope * towards.imag
        slopes[0, 1] = slopes[1, 2] = 1.0
        slopes[:, 3] = made.inertia_slope * towards.real, made.inertia_slope * towards.imag
        return slopes

    def value(self, x: Array) -> float:
        """The weighted sum of greatest effects at the instants."""
        whole = self.effects(x, self.own, self.columns)
        return self.pull * float(np.max(np.hypot(x[::2], x[1::2]))) + sum(
            weight * float(np.max(np.abs(getattr(whole, name)))) / size
            for (name, weight), size in zip(self.aim.parts, self.sizes, strict=True)
        )

    def with_tops(self, x: Array) -> Problem | None:
        """The same with the tops between its instants; None where none stands out."""
        added: list[Array] = []
        whole = self.effects(x, self.own, self.columns)
        for name, _weight in self.aim.parts:
            places, heights = tops(lambda q, name=name: self._size(x, name, q), self.turning.nodes)  # type: ignore[misc]
            greatest = float(np.max(np.abs(getattr(whole, name))))
            added.append(places[heights > greatest * (1.0 + BETWEEN)])
        if not any(len(places) for places in added):
            return None
        values = np.concatenate([self.values, *added])
        return Problem(self.turning, self.spots, self.aim, self.sizes, values)

    def _size(self, x: Array, name: str, values: Array) -> Array:
        whole = self.effects(x, self.turning.effects(values), self.columns_at(values))
        return np.asarray(np.abs(getattr(whole, name)))


def lightest(turning: Turning, spots: Sequence[Spot], aim: Aim, sizes: Sequence[float]) -> Lightest:
    """The counterweights with the least weighted sum of greatest effects over a cycle.

    `sizes` are the greatest effects without counterweights, of what counts, which the effects are measured by.
    """
    problem = Problem(turning, tuple(spots), aim, tuple(sizes), turning.values(INSTANTS * turning.turns))
    most = [spot.making.greatest for spot in spots]
    limits = np.array([np.inf if one is None else one / problem.unit for one in most])
    x, bound = _solved(problem, limits)
    for _exchange in range(EXCHANGES):
        finer = problem.with_tops(x)
        if finer is None:
            break
        problem = finer
        x, bound = _descended(problem, x, limits, trust=WIDE if problem.linear else NEARBY)
    x = _without_crumbs(problem, x)
    return Lightest(problem.products(x), problem.value(x), None if problem.pull else bound)


def _without_crumbs(problem: Problem, x: Array) -> Array:
    """Without the counterweights that are nothing but what is left of the search."""
    small = np.repeat(np.hypot(x[::2], x[1::2]) < CRUMB, 2)
    fewer = np.where(small, 0.0, x)
    return fewer if problem.value(fewer) <= problem.value(x) * (1.0 + CLOSED) else x


def _solved(problem: Problem, limits: Array) -> tuple[Array, float]:
    """The best of what several beginnings lead to; one is enough where the problem is linear."""
    zero = np.zeros(2 * len(problem.spots))
    if problem.linear:
        return _descended(problem, zero, limits)
    full = full_balance(problem.turning, problem.spots).products / problem.unit
    resting = np.stack([full.real, full.imag], axis=1).reshape(-1)
    resting = within(np.clip(resting, -WIDE, WIDE), limits)
    beginnings = [zero, resting, 0.5 * resting, -0.5 * resting]
    found = [_descended(problem, x, limits, ROUGHLY)[0] for x in beginnings]
    return _descended(problem, min(found, key=problem.value), limits, trust=10.0 * NEARBY)


def _descended(
    problem: Problem, x: Array, limits: Array, converged: float = CONVERGED, trust: float = WIDE
) -> tuple[Array, float]:
    """Linear problems one after the other; also what the last one cannot go below."""
    value = problem.value(x)
    bound = -np.inf
    for _step in range(STEPS):
        low, high = np.maximum(x - trust, -WIDE), np.minimum(x + trust, WIDE)
        found = least(problem.terms(x), low, high, limits, max(CLOSED, 0.1 * converged))
        bound = found.bound
        reached = problem.value(found.x)
        promised, gained = value - found.value, value - reached
        if gained > 0.0:
            x, value = found.x, reached
        if problem.linear or promised <= converged * value:
            break
        if gained < 0.25 * promised:
            trust = 0.25 * min(trust, float(np.max(np.abs(found.x - x))) or trust)
        elif gained > 0.75 * promised:
            trust = min(2.0 * trust, WIDE)
        if trust < LEAST_TRUST:
            break
    return x, bound
