"""A planar linkage as a tree of bodies, and what is left over: pins and prismatic pairs that close its loops.

All bodies stand as they do initially and their axes are those of the world, so every coordinate of a joint counts
from the initial position. A guide without a link of its own gets a slider, a cylinder a barrel and a rod, a loop of
prismatic pairs a carriage.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeAlias

from centrode.dynamics.masses import masses_of
from centrode.dynamics.state import Centre
from centrode.kinematics.preparation import ready
from centrode.model.mechanism import FRAME, Mechanism
from centrode.structure.gearing import Straight

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.state import Mass
    from centrode.model.links import Rolling
    from centrode.model.mechanism import Drive, Guide

Place: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class Pair:
    """Two bodies that turn about a point, or slide along a direction.

    Attributes
    ----------
    name : of the joint in the model
    place : where the point is initially [m]
    direction : along which the second slides on the first; None for a hinge
    point : the hinge's name; None for a pair that slides
    """

    name: str
    first: str
    second: str
    place: Place
    direction: Place | None = None
    point: str | None = None


@dataclass
class Tree:
    """Bodies below each other, as they are reached from the frame.

    Attributes
    ----------
    joints : body -> the pair by which it hangs, and the body it hangs on
    closures : pairs that the tree leaves open
    """

    joints: dict[str, tuple[Pair, str]] = field(default_factory=dict)
    closures: list[Pair] = field(default_factory=list)

    def children(self, body: str) -> list[str]:
        """Bodies that hang on a body, in the order in which they were reached."""
        return [name for name, (_pair, parent) in self.joints.items() if parent == body]

    def slide(self, body: str, direction: Place) -> dict[str, float] | None:
        """The way of a body along a direction, as joints and their factors; None where a joint above it turns."""
        found: dict[str, float] = {}
        while body in self.joints:
            pair, parent = self.joints[body]
            if pair.direction is None:
                return None
            sign = 1.0 if pair.second == body else -1.0
            found[pair.name] = sign * (pair.direction[0] * direction[0] + pair.direction[1] * direction[1])
            body = parent
        return found

    def turn(self, body: str) -> dict[str, float]:
        """The angle turned by a body since the beginning, as joints and their factors."""
        found: dict[str, float] = {}
        while body in self.joints:
            pair, parent = self.joints[body]
            if pair.direction is None:
                found[pair.name] = 1.0
            body = parent
        return found


@dataclass(frozen=True)
class WheelBody:
    """A rolling wheel as a body of its own: what slides along its line, or the arm about the centre of its circle.

    Attributes
    ----------
    wheel, on, centre : the wheel, the body that it rolls on, the point that is its centre
    pair : by which the body hangs on `on`
    own : the body is not a link of the description
    ways : joints, and how fast their coordinates move the centre along the line against `on`, where they all slide
    share : turn of the wheel for a way of the body [rad/m], or for its turn, both against `on`
    """

    wheel: str
    on: str
    centre: str
    pair: Pair
    share: float
    own: bool = True
    ways: Mapping[str, float] | None = None


def tree_of(
    mechanism: Mechanism,
    places: Mapping[str, Place],
    directions: Mapping[str, Place],
    contacts: Sequence[WheelBody] = (),
    light: Collection[str] = (),
) -> Tree:
    """The tree; `places` of the points and `directions` of the guides are those of the initial position [m].

    What slides on a body is reached from it at once: loops then close in hinges. A loop of prismatic pairs alone closes
    in a carriage: a body that slides like the last of them, and is pinned where that one is, as none of them turns
    against another. Loops do not close at bodies that are `light` where it can be helped: constraints are as soft as
    the lightest body that they join.
    """
    pairs = _pairs(mechanism, places, directions, contacts)
    tree, waiting, known = Tree(), deque([FRAME]), {FRAME}
    used: list[Pair] = []

    def reach(body: str, choice: list[Pair]) -> None:
        for pair in choice:
            other = {pair.first: pair.second, pair.second: pair.first}.get(body)
            if other is not None and other not in known:
                tree.joints[other] = pair, body
                used.append(pair)
                known.add(other)
                waiting.append(other)
                reach(other, pairs if other in light else sliding)

    sliding = [pair for pair in pairs if pair.direction is not None]
    reach(FRAME, sliding)
    while waiting:
        reach(waiting.popleft(), pairs)
    for pair in _left_over(pairs, used):
        if pair.direction is None:
            tree.closures.append(pair)
            continue
        carriage = carriage_name(pair.name)
        slid = replace(pair, second=carriage)
        tree.joints[carriage] = slid, pair.first
        tree.closures.append(Pair(f"{pair.name} closes", carriage, pair.second, pair.place))
    return tree


def _left_over(pairs: list[Pair], used: list[Pair]) -> list[Pair]:
    """Pairs that the tree does not keep by itself: of the hinges at one point, as many as join what is still apart."""
    left = [pair for pair in pairs if pair.point is None and pair not in used]
    for point in dict.fromkeys(pair.point for pair in pairs if pair.point is not None):
        joined: dict[str, str] = {}

        def root(body: str, joined: dict[str, str] = joined) -> str:
            while body in joined:
                body = joined[body]
            return body

        here = [pair for pair in pairs if pair.point == point]
        for pair in sorted(here, key=lambda pair: pair not in used):
            first, second = root(pair.first), root(pair.second)
            if first != second:
                joined[first] = second
                if pair not in used:
                    left.append(pair)
    return left


def _pairs(
    mechanism: Mechanism,
    places: Mapping[str, Place],
    directions: Mapping[str, Place],
    contacts: Sequence[WheelBody],
) -> list[Pair]:
    """All pairs; those of driven links with the bodies that they are driven against come first."""
    members = _members(mechanism, contacts)
    found = [
        Pair(f"{first} {second} {point}", first, second, places[point], point=point)
        for point, bodies in members.items()
        for i, first in enumerate(bodies)
        for second in bodies[i + 1 :]
    ]
    for guide in mechanism.guides:
        second = guide.link or slider_name(guide.id)
        found.append(Pair(f"guide {guide.id}", guide.on, second, places[guide.point], directions[guide.id]))
    for drive in mechanism.drives:
        if drive.distance is not None:
            start, end = (places[point] for point in drive.distance)
            way = (end[0] - start[0], end[1] - start[1])
            length = (way[0] ** 2 + way[1] ** 2) ** 0.5
            barrel, rod = cylinder_names(drive.id)
            found.append(Pair(f"drive {drive.id}", barrel, rod, end, (way[0] / length, way[1] / length)))
    found += [contact.pair for contact in contacts if contact.own]
    driven = {frozenset((drive.link, drive.relative_to)) for drive in mechanism.drives if drive.link}
    return sorted(found, key=lambda pair: frozenset((pair.first, pair.second)) not in driven)


def _members(mechanism: Mechanism, contacts: Sequence[WheelBody]) -> dict[str, list[str]]:
    """Point -> the bodies that are hinged there; a link that a guide holds needs no other slider."""
    found: dict[str, list[str]] = {}
    for point in mechanism.frame.points:
        found.setdefault(point, []).append(FRAME)
    for name, link in mechanism.links.items():
        for point in link.coordinates:
            found.setdefault(point, []).append(name)
    for guide in mechanism.guides:
        if guide.link is None:
            found.setdefault(guide.point, []).append(slider_name(guide.id))
    for drive in mechanism.drives:
        for point, body in zip(drive.distance or (), cylinder_names(drive.id), strict=False):
            found.setdefault(point, []).append(body)
    for contact in contacts:
        if contact.own:
            found.setdefault(contact.centre, []).append(contact.pair.second)
    return {point: bodies for point, bodies in found.items() if len(bodies) > 1}


def slider_name(guide: str) -> str:
    """The body that slides along a guide without a link of its own."""
    return f"slider {guide}"


def carriage_name(pair: str) -> str:
    """The body that slides where a loop closes in a prismatic pair."""
    return f"carriage {pair}"


def cylinder_names(drive: str) -> tuple[str, str]:
    """Barrel and rod of a cylinder."""
    return f"barrel {drive}", f"rod {drive}"


def contact_name(wheel: str) -> str:
    """The body that keeps a rolling wheel at its track."""
    return f"track {wheel}"


def outline(places: list[Place]) -> list[tuple[Place, Place]]:
    """Lines between the points of a body, in their order and closed where there are more than two."""
    closed = [*places, places[0]] if len(places) > 2 else places
    return list(pairwise(closed))


# Numbers and plane vectors as the XML spells them.


def turn_vector(vector: Sequence[float], angle: float) -> Place:
    """A vector turned by an angle [rad]."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1]


