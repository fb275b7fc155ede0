"""Reactions of bevel gears in closed form: force between the teeth, moments of the bearings, balancing moments."""

from __future__ import annotations

from math import atan2, cos, pi, sin
from typing import Any

import numpy as np
import pytest

import centrode as ct
from mechanisms import EPS

ROUNDING = 256 * EPS


def pair(ratio: float, bend: float, radius: float, load: float) -> ct.Mechanism:
    """Wheels on shafts at an angle; the second is loaded."""
    parts: dict[str, Any] = {
        "space": "sphere", "radius": radius,
        "frame": {"points": {"A": [1, 0, 0], "B": [cos(bend), sin(bend), 0]}},
        "links": {
            "AE": {"length": 0.4, "reference": ["A", "B"]},
            "BF": {"length": 0.6, "reference": ["B", "A"], "angle": 1.1},
        },
        "gears": [{"links": ["AE", "BF"], "ratio": ratio}],
        "drives": [{"link": "AE", "start": 0, "speed": 1}],
        "loads": [{"kind": "torque", "link": "BF", "value": load}],
    }  # fmt: skip
    return ct.Mechanism(**parts)


@pytest.mark.parametrize("bend", [pi / 2, 1.2])
@pytest.mark.parametrize("ratio", [-0.5, -3.0])
def test_wheels_that_turn_against_each_other(ratio: float, bend: float) -> None:
    """Pitch cones d1 + d2 = bend, sin d1 = -ratio sin d2; the force has the arm R sin d2 about the second axis."""
    radius, load = 0.3, 7.0
    found = ct.reactions(pair(ratio, bend, radius, load), 5)
    first = atan2(-ratio * sin(bend), 1 - ratio * cos(bend))
    second = bend - first
    assert abs(sin(first) + ratio * sin(second)) <= ROUNDING * (1 - ratio)
    size = ROUNDING * load * (1 - ratio) / sin(second) ** 2 / radius
    assert np.max(abs(found.balancing + ratio * load)) <= size
    pitch, force = np.array([cos(first), sin(first), 0.0]), load / (radius * sin(second))
    assert np.max(abs(found.tooth_force[:, 0] - [0, 0, force])) <= size
    # bearings bear what of the moment of that force is square to their axes
    moment = np.cross(radius * pitch, [0, 0, force])
    for side, sense, axis in (("A/AE", 1, [1, 0, 0]), ("B/BF", -1, [cos(bend), sin(bend), 0])):
        square = moment - (moment @ axis) * np.array(axis)
        assert np.max(abs(found.joint_moment.sel(side=side) - sense * square)) <= size
    assert np.max(abs(found.gear_moment[:, 0, :2] - [ratio * load, -load])) <= size


def test_wheels_that_turn_alike() -> None:
    """Nothing tells on which side they mesh: the force is not known, its moment is square to the axis (2, -1, 0)."""
    found = ct.reactions(pair(0.5, pi / 2, 0.3, 7.0), 3)
    assert np.isnan(found.tooth_force).all()
    assert np.max(abs(found.balancing + 3.5)) <= ROUNDING * 7
    # on the second wheel (-3.5, -7, 0): 7 about B = (0, 1, 0) balance the load, the bearing of B bears the rest
    assert np.max(abs(found.joint_moment.sel(side="B/BF") - [3.5, 0, 0])) <= ROUNDING * 14
    assert np.max(abs(found.joint_moment.sel(side="A/AE") - [0, -7, 0])) <= ROUNDING * 14
