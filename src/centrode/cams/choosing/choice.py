"""The best design within bounds, or how near the bounds the nearest one comes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from centrode.cams.choosing.measures import ALWAYS, MEASURES, Measure
from centrode.cams.choosing.problem import Family, Problem
from centrode.cams.choosing.searching import ACTIVE, KEPT, STARTS, Found, kkt_residual, search
from centrode.errors import InputError
from centrode.locale import _

Array = NDArray[np.float64]

SAME = 1e-5
"""Two searches agree where what is made best differs by less than this part."""


@dataclass(frozen=True)
class Judged:
    """A measure of a design: its worst value in SI, the angle [rad] where it is, its bound if it has one."""

    value: float
    angle: float
    bound: float | None = None

    def missed(self, measure: Measure) -> float:
        """By which part of the bound it is missed; 0 where it is kept."""
        if self.bound is None:
            return 0.0
        by = measure.sign * (self.value - self.bound) / (abs(self.bound) or 1.0)
        return by if by > KEPT else 0.0


@dataclass(frozen=True)
class Design:
    """Parameters in SI by their names, with the measures they lead to."""

    parameters: Mapping[str, float]
    measures: Mapping[str, Judged]

    @property
    def misses(self) -> dict[str, float]:
        """The bounds that are not kept, each with the part of it that is missed."""
        found = {name: judged.missed(MEASURES[name]) for name, judged in self.measures.items()}
        return {name: by for name, by in found.items() if by > 0}


@dataclass(frozen=True)
class Choice:
    """What a search chose.

    Attributes
    ----------
    best : str
        The measure made best.
    chosen : Design
        The best within the bounds; where there is none, the one whose worst miss is least.
    start : Design
        What the description gives.
    admissible : bool
        Whether the chosen design keeps all bounds.
    binding : mapping of name -> float
        Bounds that bind: by which part the best value changes when the bound is moved by a part of itself.
    at_ends : tuple of str
        Parameters that stand at an end of their range.
    residual : float
        What is left of the slope of the best value after the bounds that bind have held it (0 at an optimum), as a
        part of it; NaN where no design is admissible.
    searches, agreeing : int
        Searches made, and how many of them ended at the same best value.
    """

    best: str
    chosen: Design
    start: Design
    admissible: bool
    binding: Mapping[str, float]
    at_ends: tuple[str, ...]
    residual: float
    searches: int
    agreeing: int


def choose(
    family: Family,
    start: Array,
    best: str,
    bounds: Mapping[str, float],
    starts: int = STARTS,
    warm: Sequence[Array] = (),
) -> Choice:
    """Choose the parameters of a family of designs.

    Parameters
    ----------
    family : Family
    start : (n,)
        Parameters in SI to start from, besides others spread over the box.
    best : str
        The measure to be made best: least, or greatest for lift and gap.
    bounds : mapping of name -> float
        Greatest values in SI (least ones for lift and gap) of measures.
    starts : int
        Starts spread over the box.
    warm : sequence of (n,)
        Further starts in SI.

    Notes
    -----
    Bounds are kept to 1e-9 of themselves. A search of this kind finds local optima; that `agreeing` of the searches
    ended at the same one speaks for it, and proves nothing.
    """
    _check(family, best, bounds)
    problem = Problem(family, best, bounds)
    found = search(problem, family.share(start), starts, [family.share(one) for one in warm])
    first = found[0]
    admissible = first.excess <= KEPT
    residual, held = kkt_residual(problem, first.share) if admissible else (float("nan"), {})
    ends = [
        name for name, place in zip(family.names, first.share, strict=True) if min(place, 1 - place) <= ACTIVE
    ]
    return Choice(
        best=best,
        chosen=design(family, first.share, best, bounds),
        start=design(family, family.share(start), best, bounds),
        admissible=admissible,
        binding={name: by for name, by in held.items() if by > 0 and name not in ALWAYS},
        at_ends=tuple(ends),
        residual=residual,
        searches=1 + len(warm) + max(starts - 1, 0),
        agreeing=_agreeing(found[1:], first, admissible),
    )


def design(family: Family, share: Array, best: str, bounds: Mapping[str, float]) -> Design:
    """A design with every measure that the family has."""
    asked = [name for name in MEASURES if name != "stress" or family.contact is not None]
    found = Problem(family, best, {name: bounds.get(name, 0.0) for name in asked}).extremes(share)
    values = family.values(share)
    parameters = {name: float(value) for name, value in zip(family.names, values, strict=True)}
    return Design(parameters, {name: Judged(*found[name], bounds.get(name)) for name in asked})


def _agreeing(found: Sequence[Found], first: Found, admissible: bool) -> int:
    same = [
        abs(one.value - first.value) <= SAME * max(abs(first.value), 1.0)
        if admissible
        else abs(one.excess - first.excess) <= SAME
        for one in found
        if not admissible or one.excess <= ACTIVE
    ]
    return sum(same)


def _check(family: Family, best: str, bounds: Mapping[str, float]) -> None:
    known = ", ".join(MEASURES)
    for name in (best, *bounds):
        if name not in MEASURES:
            what = _("{name} is not a measure of a cam").format(name=name)
            raise InputError("[choose]", what, _("use one of {known}").format(known=known))
    if family.contact is None and "stress" in (best, *bounds):
        what = _("the contact stress needs the force, the width and the materials")
        raise InputError("[choose]", what, _("write a table [contact]"))
    if not np.all(family.low < family.high):
        raise InputError(
            "[choose] parameters",
            _("the range of a parameter is empty"),
            _("write [from, to], from below to"),
        )
