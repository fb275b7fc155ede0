"""The curve of positions of a mechanism, walked along its arc from the initial position until the crank turns back."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from tools.campaigns.closure.equations import Equations

Array = npt.NDArray[np.float64]
FIRST, GREATEST, LEAST = 0.02, 0.2, 1e-7
"""Steps along the arc."""
STRAIGHT = 0.99
"""Cosine of the turn of the tangent that a step may make."""
STEPS = 600
FAR = 15.0
"""Coordinates at which a walk is given up: a point that runs to infinity."""


@dataclass
class Walk:
    """Places along the curve on one side of the start, and what ended it: `limit` is the crank's angle at a limit."""

    nodes: list[Array] = field(default_factory=list)
    limit: float | None = None
    given_up: bool = False

    def near(self, q: float) -> Array:
        """The unknowns at the node whose crank angle is nearest to q, moved along to q."""
        angles = np.array([node[-1] for node in self.nodes])
        k = int(np.argmin(abs(angles - q)))
        other = (
            k + 1
            if k + 1 < len(self.nodes) and (k == 0 or (angles[k + 1] - q) * (angles[k] - q) <= 0)
            else k - 1
        )
        a, b = self.nodes[k], self.nodes[other]
        share = (q - a[-1]) / (b[-1] - a[-1]) if b[-1] != a[-1] else 0.0
        return np.asarray((a + share * (b - a))[:-1])


def tangent(closure: Equations, y: Array, along: Array) -> Array:
    """Direction of the curve, in the sense of another direction."""
    rows = closure.jacobian(y[:-1], float(y[-1]))
    bordered = np.vstack([rows, along])
    right = np.zeros(len(y))
    right[-1] = 1.0
    try:
        found = np.linalg.solve(bordered, right)
    except np.linalg.LinAlgError:
        found = np.linalg.svd(rows)[2][-1]
        found *= np.sign(found @ along)
    return np.asarray(found / np.linalg.norm(found))


def corrected(closure: Equations, y: Array, along: Array) -> Array | None:
    """The place of the curve on the plane through y square to a direction; None where Newton's method fails."""
    x = y.copy()
    for turn in range(8):
        rows = np.vstack([closure.jacobian(x[:-1], float(x[-1])), along])
        wrong = np.append(closure.values(x[:-1], float(x[-1])), along @ (x - y))
        try:
            step = np.linalg.solve(rows, wrong)
        except np.linalg.LinAlgError:
            return None
        x -= step
        size = float(np.max(abs(step)))
        if size < 1e-12 * (1.0 + float(np.max(abs(x)))):
            return x
        if not size < 1.0 or (turn == 5 and size > 1e-6):
            return None
    return x


def walked(closure: Equations, way: float, until: float) -> Walk:
    """Walk from the start, way = 1 with growing and -1 with falling angle of the crank, so far or to a limit."""
    y = np.append(closure.start, closure.begun)
    found = Walk([y])
    sense = np.zeros(len(y))
    sense[-1] = way
    along = tangent(closure, y, sense)
    step = FIRST
    for _ in range(STEPS):
        new = corrected(closure, y + step * along, along)
        bent = None if new is None else tangent(closure, new, along)
        if new is None or bent is None or bent @ along < STRAIGHT:
            step /= 2.0
            if step < LEAST:
                break
            continue
        if bent[-1] * way <= 0.0:
            found.limit = turning(closure, y, along, step, way)
            return found
        y, along = new, bent
        found.nodes.append(y)
        if way * (y[-1] - closure.begun) > until:
            return found
        if closure.far(y[:-1]) > FAR:
            break
        step = min(GREATEST, 1.4 * step)
    found.given_up = True
    return found


def turning(closure: Equations, y: Array, along: Array, step: float, way: float) -> float | None:
    """The crank's angle where it turns back, between a place and the next: the slope along the arc vanishes."""
    low, high, at = 0.0, step, y
    for _ in range(45):
        middle = 0.5 * (low + high)
        new = corrected(closure, y + middle * along, along)
        if new is None:
            return None
        at = new
        if tangent(closure, at, along)[-1] * way > 0.0:
            low = middle
        else:
            high = middle
    return float(at[-1])
