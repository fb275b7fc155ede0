"""What is found while the vector chains of a mechanism are laid: unknowns and constraints, group by group."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from centrode.equations.letters import Angle, Letter
from centrode.equations.places import Place
from centrode.equations.sums import Sum


@dataclass(frozen=True)
class Unknown:
    """A quantity that the constraints determine.

    Attributes
    ----------
    name : "angle.AC", "slide.C", "bearing.wheel"
    letter, rate, second : it and its derivatives by time
    """

    name: str
    letter: Letter
    rate: Letter
    second: Letter


@dataclass(frozen=True)
class Condition:
    """One constraint: left = right, with what is left of it when earlier constraints are put in.

    Attributes
    ----------
    name : "y_C", "x_D", ...
    left : the chain, earlier constraints put in
    full : the chain in angles and lengths alone
    right : a constant, or another chain
    pair : number of the vector equation of which it is a component; -1 for a single one
    closing : direction of the link that closes the chain
    vector : of a component across that link, the vector equation it was taken of
    """

    name: str
    left: Sum
    full: Sum
    right: Sum
    pair: int = -1
    closing: Angle | None = None
    vector: Place | None = None

    @property
    def residual(self) -> Sum:
        """Left side less right side."""
        return self.left - self.right

    def rate(self, moves: Mapping[Letter, Sum], times: int = 1) -> Sum:
        """First or second derivative of the residual by time, zero where the constraint holds.

        Of a vector equation across a link, the vector is differentiated and then its component is taken: what is
        left out is a multiple of the vector itself.
        """
        if self.vector is None or self.closing is None:
            total = self.residual
            for _time in range(times):
                total = total.rate(moves)
            return total
        x, y = self.vector
        for _time in range(times):
            x, y = x.rate(moves), y.rate(moves)
        return Place(x, y).across(self.closing)


@dataclass
class Draft:
    """A group in the making: what the plan has in it, and what was found so far."""

    links: list[str] = field(default_factory=list)
    points: list[str] = field(default_factory=list)
    plan: list[int] = field(default_factory=list)
    unknowns: list[Unknown] = field(default_factory=list)
    conditions: list[Condition] = field(default_factory=list)
    label: str = ""
    """What the group is called where that is not its term of the structural formula."""

    @property
    def balance(self) -> int:
        """Constraints less unknowns."""
        return len(self.conditions) - len(self.unknowns)
