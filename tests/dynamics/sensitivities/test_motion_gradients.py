"""Derivatives of motions by numbers and initial values against differences of whole motions."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct
from central_differences import STEP, directions, moved_along
from free_motions import FIVE_BAR, SPHERICAL_FOUR_BAR

AT = [0.0, 0.3, 0.6]
PAIRS = {
    "position": "position_gradient",
    "velocity": "point_speed_gradient",
    "generalised_coordinate": "coordinate_gradient",
    "generalised_velocity": "speed_gradient",
}


def settings(mechanism: ct.Mechanism, **more: object) -> ct.Simulation:
    assert mechanism.simulation is not None
    return mechanism.simulation.model_copy(update={"tolerance": 1e-13, "equations": "multibody", **more})


@pytest.mark.parametrize(
    ("text", "paths"),
    [
        (
            FIVE_BAR,
            (
                "links.BC.length",
                "links.ED.mass",
                "loads.spring C-F.stiffness",
                "drives.AB.start",
                "frame.points.E.x",
            ),
        ),
        (SPHERICAL_FOUR_BAR, ("links.BC.length", "simulation.speed")),
    ],
)
def test_derivatives_are_those_of_differences(text: str, paths: tuple[str, ...]) -> None:
    mechanism = ct.parse_mechanism(text)
    used = settings(mechanism)
    described = mechanism.model_copy(update={"simulation": used})
    run = ct.simulate(described, at=AT, gradients=paths)
    for along in directions(described, paths):
        moved = {j: ct.simulate(moved_along(described, paths, j * along), at=AT) for j in (-2, -1, 1, 2)}
        for name, gradient in PAIRS.items():
            one, two = (moved[j][name].values - moved[-j][name].values for j in (1, 2))
            difference = (8 * one - two) / (12 * STEP)
            scale = max(float(np.abs(difference).max()), 1e-3)
            expected = np.tensordot(along / STEP, run[gradient].transpose("number", ...).values, 1)
            assert np.abs(difference - expected).max() < 1e-8 * scale, (along, name)


def test_an_optimal_throw_follows_from_the_derivative() -> None:
    # a rod that swings from rest: the height at which its tip passes the vertical is where it can be, so its speed
    # there is greatest with the shortest rod; the derivative of the tip's speed by the mass is nothing
    rod = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0}},
        simulation={"duration": 0.5, "tolerance": 1e-12, "equations": "multibody"},
    )
    run = ct.simulate(rod, at=[0.5], gradients=["links.OA.mass", "links.OA.length"])
    assert np.abs(run.coordinate_gradient.values[0, 0]).max() < 1e-12
    # the motion depends on g / l alone: dq/dl = -(t / 2 l) dq/dt
    speed = float(run.generalised_velocity[0, 0])
    assert abs(float(run.coordinate_gradient[0, 1, 0]) + 0.25 * speed) < 1e-10


def test_refusals_say_why() -> None:
    mechanism = ct.parse_mechanism(FIVE_BAR)
    with pytest.raises(ct.InputError, match="no"):
        ct.simulate(mechanism, settings(mechanism), at=AT, gradients=["links.XY.length"])
    machine = ct.example("six-bar-press-run-up")
    with pytest.raises(ct.InputError, match="all links"):
        ct.simulate(machine, at=[0.1], gradients=["links.OA.length"])


def test_parameter_studies_keep_last_values_and_extremes() -> None:
    rod = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0}},
        simulation={"duration": 2.0, "tolerance": 1e-11, "samples": 101},
    )
    found = ct.sweep(rod, {"links.OA.length": [0.8, 1.0]}, compute="simulate")
    # it swings to the other side, which lies between two samples
    assert np.allclose(found["least_OA"].values, -np.pi, atol=1e-8)
    assert np.allclose(found["greatest_OA"].values, 0.0, atol=1e-8)
    ratio = found["least_OA_at"].values[0] / found["least_OA_at"].values[1]
    assert abs(ratio - np.sqrt(0.8)) < 1e-7


def test_parameter_studies_keep_when_a_stop_is_met() -> None:
    rod = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0}},
        stops=[{"link": "OA", "least": -1.0, "restitution": 0.5}],
        simulation={"duration": 0.6, "tolerance": 1e-11, "samples": 61},
    )
    found = ct.sweep(rod, {"links.OA.length": [0.64, 1.0]}, compute="simulate")
    first = found["first_occasion_at"].values
    # time goes as the root of the length
    assert abs(first[0] / first[1] - 0.8) < 1e-9
    assert (found["occasions"].values >= 1).all()
