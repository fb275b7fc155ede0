"""A planar linkage as a tree of bodies, and what is left over: pins and prismatic pairs that close its loops.

All bodies stand as they do initially and their axes are those of the world, so every coordinate of a joint counts
from the initial position. A guide without a link of its own gets a slider, a cylinder a barrel and a rod, a loop of
prismatic pairs a carriage.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias
from xml.etree import ElementTree as ET

from centrode.dynamics.masses import masses_of
from centrode.dynamics.state import Centre
from centrode.errors import NotComputedYet
from centrode.locale import _
from centrode.model.mechanism import FRAME, Mechanism

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.state import Mass
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

    def turn(self, body: str) -> dict[str, float]:
        """The angle turned by a body since the beginning, as joints and their factors."""
        found: dict[str, float] = {}
        while body in self.joints:
            pair, parent = self.joints[body]
            if pair.direction is None:
                found[pair.name] = 1.0
            body = parent
        return found


def tree_of(mechanism: Mechanism, places: Mapping[str, Place], directions: Mapping[str, Place]) -> Tree:
    """The tree; `places` of the points and `directions` of the guides are those of the initial position [m].

    What slides on a body is reached from it at once: loops then close in hinges. A loop of prismatic pairs alone closes
    in a carriage: a body that slides like the last of them, and is pinned where that one is, as none of them turns
    against another.
    """
    pairs = _pairs(mechanism, places, directions)
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
                reach(other, sliding)

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


def _pairs(mechanism: Mechanism, places: Mapping[str, Place], directions: Mapping[str, Place]) -> list[Pair]:
    """All pairs; those of driven links with the bodies that they are driven against come first."""
    members = _members(mechanism)
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
    driven = {frozenset((drive.link, drive.relative_to)) for drive in mechanism.drives if drive.link}
    return sorted(found, key=lambda pair: frozenset((pair.first, pair.second)) not in driven)


def _members(mechanism: Mechanism) -> dict[str, list[str]]:
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


# A linkage in its initial position, as a model of MuJoCo takes it: places, speeds, masses, the tree of its
# bodies.

NOMINAL = 1e-3
"""Mass of a body that the description gives none, as a part of the greatest (of 1 kg where there is none)."""
LIGHTEST = 1e-15
"""What MuJoCo divides by at the least."""
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

    def __init__(self, mechanism: Mechanism, motion: xarray.Dataset) -> None:
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
        self.tree: Tree = tree_of(mechanism, self.places, directions)
        self.masses: dict[str, Mass] = {mass.link: mass for mass in masses_of(mechanism)}
        spread = [max(values) - min(values) for values in zip(*self.places.values(), strict=True)]
        self.size = max(spread)
        self.pace = max(pace_of(drive, self.size) for drive in mechanism.drives) or 1.0
        self.step = min(LONGEST_STEP, 2 * math.pi / self.pace / STEPS)

        self.greatest = max((float(mass.mass) for mass in self.masses.values()), default=1.0) or 1.0
        self.least = NOMINAL * self.greatest
        if min(self.least, self.nominal_inertia) < LIGHTEST:
            what = _("MuJoCo has no bodies with a mass or moment of inertia below {least} kg or kg·m²")
            raise NotComputedYet(
                "links", what.format(least=LIGHTEST), _("export it enlarged, or in other units")
            )

    @property
    def nominal_inertia(self) -> float:
        """Moment of inertia of a body that the description gives none."""
        return float(self.least * (0.1 * self.size) ** 2)

    def _direction(self, guide: Guide) -> Place:
        return turn_vector(guide.unit, self.angles[guide.on])

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


# Bodies of the model: joints, masses, what is drawn of them, and the bodies that hang on them.

THIN = 0.01
"""Radius of drawn links, as a part of the mechanism's size."""


def add_body(pose: Pose, parent: ET.Element, name: str, origin: Place) -> None:
    """A body with its joint, its mass and what is drawn of it, and the bodies that hang on it."""
    pair, _on = pose.tree.joints[name]
    own = pair.place
    body = ET.SubElement(parent, "body", name=name, pos=numbers((*less(own, origin), 0.0)))
    if pair.direction is None:
        ET.SubElement(body, "joint", name=pair.name, type="hinge", axis="0 0 1")
    else:
        sign = 1.0 if pair.second == name else -1.0
        axis = (sign * pair.direction[0], sign * pair.direction[1], 0.0)
        ET.SubElement(body, "joint", name=pair.name, type="slide", axis=numbers(axis))
    _inertial(pose, body, name, own)
    _shape(pose, body, name, own)
    for child in pose.tree.children(name):
        add_body(pose, body, child, own)


