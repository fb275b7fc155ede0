"""A fixed sample of the campaign of free motions."""

from __future__ import annotations

import pytest
from tools.campaigns.free_motions.cases import CAMPAIGN


@pytest.mark.parametrize("number", (0, 1, 3, 4, 5, 6, 7, 11))
def test_a_fixed_sample(number: int) -> None:
    outcome = CAMPAIGN.outcome(1, number)
    assert outcome.faults == []
    assert outcome.counts
