"""The first minutes of the motions that last ten thousand seconds."""

from __future__ import annotations

import pytest
from tools.campaigns.long_runs import cases


@pytest.mark.parametrize("number", range(len(cases.CASES)))
def test_nothing_sinks_creeps_or_gains_energy(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cases, "DURATION", 100.0)
    monkeypatch.setattr(cases, "SAMPLES", 501)
    assert cases.CAMPAIGN.outcome(1, number).faults == []
