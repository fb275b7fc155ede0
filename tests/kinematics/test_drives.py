"""Drives between two moving links: motors on links, guides of moving links, also as second of two drives."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from mechanisms import EPS, link, point, slide

TAU = math.tau


def test_a_motor_on_a_crank() -> None:
    """Two drives, the second relative to the first link: angles add up, over many turns."""
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 2.0}, "AB": {"length": 1.0}},
        drives=[
            {"link": "OA", "start": 0.3, "speed": 1.0},
            {"link": "AB", "relative_to": "OA", "start": -0.5, "speed": -3.5},
        ],
    )
    data = ct.motion(mechanism, 201, start=0.0, stop=30 * TAU)
    t = data.time.to_numpy()
    first, second = 0.3 + t, -0.2 - 2.5 * t
    allowed = 8 * EPS * (1 + t) * 3.5
    assert (np.abs(link(data, "AB") - second) <= allowed).all()
    assert (np.abs(point(data, "B") - (2 * np.exp(1j * first) + np.exp(1j * second))) <= 3 * allowed).all()
    assert np.abs(link(data, "AB", "angular_velocity") + 2.5).max() <= 16 * EPS


def test_a_motor_between_crank_and_coupler() -> None:
    """A single drive between two moving links: a rocking scissor whose opening is given."""
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 2.0, "angle": 0.9}, "AB": {"length": 2.0, "angle": -0.9}},
        guides=[{"point": "B", "through": [0, 0], "direction": [1, 0]}],
        drives=[{"link": "AB", "relative_to": "OA", "start": -1.8, "speed": 1.0}],
    )
    data = ct.motion(mechanism, 31, start=-2.6, stop=-0.4)
    opening = data.drive_value[:, 0].to_numpy()
    # an isosceles triangle: the base is 4 cos(opening / 2)
    assert np.abs(point(data, "B") - 4 * np.cos(opening / 2)).max() <= 256 * EPS
    assert np.abs(link(data, "OA") + opening / 2).max() <= 256 * EPS


def telescope(second: dict[str, object]) -> ct.Mechanism:
    """A telescope on a turntable: the block slides on a guide of the turning arm, beside its pivot."""
    return ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={
            "arm": {"points": {"O": [0, 0], "E": [1, 0]}},
            "block": {"points": {"B": [0, 0], "T": [0.5, 0.2]}},
        },
        guides=[
            {
                "point": "B",
                "on": "arm",
                "through": [0.2, 0.3],
                "direction": 0.4,
                "link": "block",
                "angle": 0.1,
            }
        ],
        drives=[{"link": "arm", "start": 0.3, "speed": 1.0}, second],
    )


def test_a_guide_on_a_moving_link_is_driven() -> None:
    """Place, velocity and acceleration of the block by the formulas of relative motion, Coriolis's included."""
    data = ct.motion(telescope({"guide": "B", "start": 0.5, "law": "0.2*t^2"}), 61, start=0.0, stop=6.0)
    t = data.time.to_numpy()
    turn = np.exp(1j * (0.3 + t))
    along = np.exp(0.4j)
    s, v, a = 0.5 + 0.2 * t**2, 0.4 * t, 0.4
    local = 0.2 + 0.3j + s * along
    size = 16 * EPS * (1 + t) * (1 + s)
    assert (np.abs(point(data, "B") - turn * local) <= size).all()
    assert (np.abs(point(data, "B", "velocity") - turn * (1j * local + v * along)) <= 4 * size).all()
    expected = turn * (-local + 2j * v * along + a * along)
    assert (np.abs(point(data, "B", "acceleration") - expected) <= 16 * size).all()
    assert (np.abs(slide(data, "B") - s) <= size).all()
    tip = turn * (local + np.exp(0.1j) * (0.5 + 0.2j))
    assert (np.abs(point(data, "T") - tip) <= size).all()
    assert data.drive_value.units == "rad m"


def test_a_cylinder_is_another_way_to_drive_a_telescope() -> None:
    """By the distance of B from the pivot instead of the displacement: the same place."""
    by_slide = ct.motion(telescope({"guide": "B", "start": 0.5, "law": "0.2*t^2"}), 31, start=0.0, stop=3.0)
    t = by_slide.time.to_numpy()
    distance = "sqrt((0.2+(0.5+0.2*t^2)*cos(0.4))^2+(0.3+(0.5+0.2*t^2)*sin(0.4))^2)"
    start = abs(0.2 + 0.3j + 0.5 * np.exp(0.4j))
    mechanism = telescope({"distance": ["O", "B"], "start": 0.0, "law": distance})
    sided = mechanism.model_copy(update={"assembly": ct.Assembly(sides={"B": "ahead"})})
    by_distance = ct.motion(sided, 31, start=0.0, stop=3.0)
    assert abs(float(by_distance.drive_value[0, 1]) - start) <= 4 * EPS
    assert (np.abs(point(by_distance, "B") - point(by_slide, "B")) <= 64 * EPS * (1 + t)).all()


def test_a_drive_against_a_prismatic_pair_is_refused() -> None:
    mechanism = telescope({"link": "block", "relative_to": "arm", "speed": 1.0})
    with pytest.raises(
        ct.InputError, match="drive of link block: it cannot move: the rest of the mechanism holds it"
    ):
        ct.check(mechanism)
