"""A solver against the motion of each changed mechanism, against sweeps, and against differences."""

from __future__ import annotations

import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import centrode as ct
from centrode.kinematics.machine_code.frame_calls import PlainFunction
from centrode.kinematics.machine_code.frame_plan import DirectPlan
from centrode.numerics.executors import AUTO, MACHINE_CODE, choose_executor
from centrode.numerics.expressions import EXPRESSIONS, variable
from centrode.numerics.graphs import Graph, graph_of_rows, graph_rows
from centrode.numerics.scans import evaluate
from centrode.sweeps.solver import Solver

EPS = np.finfo(float).eps
FREE = {
    "crank-rocker": ["links.AB.length", "links.DB.length", "frame.points.D.x"],
    "six-bar-press": ["links.AB.points.B.x", "frame.points.C.x", "links.OA.length", "guides.H.direction"],
    "spherical-four-bar": ["links.AB.length", "frame.points.D.longitude"],
    "geared-five-bar": ["links.AB.length"],
    "two-link-arm": ["links.AB.length"],
    "third-class-triad": ["links.AB.length", "links.DC.length"],
    "slider-between-cranks-locked": ["links.AB.length"],
    "kite": ["links.AB.length"],
    "planetary-hypocycloid": ["rolling.wheel.radius"],
}
"""Clear ones, groups of higher class, limits, change points, and what is not traced."""


def made(name: str, **options: object) -> Solver:
    mechanism = ct.example(name)
    paths = []
    for path in FREE[name]:
        try:
            ct.value_at(mechanism, path)
            paths.append(path)
        except ct.InputError:
            continue
    paths = paths or [f"links.{link}.length" for link in mechanism.links if mechanism.links[link].length][:1]
    return ct.solver(mechanism, paths, 73, **options)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", FREE)
def test_moves_are_the_motions_of_the_changed_mechanisms(name: str) -> None:
    solver = made(name)
    draw = np.random.default_rng(0)
    for k in range(4):
        values = np.array(solver.own) * (1.0 + 0.02 * draw.uniform(-1.0, 1.0, len(solver.free)) * bool(k))
        frame = solver.move(values)
        vary = {path: [value] for path, value in zip(solver.free, values, strict=True)}
        motion = ct.motion(solver.mechanism, 73, vary=vary).isel(mechanism=0)
        np.testing.assert_array_equal(frame.status, motion.status)
        for quantity, found in frame.arrays.items():
            there = motion[quantity].values
            if not there.size:
                continue
            # dyads to the bits of the arrays; groups of higher class to 128 eps kappa, each derivative 23 times that
            order = 2 if "acceleration" in quantity else 1 if "velocity" in quantity else 0
            higher = 128.0 * EPS * 400.0 * 23.0**order * np.nanmax(np.abs(there), initial=1.0)
            bound = higher if name == "third-class-triad" else 0.0
            np.testing.assert_allclose(found, there, rtol=0.0, atol=bound, err_msg=quantity)


def test_events_of_what_is_not_clear() -> None:
    locked = made("slider-between-cranks-locked")
    frame = locked.move(locked.own)
    motion = ct.motion("slider-between-cranks-locked", 73)
    assert not frame.is_clear
    assert [event.at for event in frame.events] == motion.event_value.values.tolist()


def test_a_dataset_is_the_motion_of_the_changed_description() -> None:
    solver = made("crank-rocker")
    data = solver.move([3.6, 3.1, 4.0]).dataset()
    changed = ct.example("crank-rocker")
    for path, value in zip(solver.free, [3.6, 3.1, 4.0], strict=True):
        changed = ct.with_value(changed, path, value)
    motion = ct.motion(changed, 73)
    assert data.attrs["mechanism"] == motion.attrs["mechanism"]
    for name in ("position", "velocity", "acceleration", "angle"):
        np.testing.assert_allclose(data[name], motion[name], rtol=0.0, atol=64 * EPS * 10.0)


