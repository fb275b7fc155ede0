"""Harmonics of what inertia does to the frame: Fourier coefficients over a whole cycle of the drive.

At constant speed by the trapezoidal rule on a whole period, which converges faster than any power of the number of
nodes for smooth periodic functions (L. N. Trefethen, J. A. C. Weideman, SIAM Review 56, 2014, 385-458); where loads
make the acceleration jump by Gauss's rule between the jumps.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from centrode.dynamics.balancing.inertial import Array, Complex
from centrode.dynamics.balancing.turning import NODES_PER_TURN, Turning
from centrode.dynamics.steady_motion.quadrature import Panels

MOST_DOUBLINGS = 5
SETTLED = 1e-13
"""Change of the coefficients, over what the parts of the sum amount to, at which the doubling of nodes ends."""


@dataclass(frozen=True)
class Harmonics:
    """F(q) = sum of cosine_k cos(k q) + sine_k sin(k q) over the orders k, q the drive's value.

    Attributes
    ----------
    orders : (orders)
        Times in a turn of the drive; fractions where the cycle has several turns. The first is 0, the mean.
    force_cosine, force_sine : (orders) complex x + i y [N]
    moment_cosine, moment_sine : (orders) [N m]
    nodes : int
        Values of the drive the coefficients come from.
    error : float
        Change of a coefficient with twice the nodes, over what the parts of its sum amount to.
    """

    orders: Array
    force_cosine: Complex
    force_sine: Complex
    moment_cosine: Array
    moment_sine: Array
    nodes: int
    error: float

    @property
    def force_greatest(self) -> Array:
        """Longer half axis of the ellipse that the force of each order describes (orders) [N]."""
        forward, backward = self.force_cosine - 1j * self.force_sine, self.force_cosine + 1j * self.force_sine
        return np.asarray(0.5 * (np.abs(forward) + np.abs(backward)))


def harmonics_of(turning: Turning, most: int) -> Harmonics:
    """Harmonics up to an order of the drive's turns."""
    orders = np.arange(most * turning.turns + 1) / turning.turns
    panels = turning.instants.panels
    count = NODES_PER_TURN * turning.turns
    force, moment = turning.sizes
    sizes = np.array([force or 1.0, force or 1.0, moment or 1.0])  # nothing moves: the sums are zero
    before: Array | None = None
    error = np.inf
    for _doubling in range(MOST_DOUBLINGS):
        if panels is None:
            values, weights = turning.values(count), np.full(count, 1.0 / count)
        else:
            values, weights = _gauss(turning, panels)
        found = _coefficients(turning, orders, values, weights)
        if before is not None:
            error = float(np.max(np.max(np.abs(found - before), axis=(0, 2)) / sizes))
        if error <= SETTLED:
            break
        before, count = found, 2 * count
        panels = None if panels is None else _halved(panels)
    cosine, sine = found
    return Harmonics(
        orders,
        cosine[0] + 1j * cosine[1],
        sine[0] + 1j * sine[1],
        cosine[2],
        sine[2],
        len(values),
        error,
    )


def _coefficients(turning: Turning, orders: Array, values: Array, weights: Array) -> Array:
    """Cosine and sine coefficients (2, 3, orders) of force x, force y and moment."""
    effects = turning.effects(values)
    rows = np.stack([effects.force.real, effects.force.imag, effects.moment])
    waves = np.exp(1j * orders[:, None] * values) * np.where(orders == 0.0, 1.0, 2.0)[:, None]
    found = (rows * weights) @ waves.T
    return np.stack([found.real, found.imag])


def _gauss(turning: Turning, panels: Panels) -> tuple[Array, Array]:
    """Values of the drive at Gauss's nodes of a cycle, and weights that make a mean."""
    sense = np.sign(turning.period)
    return turning.first + sense * panels.nodes, panels.weights / abs(turning.period)


def _halved(panels: Panels) -> Panels:
    middles = 0.5 * (panels.edges[:-1] + panels.edges[1:])
    return Panels(np.sort(np.concatenate([panels.edges, middles])))
