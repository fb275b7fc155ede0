"""A fixed sample of the campaign of spherical chains."""

from __future__ import annotations

import pytest
from tools.campaigns.spheres.cases import CAMPAIGN


@pytest.mark.parametrize("number", (0, 1, 3, 8))
def test_a_fixed_sample(number: int) -> None:
    outcome = CAMPAIGN.outcome(1, number)
    assert outcome.faults == []
    assert outcome.counts
