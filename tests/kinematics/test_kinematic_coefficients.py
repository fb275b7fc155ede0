"""Partial derivatives by each drive against closed forms, and against the motion they have to add up to."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import centrode as ct
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from mechanisms import EPS, four_bar, point, statuses

Array = npt.NDArray[np.float64]
M = JetFunctions(ARRAYS)
TIMES = np.linspace(0.1, 1.3, 9)


def arm(relative: bool, scale: float = 1.0) -> ct.Mechanism:
    """Two links in series; the second motor on the first link, or on the frame."""
    second: dict[str, Any] = {"link": "AB", "start": 0.7, "law": "0.4*sin(3*t)"}
    if relative:
        second["relative_to"] = "OA"
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0]}},
        links={"OA": {"length": 0.5 * scale}, "AB": {"length": 0.8 * scale}},
        drives=[{"link": "OA", "start": 0.2, "law": "0.9*t**2"}, second],
    )


def by(data: xr.Dataset, drives: tuple[str, ...], **which: str) -> Array:
    """A coefficient of a point as complex numbers, or of a link or guide, by one or two drives."""
    order = "velocity" if len(drives) == 1 else "acceleration"
    prefix = {"point": "", "link": "angular_", "guide": "slide_"}[next(iter(which))]
    values = data[f"{prefix}{order}_coefficient"].sel(**which)
    for dimension, drive in zip(("drive", "drive_2"), drives, strict=False):
        values = values.sel({dimension: drive})
    found = values.to_numpy()
    return found[..., 0] + 1j * found[..., 1] if "point" in which else found


@pytest.mark.parametrize("scale", [1e-3, 1.0, 730.0])
@pytest.mark.parametrize("relative", [True, False])
def test_an_arm_of_two_links(relative: bool, scale: float) -> None:
    """B = l1 e^{i a} + l2 e^{i (a + b)}, or l1 e^{i a} + l2 e^{i b}."""
    data = ct.kinematic_coefficients(arm(relative, scale), at=TIMES)
    a, b = data["drive_value"].to_numpy().T
    first, second = 0.5 * np.exp(1j * a), 0.8 * np.exp(1j * (a + b if relative else b))
    mixed = -second if relative else 0.0 * second
    exact = {
        ("OA",): 1j * (first + second if relative else first),
        ("AB",): 1j * second,
        ("OA", "OA"): -(first + second if relative else first),
        ("AB", "AB"): -second,
        ("OA", "AB"): mixed,
        ("AB", "OA"): mixed,
    }
    for drives, expected in exact.items():
        # polarisation adds up three second derivatives, each at most (1 + 1)^2 1.3 and rounded a few times
        assert np.max(np.abs(by(data, drives, point="B") / scale - expected)) <= 32 * EPS * 1.3
    assert by(data, ("OA",), link="AB") == pytest.approx(float(relative), abs=4 * EPS)
    assert by(data, ("AB",), link="AB") == pytest.approx(1.0, abs=4 * EPS)
    assert np.max(np.abs(data["angular_acceleration_coefficient"])) <= 32 * EPS
    assert (data["velocity_coefficient"].sel(point="O") == 0.0).all()


def crane(scale: float = 1.0) -> ct.Mechanism:
    """A link turned on the frame carries a guide on which a point is pushed: two drives of different kinds."""
    return ct.Mechanism(
        links={"OK": {"points": {"O": [0.0, 0.0], "K": [0.3 * scale, 0.0]}}},
        frame={"points": {"O": [0.0, 0.0]}},
        guides=[{"point": "P", "on": "OK", "through": [0.0, 0.1 * scale], "direction": [1.0, 0.0]}],
        drives=[
            {"link": "OK", "start": 0.4, "speed": 0.3},
            {"guide": "P", "start": 0.5 * scale, "law": f"{0.2 * scale!r}*sin(t)"},
        ],
    )


@pytest.mark.parametrize("scale", [2e-3, 1.0, 50.0])
def test_an_angle_and_a_displacement_on_a_moving_link(scale: float) -> None:
    """P = (s + i h) e^{i a}."""
    data = ct.kinematic_coefficients(crane(scale), at=TIMES)
    a, s = data["drive_value"].to_numpy().T
    turn, place = np.exp(1j * a), (s + 0.1j * scale) * np.exp(1j * a)
    exact = {
        ("OK",): (1j * place, scale),
        ("P",): (turn, 1.0),
        ("OK", "OK"): (-place, scale),
        ("OK", "P"): (1j * turn, 1.0),
        ("P", "OK"): (1j * turn, 1.0),
        ("P", "P"): (0.0 * turn, 1.0 / scale),
    }
    for drives, (expected, size) in exact.items():
        assert np.max(np.abs(by(data, drives, point="P") - expected)) <= 64 * EPS * size
    assert by(data, ("P",), guide="P") == pytest.approx(1.0, abs=8 * EPS)
    assert by(data, ("OK",), guide="P") == pytest.approx(0.0, abs=16 * EPS * scale)
    assert data["velocity_coefficient"].attrs["units"] == "m/rad, 1"
    assert data["acceleration_coefficient"].attrs["units"] == "m/rad^2, 1/rad, 1/rad, 1/m"
    assert data["angular_velocity_coefficient"].attrs["units"] == "1, rad/m"
    assert data["slide_acceleration_coefficient"].attrs["units"] == "m/rad^2, 1/rad, 1/rad, 1/m"


def five_bar(**drives: Any) -> ct.Mechanism:
    laws = {"OA": {"law": "t + 0.3*sin(2*t)"}, "EC": {"law": "-0.7*t**2"}, **drives}
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "E": [0.4, 0.0]}},
        links={
            "OA": {"length": 0.1},
            "AB": {"points": {"A": [0.0, 0.0], "B": [0.4, 0.0], "P": [0.2, 0.1]}},
            "CB": {"length": 0.35},
            "EC": {"length": 0.12},
        },
        drives=[{"link": "OA", "start": 0.3, **laws["OA"]}, {"link": "EC", "start": 2.5, **laws["EC"]}],
        assembly={"sides": {"B": "left"}},
    )


def dyad(a: Any, c: Any) -> Any:
    """B of the five-bar by the angles of its cranks, over any algebra."""
    ax, ay = M.cos(a) * 0.1, M.sin(a) * 0.1
    cx, cy = M.cos(c) * 0.12 + 0.4, M.sin(c) * 0.12
    x, y = cx - ax, cy - ay
    squared = x * x + y * y
    along = (squared + 0.4**2 - 0.35**2) / (squared * 2.0)
    left = M.sqrt(squared * 0.4**2 - (squared + 0.4**2 - 0.35**2) ** 2 * 0.25) / squared
    return ax + along * x - left * y, ay + along * y + left * x


def test_a_five_bar_against_jets_along_single_directions() -> None:
    """Directions that polarisation does not use: (1, 0), (0, 1) and (1, -1)."""
    data = ct.kinematic_coefficients(five_bar(), at=TIMES)
    a, c = data["drive_value"].to_numpy().T
    for u, v in ((1.0, 0.0), (0.0, 1.0), (1.0, -1.0), (2.0, 0.5)):
        x, y = dyad(Jet((a, u, 0.0)), Jet((c, v, 0.0)))
        first = by(data, ("OA",), point="B") * u + by(data, ("EC",), point="B") * v
        second = by(data, ("OA", "OA"), point="B") * u * u + by(data, ("EC", "EC"), point="B") * v * v
        second = second + 2.0 * by(data, ("OA", "EC"), point="B") * u * v
        # the dyad is nowhere near its limits: sin(transmission angle) > 0.5
        assert np.max(np.abs(first - (x.derivative(1) + 1j * y.derivative(1)))) <= 256 * EPS
        assert np.max(np.abs(second - (x.derivative(2) + 1j * y.derivative(2)))) <= 1024 * EPS


def scissors() -> ct.Mechanism:
    """A five-bar whose second motor turns one rod against the other: a group of higher class."""
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "E": [1.0, 0.0]}},
        links={
            "OA": {"length": 0.4},
            "AB": {"length": 0.6, "angle": "70 deg"},
            "CB": {"length": 0.7},
            "EC": {"length": 0.5, "angle": "91 deg"},
        },
        drives=[
            {"link": "OA", "start": 1.0, "law": "0.3*sin(t)"},
            {"link": "CB", "relative_to": "AB", "start": 1.3, "law": "-0.2*t**2"},
        ],
    )


def of_scissors(a: Any, v: Any) -> Any:
    """B by the crank's angle and that between the rods: |AC| = |w|, w = 0.6 - 0.7 e^{i v}, then C over A -> E."""
    ax, ay = M.cos(a) * 0.4, M.sin(a) * 0.4
    wx, wy = M.cos(v) * -0.7 + 0.6, M.sin(v) * -0.7
    reach = wx * wx + wy * wy
    x, y = 1.0 - ax, -ay
    squared = x * x + y * y
    along = (squared + reach - 0.25) / (squared * 2.0)
    left = M.sqrt(squared * reach - (squared + reach - 0.25) ** 2 * 0.25) / squared
    cx, cy = along * x - left * y, along * y + left * x
    return ax + (cx * wx + cy * wy) / reach * 0.6, ay + (cy * wx - cx * wy) / reach * 0.6


