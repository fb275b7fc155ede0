"""A fixed sample of the campaign of free motions."""

from __future__ import annotations

import pytest
from tools.campaigns.free_motions.cases import CAMPAIGN


@pytest.mark.parametrize("number", tuple(range(12)))
def test_a_fixed_sample(number: int) -> None:
    outcome = CAMPAIGN.outcome(1, number)
    assert outcome.faults == []
    assert outcome.counts
