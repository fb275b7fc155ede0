"""Primary instant centres: those that a joint shows, without any construction."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import Literal, TypeAlias

import numpy as np

from centrode.analysis.instant_centres.bodies import Bodies, Named, Pair
from centrode.model.mechanism import FRAME, Guide, Mechanism, Rolling

Kind: TypeAlias = Literal["hinge", "guide", "rolling"]


@dataclass(frozen=True)
class Joint:
    """Two bodies joined so that their centre is seen: in a hinge, square to a guide, where a wheel touches."""

    kind: Kind
    name: str
    pair: Pair


@dataclass(frozen=True)
class Gearing:
    """A gear ties three centres: with two of those of its wheels and its carrier the third is known."""

    name: str
    first: int
    second: int
    carrier: int
    ratio: float


def joints_of(mechanism: Mechanism, bodies: Named) -> tuple[Joint, ...]:
    """Hinges, guides and rolling wheels, in the order of the points, the guides and the wheels."""
    found: list[Joint] = []
    for point in mechanism.points:
        found += [Joint("hinge", point, ordered(pair)) for pair in combinations(carriers(bodies, point), 2)]
    for guide in mechanism.guides:
        slid = guide.link if guide.link is not None else slider_of(bodies, guide)
        found.append(Joint("guide", guide.id, ordered((bodies.number(slid), bodies.number(guide.on)))))
    for wheel in mechanism.rolling:
        pair = ordered((bodies.number(wheel.link), bodies.number(wheel.on)))
        found.append(Joint("rolling", wheel.id, pair))
    return tuple(found)


def gearings_of(mechanism: Mechanism, bodies: Named) -> tuple[Gearing, ...]:
    """Gears as ties between centres."""
    return tuple(
        Gearing(
            gear.id,
            bodies.number(gear.links[0]),
            bodies.number(gear.links[1]),
            bodies.number(gear.carrier),
            gear.ratio,
        )
        for gear in mechanism.gears
    )


def ordered(pair: Pair) -> Pair:
    """A pair as it is named: the later body against the earlier one."""
    return max(pair), min(pair)


def carriers(bodies: Named, point: str) -> list[int]:
    """Bodies that are hinged at a point: links and the frame that name it, and its sliders."""
    mechanism = bodies.mechanism
    names = [FRAME] if point in mechanism.frame.points else []
    names += [name for name, link in mechanism.links.items() if point in link.coordinates]
    names += [name for name, guide in bodies.sliders.items() if guide.point == point]
    return [bodies.number(name) for name in names]


def slider_of(bodies: Named, guide: Guide) -> str:
    """Name of the slider of a guide."""
    return next(name for name, own in bodies.sliders.items() if own.id == guide.id)


def place_of(joint: Joint, bodies: Bodies) -> tuple[complex, bool]:
    """Where a primary centre is at one sample, or its direction if it is at infinity (then True)."""
    if joint.kind == "hinge":
        return point_at(bodies, joint.name), False
    if joint.kind == "guide":
        guide = bodies.mechanism.guide(joint.name)
        along = complex(*guide.unit) * np.exp(1j * bodies.turn[bodies.number(guide.on)])
        return complex(1j * along), True
    wheel = next(wheel for wheel in bodies.mechanism.rolling if wheel.id == joint.name)
    return contact_of(wheel, bodies), False


def point_at(bodies: Bodies, point: str) -> complex:
    """Place of a named point at one sample."""
    mechanism = bodies.mechanism
    if point in mechanism.frame.points:
        return complex(*mechanism.frame.coordinates[point])
    for name, guide in bodies.sliders.items():
        if guide.point == point:
            return complex(bodies.place[bodies.number(name)])
    owner = next(name for name, link in mechanism.links.items() if point in link.coordinates)
    return bodies.carried(bodies.number(owner), mechanism.links[owner].coordinates[point])


def contact_of(wheel: Rolling, bodies: Bodies) -> complex:
    """Where a wheel touches its track at one sample: the foot of its centre on it."""
    mechanism, on = bodies.mechanism, bodies.number(wheel.on)
    centre, track = point_at(bodies, wheel.centre), wheel.along
    if track.through is not None:
        along = complex(*track.unit) * np.exp(1j * bodies.turn[on])
        start = bodies.carried(on, track.through)
        return start + complex(((centre - start) * np.conj(along)).real * along)
    own = track.centre
    local = mechanism.points_of(wheel.on)[own] if isinstance(own, str) else own
    middle = bodies.carried(on, local or (0.0, 0.0))
    radius = track.radius or 0.0
    # a ring around its pin touches on the far side of the pin
    far = -1.0 if track.inside and wheel.radius > radius else 1.0
    return middle + far * radius * (centre - middle) / abs(centre - middle)


def rolling_pairs(mechanism: Mechanism, bodies: Named) -> Iterator[Pair]:
    """Pairs that roll on each other: wheels on their tracks, and geared links on their pitch circles."""
    for wheel in mechanism.rolling:
        yield ordered((bodies.number(wheel.link), bodies.number(wheel.on)))
    for gear in mechanism.gears:
        yield ordered((bodies.number(gear.links[0]), bodies.number(gear.links[1])))