def less(place: Place, origin: Place) -> Place:
    """A place as seen from an origin."""
    return place[0] - origin[0], place[1] - origin[1]


def number(value: float) -> str:
    """The shortest digits that read back as the same number."""
    return repr(float(value))


def numbers(values: Sequence[float]) -> str:
    """Several of them, apart by blanks."""
    return " ".join(number(value) for value in values)


# A linkage in its initial position, as a model takes it: places, speeds, masses, the tree of its bodies.

NOMINAL = 1e-3
"""Mass of a body that the description gives none, as a part of the greatest (of 1 kg where there is none)."""
THIN = 0.01
"""Radius of drawn links, as a part of the mechanism's size."""
STEPS = 4000
"""Steps of time in a turn of the drive, at least."""
LONGEST_STEP = 1e-3


class Pose:
    """The initial position of a linkage.

    Attributes
    ----------
    places, angles : of points [m] and links [rad]
    spins, slides : angular velocities of bodies, velocities of what slides
    tree : bodies below each other, and what closes their loops
    masses : of the links that have any; `least` and `nominal_inertia` are those of the others
    size : longer side of all places [m]
    pace, step : how fast the drives run [rad/s], and the step of time [s] that this asks for
    """

    def __init__(
        self,
        mechanism: Mechanism,
        motion: xarray.Dataset,
        nominal: float = NOMINAL,
        *,
        rolls: bool = False,
        free: bool = False,
    ) -> None:
        self.mechanism = mechanism
        first = motion.isel(sample=0)
        self.places: dict[str, Place] = {
            name: (float(x), float(y))
            for name, (x, y) in zip(first["point"].values.tolist(), first["position"].values, strict=True)
        }
        self.angles = dict(zip(first["link"].values.tolist(), first["angle"].values.tolist(), strict=True))
        self.angles[FRAME] = 0.0
        directions = {guide.id: self._direction(guide) for guide in mechanism.guides}
        self.spins, self.slides = speeds_of(mechanism, first)
        spread = [max(values) - min(values) for values in zip(*self.places.values(), strict=True)]
        self.size = max(spread)
        light = [slider_name(guide.id) for guide in mechanism.guides] if free else []
        self.tree: Tree = tree_of(mechanism, self.places, directions, light=light)
        self.contacts = self._contacts() if rolls else []
        if any(one.own for one in self.contacts):
            # with bodies of their own the tree is another one, and what slid may turn
            self.contacts = self._contacts(by_slides=False)
            own = [one for one in self.contacts if one.own]
            for contact in own:
                self._set_rates(contact)
            light += [contact.pair.second for contact in own]
            self.tree = tree_of(mechanism, self.places, directions, own, light)
        self.masses: dict[str, Mass] = {mass.link: mass for mass in masses_of(mechanism)}
        self.pace = max(pace_of(drive, self.size) for drive in mechanism.drives) or 1.0
        self.step = min(LONGEST_STEP, 2 * math.pi / self.pace / STEPS)

        self.greatest = max((float(mass.mass) for mass in self.masses.values()), default=1.0) or 1.0
        self.least = nominal * self.greatest

    @property
    def nominal_inertia(self) -> float:
        """Moment of inertia of a body that the description gives none."""
        return float(self.least * (0.1 * self.size) ** 2)

    def inertial(self, name: str, own: Place) -> tuple[float, float, Place]:
        """Mass [kg], moment of inertia [kg m^2] and centre of mass of a body, as seen from a place [m]."""
        known = self.masses.get(name)
        mass = max(float(known.mass), self.least) if known else self.least
        inertia = known.inertia if known is not None and not isinstance(known.inertia, tuple) else 0.0
        about = max(float(inertia), self.nominal_inertia)
        centre = (0.0, 0.0)
        if known is not None and isinstance(known.centre, Centre):
            way = turn_vector((float(known.centre.along), float(known.centre.across)), self.angles[name])
            base = self.places[known.centre.base]
            centre = less((base[0] + way[0], base[1] + way[1]), own)
        return mass, about, centre

    def driven_joints(self, drive: Drive) -> dict[str, float]:
        """The value of a drive since the beginning, as joints and their factors."""
        if drive.link is not None:
            return self.turns({drive.link: 1.0, drive.relative_to: -1.0})
        if drive.guide is None:
            return {f"drive {drive.id}": 1.0}
        return {f"guide {drive.guide}": 1.0}

    def _direction(self, guide: Guide) -> Place:
        return turn_vector(guide.unit, self.angles[guide.on])

    def _set_rates(self, contact: WheelBody) -> None:
        """Initial speeds of the body that keeps a wheel at its track."""
        turn = self.spins[contact.wheel] - self.spins[contact.on]
        body = contact.pair.second
        if contact.pair.direction is None:
            self.spins[body] = self.spins[contact.on] + turn / contact.share
        else:
            self.spins[body] = self.spins[contact.on]
            self.slides[contact.pair.name] = turn / contact.share

    def _contacts(self, *, by_slides: bool = True) -> list[WheelBody]:
        """Rolling wheels: on a line their centre slides, on a circle it turns about the circle's centre."""
        gearing = ready(self.mechanism).structure.dimensions.gearing
        found = []
        for wheel in self.mechanism.rolling:
            track, name, body = gearing.track[wheel.id], f"rolling {wheel.id}", contact_name(wheel.id)
            centre = self.places[wheel.centre]
            if isinstance(track, Straight):
                direction = turn_vector(_numbers(track.direction), self.angles[wheel.on])
                pair = Pair(name, wheel.on, body, centre, direction)
                share = -1.0 / float(gearing.radius[wheel.id])
                if by_slides and (ways := self._ways(wheel, direction)) is not None:
                    found.append(WheelBody(wheel.link, wheel.on, wheel.centre, pair, share, False, ways))
                    continue
            else:
                place = self._place_on(wheel.on, _numbers(track.centre))
                arm = self._arm(wheel, place)
                pair = Pair(name, wheel.on, arm or body, place, point=f"{name} centre")
                share = float(gearing.spin(wheel.id))
            own = pair.second == body
            found.append(WheelBody(wheel.link, wheel.on, wheel.centre, pair, share, own))
        return found

    def _ways(self, wheel: Rolling, direction: Place) -> dict[str, float] | None:
        """How slides move a wheel's centre along a line against its track; None where joints turn either."""
        hinge, parent = self.tree.joints[wheel.link]
        centre, track = (self.tree.slide(body, direction) for body in (parent, wheel.on))
        if hinge.point != wheel.centre or centre is None or track is None:
            return None
        names = {**centre, **track}
        return {name: centre.get(name, 0.0) - track.get(name, 0.0) for name in names}

    def _arm(self, wheel: Rolling, place: Place) -> str | None:
        """The link that leads a wheel's centre about that of its circle, if there is one."""
        links = self.mechanism.links
        on = self.mechanism.frame.points if wheel.on == FRAME else links[wheel.on].coordinates
        for name, link in links.items():
            if name != wheel.link and wheel.centre in link.coordinates:
                pivots = [point for point in link.coordinates if point in on and point != wheel.centre]
                if any(math.dist(self.places[point], place) <= 1e-12 * self.size for point in pivots):
                    return name
        return None

    def _place_on(self, body: str, own: Place) -> Place:
        """A place in the axes of a body, in those of the frame."""
        if body == FRAME:
            return own
        point, (x, y) = next(iter(self.mechanism.links[body].coordinates.items()))
        way = turn_vector(less(own, (float(x), float(y))), self.angles[body])
        return self.places[point][0] + way[0], self.places[point][1] + way[1]

    def turns(self, factors: Mapping[str, float]) -> dict[str, float]:
        """A sum of links' turns as joints and their factors."""
        found: dict[str, float] = {}
        for body, factor in factors.items():
            for joint, share in self.tree.turn(body).items():
                found[joint] = found.get(joint, 0.0) + factor * share
        return {joint: factor for joint, factor in found.items() if factor}

    def order(self, body: str) -> list[str]:
        """Bodies below one in the order of the document, which is that of MuJoCo's coordinates."""
        return [name for child in self.tree.children(body) for name in (child, *self.order(child))]

    def rate(self, name: str) -> float:
        """Initial speed of the joint by which a body hangs."""
        pair, parent = self.tree.joints[name]
        if pair.direction is None:
            return self.spins[name] - self.spins[parent]
        return self.slides[pair.name]


