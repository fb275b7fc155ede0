"""Repairs by one dimension: limiting values by closed forms, and repaired mechanisms solved by other means."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pytest
from scipy.optimize import brentq

import centrode as ct
from centrode.analysis.redesign.proposal import propose
from centrode.analysis.redesign.repair import LEAST_ANGLES
from centrode.analysis.redesign.results import RotatabilityResults, rotatability_results
from centrode.analysis.redesign.single_changes import (
    SingleChange,
    SingleChanges,
    dimensions_of_design,
    single_changes,
)
from centrode.errors import NotComputedYet
from centrode.model.files import with_values
from centrode.model.placement import replace_placed
from mechanisms import four_bar

DISPLAY = {"length": "mm", "angle": "deg"}
TEN = LEAST_ANGLES[1:]
"""From 10 degrees on."""
NODES = 1e-9
"""What parabolas between 720 nodes of the turn leave of a limiting value: a fourth power of their step, in parts of the
greatest length."""


def by_path(found: SingleChanges | None) -> Mapping[str, SingleChange]:
    assert found is not None
    return {change.dimension.path: change for change in found.changes}


def turning(crank: float, coupler: float, rocker: float, ground: float) -> bool:
    """Whether the crank turns fully, by F. Grashof's rule."""
    lengths = sorted((crank, coupler, rocker, ground))
    return lengths[0] + lengths[3] <= lengths[1] + lengths[2] and lengths[0] in (crank, ground)


def least_angle(crank: float, coupler: float, rocker: float, ground: float) -> float:
    """The least transmission angle of a four-bar whose crank turns: where the crank lies along the frame."""
    cosines = [
        (coupler**2 + rocker**2 - end**2) / (2 * coupler * rocker)
        for end in (abs(ground - crank), ground + crank)
    ]
    return math.asin(min(math.sqrt(max(0.0, 1 - cosine**2)) for cosine in cosines))


def test_a_four_bar_turns_from_the_lengths_of_grashofs_rule() -> None:
    """Crank 60, coupler 70, rocker 50, ground 90 mm: 50 + 90 > 60 + 70."""
    lengths = {"OA": 0.06, "AB": 0.07, "DB": 0.05, "OD": 0.09}
    mechanism = four_bar(
        *lengths.values(), drives=[{"link": "OA", "start": 1.0, "speed": 1}], display=DISPLAY
    )
    found = single_changes(mechanism, margins=TEN)
    changes = by_path(found)
    limits = {"links.OA.length": 0.03, "frame.points.D.x": 0.04, "links.DB.length": 0.08}
    assert set(changes) == set(limits)
    for path, limit in limits.items():
        change = changes[path]
        name = "OD" if path.startswith("frame") else path.split(".")[1]
        assert change.bound == pytest.approx(limit, abs=NODES * 0.09)
        beyond = np.sign(change.after - change.before) * 1e-6
        assert turning(*(lengths | {name: limit + beyond}).values())
        assert not turning(*(lengths | {name: limit - beyond}).values())
        repaired = (lengths | {name: change.after}).values()
        assert turning(*repaired)
        assert change.least_angle == pytest.approx(least_angle(*repaired), rel=1e-12)
        assert change.least_angle >= TEN[0]
    assert found is not None and [one.path for one in found.without] == ["links.AB.length"]
    for length in np.linspace(0.2, 3.0, 500) * lengths["AB"]:
        assert not turning(*(lengths | {"AB": float(length)}).values())


def test_the_proposed_value_has_few_digits_of_the_unit_shown() -> None:
    mechanism = four_bar(
        0.06, 0.07, 0.05, 0.09, drives=[{"link": "OA", "start": 1.0, "speed": 1}], display=DISPLAY
    )
    values = {path: change.after for path, change in by_path(single_changes(mechanism, margins=TEN)).items()}
    assert values == {"links.OA.length": 0.0295, "frame.points.D.x": 0.037, "links.DB.length": 0.081}


def slider_crank(crank: float, rod: float, offset: float, form: str = "length") -> ct.Mechanism:
    """A slider-crank whose links give their lengths, or coordinates of their points."""
    links = {
        "length": {"OA": {"length": crank}, "AB": {"length": rod}},
        "points": {
            "OA": {"points": {"O": [0, 0], "A": [crank, 0]}},
            "AB": {"points": {"A": [0, 0], "B": [0, rod]}},
        },
    }[form]
    return ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links=links,
        guides=[{"point": "B", "on": "frame", "through": [0, offset], "direction": [1, 0]}],
        drives=[{"link": "OA", "start": 0.0, "speed": 1.0}],
        assembly={"sides": {"B": "ahead"}},
    )


