"""Limits, extreme positions, strokes, time ratios and transmission angles against textbook closed forms."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.analysis.rotatability.causes import CauseKind, Tracer
from centrode.analysis.rotatability.rotatability import Rotatability
from centrode.analysis.rotatability.tours import DWELL_BAND, LinkStroke
from growing import DYADS, grown, mechanism_of
from mechanisms import EPS, four_bar
from samples import examples_at_hand, few
from turning import assert_swings, recorded


def swing_of(found: Rotatability, name: str) -> LinkStroke:
    return next(swing for swing in found.one.swings if swing.name == name)


def crank_rockers() -> Iterator[tuple[float, float, float, float]]:
    """Crank, coupler, rocker, ground: the crank is the shortest, and the rule of Grashof holds with room to spare."""
    random = np.random.default_rng(7)
    while True:
        a, b, c, d = 0.5 + random.random(4) * np.array([0.5, 3.0, 3.0, 3.0])
        longest = max(b, c, d)
        if a < 0.9 * min(b, c, d) and a + longest < 0.95 * (b + c + d - longest):
            yield float(a), float(b), float(c), float(d)


def test_a_crank_rocker_turns() -> None:
    found = ct.rotatability(four_bar(*next(crank_rockers())))
    assert found.turns_fully is True
    assert found.limits == ()
    assert found.one.period == 1


def test_rockers_swing_between_the_two_lines_of_crank_and_coupler() -> None:
    """Extremes of the rocker where B is b + a and b - a away from O, by the law of cosines; time ratio likewise."""
    choose = crank_rockers()
    for _k in range(25):
        a, b, c, d = next(choose)
        swing = swing_of(ct.rotatability(four_bar(a, b, c, d)), "DB")
        outer, inner = (
            math.acos((d**2 + c**2 - (b + sign * a) ** 2) / (2 * c * d)) for sign in (1, -1)
        )  # angles at D between DO and DB
        assert swing.least is not None and swing.greatest is not None and swing.time_ratio is not None
        # B lies to the left of A-D; the angle of DB is pi less that at D
        bound = 64 * EPS * (1 + 1 / math.sin(outer) + 1 / math.sin(inner))
        assert abs(swing.least.value - (math.pi - outer)) <= bound
        assert abs(swing.greatest.value - (math.pi - inner)) <= bound
        first, second = (
            math.acos((d**2 + (b + sign * a) ** 2 - c**2) / (2 * d * (b + sign * a))) for sign in (1, -1)
        )  # angles at O between OD and OB
        way = math.pi + second - first
        ratio = max(way, math.tau - way) / min(way, math.tau - way)
        assert swing.time_ratio == pytest.approx(ratio, rel=math.sqrt(EPS))
        # the crank turns from the inner dead point on counter-clockwise to the outer one
        assert swing.forward == pytest.approx(way, rel=math.sqrt(EPS))
        assert swing.back == pytest.approx(math.tau - way, rel=math.sqrt(EPS))
        assert swing.least.in_line == swing.greatest.in_line == (("OA", "AB"),)


def test_transmission_angles_are_least_with_the_crank_in_line_with_the_frame() -> None:
    choose = crank_rockers()
    for _k in range(25):
        a, b, c, d = next(choose)
        (transmission,) = ct.rotatability(four_bar(a, b, c, d)).one.transmissions
        exact = [math.acos((b**2 + c**2 - (d + sign * a) ** 2) / (2 * b * c)) for sign in (-1, 1)]
        bound = 64 * EPS * sum(1 / math.sin(angle) for angle in exact)
        found = sorted(value for _at, value in transmission.extremes)
        assert len(found) == 2
        assert np.max(np.abs(np.array(found) - sorted(exact))) <= bound
        assert abs(transmission.least - min(min(x, math.pi - x) for x in exact)) <= bound
        places = sorted(at % math.pi for at, _value in transmission.extremes)
        assert all(min(at, math.pi - at) <= 4 * math.sqrt(EPS) for at in places)


def test_slider_cranks_have_the_stroke_and_the_time_ratio_of_the_textbook() -> None:
    random = np.random.default_rng(3)
    for _k in range(25):
        r, e = 0.5 + random.random(), random.random()
        rod = (r + e) * (1.2 + random.random())
        mechanism = ct.slider_crank(crank=r, coupler=rod, offset=e)
        found = ct.rotatability(mechanism)
        (slide,) = [swing for swing in found.one.swings if swing.member == "guide"]
        far, near = math.sqrt((rod + r) ** 2 - e**2), math.sqrt((rod - r) ** 2 - e**2)
        assert slide.stroke == pytest.approx(far - near, abs=16 * EPS * (rod + r) ** 2 / near)
        alpha = math.asin(e / (rod - r)) - math.asin(e / (rod + r))
        assert slide.time_ratio == pytest.approx((math.pi + alpha) / (math.pi - alpha), rel=math.sqrt(EPS))
        (transmission,) = found.one.transmissions
        exact = sorted(math.pi / 2 - math.asin((e + sign * r) / rod) for sign in (-1, 1))
        reached = sorted(min(v, math.pi - v) for _at, v in transmission.extremes)
        folded = sorted(min(v, math.pi - v) for v in exact)
        assert np.max(np.abs(np.array(reached) - folded)) <= 64 * EPS / math.sin(folded[0])


def test_dead_points_are_the_limits_of_the_mechanism_driven_there() -> None:
    """A rocker as the drive stops where the crank and the coupler are collinear: its own extreme values."""
    mechanism = four_bar(1.0, 3.5, 3.0, 4.0)
    found = ct.rotatability(mechanism)
    points = [point for point in found.one.dead_points if point.driver == "DB"]
    start = float(ct.motion(mechanism, at=[1.0]).angle.sel(link="DB")[0])
    other = four_bar(
        1.0,
        3.5,
        3.0,
        4.0,
        drives=[{"link": "DB", "start": start, "speed": 1}],
        assembly={"sides": {"A": "right"}},
    )
    for side in ("left", "right"):
        other = ct.Mechanism(
            frame=other.frame, links=other.links, drives=other.drives, assembly={"sides": {"A": side}}
        )
        limits = ct.limits(other).interval
        assert sorted(point.value for point in points) == pytest.approx(limits, abs=64 * EPS)
        assert str(ct.rotatability(other).limits[0].condition) == "sin(phi1 - phi2) = 0"
    assert all(point.in_line == (("OA", "AB"),) for point in points)


def test_change_points_have_causes_and_are_no_limits() -> None:
    found = ct.rotatability(ct.example("parallelogram"))
    assert found.turns_fully is True
    assert [str(point.condition) for point in found.one.change_points] == ["sin(phi2 - phi3) = 0"] * 2
    causes = [point.cause for point in found.one.change_points]
    assert [(cause.kind, cause.stretched) for cause in causes] == [
        (CauseKind.RODS_IN_LINE, True),
        (CauseKind.RODS_IN_LINE, False),
    ]
    assert all(cause.bodies == ((Tracer.LINK, "AB"), (Tracer.LINK, "DB")) for cause in causes)
    printed = ct.summary(found)
    assert "AB and DB are collinear, extended (" in printed
    assert "AB and DB are collinear, folded (" in printed
    assert found.one.transmissions[0].least == 0.0
    assert ct.rotatability(ct.example("galloway")).one.period == 2


def test_dwells_stay_within_their_band_and_cannot_be_longer() -> None:
    mechanism = ct.example("klann-leg")
    swing = swing_of(ct.rotatability(mechanism), "rod")
    (dwell,) = swing.dwells
    assert swing.stroke is not None
    step = math.tau / 720
    inside = ct.motion(mechanism, at=np.linspace(dwell.first, dwell.last, 400)).angle.sel(link="rod").values
    assert float(np.ptp(inside)) <= DWELL_BAND * swing.stroke * (1 + 1e-3)
    for first, last in ((dwell.first - 2 * step, dwell.last), (dwell.first, dwell.last + 2 * step)):
        longer = ct.motion(mechanism, at=np.linspace(first, last, 400)).angle.sel(link="rod").values
        assert float(np.ptp(longer)) > DWELL_BAND * swing.stroke
    assert swing_of(ct.rotatability(ct.example("scotch-yoke")), "H").dwells == ()


def test_a_displacement_does_not_turn_and_drives_are_told_apart() -> None:
    slider = ct.rotatability(ct.example("elliptic-trammel"))
    assert slider.turns_fully is None
    assert [limit.value for limit in slider.limits] == [-1.0, 1.0]
    arm = ct.example("excavator-arm")
    found = ct.rotatability(arm)
    assert found.turns_fully is None
    assert [turning.drive for turning in found.drives] == ["K-A", "C-E", "S-N"]
    for turning in found.drives:
        interval = ct.limits(arm, turning.drive).interval
        assert tuple(limit.value for limit in turning.limits) == interval
        assert turning.limits[0].cause.kind == CauseKind.RODS_IN_LINE


def test_what_is_found_is_json_and_rows(tmp_path: Path) -> None:
    for name in (
        "crank-rocker",
        "tangent-mechanism",
        "spherical-four-bar",
        "third-class-triad",
        "cardan-gear",
    ):
        mechanism = ct.example(name)
        found = ct.rotatability(mechanism)
        data = recorded(found, tmp_path)
        assert data["turns_fully"] is found.turns_fully
        assert len(data["drives"][0]["swings"]) == len(found.one.swings)
        first = ct.summary(found).splitlines()[0]
        assert first.split("  ", 1)[0] == "drive" and first.split()[-1] == found.one.drive


@pytest.mark.parametrize("seed", range(16))
def test_random_mechanisms_swing_between_their_extreme_positions(seed: int) -> None:
    """No sample of the motion lies beyond what roots of rates found, and some lie near it."""
    kinds = [str(kind) for kind in np.random.default_rng(seed).choice(DYADS, size=2)]
    mechanism = mechanism_of(grown(kinds, seed))
    found = ct.rotatability(mechanism)
    assert {limit.value for limit in found.limits} <= set(ct.limits(mechanism).interval)
    ends = {limit.end: limit.value for limit in found.limits}
    first = ends.get("low", found.one.initial)
    last = ends.get("high", found.one.initial + math.tau * (found.one.period or 2))
    motion = ct.motion(mechanism, at=np.linspace(first, last, 1203)[1:-1])
    assert (motion.status == 0).all()
    for swing in found.one.swings:
        if swing.least is None or swing.greatest is None or swing.stroke is None:
            continue
        along = (
            motion.angle.sel(link=swing.name)
            if swing.member == "link"
            else motion.slide.sel(guide=swing.name)
        )
        low, high = float(along.min()), float(along.max())
        # at a limit a value is as exact as the root of its group's rounding
        margin = 16 * math.sqrt(EPS) * max(1.0, abs(low), abs(high))
        assert swing.least.value - margin <= low and high <= swing.greatest.value + margin
        near_limits = 0.2 * swing.stroke if found.limits else 1e-4 * swing.stroke
        assert low <= swing.least.value + near_limits and swing.greatest.value - near_limits <= high


def test_every_example_is_answered() -> None:
    for name in examples_at_hand(ct.example_names())[:: few(2, 1)]:
        assert_swings(ct.rotatability(ct.example(name)))


def test_a_drive_that_runs_backwards_has_its_places_on_its_run() -> None:
    """The same geometry; every place lies within the turn that the drive makes, so below its initial value."""
    ahead = four_bar(1.0, 3.5, 3.0, 4.0)
    start = ct.value_at(ahead, "drives.OA.start")
    back = ct.rotatability(ct.with_value(ahead, "drives.OA.speed", -1.0)).one
    places = [extreme.at for swing in back.swings for extreme in swing.extremes]
    places += [point.at for point in back.dead_points] + [at for at, _ in back.transmissions[0].extremes]
    assert len(places) >= 6
    assert all(start - math.tau <= at <= start for at in places)
    found = ct.rotatability(ahead).one
    for swing, other in zip(back.swings, found.swings, strict=True):
        assert swing.stroke == pytest.approx(other.stroke, abs=64 * EPS)
        turns = sorted(extreme.at % math.tau for extreme in swing.extremes)
        assert turns == pytest.approx(sorted(e.at % math.tau for e in other.extremes), abs=1e-7)


@pytest.mark.parametrize("short", [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-13])
def test_a_mechanism_that_hardly_moves_between_two_dead_points(short: float, tmp_path: Path) -> None:
    """Three links of 1 m all but stretched out over 3 m: the crank moves by about sqrt(4 short / 3) to both sides."""
    ground = 3.0 - short
    mechanism = four_bar(1.0, 1.0, 1.0, ground, drives=[{"link": "OA", "start": 0.0, "speed": 1.0}])
    found = ct.rotatability(mechanism)
    assert found.turns_fully is False
    assert found.one.period is None
    # AB and DB stretched: |AD| = 2; ground is rounded, and the arc of the cosine loses digits as its sine does
    exact = math.acos((1.0 + ground**2 - 4.0) / (2.0 * ground))
    for limit, end in zip(found.limits, (-exact, exact), strict=False):
        assert limit.value == pytest.approx(end, abs=32 * EPS / exact)
    lines = [line.split("  ", 1) for line in ct.summary(found).splitlines() if not line.startswith(" ")]
    rows = {label: text.strip() for label, text in lines}
    assert rows["turns fully"].startswith("no")
    assert ("upper limit" in rows) == bool(found.limits)
    assert recorded(found, tmp_path)["turns_fully"] is False


def test_forward_and_back_follow_the_sense_of_the_drive() -> None:
    """A drive that runs the other way goes the same ways the other way round: forward and back change places."""
    mechanism = four_bar(1.0, 3.5, 3.0, 4.0)
    (drive,) = mechanism.drives
    assert drive.speed is not None
    other = mechanism.model_copy(update={"drives": (drive.model_copy(update={"speed": -drive.speed}),)})
    there, again = (swing_of(ct.rotatability(one), "DB") for one in (mechanism, other))
    assert there.forward is not None and there.back is not None and again.forward is not None
    assert abs(there.forward - there.back) > 0.1
    assert again.forward == pytest.approx(there.back, rel=math.sqrt(EPS))
    assert again.back == pytest.approx(there.forward, rel=math.sqrt(EPS))
