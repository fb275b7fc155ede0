"""Equilibria that rest on rigid stops: what is closed is a constraint whose force pushes and never pulls.

With stops closed the position is an equilibrium of the mechanism that they hold, and each of their forces points away
from its bound (F. Pfeiffer and C. Glocker, Multibody Dynamics with Unilateral Contacts, 1996, chapter 4). Where all
forces are above zero a small departure keeps the stops closed, so the stability is that of the motions which they
leave.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.equilibria.configuration_curve import position_distance, same_position
from centrode.dynamics.equilibria.equilibrium_search import (
    SAME,
    Equilibria,
    approached_positions,
    force_scale,
    settled_equilibria,
    stop_values,
    walked_positions,
    with_states,
)
from centrode.dynamics.equilibria.linear_equations import LoadedMechanism
from centrode.dynamics.equilibria.small_motions import SmallMotions, small_motions
from centrode.dynamics.forward_dynamics.contacts import stop_coordinate
from centrode.dynamics.forward_dynamics.equations_of_motion import KeptDrive
from centrode.dynamics.load_coordinates import Spin, is_angular
from centrode.dynamics.state import length_unit
from centrode.geometry import sphere
from centrode.kinematics.path import DrivenBy
from centrode.laws import Uniform
from centrode.locale import _
from centrode.model.contacts import Stop
from centrode.model.mechanism import Drive, Mechanism
from centrode.numerics.operations import PLAIN
from centrode.structure.constraints import (
    AngleDrive,
    Constraint,
    DisplacementDrive,
    DistanceDrive,
    Entity,
    Positions,
    Row,
)
from centrode.structure.dimensions import Dimensions, reference_arcs

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

RANK = 1e-9
"""A singular value below this share of the greatest counts as none."""
TOUCHING = 1e-9
"""A coordinate beyond its bound by less than this, in rad or greatest lengths, is at it."""
PUSHING = 1e-9
"""Share of the forces by which the force of a stop is above zero."""
NEAREST = 200
"""Positions nearest to bounds from which closed ones are sought."""
MOST_SETS = 200
"""Sets of closed stops that are looked at."""


@dataclass(frozen=True)
class PointAtWall:
    """A point is at a distance from the origin of the frame, along a direction.

    Attributes
    ----------
    drive : name by which the distance is known
    direction : unit vector
    radius : of the sphere [m], on which points are unit vectors; 1 in the plane
    """

    drive: str
    point: str
    direction: tuple[float, ...]
    radius: float = 1.0
    size = 1
    angular = False

    @property
    def bodies(self) -> tuple[Entity, ...]:
        return (Entity("point", self.point),)

    @property
    def label(self) -> str:
        return _("stop {stop}").format(stop=self.drive)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        parts = [u * x for u, x in zip(self.direction, at.points[self.point], strict=True)]
        return [sum(parts[1:], parts[0]) * self.radius - at.drives[self.drive]]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        return [{self.bodies[0]: tuple(self.radius * u for u in self.direction)}]


@dataclass(frozen=True)
class PointsAtArc:
    """On the sphere: two points are at an angular distance.

    Attributes
    ----------
    drive : name by which the distance [rad] is known
    """

    drive: str
    first: str
    second: str
    size = 1
    angular = True

    @property
    def bodies(self) -> tuple[Entity, ...]:
        return Entity("point", self.first), Entity("point", self.second)

    @property
    def label(self) -> str:
        return _("stop {stop}").format(stop=self.drive)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        return [
            numbers.space.distance(m, at.points[self.first], at.points[self.second]) - at.drives[self.drive]
        ]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        one, other = at.points[self.first], at.points[self.second]
        slopes = sphere.away(PLAIN, one, other), sphere.away(PLAIN, other, one)
        return [dict(zip(self.bodies, slopes, strict=True))]


@dataclass(frozen=True)
class RestingEquilibrium:
    """An equilibrium with closed stops.

    Attributes
    ----------
    place : (coordinates) [rad or m]
    forces : label of a closed stop -> its force along its coordinate [N or N m]: below zero at `most`, above at `least`
    motions : small motions that the closed stops leave
    holding : forces of the drives that are held, as multipliers [N or N m]
    """

    place: Array
    forces: Mapping[str, float]
    motions: SmallMotions
    holding: Array


def resting_equilibria(loaded: LoadedMechanism, free: Equilibria | None) -> tuple[RestingEquilibrium, ...]:
    """Equilibria on rigid stops that are found from positions which the mechanism can be brought to.

    `free` are those without, whose curve of positions is used; stops that are compliant are not closed.
    """
    mechanism = loaded.mechanism
    rigid = [stop for stop in mechanism.stops if stop.is_rigid]
    if not rigid or not loaded.mobility:
        return ()
    curve = None if free is None else free.curve
    starts = curve.places if curve is not None else walked_positions(loaded)
    scale = force_scale(loaded, starts)
    found: list[RestingEquilibrium] = []
    for closed in _closed_sets(rigid, loaded.mobility):
        for one in _with_closed(loaded, closed, starts, scale):
            if not any(_is_same(loaded, one, other) for other in found):
                found.append(one)
    begin = loaded.start
    return tuple(sorted(found, key=lambda one: float(same_position(loaded, one.place[None], begin)[0])))


def _closed_sets(stops: Sequence[Stop], mobility: int) -> Iterator[tuple[tuple[Stop, float, float], ...]]:
    """Sets of stops, each with its bound and which of both it is, that could hold at once."""
    count = 0
    for size in range(1, mobility + 1):
        for chosen in combinations(stops, size):
            bounds = [
                [(bound, sign) for bound, sign in ((stop.least, -1.0), (stop.most, 1.0)) if bound is not None]
                for stop in chosen
            ]
            for at in product(*bounds):
                count += 1
                if count > MOST_SETS:
                    return
                yield tuple((stop, *one) for stop, one in zip(chosen, at, strict=True))


def _with_closed(
    loaded: LoadedMechanism, closed: Sequence[tuple[Stop, float, float]], starts: Array, scale: float
) -> Iterator[RestingEquilibrium]:
    """Equilibria at which some stops are closed, push, and no other is violated."""
    held = _held_stops(loaded, closed)
    near = held.closed_coordinates(_near_bounds(loaded, closed, starts))
    near = near[np.isfinite(near[:, 0])]
    if not len(near):
        return
    # the initial position need not come to the bound at all: how independent rows are is looked at where it does
    held.__dict__["rank"] = _rank(held, near)
    if held.mobility != loaded.mobility - len(closed):
        return
    if held.states:
        places = settled_equilibria(held, with_states(held, near))
    elif held.mobility:
        places = np.concatenate(
            [settled_equilibria(held, near), settled_equilibria(held, approached_positions(held, near[::2]))]
        )
    else:
        places = near
    places = _first_of_same(loaded, places[np.isfinite(places[:, 0])])
    if not len(places):
        return
    there = held.at(places)
    reactions = held.reactions(there)
    motions = small_motions(held, places)
    values = stop_values(loaded, places)
    first = held.equations.equations - len(closed)
    senses = _senses(loaded.mechanism, closed)
    for k, place in enumerate(places):
        # a multiplier acts against its row: upwards at `most` it holds back
        forces = -senses * reactions[k, first:]
        pushes = all(
            -sign * force * _unit(loaded, stop) > PUSHING * scale
            for (stop, _bound, sign), force in zip(closed, forces, strict=True)
        )
        if pushes and _is_allowed(loaded, values[k], closed):
            labels = [stop.label for stop, _bound, _sign in closed]
            own = reactions[k, first - len(loaded.equations.kept) : first]
            yield RestingEquilibrium(
                place, dict(zip(labels, map(float, forces), strict=True)), motions[k], own
            )


def _rank(held: LoadedMechanism, places: Array) -> int:
    """Number of closure equations that do not repeat others at some of the positions (n, coordinates)."""
    _left, rows = held.closures_at(places[:: max(len(places) // 5, 1)])
    sizes = np.linalg.svd(held.scaled_rows(rows), compute_uv=False)
    return int(np.max(np.sum(sizes > RANK * np.max(sizes, axis=1, initial=1.0)[:, None], axis=1)))


def _unit(loaded: LoadedMechanism, stop: Stop) -> float:
    if is_angular(stop_coordinate(loaded.mechanism, stop)):
        return 1.0
    return float(loaded.equations.numbers.scale) * length_unit(loaded.mechanism)


def _near_bounds(
    loaded: LoadedMechanism, closed: Sequence[tuple[Stop, float, float]], starts: Array
) -> Array:
    """Starts with a change of side of one bound behind them, or the nearest ones."""
    numbers = [list(loaded.mechanism.stops).index(stop) for stop, _bound, _sign in closed]
    apart = stop_values(loaded, starts)[:, numbers] - np.array([bound for _stop, bound, _sign in closed])
    apart = apart / np.array([_unit(loaded, stop) for stop, _bound, _sign in closed])
    size = np.max(np.abs(apart), axis=1)
    chosen = np.argsort(size, kind="stable")[:NEAREST]
    if len(closed) == 1:
        # along a curve each change of side is a start of its own
        crossed = np.flatnonzero(np.diff(np.sign(apart[:, 0])) != 0)
        chosen = np.unique(np.concatenate([chosen, crossed]))
    return starts[chosen]


def _held_stops(loaded: LoadedMechanism, closed: Sequence[tuple[Stop, float, float]]) -> LoadedMechanism:
    """The mechanism with stops at their bounds as drives that keep a value."""
    mechanism, equations = loaded.mechanism, loaded.equations
    kept = tuple(_closed_stop(mechanism, stop, bound) for stop, bound, _sign in closed)
    if mechanism.space == "sphere":
        equations = replace(equations, numbers=_with_reference_arcs(equations.numbers, kept))
    return replace(loaded, equations=replace(equations, kept=(*equations.kept, *kept)))


def _with_reference_arcs(numbers: Dimensions, kept: Iterable[KeptDrive]) -> Dimensions:
    """Dimensions with the arcs between which angles of closed stops are measured: else driven links alone have them."""
    arcs = {
        one.constraint.link: reference_arcs(
            one.constraint.link, one.constraint.relative_to, numbers.frame, numbers.local, numbers.ends
        )
        for one in kept
        if isinstance(one.constraint, AngleDrive)
    }
    return replace(numbers, references={**numbers.references, **arcs})


def _closed_stop(mechanism: Mechanism, stop: Stop, bound: float) -> KeptDrive:
    """A stop at its bound as a drive that keeps a value."""
    name, on_sphere = stop.label, mechanism.space == "sphere"
    constraint: Constraint
    if stop.link is not None:
        coordinate = stop_coordinate(mechanism, stop)
        if isinstance(coordinate, Spin):
            # the joint's angle is that of the other link against this one
            constraint, bound = AngleDrive(name, stop.relative_to, stop.link), -bound
        else:
            constraint = AngleDrive(name, stop.link, stop.relative_to)
    elif stop.guide is not None:
        guide = mechanism.guide(stop.guide)
        constraint = DisplacementDrive(name, guide.point, guide.id, guide.on)
    elif stop.point is not None:
        direction = [float(x) for x in stop.direction or (1.0, 0.0)]
        direction = direction if on_sphere else direction[:2]
        length = math.hypot(*direction)
        radius = float(mechanism.sphere_radius) if on_sphere else 1.0
        constraint = PointAtWall(name, stop.point, tuple(x / length for x in direction), radius)
    else:
        first, second = stop.points or ("", "")
        constraint = (PointsAtArc if on_sphere else DistanceDrive)(name, first, second)
    # it has the name of the stop, whatever it drives
    return KeptDrive(constraint, DrivenBy(Drive(guide=name, start=bound, speed=0.0), Uniform(0.0), bound))


def _senses(mechanism: Mechanism, closed: Sequence[tuple[Stop, float, float]]) -> Array:
    """Signs of the coordinates of closed stops against what keeps them: -1 where a joint counts the other link."""
    coordinates = [stop_coordinate(mechanism, stop) for stop, _bound, _sign in closed]
    return np.array([one.sense if isinstance(one, Spin) else 1.0 for one in coordinates])


def _is_allowed(loaded: LoadedMechanism, values: Array, closed: Sequence[tuple[Stop, float, float]]) -> bool:
    """Whether the closed stops are at their bounds, turns counted, and the others within them."""
    at = {stop.label: bound for stop, bound, _sign in closed}
    for stop, value in zip(loaded.mechanism.stops, values, strict=True):
        if not stop.is_rigid:
            continue
        slack = TOUCHING * _unit(loaded, stop)
        low = high = at.get(stop.label)
        if stop.label not in at:
            low, high = stop.least, stop.most
        if (low is not None and value < low - slack) or (high is not None and value > high + slack):
            return False
    return True


def _first_of_same(loaded: LoadedMechanism, places: Array) -> Array:
    """Places without repetitions."""
    kept: list[Array] = []
    for place in places:
        if not kept or np.min(position_distance(loaded, np.array(kept), place)) >= SAME:
            kept.append(place)
    return np.array(kept).reshape(len(kept), loaded.size)


def _is_same(loaded: LoadedMechanism, one: RestingEquilibrium, other: RestingEquilibrium) -> bool:
    return bool(position_distance(loaded, one.place[None], other.place)[0] < SAME)
