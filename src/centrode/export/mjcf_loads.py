"""Loads in a model of MuJoCo: springs and dampers as tendons, constant forces and moments as actuators."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias, assert_never
from xml.etree import ElementTree as ET

from centrode.export.body_trees import Pose, number, numbers, turn_vector
from centrode.locale import _
from centrode.model.loads import (
    AnyLoad,
    BearingFriction,
    GuideForce,
    GuideFriction,
    HingeDamper,
    HingeFriction,
    HingeSpring,
    LinkWeight,
    PointDamper,
    PointForce,
    PointSpring,
    PointWeight,
    SliderFriction,
    Torque,
    numbered_names,
)
from centrode.model.mechanism import FRAME, Mechanism

WORLD_SITE = "axes of the frame"
"""The site in whose axes constant forces act."""


@dataclass(frozen=True)
class TendonLoad:
    """A spring or a damper: along the line between two sites, or along a sum of coordinates of joints."""

    name: str
    sites: tuple[str, ...]
    joints: Mapping[str, float]
    properties: Mapping[str, str]


@dataclass(frozen=True)
class ActuatorLoad:
    """A constant force or moment: an actuator whose control is the amount."""

    name: str
    attributes: Mapping[str, str]
    joints: Mapping[str, float]
    amount: float


@dataclass(frozen=True)
class OwnWeight:
    """A link whose weight is its own: what is added to its mass times gravity, at a site in its centre of mass."""

    link: str
    force: ActuatorLoad | None


HeldLoad: TypeAlias = TendonLoad | ActuatorLoad | OwnWeight


@dataclass(frozen=True)
class ModelLoads:
    """Loads of a model, and the labels of those that it does not hold, with why."""

    tendons: tuple[TendonLoad, ...]
    actuators: tuple[ActuatorLoad, ...]
    weights: tuple[OwnWeight, ...]
    omitted: Mapping[str, str]


def labelled_loads(mechanism: Mechanism) -> Iterator[tuple[str, AnyLoad]]:
    """Loads with labels that are all different."""
    labels = numbered_names([load.label for load in mechanism.loads])
    return zip(labels, mechanism.loads, strict=True)


def model_loads(pose: Pose) -> ModelLoads:
    """The loads of a description as a model of MuJoCo holds them."""
    return held_loads(pose.mechanism, partial(_model_load, pose))


def held_loads(mechanism: Mechanism, held: Callable[[str, AnyLoad], HeldLoad | None]) -> ModelLoads:
    """What a function makes of each load by its name in the model: of those that it leaves out, the labels."""
    found = {label: held(f"load {label}", load) for label, load in labelled_loads(mechanism)}
    return ModelLoads(
        tuple(x for x in found.values() if isinstance(x, TendonLoad)),
        tuple(
            force
            for x in found.values()
            if (force := x.force if isinstance(x, OwnWeight) else x) is not None
            and isinstance(force, ActuatorLoad)
        ),
        tuple(x for x in found.values() if isinstance(x, OwnWeight)),
        {label: reason_left_out(load) for label, load in labelled_loads(mechanism) if found[label] is None},
    )


def reason_left_out(load: AnyLoad) -> str:
    """Why a model of MuJoCo does not hold a load: it has numbers, springs and dampers, and no functions."""
    given = {name: value for name, value in load if value is not None}
    friction = isinstance(load, HingeFriction | GuideFriction | BearingFriction | SliderFriction)
    amounts = [x for name in ("value", "vector") for x in _all_of(given.get(name))]
    if "table" in given:
        return _("a table")
    if any(isinstance(amount, str) for amount in amounts):
        return _("a formula")
    if friction:
        return _("dry or quadratic friction")
    if given.get("while_moving"):
        return _("acts in one sense of motion alone")
    if isinstance(load, LinkWeight):
        return _("the weight of a link without a mass")
    return _("no joints of the model give its coordinate")


def _all_of(value: object) -> Sequence[object]:
    return value if isinstance(value, tuple) else (value,)


def load_between_points(name: str, load: PointSpring | PointDamper, sites: tuple[str, ...]) -> TendonLoad:
    """A spring or damper between two points as a tendon between their sites."""
    if isinstance(load, PointDamper):
        return TendonLoad(name, sites, {}, {"damping": number(load.damping)})
    properties = {"stiffness": number(load.stiffness), "springlength": number(load.free_length or 0.0)}
    return TendonLoad(name, sites, {}, properties)


def _model_load(pose: Pose, name: str, load: AnyLoad) -> HeldLoad | None:
    match load:
        case PointSpring(points=points) | PointDamper(points=points):
            return load_between_points(name, load, _sites(pose, points))
        case HingeSpring(link=link, relative_to=base, stiffness=stiffness, free_angle=free):
            # the coordinates of joints count from the initial position
            rest = (free or 0.0) - (pose.angles[link] - pose.angles[base])
            properties = {"stiffness": number(stiffness), "springlength": resting_length(rest)}
            return TendonLoad(name, (), _joint_turns(pose, link, base), properties)
        case HingeDamper(link=link, relative_to=base, damping=damping):
            return TendonLoad(name, (), _joint_turns(pose, link, base), {"damping": number(damping)})
        case HingeFriction(link=link, relative_to=base, value=None, viscous=float(viscous), quadratic=None):
            return TendonLoad(name, (), _joint_turns(pose, link, base), {"damping": number(viscous)})
        case GuideFriction(guide=guide, value=None, viscous=float(viscous), quadratic=None):
            return TendonLoad(name, (), {f"guide {guide}": 1.0}, {"damping": number(viscous)})
        case Torque(link=link, relative_to=base, value=float(value), table=None):
            return ActuatorLoad(name, {}, _joint_turns(pose, link, base), value)
        case GuideForce(guide=guide, value=float(value), table=None, pressure=None):
            return ActuatorLoad(name, {}, {f"guide {guide}": 1.0}, value)
        case PointForce(point=point, vector=(float(x), float(y)), axes="frame", while_moving=None):
            return _force(pose, name, point, (x, y))
        case PointForce(point=point, vector=(float(x), float(y)), axes=str(axes), while_moving=None) if (
            axes != FRAME and point in pose.mechanism.links[axes].coordinates
        ):
            # in the axes of the link's own site, which are initially those of the frame
            gear = numbers((*turn_vector((x, y), pose.angles[axes]), 0.0, 0.0, 0.0, 0.0))
            return ActuatorLoad(name, {"site": f"{axes}.{point}", "gear": gear}, {}, 1.0)
        case PointWeight(point=point, value=float(value)):
            return _force(pose, name, point, turned_down(pose.mechanism, value))
        case LinkWeight(link=link, value=None) if link in pose.masses:
            return OwnWeight(link, None)
        case LinkWeight(link=link, value=float(value)) if link in pose.masses:
            own = float(pose.masses[link].mass) * math.hypot(*(pose.mechanism.gravity or (0.0, 0.0)))
            gear = numbers((*turned_down(pose.mechanism, value - own), 0.0, 0.0, 0.0, 0.0))
            attributes = {"site": f"weight {link}", "refsite": WORLD_SITE, "gear": gear}
            return OwnWeight(link, ActuatorLoad(name, attributes, {}, 1.0)) if own else None
        case (
            HingeFriction() | GuideFriction() | BearingFriction() | SliderFriction()
            | Torque() | GuideForce() | PointForce() | LinkWeight() | PointWeight()
        ):  # fmt: skip
            return None
        case _:
            assert_never(load)


def _force(pose: Pose, name: str, point: str, vector: Sequence[float]) -> ActuatorLoad:
    """A constant force, in the axes of the frame."""
    (site,) = _sites(pose, (point,))
    gear = numbers((*vector, 0.0, 0.0, 0.0, 0.0))
    return ActuatorLoad(name, {"site": site, "refsite": WORLD_SITE, "gear": gear}, {}, 1.0)


def turned_down(mechanism: Mechanism, size: float) -> tuple[float, float]:
    """A vector of a size in the direction of gravity."""
    x, y = (float(part) for part in mechanism.gravity or (0.0, 0.0))
    strength = math.hypot(x, y) or 1.0
    return size * x / strength, size * y / strength


def _sites(pose: Pose, points: Sequence[str]) -> tuple[str, ...]:
    """Sites of points, each on a body that has it."""
    found = []
    for point in points:
        owners = [name for name, link in pose.mechanism.links.items() if point in link.coordinates]
        fixed = point in pose.mechanism.frame.points
        found.append(f"{FRAME if fixed else owners[0]}.{point}")
    return tuple(found)


def _joint_turns(pose: Pose, link: str, base: str) -> dict[str, float]:
    return pose.turns({link: 1.0, base: -1.0})


def resting_length(length: float) -> str:
    """A resting length as MuJoCo reads it: -1 alone has a meaning of its own there."""
    return number(length if length != -1.0 else -1.0 - 1e-15)


def add_tendons(loads: ModelLoads, tendons: ET.Element) -> None:
    """Springs and dampers."""
    for load in loads.tendons:
        tendon = ET.SubElement(
            tendons, "spatial" if load.sites else "fixed", name=load.name, attrib=dict(load.properties)
        )
        for site in load.sites:
            ET.SubElement(tendon, "site", site=site)
        for joint, factor in load.joints.items():
            ET.SubElement(tendon, "joint", joint=joint, coef=number(factor))


def tendons_of(root: ET.Element) -> ET.Element:
    """Where the tendons of a model stand."""
    found = root.find("tendon")
    return ET.SubElement(root, "tendon") if found is None else found


def fixed_tendon(root: ET.Element, name: str, joints: Mapping[str, float]) -> None:
    """A tendon whose length is a sum of coordinates."""
    tendon = ET.SubElement(tendons_of(root), "fixed", name=name)
    for joint, factor in joints.items():
        ET.SubElement(tendon, "joint", joint=joint, coef=number(factor))
