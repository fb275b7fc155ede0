"""Gears against closed forms: Willis's trains, geared five-bars, planets on couplers, many turns, bad input."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import centrode as ct
from mechanisms import EPS, link, point

Array = npt.NDArray[np.float64]


def rounding(angles: float, ratio: float = 1.0) -> float:
    """Of an angle that follows from others of this size by a ratio."""
    return 4 * EPS * (1.0 + abs(angles)) * (1.0 + abs(ratio))


def train(driven: str, fixed: str, teeth: tuple[int, int], start: dict[str, float]) -> ct.Mechanism:
    """Sun, planet, ring and carrier: one of sun, ring and carrier fixed in the frame, another driven."""
    sun, planet = teeth
    ring = sun + 2 * planet
    radius = float(sun + planet)
    links: dict[str, Any] = {
        "sun": {"points": {"O": [0, 0], "S": [float(sun), 0]}},
        "carrier": {"points": {"O": [0, 0], "P": [radius, 0]}},
        "ring": {"points": {"O": [0, 0], "R": [float(ring), 0]}},
        "planet": {"points": {"P": [0, 0], "Q": [float(planet), 0]}},
    }
    frame: dict[str, Any] = {"O": [0, 0]}
    if fixed == "carrier":
        frame["P"] = [radius, 0]
    del links[fixed]
    for name, angle in start.items():
        if name in links and name != driven:
            links[name]["angle"] = angle

    def name(wheel: str) -> str:
        return "frame" if wheel == fixed else wheel

    return ct.Mechanism(
        frame={"points": frame},
        links=links,
        gears=[
            {"links": [name("sun"), "planet"], "carrier": name("carrier"), "ratio": -sun / planet},
            {"links": ["planet", name("ring")], "carrier": name("carrier"), "ratio": planet / ring},
        ],
        drives=[{"link": driven, "start": start[driven], "speed": 1.0}],
    )


PAIRS = [
    (driven, fixed)
    for fixed in ("sun", "ring", "carrier")
    for driven in ("sun", "ring", "carrier", "planet")
    if driven != fixed
]


@pytest.mark.parametrize(("driven", "fixed"), PAIRS)
@pytest.mark.parametrize("seed", range(3))
def test_planetary_trains_obey_willis(driven: str, fixed: str, seed: int) -> None:
    """(ring - carrier) = -sun teeth / ring teeth (sun - carrier), over fifty turns and from any initial angles."""
    random = np.random.default_rng(seed)
    sun, planet = (int(n) for n in random.integers(17, 60, size=2))
    ring = sun + 2 * planet
    start = {
        name: float(x)
        for name, x in zip(("sun", "ring", "carrier", "planet"), random.uniform(-3, 3, 4), strict=True)
    }
    mechanism = train(driven, fixed, (sun, planet), start)
    span = 50 * math.tau
    data = ct.motion(mechanism, 101, start=start[driven] - span, stop=start[driven] + span)
    assert (data.status == ct.Status.OK).all()
    angles = {name: link(data, name) for name in mechanism.links} | {fixed: np.zeros(101)}
    turned = {name: angle - angle[50] for name, angle in angles.items()}
    size = max(float(np.abs(angle).max()) for angle in angles.values())
    c = turned["carrier"]
    ratio = sun / min(sun, planet)
    assert np.abs((turned["ring"] - c) * ring + sun * (turned["sun"] - c)).max() <= sun * rounding(
        size, ring / sun
    )
    assert np.abs((turned["planet"] - c) * planet + sun * (turned["sun"] - c)).max() <= sun * rounding(
        size, ratio
    )
    # places belong to the angles; the drive's angle is its value
    assert np.abs(turned[driven] - (data.drive_value[:, 0].to_numpy() - start[driven])).max() <= rounding(
        span
    )
    if "Q" in data.point:
        centre = point(data, "P")
        expected = centre + planet * np.exp(1j * angles["planet"])
        assert np.abs(point(data, "Q") - expected).max() <= ring * rounding(size)


def test_the_mesh_is_that_of_the_initial_angles() -> None:
    """Of the links that a gear could give, the ones that state an angle keep it."""
    start = {"sun": 0.4, "planet": 1.1, "carrier": -0.7, "ring": 0.0}
    data = ct.motion(train("sun", "ring", (24, 18), start), at=[0.4])
    assert abs(float(link(data, "planet")[0]) - 1.1) <= 8 * EPS
    assert abs(float(link(data, "carrier")[0]) + 0.7) <= 8 * EPS


def pair(ratio: float, **more: Any) -> ct.Mechanism:
    """A driven wheel OA and a wheel EC that it turns."""
    parts: dict[str, Any] = {
        "frame": {"points": {"O": [0, 0], "E": [3, 0]}},
        "links": {"OA": {"length": 1.0}, "EC": {"length": 1.0, "angle": 0.5}},
        "gears": [{"links": ["OA", "EC"], "ratio": ratio}],
        "drives": [{"link": "OA", "start": 0.2, "speed": 1.0}],
    }
    return ct.Mechanism(**(parts | more))


@pytest.mark.parametrize("ratio", [-1000.0, -0.001, 1000.0, 1 / 3, -math.pi, 1.0])
def test_many_turns_and_any_ratio(ratio: float) -> None:
    span = 400 * math.tau
    data = ct.motion(pair(ratio), 81, start=0.2 - span, stop=0.2 + span)
    expected = 0.5 + ratio * (data.drive_value[:, 0].to_numpy() - 0.2)
    assert np.abs(link(data, "EC") - expected).max() <= rounding(span, ratio)
    assert np.abs(link(data, "EC", "angular_velocity") - ratio).max() <= 4 * EPS * abs(ratio)


def test_the_other_wheel_may_be_driven() -> None:
    data = ct.motion(pair(-2.5, drives=[{"link": "EC", "start": 0.5, "speed": 1.0}]), 9, start=-9, stop=9)
    expected = (data.drive_value[:, 0].to_numpy() - 0.5) / -2.5
    assert np.abs(link(data, "OA") - expected).max() <= rounding(9)


def test_geared_five_bar_is_that_of_two_cranks() -> None:
    """B is where the circles about the pins of two cranks meet, one turning -2 times as fast."""
    data = ct.motion(ct.example("geared-five-bar"), 721, start=-9.0, stop=9.0)
    q = data.drive_value[:, 0].to_numpy()
    a, c = np.exp(1j * q), 4 + 1.2 * np.exp(1j * (math.pi / 3 - 2 * q))
    w = c - a
    ahead = (np.abs(w) ** 2 + 3.5**2 - 3.0**2) / (2 * np.abs(w))
    b = a + w / np.abs(w) * (ahead + 1j * np.sqrt(3.5**2 - ahead**2))
    sine = np.sqrt(3.5**2 - ahead**2) / 3.5
    assert (np.abs(point(data, "B") - b) <= 32 * EPS * 4 / sine).all()


def on_coupler(ratio: float, drive: str = "OA") -> ct.Mechanism:
    """A four-bar whose coupler carries a planet at B that meshes with a wheel fixed to the rocker."""
    return ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [4, 0]}},
        links={
            "OA": {"length": 1.0},
            "AB": {"length": 3.5},
            "DB": {"length": 3.0},
            "planet": {"points": {"A": [0, 0], "P": [0.5, 0]}, "angle": 0.3},
        },
        gears=[{"links": ["DB", "planet"], "carrier": "AB", "ratio": ratio}],
        drives=[{"link": drive, "start": 1.0, "speed": 1.0}],
        assembly={"sides": {"B": "left"}},
    )


@pytest.mark.parametrize("ratio", [-1.7, 0.37, 3.0])
def test_a_planet_on_a_coupler(ratio: float) -> None:
    """The coupler is the carrier; its own angle and the rocker's come from a dyad."""
    data = ct.motion(on_coupler(ratio), 1001, start=1.0, stop=1.0 + 40 * math.tau)
    coupler, rocker = link(data, "AB"), link(data, "DB")
    turned = (rocker - coupler) - (rocker[0] - coupler[0])
    expected = 0.3 + (coupler - coupler[0]) + ratio * turned
    assert np.abs(link(data, "planet") - expected).max() <= 64 * rounding(4.0, ratio)
    arm = point(data, "P") - point(data, "A")
    assert np.abs(arm - 0.5 * np.exp(1j * link(data, "planet"))).max() <= 64 * rounding(4.0, ratio)


