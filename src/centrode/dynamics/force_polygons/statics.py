"""The bodies that forces act on at an instant, their numbers, and who carries the pin of each hinge.

Places and forces are complex numbers x + i y. A point on a guide without a link of its own is a slider, as for
instant centres. The pin of a hinge belongs to one of the bodies that meet there; the others are hinged to that one,
so a hinge of k bodies is k - 1 hinges.
"""

from __future__ import annotations

import cmath
import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any, Literal, TypeAlias, assert_never

import numpy as np

from centrode.analysis.graphic.stage import VectorDrawing, cross
from centrode.dynamics.load_coordinates import (
    AngularDistance,
    Component,
    Distance,
    GuideArc,
    HalfSquare,
    HingeTurn,
    Slide,
    Spin,
    Travel,
    Turn,
)
from centrode.dynamics.loads import AppliedLoad, LoadTerm, MassesAndLoads
from centrode.dynamics.state import Centre, Mass, Radial, State
from centrode.errors import MotionError, NotComputedYet
from centrode.locale import _
from centrode.model.labels import sliders_of
from centrode.model.mechanism import FRAME, Drive, Guide, Mechanism
from centrode.numerics.operations import PLAIN
from centrode.structure.constraints import GearRatio, NoSlip, TrackContact, contact_point
from centrode.structure.groups import Group, TurnedLink, Turning
from centrode.structure.plan import Structure
from centrode.structure.rank import in_order, match, strong_components

MOST_DIGITS = 10
"""With more bodies the two numbers of a reaction are parted by a comma."""


@dataclass(frozen=True)
class FreeBodies:
    """Frame, links, sliders and bare pins.

    Attributes
    ----------
    names : by number, the frame first; links and sliders as for instant centres, then pins that no body has
    sliders : slider -> its guide
    pins : pin -> the point
    order : body -> its place in the plan, -1 of the frame
    """

    mechanism: Mechanism
    names: tuple[str, ...]
    sliders: Mapping[str, Guide]
    pins: Mapping[str, str]
    order: Mapping[str, int]

    @classmethod
    def of(cls, structure: Structure) -> FreeBodies:
        """The bodies of a planar mechanism."""
        mechanism = structure.mechanism
        sliders = sliders_of(mechanism)
        order = {FRAME: -1}
        of_point: dict[str, int] = dict.fromkeys(mechanism.frame.points, -1)
        for number, group in enumerate(structure.groups):
            first = _with_its_point(group, number, of_point, order)
            order |= {link: first for link in group.links if link not in order}
            of_point |= {point: number for point in group.points if point not in of_point}
        for name, guide in sliders.items():
            order[name] = max(of_point.get(guide.point, -1), order[guide.on])
        carried = {point for link in mechanism.links.values() for point in link.coordinates}
        carried |= {guide.point for guide in sliders.values()} | set(mechanism.frame.points)
        pins = {f"pin {point}": point for point in mechanism.moving_points if point not in carried}
        order |= {name: of_point.get(point, 0) for name, point in pins.items()}
        return cls(mechanism, (FRAME, *mechanism.link_names, *sliders, *pins), sliders, pins, order)

    def number(self, body: str) -> int:
        """Number of a body, 0 of the frame."""
        return self.names.index(body)

    def pair(self, first: str, second: str) -> str:
        """Both numbers, as they stand at a reaction of the first on the second."""
        comma = "," if len(self.names) > MOST_DIGITS else ""
        return f"{self.number(first)}{comma}{self.number(second)}"

    def carrier(self, guide: Guide) -> str:
        """Name of the body that slides on a guide: its link, or the slider that is understood."""
        if guide.link is not None:
            return guide.link
        return next(name for name, own in self.sliders.items() if own is guide)

    @cached_property
    def at_point(self) -> Mapping[str, tuple[str, ...]]:
        """Point -> the bodies that have it, the one that carries its pin first.

        That is the body that is found first in the plan; within a group a slider, then a link that a guide guides
        there, then description order.
        """
        found: dict[str, list[str]] = {point: [FRAME] for point in self.mechanism.frame.points}
        for name, guide in self.sliders.items():
            found.setdefault(guide.point, []).append(name)
        for name, link in self.mechanism.links.items():
            for point in link.coordinates:
                found.setdefault(point, []).append(name)
        for name, point in self.pins.items():
            found.setdefault(point, []).append(name)
        return {point: tuple(sorted(names, key=self._rank(point))) for point, names in found.items()}

    def _rank(self, point: str) -> Rank:
        guided = {guide.link for guide in self.mechanism.guides if guide.point == point}
        return Rank(self.order, set(self.sliders), guided)

    def host(self, point: str) -> str:
        """The body that carries the pin of a point; loads on the point act on it."""
        return self.at_point[point][0]


