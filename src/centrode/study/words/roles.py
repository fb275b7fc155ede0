"""What each part of a mechanism does in its motion: which links turn fully, which swing and how far."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from centrode.errors import InputError, Status
from centrode.kinematics.motion import motion
from centrode.model.mechanism import Mechanism
from centrode.quantities import display_unit

WHOLE = 1e-6
"""How near to a whole turn counts as one [rad]: joints of one turn close to rounding."""

SAMPLES = 1441
"""Four a degree: an extreme between two samples is missed by some 1e-6 of it, four digits are told."""


@dataclass(frozen=True)
class Roles:
    """Extents of a motion that gets everywhere; without one (it locks, or has no range) nothing is known of them.

    Attributes
    ----------
    swings : link -> angle between its extremes [rad]
    turned : link -> what it turns from the first sample to the last [rad]
    strokes : guide -> way between the extremes of its displacement [m, rad on the sphere]
    ways : guide -> how far its displacement is from first to last sample [m, rad]
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
        """Whether a link goes all the way round."""
        return self.swings.get(link, 0.0) >= math.tau - WHOLE

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

    def angle_text(self, angle: float) -> str:
        """An angle as prose has it: in degrees, where the description does not ask for another unit."""
        unit = self.mechanism.display.angle
        if unit in ("deg", "rad"):
            return f"{math.degrees(angle):.3g}°"
        factor, shown = display_unit("rad", angle=str(unit))
        return f"{angle * factor:.3g} {shown}"

    def length_text(self, length: float) -> str:
        """A length in the description's unit; on the sphere an arc."""
        if self.mechanism.space == "sphere":
            return self.angle_text(length)
        factor, shown = display_unit("m", length=str(self.mechanism.display.length))
        return f"{length * factor:.4g} {shown}"


def roles_of(mechanism: Mechanism) -> Roles:
    """Extents over the range of the description, one turn of the drive if it names none."""
    try:
        data = motion(mechanism, SAMPLES)
    except InputError:
        return Roles(mechanism)
    if not np.isin(data["status"].to_numpy(), (Status.OK, Status.SINGULAR)).all():
        return Roles(mechanism)
    swings, turned, strokes, ways = {}, {}, {}, {}
    name = "angle" if "angle" in data else "joint_angle"
    labels = data["link" if name == "angle" else "joint"].to_numpy()
    for column, link in enumerate(labels):
        angles = data[name].to_numpy()[:, column]
        swings[str(link)], turned[str(link)] = float(np.ptp(angles)), float(angles[-1] - angles[0])
    for column, guide in enumerate(data["guide"].to_numpy()):
        slides = data["slide"].to_numpy()[:, column]
        strokes[str(guide)], ways[str(guide)] = float(np.ptp(slides)), float(slides[-1] - slides[0])
    value = data["drive_value"].to_numpy()[:, 0]
    one_turn = mechanism.motion_parameter.turns and abs(abs(value[-1] - value[0]) - math.tau) < WHOLE
    return Roles(mechanism, swings, turned, strokes, ways, one_turn)
