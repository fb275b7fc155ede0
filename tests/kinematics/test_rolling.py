"""Rolling wheels against closed forms: trochoids over many turns, instant centres, wheels on moving links."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import centrode as ct
from mechanisms import EPS, link, point

Array = npt.NDArray[np.float64]
TURNS = 50


def at_contact(data: Any, wheel: str) -> npt.NDArray[np.complex128]:
    xy = data["contact"].sel(rolling=wheel).to_numpy()
    return np.asarray(xy[..., 0] + 1j * xy[..., 1])


def on_circle(circle: float, wheel: float, inside: bool, start: float = 0.3, **more: Any) -> ct.Mechanism:
    """A wheel on the pin of a crank that rolls on a fixed circle about the crank's pivot; P on its rim, Q within."""
    arm = abs(circle - wheel) if inside else circle + wheel
    parts: dict[str, Any] = {
        "frame": {"points": {"O": [1.0, -2.0]}},
        "links": {
            "OA": {"length": arm},
            "wheel": {"points": {"A": [0, 0], "P": [wheel, 0], "Q": [0, 0.4 * wheel]}, "angle": 0.7},
        },
        "rolling": [
            {
                "link": "wheel",
                "centre": "A",
                "radius": wheel,
                "along": {"centre": "O", "radius": circle, "inside": inside},
            }
        ],
        "drives": [{"link": "OA", "start": start, "speed": 1.0}],
    }
    return ct.Mechanism(**(parts | more))


CIRCLES = [
    (3.0, 1.0, True),
    (2.0, 1.0, True),
    (5.0, 1.9, True),
    (1.0, 2.5, True),
    (2.0, 0.7, False),
    (0.8, 2.2, False),
]


@pytest.mark.parametrize(("circle", "wheel", "inside"), CIRCLES)
def test_trochoids_over_fifty_turns(circle: float, wheel: float, inside: bool) -> None:
    """Epi-, hypo- and pericycloids: the wheel turns by (R + r)/r or -(R - r)/r of the crank's angle."""
    mechanism = on_circle(circle, wheel, inside)
    span = TURNS * math.tau
    data = ct.motion(mechanism, 501, start=0.3 - span, stop=0.3 + span)
    q = data.drive_value[:, 0].to_numpy()
    spin = -(circle - wheel) / wheel if inside else (circle + wheel) / wheel
    turned = 0.7 + spin * (q - 0.3)
    # the crank's angle is rounded to its own size, and so is that of the wheel
    allowed = 4 * EPS * (1 + np.abs(q)) * (1 + abs(spin))
    assert (np.abs(link(data, "wheel") - turned) <= allowed).all()
    arm = abs(circle - wheel) if inside else circle + wheel
    centre = 1 - 2j + arm * np.exp(1j * q)
    assert (
        np.abs(point(data, "P") - (centre + wheel * np.exp(1j * turned))) <= (arm + wheel) * allowed
    ).all()
    assert np.abs(link(data, "wheel", "angular_velocity") - spin).max() <= 64 * EPS * abs(spin)
    far = -1.0 if inside and wheel > circle else 1.0
    contact = at_contact(data, "wheel")
    assert (np.abs(contact - (1 - 2j + far * circle * np.exp(1j * q))) <= (arm + circle) * allowed).all()
    for name in (
        "PQ"
    ):  # the contact is the instant centre: every velocity is square to its arm and omega times as long
        expected = 1j * link(data, "wheel", "angular_velocity") * (point(data, name) - contact)
        assert (
            np.abs(point(data, name, "velocity") - expected).max()
            <= 64 * (arm + circle) * abs(spin) * EPS * span
        )


def test_cardan_circles_draw_a_straight_line() -> None:
    """R = 2 r: every point of the rim moves along a diameter."""
    data = ct.motion(on_circle(2.0, 1.0, True), 721, start=0.3, stop=0.3 + TURNS * math.tau)
    p = point(data, "P") - (1 - 2j)
    heading = np.exp(0.5j * (0.3 + 0.7))
    assert np.abs((p * np.conj(heading)).imag).max() <= 8 * EPS * TURNS * math.tau
    assert np.abs(p).max() <= 2 * (1 + 8 * EPS)