def test_a_group_of_higher_class_with_a_drive_between_moving_links() -> None:
    data = ct.kinematic_coefficients(scissors(), at=TIMES)
    a, v = data["drive_value"].to_numpy().T
    for p, q in ((1.0, 0.0), (0.0, 1.0), (1.0, -1.0)):
        x, y = of_scissors(Jet((a, p, 0.0)), Jet((v, q, 0.0)))
        first = by(data, ("OA",), point="B") * p + by(data, ("CB",), point="B") * q
        second = by(data, ("OA", "OA"), point="B") * p * p + by(data, ("CB", "CB"), point="B") * q * q
        second = second + 2.0 * by(data, ("OA", "CB"), point="B") * p * q
        assert np.max(np.abs(first - (x.derivative(1) + 1j * y.derivative(1)))) <= 1024 * EPS
        assert np.max(np.abs(second - (x.derivative(2) + 1j * y.derivative(2)))) <= 8192 * EPS


def rates(mechanism: ct.Mechanism, time: Array) -> tuple[Array, Array]:
    """First and second derivatives of the drives by time: (n, drives)."""
    laws = [drive.motion_law.jet(M, Jet.variable(time, 2)) for drive in mechanism.drives]
    return tuple(np.stack([law.derivative(k) + 0.0 * time for law in laws], axis=-1) for k in (1, 2))


