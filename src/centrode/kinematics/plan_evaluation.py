"""Running a plan over any algebra: the positions of everything at values of the drives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.geometry.space import Space
from centrode.kinematics.dyads import Continued, solve_group
from centrode.kinematics.path import Path, nearest_node
from centrode.kinematics.stretches import TurnedStretch, with_quick_steps, with_quick_turns
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from centrode.numerics.rounding_bounds import Rounded
from centrode.structure.constraints import FRAME, Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Meet
from centrode.structure.plan import Structure

Number: TypeAlias = Any
Namespace: TypeAlias = Any


class EvaluationPolicy:
    """Policy of a plan's evaluation, group by group; this one decides nothing and looks at nothing."""

    def root(self, group: int, radicand: Number) -> Number:
        """The signed root of a group's radicand: the sign is the branch."""
        raise NotImplementedError

    def divisor(self, group: int, divisor: Number) -> Number:
        """A number that a group divides by."""
        return divisor

    def continue_angle(self, group: int, key: str, angle: Number) -> Number:
        """An angle in (-pi, pi] with the turns that its path has made."""
        return angle

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        """Add what a group of higher class gives."""
        raise NotImplementedError

    def take_meeting(self, group: int, one: Any, other: Any, place: Any) -> None:
        """Hook that is called with the two loci of a group and the place where they meet."""

    def after(self, group: int, at: Positions) -> None:
        """Hook that is called after a group is solved."""


class FixedSigns(EvaluationPolicy):
    """Given signs and turns, wherever the drive stands."""

    def __init__(
        self, m: Namespace, signs: Mapping[int, Number], continued: Continued = lambda _key, angle: angle
    ) -> None:
        self.m = m
        self.signs = signs
        self.turned = continued

    def root(self, group: int, radicand: Number) -> Number:
        return self.m.sqrt(radicand) * self.signs[group]

    def continue_angle(self, group: int, key: str, angle: Number) -> Number:
        return self.turned(key, angle)


@dataclass(frozen=True)
class SideChoices:
    """The hooks for one group of the plan."""

    hooks: EvaluationPolicy
    group: int

    def root(self, radicand: Number) -> Number:
        """The signed root of the group's radicand."""
        return self.hooks.root(self.group, radicand)

    def divisor(self, divisor: Number) -> Number:
        """A number that the group divides by."""
        return self.hooks.divisor(self.group, divisor)

    def take_meeting(self, one: Any, other: Any, place: Any) -> None:
        """Hook that is called with the two loci of the group and the place where they meet."""
        self.hooks.take_meeting(self.group, one, other, place)

    def continue_angle(self, key: str, angle: Number) -> Number:
        """An angle in (-pi, pi] with the turns that its path has made; `key` names it."""
        return self.hooks.continue_angle(self.group, key, angle)

    def higher(self, m: Namespace, at: Positions) -> None:
        """Add what the group gives, if it is of higher class."""
        self.hooks.higher(self.group, m, at)