def cycloid(heading: float, **more: Any) -> ct.Mechanism:
    """A wheel on a line through (0.5, 1) of any heading, rolled by its own angle."""
    parts: dict[str, Any] = {
        "frame": {"points": {"O": [0, 0]}},
        "links": {"wheel": {"points": {"C": [0, 0], "P": [0.4, 0]}}},
        "rolling": [
            {
                "link": "wheel",
                "centre": "C",
                "radius": 0.4,
                "along": {"through": [0.5, 1.0], "direction": heading},
            }
        ],
        "drives": [{"link": "wheel", "start": 0.2, "speed": -1.0}],
    }
    return ct.Mechanism(**(parts | more))


@pytest.mark.parametrize("heading", [0.0, 2.0, -1.3])
def test_a_wheel_driven_by_its_own_angle(heading: float) -> None:
    """It starts over the line's own point and runs r for a radian, against the line's direction if it turns left."""
    data = ct.motion(cycloid(heading), 401, start=0.2 + TURNS * math.tau, stop=0.2 - TURNS * math.tau)
    q = data.drive_value[:, 0].to_numpy()
    along = np.exp(1j * heading)
    foot = 0.5 + 1j - 0.4 * (q - 0.2) * along
    allowed = 4 * EPS * (1 + np.abs(q)) * 2
    assert (np.abs(at_contact(data, "wheel") - foot) <= allowed).all()
    expected = foot + 0.4j * along + 0.4 * np.exp(1j * q)
    assert (np.abs(point(data, "P") - expected) <= allowed).all()


def test_a_wheel_whose_axle_is_driven_draws_a_cycloid() -> None:
    data = ct.motion(ct.example("rolling-wheel-rod"), 401, start=-90.0, stop=90.0)
    u = data.drive_value[:, 0].to_numpy() / 0.3
    cycloid = 0.3 * (u + np.sin(u)) + 0.3j * (1 + np.cos(u))
    allowed = 4 * EPS * (1 + np.abs(u))
    assert (np.abs(point(data, "P") - cycloid) <= allowed).all()
    assert (np.abs(link(data, "wheel") - (math.pi / 2 - u)) <= allowed).all()
    assert (
        np.abs(point(data, "P", "velocity_coefficient") - (1 + np.cos(u) - 1j * np.sin(u))) <= 4 * allowed
    ).all()


@pytest.mark.parametrize("driven", ["pinion", "rack"])
def test_rack_and_pinion(driven: str) -> None:
    drive = {"link": "pinion", "start": 0.0} if driven == "pinion" else {"guide": "H", "start": 0.0}
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"pinion": {"points": {"O": [0, 0], "M": [0.5, 0]}}, "rack": {"points": {"H": [0, 0], "E": [1, 0]}}},
        guides=[{"point": "H", "through": [0, -0.5], "direction": [1, 0], "link": "rack"}],
        rolling=[{"link": "pinion", "centre": "O", "radius": 0.5, "on": "rack",
                  "along": {"through": [0, 0], "direction": [1, 0]}}],
        drives=[{**drive, "speed": 1.0}],
    )  # fmt: skip
    data = ct.motion(mechanism, 101, start=-80.0, stop=80.0)
    value = data.drive_value[:, 0].to_numpy()
    allowed = 4 * EPS * (1 + np.abs(value)) * 2
    assert (np.abs(point(data, "H").real - 0.5 * link(data, "pinion")) <= allowed).all()
    assert (
        np.abs((link(data, "pinion") if driven == "pinion" else point(data, "H").real) - value) <= allowed
    ).all()
    assert np.abs(at_contact(data, "pinion") + 0.5j).max() <= 4 * EPS


