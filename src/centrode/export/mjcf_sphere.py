"""A spherical linkage as a model of MuJoCo: all bodies stand at the centre, and all hinges pass through it.

As in the plane the axes of the bodies are initially those of the world, so every coordinate of a joint counts from the
initial position. A guide has a slider, which turns about the pole of its circle and is hinged to the point. A loop
closes where a point on the axis of a hinge is the same place of both bodies.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, TypeAlias
from xml.etree import ElementTree as ET

import numpy as np
import numpy.typing as npt

from centrode.analysis.instant_centres.bodies import pole_of, turning_bodies_of
from centrode.dynamics.load_coordinates import Spin, turning_of
from centrode.dynamics.masses import masses_of
from centrode.dynamics.state import About, Radial
from centrode.errors import NotComputedYet
from centrode.export.body_trees import (
    LONGEST_STEP,
    NOMINAL,
    STEPS,
    THIN,
    Pair,
    Tree,
    left_over,
    number,
    numbers,
    outline,
    pace_of,
    slider_name,
    spanning_tree,
)
from centrode.export.mjcf_loads import (
    WORLD_SITE,
    ActuatorLoad,
    ModelLoads,
    TendonLoad,
    fixed_tendon,
    held_loads,
    load_between_points,
    resting_length,
)
from centrode.locale import _
from centrode.model.loads import (
    AnyLoad,
    HingeDamper,
    HingeFriction,
    HingeSpring,
    PointDamper,
    PointForce,
    PointSpring,
    Torque,
    TurningLoad,
)
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.values import unit_vector

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.state import Mass
    from centrode.model.mechanism import Drive

Array: TypeAlias = npt.NDArray[np.float64]
Vector: TypeAlias = tuple[float, float, float]

PARALLEL = 1e-9
"""Sine of the angle below which two axes are one."""
ROUNDED = 1e-12
"""Part of a tensor's trace that is added to its moments."""
PIN = (0.94, 1.06)
"""Where a pin through a hinge begins and ends, in the radius."""
CHORDS = 8
"""Straight pieces that an arc is drawn with."""


