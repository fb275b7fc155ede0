"""Joints between the bodies, each with the unknown forces and moments that it can transfer."""

from __future__ import annotations

import cmath
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

from centrode.algebra.plain import PLAIN
from centrode.analysis.graphic.stage import Drawing
from centrode.dynamics.force_polygons.bodies import Bodies
from centrode.model.mechanism import FRAME, Drive
from centrode.structure.constraints import Contact, GearRatio, NoSlip, contact_point
from centrode.structure.plan import Structure

Kind: TypeAlias = Literal["hinge", "guide", "rolling", "mesh", "drive"]
Basis: TypeAlias = tuple[complex, float]
"""A unit force at the joint's place, and a unit moment."""


@dataclass(frozen=True)
class Joint:
    """What two bodies (three of a gear) do to each other.

    Attributes
    ----------
    name : point, guide, gear, rolling wheel or drive
    shares : body -> factor of the action on it: -1 and 1 of two bodies, the second being the one with 1
    place : where its force acts
    bases : unknowns: unit force and unit moment on a body of share 1
    along : unit vector of a guide, or of what a drive pushes along
    alone : whether no other joint has reactions between the same bodies
    """

    kind: Kind
    name: str
    shares: Mapping[str, float]
    place: complex
    bases: tuple[Basis, ...]
    along: complex = 0j
    alone: bool = True

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


def joints_of(structure: Structure, bodies: Bodies, drawing: Drawing) -> tuple[Joint, ...]:
    """All joints as they stand, hinges first; `alone` is false where two joints join the same bodies."""
    found = [
        *_hinges(bodies, drawing),
        *_guides(bodies, drawing),
        *_wheels(structure, bodies, drawing),
        *(_drive(drive, bodies, drawing) for drive in structure.mechanism.drives),
    ]
    reactions = [joint for joint in found if joint.kind != "drive" and joint.has_force]
    pairs = Counter(frozenset(joint.bodies) for joint in reactions)
    return tuple(
        Joint(j.kind, j.name, j.shares, j.place, j.bases, j.along, pairs[frozenset(j.bodies)] < 2)
        for j in found
    )


def _hinges(bodies: Bodies, drawing: Drawing) -> Iterator[Joint]:
    for point, (host, *others) in bodies.at_point.items():
        for other in others:
            yield Joint("hinge", point, {host: -1.0, other: 1.0}, drawing.point(point), XY)


def _guides(bodies: Bodies, drawing: Drawing) -> Iterator[Joint]:
    for guide in bodies.mechanism.guides:
        along = _heading(drawing, guide.on, drawing.numbers.direction[guide.id])
        shares = {guide.on: -1.0, bodies.carrier(guide): 1.0}
        bases: tuple[Basis, ...] = ((1j * along, 0.0), (0j, 1.0))
        yield Joint("guide", guide.id, shares, drawing.point(guide.point), bases, along)


def _wheels(structure: Structure, bodies: Bodies, drawing: Drawing) -> Iterator[Joint]:
    redundant = {one.rolling for one in structure.redundant if isinstance(one, Contact)}
    for constraint in structure.constraints:
        if isinstance(constraint, GearRatio):
            yield _mesh(constraint, bodies, drawing)
        if isinstance(constraint, NoSlip):
            at = complex(*contact_point(constraint, PLAIN, drawing.numbers, drawing.at))
            apart = drawing.point(constraint.centre) - at
            across = 1j * apart / abs(apart)
            bases = XY if constraint.rolling not in redundant else ((across, 0.0),)
            shares = {constraint.on: -1.0, constraint.link: 1.0}
            yield Joint("rolling", constraint.rolling, shares, at, bases, across)


def _mesh(gear: GearRatio, bodies: Bodies, drawing: Drawing) -> Joint:
    """A force square to the line of centres at the pitch point; moments alone where nothing tells that point.

    The radial part of a tooth's force, which presses the wheels apart, is left out.
    """
    weights = gear.weights(drawing.numbers)
    ratio = float(drawing.numbers.gearing.ratio[gear.gear])
    axes = [_axes(bodies, wheel, gear.carrier) for wheel in (gear.first, gear.second)]
    if len(axes[0]) == len(axes[1]) == 1 and axes[0] != axes[1] and ratio != 1.0:
        first, second = (drawing.point(names[0]) for names in axes)
        pitch = (first - ratio * second) / (1.0 - ratio)
        across = 1j * (pitch - second) / abs(pitch - second)
        return Joint("mesh", gear.gear, {gear.first: -1.0, gear.second: 1.0}, pitch, ((across, 0.0),), across)
    shares = {link: float(weight) for link, weight in weights.items() if weight != 0.0}
    return Joint("mesh", gear.gear, shares, 0j, ((0j, 1.0),))


def _axes(bodies: Bodies, wheel: str, carrier: str) -> list[str]:
    """Points in which a wheel is hinged to its carrier."""
    return [point for point, names in bodies.at_point.items() if wheel in names and carrier in names]


def _drive(drive: Drive, bodies: Bodies, drawing: Drawing) -> Joint:
    """Its moment on the driven link, positive as the angle grows; its force, positive as the way grows."""
    if drive.link is not None:
        shares = {drive.relative_to: -1.0, drive.link: 1.0}
        both = [point for point, names in bodies.at_point.items() if set(shares) <= set(names)]
        at = drawing.point(both[0]) if both else 0j
        return Joint("drive", drive.id, shares, at, ((0j, 1.0),))
    if drive.guide is not None:
        guide = bodies.mechanism.guide(drive.guide)
        along = _heading(drawing, guide.on, drawing.numbers.direction[guide.id])
        shares, at = {guide.on: -1.0, bodies.carrier(guide): 1.0}, drawing.point(guide.point)
        return Joint("drive", drive.id, shares, at, ((along, 0.0),), along)
    assert drive.distance is not None
    first, second = drive.distance
    at = drawing.point(second)
    along = at - drawing.point(first)
    along /= abs(along)
    shares = {bodies.host(first): -1.0, bodies.host(second): 1.0}
    return Joint("drive", drive.id, shares, at, ((along, 0.0),), along)


def _heading(drawing: Drawing, on: str, direction: tuple[float, float]) -> complex:
    """Unit vector of a guide as it stands."""
    angle = 0.0 if on == FRAME else cmath.phase(complex(*drawing.at.poses[on].rotor))
    return complex(*direction) * cmath.rect(1.0, angle)
