"""Running a plan over any algebra: the positions of everything at values of the drives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.kinematics.groups import solve_group
from centrode.kinematics.paths import Path
from centrode.kinematics.wheels import Continued
from centrode.structure.constraints import FRAME, Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.plan import Structure

Number: TypeAlias = Any
Namespace: TypeAlias = Any


class Hooks:
    """What decides while a plan is run, group by group; this one decides nothing and looks at nothing."""

    def root(self, group: int, radicand: Number) -> Number:
        """The signed root of a group's radicand: the sign is the branch."""
        raise NotImplementedError

    def divisor(self, group: int, divisor: Number) -> Number:
        """A number that a group divides by."""
        return divisor

    def continued(self, group: int, key: str, angle: Number) -> Number:
        """An angle in (-pi, pi] with the turns that its path has made."""
        return angle

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        """Add what a group of higher class gives."""
        raise NotImplementedError

    def after(self, group: int, at: Positions) -> None:
        """What is done after a group is solved."""


class FixedSigns(Hooks):
    """Given signs and turns, wherever the drive stands."""

    def __init__(
        self, m: Namespace, signs: Mapping[int, Number], continued: Continued = lambda _key, angle: angle
    ) -> None:
        self.m = m
        self.signs = signs
        self.turned = continued

    def root(self, group: int, radicand: Number) -> Number:
        return self.m.sqrt(radicand) * self.signs[group]

    def continued(self, group: int, key: str, angle: Number) -> Number:
        return self.turned(key, angle)


@dataclass(frozen=True)
class Choices:
    """The hooks for one group of the plan."""

    hooks: Hooks
    group: int

    def root(self, radicand: Number) -> Number:
        """The signed root of the group's radicand."""
        return self.hooks.root(self.group, radicand)

    def divisor(self, divisor: Number) -> Number:
        """A number that the group divides by."""
        return self.hooks.divisor(self.group, divisor)

    def continued(self, key: str, angle: Number) -> Number:
        """An angle in (-pi, pi] with the turns that its path has made; `key` names it."""
        return self.hooks.continued(self.group, key, angle)

    def higher(self, m: Namespace, at: Positions) -> None:
        """Add what the group gives, if it is of higher class."""
        self.hooks.higher(self.group, m, at)


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

    def positions(self, m: Namespace, parameter: Number, hooks: Hooks) -> Positions:
        """Positions at a parameter of the path, over any algebra."""
        at = self.frame(m, parameter)
        self.advance(at, range(len(self.structure.groups)), m, hooks)
        return at

    def frame(self, m: Namespace, parameter: Number) -> Positions:
        """What is known before the first group of the plan."""
        return Positions.of_frame(self.numbers, self.path.drive_values(m, parameter), m)

    def advance(self, at: Positions, groups: range, m: Namespace, hooks: Hooks) -> None:
        """Add what a stretch of the plan gives, the groups before it being known."""
        for i in groups:
            solve_group(self.structure.groups[i], m, self.numbers, at, Choices(hooks, i))
            hooks.after(i, at)
            self.count(i, at, m, hooks)

    def count(self, group: int, at: Positions, m: Namespace, hooks: Hooks) -> None:
        """Add the angles, with their turns, of links of a group on which gears or rolling wheels depend."""
        for link in self.structure.counted[group]:
            if link not in at.angles:
                at.angles[link] = hooks.continued(group, link, own_angle(m, self.numbers, at, link))

    def guard(self, m: Namespace, parameter: Number, group: int, hooks: Hooks) -> Number:
        """The number whose sign decides whether a group closes: its radicand, or the divisor of a group without one."""
        return self.guard_behind(self.frame(m, parameter), m, group, hooks)

    def guard_behind(self, at: Positions, m: Namespace, group: int, hooks: Hooks) -> Number:
        """The same from what is known before the first group of the plan."""
        try:
            self.advance(at, range(group + 1), m, _UpTo(group, hooks))
        except Reached as reached:
            return reached.value
        raise ValueError(f"group {group} has neither a radicand nor a divisor")

    def taken(self, lanes: Any) -> Kinematics:
        """The same plan with the numbers of chosen mechanisms of the batch, one for each entry of `lanes`."""

        def take(x: Number) -> Number:
            return x if isinstance(x, float) else x.reshape(-1)[lanes]

        return Kinematics(self.structure, self.numbers.mapped(take), self.path.taken(take))


def own_angle(m: Namespace, numbers: Dimensions, at: Positions, link: str) -> Number:
    """Angle of a link in (-pi, pi]: of its axes, on the sphere from the arc that it is measured from."""
    reference = numbers.reference(link)
    if reference is None:
        cosine, sine = at.poses[link].rotor
        return m.atan2(sine, cosine)
    base = at.poses[numbers.gearing.measured.get(link, FRAME)]
    return numbers.space.turn(m, at.poses[link], base, (1.0, 0.0), reference)


class _UpTo(Hooks):
    """Other hooks up to a group, whose radicand or divisor is carried out."""

    def __init__(self, last: int, hooks: Hooks) -> None:
        self.last = last
        self.hooks = hooks

    def root(self, group: int, radicand: Number) -> Number:
        if group == self.last:
            raise Reached(radicand)
        return self.hooks.root(group, radicand)

    def divisor(self, group: int, divisor: Number) -> Number:
        if group == self.last:
            raise Reached(divisor)
        return divisor

    def continued(self, group: int, key: str, angle: Number) -> Number:
        return self.hooks.continued(group, key, angle)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        self.hooks.higher(group, m, at)

    def after(self, group: int, at: Positions) -> None:
        self.hooks.after(group, at)