def test_a_drag_link_counts_the_turns_of_its_follower() -> None:
    """The follower of a drag link turns with its crank: an angle from a dyad with as many turns as the drive."""
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [1, 0]}},
        links={
            "OA": {"length": 3.0},
            "AB": {"length": 2.5},
            "DB": {"length": 2.8},
            "wheel": {"points": {"D": [0, 0], "W": [1, 0]}, "angle": 0.0},
        },
        gears=[{"links": ["DB", "wheel"], "ratio": 0.3}],
        drives=[{"link": "OA", "start": 1.0, "speed": 1.0}],
        assembly={"sides": {"B": "left"}},
    )
    data = ct.motion(mechanism, 401, start=1.0 - 20 * math.tau, stop=1.0 + 20 * math.tau)
    follower, wheel = link(data, "DB"), link(data, "wheel")
    assert abs(follower[-1] - follower[0] - 40 * math.tau) <= rounding(20 * math.tau)
    assert np.abs((wheel - wheel[200]) - 0.3 * (follower - follower[200])).max() <= rounding(20 * math.tau)


def test_a_value_is_the_same_bits_in_any_company() -> None:
    mechanism = on_coupler(0.37)
    whole = ct.motion(mechanism, 301, start=-60.0, stop=60.0)
    for k in (0, 17, 149, 150, 300):
        alone = ct.motion(mechanism, at=[float(whole.drive_value[k, 0])])
        for name in ("position", "angle", "angular_acceleration", "residual"):
            np.testing.assert_array_equal(alone[name][0], whole[name][k])


