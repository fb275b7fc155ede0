"""Formulas against motion and structure, which come from closed forms and jets and know nothing of the chains."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings

import centrode as ct
from centrode.equations.derivation import Equations
from centrode.structure.rank import jacobian
from growing import descriptions, mechanism_of
from growing_higher import higher_descriptions
from mechanisms import EPS
from samples import few
from worked_out import Values, condition, initial_values, planar_examples, value_of

WORTH = 1e6
"""Positions whose condition is worse prove nothing about formulas and are passed over."""
OPERATIONS = 512
"""Roundings in a chain, its derivatives and a determinant of four rows, at most, of errors that add up."""


def worth(mechanism: ct.Mechanism) -> bool:
    """Whether the initial position proves anything: it moves on from there, and no group is near a dead point."""
    found = ct.equations(mechanism)
    try:
        values = initial_values(found)
    except (ZeroDivisionError, np.linalg.LinAlgError):
        return False
    status = motion_at_start(mechanism, found).status
    return int(status[0]) == ct.Status.OK and condition(found, values) < WORTH


def compared(mechanism: ct.Mechanism) -> tuple[Equations, Values, float]:
    """Equations, their numbers in the initial position, and what rounding may do to them."""
    found = ct.equations(mechanism)
    values = initial_values(found)
    return found, values, OPERATIONS * EPS * condition(found, values) * len(found.groups or (1,))


def motion_at_start(mechanism: ct.Mechanism, found: Equations) -> Any:
    path = found.board.ready.kinematics.path
    # of a drive with a law, what is asked for is a time
    return ct.motion(mechanism, at=np.array([path.initial if path.parameter.is_uniform else 0.0]))


def check_rates(mechanism: ct.Mechanism) -> None:
    found, values, allowed = compared(mechanism)
    motion = motion_at_start(mechanism, found)
    rates = [abs(values[one.rate]) for one in found.unknowns]
    seconds = [abs(values[one.second]) for one in found.unknowns]
    # errors of one group reach the next with its rates, those of rates reach the accelerations twice
    speed = 1.0 + max(rates, default=0.0)
    limits = (allowed * speed**2, allowed * (speed**3 + speed * max(seconds, default=0.0)))
    for one in found.unknowns:
        kind, _dot, name = one.name.partition(".")
        if kind != "angle" or name not in motion.link.values:
            continue
        for variable, letter, limit in zip(
            ("angular_velocity", "angular_acceleration"), (one.rate, one.second), limits, strict=True
        ):
            assert abs(float(motion[variable].sel(link=name)[0]) - values[letter]) <= limit, (
                one.name,
                variable,
            )
    reach = float(found.board.numbers.scale)
    for point in motion.point.values:
        if point not in found.board.moving:
            continue
        velocity = found.velocity(point)
        known = motion.velocity.sel(point=point)[0]
        for formula, axis in (
            (velocity.x, 0),
            (velocity.y, 1),
            (velocity.closed_x, 0),
            (velocity.closed_y, 1),
        ):
            if formula is not None:
                assert abs(value_of(formula, values) - float(known[axis])) <= limits[0] * max(1.0, reach) * 4


@pytest.mark.parametrize("name", planar_examples())
def test_rates_of_examples(name: str) -> None:
    check_rates(ct.example(name))


@settings(max_examples=few(6, 25))
@given(descriptions())
def test_rates_of_random_mechanisms(parts: dict[str, Any]) -> None:
    mechanism = mechanism_of(parts)
    assume(worth(mechanism))
    check_rates(mechanism)


@settings(max_examples=few(2, 10))
@given(higher_descriptions())
def test_rates_of_random_groups_of_higher_class(parts: dict[str, Any]) -> None:
    mechanism = mechanism_of(parts)
    try:
        usable = worth(mechanism)
    except ct.InputError as error:  # draws that put two points of a group in one place
        assume("the mobility" not in str(error))
        raise
    assume(usable)
    check_rates(mechanism)


def check_determinants(mechanism: ct.Mechanism) -> None:
    """The product of the groups' determinants is the determinant of the Jacobian of all constraints.

    Points and the places of links are eliminated with factors of size 1; the direction of a cylinder or of a radius is
    an unknown more, with a factor of that length.
    """
    found, values, allowed = compared(mechanism)
    structure = found.board.ready.structure
    assert not structure.redundant
    product = 1.0
    for group in found.groups:
        formula = group.determinant_formula
        if formula is None:
            return
        product *= value_of(formula, values)
    at = found.board.ready.assembled.positions
    matrix = jacobian(structure.constraints, structure.unknowns, found.board.numbers, at)
    expected = float(np.linalg.det(matrix))
    for letter, meaning in found.board.alphabet.meanings.items():
        if meaning.kind in ("stroke", "reach"):
            expected *= values[letter]
    limit = allowed * abs(expected) + len(matrix) * EPS * np.linalg.cond(matrix) * abs(expected)
    assert abs(abs(product) - abs(expected)) <= limit


@pytest.mark.parametrize("name", planar_examples())
def test_determinants_of_examples(name: str) -> None:
    if not ct.check(ct.example(name)).redundant:
        check_determinants(ct.example(name))


@settings(max_examples=few(6, 25))
@given(descriptions())
def test_determinants_of_random_mechanisms(parts: dict[str, Any]) -> None:
    mechanism = mechanism_of(parts)
    assume(not ct.check(mechanism).redundant and worth(mechanism))
    check_determinants(mechanism)


@pytest.mark.parametrize("name", planar_examples())
def test_formulas_solve_their_systems_at_any_values(name: str) -> None:
    """Cramer's formulas are identities: they hold at random numbers for all letters, where nothing closes."""
    found = ct.equations(ct.example(name))
    random = np.random.default_rng(7)
    for solution in [one for group in found.groups for one in (group.velocities, group.seconds)]:
        system = solution.system
        if solution.formulas is None:
            continue
        sums = [*system.right, *(entry for row in system.matrix for entry in row)]
        values: Values = {letter: random.uniform(0.5, 2.0) for one in sums for letter in one.letters}
        matrix = np.array([[x.value(np, values.__getitem__) for x in row] for row in system.matrix])
        right = np.array([x.value(np, values.__getitem__) for x in system.right])
        assert system.determinant is not None
        values[solution.under] = value_of(system.determinant, values)
        size = float(np.prod(np.linalg.norm(matrix, axis=1)))
        assert abs(values[solution.under] - np.linalg.det(matrix)) <= OPERATIONS * EPS * size
        solved = np.array([value_of(formula, values) for formula in solution.formulas])
        scale = np.linalg.norm(matrix) * np.linalg.norm(solved) + np.linalg.norm(right)
        allowed = OPERATIONS * EPS * scale * np.linalg.cond(matrix)
        assert np.max(np.abs(matrix @ solved - right)) <= allowed