@pytest.mark.parametrize("form", ["length", "points"])
def test_a_slider_crank_turns_where_the_rod_reaches_crank_and_offset(form: str) -> None:
    """The rod is at least crank and offset together, the closed form; the sine of the angle is what it lacks."""
    crank, rod, offset = 0.6, 0.8, 0.3
    changes = by_path(single_changes(slider_crank(crank, rod, offset, form)))
    crank_path, rod_path = (
        ("links.OA.length", "links.AB.length")
        if form == "length"
        else ("links.OA.points.A.x", "links.AB.points.B.y")
    )
    assert set(changes) == {crank_path, rod_path, "guides.B.through.y"}
    limits = {crank_path: rod - offset, rod_path: crank + offset, "guides.B.through.y": rod - crank}
    for path, limit in limits.items():
        change = changes[path]
        assert change.bound == pytest.approx(limit, abs=NODES * rod)
        new = {crank_path: crank, rod_path: rod, "guides.B.through.y": offset} | {path: change.after}
        cosine = (new[crank_path] + new["guides.B.through.y"]) / new[rod_path]
        assert cosine < 1.0
        assert change.least_angle == pytest.approx(math.acos(cosine), rel=1e-12)
    sizes = [change.size for change in changes.values()]
    assert sizes == sorted(sizes)


SIX_BAR = {
    "frame": {"points": {"O": [0, 0], "D": [0.08, 0], "F": [0.15, 0]}},
    "links": {name: {"length": length} for name, length in
              (("OA", 0.025), ("AB", 0.07), ("DB", 0.05), ("BE", 0.04), ("FE", 0.066))},
    "drives": [{"link": "OA", "start": math.pi / 2, "speed": 1.0}],
    "assembly": {"sides": {"B": "left", "E": "right"}},
    "display": DISPLAY,
}  # fmt: skip


def distance_from_f(phi: float, rocker: float = 0.05, fixed: float = 0.15) -> float:
    """Distance of B of the six-bar from F, by triangles alone."""
    a = 0.025 * np.exp(1j * phi)
    to_a, far = np.angle(a - 0.08), abs(a - 0.08)
    inner = math.acos((far**2 + rocker**2 - 0.07**2) / (2 * far * rocker))
    # B is left of the line from A to D
    b = min((0.08 + rocker * np.exp(1j * (to_a + sign * inner)) for sign in (1, -1)), key=lambda b: -b.imag)
    return float(abs(b - fixed))


def test_the_second_dyad_of_a_six_bar_is_made_to_close() -> None:
    """Rods 40 and 66 mm on B and F: they reach as far as B goes from F, which triangles tell."""
    mechanism = ct.Mechanism(**SIX_BAR)
    found = single_changes(mechanism)
    changes = by_path(found)
    turn = np.linspace(0.0, math.tau, 7201)
    apart = np.array([distance_from_f(phi) for phi in turn])
    farthest = apart.max()
    assert farthest > 0.04 + 0.066
    # the grid misses the greatest distance by less than the square of half a step
    assert changes["links.FE.length"].bound == pytest.approx(farthest - 0.04, abs=1e-8)
    assert changes["links.BE.length"].bound == pytest.approx(farthest - 0.066, abs=1e-8)
    reach = brentq(
        lambda x: max(distance_from_f(phi, fixed=x) for phi in turn[::20]) - 0.106, 0.12, 0.15, xtol=1e-9
    )
    assert changes["frame.points.F.x"].bound == pytest.approx(reach, abs=1e-6)
    for change in changes.values():
        course = ct.motion(change.repaired, samples=181)
        assert (course["status"] == ct.Status.OK).all()
        assert change.residual < 1e-14
        again = ct.parse_mechanism(ct.mechanism_text(change.repaired))
        assert ct.rotatability(again).turns_fully
    change = changes["links.FE.length"]
    places = ct.motion(change.repaired, at=[0.3]).position.sel(sample=0)
    b, e, f = (places.sel(point=name).values for name in "BEF")
    assert np.hypot(*(e - b)) == pytest.approx(0.04, rel=1e-12)
    assert np.hypot(*(e - f)) == pytest.approx(change.after, rel=1e-12)
    assert np.hypot(*(b - f)) == pytest.approx(distance_from_f(0.3), rel=1e-12)


