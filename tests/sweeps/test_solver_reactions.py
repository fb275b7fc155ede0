"""Reactions among the outputs of a solver: against `reactions` of each changed mechanism, and against differences."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

import centrode as ct
from centrode.dynamics.kinetostatics.reaction_expressions import REACTIONS, SparseEquations
from centrode.model.files import with_values
from centrode.numerics.expressions import variable
from centrode.numerics.graphs import Graph
from centrode.numerics.scans import evaluate
from centrode.sweeps.solver import Solver

EPS = np.finfo(float).eps
SAMPLES = 73
LOADED = """
title = "Four-bar linkage with loads of all kinds"
gravity = [0.0, -9.81]
[frame.points]
O = [0.0, 0.0]
D = [4.0, 0.2]
[links.OA]
points = { O = [0.0, 0.0], A = [1.0, 0.0] }
mass = 1.2
centre = [0.4, 0.05]
inertia = 0.3
[links.AB]
points = { A = [0.0, 0.0], B = [3.5, 0.0], P = [1.7, 1.0] }
mass = 2.0
centre = "P"
inertia = 1.1
[links.DB]
points = { D = [0.0, 0.0], B = [3.0, 0.0] }
mass = 1.5
centre = [1.5, 0.0]
inertia = 0.9
[[drives]]
link = "OA"
start = "40 deg"
speed = "90 rpm"
[assembly]
sides = { B = "left" }
[[loads]]
kind = "force"
point = "P"
vector = ["120 * cos(q)", -30.0]
[[loads]]
kind = "spring"
points = ["P", "D"]
stiffness = 80.0
free_length = 1.0
[[loads]]
kind = "torque"
link = "DB"
value = "3 - 0.1 * v"
[[loads]]
kind = "damper"
points = ["O", "B"]
damping = 12.0
"""


def loaded() -> ct.Mechanism:
    return ct.parse_mechanism(LOADED)


MECHANISMS: dict[str, list[str]] = {
    "loaded": [
        "links.OA.points.A.x", "links.AB.points.B.x", "links.DB.points.B.x", "frame.points.D.x", "frame.points.O.y",
    ],
    "in-line-four-bar": ["links.OA.length", "links.AB.length", "links.DB.length"],
    "single-cylinder-engine": ["links.crank.points.A.x", "links.rod.points.B.x"],
    "six-bar-press": ["links.OA.length", "links.AB.points.B.x", "frame.points.C.x", "guides.H.through.y"],
    "andrews-squeezer": ["links.OF.length", "links.EF.points.F.x"],
}  # fmt: skip


def mechanism_of(name: str) -> ct.Mechanism:
    return loaded() if name == "loaded" else ct.example(name)


def asked(mechanism: ct.Mechanism) -> list[str]:
    known = ct.reactions(mechanism, 3)
    return [name for name in REACTIONS if name in known]


def made(name: str) -> Solver:
    mechanism = mechanism_of(name)
    return ct.solver(mechanism, MECHANISMS[name], SAMPLES, outputs=asked(mechanism))


def draws(solver: Solver, count: int) -> list[npt.NDArray[np.float64]]:
    draw, own = np.random.default_rng(3), np.array(solver.own)
    return [
        own + 0.02 * draw.uniform(-1.0, 1.0, len(own)) * np.maximum(np.abs(own), 0.01) for _k in range(count)
    ]


@pytest.mark.parametrize("name", MECHANISMS)
def test_reactions_are_those_of_the_changed_mechanism(name: str) -> None:
    solver = made(name)
    for values in draws(solver, 4):
        frame = solver.move(values)
        assert frame.is_clear
        changed = with_values(solver.mechanism, dict(zip(solver.free, map(float, values), strict=True)))
        there = ct.reactions(changed, SAMPLES)
        # what the arrays say of their own rounding, of the greatest of all reactions
        names = list(frame.outputs)
        greatest = max(float(np.abs(there[x]).max()) for x in names)
        bound = 4.0 * float(there.reaction_loss.max()) * greatest
        for x in names:
            np.testing.assert_allclose(frame.outputs[x], there[x], rtol=0.0, atol=bound, err_msg=x)


@pytest.mark.parametrize("name", MECHANISMS)
def test_gradients_of_reactions_are_differences(name: str) -> None:
    solver = made(name)
    (values,) = draws(solver, 1)
    slopes = solver.gradient(values)
    for k, value in enumerate(values):
        # four places: the error of the difference is step^4 of the fifth derivative, and rounding over the step
        step = 2e-4 * max(abs(value), 1e-2)
        off = step * np.eye(len(values))[k]
        one, two = (solver.outputs(values + n * off) - solver.outputs(values - n * off) for n in (1.0, 2.0))
        difference = (8.0 * one - two) / (12.0 * step)
        size = np.abs(slopes[:, k]).max()
        np.testing.assert_allclose(slopes[:, k], difference, rtol=0.0, atol=1e-7 * size)


def test_a_formula_of_reactions_is_reduced_and_differentiated() -> None:
    formula = "max(sqrt(joint_force_B_AB_x**2 + joint_force_B_AB_y**2))"
    solver = ct.solver(loaded(), MECHANISMS["loaded"], SAMPLES, outputs=formula)
    every = ct.solver(loaded(), MECHANISMS["loaded"], SAMPLES, outputs="joint_force.B/AB")
    sizes = np.hypot(*every.move(every.own).outputs["joint_force.B/AB"].T)
    assert solver.outputs(solver.own) == pytest.approx(sizes.max(), rel=8 * EPS)
    parts = every.split(every.gradient(every.own))["joint_force.B/AB"]
    at = int(np.argmax(sizes))
    unit = every.move(every.own).outputs["joint_force.B/AB"][at] / sizes[at]
    np.testing.assert_allclose(solver.gradient(solver.own), unit @ parts[at], rtol=1e-12)


def test_reactions_with_limits_are_those_of_the_arrays() -> None:
    solver = ct.solver(
        loaded(), ["links.OA.points.A.x", "links.AB.points.B.x"], SAMPLES, outputs=["joint_force"]
    )
    values = [2.2, 1.5]
    frame, slopes = solver.move(values), solver.gradient(values)
    changed = with_values(solver.mechanism, dict(zip(solver.free, values, strict=True)))
    there = ct.reactions(changed, SAMPLES)
    assert {0, 1, 2} <= set(frame.status.tolist())
    np.testing.assert_array_equal(frame.outputs["joint_force"], there.joint_force)
    # derivatives wherever there are reactions
    known = np.isfinite(there.joint_force.values)
    parts = solver.split(slopes)["joint_force"]
    np.testing.assert_array_equal(np.isfinite(parts).all(axis=-1), known)
    step = 1e-6
    for k in range(2):
        off = step * np.eye(2)[k]
        difference = (solver.outputs(values + off) - solver.outputs(values - off)) / (2.0 * step)
        good = np.isfinite(slopes[:, k])
        # next to a limit derivatives grow without bound, and differences with them
        np.testing.assert_allclose(
            slopes[good, k], difference[good], rtol=1e-5, atol=1e-5 * np.nanmax(np.abs(difference))
        )


@pytest.mark.parametrize("bad", [[19.0, 3.5], [np.nan, 3.5]])
def test_reactions_of_what_does_not_assemble_are_absent(bad: list[float]) -> None:
    solver = ct.solver(
        loaded(),
        ["links.OA.points.A.x", "links.AB.points.B.x"],
        SAMPLES,
        outputs=["balancing", "max(balancing_OA)"],
    )
    assert np.isnan(solver.outputs(bad)).all()
    assert np.isnan(solver.gradient(bad)).all()


def test_what_expressions_cannot_say_is_left_to_the_arrays() -> None:
    rubbing = ct.parse_mechanism(
        LOADED + '[[loads]]\nkind = "friction"\npoint = "B"\ncoefficient = 0.1\nradius = 0.05\n'
    )
    solver = ct.solver(rubbing, ["links.AB.points.B.x"], SAMPLES, outputs=["joint_force"])
    changed = with_values(rubbing, {"links.AB.points.B.x": 3.52})
    np.testing.assert_array_equal(
        solver.move([3.52]).outputs["joint_force"], ct.reactions(changed, SAMPLES).joint_force
    )
    with pytest.raises(ct.InputError, match="friction that depends on reactions"):
        solver.gradient([3.52])


def test_reactions_without_masses_are_refused() -> None:
    with pytest.raises(ct.InputError, match="neither masses nor loads"):
        ct.solver("crank-rocker", ["links.AB.length"], 37, outputs="joint_force")


@pytest.mark.parametrize("seed", range(4))
def test_sparse_equations_solve_what_numpy_solves(seed: int) -> None:
    draw = np.random.default_rng(seed)
    size = 9
    # two groups of three behind three forces with plain factors
    matrix = np.zeros((size, size))
    matrix[:3, :3] = np.eye(3) * draw.choice([-1.0, 1.0], 3)
    matrix[3:6, 3:6], matrix[6:, 6:] = draw.uniform(0.1, 1.0, (2, 3, 3)) + np.eye(3)
    matrix[:3, 3:], matrix[3:6, 6:] = draw.uniform(-1.0, 1.0, (3, 6)), draw.uniform(-1.0, 1.0, (3, 3))
    order = draw.permutation(size)
    matrix, right = matrix[order], draw.uniform(-1.0, 1.0, size)
    names = {(i, j): f"a {i} {j}" for i, j in zip(*np.nonzero(matrix), strict=True)}
    rows = [
        {
            j: float(matrix[i, j]) if abs(matrix[i, j]) == 1.0 else variable(names[i, j])
            for j in range(size)
            if matrix[i, j]
        }
        for i in range(size)
    ]
    solved = SparseEquations(rows, [variable(f"b {i}") for i in range(size)]).solve()
    values = {name: matrix[at] for at, name in names.items()} | {f"b {i}": x for i, x in enumerate(right)}
    found = evaluate(Graph.of({str(k): x for k, x in solved.items()}), values)
    there = np.linalg.solve(matrix, right)
    bound = 64 * EPS * np.linalg.cond(matrix) * np.abs(there).max()
    np.testing.assert_allclose([found[str(k)] for k in range(size)], there, rtol=0.0, atol=bound)