def _with_its_point(group: Group, number: int, points: Mapping[str, int], links: Mapping[str, int]) -> int:
    """Place of a group's links in the plan: a link that does not turn belongs to the group that gives its point."""
    if isinstance(group, TurnedLink) and isinstance(group.turning, Turning) and group.turning.drive is None:
        bases = {group.turning.link, group.turning.relative_to} - {group.link}
        return max(points.get(group.pivot, number), *(links.get(base, number) for base in bases))
    return number


@dataclass(frozen=True)
class Rank:
    """Sorting key of the bodies at a point."""

    order: Mapping[str, int]
    sliders: set[str]
    guided: set[str | None]

    def __call__(self, body: str) -> tuple[int, int]:
        special = 0 if body in self.sliders else 1 if body in self.guided else 2
        return self.order[body], special


# Joints between the bodies, each with the unknown forces and moments that it can transfer.

Kind: TypeAlias = Literal["hinge", "guide", "rolling", "mesh", "drive"]
Basis: TypeAlias = tuple[complex, float]
"""A unit force at the joint's place, and a unit moment."""


@dataclass(frozen=True)
class StaticJoint:
    """Joint of two bodies (three of a gear) with its unknown forces and moments.

    Attributes
    ----------
    name : point, guide, gear, rolling wheel or drive
    shares : body -> factor of the action on it: -1 and 1 of two bodies, the second being the one with 1
    place : where its force acts
    bases : unknowns: unit force and unit moment on a body of share 1
    along : unit vector of a guide, or of what a drive pushes along
    alone : whether no other joint has reactions between the same bodies
    inclined : whether the force between teeth has its radial part
    """

    kind: Kind
    name: str
    shares: Mapping[str, float]
    place: complex
    bases: tuple[Basis, ...]
    along: complex = 0j
    alone: bool = True
    inclined: bool = False

    @property
    def bodies(self) -> tuple[str, ...]:
        """Bodies that it joins."""
        return tuple(self.shares)

    def other(self, body: str) -> str:
        """The other of two bodies."""
        return next(name for name in self.shares if name != body)

    @property
    def has_force(self) -> bool:
        """Whether it transfers forces, and not a moment alone."""
        return any(force for force, _moment in self.bases)

    @property
    def letter(self) -> str:
        """R of hinges and rolling contacts, P of guides, nothing of others."""
        if self.kind in ("hinge", "rolling") and len(self.bases) == 2:
            return "R"
        return "P" if self.kind == "guide" else ""


XY: tuple[Basis, ...] = ((1 + 0j, 0.0), (1j, 0.0))


def joints_of(
    structure: Structure,
    bodies: FreeBodies,
    drawing: VectorDrawing,
    teeth: Mapping[str, complex] = MappingProxyType({}),
) -> tuple[StaticJoint, ...]:
    """All joints as they stand, hinges first; `alone` is false where two joints join the same bodies.

    `teeth` are tangential forces on the second wheels of pairs of gears [N]: their senses say which flanks bear.
    """
    found = [
        *_hinges(bodies, drawing),
        *_guides(bodies, drawing),
        *_wheels(structure, bodies, drawing, teeth),
        *(_drive(drive, bodies, drawing) for drive in structure.mechanism.drives),
    ]
    reactions = [joint for joint in found if joint.kind != "drive" and joint.has_force]
    # two joints between the same bodies have reactions of one name: the joint is added to it then
    pairs = Counter(frozenset(joint.bodies) for joint in reactions)
    return tuple(replace(joint, alone=pairs[frozenset(joint.bodies)] < 2) for joint in found)