def test_a_swing_beyond_its_reach_needs_its_own_range_only() -> None:
    """From 20 to 120 degrees: the rods have to reach where the crank stands at 120."""
    lengths = {"OA": 0.06, "AB": 0.07, "DB": 0.05, "OD": 0.09}
    study = {"from": math.radians(20), "to": math.radians(120)}
    mechanism = four_bar(
        *lengths.values(),
        drives=[{"link": "OA", "start": math.radians(60), "speed": 1}],
        study=study,
        display=DISPLAY,
    )
    found = single_changes(mechanism, margins=TEN)
    changes = by_path(found)
    assert found is not None and not found.required.turn
    assert (found.required.low, found.required.high) == (study["from"], study["to"])
    reach = math.sqrt(0.06**2 + 0.09**2 - 2 * 0.06 * 0.09 * math.cos(study["to"]))
    assert changes["links.AB.length"].bound == pytest.approx(reach - 0.05, abs=NODES * 0.09)
    assert changes["links.DB.length"].bound == pytest.approx(reach - 0.07, abs=NODES * 0.09)
    for change in changes.values():
        assert ct.rotatability(change.repaired).limits or ct.rotatability(change.repaired).turns_fully
        assert (ct.motion(change.repaired)["status"] == ct.Status.OK).all()
    inside = mechanism.model_copy(update={"study": ct.Study(**{"from": 0.4, "to": 1.8})})
    assert single_changes(inside) is None


def test_a_spherical_crank_turns_from_the_arc_of_grashofs_rule() -> None:
    """Crank 50, coupler 45, rocker 90, ground 90 degrees: 45 + 90 < 50 + 90, but the coupler is the shortest arc."""
    text = ct.mechanism_text(ct.example("spherical-four-bar"))
    mechanism = ct.parse_mechanism(text)
    for path, value in (("links.AB.length", 50), ("drives.AB.start", 45), ("links.DC.angle", 50)):
        mechanism = ct.with_value(mechanism, path, f"{value} deg")
    assert ct.rotatability(mechanism).turns_fully is False
    changes = by_path(single_changes(mechanism, margins=TEN))
    assert changes["links.AB.length"].bound == pytest.approx(math.radians(45), rel=1e-8)
    assert changes["links.BC.length"].bound == pytest.approx(math.radians(50), rel=1e-8)
    for change in changes.values():
        assert ct.rotatability(change.repaired).turns_fully


def test_what_is_placed_is_placed_anew() -> None:
    mechanism = ct.example("slider-between-cranks-locked")
    assert {one.kind for one in dimensions_of_design(mechanism)} == {"length", "angle"}
    changes = by_path(single_changes(mechanism, margins=TEN))
    change = changes["links.CB.angle"]
    repaired = change.repaired
    # C is at (1.5, 1/2 sin 0.5...) of the chain of initial angles; D follows from CB and BD
    c = 0.5 + 1.0 * np.exp(0.5j)
    d = c + 1.2 * np.exp(1j * change.after) + 0.8 * np.exp(5.7j)
    assert repaired.frame.coordinates["D"] == pytest.approx((d.real, d.imag), rel=1e-12)
    assert ct.rotatability(repaired).turns_fully


def test_twenty_degrees_are_kept_where_one_dimension_brings_them_about() -> None:
    """Else the greatest that any dimension brings about is told: of the source's locked mechanism OA does it."""
    found = single_changes("slider-between-cranks-locked")
    assert found is not None and found.margin == LEAST_ANGLES[0] and found.greatest is None
    assert all(change.least_angle >= LEAST_ANGLES[0] - 1e-9 for change in found.changes)
    # row 19 of the source's table: the crank at a fifth of its length is the best that one dimension does
    numbers = {"links.BD.length": 0.5, "links.CB.length": 1.0}
    numbers |= {"links.AC.angle": 2.1, "links.CB.angle": 0.5, "links.BD.angle": 4.7}
    lower = single_changes(replace_placed(with_values(ct.example("slider-between-cranks-locked"), numbers)))
    assert lower is not None and lower.margin == math.radians(10)
    assert lower.greatest == pytest.approx(math.acos(0.2 * 0.5 + math.sin(2.1)), rel=1e-6)