class ReachedRadicand(Exception):
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

    def positions(self, m: Namespace, parameter: Number, hooks: EvaluationPolicy) -> Positions:
        """Positions at a parameter of the path, over any algebra."""
        at = self.frame(m, parameter)
        self.advance(at, range(len(self.structure.groups)), m, hooks)
        return at

    def frame(self, m: Namespace, parameter: Number) -> Positions:
        """Positions before the first group of the plan, at a parameter over the algebra of `m`."""
        return Positions.of_frame(self.numbers, self.path.drive_values(m, parameter), m)

    def advance(self, at: Positions, groups: range, m: Namespace, hooks: EvaluationPolicy) -> None:
        """Add what a stretch of the plan gives, the groups before it being known."""
        for i in groups:
            # after the group: what it is replaced by near change points is what its links' angles are counted
            # from
            solve_group(self.structure.groups[i], m, self.numbers, at, SideChoices(hooks, i))
            hooks.after(i, at)
            self.count(i, at, m, hooks)

    def count(self, group: int, at: Positions, m: Namespace, hooks: EvaluationPolicy) -> None:
        """Add the angles, with their turns, of links of a group on which gears or rolling wheels depend."""
        for link in self.structure.counted_links[group]:
            # a link that a gear turns has its angle with its turns already
            if link not in at.angles:
                at.angles[link] = hooks.continue_angle(group, link, own_angle(m, self.numbers, at, link))

    def guard(self, m: Namespace, parameter: Number, group: int, hooks: EvaluationPolicy) -> Number:
        """The number whose sign decides whether a group closes: its radicand, or the divisor of a group without one."""
        return self.guard_behind(self.frame(m, parameter), m, group, hooks)

    def guard_behind(self, at: Positions, m: Namespace, group: int, hooks: EvaluationPolicy) -> Number:
        """`guard` from positions that hold what is known before the first group of the plan."""
        try:
            self.advance(at, range(group + 1), m, _UpTo(group, hooks))
        except ReachedRadicand as reached:
            return reached.value
        raise ValueError(f"group {group} has neither a radicand nor a divisor")

    def take(self, lanes: Any) -> Kinematics:
        """The plan with the numbers of chosen mechanisms of the batch, one for each entry of `lanes` (k,)."""

        def take(x: Number) -> Number:
            # arrays of a batch are columns (lanes, 1): flat, one number is taken for each entry
            return x if isinstance(x, float) else x.reshape(-1)[lanes]

        if self.numbers.alone and not self.path.held:
            return self
        return Kinematics(self.structure, self.numbers.map_numbers(take), self.path.take(take))


FEW_GROUPS = 6
"""Of a row of parallelograms each multiplies the box of an error by 6: so few leave it below 1e-11."""


def is_long_row(structure: Structure) -> bool:
    """Whether so many groups may follow each other that bounds have to keep the directions of what they bound.

    Bounds of lengths alone grow with each group as the errors do not; where groups are few they take fewer operations.
    """
    return sum(isinstance(group, Meet) for group in structure.groups) > FEW_GROUPS


def own_angle(m: Namespace, numbers: Dimensions, at: Positions, link: str) -> Number:
    """Angle of a link in (-pi, pi]: of its axes, on the sphere from the arc that it is measured from."""
    reference = numbers.reference(link)
    if reference is None:
        cosine, sine = at.poses[link].rotor
        return m.atan2(sine, cosine)
    base = at.poses[numbers.gearing.measured.get(link, FRAME)]
    return numbers.space.turn(m, at.poses[link], base, (1.0, 0.0), reference)


class _UpTo(EvaluationPolicy):
    """Other hooks up to a group, whose radicand or divisor is carried out."""

    def __init__(self, last: int, hooks: EvaluationPolicy) -> None:
        self.last = last
        self.hooks = hooks

    def root(self, group: int, radicand: Number) -> Number:
        if group == self.last:
            raise ReachedRadicand(radicand)
        return self.hooks.root(group, radicand)

    def divisor(self, group: int, divisor: Number) -> Number:
        if group == self.last:
            raise ReachedRadicand(divisor)
        return divisor

    def continue_angle(self, group: int, key: str, angle: Number) -> Number:
        return self.hooks.continue_angle(group, key, angle)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        self.hooks.higher(group, m, at)

    def after(self, group: int, at: Positions) -> None:
        self.hooks.after(group, at)


# Angles that groups depend on with their turns: counted on the mesh of the path, outwards from its start.
#
# A value anywhere takes its turns from the nearest node, so it does not depend on the samples requested.

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
TURN = 2.0 * np.pi