def _numbers(vector: Sequence[Any]) -> Place:
    return float(vector[0]), float(vector[1])


def pace_of(drive: Drive, size: float) -> float:
    """How fast a drive runs [rad/s]: an angle, a way in sizes of the mechanism, the cam of a law; 1 of others."""
    if drive.speed is not None:
        return abs(drive.speed) if drive.kind == "angle" else abs(drive.speed) / size
    if drive.table is not None:
        return 2.0 * math.pi / (drive.table[-1][0] - drive.table[0][0])
    return abs(drive.turning or 1.0)


def speeds_of(mechanism: Mechanism, first: xarray.Dataset) -> tuple[dict[str, float], dict[str, float]]:
    """Angular velocities of bodies and velocities of what slides, initially."""
    links, guides = first["link"].values.tolist(), first["guide"].values.tolist()
    spins = dict(zip(links, first["angular_velocity"].values.tolist(), strict=True)) | {FRAME: 0.0}
    along = dict(zip(guides, first["slide_velocity"].values.tolist(), strict=True))
    slides = {f"guide {guide}": speed for guide, speed in along.items()}
    spins |= {slider_name(guide.id): spins[guide.on] for guide in mechanism.guides}
    for drive in mechanism.drives:
        if drive.distance is None:
            continue
        start, end = (first.sel(point=point) for point in drive.distance)
        (x, y), (u, v) = (
            end["position"].values - start["position"].values,
            end["velocity"].values - start["velocity"].values,
        )
        length = math.hypot(x, y)
        slides[f"drive {drive.id}"] = (x * u + y * v) / length
        spins |= dict.fromkeys(cylinder_names(drive.id), (x * v - y * u) / length**2)
    return spins, slides
