"""A fixed sample of the campaign of change points; the truth itself closes to all its digits."""

from __future__ import annotations

import mpmath
import pytest
from tools.campaigns.change_points.cases import CAMPAIGN
from tools.campaigns.change_points.drawing import drawn
from tools.campaigns.change_points.linkage import DIGITS

SAMPLE = (3, 10, 15, 20, 21, 25, 26, 29, 35, 36, 43, 59)
"""Every kind, alone, in a batch and by machine code, most of them within 0.01 of ratio 1."""


RESTING = pytest.mark.xfail(
    strict=True,
    reason="a rocker 4e-6 from ratio 1 rests over half a turn, and the linkage behind it stands within rounding of its "
    "change point all that time: samples there are singular",
)


@pytest.mark.parametrize("number", [pytest.param(n, marks=RESTING) if n == 21 else n for n in SAMPLE])
def test_linkages_pass_their_change_points(number: int) -> None:
    outcome = CAMPAIGN.outcome(1, number)
    assert outcome.faults == []
    assert outcome.figures


@pytest.mark.parametrize("number", SAMPLE)
def test_the_truth_closes(number: int) -> None:
    linkage, _way, _random = drawn(1, number)
    with mpmath.workdps(DIGITS):
        numbers = {path: mpmath.mpf(x) for path, x in linkage.dimensions.items()}
        at = mpmath.mpf(linkage.parts["drives"][0]["start"])
        missing = linkage.closures(numbers, at, linkage.places(numbers, at))
        assert max(abs(x) for x in missing) < mpmath.mpf(10) ** -70
