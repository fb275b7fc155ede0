"""The table of joints of a mechanism: which body the reaction of a joint acts on, and which one bears its opposite."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

from centrode.model.mechanism import FRAME, Mechanism


class JointKind(Enum):
    """Kinds of joints, in the order of the table."""

    HINGE = "hinge"
    GUIDE = "guide"
    GEAR = "gear"
    WHEEL = "wheel"
    CYLINDER = "cylinder"


@dataclass(frozen=True)
class TabledJoint:
    """A column of the table of joints.

    Attributes
    ----------
    kind : of joint
    name : point, guide, gear, wheel or drive
    first : body that the reaction acts on (+1)
    second : body that bears the opposite (-1); a link or the frame
    one_of_several : whether its hinge has more joints
    """

    kind: JointKind
    name: str
    first: str
    second: str
    one_of_several: bool = False

    def sign(self, body: str) -> int:
        """1 where the reaction acts, -1 where its opposite does, else 0."""
        return (body == self.first) - (body == self.second)


def tabled_joints(mechanism: Mechanism) -> tuple[TabledJoint, ...]:
    """The joints: hinges in the order in which the links name them, then guides, gears, wheels and cylinders.

    The reaction acts on the link that the description names first. A hinge of k links is k - 1 joints: of the first
    link with each of the others.
    """
    return (*_hinges(mechanism), *_guides(mechanism), *_wheels(mechanism), *_cylinders(mechanism))


def _bodies_at(mechanism: Mechanism, point: str) -> list[str]:
    """Links hinged at a point, in description order, the frame last."""
    links = [name for name, link in mechanism.links.items() if point in link.coordinates]
    return [*links, FRAME] if point in mechanism.frame.points else links


def _hinges(mechanism: Mechanism) -> Iterator[TabledJoint]:
    for point in dict.fromkeys(point for link in mechanism.links.values() for point in link.coordinates):
        first, *others = _bodies_at(mechanism, point)
        for other in others:
            yield TabledJoint(JointKind.HINGE, point, first, other, len(others) > 1)


def _guides(mechanism: Mechanism) -> Iterator[TabledJoint]:
    """Guides, each between the slider, or the first link at its point, and the body that carries its line."""
    for guide in mechanism.guides:
        slider = guide.link or next(iter(_bodies_at(mechanism, guide.point)), "")
        yield TabledJoint(JointKind.GUIDE, guide.id, slider, guide.on)


def _wheels(mechanism: Mechanism) -> Iterator[TabledJoint]:
    for gear in mechanism.gears:
        yield TabledJoint(JointKind.GEAR, gear.id, gear.links[0], gear.links[1])
    for wheel in mechanism.rolling:
        yield TabledJoint(JointKind.WHEEL, wheel.id, wheel.link, wheel.on)


def _cylinders(mechanism: Mechanism) -> Iterator[TabledJoint]:
    for drive in mechanism.drives:
        if drive.distance is not None:
            first, second = (next(iter(_bodies_at(mechanism, point)), "") for point in drive.distance)
            yield TabledJoint(JointKind.CYLINDER, drive.id, second, first)
