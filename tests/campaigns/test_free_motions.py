"""A fixed sample of the campaign of free motions."""

from __future__ import annotations

import pytest
from tools.campaigns.free_motions import examples
from tools.campaigns.free_motions.cases import CAMPAIGN


@pytest.mark.parametrize("number", (0, 1, 3, 4, 5, 6, 7, 11))
def test_a_fixed_sample(number: int) -> None:
    outcome = CAMPAIGN.outcome(1, number)
    assert outcome.faults == []
    assert outcome.counts


@pytest.mark.parametrize(
    "name", ("antiparallelogram", "cardan-gear", "planetary-hypocycloid", "tangent-mechanism", "wiper")
)
def test_some_examples(name: str) -> None:
    """Change points, gears, a wheel whose contact repeats another, a loose pin, and a start in equilibrium."""
    outcome = examples.CAMPAIGN.outcome(1, examples.names().index(name))
    assert outcome.faults == []
    assert {column for _row, column in outcome.figures} >= {"drift", "gap", "states", "way back"}
