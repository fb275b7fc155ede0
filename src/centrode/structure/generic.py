"""Random numbers of gears and rolling wheels for the generic rank: nothing special but what the description says.

An arm or a guide that keeps a wheel at its track does so because the arm turns about the circle's centre, or because
the guide is parallel to the line. These two coincidences belong to the structure and are kept.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, sin, tau

import numpy as np

from centrode.geometry.plane import Vector, cross, reversed_rotor, subtract, turned
from centrode.model.mechanism import Mechanism, Rolling
from centrode.structure.dimensions import Dimensions
from centrode.structure.gearing import Gearing, Round, Straight, Track
from centrode.structure.positions import FRAME, Positions

COINCIDE = 1e-9
"""Places closer than this (in the greatest length) are one, directions closer than this (sine) parallel."""


def random_gearing(
    mechanism: Mechanism,
    numbers: Dimensions,
    at: Positions,
    directions: Mapping[str, Vector],
    random: np.random.Generator,
) -> Gearing:
    """Ratios, radii and tracks at random; `at` and `directions` are the random positions and lines of guides."""
    ratio = {
        gear.id: float(random.choice([-1.0, 1.0]) * random.uniform(0.3, 3.0)) for gear in mechanism.gears
    }
    radius = {wheel.id: float(random.uniform(0.2, 0.6)) for wheel in mechanism.rolling}
    track: dict[str, Track] = {}
    for wheel in mechanism.rolling:
        own = numbers.gearing.track[wheel.id]
        place = float(random.normal()), float(random.normal())
        if isinstance(own, Straight):
            track[wheel.id] = Straight(place, _direction(mechanism, numbers, at, directions, wheel, random))
        else:
            named = point_at(numbers, wheel.on, own.centre)
            centre = place if named is None else local_of(at, wheel.on, named)
            track[wheel.id] = Round(centre, float(random.uniform(0.7, 1.5)), own.inside)
    phase = dict.fromkeys((*ratio, *radius), 0.0)
    return Gearing(ratio, radius, track, phase, numbers.gearing.shares, numbers.gearing.measured)


def point_at(numbers: Dimensions, body: str, local: Vector) -> str | None:
    """The point of a body that lies at local coordinates, if there is one."""
    points = numbers.frame if body == FRAME else numbers.local[body]
    near = COINCIDE * float(numbers.scale)
    for name, (x, y) in points.items():
        if abs(x - local[0]) <= near and abs(y - local[1]) <= near:
            return name
    return None


def local_of(at: Positions, body: str, point: str) -> Vector:
    """Coordinates of a point in the axes of a body."""
    pose = at.poses[body]
    return turned(subtract(at.points[point], pose.origin), reversed_rotor(pose.rotor))


def _direction(
    mechanism: Mechanism,
    numbers: Dimensions,
    at: Positions,
    directions: Mapping[str, Vector],
    wheel: Rolling,
    random: np.random.Generator,
) -> Vector:
    """Direction of a line in the axes of its body: that of a guide it is parallel to, else a random one."""
    track = numbers.gearing.track[wheel.id]
    assert isinstance(track, Straight)
    for guide in mechanism.guides:
        own = numbers.direction[guide.id]
        if guide.on == wheel.on and parallel(own, track.direction):
            return directions[guide.id]
        # the body that carries the track slides on the guide without turning
        seen = turned(own, reversed_rotor(numbers.turn[guide.id]))
        if guide.link == wheel.on and parallel(seen, track.direction):
            absolute = turned(directions[guide.id], at.poses[guide.on].rotor)
            return turned(absolute, reversed_rotor(at.poses[wheel.on].rotor))
    angle = random.uniform(0.0, tau)
    return cos(angle), sin(angle)


def parallel(one: Vector, other: Vector) -> bool:
    """Whether two unit vectors lie in one line."""
    return bool(abs(float(cross(one, other))) <= COINCIDE)
