"""Cylinders against the law of cosines: on the frame, between moving links, in chains; values that cannot be."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import centrode as ct
from mechanisms import EPS, link, point, statuses

Array = npt.NDArray[np.float64]
TAU = math.tau


def lever(**drive: Any) -> ct.Mechanism:
    """A lever about O, lifted at E by a cylinder that stands on F."""
    return ct.Mechanism(
        frame={"points": {"O": [0, 0], "F": [2, -1]}},
        links={"lever": {"points": {"O": [0, 0], "E": [1.5, 0.3], "T": [4, 0]}}},
        drives=[{"distance": ["F", "E"], "start": 1.5, "speed": 0.1, **drive}],
        assembly={"sides": {"E": "left"}},
    )


def test_a_lever_on_a_cylinder_obeys_the_law_of_cosines() -> None:
    data = ct.motion(lever(), 101)
    length = data.drive_value[:, 0].to_numpy()
    base, arm = abs(2 - 1j), abs(1.5 + 0.3j)
    # the range left alone: half a per cent within the limits, where the cylinder and the arm are in line with the base
    low, high = abs(base - arm), base + arm
    assert length[0] == pytest.approx(low + 0.005 * (high - low), rel=8 * EPS)
    assert length[-1] == pytest.approx(high - 0.005 * (high - low), rel=8 * EPS)
    cosine = (base**2 + arm**2 - length**2) / (2 * base * arm)
    # E lies left of the line from O, the lever's own end, to F
    angle = np.angle(2 - 1j) + np.arccos(cosine) - np.angle(1.5 + 0.3j)
    sine = np.sqrt(1 - cosine**2)
    assert (np.abs(link(data, "lever") - angle) <= 32 * EPS / sine).all()
    rate = length / (base * arm * sine)
    found = link(data, "lever", "angular_velocity_coefficient")
    assert (np.abs(found - rate) <= 64 * EPS * rate / sine**2).all()
    assert data.drive_value.units == "m"


def test_a_cylinder_and_the_motor_of_its_lever_agree() -> None:
    """Driven by its angle the lever has the distance that drives it there."""
    by_length = ct.motion(lever(), 21)
    turned = ct.Mechanism(
        frame=lever().frame, links=lever().links, drives=[{"link": "lever", "start": 0.0, "speed": 1.0}]
    )
    by_angle = ct.motion(turned, at=link(by_length, "lever"))
    distance = np.abs(point(by_angle, "E") - (2 - 1j))
    assert np.abs(distance - by_length.drive_value[:, 0]).max() <= 64 * EPS


def test_excavator_arm_by_the_law_of_cosines() -> None:
    """Each joint's angle follows from the length of its own cylinder."""
    mechanism = ct.example("excavator-arm")
    data = ct.motion(mechanism, 121)
    assert set(statuses(data)) == {"ok"}
    lengths = dict(zip(("KA", "CE", "SN"), data.drive_value.to_numpy().T, strict=True))

    def inner(body: str, joint: str, end: str) -> complex:
        local = mechanism.links[body].coordinates
        return complex(*local[end]) - complex(*local[joint])

    frame = {name: complex(*at) for name, at in mechanism.frame.coordinates.items()}

    def opening(one: complex, other: complex, across: Array) -> Array:
        return np.arccos((abs(one) ** 2 + abs(other) ** 2 - across**2) / (2 * abs(one) * abs(other)))

    base = frame["K"] - frame["O"]
    arm = inner("boom", "O", "A")
    boom = np.angle(base) + opening(base, arm, lengths["KA"]) - np.angle(arm)
    assert np.abs(np.exp(1j * (link(data, "boom") - boom)) - 1).max() <= 64 * EPS
    back, forward = inner("boom", "B", "C"), inner("stick", "B", "E")
    relative = np.angle(back) + opening(back, forward, lengths["CE"]) - np.angle(forward)
    other = np.angle(back) - opening(back, forward, lengths["CE"]) - np.angle(forward)
    stick = link(data, "stick") - link(data, "boom")
    apart = [np.abs(np.exp(1j * (stick - angle)) - 1).max() for angle in (relative, other)]
    assert min(apart) <= 64 * EPS


def between_moving_links() -> ct.Mechanism:
    """A two-link arm: the first link has a motor, the second is lifted by a cylinder that stands on the first."""
    return ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={
            "first": {"points": {"O": [0, 0], "G": [0.5, 0.4], "A": [2, 0]}},
            "second": {"points": {"A": [0, 0], "H": [0.6, 0.5], "T": [1.5, 0]}},
        },
        drives=[
            {"link": "first", "start": 0.2, "speed": 1.0},
            {"distance": ["G", "H"], "start": 1.6, "law": "0.3*sin(2*t)"},
        ],
        assembly={"sides": {"H": "left"}},
    )


