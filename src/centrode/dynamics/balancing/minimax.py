"""The least greatest value of vectors that depend linearly on unknowns, by cutting planes, with a proof.

Minimise the sum over terms of weight * max over n instants of |constant + rows x|: a second-order cone programme.
Every linear programme over some of its tangents bounds the answer from below, every x tried bounds it from above
(J. E. Kelley, Journal of the Society for Industrial and Applied Mathematics 8, 1960, 703-712). Between the linear
programmes the unknowns are polished by sequential quadratic programming over the instants that stand out.
"""

from __future__ import annotations

import functools
import importlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from centrode.dynamics.balancing.shaking_forces import Array, Complex

# slower to import than NumPy
_optimize = functools.partial(importlib.import_module, "scipy.optimize")

MOST_ROUNDS = 120
POLISHED, POLISHES, MOST_TOPS = 6, 4, 12
DIRECTIONS = np.exp(2j * np.pi * np.arange(8) / 8)
# They decide the work; when it ends the gap between the bounds decides. Six random problems of two pairs over 180
# instants took 5 to 7 linear programmes. Polished every third round instead of every sixth they took 4 to 7, every
# twelfth up to 13, never up to 14. Half and double of POLISHES and MOST_TOPS, four and sixteen directions in place of
# eight change that by one programme. MOST_ROUNDS is a bound that none of them came near.
CLOSED = 1e-8
"""Gap between the bounds, over the answer's scale, at which it is found."""
SOLVER = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


@dataclass(frozen=True)
class MinimaxTerm:
    """weight * max |constant + rows x|; constant (n), rows (n, unknowns), real or complex."""

    weight: float
    constant: Complex | Array
    rows: Complex | Array

    def at(self, x: Array) -> Array:
        """Absolute values at the instants."""
        return np.asarray(np.abs(self.constant + self.rows @ x))


@dataclass(frozen=True)
class MinimaxSolution:
    """Unknowns, the value they give, and what no unknowns can go below."""

    x: Array
    value: float
    bound: float


def value_of(terms: Sequence[MinimaxTerm], x: Array) -> float:
    """The sum of weighted greatest values."""
    return sum(term.weight * float(np.max(term.at(x))) for term in terms)