def test_a_report_proposes_initial_angles_before_lengths() -> None:
    """The source changes initial angles; they have few digits, and every group keeps 20 degrees by triangles alone."""
    mechanism = ct.example("slider-between-cranks-locked")
    found = single_changes(mechanism)
    assert found is not None
    proposed = propose(found)
    assert proposed is not None and proposed.angle == proposed.wanted == LEAST_ANGLES[0]
    assert {one.kind for one in proposed.dimensions} == {"angle"}
    assert all(change.after == round(change.after, 3) for change in proposed.changes)
    phi2, phi3, phi4 = (proposed.repaired.initial_angle(link) for link in ("AC", "CB", "BD"))
    turn = np.linspace(0.0, math.tau, 3601)
    height = np.sin(phi2)
    c = 0.5 * np.cos(turn) + np.sqrt(1.0 - (height - 0.5 * np.sin(turn)) ** 2) + 1j * height
    d = 0.5 + np.exp(1j * phi2) + 1.2 * np.exp(1j * phi3) + 0.8 * np.exp(1j * phi4)
    between = (1.2**2 + 0.8**2 - np.abs(c - d) ** 2) / (2 * 1.2 * 0.8)
    sines = np.sqrt(1.0 - np.array([(0.5 * np.sin(turn) - height) ** 2, between**2]))
    assert sines.min() == pytest.approx(math.sin(proposed.least_angle), abs=1e-5)
    assert proposed.least_angle >= LEAST_ANGLES[0] - 1e-9


def test_a_named_angle_and_a_greatest_change_bound_the_proposal() -> None:
    """The least angle of the proposal by the law of cosines; an angle that is named has no lesser one behind it."""
    lengths = {"OA": 0.06, "AB": 0.07, "DB": 0.05, "OD": 0.09}
    mechanism = four_bar(
        *lengths.values(), drives=[{"link": "OA", "start": 1.0, "speed": 1}], display=DISPLAY
    )
    sizes: dict[float, float] = {}
    for angle in (5.0, 30.0):
        found = rotatability_results(mechanism, complete=True, least_transmission_angle=f"{angle} deg")
        proposed = found.proposed
        assert proposed is not None and proposed.wanted == proposed.angle == math.radians(angle)
        named = {"OD" if "frame" in one.path else one.path.split(".")[1]: one for one in proposed.changes}
        kept = least_angle(*(lengths | {name: one.after for name, one in named.items()}).values())
        assert kept >= math.radians(angle) - 1e-9
        assert proposed.least_angle == pytest.approx(kept, rel=1e-9)
        sizes[angle] = max(abs(one.size) for one in proposed.changes)
    assert sizes[5.0] < sizes[30.0], "a lesser angle needs a smaller change"
    # Grashof's rule needs DB at 80 mm, or OA at 30 mm: no length within a fifth of itself does alone
    found = rotatability_results(
        mechanism, complete=True, least_transmission_angle="5 deg", greatest_change="20 %"
    )
    assert found.single is not None and not {c.dimension.kind for c in found.single.changes} & {"length"}
    assert found.proposed is not None and found.proposed.least_angle >= math.radians(5.0) - 1e-9
    for change in found.proposed.changes:
        assert abs(change.after / change.before - 1.0) <= 0.2 + 1e-9
    out_of_reach = rotatability_results(mechanism, complete=True, least_transmission_angle="85 deg")
    assert out_of_reach.proposed is None


def test_bounds_of_a_change_narrow_what_a_repair_tries() -> None:
    mechanism = ct.four_bar(2, 3, 2.5, 2.5)
    found = ct.repair(mechanism, greatest_change=0.3)
    assert [(one.low, one.high) for one in found.varying] == [
        pytest.approx((0.7 * one.before, 1.3 * one.before)) for one in found.varying
    ]
    given = ct.repair(
        mechanism, ["links.crank.length"], {"links.crank.length": (0.5, 2.0)}, greatest_change=0.3
    )
    assert [(one.low, one.high) for one in given.varying] == [(0.5, 2.0)], (
        "bounds that are given go before it"
    )
    with pytest.raises(ct.InputError, match=r"greatest_change: it must lie between 0 and 1, got 1\.5"):
        ct.repair(mechanism, greatest_change=1.5)


