"""Critical values against closed forms: folds, branch points and Hopf points."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.equilibria.critical_values import BRANCH_POINT, FOLD, HOPF, KINDS
from sprung import pendulum


def test_a_moment_folds_where_the_weight_can_no_longer_balance_it() -> None:
    loaded = pendulum(loads=[{"kind": "torque", "link": "OA", "value": 1.0}])
    found = ct.equilibrium(loaded, vary={"loads.torque OA.value": (-6, 6)})
    kinds = [KINDS[k] for k in found.critical_kind.values]
    assert kinds == [FOLD, FOLD]
    # at a fold the number does not change to the first order: it is known to rounding
    assert np.allclose(found.critical_value.values, [-9.81 / 2, 9.81 / 2], rtol=1e-12)
    assert np.allclose(np.cos(found.critical_coordinate.values[:, 0]), [-1, 1], atol=1e-12)
    # it goes round: one closed branch
    assert set(found.branch.values.tolist()) == {1}


def test_an_upright_rod_buckles_where_its_spring_is_as_stiff_as_its_weight_turns_it_over() -> None:
    upright = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1, "mass": 1, "shape": "rod", "angle": "90 deg"}},
        loads=[{"kind": "spring", "link": "OA", "stiffness": 3.0, "free_angle": "90 deg"}],
    )
    (name,) = (load.label for load in upright.loads)
    found = ct.equilibrium(upright, vary={f"loads.{name}.stiffness": ("2 N m/rad", "8 N m/rad")})
    assert [KINDS[k] for k in found.critical_kind.values] == [BRANCH_POINT]
    # sought by a determinant that vanishes to the first order where positions are known to the root of rounding
    assert math.isclose(float(found.critical_value[0]), 9.81 / 2, rel_tol=1e-6)
    # the bent equilibria satisfy k x = m g l / 2 sin x
    bent = found.branch.values == 2
    apart = found.branch_coordinate.values[bent, 0] - math.pi / 2
    left = found.branch_value.values[bent] * apart - 9.81 / 2 * np.sin(apart)
    assert bent.sum() > 10
    assert np.max(np.abs(left)) < 1e-9


def test_a_damper_that_drives_begins_oscillations() -> None:
    driven = pendulum(
        loads=[
            {"kind": "damper", "link": "OA", "damping": 0.5},
            {"kind": "torque", "link": "OA", "value": "0.2*v"},
        ]
    )
    (name,) = (load.label for load in driven.loads if load.kind == "damper")
    found = ct.equilibrium(driven, vary={f"loads.{name}.damping": (0.05, 0.6)})
    hopf = [k for k, kind in enumerate(found.critical_kind.values) if KINDS[kind] == HOPF]
    assert len(hopf) == 1
    assert math.isclose(float(found.critical_value[hopf[0]]), 0.2, rel_tol=1e-9)
    assert math.isclose(float(found.critical_frequency[hopf[0]]), math.sqrt(1.5 * 9.81), rel_tol=1e-9)


def test_a_length_moves_equilibria_as_new_descriptions_have_them() -> None:
    two = pendulum(loads=[{"kind": "torque", "link": "OA", "value": 2.0}])
    found = ct.equilibrium(two, vary={"links.OA.length": (0.8, 1.2)})
    ends = np.flatnonzero(found.branch_value.values == 1.2)
    fresh = ct.equilibrium(ct.with_value(two, "links.OA.length", 1.2)).generalised_coordinate.values[:, 0]
    for k in ends:
        apart = np.abs(np.exp(1j * fresh) - np.exp(1j * found.branch_coordinate.values[k, 0]))
        assert apart.min() < 1e-10


def test_a_number_that_is_no_number_of_the_equations_is_refused() -> None:
    with pytest.raises(ct.InputError):
        ct.equilibrium(pendulum(), vary={"links.OA.width": (1, 2)})