def _hinges(bodies: FreeBodies, drawing: VectorDrawing) -> Iterator[StaticJoint]:
    for point, (host, *others) in bodies.at_point.items():
        for other in others:
            yield StaticJoint("hinge", point, {host: -1.0, other: 1.0}, drawing.point(point), XY)


def _guides(bodies: FreeBodies, drawing: VectorDrawing) -> Iterator[StaticJoint]:
    for guide in bodies.mechanism.guides:
        along = _heading(drawing, guide.on, drawing.numbers.direction[guide.id])
        shares = {guide.on: -1.0, bodies.carrier(guide): 1.0}
        bases: tuple[Basis, ...] = ((1j * along, 0.0), (0j, 1.0))
        yield StaticJoint("guide", guide.id, shares, drawing.point(guide.point), bases, along)


def _wheels(
    structure: Structure, bodies: FreeBodies, drawing: VectorDrawing, teeth: Mapping[str, complex]
) -> Iterator[StaticJoint]:
    redundant = {one.rolling for one in structure.redundant if isinstance(one, TrackContact)}
    for constraint in structure.constraints:
        if isinstance(constraint, GearRatio):
            yield _mesh(constraint, bodies, drawing, teeth.get(constraint.gear))
        if isinstance(constraint, NoSlip):
            at = complex(*contact_point(constraint, PLAIN, drawing.numbers, drawing.at))
            apart = drawing.point(constraint.centre) - at
            across = 1j * apart / abs(apart)
            # a contact that something else keeps presses with a force that equilibrium does not tell: it is
            # left out
            bases = XY if constraint.rolling not in redundant else ((across, 0.0),)
            shares = {constraint.on: -1.0, constraint.link: 1.0}
            yield StaticJoint("rolling", constraint.rolling, shares, at, bases, across)


def _mesh(gear: GearRatio, bodies: FreeBodies, drawing: VectorDrawing, tooth: complex | None) -> StaticJoint:
    """A force at the pitch point along the line of action; moments alone where nothing tells that point.

    Of a gear without a pair nothing tells the pressure angle: its force is square to the line of centres, and the
    radial part, which presses the wheels apart, is left out.
    """
    weights = gear.weights(drawing.numbers)
    ratio = float(drawing.numbers.gearing.ratio[gear.gear])
    axes = [_axes(bodies, wheel, gear.carrier) for wheel in (gear.first, gear.second)]
    if len(axes[0]) == len(axes[1]) == 1 and axes[0] != axes[1] and ratio != 1.0:
        first, second = (drawing.point(names[0]) for names in axes)
        # where both wheels have one velocity against the carrier: w1 (P - A) = w2 (P - B) with w2 = i w1
        pitch = (first - ratio * second) / (1.0 - ratio)
        across = 1j * (pitch - second) / abs(pitch - second)
        pair = next(one.pair for one in bodies.mechanism.gears if one.id == gear.gear)
        if pair is not None and tooth:
            # which flanks bear decides on which side of the tangent the line of action lies
            sense = 1.0 if (tooth * across.conjugate()).real >= 0.0 else -1.0
            away = (second - first) / abs(second - first)
            angle = pair.working_mesh()[0]
            across = across * math.cos(angle) + sense * pair.turns * away * math.sin(angle)
        shares = {gear.first: -1.0, gear.second: 1.0}
        inclined = pair is not None and bool(tooth)
        return StaticJoint("mesh", gear.gear, shares, pitch, ((across, 0.0),), across, inclined=inclined)
    shares = {link: float(weight) for link, weight in weights.items() if weight != 0.0}
    return StaticJoint("mesh", gear.gear, shares, 0j, ((0j, 1.0),))


def _axes(bodies: FreeBodies, wheel: str, carrier: str) -> list[str]:
    """Points in which a wheel is hinged to its carrier."""
    return [point for point, names in bodies.at_point.items() if wheel in names and carrier in names]


