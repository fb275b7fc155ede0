"""A fixed sample of the campaign of play in joints."""

from __future__ import annotations

import pytest
from tools.campaigns.clearances.cases import run


@pytest.mark.parametrize("number", range(3))
def test_no_pin_lies_beyond_the_extremes(number: int) -> None:
    outcome = run(32, number, 200_000)
    assert outcome.faults == []
    assert outcome.figures["crank-rockers", "beyond"] == 0.0