@pytest.mark.parametrize("bad", [[9.0, 3.0, 4.0], [np.nan, 3.0, 4.0], [np.inf, 3.0, 4.0], [-1.0, 3.0, 4.0]])
def test_what_does_not_assemble_has_a_status(bad: list[float]) -> None:
    solver = made("crank-rocker", outputs=["position.B.x", "range(angle_DB)"])
    frame = solver.move(bad)
    assert (frame.status == ct.Status.OPEN).all()
    assert np.isnan(frame.position[:, 1]).all()
    assert np.isnan(solver.outputs(bad)).all()
    assert np.isnan(solver.gradient(bad)).all()
    # and the next one is right again
    assert (solver.move(solver.own).status == ct.Status.OK).all()


FORMULAS = {
    "error": "sum((position_B_x - 1)**2 + (position_B_y - 2)**2)",
    "swing": "range(angle_DB)",
    "farthest": "max(abs(position_B_x - mean(position_B_x)))",
}


def test_reduced_outputs_and_gradients_are_those_of_sweeps() -> None:
    solver = made("crank-rocker", outputs=FORMULAS)
    values = [3.53, 3.02, 4.01]
    vary = {path: [value] for path, value in zip(solver.free, values, strict=True)}
    swept = ct.sweep("crank-rocker", vary, samples=73, reduce=FORMULAS, gradient=True)
    outputs, slopes = solver.move(values).outputs, solver.split(solver.gradient(values))
    for name in FORMULAS:
        # a mean's rounding: samples times eps of what is summed
        np.testing.assert_allclose(outputs[name], swept[name].values[0], rtol=73 * EPS * 8)
        there = swept[f"gradient.{name}"].values[0]
        np.testing.assert_allclose(slopes[name], there, rtol=0.0, atol=73 * EPS * 64 * np.abs(there).max())


@pytest.mark.parametrize("name", ["crank-rocker", "spherical-four-bar", "third-class-triad"])
def test_gradients_are_differences(name: str) -> None:
    point = {"crank-rocker": "B", "spherical-four-bar": "C", "third-class-triad": "C"}[name]
    mean = f"position_{point}_x - mean(position_{point}_x)"
    solver = made(name, outputs=[f"position.{point}", mean, f"max(position_{point}_x)"])
    values, step = np.array(solver.own) * 1.002, 1e-5
    slopes = solver.gradient(values)
    for k in range(len(values)):
        off = step * np.eye(len(values))[k]
        difference = (solver.outputs(values + off) - solver.outputs(values - off)) / (2.0 * step)
        # truncation step^2, rounding eps / step; at an extreme of samples the slope is that of its sample
        np.testing.assert_allclose(slopes[:, k], difference, rtol=0.0, atol=1e3 * step**2 + 1e3 * EPS / step)


def test_one_number_alone_is_a_float() -> None:
    solver = made("crank-rocker", outputs="range(angle_DB)")
    assert isinstance(solver.outputs(solver.own), float)
    assert solver.gradient(solver.own).shape == (3,)


def test_values_are_numbers_texts_or_named() -> None:
    solver = made("crank-rocker")
    here = solver.move([3.6, 3.0, 4.0]).copy()
    for values in (["3600 mm", 3, "4 m"], {"links.AB.length": "3.6 m"}, np.array([3.6, 3.0, 4.0])):
        np.testing.assert_array_equal(solver.move(values).position, here.position)


def test_frames_that_are_kept_and_copies_stay() -> None:
    solver = made("crank-rocker")
    first = solver.move([3.5, 3.0, 4.0])
    kept, place = first.copy(), first.position.copy()
    other = solver.move([3.6, 3.0, 4.0])
    np.testing.assert_array_equal(kept.position, place)
    np.testing.assert_array_equal(first.position, place)
    assert not np.array_equal(other.position, place)
    with pytest.raises(ValueError, match="read-only"):
        first.position[0] = 0.0


