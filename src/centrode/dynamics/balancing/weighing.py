"""What counterweights are weighed by: the greatest effects over a cycle, and how they depend on the products."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from centrode.dynamics.balancing.counterweights import PARAMETERS, Spot, columns_of, parameters
from centrode.dynamics.balancing.full import SAME
from centrode.dynamics.balancing.inertial import Array, Complex, Effects
from centrode.dynamics.balancing.making import LEAST
from centrode.dynamics.balancing.minimax import Term
from centrode.dynamics.balancing.turning import Turning, tops_of

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

    @property
    def convex(self) -> bool:
        """Whether effects depend linearly on the products and their lengths: inertia of discs goes with the square."""
        return self.linear or all(spot.making.thickness is None for spot in self.spots)

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

    def terms(self, x: Array, lengths: Sequence[bool]) -> list[Term]:
        """What counts, linear about some unknowns; `lengths`: for which spots the length is an unknown of its own."""
        whole = self.effects(x, self.own, self.columns)
        products = self.products(x)
        place = np.concatenate([x, np.abs(products) / self.unit])
        slopes = [self._slopes(*each) for each in zip(self.spots, products, lengths, strict=True)]
        found = []
        for (name, weight), size in zip(self.aim.parts, self.sizes, strict=True):
            parts = [s @ getattr(column, name) for s, column in zip(slopes, self.columns, strict=True)]
            rows = np.concatenate([*(part[:2] for part in parts), *(part[2:] for part in parts)]).T
            rows = rows * (self.unit / size)
            constant = np.asarray(getattr(whole, name) / size - rows @ place)
            found.append(Term(weight, constant, rows))
        if not self.pull:
            return found
        pairs = len(self.spots)
        small = np.zeros((pairs, 3 * pairs), dtype=np.complex128)
        small[np.arange(pairs), 2 * np.arange(pairs)] = 1.0
        small[np.arange(pairs), 2 * np.arange(pairs) + 1] = 1j
        return [*found, Term(self.pull, np.zeros(pairs, dtype=np.complex128), small)]

    def _slopes(self, spot: Spot, product: complex, length: bool) -> Array:
        """Derivatives of the parameters by the product's components and its length (3, PARAMETERS)."""
        made = spot.making.made(abs(product), LEAST * self.unit)
        towards = product / abs(product) if product else 0j
        by_length = np.array([made.mass_slope, 0.0, 0.0, made.inertia_slope])
        slopes = np.zeros((3, PARAMETERS))
        slopes[0, 1] = slopes[1, 2] = 1.0
        if length:
            slopes[2] = by_length
        else:
            slopes[0] += towards.real * by_length
            slopes[1] += towards.imag * by_length
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
            places, heights = tops_of(lambda q, name=name: self._size(x, name, q), self.turning.nodes)  # type: ignore[misc]
            greatest = float(np.max(np.abs(getattr(whole, name))))
            added.append(places[heights > greatest * (1.0 + BETWEEN)])
        if not any(len(places) for places in added):
            return None
        values = np.concatenate([self.values, *added])
        return Problem(self.turning, self.spots, self.aim, self.sizes, values)

    def _size(self, x: Array, name: str, values: Array) -> Array:
        whole = self.effects(x, self.turning.effects(values), self.columns_at(values))
        return np.asarray(np.abs(getattr(whole, name)))
