"""Where a drive's law jumps or has no value: no mechanism moves like that.

A formula jumps only where a sign, an angle by atan2, a logarithm or a divisor changes its sign or touches zero.
These numbers are looked at on a mesh of time, the places are halved down to rounding, and there the values of the
law on both sides are compared: a change that does not shrink with the stretch it is taken over is a jump.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.laws import Law, TextLaw
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.search import bisect, newton_roots

Array: TypeAlias = npt.NDArray[np.float64]
Places: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any

NODES = 4096
"""Of the mesh of time."""
MOST = 128
"""Places at which one number changes its sign that are looked at, the earliest ones."""
NEAR, FAR = 2.0**-44, 2.0**-24
"""Distances to both sides of a place, as shares of the range."""
KEPT = 0.1
"""A jump keeps more than this share of its change from far to near; a square root keeps a thousandth."""


@dataclass(frozen=True)
class Jump:
    """A jump of a law at a time [s], from a value to another [rad or m]; to NaN where the law has no finite value."""

    time: float
    before: float
    after: float


class _Watching(JetFunctions):
    """Jets that keep the numbers at whose zeros a formula may jump, in the order in which they come up."""

    def __init__(self) -> None:
        super().__init__(ARRAYS)
        self.kept: list[Jet] = []

    def divisor(self, x: Number) -> Number:
        """Divisor unchanged; it is kept, as a law may jump at its zero."""
        return self._keep(x)

    def sign(self, x: Number) -> Number:
        return super().sign(self._keep(x))

    def tan(self, x: Number) -> Number:
        return self.sin(x) / self._keep(self.cos(x))

    def atan2(self, y: Number, x: Number) -> Number:
        return super().atan2(self._keep(y), x)

    def log(self, x: Number) -> Number:
        return super().log(self._keep(x))

    def _keep(self, x: Number) -> Number:
        if isinstance(x, Jet):
            self.kept.append(x)
        return x


def first_jump(law: Law, first: float, last: float, least: float) -> Jump | None:
    """The first jump by more than `least` [rad or m] between two times [s], or place without a value; None without.

    Only formulas jump: tables, segments and cams are continuous by their making.
    """
    if not isinstance(law, TextLaw) or not last > first:
        return None
    mesh = np.linspace(first, last, NODES)
    places = np.concatenate([_suspects(law, mesh), mesh[~np.isfinite(_values(law, mesh))]])
    if not len(places):
        return None
    # shares of the range in times as great as those at which the law is looked at, so that sums with them do
    # not vanish
    width = max(last - first, abs(first), abs(last))
    here = _values(law, places)
    near, far = (
        [_values(law, np.clip(places + side * share * width, first, last)) for side in (-1.0, 1.0)]
        for share in (NEAR, FAR)
    )
    with np.errstate(all="ignore"):
        close, wide = (np.abs([after - before, here - before, after - here]) for before, after in (near, far))
        # from far to near a continuous law loses most of its change
        jumps = ((close > least) & (close > KEPT * wide)).any(axis=0)
        # a pole grows towards the place: it has no value there, and is no jump
        grows = (close > 2.0 * wide + least).any(axis=0)
    absent = ~np.isfinite(here) | ~np.isfinite(close).all(axis=0) | (jumps & grows)
    jumping = np.flatnonzero(jumps | absent)
    if not len(jumping):
        return None
    k = jumping[np.argmin(places[jumping])]
    # next to zero the time is rounding of the range, and zero is what is meant
    time = places[k] if abs(places[k]) > NEAR * width else 0.0
    return Jump(float(time), float(near[0][k]), np.nan if absent[k] else float(near[1][k]))


def _suspects(law: TextLaw, mesh: Array) -> Array:
    """Times at which a number whose zeros matter changes its sign, or turns round towards zero."""
    suspects = [np.empty(0)]
    for number, jet in enumerate(_watched_jets(law, mesh, 1)):
        value, slope = (np.broadcast_to(jet.derivative(k), mesh.shape) for k in (0, 1))
        with np.errstate(all="ignore"):
            # it falls towards zero at the first node and rises from it at the second: it may touch zero
            # between
            dips = (value[:-1] * slope[:-1] < 0.0) & (value[1:] * slope[1:] >= 0.0)
        cells = np.flatnonzero(dips & (np.sign(value[:-1]) == np.sign(value[1:])))
        nodes = mesh
        if len(cells):
            turns = _turns(law, number, mesh[cells], mesh[cells + 1])
            suspects.append(turns)
            # the turning place is a node as well: on both sides signs are compared with it
            nodes = np.unique(np.append(mesh, turns))
        suspects.append(_changes(law, number, nodes))
    return np.concatenate(suspects)


def _turns(law: TextLaw, number: int, low: Array, high: Array) -> Array:
    """Where a number turns round."""

    def slope(x: Array) -> tuple[Array, Array]:
        jet = _watched_jets(law, x, 2)[number]
        return np.broadcast_to(jet.derivative(1), x.shape), np.broadcast_to(jet.derivative(2), x.shape)

    return newton_roots(slope, low, high)


def _changes(law: TextLaw, number: int, nodes: Array) -> Array:
    """Where a number changes its sign, zero being a sign of its own."""

    def sign(x: Array) -> Array:
        return np.broadcast_to(np.sign(_watched_jets(law, x, 0)[number].value), x.shape)

    at = sign(nodes)
    # the earliest places suffice: only the first jump is reported
    cells = np.flatnonzero(at[:-1] != at[1:])[:MOST]
    return bisect(lambda x: sign(x) == at[cells], nodes[cells], nodes[cells + 1])[1]


def _watched_jets(law: TextLaw, time: Array, order: int) -> list[Jet]:
    watching = _Watching()
    with np.errstate(all="ignore"):
        law.jet(watching, Jet.variable(time, order))
    return watching.kept


def _values(law: TextLaw, time: Array) -> Array:
    with np.errstate(all="ignore"):
        return np.broadcast_to(np.asarray(law.jet(ARRAYS, time), dtype=np.float64), time.shape)
