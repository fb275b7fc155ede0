"""Groups of higher class by their loops: the same equations, derivatives and motions as by all their constraints."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.kinematics.higher_class import curve_continuation
from centrode.kinematics.higher_class.loop_closure import LoopClosure
from centrode.kinematics.higher_class.system import GroupSystem, Surroundings, needed_positions
from centrode.kinematics.path import JETS
from centrode.kinematics.plan_evaluation import EvaluationPolicy
from centrode.kinematics.preparation import ready
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from centrode.structure.groups import Newton
from mechanisms import EPS, Parts, events, parts_of

EXAMPLES = (
    "third-class-triad",
    "fourth-class-group",
    "stephenson-driven-at-rocker",
    "watt-driven-second-loop",
    "scissor-lift-cylinder",
)
PLACES = 7


def rolling_rod() -> ct.Mechanism:
    """A wheel on the floor and its rod, driven at the block: a group with both equations of rolling."""
    parts: Parts = parts_of(ct.example("rolling-wheel-rod"))
    for name in ("study", "assembly", "loads"):
        parts.pop(name, None)
    motion = ct.motion(ct.example("rolling-wheel-rod"), at=[0.0])
    angles = {str(link): float(x) for link, x in zip(motion.link.values, motion.angle.values[0], strict=True)}
    links = {name: {**link, "angle": angles[name]} for name, link in parts["links"].items()}
    at = float(motion.slide.sel(guide="B")[0])
    return ct.Mechanism(**{**parts, "links": links, "drives": [{"guide": "B", "start": at, "speed": 1.0}]})


MECHANISMS = {name: lambda name=name: ct.example(name) for name in EXAMPLES} | {"rolling": rolling_rod}


@pytest.fixture(params=MECHANISMS)
def mechanism(request: pytest.FixtureRequest) -> ct.Mechanism:
    made: ct.Mechanism = MECHANISMS[request.param]()
    return made


def near(mechanism: ct.Mechanism) -> tuple[GroupSystem, LoopClosure, np.ndarray, np.ndarray]:
    """A group's equations in both forms at random places at which its hinges hold, with what is known there."""
    prepared = ready(mechanism)
    groups = prepared.structure.groups
    number, group = next((i, g) for i, g in enumerate(groups) if isinstance(g, Newton))
    numbers = prepared.kinematics.numbers
    at = prepared.kinematics.frame(JETS, Jet.variable(np.full(PLACES, prepared.kinematics.path.initial), 3))
    prepared.kinematics.advance(at, range(number), JETS, EvaluationPolicy())
    at = needed_positions(group, at)
    loops = LoopClosure(group, numbers, at)
    known = loops.known(at, PLACES, 4)
    state = GroupSystem(group, numbers, at, 1).state_of(prepared.assembled.positions)
    free, whole = loops.free_of(np.repeat(state, PLACES, axis=0))
    free = free + np.random.default_rng(2).uniform(-0.1, 0.1, free.shape)
    values = at.map_numbers(lambda x: x.value if isinstance(x, Jet) else x)
    system = GroupSystem(group, numbers, values, PLACES)
    return system, loops, loops.numbers(free, whole, known[0]), known


def test_residuals_and_matrices_are_those_of_the_constraints(mechanism: ct.Mechanism) -> None:
    system, loops, numbers, _known = near(mechanism)
    at = system.at(ARRAYS, system.known, loops.state(numbers))
    linear = system.linear(at)
    _moved, rest = linear.reduce(system.residual(ARRAYS, at))
    assert np.allclose(loops.residual(numbers), system.stack(rest), rtol=0.0, atol=64 * EPS)
    assert np.allclose(loops.matrix(numbers), linear.matrix, rtol=0.0, atol=64 * EPS)


def test_free_coordinates_come_back_from_states(mechanism: ct.Mechanism) -> None:
    _system, loops, numbers, known = near(mechanism)
    again = loops.numbers(*loops.free_of(loops.state(numbers)), known[0])
    assert np.allclose(again, numbers, rtol=0.0, atol=16 * EPS * np.max(np.abs(numbers)))


def test_matrices_are_differences_of_residuals(mechanism: ct.Mechanism) -> None:
    """By central differences, which are off by the square of their step and by rounding over it."""
    _system, loops, numbers, known = near(mechanism)
    free, step = numbers[:, loops.coordinates], EPS ** (1.0 / 3.0)
    for column in range(loops.free):
        shift = np.zeros(loops.free)
        shift[column] = step
        sides = [loops.residual(loops.numbers(free + s * shift, 0.0 * free, known[0])) for s in (1.0, -1.0)]
        slope = (sides[0] - sides[1]) / (2.0 * step)
        assert np.allclose(slope, loops.matrix(numbers)[:, :, column], rtol=0.0, atol=300.0 * step**2)


