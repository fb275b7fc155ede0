"""A fixed sample of the campaign of imported drawings."""

from __future__ import annotations

import pytest
from tools.campaigns.imports.cases import run

from samples import few


@pytest.mark.parametrize("number", few(range(2), range(20)))
def test_a_fixed_sample(number: int) -> None:
    outcome = run(1, number)
    assert outcome.faults == [], outcome.subject
    assert outcome.counts["drawings"] == 100 and outcome.counts[".svg read"] > 0
