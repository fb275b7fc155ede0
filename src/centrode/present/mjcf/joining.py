"""What joins the bodies of the model beside their tree: constraints of loops and gears, actuators of the drives."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from centrode.model.mechanism import FRAME
from centrode.present.mjcf.pose import NOMINAL, Pose
from centrode.present.mjcf.spelled import less, number, numbers
from centrode.present.mjcf.tree import Pair

if TYPE_CHECKING:
    from centrode.model.mechanism import Drive

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
            _fixed(tendons, f"gear {gear.id}", pose.turns({second: 1.0, gear.carrier: gear.ratio - 1.0,
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
        _fixed(tendons, f"drive {drive.id}", joints)
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


def _fixed(tendons: ET.Element, name: str, joints: Mapping[str, float]) -> None:
    """A tendon whose length is a sum of coordinates."""
    tendon = ET.SubElement(tendons, "fixed", name=name)
    for joint, factor in joints.items():
        ET.SubElement(tendon, "joint", joint=joint, coef=number(factor))