def spherical() -> ct.Mechanism:
    """Two cranks and two rods on the sphere."""
    return ct.Mechanism(
        space="sphere",
        frame={"points": {"A": [0.0, 0.0], "D": ["80 deg", 0.0]}},
        links={
            "AB": {"length": "30 deg", "reference": ["A", "D"]},
            "BC": {"length": "70 deg"},
            "CE": {"length": "60 deg"},
            "DE": {"length": "35 deg", "reference": ["D", "A"]},
        },
        drives=[
            {"link": "AB", "start": "60 deg", "law": "sin(t)"},
            {"link": "DE", "start": "-70 deg", "speed": -0.5},
        ],
        assembly={"sides": {"C": "left"}},
    )


MECHANISMS = {
    "sphere": spherical,
    "arm": lambda: arm(True),
    "crane": crane,
    "five-bar": five_bar,
    "scissors": scissors,
    "excavator-arm": lambda: ct.example("excavator-arm"),
    "two-link-arm": lambda: ct.example("two-link-arm"),
    "five-bar-two-drives": lambda: ct.example("five-bar-two-drives"),
}


@pytest.mark.parametrize("name", MECHANISMS)
def test_they_add_up_to_velocities_and_accelerations(name: str) -> None:
    mechanism = MECHANISMS[name]()
    data = ct.kinematic_coefficients(mechanism, at=TIMES)
    motion = ct.motion(mechanism, at=TIMES)
    assert statuses(data) == statuses(motion)
    rate, second_rate = rates(mechanism, TIMES)
    for prefix, of in (("", "point"), ("angular_", "link"), ("joint_", "joint"), ("slide_", "guide")):
        if not motion.sizes.get(of):
            continue
        first = data[f"{prefix}velocity_coefficient"].to_numpy()
        second = data[f"{prefix}acceleration_coefficient"].to_numpy()
        velocity = np.einsum("nd...,nd->n...", first, rate)
        acceleration = np.einsum("nde...,nd,ne->n...", second, rate, rate)
        acceleration += np.einsum("nd...,nd->n...", first, second_rate)
        size = 1.0 + np.max(np.abs(first)) + np.max(np.abs(second))
        fast = 1.0 + np.max(np.abs(rate)) ** 2 + np.max(np.abs(second_rate))
        for found, variable in ((velocity, "velocity"), (acceleration, "acceleration")):
            expected = motion[f"{prefix}{variable}"].to_numpy()
            assert np.max(np.abs(found - expected)) <= 256 * EPS * size * fast


