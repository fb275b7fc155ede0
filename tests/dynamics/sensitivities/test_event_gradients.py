"""Derivatives of motions through events: against closed forms, and differences of whole motions."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

import centrode as ct
from central_differences import STEP, directions, moved_along
from centrode.dynamics.forward_dynamics.trajectory import Trajectory
from centrode.dynamics.sensitivities.motion_gradients import MotionGradients, motion_gradients
from centrode.dynamics.simulation.multibody_motion import multibody_setting

ROD = {"shape": "rod"}
GRAVITY = 9.81


def bouncing_mass(**parts: object) -> ct.Mechanism:
    """A mass that falls from 1 m onto a floor at 0.1 m, with restitution 0.7."""
    given: dict[str, object] = {
        "gravity": [0, -GRAVITY],
        "frame": {"points": {"O": [0, 0]}},
        "links": {"mass": {"points": {"B": [0, 0]}, "mass": 1}},
        "guides": [{"point": "B", "on": "frame", "through": "O", "direction": [0, 1], "link": "mass"}],
        "drives": [{"guide": "B", "start": 1.0}],
        "stops": [{"name": "floor", "guide": "B", "least": 0.1, "restitution": 0.7}],
        "simulation": {"duration": 1.5, "tolerance": 1e-12},
    }
    return ct.Mechanism(**(given | parts))


def gradients_of(mechanism: ct.Mechanism, paths: Sequence[str], times: Sequence[float]) -> MotionGradients:
    assert mechanism.simulation is not None
    return motion_gradients(mechanism, mechanism.simulation, paths, np.array(times))


def course_of(mechanism: ct.Mechanism, times: Sequence[float]) -> Trajectory:
    assert mechanism.simulation is not None
    return multibody_setting(mechanism, mechanism.simulation).run(np.array(times))


def test_instants_of_impacts_change_as_the_closed_form_of_a_bouncing_mass_says():
    # t_n = sqrt(2 h / g) (1 + 2 (e + ... + e^(n - 1)))
    paths = ["drives.B.start", "stops.floor.restitution", "gravity.y", "stops.floor.least", "links.mass.mass"]
    found = gradients_of(bouncing_mass(), paths, [0.0, 1.5])
    height, e = 0.9, 0.7
    first = math.sqrt(2 * height / GRAVITY)
    events = found.motion.events
    assert [one.event.kind for one in events] == ["impact"] * 3
    for n, one in enumerate(events, start=1):
        time = first * (1 + 2 * sum(e**k for k in range(1, n)))
        by_height, by_gravity = time / 2 / height, time / 2 / GRAVITY
        by_restitution = first * 2 * sum(k * e ** (k - 1) for k in range(1, n))
        exact = [by_height, by_restitution, by_gravity, -by_height, 0.0]
        assert np.allclose(one.time_changes, exact, atol=1e-11)
        # the place at an impact is that of the floor, whatever else changes
        assert np.allclose(one.coordinate_changes[:, 0], [0, 0, 0, 1, 0], atol=1e-11)
    # the speed behind three impacts at 1.5 s, by the height: e^3 v0' less g t'
    speed_behind = e**3 * math.sqrt(2 * GRAVITY * height)
    time = first * (1 + 2 * (e + e * e))
    exact_speed = speed_behind / 2 / height + GRAVITY * time / 2 / height
    assert abs(found.motion.speed_changes[-1, 0, 0] - exact_speed) < 1e-11


def test_a_clamp_that_lets_go_later_moves_all_that_follows():
    clamped = bouncing_mass(clamps=[{"name": "hand", "guide": "B", "until": 0.2}])
    found = gradients_of(clamped, ["clamps.hand.until"], [0.1, 0.3, 1.5])
    assert np.allclose([one.time_changes[0] for one in found.motion.events], 1.0, atol=1e-11)
    assert abs(found.motion.coordinate_changes[0, 0, 0]) < 1e-14
    # falling for 0.1 s: a later release by dt leaves it g t dt higher
    assert abs(found.motion.coordinate_changes[1, 0, 0] - GRAVITY * 0.1) < 1e-11


def test_a_block_that_slides_to_rest_stops_where_its_energy_ends():
    # x = v^2 / (2 F / m), t = v m / F
    sledge = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"block": {"points": {"P": [0, 0]}, "mass": 2}},
        guides=[{"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "block"}],
        drives=[{"guide": "P", "start": 0}],
        loads=[{"kind": "friction", "guide": "P", "value": 3}],
        simulation={"duration": 2.0, "tolerance": 1e-12, "speed": 1.5, "equations": "multibody"},
    )
    found = gradients_of(sledge, ["simulation.speed", "loads.friction P.value", "links.block.mass"], [2.0])
    (stick,) = found.motion.events
    assert stick.event.kind == "sticks"
    assert np.allclose(stick.time_changes, [2 / 3, -1.5 * 2 / 9, 0.5], atol=1e-10)
    rest = [1.5 * 2 / 3, -(1.5**2) * 2 / 2 / 9, 1.5**2 / 6]
    assert np.allclose(found.motion.coordinate_changes[0, :, 0], rest, atol=1e-10)
    assert np.allclose(found.motion.speed_changes[0], 0.0, atol=1e-10)


def slider_crank(**parts: object) -> ct.Mechanism:
    given: dict[str, object] = {
        "gravity": [0, -GRAVITY],
        "frame": {"points": {"O": [0, 0]}},
        "links": {
            "OA": {"length": 0.1, "mass": 0.2, **ROD},
            "AB": {"length": 0.3, "mass": 0.5, **ROD},
            "slider": {"points": ["B"], "mass": 1},
        },
        "guides": [{"point": "B", "on": "frame", "through": "O", "direction": [1, 0], "link": "slider"}],
        "drives": [{"link": "OA", "start": "60 deg", "speed": 1}],
        "assembly": {"sides": {"B": "ahead"}},
        "simulation": {"duration": 1.0, "equations": "multibody"},
    }
    return ct.Mechanism(**(given | parts))


STOPPED = slider_crank(stops=[{"name": "end", "guide": "B", "most": 0.38, "restitution": 0.5}])
SPRUNG = slider_crank(
    stops=[{"name": "end", "guide": "B", "most": 0.38, "stiffness": "20 kN/m", "damping": 30}]
)
STICK_SLIP = slider_crank(
    gravity=None,
    drives=[{"link": "OA", "start": "90 deg", "speed": 1}],
    loads=[
        {"kind": "spring", "link": "OA", "stiffness": 1.5, "free_angle": "90 deg"},
        {"kind": "friction", "guide": "B", "value": 3, "static": 4.5, "surface_speed": 0.1},
    ],
    simulation={"duration": 2.0, "equations": "multibody"},
)
PENDULUM = ct.Mechanism(
    gravity=[0, -GRAVITY],
    frame={"points": {"O": [0, 0]}},
    links={
        "OA": {"length": 1, "mass": 1, "angle": -1.8, **ROD},
        "AB": {"length": 1, "mass": 1, "angle": -2.4, **ROD},
    },
    stops=[{"name": "wall", "point": "B", "direction": [1, 0], "most": 0.6, "restitution": 0.6}],
    loads=[{"kind": "friction", "link": "OA", "value": 0.4, "static": 0.5}],
    simulation={"duration": 2.0},
)
TWO_STUCK = ct.Mechanism(
    frame={"points": {"O": [0, 0]}},
    links={"one": {"points": {"P": [0, 0]}, "mass": 1}, "two": {"points": {"Q": [0, 0]}, "mass": 2}},
    guides=[
        {"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "one"},
        {"point": "Q", "on": "one", "through": [0, 0], "direction": [1, 0], "link": "two"},
    ],
    drives=[{"guide": "P", "start": 0}, {"guide": "Q", "start": 0.1}],
    loads=[
        {"kind": "force", "guide": "P", "value": "20*sin(5*t)"},
        {"kind": "friction", "guide": "Q", "value": 6, "static": 7},
    ],
    simulation={"duration": 2.0},
)
HELD = ct.Mechanism(
    gravity=[0, -GRAVITY],
    frame={"points": {"O": [0, 0]}},
    links={"OA": {"length": "0.6 m", "mass": "2 kg", "angle": 0, **ROD}},
    drives=[{"link": "OA", "start": 0}],
    controllers=[
        {"name": "hold", "drive": "OA", "target": "0.5", "proportional": 60, "integral": 40, "derivative": 12}
    ],
    stops=[{"name": "end", "link": "OA", "most": 0.4, "restitution": 0.4}],
    simulation={"duration": 1.0},
)


@pytest.mark.parametrize(
    ("mechanism", "paths", "times", "kinds"),
    [
        (
            STOPPED,
            (
                "links.AB.length",
                "stops.end.most",
                "stops.end.restitution",
                "links.slider.mass",
                "drives.OA.start",
            ),
            (0.2, 0.3, 0.5, 0.9),
            {"impact", "comes to rest"},
        ),
        (
            SPRUNG,
            ("stops.end.stiffness", "stops.end.damping", "stops.end.most", "links.OA.length"),
            (0.2, 0.3, 0.8),
            {"touches", "leaves"},
        ),
        (
            STICK_SLIP,
            (
                "loads.friction B.value",
                "loads.friction B.static",
                "loads.friction B.surface_speed",
                "loads.spring OA.stiffness",
                "links.AB.length",
            ),
            (0.1, 0.7, 1.3, 2.0),
            {"sticks", "slips"},
        ),
        (
            PENDULUM,
            ("links.AB.length", "stops.wall.restitution", "loads.friction OA.value", "links.OA.mass"),
            (0.5, 1.0, 1.5),
            {"impact"},
        ),
        (TWO_STUCK, ("links.two.mass", "loads.friction Q.value", "loads.friction Q.static"), (0.5, 1.9), {"slips"}),
        (HELD, ("links.OA.mass", "stops.end.restitution"), (0.1, 0.9), {"impact"}),
    ],
    ids=("stop", "compliant stop", "belt", "wall and friction", "two blocks", "controller"),
)  # fmt: skip
def test_derivatives_are_those_of_differences(
    mechanism: ct.Mechanism, paths: tuple[str, ...], times: tuple[float, ...], kinds: set[str]
) -> None:
    assert mechanism.simulation is not None
    tight = mechanism.simulation.model_copy(update={"tolerance": 1e-13})
    described = mechanism.model_copy(update={"simulation": tight})
    found = gradients_of(described, paths, times)
    assert kinds <= {one.event.kind for one in found.motion.events}
    for along in directions(described, paths):
        moved = {j: course_of(moved_along(described, paths, j * along), times) for j in (-2, -1, 1, 2)}
        assert len({len(one.events) for one in moved.values()}) == 1

        def differences(of: object, moved=moved) -> np.ndarray:
            one, two = (of(moved[j]) - of(moved[-j]) for j in (1, 2))
            return (8 * one - two) / 12

        for own, of in (
            (found.motion.coordinate_changes, lambda course: course.coordinates),
            (found.motion.speed_changes, lambda course: course.speeds),
            (found.position, lambda course: course.places),
            (found.velocity, lambda course: course.velocities),
        ):
            difference = differences(of) / STEP
            scale = max(float(np.abs(difference).max()), 1e-2)
            expected = np.tensordot(np.moveaxis(own, 1, -1), along / STEP, 1)
            assert np.abs(difference - expected).max() < 1e-8 * scale, along
        # instants of fast events; those of ever smaller impacts are known to as much as their rounding over their speed
        instants = differences(lambda course: np.array([event.time for event in course.events]))[:5] / STEP
        own_times = np.array([one.time_changes for one in found.motion.events])[:5] @ along / STEP
        assert np.abs(instants - own_times).max() < 5e-8 * max(float(np.abs(instants).max()), 1e-2), along


def test_what_has_no_derivative_is_named() -> None:
    with pytest.raises(ct.InputError, match="does not depend on it"):
        gradients_of(bouncing_mass(), ["simulation.duration"], [1.5])
    twice = bouncing_mass(
        links={"one": {"points": {"B": [0, 0]}, "mass": 1}, "two": {"points": {"C": [0, 0]}, "mass": 1}},
        guides=[
            {"point": "B", "on": "frame", "through": "O", "direction": [0, 1], "link": "one"},
            {"point": "C", "on": "frame", "through": "O", "direction": [0, 1], "link": "two"},
        ],
        drives=[{"guide": "B", "start": 1.0}, {"guide": "C", "start": 1.0}],
        stops=[
            {"name": "floor", "guide": "B", "least": 0.1, "restitution": 0.7},
            {"name": "ground", "guide": "C", "least": 0.1, "restitution": 0.7},
        ],
    )
    # both fall alike with another gravity, and part with another height of one
    assert len(gradients_of(twice, ["gravity.y"], [0.5]).motion.events) == 6
    with pytest.raises(ct.MotionError, match="two things happen at once"):
        gradients_of(twice, ["drives.B.start"], [0.5])


def test_a_dataset_has_the_derivatives_of_its_events() -> None:
    mass = bouncing_mass()
    run = ct.simulate(mass, gradients=["drives.B.start", "stops.floor.restitution"])
    speeds = run.occasion_point_speed.sel(point="B", axis="y").values
    # v = sqrt(2 g h) before the first impact, e times as much before the second
    fast = math.sqrt(2 * GRAVITY * 0.9)
    assert np.allclose(speeds[:2], [-fast, -0.7 * fast], atol=1e-10)
    slopes = run.occasion_point_speed_gradient.sel(point="B", axis="y").values
    assert np.allclose(slopes[:2], [[-GRAVITY / fast, 0], [-0.7 * GRAVITY / fast, -fast]], atol=1e-10)
