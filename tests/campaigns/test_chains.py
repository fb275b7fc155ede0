"""A fixed sample of the campaign of random chains."""

from __future__ import annotations

import pytest
from tools.campaigns.chains.cases import CAMPAIGN


@pytest.mark.parametrize("number", (1, 3, 8, 10, 15))
def test_a_fixed_sample(number: int) -> None:
    outcome = CAMPAIGN.outcome(1, number)
    assert outcome.faults == []
    assert outcome.counts
