"""What friction takes: power and work of each contact, efficiency, and where loads no longer drive."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.amounts import Friction, Square
from centrode.dynamics.friction.rubbing import Rubbed
from centrode.dynamics.loads import Acting

Array: TypeAlias = npt.NDArray[np.float64]
Codes: TypeAlias = npt.NDArray[np.int8]
NOISE = 2.0**-40
"""Powers below this share of the greatest are rounding."""
FREE, HELD, JAMMED = 0, 1, 2
LOCKING = {FREE: "free", HELD: "held", JAMMED: "jammed"}


@dataclass(frozen=True)
class Powers:
    """Everything that gives or takes energy, as moments along the path's parameter; power is the moment times `rate`.

    Attributes
    ----------
    drives, loads : (n, drives), (n, loads)
        Loads other than friction.
    inertia, lost : (n)
        Inertia of all links together; all friction, what a load of a given size takes among it.
    rate : (n)
    """

    drives: Array
    loads: Array
    inertia: Array
    lost: Array
    rate: Array

    @classmethod
    def of(
        cls, drives: Array, loads: Sequence[Acting], shares: Array, total: Array, rubbed: Rubbed, rate: Array
    ) -> Powers:
        """`drives` (n, drives) give, `shares` (loads, 1, n) and, with inertia, `total` (1, n) do without friction."""
        rubbing = np.array([_rubs(load) for load in loads], dtype=bool)
        by_load = shares[:, 0].T
        return cls(
            drives,
            by_load[:, ~rubbing],
            total[0] - by_load.sum(axis=1),
            -rubbed.moment - by_load[:, rubbing].sum(axis=1),
            rate,
        )

    @property
    def efficiency(self) -> Array:
        """Share (n) of the power that is given which friction does not take; NaN where none is given."""
        parts = np.column_stack([self.drives, self.loads, self.inertia]) * self.rate[:, None]
        return _efficiency(parts, self.lost * self.rate)

    def mean_efficiency(self, parameter: Array) -> float:
        """The same of works over all samples; each drive, each load and inertia counts with what it gives in all."""
        parts = np.column_stack([self.drives, self.loads, self.inertia])
        works, lost = (works_over(parameter, self.rate, values) for values in (parts, self.lost[:, None]))
        return float(_efficiency(works[None], lost)[0])

    @property
    def locking(self) -> Codes:
        """HELD (n) where loads and inertia would drive the mechanism without friction, and do not with it."""
        outer = (self.loads.sum(axis=1) + self.inertia) * self.rate
        driving = self.drives.sum(axis=1) * self.rate
        noise = NOISE * (np.abs(self.loads).sum(axis=1) + np.abs(self.inertia)) * np.abs(self.rate)
        with np.errstate(invalid="ignore"):
            held = (outer > noise) & (driving >= 0.0)
        return np.where(held, HELD, FREE).astype(np.int8)


def works_over(parameter: Array, rate: Array, moments: Array) -> Array:
    """Works (m) of moments (n, m) along a parameter, by the trapezoidal rule, in the sense in which `rate` goes.

    The samples may be told backwards.
    """
    way = np.abs(np.diff(parameter))[:, None]
    values = moments * np.sign(rate)[:, None]
    return np.asarray((0.5 * way * (values[1:] + values[:-1])).sum(axis=0))


def _rubs(load: Acting) -> bool:
    return bool(load.efforts) and all(
        isinstance(effort.amount, (Friction, Square)) for effort in load.efforts
    )


def _efficiency(parts: Array, lost: Array) -> Array:
    given = np.maximum(parts, 0.0).sum(axis=1)
    noise = NOISE * np.abs(parts).max(axis=1, initial=0.0)
    with np.errstate(all="ignore"):
        return np.where(given > noise, np.maximum(1.0 - lost / given, 0.0), np.nan)
