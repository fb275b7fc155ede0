"""Reactions at the instants of a free motion, against printed values, kept drives and the equations of statics."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from free_motions import DOUBLE_PENDULUM, FIVE_BAR, FOUR_BAR, SPHERICAL_FOUR_BAR, squares, table


def simulated(text: str, at: object, **changes: object) -> xr.Dataset:
    mechanism = ct.parse_mechanism(text)
    assert mechanism.simulation is not None
    update = {"equations": "multibody", "tolerance": 1e-12, **changes}
    return ct.simulate(mechanism, mechanism.simulation.model_copy(update=update), at=at, reactions=True)


def test_hinge_of_the_four_bar_against_its_table() -> None:
    known = table("four-bar-reactions-forces")
    run = simulated(FOUR_BAR, known["t"])
    found = run["joint_force"].sel(side="C/DC").values
    expected = np.array([known["Cx"], known["Cy"]]).T
    # the slope of a force along the motion times the error of the angle
    assert np.abs(found - expected).max() <= 1e-7 * np.abs(expected).max()


@pytest.mark.parametrize("text", [FOUR_BAR, FIVE_BAR, DOUBLE_PENDULUM, SPHERICAL_FOUR_BAR, squares(2)])
def test_free_drives_give_nothing(text: str) -> None:
    """By the equations of kinetostatics, which know nothing of the forward dynamics."""
    run = simulated(text, [0.05, 0.2], duration=0.2)
    assert run.attrs["worst_imbalance"] <= 1e-12
    assert run["determined"].values.all()


def test_what_redundant_constraints_leave_open_is_masked() -> None:
    parallel = """\
gravity = [0, -9.81]
[frame.points]
A = [0, 0]
B = [1, 0]
C = [2, 0]
[links.A1]
points = { A = [0, 0], D = [0.5, 0] }
mass = 1
inertia = 0.1
centre = [0.25, 0]
angle = 1.0
[links.B1]
points = { B = [0, 0], E = [0.5, 0] }
mass = 1
inertia = 0.1
centre = [0.25, 0]
angle = 1.0
[links.C1]
points = { C = [0, 0], F = [0.5, 0] }
mass = 1
inertia = 0.1
centre = [0.25, 0]
angle = 1.0
[links.bar]
points = { D = [0, 0], E = [1, 0], F = [2, 0] }
mass = 1
inertia = 0.1
centre = [1, 0]
angle = 0
[simulation]
duration = 0.2
"""
    run = simulated(parallel, [0.1, 0.2])
    forces = run["joint_force"]
    assert not run["determined"].values.all()
    assert np.isnan(forces.sel(side="E/bar").values).any()
    assert run.attrs["worst_imbalance"] <= 1e-11


def test_the_reduced_equation_has_none() -> None:
    mechanism = ct.parse_mechanism(FOUR_BAR.replace('start = "60 deg"', 'start = "60 deg"\nspeed = 1'))
    with pytest.raises(ct.InputError, match="all links"):
        ct.simulate(mechanism, reactions=True)