def test_with_one_drive_they_are_those_of_the_motion() -> None:
    mechanism = four_bar(1.0, 3.5, 3.0, 4.0)
    data, motion = ct.kinematic_coefficients(mechanism, 7), ct.motion(mechanism, 7)
    for prefix in ("", "angular_", "slide_"):
        one = motion[f"{prefix}velocity_coefficient"]
        found = data[f"{prefix}velocity_coefficient"]
        np.testing.assert_array_equal(found.isel(drive=0), one)
        assert found.attrs == one.attrs
        two = motion[f"{prefix}acceleration_coefficient"]
        found = data[f"{prefix}acceleration_coefficient"]
        np.testing.assert_array_equal(found.isel(drive=0, drive_2=0), two)
        assert found.attrs == two.attrs


def test_at_a_change_point_they_do_not_exist_and_next_to_it_they_lose_digits() -> None:
    """Rods that just stretch out: second derivatives by one drive grow as 1/h, the motion stays smooth.

    h is the height of B over AC: h^2 = 0.64 - |AC|^2/4 has its minimum by both drives there.
    """
    drives = [{"link": "OA", "start": 0.0, "speed": 1.0}, {"link": "EC", "start": np.pi, "speed": -1.0}]
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "E": [1.0, 0.0]}},
        links={"OA": {"length": 0.3}, "AB": {"length": 0.8}, "CB": {"length": 0.8}, "EC": {"length": 0.3}},
        drives=drives,
        assembly={"sides": {"B": "left"}},
    )
    at = np.pi + np.array([-0.5, -0.01, 0.0, 0.01, 0.5])
    data, motion = ct.kinematic_coefficients(mechanism, at=at), ct.motion(mechanism, at=at)
    assert statuses(motion) == ["ok"] * 5
    assert statuses(data) == ["ok", "ok", "singular", "ok", "ok"]
    assert np.isnan(data["velocity_coefficient"].to_numpy()[2]).all()
    first, second = by(data, ("OA",), point="B"), by(data, ("OA", "OA"), point="B")
    assert np.all(np.abs(second[[1, 3]]) > 10 * np.abs(second[[0, 4]]))
    velocity = first - by(data, ("EC",), point="B")
    kept = [0, 1, 3, 4]
    # the radicand h^2 is known to a few eps, so h to eps/h, and its derivative to eps/h^2 twice over
    height = 0.3 * np.abs(at - np.pi)[kept]
    error = np.abs(velocity - point(motion, "B", "velocity"))[kept]
    assert np.all(error <= 64 * EPS / height**3 + 4e-11)


def test_open_and_cut_off_samples() -> None:
    mechanism = five_bar(OA={"speed": 0.0}, EC={"speed": -1.0})
    data, motion = ct.kinematic_coefficients(mechanism, 9, 0.0, 6.0), ct.motion(mechanism, 9, 0.0, 6.0)
    assert statuses(data) == statuses(motion)


def test_what_is_asked_for_wrongly() -> None:
    with pytest.raises(ct.InputError, match="finite values"):
        ct.kinematic_coefficients(five_bar(), at=[np.nan])
    with pytest.raises(ct.InputError, match="at most"):
        ct.kinematic_coefficients(five_bar(), samples=1_000_000, stop=1.0)
