"""A plan as expressions: what a motion without events computes at one place of the path, for any mechanism of a batch.

The plan runs over expression nodes as it runs over arrays. What differs from mechanism to mechanism are variables;
so are the parameter of the path, the time, and the rates of the parameter. Signs are those of the initial position,
which holds for mechanisms without change points alone (`judging` tells which these are), or flip at change points whose
places are variables too.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import Status
from centrode.geometry.space import Space
from centrode.kinematics.angular_velocity import attitudes_of, spins_of
from centrode.kinematics.assembly import with_phases
from centrode.kinematics.higher_class.elimination import pattern_of
from centrode.kinematics.higher_class.system import LinkChain, plain
from centrode.kinematics.machine_code.bends import BentPlan
from centrode.kinematics.machine_code.newton import NewtonStep, newton_step
from centrode.kinematics.machine_code.variables import (
    NODE_JETS,
    PARAMETER,
    TURN,
    Varied,
    before_of,
    box_array,
    grid_of_variables,
    traced_path,
    turns_along,
    turns_of,
    whole_turns,
    winders_of,
)
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.plan_evaluation import (
    EvaluationPolicy,
    Kinematics,
    PlanLayout,
    branches_at_start,
    layout_of,
    positions_from,
)
from centrode.kinematics.preparation import Ready
from centrode.kinematics.samples import ORDERS, UnitLength, each_residual
from centrode.kinematics.solve import Solved
from centrode.locale import mark
from centrode.numerics.bends import Bent
from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node, variable
from centrode.numerics.jets import Jet
from centrode.structure.constraints import Positions, TrackContact, contact_point
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton

# What decides while a plan is traced: signs, and how groups of higher class are stepped along the path.

Number: TypeAlias = Any

MOST_FREE = 9
"""Free coordinates of a group of higher class up to which it is compiled: code grows with their third power."""


class Untraceable(Exception):
    """The plan does something that expressions cannot say; `reason` is shown to the user."""

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(reason)


@dataclass
class ImpliedPlaces:
    """Places where loci meet as implicit functions of the loci, whose derivatives take a few products each.

    Attributes
    ----------
    places : a place's coordinate in closed form -> as an implicit function
    held : name -> what stands in these functions without derivatives
    """

    space: Space
    places: dict[Node, Node] = field(default_factory=dict)
    held: dict[str, Node] = field(default_factory=dict)

    def add(self, loci: Sequence[Any], place: Any, root: Operand) -> None:
        """Take a place where two loci meet, found with a root, values as jets or not."""
        one, other = (type(locus)(*(_plain_values(x) for x in locus)) for locus in loci)
        closed = _plain_values(place)
        implied = self.space.implied_place(one, other, closed, root, self._hold)
        for x, y in zip(closed, implied or closed, strict=True):
            if isinstance(x, Node) and x.arguments:
                self.places[x] = as_node(y)

    def _hold(self, number: Number) -> Number:
        # constants have no derivatives, and plain variables need no name of their own
        if not isinstance(number, Node) or not number.arguments:
            return number
        name = f"held {number.key.hex()}"
        self.held[name] = number
        return variable(name)


def _plain_values(numbers: Any) -> Any:
    """Numbers, or a vector of some, without derivatives."""
    return tuple(map(plain, numbers)) if isinstance(numbers, tuple) else plain(numbers)


class Deciding(EvaluationPolicy):
    """Signs as they are given; radicands, divisors and steps of groups of higher class are kept.

    At samples a root that does not move has derivatives that are zero, on the mesh none, as with arrays: quotients by
    what depends on it are rounded otherwise. Where there are places before and after, for groups of higher class, turns
    that gears and wheels depend on are counted.
    """

    def __init__(
        self,
        signs: Mapping[int, Operand],
        on_mesh: bool,
        chains: Mapping[int, LinkChain],
        differentiable: bool,
        space: Space,
    ) -> None:
        self.signs = signs
        self.on_mesh = on_mesh
        self.chains = chains
        self.differentiable = differentiable
        self.steps: dict[int, NewtonStep] = {}
        self.counted: dict[str, tuple[Node, Node]] = {}
        self.implied = ImpliedPlaces(space)
        self.roots: dict[int, Operand] = {}
        self.radicands: dict[int, Number] = {}
        self.divisors: dict[int, Number] = {}

    def root(self, group: int, radicand: Number) -> Number:
        self.radicands[group] = radicand
        if not isinstance(radicand, Jet) and not self.on_mesh:
            radicand = Jet((radicand, *[0.0] * (ORDERS - 1)))
        root = NODE_JETS.sqrt(radicand) * self.signs[group]
        self.roots[group] = plain(root)
        return root

    def take_meeting(self, group: int, one: Any, other: Any, place: Any) -> None:
        if self.differentiable and group in self.roots:
            self.implied.add((one, other), place, self.roots[group])

    def divisor(self, group: int, divisor: Number) -> Number:
        self.divisors[group] = divisor
        return divisor

    def continue_angle(self, group: int, key: str, angle: Number) -> Number:
        # turns are counted from place to place, and without a walk there is no place before
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


def refuse_untraceable(ready: Ready, span: SampleGrid) -> None:
    """Raise Untraceable for what is known before the plan is run."""
    kinematics = ready.kinematics
    # refused here is what a straight line of operations cannot say, or what would cost more to compile than
    # it saves
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


def chains_of(ready: Ready, numbers: Dimensions) -> dict[int, LinkChain]:
    """The groups of higher class of a plan, with dimensions over any algebra."""
    unit = float(ready.kinematics.numbers.scale)
    groups = enumerate(ready.structure.groups)
    return {i: LinkChain(group, numbers, unit) for i, group in groups if isinstance(group, Newton)}


Array: TypeAlias = npt.NDArray[np.float64]
Nodes: TypeAlias = npt.NDArray[Any]
Turns: TypeAlias = Callable[[str, Operand, Operand], Operand]
"""From a link with cosine and sine of its angle: the turns to add to that."""


@dataclass(frozen=True)
class Traced:
    """A motion at one place of the path.

    Attributes
    ----------
    solved : arrays of nodes and floats, of one lane and one sample
    radicands, divisors : group -> jet of first order, or what does not move with the drive: events are their zeros
    bent : what bounds these over cells
    turning : link -> cosine and sine of its angle where its turns have to be found
    winders : drive -> its value, with which links may turn
    turns : link -> the turns that stand in its angle: a whole number
    steps : group of higher class -> its step; there are places before and after then, see `walks`
    counted : what a gear or wheel depends on -> its turns, and its angle with these
    implied : where loci meet, as implicit functions; empty where nothing is to be differentiated
    at : places and poses without derivatives
    """

    solved: Solved
    radicands: Mapping[int, Number]
    divisors: Mapping[int, Number]
    bent: BentPlan
    turning: Mapping[str, tuple[Operand, Operand]]
    winders: Mapping[str, Operand]
    steps: Mapping[int, NewtonStep]
    counted: Mapping[str, tuple[Node, Node]]
    implied: ImpliedPlaces
    at: Positions

    @cached_property
    def bends(self) -> Mapping[tuple[str, int], Bent]:
        """Radicands and divisors over cells of the mesh, as far as they are bounded, see `bends`."""
        return self.bent.guards()

    @property
    def turns(self) -> dict[str, Node]:
        turns = _turns(bool(self.steps), self.winders)
        return {link: as_node(turns(link, *rotor)) for link, rotor in self.turning.items()}

    @property
    def standing(self) -> dict[str, Node]:
        """Name -> what jumps, or is found by iteration: derivatives by dimensions take it as given."""
        nodes = {f"turns {link}": node for link, node in self.turns.items()}
        nodes |= {f"turns counted {key}": turns for key, (turns, _angle) in self.counted.items()}
        for step in self.steps.values():
            nodes |= step.standing
        return nodes


def trace_motion(
    ready: Ready,
    span: SampleGrid,
    varied: Varied,
    signs: Mapping[int, Operand] | None = None,
    on_mesh: bool = False,
    differentiable: bool = False,
) -> Traced:
    """The motion of a mechanism of a batch at one place of the path, a sample or a node of the mesh.

    `signs` of groups are those of the initial position where they are not given; `differentiable` makes what groups of
    higher class give depend on the dimensions as their equations say. Raises Untraceable.
    """
    refuse_untraceable(ready, span)
    known = ready.kinematics
    # laws of time are not traced: values and derivatives of the drives are inputs then
    path = traced_path(known.path, span.parameter, ORDERS - 1)
    # phases of gears belong to the initial position of the description, as in `of_batch`
    kinematics = with_phases(replace(known, numbers=varied.numbers, path=path), known.numbers.gearing.phase)
    chains = chains_of(ready, kinematics.numbers)
    hooks = Deciding(signs or ready.assembled.signs, on_mesh, chains, differentiable, known.numbers.space)
    at = kinematics.positions(NODE_JETS, Jet.variable(variable(PARAMETER), ORDERS - 1), hooks)
    layout = layout_of(kinematics)
    columns = columns_of(layout.numbers(NODE_JETS, kinematics.numbers, at))
    winders = winders_of(path)
    angles, turning = angles_of(layout, at, columns, ready.assembled.angles, _turns(bool(chains), winders))
    solved = motion_of_parts(MotionParts(ready, kinematics, layout, columns, angles), span, varied)
    bent = BentPlan(ready, span, varied, signs)
    places = at.map_numbers(plain)
    return Traced(
        solved, hooks.radicands, hooks.divisors, bent, turning, winders, hooks.steps, hooks.counted,
        hooks.implied, places,
    )  # fmt: skip


def _turns(walked: bool, winders: Mapping[str, Operand]) -> Turns:
    """Rule for the turns of a link's angle: by the place before, or by a centre that runs on with a drive."""
    return turns_along if walked else functools.partial(turns_of, winders=winders)


