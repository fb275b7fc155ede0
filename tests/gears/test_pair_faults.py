"""What is reported of pairs that cannot work, against true teeth that are turned by brute force."""

from __future__ import annotations

import math

import pytest
from tools.campaigns.gears.turned_teeth import external_tooth, greatest_depth, internal_tooth

from centrode.gears.pair_faults import pair_faults
from centrode.gears.pair_geometry import PairGeometry
from centrode.gears.profiles import true_contact_ratio

TOUCHING = 1e-5
"""Modules by which sampled teeth enter each other where they only touch."""


def _kinds(pair: PairGeometry) -> list[str]:
    return [fault.kind for fault in pair_faults(pair)]


@pytest.mark.parametrize(
    ("pinion", "difference"), [(30, 5), (30, 6), (30, 7), (30, 8), (18, 5), (18, 6), (18, 7)]
)
@pytest.mark.parametrize("shift", [0.5, 0.7])
def test_tips_of_internal_pairs_run_into_each_other(pinion: int, difference: int, shift: float) -> None:
    pair = PairGeometry("internal", 1.0, (pinion, pinion + difference), (shift, shift))
    first, second = pair.wheels
    alpha, edge = pair.rack.pressure_angle, pair.rack.greatest_fillet
    teeth = (
        external_tooth(pinion, shift, first.tip / 2, alpha, 1.0, edge),
        internal_tooth(pinion + difference, shift, second.tip / 2, second.root / 2, alpha),
    )
    enters = greatest_depth(*teeth, pair.centre_distance) > TOUCHING
    assert ("tips" in _kinds(pair)) == enters
    assert (pair.tips_clear < 0) == enters


def test_undercut_may_leave_a_contact_ratio_below_one() -> None:
    pair = PairGeometry("external", 1.0, (6, 40), (-0.2, 0.3))
    assert pair.contact_ratio > 1 > true_contact_ratio(pair)
    assert "contact after undercut" in _kinds(pair)


def test_tips_inside_the_base_circle_have_no_involute() -> None:
    pair = PairGeometry("internal", 1.0, (18, 23), (0.0, 0.0))
    assert pair.wheels[1].tip < pair.wheels[1].base
    assert _kinds(pair)[0] == "tip inside base"


@pytest.mark.parametrize(
    ("pair", "clearances"),
    [
        (PairGeometry("external", 2.0, (14, 33), (0.3, 0.5)), (0.5, 0.5)),
        (PairGeometry("rack", 4.0, (14, math.inf), (0.2, -0.2)), (1.0, 1.0)),
        (PairGeometry("internal", 2.0, (20, 62), (0.3, 0.3)), (0.5, 0.925)),
    ],
)
def test_radial_clearance(pair: PairGeometry, clearances: tuple[float, float]) -> None:
    """Tip against root: c* m; of an internal wheel with the relief of GOST 19274, here 0.2125 m more."""
    assert [wheel.radial_clearance for wheel in pair.wheels] == pytest.approx(clearances, rel=1e-12)


def test_sliding_is_unbounded_where_contact_reaches_the_base_circle() -> None:
    least = PairGeometry("rack", 1.0, (14, math.inf), (0.0, 0.0)).wheels[0].least_shift
    pair = PairGeometry("rack", 1.0, (14, math.inf), (least, -least))
    assert pair.wheels[0].sliding_is_unbounded
    assert not pair.wheels[1].sliding_is_unbounded
    assert not PairGeometry("external", 1.0, (20, 40), (0.0, 0.0)).wheels[0].sliding_is_unbounded


def test_least_teeth_without_undercut() -> None:
    """17.0973 of the standard rack, and as many teeth as have this shift as their least."""
    wheel = PairGeometry("external", 1.0, (12, 40), (0.0, 0.0)).wheels[0]
    assert wheel.least_teeth == pytest.approx(17.0973, abs=5e-5)
    shifted = PairGeometry("external", 1.0, (12, 40), (wheel.least_shift, 0.0)).wheels[0]
    assert shifted.least_teeth == pytest.approx(12, rel=1e-12)