@dataclass(frozen=True)
class Turns:
    """An angle at the nodes of a mesh, and the whole turns to add to it there.

    `angle` and `turns` have shape (lanes, nodes), or (1, nodes) where the lanes agree. `quick` has the stretches on
    which half a turn may lie between two nodes.
    """

    mesh: Array
    angle: Array
    turns: Array
    quick: Sequence[TurnedStretch] = ()

    def continue_angle(self, angle: Number, parameter: Array, lanes: Lanes | None) -> Number:
        """An angle in (-pi, pi], over any algebra, with its turns at parameters as `EvaluationPolicy` has them."""
        # turns are those of the nearest node, and the rest is the difference of angles: less than half a turn
        node = nearest_node(self.mesh, parameter)
        if lanes is None:
            where: Any = (slice(None), node.reshape(-1))
        else:
            where = (lanes if len(self.angle) > 1 else 0, node)
        value = _value(angle)
        whole = self.turns[where] + np.round((self.angle[where] - value) / TURN)
        if self.quick:
            value = np.broadcast_to(value, whole.shape)
            with_quick_turns(whole, value, np.reshape(parameter, -1), lanes, self.turns, self.quick)
        # nothing is added where there are no turns, so that jets and bounds keep their bits
        return angle + TURN * whole if whole.any() else angle


def count_turns(
    angle: Number, mesh: Array, initial: float, start: float, quick: Sequence[TurnedStretch] = ()
) -> Turns:
    """Turns of an angle on a mesh (nodes,); `initial` is its value at the parameter `start`."""
    values = np.atleast_2d(np.asarray(_value(angle), dtype=np.float64))
    values = np.broadcast_to(values, (values.shape[0], len(mesh)))
    node = int(np.argmin(np.abs(mesh - start)))
    values = _fill_gaps(values, node)
    # from node to node an angle turns by less than half a turn: a greater difference is a passage of pi
    steps = np.round((values[:, :-1] - values[:, 1:]) / TURN)
    with_quick_steps(steps, quick)
    turns = np.zeros(values.shape)
    np.cumsum(steps, axis=1, out=turns[:, 1:])
    # the count starts anywhere; the whole is shifted so that the node at the start has the initial angle's
    # turns
    turns += (np.round((initial - values[:, node]) / TURN) - turns[:, node])[:, None]
    return Turns(mesh, values, turns, quick)


def _fill_gaps(values: Array, start: int) -> Array:
    """Gaps filled by the last known value on the way from the start, in both directions; zero if there is none."""
    known = np.isfinite(values)
    if known.all():
        return values
    nodes, last = np.arange(values.shape[1]), values.shape[1]
    ahead = np.maximum.accumulate(np.where(known & (nodes >= start), nodes, -1), axis=1)
    behind = np.where(known & (nodes <= start), nodes, last)
    behind = np.minimum.accumulate(behind[:, ::-1], axis=1)[:, ::-1]
    source = np.where(nodes >= start, ahead, behind)
    missing = (source < 0) | (source >= last)
    # a lane without any value at the start takes its first known one; one without any value counts as zero
    source = np.where(missing, np.argmax(known, axis=1)[:, None], source)
    filled = np.take_along_axis(values, source, axis=1)
    return np.where(np.isfinite(filled), filled, 0.0)


def _value(angle: Number) -> Any:
    if isinstance(angle, Jet | Rounded):
        return angle.value
    return angle


# The branch as data: signs of the groups as functions of the drive, with the events that bound and flip them.

AT_THE_START = 1e-9
"""A change point this close to the initial position (in the path's units) counts as lying just behind it."""


@dataclass(frozen=True)
class RadicandZero:
    """A place on the path where a group's radicand is zero.

    At a limit the mechanism locks; at a change point the two assemblies of a group meet and cross.
    """

    kind: Literal["limit", "change point"]
    group: int
    lane: int
    at: float
    closes_above: bool | None = None
    """Of a limit: whether the group closes above it or below; None where it closes on both sides."""


