"""Choices of designs: against searches by brute force and roots along the path itself, and against moved bounds."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pytest
from scipy.optimize import brentq

from cam_families import CONTACT, END, family, measured, path_of
from centrode.cams.parameter_choice.problem import MEASURES, Family, Mesh, PathTrial, paths_of
from centrode.cams.parameter_choice.search import ParameterChoice, choose, trade_off
from centrode.errors import InputError
from samples import few

EPS = 2.0**-52
START = np.array([10.0, 0.75, 0.05])
BOUNDS = {"stress": 560e6, "pressure_angle": math.radians(20), "gap": 0.015}


def excess(values: Mapping[str, float], bounds: Mapping[str, float]) -> float:
    """Worst miss of a bound, as a part of it."""
    return max(MEASURES[name].sign * (values[name] - bound) / bound for name, bound in bounds.items())


def parameters(choice: ParameterChoice) -> np.ndarray:
    return np.array(list(choice.chosen.parameters.values()))


@pytest.fixture(scope="module")
def chosen() -> ParameterChoice:
    return choose(family(), START, "size", BOUNDS)


@pytest.mark.parametrize("end", [0.3, math.pi / 4, math.pi / 2, -1.2])
def test_tried_paths_are_the_paths(end: float) -> None:
    """The iteration leaves some rounding of each of its sums over 21 nodes, in a few panels."""
    designs = np.array([[10.0, 0.75, 0.05], [20.0, 0.0, 0.05], [14.0, -0.4, 0.06]])
    phi = np.linspace(min(0, end), max(0, end), 23)
    trials = [PathTrial(lambda at, p=p: p[0] * np.exp(p[1] * at), float(p[2]), 0.0, 0.015) for p in designs]
    tried = paths_of(trials, Mesh((min(0, end), max(0, end))), phi)
    for column, design in enumerate(designs):
        k0, k1, radius = design
        path = path_of(design, end) if end > 0 else path_of((k0, -k1, radius), -end)  # its mirror image
        sign = 1 if end > 0 else -1
        room = 16 * 21 * 8 * EPS
        np.testing.assert_allclose(tried.rho[:, column], path.radius(sign * phi)[0], rtol=room)
        np.testing.assert_allclose(tried.gamma[:, column], sign * path.pressure_angle(sign * phi), atol=room)


def test_a_path_that_stalls_is_steep_and_finite() -> None:
    tried = paths_of(
        [PathTrial(lambda phi: 1.0 + 0 * phi, 0.05, 0.0, 0.015)],
        Mesh((0.0, math.pi)),
        np.linspace(0, math.pi, 9),
    )
    assert np.isfinite(tried.rho).all()
    assert np.abs(tried.gamma).max() > math.radians(71.25)  # that is refused


def test_the_bounds_are_kept_along_the_path(chosen: ParameterChoice) -> None:
    assert chosen.admissible
    found = measured(parameters(chosen), angles=20001)
    # bounds to 1e-9 by promise; the search's own angles miss a smooth top by less than a part in 1e7 of a step
    assert excess(found, BOUNDS) <= 1e-8
    for name, judged in chosen.chosen.measures.items():
        assert judged.value == pytest.approx(found[name], rel=1e-7)
    assert chosen.start.misses  # the start is not admissible
    assert chosen.agreeing > 1


def test_neighbours_are_not_better(chosen: ParameterChoice) -> None:
    """Of designs at many distances, along the path itself: what keeps the bounds is not smaller."""
    rng = np.random.default_rng(5)
    best, size = parameters(chosen), chosen.chosen.measures["size"].value
    kept = 0
    for _trial in range(few(250, 600)):
        near = best + rng.normal(size=3) * (35, 3, 0.06) * 10 ** rng.uniform(-6, -0.5)
        inside = (near >= (5, -1, 0.03)) & (near <= (40, 2, 0.09))
        if not inside.all():
            continue
        values = measured(near)
        if excess(values, BOUNDS) <= 0:
            kept += 1
            assert values["size"] >= size * (1 - 1e-8)
    assert kept >= few(8, 20)


def test_slopes_and_multipliers(chosen: ParameterChoice) -> None:
    """At the optimum the slopes balance, and the multipliers foretell what moved bounds do."""
    assert chosen.residual <= 1e-6
    size = chosen.chosen.measures["size"].value
    assert chosen.binding
    for name, by in chosen.binding.items():
        move = 1e-4
        ends = []
        for side in (-1, 1):
            moved = {**BOUNDS, name: BOUNDS[name] * (1 + side * move)}
            ends.append(choose(family(), parameters(chosen), "size", moved, 0))
        change = (ends[1].chosen.measures["size"].value - ends[0].chosen.measures["size"].value) / (2 * move)
        expected = -MEASURES[name].sign * by * size
        # a central difference of two optima that are good to some 1e-9 of themselves, over 2e-4
        assert change == pytest.approx(expected, abs=size * 2e-9 / move + move * abs(expected))


def test_one_parameter_has_a_root() -> None:
    """Constant curvature from a fixed radius: the smallest one with a gap has just that gap."""
    one = Family(
        ("k0",),
        np.array([5.0]),
        np.array([25.0]),
        lambda p: PathTrial(lambda phi: p[0] + 0 * phi, 0.05, 0.0, 0.015),
        Mesh((0.0, END), mirrored=True),
        CONTACT,
    )
    found = choose(one, np.array([10.0]), "size", {"gap": 0.01})
    root = brentq(lambda k0: measured(np.array([k0, 0.0, 0.05]))["gap"] - 0.01, 5, 19.9, xtol=1e-14)
    # the gap is asked for tighter by half of 1e-9; its slope by k0, relative, is near -1 to -2
    assert found.chosen.parameters["k0"] == pytest.approx(root, rel=2e-9)
    assert found.at_ends == ()


def test_a_round_cam_is_found_where_nothing_asks_for_another() -> None:
    """The least pressure angle is none: K = 1/rho0, also where the box's own middle is that design."""
    rho = 0.05
    wavy = Family(
        ("k", "swing"),
        np.array([0.3 / rho, -0.6]),
        np.array([1.7 / rho, 0.6]),
        lambda p: PathTrial(lambda phi: p[0] * (1 + p[1] * np.sin(3 * phi)), rho, 0.0, 0.01),
        Mesh((0.0, 1.1)),
        CONTACT,
    )
    found = choose(wavy, np.array([12.0, 0.4]), "pressure_angle", {"size": 0.065})
    assert found.admissible
    # the iteration leaves some rounding of sums over 21 nodes
    assert found.chosen.measures["pressure_angle"].value <= 21 * 8 * EPS
    # slopes at the optimum tell parameters from the value by no more than its tolerance over them
    assert found.chosen.parameters["k"] == pytest.approx(1 / rho, rel=1e-10)
    assert found.chosen.parameters["swing"] == pytest.approx(0.0, abs=1e-10)
    assert found.agreeing > 1


