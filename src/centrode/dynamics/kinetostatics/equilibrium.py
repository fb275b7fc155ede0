"""How forces act on bodies: three equations a link and two a pin, in the plane and on the sphere."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

from centrode.algebra.arrays import ARRAYS
from centrode.dynamics.coordinates import place_of
from centrode.dynamics.pulls import NOWHERE, Pull, Vector, couple, on_link, on_point
from centrode.dynamics.states import State
from centrode.geometry.sphere import Attitude, add, basis, combined, cross, dot, subtract, times
from centrode.model.mechanism import Mechanism
from centrode.structure.constraints import FRAME, Constraint, DisplacementDrive, Positions, Row
from centrode.structure.dimensions import Dimensions

Number: TypeAlias = Any
Foot: TypeAlias = tuple[Any, ...]
"""The place of a link's first point, on the sphere with two directions square to it."""


@dataclass(frozen=True)
class Pressing:
    """A force taken off a pin and given to what bears it: a link, or the frame by way of the centre."""

    point: str
    bearer: str
    force: Vector
    at: Vector

    @property
    def pulls(self) -> tuple[Pull, ...]:
        """The same as forces on both."""
        at = NOWHERE if self.bearer == FRAME else self.at
        return on_point(self.point, tuple(-x for x in self.force), self.at), on_link(
            self.bearer, self.force, at
        )


class Equilibrium(Protocol):
    """What the equations of equilibrium ask of a space."""

    @property
    def origin(self) -> Vector:
        """The origin of the frame's axes, as a place."""

    def scale(self, numbers: Dimensions) -> float:
        """Greatest length of the mechanism [m], by which moments are measured."""

    def positions(self, state: State, numbers: Dimensions) -> Positions:
        """Plain positions of a state, to evaluate constraints on."""

    def by_moment(self, constraint: Constraint) -> bool:
        """Whether the multipliers of a constraint are moments; else they are forces."""

    def of_row(self, constraint: Constraint, row: Row, at: Positions, link: str | None) -> tuple[Pull, ...]:
        """Forces and moments of a constraint's row at a multiplier of one; `link` bears what acts on its point."""

    def foot(self, first: Vector) -> Foot:
        """What the equations of a link whose first point has this place are taken about, and along."""

    def on_link(self, pull: Pull, foot: Foot, scale: float) -> tuple[Number, Number, Number]:
        """What a pull does to the three equations of its link [N]."""

    def pin_axes(self, place: Vector) -> Sequence[Vector]:
        """Two directions in which a pin at a place must be in equilibrium."""

    def pressing(self, outer: Iterable[Pull], mechanism: Mechanism, at: Positions) -> tuple[Pressing, ...]:
        """What of the loads on moving pins the space does not let act on them."""

    def centre(self, pulls: Iterable[Pull], mechanism: Mechanism) -> tuple[Pull, ...]:
        """What the centre of the space exerts on each link, of those that all `pulls` act on; two a link.

        The first acts on the link, the second on the frame.
        """


class InPlane:
    """Two forces and a moment about its first point for a link; a pin is in equilibrium along x and y."""

    origin = (0.0, 0.0)

    def scale(self, numbers: Dimensions) -> float:
        return float(numbers.scale)

    def positions(self, state: State, numbers: Dimensions) -> Positions:
        mechanism, space = state.mechanism, numbers.space
        points = {name: place_of(state.point(name)) for name in mechanism.points}
        poses = {FRAME: space.at_rest}
        for link, inside in numbers.local.items():
            point, local = next(iter(inside.items()))
            poses[link] = space.pose_of(state.m.base, place_of(state.rotor(link)), local, points[point])
        return Positions(dict(points), poses, {})

    def by_moment(self, constraint: Constraint) -> bool:
        return constraint.angular

    def of_row(self, constraint: Constraint, row: Row, at: Positions, link: str | None) -> tuple[Pull, ...]:
        found = []
        for entity, values in row.items():
            if entity.kind == "link":
                x, y, moment = values
                found.append(Pull(entity, (x, y), at.poses[entity.name].origin, moment))
                continue
            place = at.points[entity.name]
            found.append(
                on_point(entity.name, values, place) if link is None else on_link(link, values, place)
            )
        return tuple(found)

    def foot(self, first: Vector) -> Foot:
        return (first,)

    def on_link(self, pull: Pull, foot: Foot, scale: float) -> tuple[Number, Number, Number]:
        return pull.force[0], pull.force[1], pull.moment_about(foot[0]) / scale

    def pin_axes(self, place: Vector) -> Sequence[Vector]:
        return (1.0, 0.0), (0.0, 1.0)

    def pressing(self, outer: Iterable[Pull], mechanism: Mechanism, at: Positions) -> tuple[Pressing, ...]:
        return ()

    def centre(self, pulls: Iterable[Pull], mechanism: Mechanism) -> tuple[Pull, ...]:
        return ()


