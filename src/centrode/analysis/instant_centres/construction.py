"""What a construction of instant centres gives: its steps in their order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

from centrode.analysis.instant_centres.bodies import Pair
from centrode.analysis.instant_centres.primary import ordered
from centrode.errors import InputError
from centrode.locale import _

How: TypeAlias = Literal["hinge", "guide", "rolling", "gear", "kennedy", "together", "rest", "field"]


@dataclass(frozen=True)
class Step:
    """How one centre was found.

    Attributes
    ----------
    pair : numbers of the two bodies, the later first
    how : "hinge", "guide" (at infinity square to it, on the sphere its pole), "rolling" (contact), "gear",
        "kennedy" (two lines), "together" (its two neighbours lie in one place), "rest" (no relative motion),
        "field" (the velocity field, where Kennedy's theorem is not enough)
    name : of the hinge, guide, wheel or gear
    by : numbers of the bodies whose lines meet, or that were gone by
    place : (x, y) [m], None at infinity and at rest; on the sphere (x, y, z) of one end of the axis
    direction : unit vector towards a centre at infinity, else None
    error : bound on rounding, as an angle between places seen from the mechanism's size
    """

    pair: Pair
    how: How
    name: str
    by: tuple[int, ...]
    place: tuple[float, ...] | None
    direction: tuple[float, ...] | None
    error: float


@dataclass(frozen=True)
class Construction:
    """Constructed centres of one position: `bodies` by number, `steps` in the order they were found.

    `mismatch` of a pair is the relative velocity left at its constructed centre, in the greatest velocity of
    the motion: zero to rounding.
    """

    bodies: tuple[str, ...]
    steps: tuple[Step, ...]
    mismatch: Mapping[Pair, float]

    def step(self, first: str, second: str) -> Step:
        """The step that found the centre of two bodies; raises InputError where there is none."""
        for step in self.steps:
            if {first, second} == {self.bodies[number] for number in step.pair}:
                return step
        raise InputError(
            "pair",
            _("there is no constructed centre of {first} and {second}").format(first=first, second=second),
        )

    def needed(self, pairs: Sequence[Pair]) -> Construction:
        """The same with the steps alone that lead to some pairs."""
        wanted: set[Pair] = {ordered(pair) for pair in pairs}
        kept: list[Step] = []
        for step in reversed(self.steps):
            if step.pair in wanted:
                kept.append(step)
                wanted.update(ordered((one, by)) for by in step.by for one in step.pair)
        steps = tuple(reversed(kept))
        return replace(self, steps=steps, mismatch={step.pair: self.mismatch[step.pair] for step in steps})