@dataclass
class Branches:
    """Signs of all groups along the path, for a batch of mechanisms.

    Attributes
    ----------
    signs : group -> (lanes,) array of +1 or -1: at the initial position
    events : found so far, in plan order
    crossings : group -> (lanes, k) change points, padded with NaN
    largest : group -> (lanes,) greatest radicand on the mesh
    angles : link, or bearing of a rolling wheel -> its angle [rad] in the initial position
    turns : the same -> how it runs on over turns, once it is found
    smooth : whether signs flip at change points ("smooth") or stay ("keep")
    """

    initial: float
    forward: float
    unit: float
    lanes: int
    signs: dict[int, Array]
    smooth: bool
    angles: Mapping[str, float] = field(default_factory=dict)
    turns: dict[str, Turns] = field(default_factory=dict)
    events: list[RadicandZero] = field(default_factory=list)
    crossings: dict[int, Array] = field(default_factory=dict)
    largest: dict[int, Array] = field(default_factory=dict)

    def add(self, group: int, events: Sequence[RadicandZero]) -> None:
        """Record the events of a group; its sign is requested only afterwards."""
        if not events:
            return
        self.events += sorted(events, key=lambda event: (event.lane, event.at))
        per_lane: list[list[float]] = [[] for _ in range(self.lanes)]
        for event in self.events:
            if event.group == group and event.kind == "change point":
                # padded with NaN, which lies between no two numbers: one comparison serves all lanes
                per_lane[event.lane].append(self._behind_start(event.at))
        width = max((len(of_lane) for of_lane in per_lane), default=0)
        if width:
            table = np.full((self.lanes, width), np.nan)
            for lane, of_lane in enumerate(per_lane):
                table[lane, : len(of_lane)] = of_lane
            self.crossings[group] = table

    def _behind_start(self, at: float) -> float:
        # a given side holds from the start onwards: a crossing at the start itself belongs to what lies behind
        margin = AT_THE_START * self.unit
        return self.initial - self.forward * margin if abs(at - self.initial) <= margin else at

    def sign(self, group: int, parameter: Array, lanes: npt.NDArray[np.intp] | None = None) -> Array:
        """Sign of a group at parameters: shape (lanes, n), or (k,) with a lane for each entry."""
        base = self.signs[group]
        base = base[:, None] if lanes is None else base[lanes]
        crossings = self.crossings.get(group)
        if crossings is None or not self.smooth:
            return np.broadcast_to(base, np.broadcast_shapes(base.shape, np.shape(parameter)))
        table = crossings[:, None, :] if lanes is None else crossings[lanes]
        low = np.minimum(parameter, self.initial)[..., None]
        high = np.maximum(parameter, self.initial)[..., None]
        between = ((table > low) & (table < high)).sum(axis=-1)
        # two passages bring the first assembly back
        return np.asarray(base * (1.0 - 2.0 * (between % 2)))

    def reach(self, lane: int) -> tuple[float, float]:
        """Nearest limits on both sides of the initial position; infinite where there is none."""
        low, high = self.reaches()[lane]
        return float(low), float(high)

    def reaches(self) -> Array:
        """Nearest limits of every mechanism: shape (lanes, 2)."""
        reaches = np.full((self.lanes, 2), (-np.inf, np.inf))
        for event in self.events:
            if event.kind == "limit":
                side = 0 if self._is_below(event) else 1
                nearer = max if side == 0 else min
                reaches[event.lane, side] = nearer(float(reaches[event.lane, side]), event.at)
        return reaches

    def _is_below(self, limit: RadicandZero) -> bool:
        """Whether a limit bounds the reach from below; one at the start itself bounds the side that does not close."""
        # a limit at the start itself is on neither side: the side on which the group closes tells
        if limit.closes_above is not None and abs(limit.at - self.initial) <= AT_THE_START * self.unit:
            return limit.closes_above
        return limit.at <= self.initial


def branches_at_start(
    path: Path, signs: Mapping[int, float], angles: Mapping[str, float], smooth: bool, lanes: int = 1
) -> Branches:
    """Signs and angles in the initial position, before any event is known."""
    first = {group: np.full(lanes, sign) for group, sign in signs.items()}
    unit = path.unit_at(path.initial)
    return Branches(path.initial, path.forward, unit, lanes, first, smooth, angles)


# Which column of the arrays of a motion holds what.
#
# Coordinates of moving points; the numbers that tell how links are turned; displacements of guides; cosine
# and sine of the angles that are not those of a link's own axes. How many numbers each takes, the space says.


