"""Designs with parameters in a box: the measures of a design, and their slopes by the parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from centrode.cams.choosing.measures import ALWAYS, MEASURES, Measure
from centrode.cams.choosing.tried import Mesh, Trial, Tried, paths_of
from centrode.cams.contacts.line import Contact

Array = NDArray[np.float64]

ANGLES = 41
"""Angles at which a search looks at each measure; the worst ones in between are added as they show up."""
DENSE = 1601
"""Angles at which the worst ones are looked for."""
STEP = 2e-6
"""Of a parameter, as a part of its range: central differences of a smooth function, good to some 1e-10."""


@dataclass(frozen=True)
class Family:
    """Designs that differ by some numbers.

    Attributes
    ----------
    names : tuple of str
        Of the parameters.
    low, high : (n,)
        Ends of their ranges, in SI.
    trial : callable
        A design from its parameters (n,).
    contact : Contact or None
        What presses the roller; its radius is that of the trial.
    """

    names: tuple[str, ...]
    low: Array
    high: Array
    trial: Callable[[Array], Trial]
    mesh: Mesh
    contact: Contact | None = None

    def values(self, share: Array) -> Array:
        """Parameters in SI from their places in the box (n,), 0 to 1."""
        return np.asarray(self.low + share * (self.high - self.low))

    def share(self, values: Array) -> Array:
        """Places in the box from parameters in SI, those beyond an end moved to it."""
        return np.clip((values - self.low) / (self.high - self.low), 0.0, 1.0)

    def paths(self, shares: Array, phi: Array) -> Tried:
        """Paths of designs (count, n) at angles."""
        return paths_of([self.trial(self.values(share)) for share in shares], self.mesh, phi)


@dataclass
class Problem:
    """The measures that are bounded, with the one to be made best.

    Attributes
    ----------
    family : Family
    best : str
        Name of the measure to be made best.
    bounds : mapping of name -> float
        Greatest (or least) values in SI.
    more : list of (n,) [rad]
        Further angles to look at.
    """

    family: Family
    best: str
    bounds: Mapping[str, float]
    more: list[float] = field(default_factory=list)
    _known: tuple[bytes, dict[str, Array], dict[str, Array]] | None = field(default=None, repr=False)

    @property
    def limits(self) -> dict[str, tuple[Measure, float]]:
        """Measure and bound of every constraint, those of every design included."""
        asked = {name: (MEASURES[name], bound) for name, bound in self.bounds.items()}
        return {**ALWAYS, **asked}

    @property
    def phi(self) -> Array:
        """The angles that are looked at; the last one is the end of the working arc."""
        first, last = self.family.mesh.ends
        return np.unique(np.concatenate([np.linspace(first, last, ANGLES), [0.0], self.more]))

    def scale(self, name: str) -> float:
        """What a measure is divided by: its bound, or that of the best design seen at the start."""
        bound = abs(self.limits[name][1]) if name in self.limits else 0.0
        return bound or self._references.get(name, 1.0)

    def measured(self, share: Array) -> tuple[dict[str, Array], dict[str, Array]]:
        """Measures (m,) with their signs, over their scales, and slopes (m, n) by the places in the box."""
        key = share.tobytes() + bytes(str(len(self.more)), "ascii")
        if self._known is None or self._known[0] != key:
            lanes, weights = _differences(share)
            tried = self.family.paths(lanes, self.phi)
            values, slopes = {}, {}
            for name, measure in self._measures.items():
                found = measure.of(tried, self.family.contact) / self.scale(name)
                values[name], slopes[name] = found[:, 0], found @ weights
            self._known = (key, values, slopes)
        return self._known[1], self._known[2]

    def extremes(self, share: Array) -> dict[str, tuple[float, float]]:
        """Each measure's worst value in SI, and the angle [rad] where it is, on a dense row of angles."""
        first, last = self.family.mesh.ends
        phi = np.unique(np.concatenate([np.linspace(first, last, DENSE), [0.0]]))
        tried = self.family.paths(share[None], phi)
        found = {}
        for name, measure in self._measures.items():
            values = measure.of(tried, self.family.contact)[:, 0]
            at = int(np.argmax(values))
            place = float(phi[-1]) if measure.whole else float(phi[at % len(phi)])
            found[name] = (measure.sign * float(values[at]), place)
        return found

    def excess(self, share: Array) -> dict[str, float]:
        """By how much of its bound each constraint is missed; negative where there is room."""
        found = self.extremes(share)
        return {
            name: measure.sign * (found[name][0] - bound) / (abs(bound) or self.scale(name))
            for name, (measure, bound) in self.limits.items()
        }

    @property
    def _measures(self) -> dict[str, Measure]:
        return {self.best: MEASURES[self.best], **{name: one for name, (one, _bound) in self.limits.items()}}

    @property
    def _references(self) -> dict[str, float]:
        """Sizes of measures without a bound: the greatest of some designs, one alone may be round with no angle."""
        if not hasattr(self, "_sizes"):
            count = len(self.family.names)
            some = np.stack([np.full(count, share) for share in (0.25, 0.5, 0.75)])
            middle = self.family.paths(some, self.phi)
            self._sizes = {
                name: float(np.max(np.abs(one.of(middle, self.family.contact)))) or 1.0
                for name, one in self._measures.items()
            }
        return self._sizes


def _differences(share: Array) -> tuple[Array, Array]:
    """Places in the box (2 n + 1, n), and weights (2 n + 1, n) that make slopes of the values there.

    Both neighbours where there is room, else two on the side of the box: a parameter must not leave its range.
    """
    count = len(share)
    near = np.where(share < STEP, 1.0, np.where(share > 1 - STEP, -1.0, 0.0))
    first, second = np.where(near, near, 1.0), np.where(near, 2 * near, -1.0)
    unit = np.eye(count)
    lanes = np.concatenate([share[None], share + STEP * first * unit, share + STEP * second * unit])
    weights = np.concatenate(
        [
            (-1.5 * near)[None],
            np.diag(np.where(near, 2.0 * near, 0.5)),
            np.diag(np.where(near, -0.5 * near, -0.5)),
        ]
    )
    return lanes, weights / STEP
