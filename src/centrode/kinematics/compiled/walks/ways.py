"""The order in which a walk passes places of the path: from the initial position onwards, then from there back.

Samples may be few, or lie anywhere; so many other places are put between them that no step is long.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.compiled.variables import FIRST, PARAMETER, SAMPLE, SHARE, STEP
from centrode.kinematics.paths import Path

Array: TypeAlias = npt.NDArray[np.float64]
Places: TypeAlias = npt.NDArray[np.intp]

NODES = 2
"""Longest step, in nodes of the mesh of events: 1 degree of an angle drive."""
MOST_SHARE = 1e6
"""Steps shorter than this part of the longest one tell nothing of rates."""


@dataclass(frozen=True)
class Leg:
    """The places in one sense of the path, the initial position first.

    Attributes
    ----------
    inputs : name -> (places,)
    places : of those that are asked for, where they stand here
    asked : and where they stand in what is asked for
    """

    inputs: Mapping[str, Array]
    places: Places
    asked: Places

    @property
    def steps(self) -> int:
        """How many places there are."""
        return len(self.inputs[PARAMETER])

    def parts(self, steps: int) -> Iterator[Leg]:
        """The leg in parts of at most so many places."""
        for first in range(0, self.steps, steps):
            inputs = {name: row[first : first + steps] for name, row in self.inputs.items()}
            here = (self.places >= first) & (self.places < first + steps)
            yield Leg(inputs, self.places[here] - first, self.asked[here])


@dataclass(frozen=True)
class Way:
    """Both legs."""

    legs: tuple[Leg, Leg]


def way_of(path: Path, inputs: Mapping[str, Array]) -> Way:
    """The way past all that is asked for, name -> (samples,)."""
    off = inputs[PARAMETER] - path.initial
    order = np.argsort(off, kind="stable")
    ahead, behind = order[off[order] >= 0.0], order[off[order] < 0.0][::-1]
    longest = NODES * path.step
    return Way((_leg(path.initial, longest, inputs, ahead), _leg(path.initial, -longest, inputs, behind)))


def _leg(initial: float, longest: float, inputs: Mapping[str, Array], asked: Places) -> Leg:
    parameter, places = _filled(initial, longest, inputs[PARAMETER][asked])
    found = {name: np.zeros(len(parameter)) for name in (*inputs, STEP, SHARE, FIRST, SAMPLE)}
    for name, values in inputs.items():
        found[name][places] = values[asked]
    found[PARAMETER] = parameter
    found[STEP][1:] = np.diff(parameter)
    with np.errstate(divide="ignore"):
        share = longest / found[STEP]
    found[SHARE][:] = np.where(np.abs(share) < MOST_SHARE, share, 0.0)
    found[FIRST][0] = 1.0
    found[SAMPLE][places] = 1.0
    return Leg(found, places, asked)


def _filled(initial: float, longest: float, asked: Array) -> tuple[Array, Places]:
    """Places with no longer steps than that, and which of them are those asked for."""
    if not len(asked):
        return np.array([initial]), np.zeros(0, dtype=np.intp)
    stops = np.concatenate([[initial], asked])
    counts = np.maximum(1, np.ceil(np.diff(stops) / longest * (1.0 - 1e-9)).astype(np.intp))
    parts = [
        start + (stop - start) * np.arange(1, count + 1) / count if count > 1 else [stop]
        for start, stop, count in zip(stops[:-1], stops[1:], counts, strict=True)
    ]
    parameter = np.concatenate([[initial], *parts])
    places = np.cumsum(counts)
    parameter[places] = asked  # to the last bit
    return parameter, places.astype(np.intp)