def rocker_with_wheel() -> ct.Mechanism:
    """A wheel that rolls along the rocker of a four-bar; a rod from the frame holds its centre."""
    return ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [4, 0], "F": [4.8, 2.2]}},
        links={
            "OA": {"length": 1.0},
            "AB": {"length": 3.5},
            "DB": {"length": 3.0},
            "FC": {"length": 2.4},
            "wheel": {"points": {"C": [0, 0], "W": [0.5, 0]}, "angle": 0.4},
        },
        rolling=[{"link": "wheel", "centre": "C", "radius": 0.5, "on": "DB",
                  "along": {"through": [0, 0], "direction": [-1, 0]}}],
        drives=[{"link": "OA", "start": 0.6, "speed": 1.0}],
        assembly={"sides": {"B": "left", "C": "behind"}},
    )  # fmt: skip


def test_a_wheel_on_a_moving_line() -> None:
    """Centre, angle and contact from the rocker's own motion, by the law of no slip."""
    data = ct.motion(rocker_with_wheel(), 201, start=0.6, stop=0.6 + 10 * math.tau)
    assert (data.status == ct.Status.OK).all()
    rocker, d = link(data, "DB"), 4.0 + 0j
    centre = (point(data, "C") - d) * np.exp(
        -1j * rocker
    )  # in the rocker's axes: below its axis, as it runs backwards
    assert np.abs(centre.imag + 0.5).max() <= 64 * EPS
    assert np.abs(np.abs(point(data, "C") - (4.8 + 2.2j)) - 2.4).max() <= 64 * EPS
    turned = link(data, "wheel") - rocker
    assert np.abs((turned - turned[0]) - (centre.real - centre.real[0]) / 0.5).max() <= 256 * EPS
    contact = at_contact(data, "wheel")
    assert np.abs(contact - (d + centre.real * np.exp(1j * rocker))).max() <= 256 * EPS
    # both bodies have one velocity there
    of_wheel = point(data, "C", "velocity") + 1j * link(data, "wheel", "angular_velocity") * (
        contact - point(data, "C")
    )
    of_rocker = 1j * link(data, "DB", "angular_velocity") * (contact - d)
    assert np.abs(of_wheel - of_rocker).max() <= 1024 * EPS


def test_two_wheels_roll_on_each_other() -> None:
    """Both on one crank: against the crank they turn like gears."""
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={
            "arm": {"points": {"O": [0, 0], "A": [1, 0], "B": [3, 0]}},
            "first": {"points": {"A": [0, 0], "P": [0.8, 0]}, "angle": 0.1},
            "second": {"points": {"B": [0, 0], "Q": [1.2, 0]}, "angle": 0.2},
        },
        rolling=[
            {"link": "first", "centre": "A", "radius": 0.8, "along": {"centre": "O", "radius": 0.2}},
            {
                "link": "second",
                "centre": "B",
                "radius": 1.2,
                "on": "first",
                "along": {"centre": "A", "radius": 0.8},
            },
        ],
        drives=[{"link": "arm", "start": 0.0, "speed": 1.0}],
    )
    assert ct.check(mechanism).redundant == ("contact of wheel first", "contact of wheel second")
    data = ct.motion(mechanism, 301, start=0.0, stop=TURNS * math.tau)
    q = data.drive_value[:, 0].to_numpy()
    first = 0.1 + q * (0.2 + 0.8) / 0.8
    second = 0.2 + q - (first - 0.1 - q) * 0.8 / 1.2
    allowed = 16 * EPS * (1 + q)
    assert (np.abs(link(data, "first") - first) <= allowed).all()
    assert (np.abs(link(data, "second") - second) <= 2 * allowed).all()
    assert (np.abs(at_contact(data, "second") - 1.8 * np.exp(1j * q)) <= 2 * allowed).all()


def test_a_wheel_turns_its_arm() -> None:
    """The planet is driven by its own angle; the arm follows from rolling."""
    mechanism = on_circle(3.0, 1.0, True, drives=[{"link": "wheel", "start": 0.7, "speed": 1.0}])
    data = ct.motion(mechanism, 101, start=0.7 - 90, stop=0.7 + 90)
    expected = (data.drive_value[:, 0].to_numpy() - 0.7) / -2.0
    assert np.abs(link(data, "OA") - expected).max() <= 4 * EPS * 90


