"""A fixed sample of the campaign of teeth that enter each other."""

from __future__ import annotations

import pytest
from tools.campaigns.gears.cases import CAMPAIGN


@pytest.mark.parametrize("number", tuple(range(30)))
def test_a_fixed_sample(number: int) -> None:
    outcome = CAMPAIGN.outcome(1, number)
    assert outcome.faults == []
    assert outcome.counts