class SpherePose:
    """A spherical linkage at its initial position, and its tree of bodies.

    Attributes
    ----------
    mechanism : on the sphere
    size : radius of the sphere [m]
    places : point -> direction towards it
    axes : body -> its own axes, as columns, in those of the frame
    spins : body -> its angular velocity [rad/s]
    tree : the bodies below each other
    masses : link -> its mass
    pace, step : how fast the drives run [rad/s], and the step of time [s]
    greatest, least : greatest mass of the description, and mass of what has none [kg]
    """

    def __init__(self, mechanism: Mechanism, motion: xarray.Dataset, nominal: float = NOMINAL) -> None:
        self.mechanism = mechanism
        self.size = float(mechanism.sphere_radius)
        bodies = turning_bodies_of(motion.isel(sample=[0]))
        self.places: dict[str, Vector] = {name: _vector(at[0]) for name, at in bodies.points.items()}
        names = [FRAME, *mechanism.link_names, *(slider_name(guide.id) for guide in mechanism.guides)]
        self.axes: dict[str, Array] = dict(zip(names, bodies.axes[0], strict=True))
        self.spins: dict[str, Array] = dict(zip(names, bodies.speed[0], strict=True))
        self.tree: Tree = _tree_of(list(_hinges(self)))
        self.masses: dict[str, Mass] = {mass.link: mass for mass in masses_of(mechanism)}
        self.pace = max(pace_of(drive, 1.0) for drive in mechanism.drives) or 1.0
        self.step = min(LONGEST_STEP, 2 * math.pi / self.pace / STEPS)
        self.greatest = max((float(mass.mass) for mass in self.masses.values()), default=1.0) or 1.0
        self.least = nominal * self.greatest

    def at(self, point: str) -> Vector:
        """Initial place of a point [m]."""
        return _vector(self.size * np.array(self.places[point]))

    @property
    def nominal_inertia(self) -> float:
        """Moment of inertia of a body that the description gives none: its mass rests at the centre."""
        return float(self.least * self.size**2)

    def inertial(self, name: str) -> tuple[float, Vector, Array]:
        """Mass [kg], centre of mass [m] and tensor about it [kg m^2] of a body, in the axes of the world."""
        known, nominal = self.masses.get(name), self.nominal_inertia
        if known is None:
            return self.least, (0.0, 0.0, 0.0), nominal * np.eye(3)
        axes, tensor = self.axes[name], np.zeros((3, 3))
        assert isinstance(known.centre, Radial) and isinstance(known.inertia, tuple)
        for part in known.inertia:
            direction = axes @ np.array(part.direction, dtype=np.float64)
            along = np.outer(direction, direction)
            if isinstance(part, About):
                # a ring, of which the description knows one moment: a thin disc about an axis that stands still
                self._check_ring(name, direction)
                tensor += 0.5 * float(part.moment) * (np.eye(3) + along)
            else:
                tensor += float(part.moment) * (np.eye(3) - along)
        # of a thin disc the greatest moment is the sum of the others, which MuJoCo's rounding may break
        tensor += ROUNDED * float(np.trace(tensor)) * np.eye(3)
        if float(np.linalg.eigvalsh(tensor)[0]) < nominal:
            tensor += nominal * np.eye(3)
        centre = float(known.centre.distance) * (axes @ np.array(known.centre.direction, dtype=np.float64))
        return max(float(known.mass), self.least), _vector(centre), tensor

    def _check_ring(self, name: str, direction: Array) -> None:
        fixed = self.mechanism.frame.points
        shafts = [self.places[point] for point in self.mechanism.points_of(name) if point in fixed]
        if any(float(np.linalg.norm(np.cross(direction, shaft))) <= PARALLEL for shaft in shafts):
            return
        what = _("the moving link {link} is a ring and a point mass, which no body of MuJoCo is").format(
            link=name
        )
        raise NotComputedYet(f"[links.{name}] model", what, _("give its inertia as a tensor, without model"))

    def turn_about(self, axis: str | Sequence[float], link: str, base: str) -> dict[str, float] | None:
        """The turn of a link against another about an axis, as joints and their factors.

        None where a joint between the two turns about another axis: it then is no sum of coordinates.
        """
        at = self.places[axis] if isinstance(axis, str) else _vector(np.array(axis) / np.linalg.norm(axis))
        found: dict[str, float] = {}
        for body, factor in ((link, 1.0), (base, -1.0)):
            while body in self.tree.joints:
                pair, parent = self.tree.joints[body]
                found[body] = found.get(body, 0.0) + factor
                body = parent
        turned = {}
        for body in [body for body, factor in found.items() if factor]:
            pair, _parent = self.tree.joints[body]
            if float(np.linalg.norm(np.cross(at, _axis(pair)))) > PARALLEL:
                return None
            turned[pair.name] = found[body] * math.copysign(1.0, float(np.dot(at, _axis(pair))))
        return turned

    def driven_joints(self, drive: Drive) -> dict[str, float]:
        """The value of a drive since the beginning, as joints and their factors."""
        if drive.guide is not None:
            (guide,) = (x for x in self.mechanism.guides if x.id == drive.guide)
            # displacements are arcs of a circle of the radius sin(arc)
            hung, _parent = self.tree.joints[slider_name(guide.id)]
            sense = 1.0 if hung.name == f"guide {guide.id}" else -1.0
            return {f"guide {guide.id}": sense * math.sin(guide.arc)}
        assert drive.link is not None
        spin = _shared_point(self.mechanism, drive.link, drive.relative_to)
        joints = self.turn_about(spin, drive.link, drive.relative_to)
        assert joints is not None  # the tree keeps hinges of drives before all others
        return joints

    def order(self, body: str) -> list[str]:
        """Bodies below one in the order of the document, which is that of MuJoCo's coordinates."""
        return [name for child in self.tree.children(body) for name in (child, *self.order(child))]

    def rate(self, name: str) -> float:
        """Initial speed of the joint by which a body hangs."""
        pair, parent = self.tree.joints[name]
        return float(np.dot(self.spins[name] - self.spins[parent], _axis(pair)))


def _vector(values: Array) -> Vector:
    x, y, z = (float(part) for part in values)
    return x, y, z


def _axis(pair: Pair) -> Vector:
    assert pair.axis is not None
    return pair.axis


def _shared_point(mechanism: Mechanism, link: str, other: str) -> str:
    """The hinge of two links: the first point of the link where they share more."""
    points = mechanism.points_of(other)
    return next(point for point in mechanism.points_of(link) if point in points)


