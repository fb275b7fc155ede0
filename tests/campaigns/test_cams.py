"""A fixed sample of the campaign of plate cams."""

from __future__ import annotations

import pytest
from tools.campaigns.cams.cases import CAMPAIGN


@pytest.mark.parametrize("number", tuple(range(10)))
def test_a_fixed_sample(number: int) -> None:
    outcome = CAMPAIGN.outcome(1, number)
    assert outcome.faults == []
    assert outcome.counts