@dataclass(frozen=True)
class OnSphere:
    """Three moments about the centre of the sphere for a link; a pin is in equilibrium along the sphere.

    Links turn about the centre, so that it bears them: hinges bear what lies along the sphere, at its `radius` [m].
    Moments about the centre are taken along the direction of the link's first point, about that point, and square
    to it, where they are forces there times the radius: so small linkages keep their accuracy.
    """

    radius: float
    origin = NOWHERE

    def scale(self, numbers: Dimensions) -> float:
        return self.radius * float(numbers.scale)

    def positions(self, state: State, numbers: Dimensions) -> Positions:
        mechanism = state.mechanism
        points = {
            name: tuple(x / self.radius for x in place_of(state.point(name))) for name in mechanism.points
        }
        poses = {FRAME: numbers.space.at_rest}
        for link in mechanism.links:
            x, y, z = (place_of(axis) for axis in state.attitude(link))
            poses[link] = Attitude(x, y, z)
        return Positions(points, poses, {})

    def by_moment(self, constraint: Constraint) -> bool:
        # the value of a drive along a circle is an arc
        return constraint.angular or isinstance(constraint, DisplacementDrive)

    def of_row(self, constraint: Constraint, row: Row, at: Positions, link: str | None) -> tuple[Pull, ...]:
        point = next((entity for entity in row if entity.kind == "point"), None)
        if point is None:
            return tuple(couple(entity.name, tuple(moment)) for entity, moment in row.items())
        place = at.points[point.name]
        unit = 1.0 / self.radius if self.by_moment(constraint) else 1.0
        first, second = basis(ARRAYS, place)
        force = times(unit, combined((row[point][0], first), (row[point][1], second)))
        there = times(self.radius, place)
        others = [on_link(entity.name, times(-1.0, force), there) for entity in row if entity is not point]
        return on_point(point.name, force, there), *others

    def foot(self, first: Vector) -> Foot:
        return first, *basis(ARRAYS, first)

    def on_link(self, pull: Pull, foot: Foot, scale: float) -> tuple[Number, Number, Number]:
        (up, one, other), force = foot, pull.force
        place = times(1.0 / self.radius, pull.at)
        turning, twist = cross(place, force), cross(subtract(place, up), force)
        if isinstance(pull.moment, tuple):
            moment = times(1.0 / self.radius, pull.moment)
            turning, twist = add(turning, moment), add(twist, moment)
        return dot(one, turning), dot(other, turning), dot(up, twist) * (self.radius / scale)

    def pin_axes(self, place: Vector) -> Sequence[Vector]:
        return basis(ARRAYS, place)

    def pressing(self, outer: Iterable[Pull], mechanism: Mechanism, at: Positions) -> tuple[Pressing, ...]:
        """What does not lie along the sphere.

        The only link of a pin bears it; with several links nothing tells which, so that the centre does.
        """
        found = []
        for pull in outer:
            name = pull.body.name
            if pull.body.kind == "point" and name in mechanism.moving_points:
                up = at.points[name]
                outwards = times(dot(pull.force, up), up)
                links = [link for link, one in mechanism.links.items() if name in one.coordinates]
                found.append(Pressing(name, links[0] if len(links) == 1 else FRAME, outwards, pull.at))
        return tuple(found)

    def centre(self, pulls: Iterable[Pull], mechanism: Mechanism) -> tuple[Pull, ...]:
        sums: dict[str, Vector] = dict.fromkeys(mechanism.links, NOWHERE)
        for pull in pulls:
            if pull.body.kind == "link" and pull.body.name in sums:
                sums[pull.body.name] = add(sums[pull.body.name], pull.force)
        found: list[Pull] = []
        for link, force in sums.items():
            found += [on_link(link, tuple(-x for x in force), NOWHERE), on_link(FRAME, force, NOWHERE)]
        return tuple(found)


def equilibrium_of(mechanism: Mechanism) -> Equilibrium:
    """That of the mechanism's space."""
    return OnSphere(mechanism.sphere_radius) if mechanism.space == "sphere" else InPlane()