def test_a_batch_is_its_mechanisms_one_by_one() -> None:
    """A batch keeps the mesh of the description: constants of the angles, whatever the ratios."""
    mechanism = pair(-2.0)
    ratios = [-2.0, -1.5, 4.0]
    batch = ct.motion(mechanism, 25, start=-50, stop=50, vary={"gears.OA-EC.ratio": ratios})
    constant = 0.5 - -2.0 * 0.2
    for k, ratio in enumerate(ratios):
        expected = constant + ratio * batch.drive_value[:, 0].to_numpy()
        assert np.abs(batch.angle.sel(link="EC")[k] - expected).max() <= rounding(50, ratio)
    coupler = on_coupler(0.37)
    batch = ct.motion(coupler, 25, start=-50, stop=50, vary={"links.AB.length": [3.5, 3.5]})
    alone = ct.motion(coupler, 25, start=-50, stop=50)
    for k in range(2):
        np.testing.assert_array_equal(batch.angle[k], alone.angle)


def test_a_gear_that_closes_a_loop_of_gears_is_checked() -> None:
    """Three wheels on the frame, each meshing with the others: the third gear repeats, and has to fit."""
    links = {
        name: {"points": {p: [0, 0], p + "'": [1, 0]}} for name, p in (("a", "O"), ("b", "E"), ("c", "F"))
    }
    gears = [
        {"links": ["a", "b"], "ratio": -2.0},
        {"links": ["b", "c"], "ratio": -3.0},
        {"links": ["a", "c"], "ratio": 6.0},
    ]
    parts: dict[str, Any] = {
        "frame": {"points": {"O": [0, 0], "E": [2, 0], "F": [4, 0]}},
        "links": links,
        "drives": [{"link": "a", "start": 0.0, "speed": 1.0}],
    }
    fitting = ct.check(ct.Mechanism(**parts, gears=gears))
    assert fitting.redundant == ("gear a-c",)
    gears[2]["ratio"] = 5.0
    with pytest.raises(ct.InputError, match=r"the mobility \(by rank\) is 0"):
        ct.check(ct.Mechanism(**parts, gears=gears))


def test_gears_that_lock_are_told() -> None:
    """With the ratio 1 the carrier of a fixed wheel has no angle that follows."""
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1.0}, "wheel": {"points": {"O": [0, 0], "W": [1, 0]}}},
        gears=[{"links": ["frame", "wheel"], "carrier": "OA", "ratio": 1.0}],
        drives=[{"link": "wheel", "start": 0.0, "speed": 1.0}],
    )
    with pytest.raises(ct.InputError, match="block each other or leave an angle undetermined"):
        ct.check(mechanism)


def test_a_ratio_of_zero_is_refused() -> None:
    with pytest.raises(ct.InputError, match="ratio must not be zero"):
        pair(0.0)
    with pytest.raises(ct.InputError, match="ratio must not be zero"):
        ct.motion(pair(2.0), 3, vary={"gears.OA-EC.ratio": [1.0, 0.0]})
