"""The initial position: which side is meant, what does not assemble and by how much, what is left unsaid."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import centrode as ct
from mechanisms import EPS, four_bar, parts_of, point, slide


def started(mechanism: ct.Mechanism) -> Any:
    start = mechanism.drives[0].start
    return ct.motion(mechanism, 1, start=start, stop=start)


@pytest.mark.parametrize(("side", "sign"), [("left", 1.0), ("right", -1.0)])
def test_left_and_right_of_the_line_between_the_known_points(side: str, sign: float) -> None:
    data = started(four_bar(1.0, 3.5, 3.0, 4.0, assembly={"sides": {"B": side}}))
    a, b = point(data, "A")[0], point(data, "B")[0]
    assert sign * (np.conj(4 - a) * (b - a)).imag > 0


@pytest.mark.parametrize(("side", "sign"), [("ahead", 1.0), ("behind", -1.0)])
def test_ahead_and_behind_along_a_guide(side: str, sign: float) -> None:
    data = started(ct.slider_crank(1.0, 3.0, 0.3, side=side))
    assert sign * (slide(data, "B")[0] - point(data, "A")[0].real) > 0
    parts = parts_of(ct.example("inverted-slider-crank"))
    parts["links"]["lever"].pop("angle")
    parts["assembly"] = {"sides": {"A": side}}
    assert sign * slide(started(ct.Mechanism(**parts)), "A")[0] > 0


def test_words_that_do_not_apply() -> None:
    with pytest.raises(ct.InputError, match='"ahead" does not apply to a group RRR; write B = "left"'):
        started(four_bar(1.0, 3.5, 3.0, 4.0, assembly={"sides": {"B": "ahead"}}))
    with pytest.raises(ct.InputError, match='"left" does not apply to a group RRP; write B = "ahead"'):
        started(ct.slider_crank(1.0, 3.0, side="left"))


def test_nothing_said_of_the_side() -> None:
    with pytest.raises(
        ct.InputError,
        match=r"the side on which it is assembled is not given.* give the initial angle of AB or DB",
    ):
        started(four_bar(1.0, 3.5, 3.0, 4.0, assembly={}))


def six_bar(sides: dict[str, str], **angles: float) -> ct.Mechanism:
    """Two four-bar linkages in a row: the rocker of the first drives the second."""
    links: dict[str, Any] = {
        "AB": {"length": 1},
        "BC": {"length": 3.5},
        "rocker": {"points": {"C": [3, 0], "D": [0, 0], "E": [2, 0]}},
        "EF": {"length": 4},
        "GF": {"length": 2.5},
    }
    return ct.Mechanism(
        frame={"points": {"A": [0, 0], "D": [4, 0], "G": [8, 0]}},
        links={
            name: link | ({"angle": angles[name]} if name in angles else {}) for name, link in links.items()
        },
        drives=[{"link": "AB", "start": 0.7, "speed": 1}],
        assembly={"sides": sides},
    )


@pytest.mark.parametrize(
    ("sides", "angles", "points"),
    [({}, {}, "CF"), ({"C": "left"}, {}, "F"), ({"F": "left"}, {}, "C"), ({}, {"GF": 1.0}, "C")],
)
def test_all_sides_that_nothing_says_are_told_at_once(
    sides: dict[str, str], angles: dict[str, float], points: str
) -> None:
    with pytest.raises(ct.InputError) as caught:
        ct.check(six_bar(sides, **angles))
    lines = str(caught.value).splitlines()
    assert [line[line.index("(point ") + 7] for line in lines] == [*points]
    for line, name in zip(lines, points, strict=True):
        assert line.endswith(f'or [assembly] sides, {name} = "left" | "right"')
    assert ct.check(six_bar({"C": "left", "F": "left"})).mobility == 1


@pytest.mark.parametrize(("off", "refused"), [(4.9, False), (5.1, True), (-5.1, True)])
def test_initial_angles_hold_to_five_degrees(off: float, refused: bool) -> None:
    right = started(four_bar(1.0, 3.5, 3.0, 4.0))
    parts = parts_of(four_bar(1.0, 3.5, 3.0, 4.0, assembly={}))
    parts["links"]["DB"]["angle"] = float(right["angle"].sel(link="DB")[0]) + np.radians(off)
    if refused:
        with pytest.raises(ct.InputError, match=rf"it has .* deg, a difference of {abs(off):.3g} deg"):
            started(ct.Mechanism(**parts))
    else:
        found = started(ct.Mechanism(**parts))
        assert point(found, "B")[0] == pytest.approx(point(right, "B")[0], abs=8 * EPS)


@pytest.mark.parametrize("off", [-44.0, 5.1, 20.0])
def test_where_sides_decide_an_initial_angle_may_be_rough(off: float) -> None:
    right = started(four_bar(1.0, 3.5, 3.0, 4.0))
    parts = parts_of(four_bar(1.0, 3.5, 3.0, 4.0))
    assert parts["assembly"]["sides"]
    parts["links"]["DB"]["angle"] = float(right["angle"].sel(link="DB")[0]) + np.radians(off)
    found = started(ct.Mechanism(**parts))
    assert point(found, "B")[0] == point(right, "B")[0]
    assert float(found["angle"].sel(link="DB")[0]) == pytest.approx(
        float(right["angle"].sel(link="DB")[0]), abs=8 * EPS
    )


def test_an_initial_angle_that_contradicts_the_side_is_a_mistake() -> None:
    parts = parts_of(four_bar(1.0, 3.5, 3.0, 4.0))
    right = started(four_bar(1.0, 3.5, 3.0, 4.0))
    parts["links"]["DB"]["angle"] = float(right["angle"].sel(link="DB")[0]) + np.radians(46.0)
    with pytest.raises(ct.InputError, match="a difference of 46 deg"):
        started(ct.Mechanism(**parts))


def test_links_too_short_or_too_long_are_told_by_how_much() -> None:
    # A = (1, 0) at the start: AD = 3
    short = four_bar(1.0, 1.2, 1.5, 4.0, drives=[{"link": "OA", "start": 0.0, "speed": 1.0}])
    with pytest.raises(ct.InputError, match=r"links AB and DB together are too short by 0\.3 m"):
        started(short)
    long = four_bar(1.0, 5.0, 1.5, 4.0, drives=[{"link": "OA", "start": 0.0, "speed": 1.0}])
    with pytest.raises(ct.InputError, match=r"link AB is too long for link DB by 0\.5 m"):
        started(long)
    with pytest.raises(ct.InputError, match=r"link coupler is too short to reach its guide by 0\.25 m"):
        started(ct.slider_crank(1.0, 1.75, 2.0, start=0.0))
    parts = parts_of(ct.example("inverted-slider-crank"))
    parts["guides"][0]["through"] = [0.0, 5.0]
    # |DA|^2 = 10 - 6 cos 1
    by = 5.0 - np.sqrt(10 - 6 * np.cos(1.0))
    with pytest.raises(ct.InputError, match=f"offset of guide A exceeds the distance D-A by {by:.4g} m"):
        started(ct.Mechanism(**parts))


def test_a_flat_triangle_does_not_tell_its_side() -> None:
    flat = four_bar(1.0, 1.5, 1.5, 4.0, assembly={}, drives=[{"link": "OA", "start": 0.0, "speed": 1.0}])
    with pytest.raises(ct.InputError, match="its triangle is degenerate in the initial position"):
        started(flat)
    with pytest.raises(ct.InputError, match="degenerate"):
        parts = parts_of(ct.example("kite"))
        parts["drives"][0]["start"] = np.pi
        parts["links"]["AB"]["angle"] = 0.0
        parts["links"]["DB"]["angle"] = np.pi
        started(ct.Mechanism(**parts))


def test_the_drive_and_the_initial_angle_have_to_agree() -> None:
    parts = parts_of(four_bar(1.0, 3.5, 3.0, 4.0))
    parts["links"]["OA"]["angle"] = 1.1
    with pytest.raises(ct.InputError, match=r"it starts at 1 rad, but the initial angle is 1\.1 rad"):
        started(ct.Mechanism(**parts))
    parts["links"]["OA"]["angle"] = 1.0 + 2 * np.pi
    assert point(started(ct.Mechanism(**parts)), "B")[0] == pytest.approx(
        point(started(four_bar(1.0, 3.5, 3.0, 4.0)), "B")[0], abs=8 * EPS * 8
    )


def test_parallel_guides_do_not_meet() -> None:
    parts = parts_of(ct.example("tangent-mechanism"))
    parts["drives"][0]["start"] = np.pi / 2
    parts.pop("study")
    with pytest.raises(ct.InputError, match="its lines are parallel"):
        # cos(pi/2) is 6e-17 in floats: they would meet 1.6e16 m away
        ct.check(ct.Mechanism(**parts))


def test_a_constraint_that_repeats_others_has_to_fit_everywhere() -> None:
    """A fourth bar that fits the coupler's path in the initial position only makes the linkage rigid."""
    mechanism = four_bar(1.0, 3.5, 3.0, 4.0)
    at = started(mechanism)
    parts = parts_of(mechanism)
    b = point(at, "B")[0]
    parts["frame"]["points"]["F"] = [0.5, 2.9]
    parts["links"]["FB"] = {"length": float(abs(b - (0.5 + 2.9j)))}
    with pytest.raises(
        ct.InputError, match=r"it holds in the initial position only|the mobility \(by rank\) is 0"
    ):
        started(ct.Mechanism(**parts))
    parts["links"]["FB"]["length"] += 0.01
    with pytest.raises(ct.InputError, match=r"residual of this constraint is 0\.01 m"):
        started(ct.Mechanism(**parts))