def _drive(drive: Drive, bodies: FreeBodies, drawing: VectorDrawing) -> StaticJoint:
    """Its moment on the driven link, or its force, positive as its coordinate grows."""
    sense = bodies.mechanism.motion_parameter.drive(drive.id).sense
    if drive.link is not None:
        shares = {drive.relative_to: -sense, drive.link: sense}
        both = [point for point, names in bodies.at_point.items() if set(shares) <= set(names)]
        at = drawing.point(both[0]) if both else 0j
        return StaticJoint("drive", drive.id, shares, at, ((0j, 1.0),))
    if drive.guide is not None:
        guide = bodies.mechanism.guide(drive.guide)
        along = _heading(drawing, guide.on, drawing.numbers.direction[guide.id])
        shares, at = {guide.on: -sense, bodies.carrier(guide): sense}, drawing.point(guide.point)
        return StaticJoint("drive", drive.id, shares, at, ((along, 0.0),), along)
    assert drive.distance is not None
    first, second = drive.distance
    at = drawing.point(second)
    along = at - drawing.point(first)
    along /= abs(along)
    shares = {bodies.host(first): -sense, bodies.host(second): sense}
    return StaticJoint("drive", drive.id, shares, at, ((along, 0.0),), along)


def _heading(drawing: VectorDrawing, on: str, direction: tuple[float, float]) -> complex:
    """Unit vector of a guide as it stands."""
    angle = 0.0 if on == FRAME else cmath.phase(complex(*drawing.at.poses[on].rotor))
    return complex(*direction) * cmath.rect(1.0, angle)


# Forces and moments on the bodies at an instant: loads, weights, inertia, and reactions as they get known.

Source: TypeAlias = Literal["load", "weight", "inertia", "reaction", "drive"]


@dataclass(frozen=True)
class Action:
    """A force [N] at a place, or a moment [N m], on a body; a reaction of a guide has both.

    Attributes
    ----------
    symbol : G2, Φ2, MΦ2, F1, R12
    label : what it is: the load's name, the link, the joint
    """

    symbol: str
    label: str
    body: str
    source: Source
    force: complex = 0j
    place: complex = 0j
    moment: float = 0.0

    def about(self, place: complex) -> float:
        """Its moment about a place [N m], counter-clockwise positive."""
        return self.moment + cross(self.place - place, self.force)


@dataclass(frozen=True)
class MomentTerm:
    """An action by its symbol, with its moment about a place [N m]."""

    symbol: str
    moment: float


def total(actions: Iterable[Action]) -> complex:
    """Sum of the forces."""
    return sum((action.force for action in actions), 0j)


def moment_about(actions: Iterable[Action], place: complex) -> float:
    """Sum of the moments about a place."""
    return sum(action.about(place) for action in actions)


def outer_actions(
    burden: MassesAndLoads, state: State, rates: StateRates, drawing: VectorDrawing, bodies: FreeBodies
) -> list[Action]:
    """Loads, weights and inertia on the moving bodies and the frame at the only sample of a state."""
    reader = ActionReader(burden, state, drawing, bodies)
    found = list(reader.loads())
    for mass in burden.masses:
        found += reader.inertia(mass, rates)
    return found


@dataclass(frozen=True)
class StateRates:
    """First and second derivative by time of what a state's jets are differentiated by."""

    first: float
    second: float

    def acceleration(self, jet: Any) -> float:
        """Second derivative by time of a jet."""
        return _number(jet.derivative(2)) * self.first**2 + _number(jet.derivative(1)) * self.second


