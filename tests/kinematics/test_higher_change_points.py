"""Change points inside groups of higher class, and near misses of them: against the same motion by dyads."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.structure.plan import structure_of
from mechanisms import EPS, events, parts_of, point, statuses
from redriven import Redriven, by_chain_rule, by_newton, reach_of, redriven
from samples import few

BASES = few((0.7, -1.0), (0.7, -1.0, 2.0))
SPECIAL = -1.85027107097245
"""Angle of FR where the crank of the exact parallelogram passes 0."""


def parallelogram(longer: float = 0.0) -> ct.Mechanism:
    """A parallelogram whose coupler point P leads the rocker FR through the rod PR; the coupler may be too long."""
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "D": [4.0, 0.0], "F": [1.0, 5.0]}},
        links={
            "OA": {"length": 1.0},
            "coupler": {"points": {"A": [0.0, 0.0], "B": [4.0 + longer, 0.0], "P": [2.0, 1.5]}, "angle": 0.0},
            "DB": {"length": 1.0, "angle": 0.7},
            "PR": {"length": 3.0},
            "FR": {"length": 2.0},
        },
        drives=[{"link": "OA", "start": 0.7, "speed": 1.0}],
        assembly={"sides": {"R": "left"}},
    )


@pytest.fixture(scope="module", params=BASES)
def case(request: pytest.FixtureRequest) -> Redriven:
    return redriven(parallelogram(), "FR", request.param)


def test_all_five_links_are_solved_together(case: Redriven) -> None:
    assert "higher class" in [group.kind for group in structure_of(case.other).groups]


def test_smooth_continuation_passes_as_dyads_do(case: Redriven) -> None:
    """Interpolated next to the change point: to the errors that conventions promise there."""
    low, high = reach_of(case)
    values = np.linspace(low, high, 81)[2:-2]
    data, found = by_newton(case, values)
    assert set(statuses(data)) == {"ok"}
    expected = by_chain_rule(case, values)
    size = np.max(np.abs(expected), axis=(1, 2, 3))
    error = np.max(np.abs(found - expected), axis=(1, 2, 3)) / size
    assert np.all(error <= [1e-11, 1e-9, 1e-8])


def test_change_points_stand_where_the_crank_is_in_line(case: Redriven) -> None:
    low, high = reach_of(case)
    found = events(ct.motion(case.other, at=[low, high]), "change point")
    cranks = [x for x in (-np.pi, 0.0, np.pi) if case.stretch[0] < x < case.stretch[1]]
    expected = [float(case.angle([x])[0][0]) for x in cranks]
    # the saddle of the worst equation is found to the root of what its value is flat to
    assert sorted(found) == pytest.approx(sorted(expected), abs=1e-10)


@pytest.mark.parametrize(
    "longer",
    few([1e-2, 1e-9, -1e-4, -1e-11], [1e-2, 1e-4, 1e-6, 1e-9, -1e-2, -1e-4, -1e-6, -1e-9, -1e-11]),
)
def test_a_near_miss_is_not_passed_as_a_crossing(longer: float) -> None:
    """With a coupler too long the crank locks; too short, it goes over to the antiparallelogram: FR turns back."""
    case = redriven(parallelogram(longer), "FR", 0.7)
    found = ct.motion(case.other, samples=41, start=-2.6, stop=-1.6)
    assert events(found, "change point") == []
    assert set(statuses(found)) == {"ok", "open"}
    if longer < 0.0:
        end = float(np.max(case.angle(case.stretch)[0]))
        # an extreme that is as sharp as the miss is near
        assert np.min(np.abs(np.array(events(found, "limit")) - end)) <= 64 * EPS / np.sqrt(-longer)


@pytest.mark.parametrize("longer", few([1e-12, -1e-13], [1e-12, 1e-13, -1e-13]))
def test_a_miss_too_near_to_be_followed_is_told(longer: float) -> None:
    """Between rounding and what can be followed: nothing is given beyond, and no change point is claimed."""
    case = redriven(parallelogram(longer), "FR", 0.7)
    data = ct.motion(case.other, at=[SPECIAL - 0.1, SPECIAL - 1e-3, SPECIAL + 1e-3, SPECIAL + 0.1])
    assert events(data, "change point") == []
    assert statuses(data)[:2] == ["ok", "ok"]
    if "ok" not in statuses(data)[2:]:
        assert set(statuses(data)[2:]) <= {"open", "unconverged"}
    else:  # followed all the same: round the corner, on the other curve
        straight = ct.motion(redriven(parallelogram(), "FR", 0.7).other, at=[SPECIAL + 0.1])
        assert abs(point(data, "A")[-1] - point(straight, "A")[0]) > 1e-3


def test_a_gap_of_limits_is_found_on_both_sides() -> None:
    """Started beyond the near miss, the group ends on its other side: two limits, as far apart as the gap is wide."""
    longer = 1e-8
    one = redriven(parallelogram(longer), "FR", 0.7)
    low, high = reach_of(one)
    at = ct.motion(one.by_dyads, at=list(one.stretch))
    locked = min(abs(x) for x in events(at, "limit")) if events(at, "limit") else None
    # by cosines: the crank of a parallelogram whose coupler is too long by x stops at sqrt(3/2 x)
    assert locked == pytest.approx(np.sqrt(1.5 * longer), rel=1e-3)
    inside = ct.motion(one.other, at=np.linspace(low, high, 9)[1:-1])
    assert set(statuses(inside)) == {"ok"}


def test_keep_ends_at_the_change_point() -> None:
    case = redriven(parallelogram(), "FR", 0.7)
    parts: dict[str, Any] = parts_of(case.other)
    parts["assembly"] = {"continuation": "keep"}
    data = ct.motion(ct.Mechanism(**parts), at=[SPECIAL - 0.1, SPECIAL - 0.01, SPECIAL + 0.01, SPECIAL + 0.1])
    assert statuses(data) == ["ok", "ok", "unconverged", "unconverged"]
    smooth = ct.motion(case.other, at=[SPECIAL - 0.1])
    assert np.array_equal(point(data, "R")[:1], point(smooth, "R"))