def least(terms: Sequence[MinimaxTerm], low: Array, high: Array, closed: float = CLOSED) -> MinimaxSolution:
    """The unknowns with the least sum of greatest values: pairs, then for each a length not below that of the pair.

    Parameters
    ----------
    terms : sized so that values are of the order of 1
    low, high : (3 pairs)
        Bounds of each; finite.
    closed : gap between the bounds, over the value, at which it is found
    """
    weights = [term.weight for term in terms]
    planes = _Planes(len(terms), len(low))
    for number, term in enumerate(terms):
        # to begin with, some two dozen tangents evenly over the cycle, in every direction that a vector may
        # have
        for instant in range(0, len(term.constant), max(1, len(term.constant) // 24)):
            for direction in DIRECTIONS if np.iscomplexobj(term.rows) else (1.0, -1.0):
                planes.touch(number, term, instant, direction)
    for pair in range(len(low) // 3):
        for direction in DIRECTIONS:
            # a pair's length is first bounded by an octagon; further planes are added where it matters
            planes.widen(pair, direction)
    # zero, moved into the box, is a solution that is always allowed
    best = _inside(np.clip(np.zeros(len(low)), low, high), high)
    value, bound = value_of(terms, best), -np.inf
    for round_ in range(MOST_ROUNDS):
        x, heights = planes.lowest(weights, low, high)
        # each programme over some of the tangents bounds the answer from below; the best bound counts
        bound = max(bound, float(np.dot(weights, heights)))
        tried = [x]
        # now and then, as a polish costs as much as several programmes
        if round_ % POLISHED == POLISHED - 1:
            tried.append(_polish(terms, best, low, high))
        for x in tried:
            for number, term in enumerate(terms):
                _touch_tops(planes, number, term, x)
            pairs, lengths = _split_unknowns(x)
            # pairs beyond their length violate the cone: they are cut off by the plane along them
            for k in np.flatnonzero(np.abs(pairs) > lengths * (1.0 - 1e-6)).tolist():
                if pairs[k]:
                    planes.widen(k, complex(pairs[k] / abs(pairs[k])))
            # what a programme gives is made allowed first: its value then bounds the answer from above
            inside = _inside(x, high)
            here = value_of(terms, inside)
            if here < value:
                best, value = inside, here
        # values are sized to the order of 1, so below 1e-3 the gap counts as such
        if value - bound <= closed * max(value, 1e-3):
            break
    # the programme's own tolerance may put the bound a little above the value
    return MinimaxSolution(best, value, min(bound, value))


def _split_unknowns(x: Array) -> tuple[Complex, Array]:
    """Pairs as complex numbers, and lengths."""
    count = len(x) // 3
    return np.asarray(x[: 2 * count : 2] + 1j * x[1 : 2 * count : 2]), x[2 * count :]


def _inside(x: Array, high: Array) -> Array:
    """Pairs that are too long made as long as they may be, lengths that are too short as long as their pairs."""
    pairs, lengths = _split_unknowns(x)
    most = high[2 * len(pairs) :]
    own = np.abs(pairs)
    # zero pairs are divided by 1 and stay zero
    share = np.where(own > most, most / np.where(own > 0.0, own, 1.0), 1.0)
    shorter = pairs * share
    flat = np.stack([shorter.real, shorter.imag], axis=1).reshape(-1)
    return np.concatenate([flat, np.maximum(lengths, np.abs(shorter))])


@dataclass
class _Planes:
    """Half spaces in unknowns and heights of the terms."""

    terms: int
    unknowns: int
    left: list[Array] = field(default_factory=list)
    right: list[float] = field(default_factory=list)

    def touch(self, number: int, term: MinimaxTerm, instant: int, direction: complex) -> None:
        """The component along a unit direction stays below the height of its term."""
        row = np.zeros(self.unknowns + self.terms)
        # Re(conj(d) (c + r x)) <= height for a unit d: the component is never greater than the size
        row[: self.unknowns] = (np.conj(direction) * term.rows[instant]).real
        row[self.unknowns + number] = -1.0
        self.left.append(row)
        self.right.append(-float((np.conj(direction) * term.constant[instant]).real))

    def widen(self, pair: int, direction: complex) -> None:
        """The component of a pair along a unit direction stays below its length."""
        row = np.zeros(self.unknowns + self.terms)
        # Re(conj(d) pair) <= length
        row[2 * pair], row[2 * pair + 1] = direction.real, direction.imag
        row[2 * (self.unknowns // 3) + pair] = -1.0
        self.left.append(row)
        self.right.append(0.0)

    def lowest(self, weights: Sequence[float], low: Array, high: Array) -> tuple[Array, Array]:
        """Unknowns and heights of the least weighted sum of heights."""
        solution: Any = _optimize().linprog(
            np.concatenate([np.zeros(self.unknowns), weights]),
            np.array(self.left),
            np.array(self.right),
            bounds=[*zip(low, high, strict=True), *[(0.0, None)] * self.terms],
            method="highs",
            options=SOLVER,
        )
        if solution.x is None:  # zero unknowns with great heights are always allowed, but numbers may be wild
            raise ArithmeticError(solution.message)
        return np.asarray(solution.x[: self.unknowns]), np.asarray(solution.x[self.unknowns :])


def _touch_tops(planes: _Planes, number: int, term: MinimaxTerm, x: Array) -> None:
    """Add the tangents at instants where a term stands out most."""
    vectors = term.constant + term.rows @ x
    for instant in _tops(np.abs(vectors)):
        size = abs(vectors[instant])
        # the tangent at x: the direction of the vector there; any will do for zero
        planes.touch(number, term, instant, complex(vectors[instant] / size) if size else 1.0)


def _tops(sizes: Array) -> list[int]:
    """Instants of the greatest local maxima."""
    # instants go round: the last is the neighbour of the first
    peaks = np.flatnonzero((sizes >= np.roll(sizes, 1)) & (sizes >= np.roll(sizes, -1)))
    order = np.argsort(sizes[peaks])[::-1][:MOST_TOPS]
    return [int(instant) for instant in peaks[order]]


def _polish(terms: Sequence[MinimaxTerm], x: Array, low: Array, high: Array) -> Array:
    """Unknowns nearer to the answer by sequential quadratic programming: tangents alone close in slowly on a curve."""
    for _round in range(POLISHES):
        # instants that may be the greatest near the answer: only these become constraints, with their
        # curvature
        corners = [(k, i) for k, term in enumerate(terms) for i in _near(term.at(x))]
        better = _by_quadratics(terms, corners, x, low, high)
        if value_of(terms, better) >= value_of(terms, x):
            break
        x = better
    return x


def _near(sizes: Array) -> list[int]:
    """Instants that may be the greatest ones near here."""
    order = np.argsort(sizes)[::-1]
    return [int(i) for i in order[:MOST_TOPS] if sizes[i] > 0.0] + _tops(sizes)


def _by_quadratics(
    terms: Sequence[MinimaxTerm], corners: Sequence[tuple[int, int]], x: Array, low: Array, high: Array
) -> Array:
    """The least sum of heights above chosen instants of the terms."""
    unknowns, count = len(x), len(x) // 3
    weights = np.concatenate([np.zeros(unknowns), [term.weight for term in terms]])
    owners = np.array([k for k, _i in corners])
    constant = np.array([terms[k].constant[i] for k, i in corners])
    rows = np.array([terms[k].rows[i] for k, i in corners])

    def room(y: Array) -> Array:
        pairs, lengths = _split_unknowns(y[:unknowns])
        heights = y[unknowns + owners] - np.abs(constant + rows @ y[:unknowns])
        return np.concatenate([heights, lengths - np.abs(pairs)])

    def slopes(y: Array) -> Array:
        # the derivative of |v| is the component of v' along v
        units = _units(constant + rows @ y[:unknowns])
        found = np.zeros((len(corners) + count, len(y)))
        found[: len(corners), :unknowns] = -(np.conj(units)[:, None] * rows).real
        found[np.arange(len(corners)), unknowns + owners] = 1.0
        towards = _units(_split_unknowns(y[:unknowns])[0])
        for pair in range(count):
            line = len(corners) + pair
            found[line, 2 * pair], found[line, 2 * pair + 1] = -towards[pair].real, -towards[pair].imag
            found[line, 2 * count + pair] = 1.0
        return found

    heights = [float(np.max(term.at(x))) for term in terms]
    found: Any = _optimize().minimize(
        lambda y: float(weights @ y),
        np.concatenate([x, heights]),
        jac=lambda _y: weights,
        bounds=[*zip(low, high, strict=True), *[(0.0, None)] * len(terms)],
        constraints={"type": "ineq", "fun": room, "jac": slopes},
        method="SLSQP",
        options={"ftol": 1e-15, "maxiter": 100},
    )
    # its bounds are kept to a tolerance only
    better = np.clip(found.x[:unknowns], low, high)
    return _inside(better, high) if np.isfinite(better).all() else x


def _units(vectors: Complex | Array) -> Complex:
    """Unit vectors, zero for zero; of real numbers their signs."""
    sizes = np.abs(vectors)
    return np.asarray(vectors / np.where(sizes > 0.0, sizes, 1.0), dtype=np.complex128)
