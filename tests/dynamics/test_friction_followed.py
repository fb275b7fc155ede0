"""Sizes of friction that feed on themselves: f = c |R_0 + G f| by closed forms and by plain iteration."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from centrode.dynamics.kinetostatics.friction import (
    LEAST_STEP,
    Followed,
    FrictionLaw,
    FrictionRule,
    Outcome,
    solve_friction,
)
from mechanisms import EPS
from samples import few


def one(factor: float, base: complex, gain: complex, rule: FrictionRule = FrictionRule.LENGTH) -> Followed:
    """A single size at one position."""
    parts = np.array([[[base.real, base.imag]]]), np.array([[[[gain.real], [gain.imag]]]])
    return solve_friction(FrictionLaw(np.array([[factor]]), *parts, np.array([rule], dtype=np.int8)))


@pytest.mark.parametrize("gain", [0.0, 0.5, -0.5, -3.0, -40.0, 0.999])
def test_one_normal_force(gain: float) -> None:
    """f = |1 + g f| is 1/(1 - g): for g below -1 there is another, at which the force has turned round."""
    found = one(1.0, 1.0, gain)
    assert found.outcome[0] == Outcome.FOUND
    assert found.share[0] == 1.0
    assert math.isclose(
        found.sizes[0, 0], 1 / (1 - gain), rel_tol=64 * EPS * max(1, abs(gain)) / (1 - max(gain, 0))
    )


@pytest.mark.parametrize("gain", [1.0, 1.001, 5.0])
def test_one_normal_force_that_grows_without_end(gain: float) -> None:
    found = one(1.0, 1.0, gain)
    assert found.outcome[0] == Outcome.LOCKED
    # it goes to infinity where the coefficient reaches 1/g
    assert abs(found.share[0] - 1 / gain) <= 4 * LEAST_STEP


def test_a_force_that_turns_back() -> None:
    """f = c |1j - 0.5 + f|: two solutions that grow together and meet where the discriminant is zero."""
    base, size = complex(-0.5, 1.0), abs(complex(-0.5, 1.0))
    # (1 - c^2) f^2 + c^2 f - c^2 size^2 = 0 has a positive root that is continuous from c = 0 on for c < 1
    for factor in (0.2, 0.9, 0.99):
        square = factor**2
        wanted = (-square + math.sqrt(square**2 + 4 * (1 - square) * square * size**2)) / (2 * (1 - square))
        assert math.isclose(one(factor, base, 1.0).sizes[0, 0], wanted, rel_tol=1e4 * EPS)
    # beyond c = 1 the two roots are positive, and complex from 4 c^2 (c^2 - 1) size^2 > c^4 on
    last = math.sqrt(size**2 / (size**2 - 0.25))
    assert one(0.999 * last, base, 1.0).outcome[0] == Outcome.FOUND
    end = one(2.0, base, 1.0)
    assert end.outcome[0] == Outcome.LOCKED
    assert abs(2.0 * end.share[0] - last) <= math.sqrt(LEAST_STEP)


def test_the_greater_of_two_and_the_signed() -> None:
    assert one(0.5, complex(1.0, -3.0), 0.0, FrictionRule.GREATER).sizes[0, 0] == 1.5
    assert one(0.5, complex(-1.0, 0.0), 0.0, FrictionRule.FIRST).sizes[0, 0] == -0.5
    # |N| until the moment's part, which friction makes greater, overtakes it: f = |1 + 2 f| / 4 there
    found = one(0.25, complex(1.2, 1.0), complex(0.0, 2.0), FrictionRule.GREATER)
    assert math.isclose(found.sizes[0, 0], 0.5, rel_tol=64 * EPS)


def test_no_size_and_no_force() -> None:
    assert one(0.3, 0.0, 0.7).sizes[0, 0] == 0.0
    assert one(0.0, 1.0, 5.0).sizes[0, 0] == 0.0
    empty = solve_friction(
        FrictionLaw(np.zeros((0, 2)), np.zeros((0, 2, 2)), np.zeros((0, 2, 2, 2)), np.zeros(2, dtype=np.int8))
    )
    assert empty.sizes.shape == (0, 2)


@settings(max_examples=few(10, 60), deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 6))
def test_where_little_feeds_back_plain_iteration_comes_to_the_same(seed: int, width: int) -> None:
    random = np.random.default_rng(seed)
    count = 5
    gain = random.normal(size=(count, width, 2, width))
    law = FrictionLaw(
        random.choice([-1.0, 1.0], (count, width)) * random.uniform(0.0, 1.0, (count, width)),
        random.normal(size=(count, width, 2)),
        gain,
        random.choice(
            np.array([FrictionRule.LENGTH, FrictionRule.GREATER, FrictionRule.FIRST], dtype=np.int8), width
        ),
    )
    law = FrictionLaw(
        law.factor * (0.7 / np.maximum(law.feedback, 0.7))[:, None], law.base, law.gain, law.rules
    )
    found = solve_friction(law)
    assert (found.outcome == Outcome.FOUND).all()
    sizes = np.zeros((count, width))
    for _round in range(400):  # 0.7^400 is nothing beside rounding
        sizes = law.factor * law.measures(sizes)[0]
    # rounding of each measure, which feeds back: the sum of the powers of the shares that sizes add
    shares = np.abs(law.factor)[..., None] * np.linalg.norm(law.gain, axis=2)
    grown = np.linalg.inv(np.eye(width) - shares).sum(axis=(1, 2))
    assert (
        abs(found.sizes - sizes).max(axis=1) <= 64 * width * EPS * grown * (1 + abs(sizes).max(axis=1) * 10)
    ).all()


@settings(max_examples=few(10, 30), deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 4))
def test_what_is_followed_solves_and_joins_on_to_no_friction(seed: int, width: int) -> None:
    """With strong feedback too; sizes of a hair less friction are a hair less far along the same branch."""
    random = np.random.default_rng(seed)
    law = FrictionLaw(
        random.uniform(0.2, 2.0, (8, width)),
        random.normal(size=(8, width, 2)),
        random.normal(size=(8, width, 2, width)),
        np.full(width, FrictionRule.LENGTH, dtype=np.int8),
    )
    found = solve_friction(law)
    assert (found.outcome != Outcome.LOST).all()
    good = found.outcome == Outcome.FOUND
    assert (found.sizes[good] >= 0).all()
    assert (found.residual[good] <= 1e4 * EPS).all()
    assert (np.linalg.det(law.at(good).residual(found.sizes[good], np.ones(good.sum()))[1]) > 0).all()
    # a branch that ends at some share is there at any less
    locked = found.outcome == Outcome.LOCKED
    if locked.any():
        part = law.at(locked)
        less = FrictionLaw(
            part.factor * (0.999 * found.share[locked])[:, None], part.base, part.gain, part.rules
        )
        assert (solve_friction(less).outcome == Outcome.FOUND).all()
