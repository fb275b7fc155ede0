"""The letters of the equations at one position: rates from the systems are those of the motion in closed form."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.equations.derivation import Equations
from centrode.equations.instants import instant_of, rates_compared
from centrode.errors import Status
from centrode.model.examples import example_text
from centrode.model.examples.catalogue import load
from samples import examples_at_hand, few

EPS = float(np.finfo(float).eps)
WITH_SLIDES = few("whitworth-quick-return", "scissor-lift-cylinder")


def planar() -> list[str]:
    """Names of the planar mechanisms with unknowns."""
    found = []
    for name in examples_at_hand(ct.example_names()):
        described = load(name) if "kind" not in example_text(name) else None
        if isinstance(described, ct.Mechanism) and described.space == "plane":
            found.append(name)
    return found


@cache
def examined(name: str) -> tuple[Equations, xr.Dataset]:
    """Equations of an example, and its motion at seven samples; not to be changed."""
    mechanism = ct.example(name)
    return ct.equations(mechanism), ct.motion(mechanism, 7)


@pytest.mark.parametrize("name", planar())
def test_systems_give_the_rates_of_the_closed_forms(name: str) -> None:
    equations, motion = examined(name)
    reached = np.flatnonzero(motion.status.to_numpy() == Status.OK)
    assert reached.size
    for sample in reached.tolist():
        instant = instant_of(equations, motion, sample)
        rates = rates_compared(equations, instant, motion, sample)
        assert all(rate.agrees for rate in rates), [r for r in rates if not r.agrees]
        # what is allowed is so little that a sign or a forgotten term would not pass
        assert all(rate.allowed < 1e-5 * max(1.0, abs(rate.solved)) for rate in rates)


def test_constraints_hold_at_every_sample() -> None:
    for name in ("rolling-wheel-rod", "planetary-hypocycloid", WITH_SLIDES, "galloway"):
        equations, motion = examined(name)
        for sample in range(7):
            if motion.status[sample] != Status.OK:
                continue
            instant = instant_of(equations, motion, sample)
            for group in equations.groups:
                for one in group.conditions:
                    terms = [abs(x) for x in instant.values.values() if math.isfinite(x)]
                    assert abs(instant.number(one.residual)) <= 256 * EPS * max(1.0, *terms) ** 2


def test_formulas_are_the_systems_solved() -> None:
    mechanism = ct.example("slider-between-cranks")
    equations = ct.equations(mechanism)
    motion = ct.motion(mechanism, at=[math.pi / 2])
    instant = instant_of(equations, motion, 0)
    omega = {letter.name: x for letter, x in instant.values.items()}
    # the textbook's own closed forms, with its printed angles behind them
    phi2, phi3, phi4 = (omega[f"phi{k}"] for k in (2, 3, 4))
    assert [round(x, 3) for x in (phi2, phi3, phi4)] == [-0.021, 1.602, 3.587]
    under = math.cos(phi2) * math.sin(phi3 - phi4)
    told = -(0.5 / 1.2) * math.cos(phi4) * math.sin(math.pi / 2 - phi2) / under
    assert omega["omega3"] == pytest.approx(told, rel=64 * EPS)
    assert round(omega["omega3"], 3) == -0.411
    together = instant.together
    assert together is not None
    ratio = together.numerators / together.determinant
    assert ratio == pytest.approx(together.solution, abs=256 * EPS * together.condition)


def test_towards_a_dead_point_the_condition_grows_and_beyond_it_there_are_no_rates() -> None:
    mechanism = ct.example("slider-between-cranks-locked")
    limit = ct.rotatability(mechanism).one.limits[-1].value
    equations = ct.equations(mechanism)
    motion = ct.motion(mechanism, at=[limit - 1e-6, limit + 0.1])
    before, beyond = (instant_of(equations, motion, sample) for sample in (0, 1))
    # sin(phi3 - phi4) falls as the square root of what is left
    assert before.velocities[-1].condition > 1e2
    assert np.isnan(beyond.velocities[-1].solution).all() and np.isnan(beyond.velocities[-1].determinant)


def test_the_sphere_is_refused() -> None:
    mechanism = ct.example("spherical-four-bar")
    with pytest.raises(ct.InputError, match="planar mechanisms only"):
        instant_of(ct.equations(mechanism), ct.motion(mechanism, 3), 0)


def test_another_unit_of_length_changes_lengths_alone() -> None:
    equations, motion = examined(WITH_SLIDES)
    middle = 3
    metres, millimetres = (instant_of(equations, motion, middle, length) for length in (1.0, 1e3))
    for group, one, other in zip(equations.groups, metres.velocities, millimetres.velocities, strict=True):
        for unknown, x, y in zip(group.unknowns, one.solution, other.solution, strict=True):
            factor = 1e3 if unknown.name.startswith("slide") else 1.0
            assert y == pytest.approx(factor * x, rel=256 * EPS * one.condition)
    assert [r.closed for r in rates_compared(equations, metres, motion, middle)] == [
        r.closed for r in rates_compared(equations, millimetres, motion, middle)
    ]
