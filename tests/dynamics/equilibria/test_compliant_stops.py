"""Equilibria on compliant stops, against closed forms of rods and the energy of a chain."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, minimize

import centrode as ct

G = 9.81
ROD = {"length": 1, "mass": 1, "shape": "rod"}
BUFFER = {"name": "buffer", "link": "OA", "least": -0.5, "most": 2.5, "stiffness": 200, "damping": 2}


def rod(*stops: dict[str, Any], angle: float = 0.2, **parts: Any) -> ct.Mechanism:
    return ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {**ROD, "angle": angle}},
        stops=stops,
        **parts,
    )


def moment(a: float) -> float:
    """Of the weight and the buffer."""
    return -0.5 * G * math.cos(a) + 200 * max(-0.5 - a, 0.0) - 200 * max(a - 2.5, 0.0)


def test_a_rod_rests_on_both_buffers_and_swings_with_their_stiffness() -> None:
    found = ct.equilibrium(rod(BUFFER))
    exact = [brentq(moment, -0.7, -0.5, xtol=1e-15), brentq(moment, 2.5, 2.7, xtol=1e-15), math.pi / 2]
    assert np.allclose(found.angle[:, 0], exact, rtol=0.0, atol=1e-13)
    assert np.allclose(
        found.restraint_force[:, 0], [200 * (-0.5 - exact[0]), -200 * (exact[1] - 2.5), 0.0], rtol=1e-11
    )
    for k, a in enumerate(exact[:2]):
        # J s^2 + d s + k + d^2 V / d a^2
        roots = np.roots([1 / 3, 2.0, 200 - 0.5 * G * math.sin(a)])
        assert math.isclose(float(found.growth_rate[k, 0]), roots[0].real, rel_tol=1e-12)
        assert math.isclose(float(found.damped_frequency[k, 0]), abs(roots[0].imag), rel_tol=1e-12)
    energy = 0.5 * G * math.sin(exact[0]) + 100 * (-0.5 - exact[0]) ** 2
    assert math.isclose(float(found.potential_energy[0]), energy, rel_tol=1e-12)
    modes = ct.modes(rod(BUFFER))
    assert math.isclose(float(modes.undamped_frequency[0]) ** 2 / 3, 200 - 0.5 * G * math.sin(exact[0]))


def test_a_compliant_stop_and_a_rigid_one_hold_together() -> None:
    found = ct.equilibrium(rod({**BUFFER, "most": None}, {"link": "OA", "most": 2.5, "name": "edge"}))
    places = found.angle.values[:, 0]
    forces = dict(zip(np.round(places, 3).tolist(), found.restraint_force.values.tolist(), strict=True))
    assert set(forces) == {round(brentq(moment, -0.7, -0.5), 3), 1.571, 2.5}
    assert np.allclose(forces[2.5], [0.0, 0.5 * G * math.cos(2.5)])


def test_a_chain_lies_on_a_compliant_floor_where_its_energy_is_least() -> None:
    stiffness, floor = 400.0, -1.5
    chain = ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {**ROD, "angle": -1.2}, "AB": {**ROD, "angle": -1.3}},
        stops=[{"point": "B", "direction": [0, 1], "least": floor, "stiffness": stiffness}],
    )

    def energy(q: np.ndarray) -> float:
        height = math.sin(q[0]) + math.sin(q[1])
        return (
            G * (1.5 * math.sin(q[0]) + 0.5 * math.sin(q[1])) + 0.5 * stiffness * max(floor - height, 0) ** 2
        )

    least = min(
        (minimize(energy, [a, b], tol=1e-14) for a in (-2.0, -1.0) for b in (-2.5, -0.5)), key=lambda x: x.fun
    )
    found = ct.equilibrium(chain)
    k = int(np.argmin(found.potential_energy.values))
    assert math.isclose(float(found.potential_energy[k]), least.fun, rel_tol=1e-9)
    assert float(found.growth_rate[k].max()) <= 1e-9
    # half the weight of the second rod, as where it lies on a rigid floor
    assert abs(float(found.restraint_force[k, 0]) - 0.5 * G) < 1e-9


def test_an_equilibrium_is_followed_through_the_closing_of_a_stop() -> None:
    lifted = rod(
        BUFFER,
        loads=[
            {"kind": "spring", "link": "OA", "stiffness": 2, "free_angle": 0},
            {"name": "M", "kind": "torque", "link": "OA", "value": 1},
        ],
    )
    found = ct.equilibrium(lifted, vary={"loads.M.value": (0, 8)})
    kinds = found.critical_kind.attrs["flag_meanings"].split()
    at = {
        (kinds[k], round(float(x), 4)): float(value)
        for k, x, value in zip(
            found.critical_kind.values, found.critical_coordinate.values[:, 0], found.critical_value.values,
            strict=True,
        )
    }  # fmt: skip
    assert at["kink", -0.5] == pytest.approx(0.5 * G * math.cos(0.5) - 1.0, abs=1e-5)
    assert at["kink", 2.5] == pytest.approx(0.5 * G * math.cos(2.5) + 5.0, abs=1e-5)
    # between the buffers the moment is greatest where the spring is as stiff as the weight is soft
    fold = math.asin(2 / (0.5 * G))
    assert at["fold", round(fold, 4)] == pytest.approx(0.5 * G * math.cos(fold) + 2 * fold, abs=1e-9)


def test_a_gap_in_which_nothing_acts_is_named() -> None:
    flap = ct.Mechanism(
        frame={"points": {"O": [0, 0]}}, links={"OA": {**ROD, "angle": 0.5}}, stops=[{**BUFFER, "most": 1.5}]
    )
    with pytest.raises(ct.InputError, match="rad of OA: every position"):
        ct.equilibrium(flap)
