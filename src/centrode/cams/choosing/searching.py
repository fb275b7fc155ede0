"""The search for the best design: sequential quadratic programming from several starts, then more angles.

The greatest value of a measure over the angles has kinks where it passes from one angle to another. So it becomes
a variable t that every angle's value stays below (its epigraph), and the values at the angles are smooth. Between
the angles looked at the worst ones are found, added, and the search goes on (exchange, after Remez), until nothing
between them is worse.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize, nnls
from scipy.stats import qmc

from centrode.cams.choosing.problem import Problem

Array = NDArray[np.float64]

STARTS = 8
EXCHANGES = 6
ROUNDS = 40
TOLERANCE = 1e-12
KEPT = 1e-9
"""Of a bound: it is asked for tighter by this, so that rounding does not break it."""
ACTIVE = 1e-6
"""A constraint binds where less than this part of its bound is left."""


@dataclass(frozen=True)
class Found:
    """The end of a search: places in the box, worst excess over a bound, value made best (scaled, small is good)."""

    share: Array
    excess: float
    value: float

    def better_than(self, other: Found) -> bool:
        """Admissible ones before others; among these the better value, among others the lesser excess."""
        if (self.excess <= KEPT) != (other.excess <= KEPT):
            return self.excess <= KEPT
        return self.value < other.value if self.excess <= KEPT else self.excess < other.excess


def search(problem: Problem, first: Array, starts: int = STARTS, warm: Sequence[Array] = ()) -> list[Found]:
    """Ends of searches from `first` (n,), `warm` ones and further places spread over the box, the best in front."""
    spread = qmc.Halton(len(first), scramble=False).random(starts) if starts else np.empty((0, len(first)))
    found: list[Found] = []
    for start in [first, *warm, *spread[1:]]:
        inner = _run(problem, np.asarray(start, float), elastic=True)
        ends = [inner]
        if _worst(problem, inner) <= ACTIVE:
            ends.append(_run(problem, inner, elastic=False))
        found += [_judged(problem, end) for end in ends]
    ranked = _ranked(found)
    return _ranked([_exchanged(problem, ranked[0]), *ranked])


def kkt_residual(problem: Problem, share: Array) -> tuple[float, dict[str, float]]:
    """How far the slope of the value made best is from being held by the bounds that bind, and their multipliers.

    A best design has a slope that is a sum, with weights that are not negative, of slopes of the constraints that
    bind and of the sides of the box (Karush, Kuhn and Tucker). The residual is a part of the slope's own size; the
    multiplier of a bound tells by which part the value changes when the bound is moved by a part of itself.
    """
    values, slopes = problem.measured(share)
    count = len(share)
    columns, names = [], []
    top = values[problem.best].max()
    for row in np.flatnonzero(values[problem.best] >= top - ACTIVE * max(abs(top), 1.0)):
        columns.append(np.concatenate([slopes[problem.best][row], [-1.0]]))
        names.append("")
    for name, (measure, bound) in problem.limits.items():
        room = measure.sign * bound / problem.scale(name) - values[name]
        for row in np.flatnonzero(room <= ACTIVE):
            columns.append(np.concatenate([slopes[name][row], [0.0]]))
            names.append(name)
    for index in range(count):
        for side, near in ((-1.0, share[index] <= ACTIVE), (1.0, share[index] >= 1 - ACTIVE)):
            if near:
                columns.append(side * np.eye(count + 1)[index])
                names.append("box")
    goal = np.zeros(count + 1)
    goal[-1] = -1.0
    weights, miss = nnls(np.stack(columns, axis=1), goal)
    held = {name: 0.0 for name in problem.limits}
    for name, weight in zip(names, weights, strict=True):
        if name in held:
            held[name] += float(weight)
    own = max(float(np.linalg.norm(slopes[problem.best], axis=1).max()), np.finfo(float).tiny)
    return float(miss) / max(own, 1.0), {
        name: float(weight / max(abs(top), ACTIVE)) for name, weight in held.items()
    }


def _run(problem: Problem, start: Array, elastic: bool) -> Array:
    """One run: of the value made best, or (`elastic`) of the excess over the bounds."""
    count = len(start)
    values, _slopes = problem.measured(start)
    limits = _targets(problem)
    if elastic:
        top = max(float((values[name] - limit).max()) for name, limit in limits.items())
    else:
        top = float(values[problem.best].max())

    def room(z: Array) -> Array:
        values, _slopes = problem.measured(z[:count])
        kept = [limit - values[name] + (z[-1] if elastic else 0.0) for name, limit in limits.items()]
        return np.concatenate(kept if elastic else [z[-1] - values[problem.best], *kept])

    def room_slope(z: Array) -> Array:
        _values, slopes = problem.measured(z[:count])
        kept = [_with(-slopes[name], 1.0 if elastic else 0.0) for name in limits]
        return np.concatenate(kept if elastic else [_with(-slopes[problem.best], 1.0), *kept])

    result = minimize(
        lambda z: float(z[-1]),
        np.append(start, top),
        jac=lambda z: np.append(np.zeros(count), 1.0),
        method="SLSQP",
        bounds=[(0.0, 1.0)] * count + [(-0.02 if elastic else None, None)],
        constraints={"type": "ineq", "fun": room, "jac": room_slope},
        options={"ftol": TOLERANCE, "maxiter": ROUNDS},
    )
    end = np.clip(result.x[:count], 0.0, 1.0)
    return np.asarray(end if np.isfinite(end).all() else start)


def _targets(problem: Problem) -> dict[str, float]:
    """Scaled bounds with their signs, tighter by what rounding may take."""
    return {
        name: measure.sign * bound / problem.scale(name) - 0.5 * KEPT
        for name, (measure, bound) in problem.limits.items()
    }


def _with(slopes: Array, last: float) -> Array:
    return np.concatenate([slopes, np.full((len(slopes), 1), last)], axis=1)


def _worst(problem: Problem, share: Array) -> float:
    return max(problem.excess(share).values())


def _judged(problem: Problem, share: Array) -> Found:
    best = problem.extremes(share)[problem.best][0]
    sign = problem._measures[problem.best].sign
    return Found(share, _worst(problem, share), sign * best / problem.scale(problem.best))


def _ranked(found: Sequence[Found]) -> list[Found]:
    best = found[0]
    for one in found[1:]:
        best = one if one.better_than(best) else best
    return [best, *(one for one in found if one is not best)]


def _exchanged(problem: Problem, found: Found) -> Found:
    """The search goes on with the worst angles between those looked at, until none is worse."""
    best = replace(found, excess=np.inf)
    share = found.share
    admissible = found.excess <= 1e-3
    for _round in range(EXCHANGES):
        places = [at for _value, at in problem.extremes(share).values()]
        step = abs(problem.family.mesh.ends[1] - problem.family.mesh.ends[0]) / 1600
        first, last = problem.family.mesh.ends
        near = [at + shift * step for at in places for shift in (-1, 0, 1)]
        problem.more = sorted({*problem.more, *(at for at in near if first <= at <= last)})
        share = _run(problem, share, elastic=not admissible)
        now = _judged(problem, share)
        settled = abs(now.value - best.value) <= 1e-12 and now.excess <= KEPT
        best = now if now.better_than(best) or np.isinf(best.excess) else best
        if settled:
            break
    return best