def test_what_cannot_be_kept_is_missed_by_the_least() -> None:
    """Against a grid of designs along the path itself."""
    bounds = {"stress": 400e6, "size": 0.06, "gap": 0.02}
    found = choose(family(), START, "size", bounds)
    assert not found.admissible
    assert math.isnan(found.residual)
    worst = max(found.chosen.misses.values())
    assert worst == pytest.approx(excess(measured(parameters(found)), bounds), rel=1e-6)
    grid = [
        excess(measured(np.array([k0, k1, radius]), angles=41), bounds)
        for k0 in np.linspace(5, 40, few(6, 11))
        for k1 in np.linspace(-1, 2, few(4, 7))
        for radius in np.linspace(0.03, 0.09, few(4, 7))
    ]
    assert worst <= min(grid)


def test_the_front_is_not_beaten() -> None:
    bounds = {"gap": 0.015, "pressure_angle": math.radians(25)}
    front = trade_off(family(), START, "size", "stress", bounds, points=few(3, 5))
    size, stress = front.values("size"), front.values("stress")
    assert len(size) == few(3, 5)
    assert (np.diff(stress) > 0).all()
    assert (np.diff(size) < 0).all()
    for design in front.designs:
        assert excess(measured(np.array(list(design.parameters.values()))), bounds) <= 1e-8
    rng = np.random.default_rng(11)
    low, high = family().low, family().high
    for _trial in range(few(50, 150)):
        values = measured(low + rng.random(3) * (high - low), angles=61)
        if excess(values, bounds) > 0 or not stress[0] < values["stress"] < stress[-1]:
            continue
        # between two points the front lies below the chord's upper end
        nearest = np.searchsorted(stress, values["stress"], side="right") - 1
        assert values["size"] >= size[nearest + 1] * (1 - 1e-8)


def test_wrong_questions() -> None:
    with pytest.raises(InputError, match="not a measure"):
        choose(family(), START, "beauty", {})
    with pytest.raises(InputError, match="needs the force"):
        choose(family(contact=None), START, "size", {"stress": 1e8})