@dataclass(frozen=True)
class PlanLayout:
    """Names and places of the columns; `guided` are the guides' points, `angles` the links whose angle is measured."""

    space: Space
    points: tuple[str, ...]
    links: tuple[str, ...]
    guides: tuple[str, ...]
    guided: tuple[str, ...]
    angles: tuple[str, ...]

    @property
    def axes(self) -> int:
        """Number of coordinates of a point."""
        return len(self.space.axes)

    @property
    def attitude(self) -> int:
        """Number of columns of a link."""
        return len(self.space.attitude(self.space.at_rest))

    @property
    def first_attitude(self) -> int:
        """First column of the first link."""
        return self.axes * len(self.points)

    @property
    def first_slide(self) -> int:
        """Column of the first guide's displacement."""
        return self.first_attitude + self.attitude * len(self.links)

    @property
    def first_rotor(self) -> int:
        """First column of the first angle that is not a link's own attitude."""
        return self.first_slide + len(self.guides)

    @property
    def width(self) -> int:
        """Number of columns."""
        return self.first_rotor + (0 if self._own else 2 * len(self.angles))

    @property
    def runs_on(self) -> bool:
        """Whether an angle is that of a link's own axes, so that one the plan counts with its turns says it all."""
        return self._own

    @property
    def _own(self) -> bool:
        """Whether a link's attitude is the rotor of its angle, so that it needs no columns of its own."""
        return self.attitude == 2

    def rotor(self, link: str) -> slice:
        """Columns of cosine and sine of a link's angle."""
        first = self.first_attitude if self._own else self.first_rotor
        column = first + 2 * self.angles.index(link)
        return slice(column, column + 2)

    def numbers(self, m: Namespace, dimensions: Dimensions, at: Positions) -> list[Number]:
        """The numbers of all columns at positions, over any algebra."""
        numbers = [x for point in self.points for x in at.points[point]]
        numbers += [x for link in self.links for x in self.space.attitude(at.poses[link])]
        for guide, point in zip(self.guides, self.guided, strict=True):
            numbers.append(slide_of(m, dimensions, at, guide, point))
        # in the plane a link's attitude is the rotor of its angle; on the sphere three axes do not tell it
        if not self._own:
            numbers += [x for link in self.angles for x in rotor_of_angle(m, dimensions, at, link)]
        return numbers


def layout_of(kinematics: Kinematics) -> PlanLayout:
    """Columns for a mechanism: moving points, links and guides in description order."""
    mechanism, numbers = kinematics.structure.mechanism, kinematics.numbers
    return PlanLayout(
        numbers.space,
        tuple(mechanism.moving_points),
        tuple(mechanism.links),
        tuple(guide.id for guide in mechanism.guides),
        tuple(guide.point for guide in mechanism.guides),
        tuple(numbers.ends),
    )


def rotor_of_angle(m: Namespace, numbers: Dimensions, at: Positions, link: str) -> tuple[Number, Number]:
    """Cosine and sine of a link's angle."""
    towards = [at.points[end] for end in numbers.ends[link]]
    return numbers.space.rotor(m, at.poses[link], [*numbers.local[link].values()], towards)


def slide_of(m: Namespace, numbers: Dimensions, at: Positions, guide: str, point: str) -> Number:
    """Displacement of a guide's point along its curve."""
    return numbers.space.slide(m, at.points[point], at.poses[numbers.bodies[guide]], numbers.curve(guide))


def positions_from(
    kinematics: Kinematics,
    layout: PlanLayout,
    values: Array,
    angles: Array,
    parameter: Number,
    m: Namespace = ARRAYS,
) -> Positions:
    """Positions as plain values of the columns and angles (columns first), to evaluate constraints on."""
    numbers, size = kinematics.numbers, layout.attitude
    at = Positions.of_frame(numbers, kinematics.path.drive_values(m, parameter), m)
    for k, point in enumerate(layout.points):
        at.points[point] = tuple(values[layout.axes * k : layout.axes * (k + 1)])
    for k, link in enumerate(layout.links):
        column = layout.first_attitude + size * k
        # a pose is restored from the link's first point: its origin has no column
        point, local = next(iter(numbers.local[link].items()))
        attitude = values[column : column + size]
        at.poses[link] = numbers.space.pose_of(m, tuple(attitude), local, at.points[point])
    at.angles.update(zip(layout.angles, angles, strict=True))
    return at