def test_a_lever_rests_on_an_eccentric() -> None:
    """A flat lever on a fixed pivot over a round eccentric: its line keeps a radius from the centre."""
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [3, 0]}},
        links={
            "OC": {"points": {"O": [0, 0], "C": [0.4, 0]}},
            "roller": {"points": {"C": [0, 0], "W": [0.3, 0]}, "angle": 0.0},
            "lever": {"points": {"D": [0, 0], "E": [-4, 0]}},
        },
        rolling=[{"link": "roller", "centre": "C", "radius": 0.5, "on": "lever",
                  "along": {"through": [0, 0], "direction": [1, 0]}}],
        drives=[{"link": "OC", "start": 0.0, "speed": 1.0}],
        assembly={"sides": {"roller": "behind"}},
    )  # fmt: skip
    data = ct.motion(mechanism, 181, start=0.0, stop=6 * math.tau)
    c = 0.4 * np.exp(1j * data.drive_value[:, 0].to_numpy())
    across = (c - 3.0) * np.exp(-1j * link(data, "lever"))
    assert np.abs(across.imag - 0.5).max() <= 64 * EPS
    assert across.real.max() < 0.0
    turned = link(data, "roller") - link(data, "lever")
    assert np.abs((turned - turned[0]) + (across.real - across.real[0]) / 0.5).max() <= 128 * EPS


def test_a_value_is_the_same_bits_in_any_company() -> None:
    for mechanism in (rocker_with_wheel(), on_circle(5.0, 1.9, True)):
        whole = ct.motion(mechanism, 301, start=-60.0, stop=60.0)
        for k in (0, 17, 149, 150, 300):
            alone = ct.motion(mechanism, at=[float(whole.drive_value[k, 0])])
            for name in ("position", "angle", "angular_acceleration", "contact", "residual"):
                np.testing.assert_array_equal(alone[name][0], whole[name][k])


def test_a_batch_is_its_mechanisms_one_by_one() -> None:
    mechanism = rocker_with_wheel()
    vary = {"rolling.wheel.radius": [0.5, 0.45], "links.AB.length": [3.5, 3.5]}
    batch = ct.motion(mechanism, 61, start=-20.0, stop=20.0, vary=vary)
    alone = ct.motion(mechanism, 61, start=-20.0, stop=20.0)
    for name in ("position", "angle", "angular_velocity", "contact"):
        np.testing.assert_array_equal(batch[name][0], alone[name])
    assert (batch.status == ct.Status.OK).all()
    assert float(batch.residual.max()) < 1e-13


def test_a_wheel_that_does_not_touch_is_told_by_how_much() -> None:
    links = {"OA": {"length": 2.1}, "wheel": {"points": {"A": [0, 0], "P": [1, 0]}}}
    with pytest.raises(
        ct.InputError, match=r"does not touch .* 0\.1 m too far away; correct the radii; inside = true"
    ):
        ct.check(on_circle(3.0, 1.0, True, links=links))
    links["OA"] = {"length": 3.9}
    with pytest.raises(ct.InputError, match=r"0\.1 m too near"):
        ct.check(on_circle(3.0, 1.0, False, links=links))
    with pytest.raises(
        ct.InputError, match=r"0\.1 m too far away; .* its direction has the wheel's centre on its left"
    ):
        ct.check(
            cycloid(
                0.0,
                guides=[{"point": "C", "through": [0.0, 1.5], "direction": [1, 0]}],
                drives=[{"guide": "C", "start": 0.0, "speed": 1.0}],
            )
        )


def test_a_wheel_that_comes_off_its_track_is_refused() -> None:
    """A guide that only crosses the parallel of the track leaves nothing to move."""
    mechanism = cycloid(
        0.0,
        guides=[{"point": "C", "through": [0.5, 1.4], "direction": [1, 0.2]}],
        drives=[{"guide": "C", "start": 0.0, "speed": 1.0}],
    )
    with pytest.raises(ct.InputError, match=r"mobility \(by rank\) is 0"):
        ct.check(mechanism)
