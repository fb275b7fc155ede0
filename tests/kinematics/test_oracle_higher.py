"""Groups of higher class, gears, wheels, cylinders and the sphere against thirty digits (tests/oracle)."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import xarray as xr
from numpy.linalg import norm

import centrode as ct
from centrode.model.values import unit_vector
from mechanisms import EPS, OPERATIONS, Array, events, statuses

ORACLE: dict[str, Any] = json.loads(
    (Path(__file__).parents[1] / "oracle" / "oracle_higher.json").read_text(encoding="utf-8")
)
SPHERICAL = [name for name, record in ORACLE.items() if record["parts"].get("space") == "sphere"]
LIMITED = [name for name, record in ORACLE.items() if record["limits"]]
BESIDE = 2.0**-20
"""How far from a limit its two sides are looked at, in what one of the drive counts as."""
PLACE = ("position", "velocity", "acceleration")
ANGLE = ("angle", "angular_velocity", "angular_acceleration")
JOINT = ("joint_angle", "joint_velocity", "joint_acceleration")
SLIDE = ("slide", "slide_velocity", "slide_acceleration")
COEFFICIENT = {name: f"{name}_coefficient" for names in (PLACE, ANGLE, JOINT, SLIDE) for name in names[1:]}


@cache
def motion_of(name: str) -> xr.Dataset:
    """The motion at the samples of a record; not to be changed."""
    record = ORACLE[name]
    return ct.motion(ct.Mechanism(**record["parts"]), at=[sample["at"] for sample in record["samples"]])


@cache
def beside_limits(name: str) -> tuple[xr.Dataset, int]:
    """The motion inside the limits of a record, then outside of them, and how many they are; not to be changed."""
    record = ORACLE[name]
    inside, outside = [], []
    for limit in record["limits"]:
        way = BESIDE * unit(record) * (1 if float(limit["at"]) > start(record) else -1)
        inside.append(float(limit["at"]) - way)
        outside.append(float(limit["at"]) + way)
    return ct.motion(ct.Mechanism(**record["parts"]), at=[*inside, *outside]), len(inside)


@pytest.mark.parametrize("name", ORACLE)
def test_motion_against_thirty_digits(name: str) -> None:
    record = ORACLE[name]
    motion = motion_of(name)
    assert statuses(motion) == ["ok"] * len(record["samples"])
    for index, sample in enumerate(record["samples"]):
        for output, digits in sample["outputs"].items():
            size = 1.0 if output.startswith("angle") else record["scale"]
            for order in range(3):
                found = value(motion, output, order, many=len(record["parts"]["drives"]) > 1)[index]
                allowed = OPERATIONS * EPS * sample["condition"][order] * size
                with mp.workdps(40):
                    difference = abs(mp.mpf(float(found)) - mp.mpf(digits[order]))
                assert difference <= allowed, f"{output}, derivative {order}, at {sample['at']}"


@pytest.mark.parametrize("name", LIMITED)
def test_limits_against_thirty_digits(name: str) -> None:
    record = ORACLE[name]
    found = events(beside_limits(name)[0], "limit")
    for limit in record["limits"]:
        allowed = OPERATIONS * EPS * limit["condition"] * unit(record)
        with mp.workdps(40):
            assert min(abs(mp.mpf(v) - mp.mpf(limit["at"])) for v in found) <= allowed


@pytest.mark.parametrize("name", LIMITED)
def test_a_motion_ends_at_its_limits(name: str) -> None:
    motion, inside = beside_limits(name)
    told = statuses(motion)
    assert told[:inside] == ["ok"] * inside
    assert "ok" not in told[inside:]


@pytest.mark.parametrize("name", SPHERICAL)
def test_angular_velocities_move_the_points_of_a_spherical_link(name: str) -> None:
    record = ORACLE[name]
    mechanism = ct.Mechanism(**record["parts"])
    motion = motion_of(name)
    many = len(record["parts"]["drives"]) > 1
    for index, sample in enumerate(record["samples"]):
        c = sample["condition"]
        for link, described in mechanism.links.items():
            first, second, *_ = (rows(sample, mechanism, point) for point in described.coordinates)
            spread = norm(np.cross(first[0], second[0]))
            spin, change = (
                motion[variable(ANGLE, order, many)].sel(link=link).to_numpy()[index] for order in (1, 2)
            )
            speed = norm(spin)
            # two points of a link give its spin, divided by the sine of the arc between them
            allowed = OPERATIONS * EPS * (c[1] + speed * c[0]) / spread
            allowed_change = OPERATIONS * EPS * (c[2] + 2 * speed * c[1] + (speed**2 + norm(change)) * c[0])
            for at, velocity, acceleration in (first, second):
                assert norm(np.cross(spin, at) - velocity) <= allowed
                turned = np.cross(change, at) + np.cross(spin, np.cross(spin, at))
                assert norm(turned - acceleration) <= allowed_change / spread


def value(motion: xr.Dataset, output: str, order: int, many: bool) -> Any:
    """A column of the dataset by the oracle's name of it; with many drives derivatives are by time."""
    kind, label = output.split(":")
    if kind == "angle" and "joint" in motion.dims:
        return motion[variable(JOINT, order, many)].sel(joint=label).to_numpy()
    if kind == "angle":
        return motion[variable(ANGLE, order, many)].sel(link=label).to_numpy()
    if kind == "slide":
        return motion[variable(SLIDE, order, many)].sel(guide=label).to_numpy()
    return motion[variable(PLACE, order, many)].sel(point=label, axis=kind).to_numpy()


def variable(names: tuple[str, str, str], order: int, many: bool) -> str:
    """Name of a derivative: by time with many drives, else by the drive's value."""
    return COEFFICIENT.get(names[order], names[order]) if order and not many else names[order]


def rows(sample: dict[str, Any], mechanism: ct.Mechanism, point: str) -> Array:
    """Place, first and second derivative of a point by the oracle; those of the frame rest."""
    if point in mechanism.frame.points:
        return np.array([unit_vector(mechanism.frame.points[point]), [0.0] * 3, [0.0] * 3])
    columns = [sample["outputs"][f"{axis}:{point}"] for axis in "xyz"]
    return np.array(columns, dtype=float).T


def start(record: dict[str, Any]) -> float:
    """The drive's value in the initial position."""
    return float(record["parts"]["drives"][0]["start"])


def unit(record: dict[str, Any]) -> float:
    """What one of the drive counts as: 1 rad, or the greatest length."""
    return 1.0 if "link" in record["parts"]["drives"][0] else float(record["scale"])