def _inertial(pose: Pose, body: ET.Element, name: str, own: Place) -> None:
    known = pose.masses.get(name)
    mass = max(float(known.mass), pose.least) if known else pose.least
    inertia = known.inertia if known is not None and not isinstance(known.inertia, tuple) else 0.0
    about = max(float(inertia), pose.nominal_inertia)
    centre = (0.0, 0.0)
    if known is not None and isinstance(known.centre, Centre):
        way = turn_vector((float(known.centre.along), float(known.centre.across)), pose.angles[name])
        base = pose.places[known.centre.base]
        centre = less((base[0] + way[0], base[1] + way[1]), own)
    # a flat body: MuJoCo wants moments that some body in space can have
    ET.SubElement(body, "inertial", pos=numbers((*centre, 0.0)), mass=number(mass),
                  diaginertia=numbers((0.5 * about, 0.5 * about, about)))  # fmt: skip


def _shape(pose: Pose, body: ET.Element, name: str, own: Place) -> None:
    """Lines between the points of a link, a box for a slider, and a site for each point."""
    if name not in pose.mechanism.links:
        size = 3.0 * THIN * pose.size
        ET.SubElement(body, "geom", type="box", size=numbers((size, 0.6 * size, 0.6 * size)))
        return
    points = list(pose.mechanism.links[name].coordinates)
    for start, end in outline([less(pose.places[point], own) for point in points]):
        if math.dist(start, end) > 0.0:
            ET.SubElement(body, "geom", type="capsule", size=number(THIN * pose.size),
                          fromto=numbers((*start, 0.0, *end, 0.0)))  # fmt: skip
    for point in points:
        at = numbers((*less(pose.places[point], own), 0.0))
        ET.SubElement(body, "site", name=f"{name}.{point}", pos=at)


# What joins the bodies of the model beside their tree: constraints of loops and gears, actuators of the
# drives.

REACHED = 100
"""Steps of time in which a drive's speed is reached: faster, and it would fight the constraints."""
FOLLOWED = 10
"""Half of the steps of time by which a drive lags behind the value of its law."""
ROTOR = 0.1
"""Inertia of such a drive itself, as a part of what its gains are for: without, it would fight the constraints."""


def add_constraints(pose: Pose, root: ET.Element) -> None:
    """Loops and gears as equality constraints."""
    gears = pose.mechanism.gears
    if not pose.tree.closures and not gears:
        return
    if gears:
        tendons = ET.SubElement(root, "tendon")
        for gear in gears:
            first, second = gear.links
            _fixed_tendon(tendons, f"gear {gear.id}", pose.turns({second: 1.0, gear.carrier: gear.ratio - 1.0,
                                                            first: -gear.ratio}))  # fmt: skip
    equality = ET.SubElement(root, "equality")
    for pair in pose.tree.closures:
        _closure(pose, equality, pair)
    for gear in gears:
        ET.SubElement(equality, "tendon", name=f"gear {gear.id}", tendon1=f"gear {gear.id}")


def _closure(pose: Pose, equality: ET.Element, pair: Pair) -> None:
    first, second = ("world" if body == FRAME else body for body in (pair.first, pair.second))
    # the anchor is told in the axes of the first body
    body, other = (second, first) if first == "world" else (first, second)
    own = pose.tree.joints[body][0].place
    ET.SubElement(equality, "connect", name=pair.name, body1=body, body2=other,
                  anchor=numbers((*less(pair.place, own), 0.0)))  # fmt: skip


def add_drives(pose: Pose, root: ET.Element) -> None:
    """An actuator for each drive, and the key frame that turns them on."""
    actuators: list[tuple[str, dict[str, str]]] = []
    tendons = root.find("tendon")
    for drive in pose.mechanism.drives:
        joints = _joints(pose, drive)
        if len(joints) == 1 and next(iter(joints.values())) == 1.0:
            actuators.append((f"drive {drive.id}", {"joint": next(iter(joints))}))
            continue
        if tendons is None:
            tendons = ET.SubElement(root, "tendon")
        _fixed_tendon(tendons, f"drive {drive.id}", joints)
        actuators.append((f"drive {drive.id}", {"tendon": f"drive {drive.id}"}))
    if not actuators:
        return
    parent = ET.SubElement(root, "actuator")
    for (name, what), drive in zip(actuators, pose.mechanism.drives, strict=True):
        _actuator(pose, root, parent, drive, {"name": name} | what)
    controls = [drive.speed or 0.0 for drive in pose.mechanism.drives]
    frames = ET.SubElement(root, "keyframe")
    rates = [pose.rate(name) for name in pose.order(FRAME)]
    ET.SubElement(frames, "key", name="initial", ctrl=numbers(controls), qvel=numbers(rates))


