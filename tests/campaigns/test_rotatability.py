"""A fixed sample of the campaign of closed forms: each case is a thousand mechanisms."""

from __future__ import annotations

import pytest
from tools.campaigns.rotatability.cases import CAMPAIGN


@pytest.mark.parametrize("number", (*range(8), 14, 15))
def test_a_fixed_sample(number: int) -> None:
    outcome = CAMPAIGN.outcome(1, number)
    assert outcome.faults == []
    assert outcome.counts["mechanisms"] == 1000
    assert min(outcome.counts[what] for what in ("clear", "open", "doubtful")) > 50
