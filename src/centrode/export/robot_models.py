"""A planar linkage as models of robots: URDF, whose joints follow others, and SDF, whose joints close loops.

All links stand as they do initially, with the axes of the world; every joint counts from the initial position.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree as ET

import numpy as np

from centrode.errors import NotComputedYet
from centrode.export.body_trees import THIN, Pair, Place, Pose, less, number, numbers, outline
from centrode.export.joint_coordinates import (
    Array,
    Mimic,
    driving_joints,
    greatest,
    joint_coordinates,
    mimics_of,
)
from centrode.kinematics.motion import initial_place, motion
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import grid_of
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import FRAME

if TYPE_CHECKING:
    import xarray

SDF_VERSION = "1.11"
"""The first with joints that follow others."""
EFFORT = 1e6
"""Greatest force and moment of joints, which both formats ask for [N, N m]."""


@dataclass(frozen=True)
class RobotModel:
    """A model as text, and what it cannot hold: loops, gears, how well joints follow others, as JSON."""

    text: str
    loops: str


def urdf_model(source: MechanismSource, samples: int | None = None) -> RobotModel:
    """A planar linkage as URDF: the tree of its bodies, whose joints follow that of the drive.

    Parameters
    ----------
    source : Mechanism, file or name of an example
    samples : of the motion that straight lines are fitted to

    Returns
    -------
    RobotModel
        The text of the URDF, and a JSON beside it: pins that close loops, the error of each joint that follows
        the drive by a fitted line (exact for gears and parallelograms), and the coordinates of all joints.

    Raises
    ------
    NotComputedYet
        Spherical linkages.

    Examples
    --------
    >>> from centrode.export.robot_models import urdf_model
    >>> urdf_model("crank-rocker").text.splitlines()[0]
    '<robot name="Crank-rocker_four-bar_linkage">'
    """
    return _RobotTree.of(source, samples).urdf


def sdf_model(source: MechanismSource, samples: int | None = None) -> RobotModel:
    """A planar linkage as SDF: loops close in joints, and gears are joints that follow others exactly.

    Parameters, results and errors are those of `urdf_model`.
    """
    return _RobotTree.of(source, samples).sdf


class _RobotTree:
    """A pose with its motion, and names that every program takes."""

    def __init__(self, pose: Pose, moving: xarray.Dataset) -> None:
        self.pose, self.moving = pose, moving
        self.coordinates = joint_coordinates(pose, moving)
        self.names = _safe_names([FRAME, *pose.order(FRAME)])
        joints = [pair.name for pair, _parent in pose.tree.joints.values()]
        self.joint_names = _safe_names([*joints, *(f"closes {pair.name}" for pair in pose.tree.closures)])

    @classmethod
    def of(cls, source: MechanismSource, samples: int | None) -> _RobotTree:
        mechanism = mechanism_of(source)
        if mechanism.space == "sphere":
            what = _("models of robots are made of planar linkages")
            raise NotComputedYet("space", what, _("choose a planar linkage"))
        first = motion(mechanism, at=[initial_place(mechanism)])
        prepared = ready(mechanism)
        span = grid_of(prepared, samples, None, None, None)
        places = span.parameter if prepared.parameter.is_uniform else span.time
        # the first sample is the initial position: all coordinates count from there
        return cls(Pose(mechanism, first), motion(mechanism, at=[initial_place(mechanism), *places.tolist()]))

    @cached_property
    def mimics(self) -> dict[str, Mimic]:
        return mimics_of(self.pose, self.coordinates)

    # URDF.

    @property
    def urdf(self) -> RobotModel:
        pose = self.pose
        root = ET.Element("robot", name=_safe(pose.mechanism.title or "linkage"))
        self._urdf_link(root, FRAME, (0.0, 0.0))
        for body in pose.order(FRAME):
            self._urdf_link(root, body, pose.tree.joints[body][0].place)
            self._urdf_joint(root, body)
        return RobotModel(_document(root), self._loops())

    def _urdf_link(self, root: ET.Element, body: str, own: Place) -> None:
        pose, name = self.pose, self.names[body]
        link = ET.SubElement(root, "link", name=name)
        if body != FRAME:
            mass, about, centre = pose.inertial(body, own)
            inertial = ET.SubElement(link, "inertial")
            ET.SubElement(inertial, "origin", xyz=numbers((*centre, 0.0)))
            ET.SubElement(inertial, "mass", value=number(mass))
            ET.SubElement(inertial, "inertia", _moments(about))
        for size, place, turn, kind in self._shapes(body, own):
            visual = ET.SubElement(link, "visual")
            ET.SubElement(visual, "origin", xyz=numbers((*place, 0.0)), rpy=numbers(turn))
            geometry = ET.SubElement(visual, "geometry")
            if kind == "box":
                ET.SubElement(geometry, "box", size=numbers(size))
            else:
                ET.SubElement(geometry, "cylinder", radius=number(size[0]), length=number(size[1]))
        for point, place in self._points(body):
            ET.SubElement(root, "link", name=f"{name}.{point}")
            joint = ET.SubElement(root, "joint", name=f"at {name}.{point}".replace(" ", "_"), type="fixed")
            ET.SubElement(joint, "origin", xyz=numbers((*less(place, own), 0.0)))
            ET.SubElement(joint, "parent", link=name)
            ET.SubElement(joint, "child", link=f"{name}.{point}")

    def _urdf_joint(self, root: ET.Element, body: str) -> None:
        pose, (pair, parent) = self.pose, self.pose.tree.joints[body]
        kind = "continuous" if pair.direction is None else "prismatic"
        joint = ET.SubElement(root, "joint", name=self.joint_names[pair.name], type=kind)
        base = (0.0, 0.0) if parent == FRAME else pose.tree.joints[parent][0].place
        ET.SubElement(joint, "origin", xyz=numbers((*less(pair.place, base), 0.0)))
        ET.SubElement(joint, "parent", link=self.names[parent])
        ET.SubElement(joint, "child", link=self.names[body])
        ET.SubElement(joint, "axis", xyz=numbers(_axis(pair, body)))
        ET.SubElement(joint, "limit", self._limits(pair))
        mimic = self.mimics.get(pair.name)
        if mimic is not None:
            ET.SubElement(joint, "mimic", joint=self.joint_names[mimic.joint], multiplier=number(mimic.multiplier),
                          offset=number(mimic.offset))  # fmt: skip

    def _limits(self, pair: Pair) -> dict[str, str]:
        values = self.coordinates[pair.name]
        rates = {"effort": number(EFFORT), "velocity": number(greatest(self._rates(pair)))}
        if pair.direction is None:
            return rates
        room = 0.05 * float(np.ptp(values)) + 1e-3 * self.pose.size
        ends = {"lower": number(float(values.min()) - room), "upper": number(float(values.max()) + room)}
        return {**ends, **rates}

    def _rates(self, pair: Pair) -> Array:
        values = self.coordinates[pair.name][1:]
        time = self.moving["time"].values[1:]
        if len(values) < 2 or len(time) != len(values) or not np.isfinite(time).all():
            return np.ones(1)
        with np.errstate(all="ignore"):
            rates = np.gradient(values, time)
        return np.asarray(2.0 * rates[np.isfinite(rates)])

    # SDF.

    @property
    def sdf(self) -> RobotModel:
        pose = self.pose
        root = ET.Element("sdf", version=SDF_VERSION)
        model = ET.SubElement(root, "model", name=_safe(pose.mechanism.title or "linkage"))
        self._sdf_link(model, FRAME, (0.0, 0.0))
        fixed = ET.SubElement(model, "joint", name="frame_is_fixed", type="fixed")
        ET.SubElement(fixed, "parent").text = "world"
        ET.SubElement(fixed, "child").text = self.names[FRAME]
        for body in pose.order(FRAME):
            self._sdf_link(model, body, pose.tree.joints[body][0].place)
        for body in pose.order(FRAME):
            pair, parent = pose.tree.joints[body]
            axis = self._sdf_joint(model, pair, self.joint_names[pair.name], parent, body)
            mimic = self.mimics.get(pair.name)
            # loops move the other joints
            if mimic is not None and mimic.exact and self._is_geared(pair):
                self._sdf_mimic(axis, mimic)
        for pair in pose.tree.closures:
            self._sdf_joint(model, pair, self.joint_names[f"closes {pair.name}"], pair.first, pair.second)
        return RobotModel(_document(root), self._loops())

    def _is_geared(self, pair: Pair) -> bool:
        """Whether nothing else moves a joint: its child is a link that a gear turns."""
        bodies = {
            self_body for self_body, (own, _p) in self.pose.tree.joints.items() if own.name == pair.name
        }
        return any(bodies & set(gear.links) for gear in self.pose.mechanism.gears)

    def _sdf_mimic(self, axis: ET.Element, mimic: Mimic) -> None:
        element = ET.SubElement(axis, "mimic", joint=self.joint_names[mimic.joint])
        for word, value in (("multiplier", mimic.multiplier), ("offset", mimic.offset), ("reference", 0.0)):
            ET.SubElement(element, word).text = number(value)

    def _sdf_link(self, model: ET.Element, body: str, own: Place) -> None:
        link = ET.SubElement(model, "link", name=self.names[body])
        ET.SubElement(link, "pose").text = numbers((*own, 0.0, 0.0, 0.0, 0.0))
        mass, about, centre = self.pose.inertial(body, own)
        inertial = ET.SubElement(link, "inertial")
        ET.SubElement(inertial, "pose").text = numbers((*centre, 0.0, 0.0, 0.0, 0.0))
        ET.SubElement(inertial, "mass").text = number(mass)
        inertia = ET.SubElement(inertial, "inertia")
        for word, value in _moments(about).items():
            ET.SubElement(inertia, word).text = value
        for k, (size, place, turn, kind) in enumerate(self._shapes(body, own)):
            visual = ET.SubElement(link, "visual", name=f"shape_{k}")
            ET.SubElement(visual, "pose").text = numbers((*place, 0.0, *turn))
            shape = ET.SubElement(ET.SubElement(visual, "geometry"), kind)
            if kind == "box":
                ET.SubElement(shape, "size").text = numbers(size)
            else:
                ET.SubElement(shape, "radius").text = number(size[0])
                ET.SubElement(shape, "length").text = number(size[1])
        for point, place in self._points(body):
            frame = ET.SubElement(
                model, "frame", name=f"{self.names[body]}.{point}", attached_to=self.names[body]
            )
            ET.SubElement(frame, "pose", relative_to=self.names[body]).text = numbers(
                (*less(place, own), 0.0, 0.0, 0.0, 0.0)
            )

    def _sdf_joint(self, model: ET.Element, pair: Pair, name: str, parent: str, child: str) -> ET.Element:
        kind = "revolute" if pair.direction is None else "prismatic"
        joint = ET.SubElement(model, "joint", name=name, type=kind)
        ET.SubElement(joint, "parent").text = self.names[parent]
        ET.SubElement(joint, "child").text = self.names[child]
        own = (0.0, 0.0) if child == FRAME else self.pose.tree.joints[child][0].place
        ET.SubElement(joint, "pose", relative_to=self.names[child]).text = numbers(
            (*less(pair.place, own), 0.0, 0.0, 0.0, 0.0)
        )
        axis = ET.SubElement(joint, "axis")
        ET.SubElement(axis, "xyz").text = numbers(_axis(pair, child))
        return axis

    # What both hold.

    def _shapes(self, body: str, own: Place) -> Iterable[tuple[tuple[float, ...], Place, Place3, str]]:
        """Size, middle, turn and kind of what is drawn of a body."""
        pose = self.pose
        thin = THIN * pose.size
        if body not in pose.mechanism.links:
            if body != FRAME:
                yield (6.0 * thin, 3.6 * thin, 3.6 * thin), (0.0, 0.0), (0.0, 0.0, 0.0), "box"
            return
        points = [less(pose.places[point], own) for point in pose.mechanism.links[body].coordinates]
        for start, end in outline(points):
            length = math.dist(start, end)
            if length > 0.0:
                middle = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
                # a cylinder stands along z: it is laid down, then turned
                turn = (0.0, math.pi / 2, math.atan2(end[1] - start[1], end[0] - start[0]))
                yield (thin, length), middle, turn, "cylinder"

    def _points(self, body: str) -> list[tuple[str, Place]]:
        pose = self.pose
        if body == FRAME:
            points = list(pose.mechanism.frame.points)
        elif body in pose.mechanism.links:
            points = list(pose.mechanism.links[body].coordinates)
        else:
            return []
        return [(_safe(point), pose.places[point]) for point in points]

    def _loops(self) -> str:
        """Loops, joints that follow others, and coordinates along the motion, as JSON."""
        pose = self.pose

        def place(body: str, at: Place) -> list[float]:
            own = (0.0, 0.0) if body == FRAME else pose.tree.joints[body][0].place
            return list(less(at, own))

        closures: list[dict[str, Any]] = [
            {
                "name": self.joint_names[f"closes {pair.name}"],
                "first": self.names[pair.first], "second": self.names[pair.second],
                "at_first": place(pair.first, pair.place), "at_second": place(pair.second, pair.place),
            }
            for pair in pose.tree.closures
        ]  # fmt: skip
        mimics = {
            self.joint_names[joint]: {
                "joint": self.joint_names[mimic.joint], "multiplier": mimic.multiplier, "offset": mimic.offset,
                "exact": mimic.exact, "error": mimic.error,
            }
            for joint, mimic in self.mimics.items()
        }  # fmt: skip
        there = {self.joint_names[joint]: values.tolist() for joint, values in self.coordinates.items()}
        data = {
            "title": pose.mechanism.title,
            "units": "m, rad; every joint counts from the initial position",
            "drives": {self.joint_names[joint]: factor for joint, factor in driving_joints(pose).items()},
            "closures": closures,
            "mimics": mimics,
            "coordinates": there,
        }
        return json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


Place3 = tuple[float, float, float]


def _axis(pair: Pair, child: str) -> Place3:
    if pair.direction is None:
        return 0.0, 0.0, 1.0
    sign = 1.0 if pair.second == child else -1.0
    return sign * pair.direction[0], sign * pair.direction[1], 0.0


def _moments(about: float) -> dict[str, str]:
    """Moments of inertia of a flat body."""
    half, whole, none = number(0.5 * about), number(about), number(0.0)
    return {"ixx": half, "ixy": none, "ixz": none, "iyy": half, "iyz": none, "izz": whole}


def _safe(name: str) -> str:
    """A name without blanks: other programs part names by them."""
    return "_".join(name.split()) or "linkage"


def _safe_names(names: Iterable[str]) -> dict[str, str]:
    """Names without blanks, all of them different."""
    found: dict[str, str] = {}
    for name in names:
        safe = _safe(name)
        while safe in found.values():
            safe += "_"
        found[name] = safe
    return found


def _document(root: ET.Element) -> str:
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"
