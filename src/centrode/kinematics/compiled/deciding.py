"""What decides while a plan is traced: signs, and how groups of higher class are stepped along the path."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np

from centrode.algebra.expressions import Node, Operand, as_node, variable
from centrode.algebra.jets import Jet
from centrode.kinematics.compiled.newton.steps import Step, newton_step
from centrode.kinematics.compiled.turns import TURN, before_of, whole_turns
from centrode.kinematics.compiled.variables import NODE_JETS
from centrode.kinematics.evaluate import Hooks
from centrode.kinematics.higher_class.chains import Chain
from centrode.kinematics.higher_class.reduction import pattern_of
from centrode.kinematics.higher_class.surroundings import plain
from centrode.kinematics.ready import Ready
from centrode.kinematics.sampling import ORDERS
from centrode.kinematics.spans import Span
from centrode.locale import mark
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton

Number: TypeAlias = Any

MOST_FREE = 9
"""Free coordinates of a group of higher class up to which it is compiled: code grows with their third power."""


class Untraceable(Exception):
    """The plan does something that expressions cannot say; `reason` is told to the user."""

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(reason)


class Deciding(Hooks):
    """Signs as they are given; radicands, divisors and steps of groups of higher class are kept.

    At samples a root that does not move has derivatives that are zero, on the mesh none, as with arrays: quotients by
    what depends on it are rounded otherwise. Where there are places before and after, for groups of higher class, turns
    that gears and wheels depend on are counted.
    """

    def __init__(
        self, signs: Mapping[int, Operand], on_mesh: bool, chains: Mapping[int, Chain], differentiable: bool
    ) -> None:
        self.signs = signs
        self.on_mesh = on_mesh
        self.chains = chains
        self.differentiable = differentiable
        self.steps: dict[int, Step] = {}
        self.counted: dict[str, tuple[Node, Node]] = {}
        self.radicands: dict[int, Number] = {}
        self.divisors: dict[int, Number] = {}

    def root(self, group: int, radicand: Number) -> Number:
        self.radicands[group] = radicand
        if not isinstance(radicand, Jet) and not self.on_mesh:
            radicand = Jet((radicand, *[0.0] * (ORDERS - 1)))
        return NODE_JETS.sqrt(radicand) * self.signs[group]

    def divisor(self, group: int, divisor: Number) -> Number:
        self.divisors[group] = divisor
        return divisor

    def continued(self, group: int, key: str, angle: Number) -> Number:
        if not self.chains:
            raise Untraceable(mark("gears or wheels whose turns are counted"))
        value = plain(angle)
        turns = as_node(whole_turns(variable(before_of(f"counted {key}")), value))
        self.counted[key] = turns, as_node(value + TURN * turns)
        return angle + TURN * turns

    def higher(self, group: int, m: Any, at: Positions) -> None:
        chain = self.chains[group]
        self.steps[group] = step = newton_step(group, chain, at, self.differentiable)
        for name in chain.group.points:
            at.points[name] = step.at.points[name]
        for name in chain.group.links:
            at.poses[name], at.angles[name] = step.at.poses[name], step.at.angles[name]


def refuse_untraceable(ready: Ready, span: Span) -> None:
    """Raise Untraceable for what is known before the plan is run."""
    kinematics = ready.kinematics
    for group in ready.structure.groups:
        if isinstance(group, Newton):
            if kinematics.path.by_time:
                raise Untraceable(mark("groups of higher class with several drives"))
            if "rolling" in kinematics.numbers.space.lacks:
                raise Untraceable(mark("groups of higher class on the sphere"))
            if pattern_of(group).free > MOST_FREE:
                raise Untraceable(mark("a group of higher class with very many unknowns"))
    if np.any(kinematics.path.impossible(span.parameter)):
        raise Untraceable(mark("a cylinder shorter than zero"))
    curves = [kinematics.numbers.curve(guide.id) for guide in ready.mechanism.guides]
    if any(kinematics.numbers.space.period(np, curve) is not None for curve in curves):
        raise Untraceable(mark("guides that close"))


def chains_of(ready: Ready, numbers: Dimensions) -> dict[int, Chain]:
    """The groups of higher class of a plan, with dimensions over any algebra."""
    unit = float(ready.kinematics.numbers.scale)
    groups = enumerate(ready.structure.groups)
    return {i: Chain(group, numbers, unit) for i, group in groups if isinstance(group, Newton)}