def _actuator(
    pose: Pose, root: ET.Element, parent: ET.Element, drive: Drive, said: Mapping[str, str]
) -> None:
    """A drive that keeps its speed, or follows the value of its law."""
    heavy = sum(float(mass.mass) for mass in pose.masses.values()) or NOMINAL * len(pose.tree.joints)
    scale = heavy * (pose.size**2 if drive.kind == "angle" else 1.0)
    if drive.speed is not None:
        ET.SubElement(parent, "velocity", {"kv": number(scale / (REACHED * pose.step)), **said})
        return
    pause = FOLLOWED * pose.step
    gains = {"kp": number(scale / pause**2), "kv": number(2.0 * scale / pause)}
    ET.SubElement(parent, "position", {**gains, **said})
    for kind, place in (("joint", ".//body/joint"), ("tendon", "./tendon/fixed")):
        for one in root.iterfind(place):
            if one.get("name") == said.get(kind):
                one.set("armature", number(ROTOR * scale))


def _joints(pose: Pose, drive: Drive) -> dict[str, float]:
    """The value of a drive since the beginning, as joints and their factors."""
    if drive.link is not None:
        return pose.turns({drive.link: 1.0, drive.relative_to: -1.0})
    if drive.guide is None:
        return {f"drive {drive.id}": 1.0}
    return {f"guide {drive.guide}": 1.0}


def _fixed_tendon(tendons: ET.Element, name: str, joints: Mapping[str, float]) -> None:
    """A tendon whose length is a sum of coordinates."""
    tendon = ET.SubElement(tendons, "fixed", name=name)
    for joint, factor in joints.items():
        ET.SubElement(tendon, "joint", joint=joint, coef=number(factor))


# The model as XML: bodies below each other, constraints of the loops and gears, actuators of the drives.

HARD = "0.9999 0.9999 0.001"
"""How nearly rigid constraints are (MuJoCo's solimp)."""


def mjcf_text(mechanism: Mechanism, motion: xarray.Dataset) -> str:
    """A linkage as a model of MuJoCo (MJCF), loops closed by equality constraints at the initial position.

    Parameters
    ----------
    mechanism : Mechanism
        In the plane, without wheels that roll.
    motion : Dataset
        Its motion, whose first sample is the initial position.

    Returns
    -------
    str
        XML. Lengths in metres; every coordinate of a joint counts from the initial position. Links have the masses of
        the description; loads, springs and friction are not in the model. A drive is an actuator of its joint with
        the key frame's `ctrl` as its speed (a law's value follows `ctrl`, from the initial one).

    Raises
    ------
    NotComputedYet
        Spherical linkages, wheels that roll, and bodies too light for MuJoCo.
    """
    if mechanism.space == "sphere":
        raise NotComputedYet(
            "space", _("models of MuJoCo are made of planar linkages"), _("choose a planar linkage")
        )
    if mechanism.rolling:
        what = _("models of MuJoCo have no wheels that roll")
        raise NotComputedYet(f"[[rolling]] {mechanism.rolling[0].id}", what, _("remove it"))
    return _document(Pose(mechanism, motion))


def _document(pose: Pose) -> str:
    """The whole document."""
    root = ET.Element("mujoco", model=pose.mechanism.title or "linkage")
    ET.SubElement(root, "compiler", angle="radian", autolimits="true")
    gravity = pose.mechanism.gravity or (0.0, 0.0)
    ET.SubElement(root, "option", gravity=numbers((*gravity, 0.0)), timestep=number(pose.step),
                  integrator="implicitfast", tolerance="1e-12", iterations="200")  # fmt: skip
    solref = f"{number(3 * pose.step)} 1"
    defaults = ET.SubElement(root, "default")
    ET.SubElement(defaults, "equality", solref=solref, solimp=HARD)
    ET.SubElement(defaults, "geom", contype="0", conaffinity="0", mass="0", rgba="0.3 0.45 0.6 1")
    ET.SubElement(defaults, "site", size=number(1.5 * THIN * pose.size))
    world = ET.SubElement(root, "worldbody")
    for point in pose.mechanism.frame.points:
        ET.SubElement(world, "site", name=f"{FRAME}.{point}", pos=numbers((*pose.places[point], 0.0)))
    for body in pose.tree.children(FRAME):
        add_body(pose, world, body, (0.0, 0.0))
    add_constraints(pose, root)
    add_drives(pose, root)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"
