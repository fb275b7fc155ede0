"""Initial value problems by machine code and by Python: against closed forms, and against each other."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import DOP853

from centrode.numerics import dormand_prince, machine_code
from centrode.numerics.expressions import EXPRESSIONS, as_node, variable
from centrode.numerics.initial_value_problems import (
    END,
    HEADER,
    OF_FIFTH,
    OF_THIRD,
    SMALLEST,
    STEP,
    TIME,
    InitialValueProblem,
)
from centrode.numerics.integrators import integrator_of

EPS = 2.0**-52
EXECUTORS = ["arrays", *(["machine code"] if machine_code.PRESENT else [])]


def oscillator(limit: str = "", guard: str = "", tight: bool = True) -> InitialValueProblem:
    """x'' = -k^2 x, with the energy counted as a third; closed by nothing."""
    m, x, v, k = EXPRESSIONS, variable("x"), variable("v"), variable("k")
    fifth = variable(OF_FIFTH + "x") * variable(OF_FIFTH + "x") + variable(OF_FIFTH + "v") * variable(
        OF_FIFTH + "v"
    )
    third = variable(OF_THIRD + "x") * variable(OF_THIRD + "x") + variable(OF_THIRD + "v") * variable(
        OF_THIRD + "v"
    )
    together = fifth + 0.01 * third
    size = m.where(m.less(0.0, together), variable(STEP) * fifth / m.sqrt(together), 0.0)
    error = size / variable("tolerance") if tight else as_node(0.9**8)
    closing = {"limit": as_node(0.125), "guard": m.where(m.less(2.0, variable(TIME)), 1.0, 0.0)}
    used = {name: closing[name] for name in (limit, guard) if name}
    rates = {"x": v, "v": -(k * k * x), "way": m.abs(v)}
    return InitialValueProblem((END, SMALLEST, "tolerance", "k"), rates, used, as_node(error), limit, guard)


def start(lanes: int, carried: int, step: float = 0.01) -> npt.NDArray[np.float64]:
    state = np.zeros((HEADER + carried, lanes))
    state[1], state[HEADER] = step, 1.0
    return state


@pytest.mark.parametrize("executor", EXECUTORS)
def test_an_oscillator_is_a_cosine_in_every_lane(executor: str) -> None:
    """Lanes with frequencies and ends of their own; the last vector is not full."""
    k = np.linspace(1.0, 3.0, 11)
    ends = np.linspace(2.0, 5.0, 11)
    parameters = np.stack([ends, np.zeros(11), np.full(11, 1e-12), k])
    problem = oscillator()
    found = integrator_of(problem, executor, width=None).run(parameters, start(11, 3), 10_000)
    assert np.array_equal(found[0], ends)
    # local errors of the tolerance, as many as there are attempts
    assert np.max(np.abs(found[HEADER] - np.cos(k * ends)) / found[2]) <= 1e-12
    assert np.max(np.abs(found[HEADER + 1] + k * np.sin(k * ends)) / found[2]) <= 3e-12


@pytest.mark.parametrize("executor", EXECUTORS)
def test_rows_are_the_steps_and_a_full_room_is_gone_on_from(executor: str) -> None:
    problem = oscillator()
    parameters = np.array([[3.0], [0.0], [1e-10], [2.0]])
    integrator = integrator_of(problem, executor)
    whole, rows = start(1, 3), np.empty((1000, 4))
    whole = integrator.run(parameters, whole, 10_000, rows)
    steps = int(whole[3, 0])
    assert np.all(np.diff(rows[:steps, 0]) > 0.0) and rows[steps - 1, 0] == 3.0
    assert np.array_equal(rows[steps - 1, 1:], whole[HEADER:, 0])
    parts, state = [], start(1, 3)
    while state[0, 0] < 3.0:
        few = np.empty((4, 4))
        state = integrator.run(parameters, state, 10_000, few)
        parts.append(few[: int(state[3, 0])])
    assert np.array_equal(np.concatenate(parts), rows[:steps])


@pytest.mark.skipif(not machine_code.PRESENT, reason="llvmlite is not there")
def test_python_takes_the_steps_of_machine_code() -> None:
    """Products and sums are rounded once there: what steps of one size reach is the same up to that."""
    problem = oscillator(tight=False)
    parameters = np.array([[3.0], [0.0], [1.0], [2.0]])
    found = [
        integrator_of(problem, executor).run(parameters, start(1, 3, 0.05), 1000)
        for executor in ("machine code", "arrays")
    ]
    assert found[0][2, 0] == found[1][2, 0]
    one, other = (np.delete(state, 3, axis=0) for state in found)
    # what is counted besides are the steps written, of which there are none here
    assert np.max(np.abs(one - other)) <= 64 * found[0][2, 0] * EPS


@pytest.mark.parametrize("executor", EXECUTORS)
def test_order_of_the_scheme(executor: str) -> None:
    """With steps of one size the error falls with their eighth power."""
    problem = oscillator(tight=False)
    errors = []
    for count in (16, 32):
        parameters = np.array([[4.0], [0.0], [1.0], [2.0]])
        found = integrator_of(problem, executor).run(parameters, start(1, 3, 4.0 / count), 10 * count)
        errors.append(abs(found[HEADER, 0] - math.cos(8.0)))
    assert 7.6 < math.log2(errors[0] / errors[1]) < 9.0


@pytest.mark.parametrize("executor", EXECUTORS)
def test_a_limit_holds_steps_back_and_a_guard_stops_them(executor: str) -> None:
    problem = oscillator("limit", "guard")
    parameters = np.array([[9.0], [0.0], [1e-3], [0.1]])
    state = start(1, 5, 0.125)
    state[HEADER + problem.carried_names.index("limit")] = 0.125
    rows = np.empty((200, 6))
    found = integrator_of(problem, executor).run(parameters, state, 1000, rows)
    steps = rows[: int(found[3, 0]), 0]
    assert np.max(np.diff(steps)) <= 0.125
    assert 2.0 < found[0, 0] <= 2.125 and found[HEADER + problem.carried_names.index("guard"), 0] == 1.0


@pytest.mark.parametrize("executor", EXECUTORS)
def test_steps_end_where_nothing_has_a_value(executor: str) -> None:
    """x' = sqrt(1 - t): beyond t = 1 there is no rate, and the steps shrink until they are the least."""
    m = EXPRESSIONS
    error = as_node(m.abs(variable(OF_FIFTH + "x")) * variable(STEP) / 1e-6)
    problem = InitialValueProblem((END, SMALLEST), {"x": m.sqrt(1.0 - variable(TIME))}, {}, error)
    found = integrator_of(problem, executor).run(np.array([[2.0], [1e-9]]), start(1, 1), 10_000)
    assert 0.999 < found[0, 0] <= 1.0 and found[1, 0] <= 1e-9


def test_coefficients_are_those_of_the_scheme() -> None:
    """SciPy's tables, digit for digit; and a step integrates powers of time as its orders say."""
    stages = range(dormand_prince.STAGES)
    assert [tuple(DOP853.A[k, :k]) for k in stages] == list(dormand_prince.A)
    for mine, theirs in (
        (dormand_prince.B, DOP853.B),
        (dormand_prince.C, DOP853.C),
        (dormand_prince.FIFTH, DOP853.E5),
        (dormand_prince.THIRD, DOP853.E3),
    ):
        assert mine == tuple(theirs[: dormand_prince.STAGES])
    b, c = np.array(dormand_prince.B), np.array(dormand_prince.C)
    for power in range(8):
        assert abs(b @ c**power - 1.0 / (power + 1)) <= 1e-14
    assert abs(b @ c**8 - 1.0 / 9) > 1e-6
    for row, time in zip(dormand_prince.A, c, strict=True):
        assert abs(sum(row) - time) <= 1e-14
