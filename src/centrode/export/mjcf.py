"""A planar linkage as a model of MuJoCo: bodies below each other, constraints of loops and gears, actuators."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from centrode.errors import NotComputedYet
from centrode.export.body_trees import (
    NOMINAL,
    THIN,
    Pair,
    Place,
    Pose,
    WheelBody,
    less,
    number,
    numbers,
    outline,
)
from centrode.export.mjcf_loads import WORLD_SITE, ModelLoads, add_tendons, model_loads
from centrode.locale import _
from centrode.model.mechanism import FRAME, Mechanism

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Drive

# Bodies of the model: joints, masses, what is drawn of them, and the bodies that hang on them.

LIGHTEST = 1e-15
"""What MuJoCo divides by at the least."""


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
    mass, about, centre = pose.inertial(name, own)
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
    """Loops, gears and rolling wheels as equality constraints."""
    gears = pose.mechanism.gears
    if not pose.tree.closures and not gears and not pose.contacts:
        return
    if gears or pose.contacts:
        tendons = _tendons(root)
        for gear in gears:
            first, second = gear.links
            _fixed_tendon(tendons, f"gear {gear.id}", pose.turns({second: 1.0, gear.carrier: gear.ratio - 1.0,
                                                            first: -gear.ratio}))  # fmt: skip
        for contact in pose.contacts:
            _fixed_tendon(tendons, contact.pair.name, _rolling(pose, contact))
    equality = ET.SubElement(root, "equality")
    for pair in pose.tree.closures:
        _closure(pose, equality, pair)
    for gear in gears:
        ET.SubElement(equality, "tendon", name=f"gear {gear.id}", tendon1=f"gear {gear.id}")
    for contact in pose.contacts:
        ET.SubElement(equality, "tendon", name=contact.pair.name, tendon1=contact.pair.name)


def _rolling(pose: Pose, contact: WheelBody) -> dict[str, float]:
    """What a wheel that rolls keeps constant: its turn against its track less that by its way or its arm."""
    pair, share = contact.pair, contact.share
    if contact.ways is not None:
        ways = {joint: -share * factor for joint, factor in contact.ways.items() if factor}
        return pose.turns({contact.wheel: 1.0}) | ways
    if pair.direction is None:
        return pose.turns({contact.wheel: 1.0, contact.on: share - 1.0, pair.second: -share})
    return pose.turns({contact.wheel: 1.0, contact.on: -1.0}) | {pair.name: -share}


def _closure(pose: Pose, equality: ET.Element, pair: Pair) -> None:
    first, second = ("world" if body == FRAME else body for body in (pair.first, pair.second))
    # the anchor is told in the axes of the first body
    body, other = (second, first) if first == "world" else (first, second)
    own = pose.tree.joints[body][0].place
    ET.SubElement(equality, "connect", name=pair.name, body1=body, body2=other,
                  anchor=numbers((*less(pair.place, own), 0.0)))  # fmt: skip


def add_actuators(
    pose: Pose, root: ET.Element, loads: ModelLoads, kept: Sequence[Drive], rates: list[float]
) -> None:
    """Actuators of the drives that are kept and of constant loads, and the key frame that turns them on."""
    controls: dict[str, float] = {}
    parent = ET.Element("actuator")
    for drive in kept:
        name = f"drive {drive.id}"
        said = {"name": name} | _transmission(root, name, pose.driven_joints(drive))
        _actuator(pose, root, parent, drive, said)
        controls[name] = drive.speed or 0.0
    for load in loads.actuators:
        said = dict(load.attributes) or _transmission(root, load.name, load.joints)
        ET.SubElement(parent, "motor", {"name": load.name, **said})
        controls[load.name] = load.amount
    if controls:
        root.append(parent)
    frames = ET.SubElement(root, "keyframe")
    key = {"ctrl": numbers(list(controls.values()))} if controls else {}
    ET.SubElement(frames, "key", {"name": "initial", **key, "qvel": numbers(rates)})


def _transmission(root: ET.Element, name: str, joints: Mapping[str, float]) -> dict[str, str]:
    """What an actuator acts on: a joint, or a tendon whose length is a sum of coordinates."""
    if len(joints) == 1 and next(iter(joints.values())) == 1.0:
        return {"joint": next(iter(joints))}
    _fixed_tendon(_tendons(root), name, joints)
    return {"tendon": name}


def _tendons(root: ET.Element) -> ET.Element:
    found = root.find("tendon")
    return ET.SubElement(root, "tendon") if found is None else found


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


def _fixed_tendon(tendons: ET.Element, name: str, joints: Mapping[str, float]) -> None:
    """A tendon whose length is a sum of coordinates."""
    tendon = ET.SubElement(tendons, "fixed", name=name)
    for joint, factor in joints.items():
        ET.SubElement(tendon, "joint", joint=joint, coef=number(factor))


# The model as XML: bodies below each other, constraints of the loops and gears, actuators of the drives.

LIGHT = 1e-7
"""Mass of a body that the description gives none, in models that are left to their loads; part of the greatest."""
FREE_STEPS = 1000
"""Steps of time in the duration of a simulation, at least."""
HARD = "0.9999 0.9999 0.001"
"""How nearly rigid constraints are (MuJoCo's solimp)."""


def mjcf_text(mechanism: Mechanism, motion: xarray.Dataset, *, free: bool = False) -> str:
    """A linkage as a model of MuJoCo (MJCF), loops closed by equality constraints at the initial position.

    Parameters
    ----------
    mechanism : Mechanism
        In the plane.
    motion : Dataset
        Its motion, whose first sample is the initial position.
    free : bool
        Without drives: masses, springs, dampers and constant loads move the model, from rest or from the speed that the
        description's simulation begins with.

    Returns
    -------
    str
        XML. Lengths in metres; every coordinate of a joint counts from the initial position. Links have the masses of
        the description. Springs and dampers are tendons, constant forces and moments actuators; `omitted_loads` names
        those that are not in the model. A drive is an actuator of its joint with
        the key frame's `ctrl` as its speed (a law's value follows `ctrl`, from the initial one).

    Raises
    ------
    NotComputedYet
        Spherical linkages, and bodies too light for MuJoCo.
    """
    if mechanism.space == "sphere":
        raise NotComputedYet(
            "space", _("models of MuJoCo are made of planar linkages"), _("choose a planar linkage")
        )
    pose = Pose(mechanism, motion, LIGHT if free else NOMINAL, rolls=True, free=free)
    if free and mechanism.simulation is not None and mechanism.simulation.duration is not None:
        pose.step = min(pose.step, mechanism.simulation.duration / FREE_STEPS)
    if min(pose.least, pose.nominal_inertia) < LIGHTEST:
        what = _("MuJoCo has no bodies with a mass or moment of inertia below {least} kg or kg·m²")
        raise NotComputedYet("links", what.format(least=LIGHTEST), _("export it enlarged, or in other units"))
    return _document(pose, free, _starting_pace(mechanism) if free else 1.0)


def omitted_loads(mechanism: Mechanism, motion: xarray.Dataset) -> tuple[str, ...]:
    """Labels of the loads that a model of MuJoCo does not hold: formulas, tables, diagrams, dry friction, weights."""
    return model_loads(Pose(mechanism, motion)).omitted


def _starting_pace(mechanism: Mechanism) -> float:
    """How many times as fast as the drive's own speed a simulation begins; zero where it begins at rest."""
    simulation, drive = mechanism.simulation, mechanism.drives[0]
    speed = None if simulation is None else simulation.speed
    return 0.0 if not speed or not drive.speed else speed / abs(drive.speed)


def _document(pose: Pose, free: bool, pace: float) -> str:
    """The whole document; `pace`: how many times as fast as the drives' own speeds all moves initially."""
    root = ET.Element("mujoco", model=pose.mechanism.title or "linkage")
    ET.SubElement(root, "compiler", angle="radian", autolimits="true")
    gravity = pose.mechanism.gravity or (0.0, 0.0)
    ET.SubElement(root, "option", gravity=numbers((*gravity, 0.0)), timestep=number(pose.step),
                  integrator="RK4" if free else "implicitfast", tolerance="1e-12", iterations="200")  # fmt: skip
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
    loads = model_loads(pose)
    if loads.tendons:
        add_tendons(loads, _tendons(root))
    weighed = {weight.link for weight in loads.weights if weight.force is not None}
    for element in world.iter("body"):
        inertial = element.find("inertial")
        if element.get("name") in weighed and inertial is not None:
            ET.SubElement(
                element, "site", name=f"weight {element.get('name')}", pos=inertial.get("pos", "0 0 0")
            )
    if any("refsite" in load.attributes for load in loads.actuators):
        ET.SubElement(world, "site", name=WORLD_SITE)
    kept = pose.mechanism.drives if not free else ()
    order = pose.order(FRAME)
    add_actuators(pose, root, loads, kept, [pace * pose.rate(name) for name in order])
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"