def _hinges(pose: SpherePose) -> Iterator[Pair]:
    """All hinges, those that the tree is to keep first."""
    mechanism, centre = pose.mechanism, (0.0, 0.0)
    members: dict[str, list[str]] = {}
    for body in (FRAME, *mechanism.link_names):
        for point in mechanism.points_of(body):
            members.setdefault(point, []).append(body)
    found: list[Pair] = []
    for guide in mechanism.guides:
        slider = slider_name(guide.id)
        members[guide.point].append(slider)
        pole = pose.axes[guide.on] @ np.array(unit_vector(pole_of(mechanism, guide)))
        found.append(
            Pair(f"guide {guide.id}", guide.on, slider, centre, point=f"pole {guide.id}", axis=_vector(pole))
        )
    for point, bodies in members.items():
        found += [
            Pair(f"{one} {other} {point}", one, other, centre, point=point, axis=pose.places[point])
            for one, other in combinations(bodies, 2)
        ]
    ranks = _ranks(mechanism)
    yield from sorted(found, key=lambda pair: ranks.get(frozenset((pair.first, pair.second)), len(ranks)))


def _ranks(mechanism: Mechanism) -> dict[frozenset[str], int]:
    """Two bodies -> how much the tree has to keep a hinge of theirs: of drives most, then of gears and of loads."""
    told = [(drive.link, drive.relative_to) for drive in mechanism.drives if drive.link is not None]
    told += [(link, gear.carrier) for gear in mechanism.gears for link in gear.links]
    for guide in mechanism.guides:
        # constraints are as soft as the lightest body that they join: loops do not close at sliders
        told += [(body, slider_name(guide.id)) for body in (guide.on, *mechanism.link_names)]
    turned = (HingeSpring, HingeDamper, HingeFriction, Torque)
    told += [(load.link, load.relative_to) for load in mechanism.loads if isinstance(load, turned)]
    found: dict[frozenset[str], int] = {}
    for rank, bodies in enumerate(told):
        found.setdefault(frozenset(bodies), rank)
    return found


def _tree_of(hinges: list[Pair]) -> Tree:
    """The tree that keeps the first hinges rather than the later."""
    joined: dict[str, str] = {}

    def root(body: str) -> str:
        while body in joined:
            body = joined[body]
        return body

    kept = []
    for pair in hinges:
        first, second = root(pair.first), root(pair.second)
        if first != second:
            joined[first] = second
            kept.append(pair)
    tree = spanning_tree(kept)
    tree.closures = left_over(hinges, kept)
    return tree


# Bodies, and the constraints that close their loops.