def test_a_solver_is_pickled_by_its_description() -> None:
    solver = made("crank-rocker", outputs=FORMULAS)
    other = pickle.loads(pickle.dumps(solver))
    np.testing.assert_array_equal(other.outputs(solver.own), solver.outputs(solver.own))


def test_threads_share_a_solver() -> None:
    solver = made("six-bar-press")
    own = np.array(solver.own)
    many = [own * (1.0 + 1e-3 * k / 50) for k in range(50)]
    alone = [solver.move(values).position.copy() for values in many]
    with ThreadPoolExecutor(4) as pool:
        shared = list(pool.map(lambda values: solver.move(values).position.copy(), many))
    for one, other in zip(alone, shared, strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize(
    ("free", "told"),
    [
        (["links.XX.length"], "known are"),
        (["links.AB.lenght"], "length"),
        (["drives.OA.start"], "no dimension"),
        ([], "1 to 100"),
        (["links.AB.length", "links.AB.length"], "different"),
    ],
)
def test_paths_that_are_refused(free: list[str], told: str) -> None:
    with pytest.raises(ct.InputError, match=told) as failure:
        ct.solver("crank-rocker", free)
    assert failure.value.where
    assert failure.value.repair


@pytest.mark.parametrize("values", [[3.5], ["x", 3.0, 4.0], {"links.OA.length": 1.0}, 5.0, [None, 3.0, 4.0]])
def test_values_that_are_refused(values: object) -> None:
    with pytest.raises(ct.InputError) as failure:
        made("crank-rocker").move(values)  # type: ignore[arg-type]
    assert failure.value.repair


def test_outputs_that_are_refused() -> None:
    with pytest.raises(ct.InputError, match="position"):
        made("crank-rocker", outputs="range(position_X_x)")
    with pytest.raises(ct.InputError, match="no output"):
        made("crank-rocker").gradient([3.5, 3.0, 4.0])


def test_graphs_as_rows_are_the_same_graphs() -> None:
    x = variable("x")
    graph = Graph.of({"y": EXPRESSIONS.sin(x) / 3.0 - 0.0, "z": x * x, "w": x})
    assert graph_of_rows(graph_rows(graph)).key == graph.key
    assert evaluate(graph_of_rows(graph_rows(graph)), {"x": 2.0})["z"] == 4.0
    with pytest.raises(ValueError, match="no graph"):
        graph_of_rows([["add", 5, 6]])


@pytest.mark.parametrize("free", [[3], None])
def test_free_paths_that_are_no_texts(free: object) -> None:
    with pytest.raises(ct.InputError, match="as texts"):
        ct.solver("crank-rocker", free)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("outputs", "what"), [(3, "an output is a text"), (["angle", "angle"], "given twice")]
)
def test_outputs_of_a_solver_that_are_none(outputs: object, what: str) -> None:
    with pytest.raises(ct.InputError, match=what):
        ct.solver("crank-rocker", ["links.AB.length"], 37, outputs=outputs)  # type: ignore[arg-type]


def test_small_functions_of_the_free_numbers_are_those_of_arrays() -> None:
    """The greatest arc of a sphere: sines, cosines and arc tangents by NumPy, what lies in between as machine code."""
    free = [f"links.{link}.length" for link in ("AB", "BC", "DC")]
    free += ["frame.points.D.longitude", "frame.points.D.latitude"]
    solver = ct.solver("spherical-four-bar", free, 37)
    plan = solver._plan
    assert isinstance(plan, DirectPlan)
    graph = plan.numbers.scale
    assert graph is not None
    function = PlainFunction(graph, free)
    if choose_executor(AUTO) == MACHINE_CODE:
        assert any(stage.kernel is not None for stage in function._stages)
    run, draw = function.for_thread(), np.random.default_rng(5)
    for _k in range(20):
        values = (np.array(solver.own) + 0.1 * draw.uniform(-1.0, 1.0, len(free))).tolist()
        (there,) = evaluate(graph, dict(zip(free, values, strict=True))).values()
        assert run(values) == [float(there)]
