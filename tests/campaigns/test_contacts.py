"""A fixed sample of the campaign of stops and friction, and motions that last."""

from __future__ import annotations

import numpy as np
import pytest
from tools.campaigns.contacts.cases import CAMPAIGN

import centrode as ct


@pytest.mark.parametrize("number", (6,))
def test_a_fixed_sample(number: int) -> None:
    outcome = CAMPAIGN.outcome(1, number)
    assert outcome.faults == []
    assert outcome.counts["impact"] > 0


def test_over_long_times_nothing_creeps_or_sinks_or_gains_energy() -> None:
    """A driven block between walls, on friction, for minutes: it rests, bounces, sticks again and again."""
    block = ct.Mechanism(
        frame={"points": {"O": [0, 0], "Q": [0, 1]}},
        links={
            "block": {"points": {"P": [0, 0]}, "mass": 2},
            "idle": {"points": {"R": [0, 0]}, "mass": 1},
        },
        guides=[
            {"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "block"},
            {"point": "R", "on": "frame", "through": "Q", "direction": [1, 0], "link": "idle"},
        ],
        loads=[
            {"kind": "friction", "guide": "P", "value": 1, "static": 1.5},
            {"kind": "force", "guide": "P", "value": "6*sin(0.7*t)"},
            {"kind": "friction", "guide": "R", "value": 3},
            {"kind": "force", "guide": "R", "value": "2.9*sin(t)"},
        ],
        stops=[{"guide": "P", "least": -1, "most": 1, "restitution": 0.6}],
    )
    run = ct.simulate(block, ct.Simulation(duration=300, samples=1501))
    x = run.slide.sel(guide="P").values
    assert np.all(np.abs(x) <= 1.0 + 1e-12)
    assert np.all(run.slide.sel(guide="R").values == 0.0)
    lost = run.occasion_loss.values
    assert np.all(lost[np.isfinite(lost)] >= 0.0)
    assert np.sum(np.isfinite(lost)) > 150
    turned_over = float(np.abs(run.work_of_friction[-1]))
    assert run.attrs["worst_energy_residual"] < 1e-9 * turned_over