def add_turning_body(pose: SpherePose, parent: ET.Element, name: str) -> None:
    """A body at the centre with its joint, its mass and what is drawn of it, and the bodies that hang on it."""
    pair, _on = pose.tree.joints[name]
    body = ET.SubElement(parent, "body", name=name)
    ET.SubElement(body, "joint", name=pair.name, type="hinge", axis=numbers(_axis(pair)))
    mass, centre, tensor = pose.inertial(name)
    products = [tensor[k, m] for k, m in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    ET.SubElement(body, "inertial", pos=numbers(centre), mass=number(mass),
                  fullinertia=numbers([float(x) for x in products]))  # fmt: skip
    if name in pose.mechanism.links:
        _draw_arcs(pose, body, name)
    for closure in pose.tree.closures:
        if name in (closure.first, closure.second):
            # MuJoCo scales a constraint by how its body's centre of mass gives way, which is not at all on an axis
            ET.SubElement(body, "body", name=_pin_name(closure, name), pos=numbers(_pin_place(pose, closure)))
    for child in pose.tree.children(name):
        add_turning_body(pose, body, child)


def _pin_name(closure: Pair, body: str) -> str:
    return f"{closure.name} on {body}"


def _pin_place(pose: SpherePose, closure: Pair) -> Vector:
    return _vector(pose.size * np.array(_axis(closure)))


def _draw_arcs(pose: SpherePose, body: ET.Element, name: str) -> None:
    """Chords of the arcs between the points of a link, pins through these, and a site for each."""
    points = list(pose.mechanism.points_of(name))
    for one, other in outline(points):
        first, last = (np.array(pose.places[point]) for point in (one, other))
        shares = [(1.0 - k / CHORDS) * first + k / CHORDS * last for k in range(CHORDS + 1)]
        sizes = [float(np.linalg.norm(place)) for place in shares]
        if min(sizes) < PARALLEL or float(np.linalg.norm(first - last)) < PARALLEL:
            continue  # points that coincide, or lie opposite
        ends = [pose.size * place / size for place, size in zip(shares, sizes, strict=True)]
        for start, end in pairwise(ends):
            ET.SubElement(body, "geom", type="capsule", size=number(THIN * pose.size),
                          fromto=numbers([float(x) for x in (*start, *end)]))  # fmt: skip
    for point in points:
        ends = [share * np.array(pose.at(point)) for share in PIN]
        ET.SubElement(body, "geom", type="capsule", size=number(THIN * pose.size),
                      fromto=numbers([float(x) for end in ends for x in end]))  # fmt: skip
        ET.SubElement(body, "site", name=f"{name}.{point}", pos=numbers(pose.at(point)))


def add_turning_constraints(pose: SpherePose, root: ET.Element) -> None:
    """Loops and bevel gears as equality constraints."""
    gears = {f"gear {gear.id}": gear for gear in pose.mechanism.gears}
    for name, gear in gears.items():
        first, second = gear.links
        joints: dict[str, float] = {}
        for link, factor in ((second, 1.0), (first, -gear.ratio)):
            shaft = _shared_point(pose.mechanism, link, gear.carrier)
            turned = pose.turn_about(shaft, link, gear.carrier)
            if turned is None:
                what = _("the turn of {link} against {carrier} is no sum of joints of the model")
                raise NotComputedYet(
                    f"[[gears]] {gear.id}",
                    what.format(link=link, carrier=gear.carrier),
                    _("let the carrier be hinged to both wheels"),
                )
            for joint, share in turned.items():
                joints[joint] = joints.get(joint, 0.0) + factor * share
        fixed_tendon(root, name, joints)
    if not pose.tree.closures and not gears:
        return
    equality = ET.SubElement(root, "equality")
    for pair in pose.tree.closures:
        names = [_pin_name(pair, body) for body in (pair.first, pair.second) if body != FRAME]
        ET.SubElement(equality, "connect", name=pair.name, body1=names[0], body2=[*names, "world"][1],
                      anchor="0 0 0")  # fmt: skip
    for name in gears:
        ET.SubElement(equality, "tendon", name=name, tendon1=name)


# Loads: about hinges as sums of joints, in points as in space.


def turning_loads(pose: SpherePose, motion: xarray.Dataset) -> ModelLoads:
    """The loads of a description as a model of MuJoCo holds them."""
    return held_loads(pose.mechanism, lambda name, load: _turning_load(pose, motion, name, load))


def _turning_load(
    pose: SpherePose, motion: xarray.Dataset, name: str, load: AnyLoad
) -> TendonLoad | ActuatorLoad | None:
    match load:
        case PointSpring(points=points) | PointDamper(points=points):
            return load_between_points(name, load, _sites(pose, points))
        case PointForce(point=point, vector=(float(x), float(y), float(z)), axes="frame", while_moving=None):
            gear = numbers((x, y, z, 0.0, 0.0, 0.0))
            return ActuatorLoad(name, {"site": _sites(pose, (point,))[0], "refsite": WORLD_SITE, "gear": gear},
                                {}, 1.0)  # fmt: skip
        case HingeSpring(stiffness=stiffness, free_angle=free):
            turn = _spin_of(pose, load, name, measured=True)
            joints = _joints_of(pose, turn)
            if joints is None or turn.joint is None:
                return None
            angle = float(motion["joint_angle"].sel(joint=turn.joint).values[0])
            rest = (free or 0.0) - turn.sense * angle
            return TendonLoad(
                name, (), joints, {"stiffness": number(stiffness), "springlength": resting_length(rest)}
            )
        case HingeDamper(damping=viscous):
            joints = _joints_of(pose, _spin_of(pose, load, name, measured=False))
            return None if joints is None else TendonLoad(name, (), joints, {"damping": number(viscous)})
        case HingeFriction(value=None, viscous=float(viscous), quadratic=None):
            joints = _joints_of(pose, _spin_of(pose, load, name, measured=False))
            return None if joints is None else TendonLoad(name, (), joints, {"damping": number(viscous)})
        case Torque(value=float(value), table=None):
            joints = _joints_of(pose, _spin_of(pose, load, name, measured=False))
            return None if joints is None else ActuatorLoad(name, {}, joints, value)
        case _:
            return None


def _spin_of(pose: SpherePose, load: TurningLoad, name: str, *, measured: bool) -> Spin:
    turn = turning_of(pose.mechanism, load, name, measured)
    assert isinstance(turn, Spin), "links on the sphere turn about axes"
    return turn


def _joints_of(pose: SpherePose, turn: Spin) -> Mapping[str, float] | None:
    return pose.turn_about(turn.axis, turn.link, turn.base)


def _sites(pose: SpherePose, points: Sequence[str]) -> tuple[str, ...]:
    """Sites of points, each on a body that has it."""
    bodies = (FRAME, *pose.mechanism.link_names)
    return tuple(
        f"{next(body for body in bodies if point in pose.mechanism.points_of(body))}.{point}"
        for point in points
    )
