"""The principle of operation of a mechanism: what turns fully and what swings, strokes, and what the drive meets."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from centrode.analysis.rotatability.rotatability import LimitFound, Rotatability, rotatability
from centrode.errors import InputError, Status
from centrode.kinematics.motion import motion
from centrode.kinematics.preparation import ready
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.printed_results import PrintsSummary

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism
    from centrode.structure.plan import Structure

WHOLE = 1e-6
"""How near to a whole turn counts as one [rad]: joints of one turn close to rounding."""

STILL = 1e-9
"""A link that turns less than this does not turn [rad]."""

SAMPLES = 1441
"""Four a degree: an extreme between two samples is missed by some 1e-6 of it, of which four digits are shown."""


@dataclass(frozen=True)
class LinkRoles:
    """How far links and sliders move in a motion that gets everywhere.

    Without such a motion (it locks, or has no range) the mappings are empty.

    Attributes
    ----------
    mechanism : the mechanism
    swings : link -> angle between its extremes [rad]
    turned : link -> angle from the first sample to the last [rad]
    strokes : guide -> distance between the extremes of its displacement [m, rad on the sphere]
    ways : guide -> displacement from the first sample to the last [m, rad on the sphere]
    one_turn : whether the motion is one turn of the only drive
    """

    mechanism: Mechanism
    swings: Mapping[str, float] = field(default_factory=dict)
    turned: Mapping[str, float] = field(default_factory=dict)
    strokes: Mapping[str, float] = field(default_factory=dict)
    ways: Mapping[str, float] = field(default_factory=dict)
    one_turn: bool = False

    def pivot(self, link: str) -> str | None:
        """The fixed point about which a link turns."""
        points = self.mechanism.links[link].coordinates
        return next((point for point in points if point in self.mechanism.frame.points), None)

    def turns_fully(self, link: str) -> bool:
        """Whether a link makes a whole turn."""
        return self.swings.get(link, 0.0) >= math.tau - WHOLE

    def stands_still(self, link: str) -> bool:
        """Whether a link does not turn at all."""
        return self.swings.get(link, math.inf) < STILL

    def comes_back(self, guide: str) -> bool:
        """Whether what moves along a guide ends nearer to where it began than its stroke is long."""
        return abs(self.ways[guide]) < (1 - WHOLE) * self.strokes[guide]

    def is_wheel(self, link: str) -> bool:
        """Whether a link is nothing but a wheel: nothing is hinged to it off its axis."""
        wheels = {one.link for one in self.mechanism.rolling}
        wheels.update(name for gear in self.mechanism.gears for name in gear.links)
        others = [other for name, other in self.mechanism.links.items() if name != link]
        joined = {point for other in others for point in other.coordinates}
        joined.update(guide.point for guide in self.mechanism.guides)
        points = set(self.mechanism.links[link].coordinates) - set(self.mechanism.frame.points)
        return link in wheels and not points & joined


@dataclass(frozen=True, repr=False)
class PrincipleOfOperation(PrintsSummary):
    """How a mechanism works.

    Attributes
    ----------
    mechanism : the mechanism
    structure : its groups, in the order in which they follow the drives
    mobility : degrees of freedom at real positions
    roles : how far its links and sliders move
    rotatability : whether the drive turns fully
    first_limits : limits that the drive meets first in the sense in which it moves, else in the other one; none where
        several drives move
    """

    mechanism: Mechanism
    structure: Structure
    mobility: int
    roles: LinkRoles
    rotatability: Rotatability
    first_limits: tuple[LimitFound, ...]


def principle_of_operation(mechanism: MechanismSource) -> PrincipleOfOperation:
    """How a mechanism works: its parts, what follows what, and what bounds the motion.

    Extents (strokes, angles of swing) are those over the description's own range, one turn of the drive if it names
    none. Raises InputError as `check` does.

    Examples
    --------
    >>> import centrode as ct
    >>> print(ct.summary(ct.principle_of_operation(ct.example("crank-rocker"))).splitlines()[-1])
    The mobility is 1: one drive determines the position of every link. The drive can turn fully.
    """
    mechanism = mechanism_of(mechanism)
    prepared = ready(mechanism)
    roles, turning = roles_of(mechanism), rotatability(mechanism)
    limits = first_limits(turning, forward=prepared.kinematics.path.forward > 0)
    return PrincipleOfOperation(mechanism, prepared.structure, prepared.mobility, roles, turning, limits)


def roles_of(mechanism: Mechanism) -> LinkRoles:
    """Extents over the range of the description, one turn of the drive if it names none."""
    try:
        data = motion(mechanism, SAMPLES)
    except InputError:
        return LinkRoles(mechanism)
    if not np.isin(data["status"].values, (Status.OK, Status.SINGULAR)).all():
        return LinkRoles(mechanism)
    swings, turned, strokes, ways = {}, {}, {}, {}
    name = "angle" if "angle" in data else "joint_angle"
    labels = data["link" if name == "angle" else "joint"].values
    for column, link in enumerate(labels):
        angles = data[name].values[:, column]
        swings[str(link)], turned[str(link)] = float(np.ptp(angles)), float(angles[-1] - angles[0])
    for column, guide in enumerate(data["guide"].values):
        slides = data["slide"].values[:, column]
        strokes[str(guide)], ways[str(guide)] = float(np.ptp(slides)), float(slides[-1] - slides[0])
    value = data["drive_value"].values[:, 0]
    one_turn = mechanism.motion_parameter.turns and abs(abs(value[-1] - value[0]) - math.tau) < WHOLE
    return LinkRoles(mechanism, swings, turned, strokes, ways, one_turn)


def first_limits(turning: Rotatability, *, forward: bool) -> tuple[LimitFound, ...]:
    """Limits that the only drive meets first: forwards or backwards, where it is free so, in the other sense."""
    if len(turning.drives) != 1:
        return ()
    end = "high" if forward else "low"
    limits = sorted(turning.limits, key=lambda limit: limit.end != end)
    return tuple(limit for limit in limits if limit.value == limits[0].value)
