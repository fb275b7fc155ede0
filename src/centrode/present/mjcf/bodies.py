"""Bodies of the model: joints, masses, what is drawn of them, and the bodies that hang on them."""

from __future__ import annotations

import math
from xml.etree import ElementTree as ET

from centrode.dynamics.state import Centre
from centrode.present.mjcf.pose import Pose
from centrode.present.mjcf.spelled import less, number, numbers, turned
from centrode.present.mjcf.tree import Place, outline

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
        way = turned((float(known.centre.along), float(known.centre.across)), pose.angles[name])
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
