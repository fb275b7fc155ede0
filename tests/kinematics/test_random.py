"""Random mechanisms: closed to rounding, velocities and accelerations solve the differentiated constraints."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import assume, given, settings

import centrode as ct
from centrode.geometry.plane import PlanePose
from centrode.kinematics.path import JETS
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import Solved
from centrode.numerics.jets import Jet
from centrode.structure.constraints import Entity, Positions, is_drive
from centrode.structure.rank import jacobian
from growing import descriptions, mechanism_of
from jetted import jet_positions
from mechanisms import EPS, conditioning, on_branch, solve_evenly
from samples import few

WIDTH = 0.3
SAMPLES = 7
WORTH = 1e5
"""Positions whose condition is worse than this prove nothing about formulas and are passed over."""


def motion_about_the_start(parts: dict[str, Any]) -> tuple[Solved, list[int], Any]:
    """A motion around the initial position, its samples worth a look, and what rounding may do to them."""
    prepared = ready(mechanism_of(parts))
    q = prepared.kinematics.path.initial
    solved = solve_evenly(prepared, SAMPLES, q - WIDTH, q + WIDTH)
    condition = conditioning(solved, tries=4)
    good = [k for k in range(SAMPLES) if solved.status[0, k] == ct.Status.OK and condition[0, k] < WORTH]
    assume(good)
    return solved, good, 16 * EPS * condition


@settings(max_examples=few(12, 60))
@given(descriptions())
def test_constraints_hold_with_two_derivatives(parts: dict[str, Any]) -> None:
    solved, good, allowed = motion_about_the_start(parts)
    numbers = solved.ready.kinematics.numbers
    scale = float(numbers.scale)
    for k in good:
        at = jet_positions(solved, k)
        speed = 1.0 + max(
            np.max(np.abs(solved.points[1, 0, k])) / scale, np.max(np.abs(solved.angles[1, 0, k]))
        )
        # a product of two places, differentiated: errors of one order meet the derivatives of the other
        a0, a1, a2 = allowed[:, k]
        limits = (2 * a0, 2 * (a1 + speed * a0), 2 * (a2 + 2 * speed * a1 + speed**2 * a0))
        assert solved.residual[0, k] <= limits[0]
        for constraint in solved.ready.structure.constraints:
            for residual in constraint.residual(JETS, numbers, at):
                unit = 1.0 if constraint.angular else scale
                jet = residual if isinstance(residual, Jet) else Jet((residual, 0.0, 0.0))
                for order in range(3):
                    assert abs(jet.derivative(order)) <= limits[order] * unit, (constraint.label, order)


@settings(max_examples=few(8, 30))
@given(descriptions())
def test_velocities_solve_the_linear_equations(parts: dict[str, Any]) -> None:
    """J x' is 1 in the drive's row and 0 in all others."""
    solved, good, allowed = motion_about_the_start(parts)
    structure = solved.ready.structure
    scale = float(structure.dimensions.scale)
    for k in good:
        jets = jet_positions(solved, k)
        at = Positions(
            {name: tuple(plain(x) for x in v) for name, v in jets.points.items()},  # type: ignore[misc]
            {
                name: PlanePose(*(tuple(plain(x) for x in v) for v in pose))
                for name, pose in jets.poses.items()
            },  # type: ignore[arg-type]
            {"link0": solved.span.parameter[k]},
        )
        rates = np.concatenate([rate_of(entity, jets, solved, k) for entity in structure.unknowns])
        rows = jacobian(structure.constraints, structure.unknowns, solved.ready.kinematics.numbers, at)
        known = [1.0 if is_drive(c) else 0.0 for c in structure.constraints for _ in range(c.size)]
        limit = 4 * (allowed[1, k] + np.max(np.abs(rates)) * allowed[0, k]) * max(scale, 1.0)
        assert np.max(np.abs(rows @ rates - known)) <= limit


def plain(x: Any) -> float:
    return float(x.value if isinstance(x, Jet) else x)


def slope(x: Any) -> float:
    return float(x.derivative(1)) if isinstance(x, Jet) else 0.0


def rate_of(entity: Entity, jets: Positions, solved: Solved, sample: int) -> list[float]:
    if entity.kind == "point":
        return [slope(x) for x in jets.points[entity.name]]
    turning = solved.angles[1, 0, sample, solved.layout.links.index(entity.name)]
    return [*(slope(x) for x in jets.poses[entity.name].origin), float(turning)]


@settings(max_examples=few(8, 30))
@given(descriptions())
def test_higher_jets_foretell_the_motion(parts: dict[str, Any]) -> None:
    """The Taylor series of order 12 at one value of the drive gives the positions at another."""
    solved, good, allowed = motion_about_the_start(parts)
    kinematics = solved.ready.kinematics
    at_start = np.array([kinematics.path.initial])
    step = 1e-3

    here = kinematics.positions(JETS, Jet.variable(at_start, 12), on_branch(solved, at_start))
    there = solve_evenly(solved.ready, 1, float(at_start[0] + step), float(at_start[0] + step))
    assume(there.status[0, 0] == ct.Status.OK and SAMPLES // 2 in good)
    error = np.max(allowed[0, SAMPLES // 2]) + 16 * EPS * conditioning(there, tries=4)[0, 0]
    scale = float(kinematics.numbers.scale)
    exact_step = float(there.span.parameter[0]) - float(at_start[0])
    for k, name in enumerate(solved.layout.points):
        for axis in (0, 1):
            jet = here.points[name][axis]
            if isinstance(jet, Jet):
                terms = [
                    float(c[0]) * exact_step**n for n, c in enumerate(map(np.atleast_1d, jet.coefficients))
                ]
                # the last terms bound the rest, as the step is short against the distance to a limit
                rest = 4 * max(abs(t) for t in terms[-3:])
                gap = abs(sum(terms) - there.points[0, 0, 0, k, axis])
                assert gap <= rest + scale * error