def test_a_cylinder_between_moving_links() -> None:
    """The angle between the links depends on the cylinder alone, whatever the motor does."""
    data = ct.motion(between_moving_links(), 91, start=0.0, stop=TAU)
    length = data.drive_value[:, 1].to_numpy()
    one, other = (0.5 + 0.4j) - 2.0, 0.6 + 0.5j
    cosine = (abs(one) ** 2 + abs(other) ** 2 - length**2) / (2 * abs(one) * abs(other))
    sine = np.sqrt(1 - cosine**2)
    relative = link(data, "second") - link(data, "first")
    expected = np.angle(one / other) + np.arccos(cosine)
    wrong = np.exp(1j * (relative - expected)) - 1
    assert (np.abs(wrong) <= 64 * EPS / sine).all()
    assert np.abs(np.abs(point(data, "H") - point(data, "G")) - length).max() <= 16 * EPS
    assert data.drive_value.units == "rad m"


def test_a_slider_on_a_cylinder() -> None:
    """A point on a guide and a cylinder from the side of it: x = sqrt(l^2 - h^2)."""
    mechanism = ct.Mechanism(
        frame={"points": {"F": [0, 1]}},
        links={"BC": {"points": {"B": [0, 0]}}},
        guides=[{"point": "B", "through": [0, 0], "direction": [1, 0], "link": "BC"}],
        drives=[{"distance": ["F", "B"], "start": 2.0, "speed": 0.5}],
        assembly={"sides": {"B": "ahead"}},
    )
    data = ct.motion(mechanism, 41, start=1.1, stop=3.0)
    length = data.drive_value[:, 0].to_numpy()
    x = np.sqrt(length**2 - 1)
    assert (np.abs(point(data, "B") - x) <= 16 * EPS * length**2 / x).all()
    assert (
        np.abs(point(data, "B", "velocity").real - 0.5 * length / x) <= 64 * EPS * (length / x) ** 3
    ).all()


def test_shorter_than_zero() -> None:
    with pytest.raises(ct.InputError, match="a cylinder shorter than zero"):
        lever(start=-0.5)
    with pytest.raises(ct.InputError, match="a cylinder shorter than zero"):
        lever(start=0.0)
    # the lever's end can be drawn to the cylinder's own foot; beyond, there is no motion
    parts: dict[str, Any] = {
        "frame": {"points": {"O": [0, 0], "F": [1, 0]}},
        "links": {"lever": {"points": {"O": [0, 0], "E": [1, 0]}}},
        "assembly": {"sides": {"E": "left"}},
    }
    mechanism = ct.Mechanism(**parts, drives=[{"distance": ["F", "E"], "start": 1.0, "speed": -1.0}])
    data = ct.motion(mechanism, at=[0.5, 0.1, -0.1, -1.0])
    assert statuses(data) == ["ok", "ok", "open", "open"]
    assert np.isnan(point(data, "E")[2:]).all()
    swinging = ct.Mechanism(**parts, drives=[{"distance": ["F", "E"], "start": 1.0, "law": "1.5*sin(t)"}])
    data = ct.motion(swinging, 5, start=0.0, stop=1.5 * math.pi)
    assert statuses(data)[-1] == "open"
    assert statuses(data)[:2] == ["ok", "open"]  # at 45 deg the two are apart by 2.06: the arm is too short


def test_start_by_the_initial_angles() -> None:
    """Left out, the start is the distance at which the initial angles put the points."""
    drive = {"distance": ["F", "E"], "speed": 0.1}
    frame, links = {"points": {"O": [0, 0], "F": [2, -1]}}, {"OE": {"length": 1.5, "angle": 0.9}}
    given = ct.Mechanism(frame=frame, links=links, drives=[drive])
    data = ct.motion(given, 3, start=None, stop=None)
    e = 1.5 * np.exp(0.9j)
    here = ct.motion(given, at=[abs(e - (2 - 1j))])
    assert abs(point(here, "E")[0] - e) <= 16 * EPS
    assert (data.status == ct.Status.OK).all()
    with pytest.raises(ct.InputError, match="the initial length of the cylinder is not given"):
        ct.check(ct.Mechanism(frame=frame, links={"OE": {"length": 1.5}}, drives=[drive]))


def test_a_batch_is_its_mechanisms_one_by_one() -> None:
    vary = {"links.lever.points.E.x": [1.5, 1.3], "frame.points.F.y": [-1.0, -0.8]}
    batch = ct.motion(lever(), 31, start=1.2, stop=2.4, vary=vary)
    for k in range(2):
        one = lever()
        for path, values in vary.items():
            one = ct.with_value(one, path, values[k])
        alone = ct.motion(one, 31, start=1.2, stop=2.4)
        for name in ("position", "velocity", "angle"):
            np.testing.assert_array_equal(batch[name][k], alone[name])
