"""Where a mechanism starts and lies must not matter: limits, turns, origins, rates, words without effect."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct


def four_bar(start: float, speed: float = 1.0) -> ct.Mechanism:
    """A linkage that locks on both sides, the crank longest."""
    ground = [1.8 * math.cos(2.6), 1.8 * math.sin(2.6)]
    return ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": ground}},
        links={"OA": {"length": 2.0}, "AB": {"length": 1.9}, "DB": {"length": 1.0}},
        drives=[{"link": "OA", "start": start, "speed": speed}],
        assembly={"sides": {"B": "left"}},
    )


def limits() -> list[float]:
    motion = ct.motion(four_bar(3.7), samples=9, start=3.7 - 2 * math.pi, stop=3.7 + 2 * math.pi)
    return [float(v) for v, kind in zip(motion.event_value, motion.event_kind, strict=True) if kind == 0]


def test_angles_next_to_the_lower_limit_do_not_depend_on_the_range() -> None:
    low = max(at for at in limits() if at < 3.7)
    place = low + 1e-5
    alone = ct.motion(four_bar(3.7), at=[place])
    in_company = ct.motion(four_bar(3.7), at=[3.7 - 2 * math.pi, place])
    assert np.array_equal(alone.angle[0], in_company.angle[1])


def test_a_start_at_a_limit_goes_to_the_side_that_closes() -> None:
    for limit, inward in (
        (max(a for a in limits() if a < 3.7), 1),
        (min(a for a in limits() if a > 3.7), -1),
    ):
        places = [limit, limit + 0.01 * inward, limit + 0.1 * inward, limit - 0.01 * inward]
        status = ct.motion(four_bar(limit), at=places).status.values.tolist()
        assert status == [ct.Status.SINGULAR, ct.Status.OK, ct.Status.OK, ct.Status.OPEN]


@pytest.mark.parametrize("away", [0.0, 1e3, 1e4])
def test_the_origin_may_lie_far_away(away: float) -> None:
    """A slider-crank driven by its slider: limits at +-2 and +-4 from the crank's pivot (3 - 1, 3 + 1)."""
    mechanism = ct.Mechanism(
        frame={"points": {"O": [away, 0]}},
        links={"OA": {"length": 1.0}, "AB": {"length": 3.0}},
        guides=[{"point": "B", "on": "frame", "through": "O", "direction": [1, 0]}],
        drives=[{"guide": "B", "start": 3.0, "speed": 1.0}],
        assembly={"sides": {"A": "left"}},
    )
    motion = ct.motion(mechanism, start=-5.0, stop=5.0, samples=101)
    # places of points that far away are rounded to half an ulp of the distance; F' is at least 4 at the limits
    assert motion.event_value.values == pytest.approx([-4, -2, 2, 4], abs=1e-14 + 100 * np.spacing(away))
    inside = (motion.drive_value[:, 0] > -3.9) & (motion.drive_value[:, 0] < -2.1)
    assert (motion.status[inside.values] == ct.Status.CUT_OFF).all()


def test_several_drives_that_start_at_rest_keep_their_turns() -> None:
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1.0}, "AB": {"length": 0.5}},
        drives=[{"link": "OA", "law": "100*t^2"}, {"link": "AB", "relative_to": "OA", "law": "-200*t^2"}],
    )
    motion = ct.motion(mechanism, start=0.0, stop=2.0, samples=301)
    # sine and cosine of 400 rad are good to the rounding of their argument
    assert np.abs(motion.angle.sel(link="OA") - motion.drive_value[:, 0]).max() < 4 * np.spacing(400.0)


@pytest.mark.parametrize(("law", "sign"), [("1-cos(t)", 1), ("-(1-cos(t))", -1), ("-sin(t)", -1)])
def test_a_side_at_a_change_point_holds_the_way_the_drive_sets_out(law: str, sign: int) -> None:
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [2, 0]}},
        links={"OA": {"length": 1}, "AB": {"length": 2}, "DB": {"length": 1}},
        drives=[{"link": "OA", "start": 0, "law": law}],
        assembly={"sides": {"B": "left"}},
    )
    last = ct.motion(mechanism, start=0.0, stop=1.0, samples=3).position[-1]
    a, b = last.sel(point="A").values, last.sel(point="B").values
    assert math.copysign(1, a[1]) == sign
    to_pivot, to_point = np.array([2.0, 0.0]) - a, b - a
    assert to_pivot[0] * to_point[1] - to_pivot[1] * to_point[0] > 0


def test_sides_that_no_group_asks_about_are_refused() -> None:
    with pytest.raises(ct.InputError, match=r"sides.OA: OA does not select the side of any group"):
        ct.check(
            ct.Mechanism(
                frame={"points": {"O": [0, 0], "D": [4, 0]}},
                links={"OA": {"length": 1}, "AB": {"length": 3.5, "angle": 0.4}, "DB": {"length": 3}},
                drives=[{"link": "OA", "start": 1, "speed": 1}],
                assembly={"sides": {"OA": "left"}},
            )
        )


def test_the_angle_of_a_block_tells_no_side() -> None:
    with pytest.raises(ct.InputError, match="the side on which it is assembled is not given"):
        ct.check(
            ct.Mechanism(
                frame={"points": {"O": [0, 0]}},
                links={
                    "OA": {"length": 1}, "AC": {"length": 3},
                    "block": {"points": {"C": [0, 0], "G": [0.2, 0.1]}, "angle": 0},
                },
                guides=[{"point": "G", "on": "frame", "through": [0, 0], "direction": [1, 0], "link": "block"}],
                drives=[{"link": "OA", "start": 1, "speed": 1}],
            )
        )  # fmt: skip


@pytest.mark.parametrize("lengths", [(1, 2, 1), (0.7, 1.8, 1.1), (1.1, 1.3, 2.4)])
def test_a_triangle_flat_everywhere_is_refused(lengths: tuple[float, float, float]) -> None:
    crank, coupler, rocker = lengths
    with pytest.raises(ct.InputError, match="degenerate for every value of the drive"):
        ct.check(
            ct.Mechanism(
                frame={"points": {"O": [0, 0], "D": [0, 0]}},
                links={"OA": {"length": crank}, "AB": {"length": coupler}, "DB": {"length": rocker}},
                drives=[{"link": "OA", "start": 1, "speed": 1}],
                assembly={"sides": {"B": "left"}},
            )
        )
