"""Shafts and flywheels in the equations of all links, and drives that keep laws of tables and segments."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct
from free_motions import FOUR_BAR

ARM = """\
gravity = [0, -9.81]
[frame.points]
O = [0, 0]
[links.OA]
length = 1
mass = 1
shape = "rod"
[links.AB]
length = 0.7
mass = 0.7
shape = "rod"
angle = 0.3
[[drives]]
link = "OA"
start = 0.2
{law}
[simulation]
keeps = ["OA"]
duration = 2
tolerance = 1e-10
"""
LAWS = {
    "table": "table = [[0, 0], [0.5, 0.4], [1.2, -0.3], [2.5, 1.0]]",
    "segments": 'segments = [{ to = 0.5, time = 0.7, curve = "cycloidal" }, { time = 2, curve = "dwell" }]',
    "again": "repeat = true\n"
    'segments = [{ to = 0.5, time = 0.7, curve = "cycloidal" }, { to = 0, time = 0.6, curve = "cycloidal" }]',
}


def test_a_flywheel_slows_both_routes_alike() -> None:
    text = FOUR_BAR.replace('start = "60 deg"', 'start = "60 deg"\nspeed = 1')
    text += "[machine]\n[[machine.shafts]]\ninertia = 0.05\nratio = 2\n[machine.flywheel]\ninertia = 0.1\n"
    mechanism = ct.parse_mechanism(text)
    assert mechanism.simulation is not None
    tight = mechanism.simulation.model_copy(update={"tolerance": 1e-11, "duration": 1.0})
    at = [0.3, 0.7, 1.0]
    reduced = ct.simulate(mechanism, tight, at=at)
    full = ct.simulate(mechanism, tight.model_copy(update={"equations": "multibody"}), at=at, reactions=True)
    assert np.abs(reduced["drive_value"].values - full["drive_value"].values).max() <= 1e-9
    energy = reduced["kinetic_energy"].values
    assert np.abs(energy - full["kinetic_energy"].values).max() <= 1e-9 * energy.max()
    # the flywheel's moment is borne where statics say
    assert full.attrs["worst_imbalance"] <= 1e-12


@pytest.mark.parametrize("law", LAWS)
def test_a_drive_keeps_its_law(law: str) -> None:
    mechanism = ct.parse_mechanism(ARM.format(law=LAWS[law]))
    at = np.array([0.3, 1.0, 1.9])
    run = ct.simulate(mechanism, at=at)
    alone = ct.parse_mechanism(
        ARM.format(law=LAWS[law]).replace("angle = 0.3", "")
        + '[[drives]]\nlink = "AB"\nstart = 0.3\nspeed = 0\n'
    )
    motion = ct.motion(alone, at=at)
    assert (
        np.abs(run["drive_value"].values[:, 0] - motion["drive_value"].sel(drive="OA").values).max() <= 1e-9
    )
    assert run.attrs["worst_energy_residual"] <= 1e-8
