"""The search for a return arc within bounds: linear, then quadratic programmes over the weights of additions."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linprog, minimize

from centrode.cams.closed.bounds import MOST, Bounds
from centrode.cams.closed.curves import Ends, ReturnCurve, derivatives
from centrode.cams.frames import Array

NODES = 181
SLACK = 1e-6
"""Least room that is kept to a bound at the nodes, over the size; grows to what is missed between them."""
MOST_ROOM = 1e-3
ITERATIONS = 200
STEPS = 60
LEAST_STEP = 1e-7
ENOUGH = 0.3
"""Share of what tangents promise that a step has to gain, or the next is shorter."""


class Search:
    """Bounds at nodes as constraints on weights; lengths over `scale`, `basis` makes roughness the sum of squares."""

    def __init__(self, ends: Ends, bounds: Bounds, basis: Array, scale: float) -> None:
        self.ends, self.bounds, self.scale = ends, bounds, scale
        # the ends are given: nothing moves there
        self.nodes = np.linspace(ends.start, ends.stop, NODES)[1:-1]
        self.still = ReturnCurve(ends).radius(self.nodes, 2) / scale
        self.moving = np.tensordot(basis.T, derivatives(ends, self.nodes, 2, MOST)[-MOST:], axes=1)
        given = ReturnCurve(ends).radius(np.array([ends.start, ends.stop]), 2) / scale
        at_ends, _gradients = bounds.margins(given, np.zeros((MOST, 3, 2)), scale)
        # a bound that the ends nearly touch leaves no more room than half of what they have
        room = np.maximum(0.5 * at_ends.reshape(-1, 2).min(axis=1), 0.0)
        self.most_room = np.repeat(room, len(self.nodes))
        self.room = np.minimum(SLACK, self.most_room)

    def margins(self, weights: Array) -> tuple[Array, Array]:
        """Margins (m) beyond the room at the nodes and their gradients (m, weights)."""
        rho = self.still + np.tensordot(weights, self.moving, axes=1)
        margins, gradients = self.bounds.margins(rho, self.moving, self.scale)
        return margins - self.room, gradients

    def least(self, weights: Array) -> float:
        """The least margin, less the room."""
        return float((self.margins(weights)[0] + self.room).min())

    def between(self, curve: ReturnCurve) -> None:
        """Widen the room by what a curve misses between the nodes."""
        places = np.linspace(self.ends.start, self.ends.stop, 16 * NODES)
        margins, _gradients = self.bounds.margins(
            curve.radius(places, 2) / self.scale, np.zeros((MOST, 3, len(places))), self.scale
        )
        missed = -np.minimum(margins.reshape(-1, len(places)).min(axis=1), 0.0)
        wider = self.room + 1.3 * np.repeat(missed, len(self.nodes)) + SLACK
        self.room = np.minimum(np.minimum(wider, MOST_ROOM), self.most_room)

    def feasible(self, weights: Array) -> Array:
        """Weights whose least margin is not negative, else the greatest that is found.

        Each step is a linear programme within a box about the weights, which shrinks where the step does not do
        what its tangents promise.
        """
        margins, slopes = self.margins(weights)
        size = 1.0
        for _step in range(STEPS):
            if margins.min() >= 0.0 or size < LEAST_STEP:
                break
            found = linprog(
                np.append(np.zeros(MOST), -1.0),
                np.pad(-slopes, ((0, 0), (0, 1)), constant_values=1.0),
                margins,
                bounds=[(-size, size)] * MOST + [(None, MOST_ROOM)],
            )
            if found.status != 0:
                break
            tried, promised = weights + found.x[:-1], float(found.x[-1] - margins.min())
            there = self.margins(tried)
            gained = float(there[0].min() - margins.min())
            if gained < ENOUGH * promised:
                size *= 0.4
            if gained > 0.0:
                weights, (margins, slopes) = tried, there
            if promised < SLACK * SLACK:
                break
        return weights

    def smoothest(self, weights: Array) -> Array:
        """From weights that keep the bounds, those with the least sum of squares that do."""
        found = minimize(
            lambda x: (float(x @ x), 2.0 * x),
            weights,
            jac=True,
            method="SLSQP",
            constraints={
                "type": "ineq",
                "fun": lambda x: self.margins(x)[0],
                "jac": lambda x: self.margins(x)[1],
            },
            options={"maxiter": ITERATIONS, "ftol": 1e-10},
        )
        return np.asarray(found.x) if self.least(found.x) >= 0.0 else weights
