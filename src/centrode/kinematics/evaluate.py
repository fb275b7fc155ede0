"""Running a plan over any algebra: the positions of everything at values of the drives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.kinematics.groups import solve_group
from centrode.kinematics.paths import Path
from centrode.structure.dimensions import Dimensions
from centrode.structure.plan import Structure
from centrode.structure.positions import Positions

Number: TypeAlias = Any
Namespace: TypeAlias = Any
Branch: TypeAlias = Callable[[int, Number], Number]
"""Given a group's place in the plan and its radicand: the signed root of it."""


After: TypeAlias = Callable[[int, Positions], None]
"""What is done after a group of the plan is solved."""


def nothing(_group: int, _at: Positions) -> None:
    """Nothing is done after a group."""


def as_it_is(_group: int, divisor: Number) -> Number:
    """A divisor nobody looks at."""
    return divisor


class Reached(Exception):
    """Carries a radicand out of an evaluation that needs to go no further."""

    def __init__(self, value: Number) -> None:
        self.value = value
        super().__init__("radicand reached")


@dataclass(frozen=True)
class Kinematics:
    """A plan with its numbers and the path of its drives: what positions are computed from."""

    structure: Structure
    numbers: Dimensions
    path: Path

    def positions(
        self,
        m: Namespace,
        parameter: Number,
        branch: Branch,
        divisor: Branch = as_it_is,
        after: After = nothing,
    ) -> Positions:
        """Positions at a parameter of the path, over any algebra."""
        at = self.frame(m, parameter)
        self.advance(at, range(len(self.structure.groups)), m, branch, divisor, after)
        return at

    def frame(self, m: Namespace, parameter: Number) -> Positions:
        """What is known before the first group of the plan."""
        return Positions.of_frame(self.numbers, self.path.drive_values(m, parameter))

    def advance(
        self,
        at: Positions,
        groups: range,
        m: Namespace,
        branch: Branch,
        divisor: Branch = as_it_is,
        after: After = nothing,
    ) -> None:
        """Add what a stretch of the plan gives, the groups before it being known."""
        for i in groups:
            solve_group(
                self.structure.groups[i],
                m,
                self.numbers,
                at,
                lambda radicand, i=i: branch(i, radicand),  # type: ignore[misc]
                lambda value, i=i: divisor(i, value),  # type: ignore[misc]
            )
            after(i, at)

    def guard(
        self, m: Namespace, parameter: Number, group: int, branch: Branch, after: After = nothing
    ) -> Number:
        """The number whose sign decides whether a group closes: its radicand, or the divisor of a group without one."""

        def stop(i: int, value: Number) -> Number:
            if i == group:
                raise Reached(value)
            return branch(i, value)

        def stop_at_divisor(i: int, value: Number) -> Number:
            if i == group:
                raise Reached(value)
            return value

        try:
            self.positions(m, parameter, stop, stop_at_divisor, after)
        except Reached as reached:
            return reached.value
        raise ValueError(f"group {group} has neither a radicand nor a divisor")

    def taken(self, lanes: Any) -> Kinematics:
        """The same plan with the numbers of chosen mechanisms of the batch, one for each entry of `lanes`."""

        def take(x: Number) -> Number:
            return x if isinstance(x, float) else x.reshape(-1)[lanes]

        return Kinematics(self.structure, self.numbers.mapped(take), self.path)
