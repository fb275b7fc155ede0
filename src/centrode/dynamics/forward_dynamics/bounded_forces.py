"""Forces of contacts within bounds: w = W f + q, where each force is at a bound or its acceleration w is zero.

A linear complementarity problem with bounds on both sides (R. W. Cottle, J.-S. Pang and R. E. Stone, The Linear
Complementarity Problem, 1992, chapter 4). W is the inverse of the mass that the contacts feel: symmetric, and singular
where contacts hold the same thing twice. Then some of all solutions is taken.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

SLACK = 1e-12
"""Share of what the forces and their accelerations are made of by which a bound may be passed."""
BLOCKS, CHANGES, SWEEPS = 20, 200, 5000
"""Changes of all that are wrong at once, then of the first one (Murty's rule); sweeps where that goes round."""


def forces_within(matrix: Array, right: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """Forces f within bounds, and w = W f + q: zero between the bounds, >= 0 at the low one, <= 0 at the high one.

    Parameters
    ----------
    matrix, right : W (n, n), symmetric without negative eigenvalues, and q (n)
    low, high : (n), bounds that may be infinite
    """
    count = len(right)
    if count == 0:
        return np.zeros(0), np.zeros(0)
    if count == 1:
        return _one_force(float(matrix[0, 0]), float(right[0]), float(low[0]), float(high[0]))
    at = np.zeros(count, dtype=int)
    size = np.abs(right) + SLACK
    for change in range(CHANGES):
        force = np.where(at < 0, low, np.where(at > 0, high, 0.0))
        inner = np.flatnonzero(at == 0)
        if len(inner):
            rest = -(right + matrix @ force)[inner]
            force[inner] = np.linalg.lstsq(matrix[np.ix_(inner, inner)], rest, rcond=1e-11)[0]
        w = matrix @ force + right
        reach = SLACK * (np.max(np.abs(force)) + 1.0)
        scale = SLACK * (np.max(size) + np.max(np.abs(matrix)) * np.max(np.abs(force)))
        above, below = (at == 0) & (force > high + reach), (at == 0) & (force < low - reach)
        # a row that others imply has no force of its own: what is left of it is no acceleration
        freed = ((at < 0) & (w < -scale)) | ((at > 0) & (w > scale))
        wrong = np.flatnonzero(above | below | freed)
        if not len(wrong):
            # what the others hold and still is pushed goes to its bound
            left = (at == 0) & (np.abs(w) > 1e3 * scale) & np.isfinite(np.where(w > 0.0, low, high))
            if not np.any(left):
                return np.clip(force, low, high), w
            k = int(np.argmax(np.where(left, np.abs(w), -1.0)))
            at[k] = -1 if w[k] > 0.0 else 1
            continue
        changed = wrong if change < BLOCKS else wrong[:1]
        for k in changed:
            at[k] = 1 if above[k] else -1 if below[k] else 0
    return _swept(matrix, right, low, high)


def _swept(matrix: Array, right: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """The same by sweeps of Gauss and Seidel, which creep towards a solution whatever the matrix."""
    force = np.clip(np.zeros(len(right)), low, high)
    for _sweep in range(SWEEPS):
        before = force.copy()
        for k, own in enumerate(np.diag(matrix)):
            if own > 0.0:
                force[k] = min(max(force[k] - (matrix[k] @ force + right[k]) / own, low[k]), high[k])
        if np.max(np.abs(force - before)) <= SLACK * np.max(np.abs(force)):
            break
    return force, matrix @ force + right


def _one_force(mobility: float, right: float, low: float, high: float) -> tuple[Array, Array]:
    force = min(max(-right / mobility if mobility > 0.0 else 0.0, low), high)
    return np.array([force]), np.array([mobility * force + right])


def impulses_of_impact(
    matrix: Array, before: Array, restitution: Sequence[float], is_stop: npt.NDArray[np.bool_]
) -> tuple[Array, Array]:
    """Impulses of stops and clamps, and their relative speeds after an impact, by Newton's law of restitution.

    Parameters
    ----------
    matrix, before : W (n, n), and speeds away from the bounds (n), negative where something hits
    restitution : of each
    is_stop : a stop pushes only, a clamp holds both ways

    Where different restitutions would make energy, the least of them holds for all: then none is gained.
    """
    if len(before) == 1 and is_stop[0]:
        impulse = np.maximum(-(1.0 + restitution[0]) * before / matrix[0], 0.0)
        return impulse, before + matrix[0] * impulse
    low = np.where(is_stop, 0.0, -np.inf)
    high = np.full(len(before), np.inf)
    factors = np.where(is_stop, restitution, 0.0)
    for shares in (
        factors,
        np.full(len(before), np.min(factors[before < 0.0], initial=0.0)),
        np.zeros(len(before)),
    ):
        aim = before + shares * np.minimum(before, 0.0)
        impulses, _rest = forces_within(matrix, aim, low, high)
        after = before + matrix @ impulses
        if float(impulses @ (before + after)) <= SLACK * float(np.sum(np.abs(impulses * before))):
            break
    return impulses, after