@dataclass(frozen=True)
class ActionReader:
    """Turns loads and masses into actions."""

    burden: MassesAndLoads
    state: State
    drawing: VectorDrawing
    bodies: FreeBodies

    def inertia(self, mass: Mass, rates: StateRates) -> Iterator[Action]:
        """Force and moment of inertia of a link, against its acceleration."""
        number = self.bodies.number(mass.link)
        if mass.weighs:
            x, y = self.state.centre(mass.centre)
            pulled = -mass.mass * complex(rates.acceleration(x), rates.acceleration(y))
            yield Action(f"Φ{number}", mass.link, mass.link, "inertia", pulled, self.place(mass.centre))
        if mass.resists:
            turn = -mass.moment_of_inertia * rates.acceleration(self.state.angle(mass.link))
            yield Action(f"MΦ{number}", mass.link, mass.link, "inertia", moment=turn)

    def loads(self) -> Iterator[Action]:
        """Loads in description order, then weights; forces of one load on one place are put together."""
        known = np.ones((1, 1), dtype=bool)
        numbers = Counter[str]()
        for load in self.burden.loads:
            source, symbol = self.symbol(load, numbers)
            gathered: dict[tuple[str, complex], Action] = {}
            for effort, strength in zip(load.efforts, load.strengths(self.state, known), strict=True):
                for one in self.actions(effort, _number(strength)):
                    body, force, place, moment = one
                    before = gathered.get((body, place))
                    if before is not None:
                        force, moment = force + before.force, moment + before.moment
                    gathered[body, place] = Action(symbol, load.label, body, source, force, place, moment)
            # a load between two bodies has an action on each: the body is added to its name
            both = len([body for body, _place in gathered if body != FRAME]) > 1
            for (body, _place), action in gathered.items():
                name = f"{symbol}({self.bodies.number(body)})" if both or body == FRAME else symbol
                yield Action(name, action.label, body, source, action.force, action.place, action.moment)

    def symbol(self, load: AppliedLoad, numbers: Counter[str]) -> tuple[Source, str]:
        """G with the link's number of weights; F and M of other loads, counted."""
        coordinates = [effort.coordinate for effort in load.efforts]
        first = coordinates[0] if coordinates else None
        if isinstance(first, Component) and isinstance(first.at, Centre):
            symbol = f"G{self.bodies.number(first.at.link)}"
            numbers[symbol] += 1
            return "weight", symbol + "′" * (numbers[symbol] - 1)
        letter = "M" if isinstance(first, Turn) else "F"
        numbers[letter] += 1
        return "load", f"{letter}{numbers[letter]}"

    def actions(self, effort: LoadTerm, strength: float) -> Iterator[tuple[str, complex, complex, float]]:
        """Body, force, place and moment of each action that an effort of this strength is."""
        along = effort.coordinate if effort.works is None else effort.works
        match along:
            case Component():
                body = self.bodies.host(along.at) if isinstance(along.at, str) else along.at.link
                yield body, strength * self.direction(along), self.place(along.at), 0.0
            case Turn(link, base):
                yield link, 0j, 0j, strength
                yield base, 0j, 0j, -strength
            case Slide():
                guide = self.bodies.mechanism.guide(along.guide)
                unit = complex(*self.drawing.numbers.direction[guide.id])
                force = strength * unit * complex(*self.drawing.at.poses[guide.on].rotor)
                # on both bodies at the place of the sliding point: the pair has no moment
                place = self.drawing.point(guide.point)
                yield self.bodies.carrier(guide), force, place, 0.0
                yield guide.on, -force, place, 0.0
            case Distance(first, second) | HalfSquare(first, second):
                ends = self.drawing.point(first), self.drawing.point(second)
                apart = ends[1] - ends[0]
                force = strength * (apart if isinstance(along, HalfSquare) else apart / abs(apart))
                yield self.bodies.host(second), force, ends[1], 0.0
                yield self.bodies.host(first), -force, ends[0], 0.0
            case Spin() | HingeTurn() | GuideArc() | AngularDistance() | Travel():
                along.pulls(self.state)  # says why it acts on no body
            case _:
                assert_never(along)

    def direction(self, along: Component) -> complex:
        """Unit vector of a component as it stands."""
        unit = complex(*along.direction)
        turn = 1.0 + 0j if along.axes == FRAME else complex(*self.drawing.at.poses[along.axes].rotor)
        return unit / abs(unit) * turn

    def place(self, at: str | Centre | Radial) -> complex:
        """Place of a point or of a centre of mass."""
        if isinstance(at, str):
            return self.drawing.point(at)
        assert isinstance(at, Centre)
        turn = complex(*self.drawing.at.poses[at.link].rotor)
        return self.drawing.point(at.base) + turn * complex(float(at.along), float(at.across))


def _number(value: Any) -> float:
    """The only entry of what may be an array, or a plain number."""
    return float(np.ravel(value)[0])


# What is known while groups are solved: actions on every body, reactions of the joints, names of reactions.

