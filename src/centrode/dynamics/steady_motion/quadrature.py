"""Integrals of what is smooth but for jumps: composite Gauss-Legendre quadrature with its error.

Functions are given at Gauss nodes of panels, which end at the jumps. Each panel holds the Legendre series
through its nodes, so that values and integrals exist everywhere, not at the nodes alone. Panels whose series
has not died away are halved. Source: Gauss-Legendre quadrature and the recurrence of its polynomials, NIST
Handbook of Mathematical Functions, sections 3.5(v) and 18.9.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from numpy.polynomial import legendre

Array: TypeAlias = npt.NDArray[np.float64]
Function: TypeAlias = Callable[[Array], Array]

NODES = 12
"""Gauss nodes of a panel."""
NOISE = 1e-9
"""Last terms, over the greatest value, that are noise (of change points passed) where halving makes them no smaller."""
MOST_PANELS = 4000
MOST_ROUNDS = 45
"""Halvings after which a jump that nobody announced lies in a panel of no importance."""

_ROOTS, _WEIGHTS = legendre.leggauss(NODES)
_ORDERS = np.arange(NODES)
_TO_SERIES = (legendre.legvander(_ROOTS, NODES - 1) * _WEIGHTS[:, None] * (_ORDERS + 0.5)).T


@dataclass(frozen=True)
class Panels:
    """Stretches of a range, end to end: `edges` (panels + 1), growing."""

    edges: Array

    @cached_property
    def nodes(self) -> Array:
        """Gauss nodes (panels * NODES), growing."""
        return _nodes(self.edges[:-1], self.edges[1:]).reshape(-1)

    @cached_property
    def ends_and_nodes(self) -> Array:
        """Edges and nodes together, growing: where extremes are looked for."""
        return np.unique(np.concatenate([self.nodes, self.edges]))

    @cached_property
    def weights(self) -> Array:
        """Weights of the nodes (panels * NODES): the integral is the sum of weight times value."""
        return (0.5 * np.diff(self.edges)[:, None] * _WEIGHTS).reshape(-1)

    def series(self, values: Array) -> Series:
        """The function that has these values (panels * NODES) at the nodes."""
        return Series(self, values.reshape(-1, NODES) @ _TO_SERIES.T)


@dataclass(frozen=True)
class Series:
    """A function on panels: `coefficients` (panels, NODES) of Legendre polynomials."""

    panels: Panels
    coefficients: Array

    def at(self, places: Array) -> Array:
        """Values at places within the range; at a jump the one behind it."""
        panel, inner = self._inside(places)
        found = np.einsum("...k,...k->...", legendre.legvander(inner, NODES - 1), self.coefficients[panel])
        return np.asarray(found)

    def integral(self, places: Array) -> Array:
        """Integrals from the first edge to places within the range."""
        panel, inner = self._inside(places)
        inside = np.einsum("...k,...k->...", legendre.legvander(inner, NODES), self._antiderivative[panel])
        return np.asarray(self._before[panel] + inside)

    @property
    def total(self) -> float:
        """The integral over the whole range."""
        return float(self._before[-1])

    @property
    def error(self) -> float:
        """Bound of what the series leave out of `total`: their last two terms, over all panels."""
        return float(np.sum(tails(self.coefficients) * np.diff(self.panels.edges)))

    def _inside(self, places: Array) -> tuple[npt.NDArray[np.intp], Array]:
        """Panel of each place, and where in it, from -1 to 1."""
        edges = self.panels.edges
        panel = np.clip(np.searchsorted(edges, places, side="right") - 1, 0, len(edges) - 2)
        low, high = edges[panel], edges[panel + 1]
        return panel, (2.0 * places - low - high) / (high - low)

    @cached_property
    def _antiderivative(self) -> Array:
        """Coefficients (panels, NODES + 1) of the integral from each panel's beginning."""
        half = 0.5 * np.diff(self.panels.edges)[:, None]
        shares = half * self.coefficients / (2 * _ORDERS + 1)
        found = np.zeros((len(shares), NODES + 1))
        found[:, 1:] += shares
        found[:, : NODES - 1] -= shares[:, 1:]
        found[:, 0] += shares[:, 0]  # of P_0 the integral is P_1 + 1
        return found

    @cached_property
    def _before(self) -> Array:
        """Integrals from the first edge to every edge."""
        widths = np.diff(self.panels.edges)
        return np.concatenate([[0.0], np.cumsum(widths * self.coefficients[:, 0])])


def tails(coefficients: Array) -> Array:
    """The last terms of series (..., NODES): what they may leave out."""
    return np.asarray(np.max(np.abs(coefficients[..., -2:]), axis=-1))


def resolved(
    functions: Function, edges: Array, tolerances: Sequence[float], scales: Function = np.asarray
) -> tuple[Panels, Array]:
    """Panels on which several functions are smooth enough, and their values at the nodes.

    Parameters
    ----------
    functions : places (n) -> values (functions, n)
    edges : (any) growing
        The ends of the range with the jumps that are known, and as many places between as a first look needs.
    tolerances : one a function
        What a panel's series may leave out of an integral, over the greatest value times the whole range.
    scales : greatest values (functions) -> (functions)
        What counts as the greatest value, where a function may be nothing but rounding beside another.

    Returns
    -------
    panels, values (functions, panels * NODES)
        Halved until the series leave out less than that, or there are `MOST_PANELS`; `Series.error` tells
        what is left.
    """
    low, high = edges[:-1], edges[1:]
    done: list[tuple[Array, Array]] = []
    span, allowed = float(edges[-1] - edges[0]), np.asarray(tolerances)
    count, peak = len(low), np.zeros(0)
    before = np.full((len(allowed), count), np.inf)  # the last terms of the panel that each one is half of
    for _round in range(MOST_ROUNDS):
        values = functions(_nodes(low, high).reshape(-1)).reshape(-1, len(low), NODES)
        greatest = np.max(np.abs(values), axis=(1, 2))
        peak = greatest if not peak.size else np.maximum(peak, greatest)
        scale = scales(peak)[:, None]
        last = tails(values @ _TO_SERIES.T)
        too_great = last * (high - low) > span * allowed[:, None] * scale
        resolvable = (last < before / 4) | (last > NOISE * scale)
        coarse: npt.NDArray[np.bool_] = np.any(too_great & resolvable, axis=0)
        if count + int(coarse.sum()) > MOST_PANELS:
            coarse[:] = False
        done.append((low[~coarse], values[:, ~coarse]))
        if not coarse.any():
            break
        count += int(coarse.sum())
        middle = 0.5 * (low[coarse] + high[coarse])
        before = np.concatenate([last[:, coarse]] * 2, axis=1)
        low, high = np.concatenate([low[coarse], middle]), np.concatenate([middle, high[coarse]])
    else:
        done.append((low, functions(_nodes(low, high).reshape(-1)).reshape(-1, len(low), NODES)))
    firsts = np.concatenate([part[0] for part in done])
    order = np.argsort(firsts)
    panels = Panels(np.append(firsts[order], edges[-1]))
    together = np.concatenate([part[1] for part in done], axis=1)[:, order]
    return panels, together.reshape(len(together), -1)


def _nodes(low: Array, high: Array) -> Array:
    return 0.5 * (low + high)[:, None] + 0.5 * (high - low)[:, None] * _ROOTS
