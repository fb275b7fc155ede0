"""A fixed sample of the campaign of pages."""

from __future__ import annotations

import pytest
from tools.campaigns.pages.cases import CAMPAIGN, names
from tools.node import MISSING, NODE

SAMPLE = (
    "double-rocker",
    "klann-leg",
    "geared-five-bar",
    "parallelogram",
    "spherical-crank-guide",
    "third-class-triad",
)
"""Limits, of groups behind each other too; gears; change points; guides that close on the sphere; a group that is
refused by name."""


@pytest.mark.skipif(NODE is None, reason=MISSING)
@pytest.mark.parametrize("name", SAMPLE)
def test_a_fixed_sample(name: str) -> None:
    outcome = CAMPAIGN.outcome(1, names().index(name))
    assert outcome.faults == []
    assert outcome.counts
