"""Coordinates of the joints of a linkage's tree along its motion, and what joints follow others by a straight line."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import Status
from centrode.export.body_trees import Pose, cylinder_names, slider_name
from centrode.model.mechanism import FRAME

if TYPE_CHECKING:
    import xarray

Array: TypeAlias = npt.NDArray[np.float64]

EXACT = 1e-9
"""Error below which a joint follows another one exactly [rad, or the size of the linkage]."""


def joint_coordinates(pose: Pose, motion: xarray.Dataset) -> dict[str, Array]:
    """Coordinate of every joint of the tree at the samples that are reached: rad or m, from the initial position.

    The first sample of `motion` is the initial position.
    """
    there = motion.status.values == Status.OK
    angles, slides = _body_angles(pose, motion), _slides(pose, motion)
    found = {}
    for body, (pair, parent) in pose.tree.joints.items():
        if pair.direction is None:
            values = angles[body] - angles[parent]
        else:
            values = slides[pair.name]
        found[pair.name] = (values - values[0])[there]
    return found


def _body_angles(pose: Pose, motion: xarray.Dataset) -> dict[str, Array]:
    """Angles of all bodies [rad], with their turns."""
    links = motion["link"].values.tolist()
    angles: dict[str, Array] = {name: motion["angle"].values[:, k] for k, name in enumerate(links)}
    angles[FRAME] = np.zeros(motion.sizes["sample"])
    for guide in pose.mechanism.guides:
        angles[slider_name(guide.id)] = angles[guide.on]
    for drive in pose.mechanism.drives:
        if drive.distance is not None:
            start, end = (motion["position"].sel(point=point).values for point in drive.distance)
            way = end - start
            angle = np.arctan2(way[:, 1], way[:, 0])
            known = np.isfinite(angle)
            angle[known] = np.unwrap(angle[known])
            angles |= dict.fromkeys(cylinder_names(drive.id), angle)
    for body, (pair, _parent) in pose.tree.joints.items():
        if body not in angles:
            angles[body] = angles[pair.first]  # a carriage
    return angles


def _slides(pose: Pose, motion: xarray.Dataset) -> dict[str, Array]:
    guides = motion["guide"].values.tolist()
    slides: dict[str, Array] = {
        f"guide {name}": motion["slide"].values[:, k] for k, name in enumerate(guides)
    }
    for drive in pose.mechanism.drives:
        if drive.distance is not None:
            start, end = (motion["position"].sel(point=point).values for point in drive.distance)
            slides[f"drive {drive.id}"] = np.hypot(*(end - start).T)
    return slides


@dataclass(frozen=True)
class Mimic:
    """A joint that follows another one: multiplier times its coordinate, plus offset.

    Attributes
    ----------
    error : greatest difference from the motion [rad or m]; `exact`: it is rounding
    """

    joint: str
    multiplier: float
    offset: float
    error: float
    exact: bool


def driving_joints(pose: Pose) -> dict[str, float]:
    """Joints whose coordinates are those of drives, and the factor (1 or -1) of the drive's value."""
    found: dict[str, float] = {}
    for drive in pose.mechanism.drives:
        joints = pose.driven_joints(drive)
        if len(joints) == 1:
            found |= joints
    return found


def mimics_of(pose: Pose, coordinates: Mapping[str, Array]) -> dict[str, Mimic]:
    """How joints follow those of the drives; with several drives only joints that follow one of them exactly.

    A line is fitted by least squares where there is one drive and a joint does not follow it exactly.
    """
    masters = [joint for joint in driving_joints(pose) if joint in coordinates]
    sliding = {pair.name for pair, _parent in pose.tree.joints.values() if pair.direction is not None}
    found: dict[str, Mimic] = {}
    for joint, values in coordinates.items():
        if joint in masters or not masters:
            continue
        mimic = _fit_line(masters, coordinates, values, pose.size if joint in sliding else 1.0)
        if mimic is not None and (mimic.exact or len(pose.mechanism.drives) == 1):
            found[joint] = mimic
    return found


def _fit_line(
    masters: Sequence[str], coordinates: Mapping[str, Array], values: Array, scale: float
) -> Mimic | None:
    columns = [coordinates[master] for master in masters]
    # what follows exactly passes through the initial position, where all coordinates are zero
    without_offset = np.linalg.lstsq(np.stack(columns, axis=1), values, rcond=None)[0]
    for offset in (False, True):
        if offset:
            whole = np.stack([*columns, np.ones_like(values)], axis=1)
            solution = np.linalg.lstsq(whole, values, rcond=None)[0]
        else:
            solution = np.append(without_offset, 0.0)
        factors = solution[:-1]
        k = int(np.argmax(np.abs(factors)))
        # what stands still, and whole factors, are those of gears: rounding of the fit is none of theirs
        near = round(float(factors[k]) * 5040.0) / 5040.0
        factor = near if abs(near - factors[k]) < 1e-11 else float(factors[k])
        error = float(np.max(np.abs(factor * columns[k] + solution[-1] - values)))
        if error <= EXACT * scale:
            return Mimic(masters[k], factor, float(solution[-1]), error, True)
        if offset:
            return Mimic(masters[k], factor, float(solution[-1]), error, False)
    return None


def greatest(values: Array) -> float:
    """Greatest magnitude, at least a thousandth."""
    return max(1e-3, math.ceil(float(np.max(np.abs(values), initial=0.0)) * 1e3) / 1e3)