@dataclass(frozen=True)
class MotionParts:
    """Columns and angles at one place of the path, each with its derivatives: (3, numbers) of nodes."""

    ready: Ready
    kinematics: Kinematics
    layout: PlanLayout
    columns: Nodes
    angles: Nodes


def columns_of(numbers: Sequence[Number]) -> Nodes:
    """Value, first and second derivative of numbers: (3, numbers)."""
    return np.stack([box_array([_derivative(x, order) for x in numbers]) for order in range(ORDERS)])


def _derivative(x: Number, order: int) -> Operand:
    value: Operand = x.derivative(order) if isinstance(x, Jet) else x if order == 0 else 0.0
    return value


def angles_of(
    layout: PlanLayout,
    at: Positions,
    columns: Nodes,
    start: Mapping[str, float],
    turns: Turns,
) -> tuple[Nodes, dict[str, tuple[Operand, Operand]]]:
    """Angles with their derivatives as `turning.fill_angles` has them: (3, angles); rotors of those that may turn."""
    nodes = np.empty((ORDERS, len(layout.angles)), dtype=object)
    turning: dict[str, tuple[Operand, Operand]] = {}
    for k, link in enumerate(layout.angles):
        # on some layouts the plan counts the turns itself
        if layout.runs_on and link in at.angles:
            nodes[:, k] = [_derivative(at.angles[link], order) for order in range(ORDERS)]
            continue
        cosine, sine = columns[:, layout.rotor(link)].T
        if isinstance(cosine[0], float) and isinstance(sine[0], float):
            nodes[:, k] = 0.0
            nodes[0, k] = _constant_angle(cosine[0], sine[0], start[link])
            continue
        turning[link] = cosine[0], sine[0]
        nodes[0, k] = EXPRESSIONS.atan2(sine[0], cosine[0]) + TURN * turns(link, cosine[0], sine[0])
        for order in (1, 2):
            # with c c + s s = 1 the angle's derivatives are c s' - s c' and c s'' - s c''
            nodes[order, k] = cosine[0] * sine[order] - sine[0] * cosine[order]
    return nodes, turning


