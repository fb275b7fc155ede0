"""What one measure costs in another: the best designs as a bound moves (Pareto's front)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from centrode.cams.choosing.choice import Choice, Design, choose
from centrode.cams.choosing.measures import MEASURES
from centrode.cams.choosing.problem import Family

Array = NDArray[np.float64]

POINTS = 15
FEW = 2
"""Starts of the searches along the front, besides those from its neighbours."""


@dataclass(frozen=True)
class TradeOff:
    """A front of best designs.

    Attributes
    ----------
    best, against : str
        The measure made best, and the one whose bound moves.
    designs : tuple of Design
        From one end of the front, where `against` is best, to the other, where its bound does not bind.
    """

    best: str
    against: str
    designs: tuple[Design, ...]

    def values(self, name: str) -> Array:
        """Values in SI of a measure along the front."""
        return np.array([one.measures[name].value for one in self.designs])


def trade_off(
    family: Family,
    start: Array,
    best: str,
    against: str,
    bounds: Mapping[str, float],
    points: int = POINTS,
    said: Callable[[int, int], None] = lambda _done, _of: None,
) -> TradeOff:
    """Best designs for `points` bounds of `against`, the other bounds kept.

    The ends are the design that is best in `against` alone and the one that is best in `best` without a bound of
    `against`; each point starts from its neighbour too. Without an admissible design the front is empty.
    """
    others = {name: bound for name, bound in bounds.items() if name not in (best, against)}
    ends = [_tidied(family, start, (against, best), others), _tidied(family, start, (best, against), others)]
    if not all(end.admissible for end in ends):
        return TradeOff(best, against, ())
    low, high = (end.chosen.measures[against].value for end in ends)
    found = [ends[0].chosen]
    for number, bound in enumerate(np.linspace(low, high, points)[1:-1]):
        said(number + 1, points - 2)
        warm = np.array(list(found[-1].parameters.values()))
        made = choose(family, start, best, {**others, against: float(bound)}, FEW, [warm])
        if made.admissible:
            found.append(made.chosen)
    return TradeOff(best, against, (*found, ends[1].chosen))


def _tidied(family: Family, start: Array, order: tuple[str, str], bounds: Mapping[str, float]) -> Choice:
    """The best in the first measure, and among its equals in the second."""
    first, second = order
    made = choose(family, start, first, bounds)
    if not made.admissible:
        return made
    sign = MEASURES[first].sign
    value = made.chosen.measures[first].value
    held = {**bounds, first: value + sign * 1e-7 * abs(value)}
    again = choose(family, start, second, held, FEW, [np.array(list(made.chosen.parameters.values()))])
    return again if again.admissible else made
