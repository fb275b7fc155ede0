"""Several drives: the textbook's arm, and energy and power straight from motions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import centrode as ct
from burdened import burdened, kinetic_energy, powers
from centrode.kinematics.path import JETS
from centrode.model.examples import example_text
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from mechanisms import EPS, parts_of

TIMES = np.linspace(0.0, 1.4, 7)


def arm(relative: bool) -> ct.Mechanism:
    """Two rods with their centres off the line, two motors."""
    second: dict[str, Any] = {"link": "AB", "start": 0.7, "law": "0.4*sin(3*t)"}
    if relative:
        second["relative_to"] = "OA"
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0]}},
        links={
            "OA": {"length": 0.5, "mass": 3, "centre": [0.2, 0.1], "inertia": 0.3},
            "AB": {"length": 0.8, "mass": 2, "centre": [0.4, 0], "inertia": 0.2},
        },
        drives=[{"link": "OA", "start": 0.2, "law": "0.9*t**2"}, second],
        gravity=[0, -10],
        loads=[{"kind": "damper", "link": "AB", "relative_to": "OA", "damping": 1.5}],
    )


@pytest.mark.parametrize("relative", [True, False])
def test_an_arm_of_two_links(relative: bool) -> None:
    """Inertia matrix and Christoffel terms of the textbooks; the second angle from the frame or from the first link."""
    data = ct.reduce(arm(relative), at=TIMES)
    a, b = data.drive_value.to_numpy().T
    turn = b if relative else b - a  # of the second link against the first
    second, first = 2 * 0.16 + 0.2, 3 * 0.05 + 0.3 + 2 * 0.25
    coupling, slope = 2 * 0.5 * 0.4 * np.cos(turn), -2 * 0.5 * 0.4 * np.sin(turn)
    if relative:
        matrix = [[first + second + 2 * coupling, second + coupling], [second + coupling, second + 0 * a]]
        terms = {(0, 1, 0): slope, (1, 0, 0): slope, (1, 1, 0): slope, (0, 0, 1): -slope}
    else:
        matrix = [[first + 0 * a, coupling], [coupling, second + 0 * a]]
        terms = {(1, 1, 0): slope, (0, 0, 1): -slope}
    found = data.inertia_matrix.to_numpy()
    christoffel = data.christoffel.to_numpy()
    for i in range(2):
        for j in range(2):
            assert np.allclose(found[:, i, j], matrix[i][j], rtol=0, atol=64 * EPS * 2)
            for k in range(2):
                assert np.allclose(
                    christoffel[:, i, j, k], terms.get((i, j, k), 0.0), rtol=0, atol=64 * EPS * 2
                )
    down = -2 * 10 * np.array([0.5 * np.cos(a), 0.4 * np.cos(a + turn)])
    own = -3 * 10 * (0.2 * np.cos(a) - 0.1 * np.sin(a))
    rates = [1.8 * TIMES, 1.2 * np.cos(3 * TIMES)]
    rub = -1.5 * (rates[1] - (0 if relative else rates[0]))
    forces = [
        own + down[0] + (down[1] if relative else 0) - (0 if relative else rub),
        down[1] + rub,
    ]
    for i in range(2):
        assert np.allclose(data.generalised_force[:, i], forces[i], rtol=0, atol=64 * EPS * 40)
    parts = data.generalised_force_part.sum("load") - data.generalised_force
    assert abs(parts).max() <= 16 * EPS * 40


@pytest.mark.parametrize("name", ["two-link-arm", "five-bar-two-drives", "excavator-arm"])
def test_energy_and_power_are_those_of_the_motion(name: str) -> None:
    parts = parts_of(ct.example(name))
    parts = loaded_parts(ct.example(name), parts)
    mechanism = ct.Mechanism(**parts)
    ends = {"samples": 9}
    data, reduced = ct.motion(mechanism, **ends), ct.reduce(mechanism, **ends)
    rates = rates_of(mechanism, data.time.to_numpy())
    ok = reduced.status.to_numpy() == ct.Status.OK
    assert ok.sum() >= 7
    for link, energy in kinetic_energy(mechanism, data).items():
        matrix = reduced.inertia_matrix_part.sel(link=link).to_numpy()
        twice = np.einsum("nij,ni,nj->n", matrix, rates, rates)
        sizes = np.einsum("nij,ni,nj->n", abs(matrix), abs(rates), abs(rates))
        assert np.max(abs(0.5 * twice - energy)[ok]) <= 4096 * EPS * float(np.max(sizes[ok]))
    for k, power in enumerate(powers(mechanism, data)):
        force = reduced.generalised_force_part.isel(load=k).to_numpy()
        given = np.einsum("ni,ni->n", force, rates)
        size = float(np.max((abs(force) * abs(rates)).sum(axis=1)[ok])) + 1.0
        assert np.max(abs(given - power)[ok]) <= 4096 * EPS * size, reduced["load"][k]


def loaded_parts(mechanism: ct.Mechanism, parts: dict[str, Any]) -> dict[str, Any]:
    """Every link with the coordinates of its points, so that masses can be drawn anywhere on it."""
    for name, body in parts["links"].items():
        body.pop("length", None)
        body["points"] = {point: list(at) for point, at in mechanism.links[name].coordinates.items()}
    for guide, given in zip(mechanism.guides, parts.get("guides", []), strict=True):
        given["name"] = guide.id
    parts = {**parts, "guides": parts.get("guides", [])}
    found = burdened(parts, 11)
    found["loads"] = [load for load in found["loads"] if "q" not in str(load.get("vector"))]
    return found


def rates_of(mechanism: ct.Mechanism, times: Any) -> Any:
    """Rates of the drives, by their laws."""
    laws = [drive.motion_law.jet(JETS, Jet.variable(times, 1)) for drive in mechanism.drives]
    rates = [law.derivative(1) if isinstance(law, Jet) else 0.0 for law in laws]
    return np.stack([ARRAYS.sqrt(np.ones(len(times))) * rate for rate in rates], axis=-1)


def test_the_drive_has_no_single_value() -> None:
    parts = example_text("two-link-arm") + '\n[[loads]]\nkind = "torque"\nlink = "OA"\nvalue = "3*q"\n'
    with pytest.raises(ct.InputError, match="several drives"):
        ct.reduce(ct.parse_mechanism(parts))


def test_units_with_drives_of_several_kinds() -> None:
    crane = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"jib": {"points": {"O": [0, 0], "K": [3, 0]}, "mass": 5, "shape": "rod"}},
        guides=[{"point": "P", "on": "jib", "through": [0, 0.2], "direction": [1, 0]}],
        drives=[{"link": "jib", "start": 0.5, "speed": 0.2}, {"guide": "P", "start": 1, "speed": 0.1}],
        gravity=[0, -10],
        loads=[{"kind": "weight", "point": "P", "value": 20}],
        study={"to": 2},
    )
    data = ct.reduce(crane, samples=3)
    assert data.inertia_matrix.attrs["units"] == "kg m^2, kg m, kg m, kg"
    assert data.generalised_force.attrs["units"] == "N m, N"
    assert data.christoffel.attrs["units"].startswith("kg m^2, kg m, kg m, kg, kg m")
    angle = data.drive_value[:, 0]
    assert np.allclose(data.generalised_force_part.sel(load="weight P", drive="P"), -20 * np.sin(angle))
