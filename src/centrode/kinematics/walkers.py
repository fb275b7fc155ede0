"""Walkers that follow the groups of higher class of a batch, and the anchors they leave."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.anchors import Anchor, Trail
from centrode.kinematics.newton import System, newton
from centrode.kinematics.surroundings import Surroundings
from centrode.structure.positions import Positions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]

ORDER = 4
"""Of the Taylor polynomials that foretell."""


@dataclass
class Walkers:
    """All mechanisms of a batch, each in one sense of its path: where they are, and how far they step."""

    lane: Lanes
    sense: Array
    end: Array
    step: Array
    trails: list[Trail]
    active: Mask
    smooth: bool

    @property
    def walking(self) -> Lanes:
        """Those that have not arrived."""
        return np.nonzero(self.active)[0]

    def last(self, who: Lanes) -> list[Anchor]:
        """The newest anchors."""
        return [self.trails[k].anchors[-1] for k in who]

    def set_anchor(self, walker: int, anchor: Anchor) -> None:
        """Leave an anchor; a walker past its end has arrived."""
        self.trails[walker].anchors.append(anchor)
        if self.sense[walker] * (anchor.parameter - self.end[walker]) >= 0.0:
            self.active[walker] = False

    def plant(self, around: Surroundings, who: Lanes, parameter: Array, state: Array) -> None:
        """Leave anchors at states that Newton's method still has to bring to the last digit."""
        known = around.known(parameter, self.lane[who], ORDER)
        system = around.system(known, self.lane[who])
        with np.errstate(all="ignore"):
            found = newton(system, state)
            series = taylor(system, known, found.state)
        for k, walker in enumerate(who):
            self.set_anchor(
                walker, Anchor(float(parameter[k]), found.state[k], series[k], float(found.sense[k]))
            )
            if not (found.found[k] and np.isfinite(series[k]).all()):
                self.give_up(walker)

    def give_up(self, walker: int) -> None:
        """The group cannot be followed any further."""
        self.trails[walker].end = "unconverged"
        self.active[walker] = False


def taylor(system: System, known: Positions, state: Array) -> Array:
    """Taylor coefficients of the steps from converged states: (k, order, size)."""
    jets = system.jets(known, state, ORDER)
    return np.stack([np.stack(jet.coefficients[1:], axis=-1) for jet in jets], axis=-1)


def foretell(anchors: list[Anchor], offset: Array) -> Array:
    """Steps (k, size) that the anchors' Taylor polynomials foretell at offsets of the parameter."""
    total = np.zeros((len(anchors), anchors[0].series.shape[1]))
    series = np.array([anchor.series for anchor in anchors])
    for k in range(series.shape[1], 0, -1):
        total = (total + series[:, k - 1]) * offset[:, None]
    return total