SINGULAR = 16.0 * (2.0**-52) ** 0.5
"""Sines smaller than this are those of a dead point: there rounding of positions alone leaves the root of twice its
own share, some 2e-8."""
ROUNDED = 1e-14
"""Moments smaller than this part of the greatest force times length are rounding of none, and are not told."""


@dataclass
class Ledger:
    """Actions known so far.

    Attributes
    ----------
    actions : body -> what acts on it
    forces : joint (its number in `joints`) -> force and moment on a body of share 1
    scale : greatest length [m]
    """

    bodies: FreeBodies
    joints: Sequence[StaticJoint]
    scale: float
    actions: dict[str, list[Action]]
    forces: dict[int, tuple[complex, float]] = field(default_factory=dict)

    @classmethod
    def of(
        cls, bodies: FreeBodies, joints: Sequence[StaticJoint], outer: Iterable[Action], scale: float
    ) -> Ledger:
        """The outer actions, before any reaction is known."""
        actions: dict[str, list[Action]] = {name: [] for name in bodies.names}
        for action in outer:
            actions[action.body].append(action)
        return cls(bodies, joints, scale, actions)

    def on(self, names: Sequence[str]) -> list[Action]:
        """Actions on some bodies, body by body."""
        return [action for name in names for action in self.actions[name]]

    def settle(self, joint: StaticJoint, force: complex, moment: float = 0.0) -> None:
        """Enter the reaction of a joint, given on a body of share 1, with all its bodies."""
        # by identity: two joints may be equal in all their numbers
        number = next(k for k, one in enumerate(self.joints) if one is joint)
        self.forces[number] = force, moment
        for body in joint.shares:
            self.actions[body].append(self.reaction(joint, body, force, moment))

    def reaction(self, joint: StaticJoint, body: str, force: complex, moment: float = 0.0) -> Action:
        """The action of a joint on one of its bodies."""
        share = joint.shares[body]
        return Action(
            self.symbol(joint, body),
            joint.name,
            body,
            "drive" if joint.kind == "drive" else "reaction",
            share * force,
            joint.place,
            share * moment,
        )

    def symbol(self, joint: StaticJoint, body: str) -> str:
        """R12 of body 1 on body 2; Mb and Fb of a drive, Mz of a gear's mesh."""
        if joint.kind == "drive":
            several = len(self.bodies.mechanism.drives) > 1
            name = ("Fb" if joint.has_force else "Mb") + (f"({joint.name})" if several else "")
            # what is driven has the moment or force itself, whichever sense of the coordinate counts it
            sense = self.bodies.mechanism.motion_parameter.drive(joint.name).sense
            return name if sense * joint.shares[body] > 0 else f"−{name}"
        if joint.kind == "mesh" and not joint.has_force:
            several = len(self.bodies.mechanism.gears) > 1
            return f"Mz{self.bodies.number(body)}" + (f"({joint.name})" if several else "")
        name = f"R{self.bodies.pair(joint.other(body), body)}"
        return name if joint.alone else f"{name}({joint.name})"

    def moment(self, names: Sequence[str], place: complex) -> float:
        """Moment about a place of what acts on some bodies."""
        return moment_about(self.on(names), place)

    def terms(self, names: Sequence[str], place: complex) -> tuple[MomentTerm, ...]:
        """The same term by term; terms that are rounding of none are left out."""
        terms = [MomentTerm(action.symbol, action.about(place)) for action in self.on(names)]
        none = ROUNDED * self.scale * max((abs(action.force) for action in self.on(names)), default=0.0)
        return tuple(term for term in terms if abs(term.moment) > none)


def across(first: complex, second: complex) -> float:
    """Sine of the angle between two unit vectors along which forces are looked for.

    Raises MotionError at a dead point, where it is not told from zero.
    """
    sine = cross(first, second)
    if abs(sine) < SINGULAR:
        dead_point()
    return sine


def dead_point() -> None:
    """Say that reactions are not determined there."""
    raise MotionError(
        "at",
        _("the mechanism is singular there (dead position): no finite forces keep the group in equilibrium"),
        _("choose another instant"),
    )


# A dyad as two bodies, each with its outer joint, and the joint between them.