def test_of_a_four_bar_one_length_is_proposed() -> None:
    mechanism = four_bar(
        0.06, 0.07, 0.05, 0.09, drives=[{"link": "OA", "start": 1.0, "speed": 1}], display=DISPLAY
    )
    found = single_changes(mechanism)
    assert found is not None
    proposed = propose(found)
    assert proposed is not None and proposed.several is None
    assert [change.path for change in proposed.changes] == [found.changes[0].dimension.path]


def test_no_repair_is_sought_where_nothing_locks_or_none_is_computed() -> None:
    assert single_changes("crank-rocker") is None
    assert single_changes("double-rocker") is None, "the range that it asks for is within its reach"
    geared = ct.with_value(ct.example("geared-five-bar"), "links.AB.length", 2.1)
    with pytest.raises(NotComputedYet, match="gears"):
        single_changes(geared)
    with pytest.raises(ct.InputError, match="one drive"):
        single_changes("five-bar-two-drives")
    found = rotatability_results(geared)
    assert found.single is None and found.refusal is not None
    assert "\nrepair " in ct.summary(found) and "none is sought: " in ct.summary(found)


def test_where_no_single_dimension_helps_several_are_changed() -> None:
    """Two rods of 40 mm between a crank of 60 and a frame of 110 mm: no single length satisfies Grashof's rule."""
    lengths = [0.06, 0.04, 0.04, 0.11]
    for number in range(4):
        for share in np.linspace(0.2, 3.0, 500):
            assert not turning(*(x * share if k == number else x for k, x in enumerate(lengths)))
    mechanism = four_bar(*lengths, drives=[{"link": "OA", "start": 0.3, "speed": 1}], display=DISPLAY)
    found = rotatability_results(mechanism, complete=True)
    assert found.single is not None and not found.single.changes
    assert "no change of one dimension alone was found" in ct.summary(rotatability_results(mechanism))
    assert found.repair is not None and found.repair.found and found.dead is not None
    repaired = found.repair.repaired
    assert repaired is not None
    assert turning(*(ct.value_at(repaired, f"links.{name}.length") for name in ("OA", "AB", "DB")), 0.11)


def test_the_dead_position_is_drawn_at_the_limit() -> None:
    found = rotatability_results(slider_crank(0.6, 0.8, 0.3), complete=True)
    assert isinstance(found, RotatabilityResults) and found.dead is not None
    assert found.proposed is not None and found.proposed.several is None
    # the crank's end is as far below the guide as the rod is long
    assert found.dead.limit.value == pytest.approx(math.pi + math.asin(0.5 / 0.6), rel=1e-12)
    a, b = (found.dead.locked.position.sel(point=name).values[0] for name in "AB")
    # half of the digits: a distance of rounding beside the limit moves the rod by its root
    assert b - a == pytest.approx((0.0, 0.8), abs=1e-7)


def test_a_law_asks_for_the_range_of_its_values() -> None:
    mechanism = four_bar(
        0.06, 0.07, 0.05, 0.09, drives=[{"link": "OA", "start": 1.0, "law": "1.2*sin(t)"}], display=DISPLAY
    )
    mechanism = mechanism.model_copy(update={"study": ct.Study(**{"from": 0.0, "to": 6.2})})
    found = rotatability_results(mechanism, complete=True)
    assert found.single is not None and found.dead is not None
    required = found.single.required
    # the least and the greatest of 361 samples miss the extremes by less than half of the square of half a step
    assert (required.low, required.high) == pytest.approx((-0.2, 2.2), abs=1.2 * (6.2 / 360) ** 2 / 8)
    reach = math.sqrt(0.06**2 + 0.09**2 - 2 * 0.06 * 0.09 * math.cos(required.high))
    change = by_path(found.single)["links.DB.length"]
    assert change.bound == pytest.approx(reach - 0.07, abs=NODES * 0.09)
    assert (ct.motion(change.repaired)["status"] == ct.Status.OK).all()
    # the last sample before the limit
    limit = math.acos((0.06**2 + 0.09**2 - 0.12**2) / (2 * 0.06 * 0.09))
    assert 0.0 < limit - float(found.dead.locked["drive_value"][0, 0]) < 1.2 * 6.2 / 360