def test_series_satisfy_the_equations_order_by_order(mechanism: ct.Mechanism) -> None:
    """Of a place that is not quite one, all coefficients but the first vanish."""
    _system, loops, numbers, known = near(mechanism)
    series = loops.series(numbers, known, loops.matrix(numbers))
    size = 1.0 + max(float(np.max(np.abs(series[k]))) for k in range(4))
    for order in (1, 2, 3):
        assert np.max(np.abs(loops.coefficient(series, order))) <= 1e3 * EPS * size**2
    squared = series[:, :, : loops.free], series[:, :, loops.free : 2 * loops.free]
    for order in (1, 2, 3):
        # cosines and sines of one angle: their squares have no derivative
        left = sum(part[k] * part[order - k] for part in squared for k in range(order + 1))
        assert np.max(np.abs(left)) <= 1e3 * EPS * size**2


def by_constraints(mechanism: ct.Mechanism, monkeypatch: pytest.MonkeyPatch) -> xr.Dataset:
    """The motion with neither loops nor steps by the parameter."""
    with monkeypatch.context() as patch:
        patch.setattr(Surroundings, "_one_plane_mechanism", property(lambda _around: False))
        return ct.motion(mechanism, 73)


def along_curves(mechanism: ct.Mechanism, monkeypatch: pytest.MonkeyPatch) -> xr.Dataset:
    """The motion by loops, but along curves alone."""
    with monkeypatch.context() as patch:
        patch.setattr(
            curve_continuation,
            "_by_parameter",
            lambda _around, _loops, state, *_rest: np.zeros(len(state), dtype=bool),
        )
        return ct.motion(mechanism, 73)


@pytest.mark.parametrize("other", [by_constraints, along_curves])
@pytest.mark.parametrize("name", EXAMPLES[:4])
def test_motions_do_not_depend_on_the_way(
    name: str,
    other: Callable[[ct.Mechanism, pytest.MonkeyPatch], xr.Dataset],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    mechanism = ct.example(name)
    ours, theirs = ct.motion(mechanism, 73), other(mechanism, monkeypatch)
    assert (ours.status == theirs.status).all()
    assert ours.sizes["event"] == theirs.sizes["event"]
    for order, quantity in enumerate(("position", "velocity_coefficient", "acceleration_coefficient")):
        size = float(np.max(np.abs(theirs[quantity])))
        # both ways stop where rounding does; every derivative loses what the group's condition takes
        assert np.max(np.abs(ours[quantity] - theirs[quantity])) <= 128 * EPS * 25.0 ** (order + 1) * size


def test_the_flat_scissors_end_at_their_limit() -> None:
    """With the bars flat a change point and the limit at l = 0.4 m lie in one place: below it nothing closes."""
    data = ct.motion(ct.example("scissor-lift-cylinder"), at=[0.38, 0.39, 0.41, 0.5, 0.7])
    assert data.status.values.tolist() == [ct.Status.OPEN] * 2 + [ct.Status.OK] * 3
    assert events(data, "limit") == pytest.approx([0.4], abs=1e-12)


# What is kept of mechanisms: of a form its plan, of a mechanism what is made ready.


def test_equal_mechanisms_are_made_ready_once_and_others_again() -> None:
    first, again = ct.example("crank-rocker"), ct.example("crank-rocker")
    assert first is not again
    assert ready(first) is ready(again)
    longer = ct.with_value(first, "links.AB.length", 1.01 * ct.value_at(first, "links.AB.length"))
    assert ready(longer) is not ready(first)
    assert ready(longer).structure.groups == ready(first).structure.groups
    assert ready(longer).structure.dimensions.local["AB"] != ready(first).structure.dimensions.local["AB"]


def test_the_order_of_links_is_kept_apart() -> None:
    """Mechanisms are equal whatever the order of their links; results name these in the order of the description."""
    parts = parts_of(ct.example("crank-rocker"))
    turned = {**parts, "links": dict(reversed(parts["links"].items()))}
    one, other = ct.Mechanism(**parts), ct.Mechanism(**turned)
    assert one == other
    assert ct.motion(one, 5).link.values.tolist() == [*parts["links"]]
    assert ct.motion(other, 5).link.values.tolist() == [*turned["links"]]
    assert ct.motion(other, 5).attrs["mechanism"] == ct.mechanism_text(other)
