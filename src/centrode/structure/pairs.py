"""Kinematic pairs of a mechanism: which bodies each joins, sliders and parts of cylinders among them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias

from centrode.model.mechanism import FRAME, Mechanism
from centrode.structure.rank import is_bare

BodyKind: TypeAlias = Literal["frame", "link", "slider", "barrel", "rod"]
PairKind: TypeAlias = Literal["turning", "sliding", "gear", "rolling"]


@dataclass(frozen=True)
class PairedBody:
    """A body that a pair joins.

    Attributes
    ----------
    kind : the frame, a link, the slider that is understood on a guide, the barrel or the rod of a cylinder
    name : of the link, of the guide, or of the drive whose cylinder it is
    """

    kind: BodyKind
    name: str = ""


@dataclass(frozen=True)
class KinematicPair:
    """A pair with the two bodies that it joins; its name is that of the point, guide, drive, gear or wheel."""

    name: str
    kind: PairKind
    bodies: tuple[PairedBody, PairedBody]


def kinematic_pairs(mechanism: Mechanism) -> tuple[KinematicPair, ...]:
    """Every pair of a mechanism; a hinge of k bodies is k - 1 revolute pairs."""
    return tuple(_pairs(mechanism))


def _pairs(mechanism: Mechanism) -> Iterator[KinematicPair]:
    for point, bodies in _hinged_bodies(mechanism).items():
        for other in bodies[1:]:
            yield KinematicPair(point, "turning", (bodies[0], other))
    for guide in mechanism.guides:
        slider = PairedBody("slider", guide.id) if guide.link is None else PairedBody("link", guide.link)
        yield KinematicPair(guide.id, "sliding", (slider, _carrier(guide.on)))
    for drive in mechanism.drives:
        if drive.distance is not None:
            yield KinematicPair(drive.id, "sliding", _cylinder(drive.id))
    for gear in mechanism.gears:
        yield KinematicPair(gear.id, "gear", (_carrier(gear.links[0]), _carrier(gear.links[1])))
    for wheel in mechanism.rolling:
        yield KinematicPair(wheel.id, "rolling", (_carrier(wheel.link), _carrier(wheel.on)))


def _carrier(name: str) -> PairedBody:
    return PairedBody("frame") if name == FRAME else PairedBody("link", name)


def _cylinder(drive: str) -> tuple[PairedBody, PairedBody]:
    return PairedBody("barrel", drive), PairedBody("rod", drive)


def _hinged_bodies(mechanism: Mechanism) -> dict[str, list[PairedBody]]:
    """Points with the bodies hinged there, the frame last."""
    found: dict[str, list[PairedBody]] = {}
    for name, link in mechanism.links.items():
        for point in link.coordinates:
            found.setdefault(point, []).append(PairedBody("link", name))
    for guide in mechanism.guides:
        if is_bare(guide):
            found.setdefault(guide.point, []).append(PairedBody("slider", guide.id))
    for drive in mechanism.drives:
        if drive.distance is not None:
            for point, body in zip(drive.distance, _cylinder(drive.id), strict=True):
                found.setdefault(point, []).append(body)
    for point in mechanism.frame.points:
        if point in found:
            found[point].append(PairedBody("frame"))
    return {point: bodies for point, bodies in found.items() if len(bodies) > 1}