def _constant_angle(cosine: float, sine: float, start: float) -> float:
    """The angle of a link that never turns, on the turn of the initial position."""
    angle = float(np.arctan2(sine, cosine))
    return angle + TURN * round((start - angle) / TURN)


def motion_of_parts(parts: MotionParts, span: SampleGrid, varied: Varied) -> Solved:
    """The motion at one place, as arrays of one lane and one sample, from what the plan gives there."""
    layout, kinematics = parts.layout, parts.kinematics
    fixed = Positions.of_frame(kinematics.numbers, {}, EXPRESSIONS).points
    # derivatives of the frame are plain zeros, which cost no operation
    frame = np.full((ORDERS, layout.axes * len(fixed)), 0.0, dtype=object)
    frame[0] = box_array([x for place in fixed.values() for x in place])
    parameter = variable(PARAMETER)
    at = positions_from(
        kinematics, layout, parts.columns[0], parts.angles[0], box_array([parameter])[0], EXPRESSIONS
    )
    points = parts.columns[:, : layout.first_attitude]
    columns = parts.columns.reshape(ORDERS, layout.width, 1, 1)
    worst = _worst(kinematics, at, varied.scale)
    wheels = [c for c in kinematics.structure.constraints if isinstance(c, TrackContact)]
    contacts = [x for c in wheels for x in contact_point(c, EXPRESSIONS, kinematics.numbers, at)]
    start = parts.ready.assembled
    path = kinematics.path
    return Solved(
        replace(parts.ready, kinematics=kinematics),
        grid_of_variables(span),
        layout,
        branches_at_start(path, start.signs, start.angles, smooth=True),
        np.concatenate([frame, points], axis=1).reshape(ORDERS, 1, 1, -1, layout.axes),
        points.reshape(ORDERS, 1, 1, -1, layout.axes),
        parts.angles.reshape(ORDERS, 1, 1, -1),
        parts.columns[:, layout.first_slide : layout.first_rotor].reshape(ORDERS, 1, 1, -1),
        spins_of(layout, columns),
        attitudes_of(layout, columns),
        # expressions have no branches: where this does not hold is judged beside them
        np.full((1, 1), Status.OK, dtype=np.int8),
        box_array([worst]).reshape(1, 1),
        UnitLength(""),
        box_array(contacts).reshape(1, 1, -1, 2),
    )


def _worst(kinematics: Kinematics, at: Positions, scale: Operand) -> Operand:
    """The greatest residual. Lengths are divided together: a greater number has no lesser quotient, to the last bit."""
    worst: dict[bool, Operand] = {}
    for _kept, size, angular in each_residual(kinematics, EXPRESSIONS, at):
        worst[angular] = EXPRESSIONS.max(worst[angular], size) if angular in worst else size
    if False in worst:
        # one division by the scale for all lengths, see above
        worst[False] = worst[False] / scale
    least: Operand = 0.0
    return functools.reduce(EXPRESSIONS.max, worst.values(), least)
