"""What a sweep came to: mechanisms by how far they move, worst residual, extremes; added up block by block."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.sweeps.asked import Asked

Extremes: TypeAlias = dict[str, list[list[float] | None]]
"""Column -> for each of its components (in order) least and greatest value; None where there is no number."""


@dataclass
class Tally:
    """Counts of mechanisms, and extremes of reduced columns.

    Attributes
    ----------
    mechanisms : computed so far
    whole, none : those of which every sample is ok, and none
    worst_residual : the worst of all; NaN without any
    """

    mechanisms: int = 0
    whole: int = 0
    none: int = 0
    worst_residual: float = math.nan
    extremes: Extremes = field(default_factory=dict)

    def add(self, other: Tally) -> None:
        """Count the mechanisms of another block in."""
        self.mechanisms += other.mechanisms
        self.whole += other.whole
        self.none += other.none
        self.worst_residual = float(np.fmax(self.worst_residual, other.worst_residual))
        for name, found in other.extremes.items():
            own = self.extremes.get(name)
            self.extremes[name] = (
                found if own is None else [_wider(a, b) for a, b in zip(own, found, strict=True)]
            )

    def as_dict(self) -> dict[str, Any]:
        """As a marker holds it; numbers survive to the last bit."""
        worst = None if math.isnan(self.worst_residual) else self.worst_residual
        return {
            "mechanisms": self.mechanisms,
            "whole": self.whole,
            "none": self.none,
            "worst_residual": worst,
            "extremes": self.extremes,
        }

    @classmethod
    def from_dict(cls, told: Mapping[str, Any], components: Mapping[str, int]) -> Tally:
        """The tally of a mark; `components` says how many each column has.

        Raises KeyError, TypeError, ValueError or OverflowError where it is none.
        """
        worst = told["worst_residual"]
        extremes = {name: [_ends(pair) for pair in found] for name, found in told["extremes"].items()}
        if any(components.get(name) != len(found) for name, found in extremes.items()):
            raise ValueError("extremes of other columns")
        return cls(
            int(told["mechanisms"]),
            int(told["whole"]),
            int(told["none"]),
            math.nan if worst is None else float(worst),
            extremes,
        )


def _ends(pair: Sequence[float] | None) -> list[float] | None:
    if pair is None:
        return None
    least, greatest = pair
    return [float(least), float(greatest)]


def _wider(one: Sequence[float] | None, other: Sequence[float] | None) -> list[float] | None:
    if one is None or other is None:
        both = one if other is None else other
        return None if both is None else list(both)
    return [min(one[0], other[0]), max(one[1], other[1])]


def tally_of(asked: Asked, samples: int, results: Mapping[str, npt.NDArray[Any]]) -> Tally:
    """The tally of one block."""
    ok = results["samples_ok"]
    worst = float(np.fmax.reduce(results["worst_residual"]))
    extremes: Extremes = {}
    if asked.reduced:
        for column in asked.columns:
            if column.name not in ("samples_ok", "worst_residual", *asked.slopes.values()):
                flat = results[column.name].reshape(len(ok), math.prod(column.shape))
                extremes[column.name] = [_extremes(flat[:, k]) for k in range(flat.shape[1])]
    return Tally(len(ok), int(np.sum(ok == samples)), int(np.sum(ok == 0)), worst, extremes)


def _extremes(values: npt.NDArray[np.float64]) -> list[float] | None:
    finite = values[np.isfinite(values)]
    return [float(finite.min()), float(finite.max())] if finite.size else None
