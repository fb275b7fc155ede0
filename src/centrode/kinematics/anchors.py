"""Anchors of a group of higher class: places along the path from which every other place is found.

Anchors belong to the mechanism and its path, not to the samples: a place starts from its nearest anchor, by the
Taylor polynomial that the anchor carries. So what is found does not depend on what else is asked for.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.newton import System

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
End: TypeAlias = Literal["open", "limit", "unconverged"]

AT_THE_LIMIT = 4096.0
"""A place this many units of rounding away from a limit is the limit itself."""
HALVINGS = 40


@dataclass(frozen=True)
class Anchor:
    """One place on the path: the state there, Taylor coefficients of the step from it, sign of the determinant."""

    parameter: float
    state: Array
    series: Array
    sense: float

    @property
    def radius(self) -> float:
        """How far the Taylor polynomial reaches, by the ratio of its last two coefficients."""
        last, before = (float(np.max(np.abs(self.series[k]))) for k in (-1, -2))
        return before / last if 0.0 < last < before * 1e3 else 1e3


@dataclass(frozen=True)
class Fold:
    """A limit, and polynomials in the share t of the arc from the last anchor (0) to it (1).

    `parameters` (degree + 1,) and `states` (degree + 1, width) hold coefficients, that of t^0 first.
    """

    parameter: float
    state: Array
    sense: float
    parameters: Array
    states: Array

    def foretell(self, parameter: Array) -> Array:
        """States at parameters between the last anchor and the limit."""
        low, high = np.zeros(len(parameter)), np.ones(len(parameter))
        rising = self.parameter > self.parameters[0]
        for _halving in range(HALVINGS):
            middle = 0.5 * (low + high)
            short = (np.polynomial.polynomial.polyval(middle, self.parameters) < parameter) == rising
            low, high = np.where(short, middle, low), np.where(short, high, middle)
        found = np.polynomial.polynomial.polyval(0.5 * (low + high), self.states).T
        return np.asarray(found, dtype=np.float64)


def through_places(share: Array, parameters: Array, states: Array) -> tuple[Array, Array]:
    """Coefficients of the polynomials through parameters (n,) and states (n, width) at shares of an arc."""
    powers = np.vander(share, increasing=True)
    inverse = np.asarray(np.linalg.inv(powers), dtype=np.float64)
    return inverse @ parameters, inverse @ states


@dataclass
class Trail:
    """Anchors of one mechanism in one sense of the path, outward from the initial position, and how they end."""

    anchors: list[Anchor] = field(default_factory=list)
    end: End = "open"
    fold: Fold | None = None

    @property
    def reach(self) -> float:
        """Parameter as far as which the group can be followed."""
        return self.anchors[-1].parameter if self.fold is None else self.fold.parameter


@dataclass(frozen=True)
class Predicted:
    """Where Newton's method starts at every place, and what is known of the place beforehand."""

    state: Array
    sense: Array
    beyond: Mask
    limit: Mask


@dataclass(frozen=True)
class Anchors:
    """The anchors of all mechanisms of a batch: one trail behind and one ahead of each initial position.

    Places up to `least` beyond the end of a trail that could not be followed further are still tried.
    """

    behind: tuple[Trail, ...]
    ahead: tuple[Trail, ...]
    least: float

    def predict(self, system: System, parameter: Array, lanes: Lanes) -> Predicted:
        """Starting states at parameters, one lane for each."""
        count, width = len(parameter), self.ahead[0].anchors[0].state.shape[0]
        found = Predicted(
            np.full((count, width), np.nan),
            np.zeros(count),
            np.zeros(count, dtype=bool),
            np.zeros(count, dtype=bool),
        )
        step = np.zeros((count, system.size))
        for lane in np.unique(lanes):
            here = np.nonzero(lanes == lane)[0]
            self._of_lane(int(lane), parameter[here], here, found, step)
        known: Mask = np.asarray(np.isfinite(found.state).all(axis=1))
        moved = system.moved(np.where(known[:, None], found.state, 0.0), step)
        found.state[known & ~found.limit] = moved[known & ~found.limit]
        return found

    def _of_lane(self, lane: int, parameter: Array, here: Lanes, found: Predicted, step: Array) -> None:
        behind, ahead = self.behind[lane], self.ahead[lane]
        anchors = [*reversed(behind.anchors[1:]), *ahead.anchors]
        places = np.array([anchor.parameter for anchor in anchors])
        radii = np.array([anchor.radius for anchor in anchors])
        # between two anchors the one whose polynomial reaches further has the greater share
        between = (places[1:] * radii[:-1] + places[:-1] * radii[1:]) / (radii[1:] + radii[:-1])
        nearest = np.searchsorted(between, parameter)
        offset = parameter - places[nearest]
        found.state[here] = np.array([anchor.state for anchor in anchors])[nearest]
        found.sense[here] = np.array([anchor.sense for anchor in anchors])[nearest]
        series = np.array([anchor.series for anchor in anchors])[nearest]
        for k in range(series.shape[1], 0, -1):
            step[here] = (step[here] + series[:, k - 1]) * offset[:, None]
        for trail, sense in ((behind, -1.0), (ahead, 1.0)):
            self._near_the_end(trail, sense, parameter, here, found, step)

    def _near_the_end(
        self,
        trail: Trail,
        sense: float,
        parameter: Array,
        here: Lanes,
        found: Predicted,
        step: Array,
    ) -> None:
        outward = np.asarray(sense * (parameter - trail.reach), dtype=np.float64)
        past = np.asarray(outward > 0.0)
        if trail.end == "unconverged":
            far = outward > self.least
            found.state[here[far]] = np.nan
        fold = trail.fold
        if fold is None:
            return
        away = np.abs(parameter - fold.parameter)
        limit = away <= AT_THE_LIMIT * np.spacing(np.maximum(np.abs(fold.parameter), 1e-3))
        found.limit[here[limit]] = True
        beyond = past & ~limit
        found.beyond[here[beyond]] = True
        found.state[here[beyond]] = np.nan
        near = ~past & (sense * (parameter - trail.anchors[-1].parameter) > 0.0)
        if not len(fold.parameters):
            near[:] = False  # the curve could not be followed backwards from there
        elif near.any():
            found.state[here[near]] = fold.foretell(parameter[near])
        found.state[here[limit]] = fold.state
        found.sense[here[near | limit]] = fold.sense
        step[here[near | limit]] = 0.0
