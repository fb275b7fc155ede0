"""Counterweights with the least greatest effects: shaking force, shaking moment, moment of the drive, weighted.

With bases in the frame the force depends linearly on the products of mass and radius, and the least greatest force is
found with a proof (`minimax`). Masses and inertias go with the length of the products, which may be an unknown of its
own, not below them: a convex problem that bounds the answer. Where its lengths are those of its products it is the
answer. Else, and with discs, linear problems are solved one after the other within a region of trust.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from centrode.dynamics.balancing.counterweights import Spot
from centrode.dynamics.balancing.full import full_balance
from centrode.dynamics.balancing.inertial import Array, Complex
from centrode.dynamics.balancing.minimax import CLOSED, Found, least
from centrode.dynamics.balancing.turning import Turning
from centrode.dynamics.balancing.weighing import Aim, Problem

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
TIGHT = 1e-7
"""By how much the value may exceed that of the problem in which lengths of products are free to be greater."""


@dataclass(frozen=True)
class Lightest:
    """Products of mass and radius (spots), the value reached, and what none can go below (None where not proved)."""

    products: Complex
    value: float
    bound: float | None


def lightest(turning: Turning, spots: Sequence[Spot], aim: Aim, sizes: Sequence[float]) -> Lightest:
    """The counterweights with the least weighted sum of greatest effects over a cycle.

    `sizes` are the greatest effects without counterweights, of what counts, which the effects are measured by.
    """
    problem = Problem(turning, tuple(spots), aim, tuple(sizes), turning.values(INSTANTS * turning.turns))
    most = [spot.making.greatest for spot in spots]
    limits = np.array([WIDE if one is None else min(WIDE, one / problem.unit) for one in most])
    x, bound = _solved(problem, limits, None)
    for _exchange in range(EXCHANGES):
        finer = problem.with_tops(x)
        if finer is None:
            break
        problem = finer
        x, bound = _solved(problem, limits, x)
    x = _without_crumbs(problem, x)
    return Lightest(problem.products(x), problem.value(x), bound)


def _solved(problem: Problem, limits: Array, near: Array | None) -> tuple[Array, float | None]:
    """The answer, with what no answer goes below where that is proved; `near` is one for a few instants less."""
    zero = np.zeros(2 * len(problem.spots))
    if problem.convex:
        found = _linear(problem, zero, limits, WIDE, CLOSED, [True] * len(problem.spots))
        x = found.x[: len(zero)]
        bound = max(found.bound - problem.pull * WIDE, 0.0)
        if problem.value(x) <= found.value + TIGHT * max(found.value, 1e-3):
            return x, bound
        # more inertia than the products have would be better: what was proved is not reached
    if near is not None:
        return _descended(problem, near, limits, CONVERGED, NEARBY), None
    full = full_balance(problem.turning, problem.spots).products / problem.unit
    resting = np.stack([full.real, full.imag], axis=1).reshape(-1)
    longest = np.repeat(np.maximum(np.hypot(resting[::2], resting[1::2]) / limits, 1.0), 2)
    resting = resting / longest
    beginnings = [zero, resting, 0.5 * resting, -0.5 * resting]
    looked = [_descended(problem, x, limits, ROUGHLY, WIDE) for x in beginnings]
    return _descended(problem, min(looked, key=problem.value), limits, CONVERGED, 10.0 * NEARBY), None


def _linear(
    problem: Problem, x: Array, limits: Array, trust: float, closed: float, lengths: Sequence[bool]
) -> Found:
    """The answer of the linear problem about some unknowns, within a region of trust."""
    own = np.hypot(x[::2], x[1::2])
    low = np.concatenate([np.maximum(x - trust, -WIDE), np.maximum(own - 2.0 * trust, 0.0)])
    high = np.concatenate([np.minimum(x + trust, WIDE), np.minimum(own + 2.0 * trust, limits)])
    return least(problem.terms(x, lengths), low, high, closed)


def _descended(problem: Problem, x: Array, limits: Array, converged: float, trust: float) -> Array:
    """Linear problems one after the other.

    The length of a product bends where it is zero: there, and only there, it is an unknown of its own.
    """
    value = problem.value(x)
    for _step in range(STEPS):
        lengths = (np.hypot(x[::2], x[1::2]) < CRUMB).tolist()
        found = _linear(problem, x, limits, trust, max(CLOSED, 0.1 * converged), lengths)
        there = found.x[: len(x)]
        reached = problem.value(there)
        promised, gained = value - found.value, value - reached
        step = float(np.max(np.abs(there - x)))
        if gained > 0.0:
            x, value = there, reached
        if promised <= converged * value:
            break
        if gained < 0.25 * promised:
            trust = 0.25 * min(trust, step or trust)
        elif gained > 0.75 * promised:
            trust = min(2.0 * trust, WIDE)
        if trust < LEAST_TRUST:
            break
    return x


def _without_crumbs(problem: Problem, x: Array) -> Array:
    """Without the counterweights that are nothing but what is left of the search."""
    small = np.repeat(np.hypot(x[::2], x[1::2]) < CRUMB, 2)
    fewer = np.where(small, 0.0, x)
    return fewer if problem.value(fewer) <= problem.value(x) * (1.0 + CLOSED) else x
