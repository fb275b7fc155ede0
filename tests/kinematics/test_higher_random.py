"""Random mechanisms with groups of higher class: places as they were drawn, constraints kept with two derivatives."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import assume, given, settings

import centrode as ct
from centrode.errors import InputError
from centrode.kinematics.path import JETS, grid_at
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.solve import solve
from centrode.numerics.jets import Jet
from growing_higher import higher_descriptions
from jetted import jet_positions
from mechanisms import EPS, OPERATIONS
from redriven import answer
from samples import few

WORTH = 1e5
"""Positions that answer to their dimensions more than so prove nothing about formulas."""


def prepared_of(parts: dict[str, Any]) -> Ready:
    """The mechanism made ready; draws that put two points of a group in one place are passed over."""
    try:
        return ready(ct.Mechanism(**parts))
    except InputError as error:
        assume("the mobility" not in str(error))
        raise


@settings(max_examples=few(2, 15))
@given(higher_descriptions())
def test_the_initial_position_is_the_one_drawn(parts: dict[str, Any]) -> None:
    prepared = prepared_of(parts)
    start = np.array([prepared.kinematics.path.initial])
    data = ct.motion(prepared.mechanism, at=start)
    condition = answer(prepared.mechanism, start)[0, 0]
    assume(data.status[0] == ct.Status.OK and condition < WORTH)
    allowed = 4 * OPERATIONS * EPS * condition
    scale = float(prepared.kinematics.numbers.scale)
    for name, link in parts["links"].items():
        gap = float(data.angle.sel(link=name)[0]) - link["angle"]
        arm = max(np.hypot(*place) for place in link["points"].values())
        # a link without an arm of its own is turned by others over theirs
        assert abs(np.sin(0.5 * gap)) <= allowed * max(1.0, scale / max(arm, 1e-3))


@settings(max_examples=few(2, 15))
@given(higher_descriptions())
def test_constraints_hold_with_two_derivatives(parts: dict[str, Any]) -> None:
    prepared = prepared_of(parts)
    values = prepared.kinematics.path.initial + np.linspace(-0.3, 0.3, 5)
    solved = solve(prepared, grid_at(prepared.kinematics.path, values))
    condition = answer(prepared.mechanism, values)
    assert not (solved.status == ct.Status.UNCONVERGED).any()
    scale = float(prepared.kinematics.numbers.scale)
    for k in range(len(values)):
        if solved.status[0, k] != ct.Status.OK or condition[0, k] > WORTH:
            continue
        at = jet_positions(solved, k)
        speed = 1.0 + float(np.max(np.abs(solved.points[1, 0, k]))) / scale
        speed += float(np.max(np.abs(solved.angles[1, 0, k])))
        # a product of two places, differentiated: errors of one order meet the derivatives of the other
        a0, a1, a2 = 4 * OPERATIONS * EPS * condition[:, k]
        limits = (2 * a0, 2 * (a1 + speed * a0), 2 * (a2 + 2 * speed * a1 + speed**2 * a0))
        assert solved.residual[0, k] <= 1e-12
        for constraint in prepared.structure.constraints:
            unit = 1.0 if constraint.angular else scale
            for residual in constraint.residual(JETS, solved.ready.kinematics.numbers, at):
                jet = residual if isinstance(residual, Jet) else Jet((residual, 0.0, 0.0))
                for order in range(3):
                    assert abs(jet.derivative(order)) <= limits[order] * unit, (constraint.label, order)


@settings(max_examples=few(1, 8))
@given(higher_descriptions())
def test_samples_do_not_know_of_each_other(parts: dict[str, Any]) -> None:
    prepared = prepared_of(parts)
    values = prepared.kinematics.path.initial + np.linspace(-2.0, 2.0, 5)
    together = ct.motion(prepared.mechanism, at=values)
    for k in (0, 3):
        alone = ct.motion(prepared.mechanism, at=values[[k]])
        for name in ("position", "velocity", "acceleration", "angle", "status"):
            assert np.array_equal(alone[name][0], together[name][k], equal_nan=True), name