@dataclass(frozen=True)
class ForceSide:
    """A body of a dyad with its outer joint."""

    body: str
    joint: StaticJoint

    def known(self, ledger: Ledger) -> complex:
        """Sum of the known forces on the body."""
        return total(ledger.actions[self.body])


@dataclass(frozen=True)
class Dyad:
    """Both sides and the inner joint; of RRP, RPP the side with the outer hinge stands first."""

    first: ForceSide
    second: ForceSide
    inner: StaticJoint

    @property
    def kind(self) -> str:
        """Outer, inner, outer."""
        return self.first.joint.letter + self.inner.letter + self.second.joint.letter


# Which bodies are in equilibrium by themselves, group by group, the last of the plan first.
#
# A perfect matching of the unknowns of the joints with the equations of equilibrium, then the strong
# components of "its equations hold unknowns of" (Dulmage and Mendelsohn): these are Assur's groups and the
# input links.

Equation: TypeAlias = tuple[str, int]


@dataclass(frozen=True)
class Cell:
    """Bodies whose joints get known together, with these joints."""

    bodies: tuple[str, ...]
    joints: tuple[StaticJoint, ...]

    @property
    def inner(self) -> tuple[StaticJoint, ...]:
        """Joints between its own bodies."""
        return tuple(j for j in self.joints if set(j.bodies) <= set(self.bodies))

    def of(self, body: str) -> tuple[StaticJoint, ...]:
        """Joints of one of its bodies."""
        return tuple(joint for joint in self.joints if body in joint.shares)


def cells_of(structure: Structure, bodies: FreeBodies, joints: Sequence[StaticJoint]) -> tuple[Cell, ...]:
    """Groups in the order in which reactions get known.

    Raises NotComputedYet where constraints repeat each other, so that equilibrium does not determine the reactions.
    """
    repeated = [one.label for one in structure.redundant if not isinstance(one, TrackContact)]
    if repeated:
        _refuse(repeated)
    names = [name for name in reversed(bodies.names) if name != FRAME]
    # the last groups of the plan first, as on paper: forces run from the ends to the drive
    names.sort(key=lambda name: -bodies.order[name])
    unknowns = [(joint, k) for joint in joints for k in range(len(joint.bases))]
    owner = match({number: _equations(bodies, *unknown) for number, unknown in enumerate(unknowns)})
    # an unknown without an equation, or an equation without an unknown: the reactions are not determined
    loose = set(range(len(unknowns))) - set(owner.values())
    if loose or len(owner) != sum(_size(bodies, name) for name in names):
        _refuse(sorted({unknowns[number][0].name for number in loose}))
    home = {number: body for (body, _row), number in owner.items()}
    depends: dict[str, list[str]] = {name: [] for name in names}
    for number, (joint, _basis) in enumerate(unknowns):
        for body in joint.bodies:
            # the unknown stands in equations of another body too, which therefore has to wait for it
            if body not in (FRAME, home[number]):
                depends[body].append(home[number])
    components = in_order(strong_components(depends), depends)
    return tuple(_cell(bodies, component, unknowns, home) for component in components)


def _size(bodies: FreeBodies, body: str) -> int:
    """Equations of a body: two of a bare pin."""
    return 2 if body in bodies.pins else 3


def _equations(bodies: FreeBodies, joint: StaticJoint, basis: int) -> list[Equation]:
    """Equations in which an unknown stands: of a force all three, of a moment the last."""
    force, _moment = joint.bases[basis]
    rows = range(3) if force else (2,)
    return [
        (body, row) for body in joint.bodies if body != FRAME for row in rows if row < _size(bodies, body)
    ]


def _cell(
    bodies: FreeBodies,
    component: Sequence[str],
    unknowns: Sequence[tuple[StaticJoint, int]],
    home: Mapping[int, str],
) -> Cell:
    own = tuple(name for name in bodies.names if name in component)
    found: list[StaticJoint] = []
    for number in sorted(home):
        joint = unknowns[number][0]
        if home[number] in own and not any(joint is other for other in found):
            found.append(joint)
    return Cell(own, tuple(found))


def _refuse(names: Sequence[str]) -> None:
    raise NotComputedYet(
        ", ".join(names),
        _("constraints are redundant: equilibrium does not determine the reactions"),
        _("remove the redundant ones from the description"),
    )
