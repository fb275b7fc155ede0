"""Repairs: what is found turns by independent formulas, nothing smaller nearby does, and impossibility is proved."""

from __future__ import annotations

import csv
import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import centrode as ct
from centrode.analysis.redesign.candidates import Candidates, impossible, varyings
from centrode.analysis.redesign.repair import ENOUGH, LEAST_ANGLES, Repair
from centrode.kinematics.preparation import ready
from centrode.model.examples import example_text
from centrode.render.terminal import plain_text
from centrode.views.rotatability import impossibility_text
from mechanisms import four_bar
from samples import few
from turning import recorded

Array = npt.NDArray[np.float64]
VARIANTS = Path(__file__).parents[1] / "reference" / "planar-variants.csv"
ANGLES = ("links.CB.angle", "links.BD.angle")
LOCKED = ct.example("slider-between-cranks-locked")
DEGREE = math.radians(1.0)


def sines(phi: Array, lengths: tuple[float, float, float] = (1.0, 1.2, 0.8)) -> Array:
    """Least sine of both transmission angles of the worked mechanism over a turn, for initial angles (..., 3).

    Negative where it does not turn. By triangles alone: C on its guide, and its distance from D.
    """
    l2, l3, l4 = lengths
    phi = np.asarray(phi, dtype=float)[..., None, :]
    turn = np.linspace(0.0, math.tau, 2001)
    height = l2 * np.sin(phi[..., 0])
    ahead = np.sign(np.cos(phi[..., 0]))
    c0 = 0.5 + l2 * np.exp(1j * phi[..., 0])
    d = c0 + l3 * np.exp(1j * phi[..., 1]) + l4 * np.exp(1j * phi[..., 2])
    cosine = (0.5 * np.sin(turn) - height) / l2
    with np.errstate(invalid="ignore"):
        c = 0.5 * np.cos(turn) + ahead * l2 * np.sqrt(1 - cosine**2) + 1j * height
    between = (l3**2 + l4**2 - abs(c - d) ** 2) / (2 * l3 * l4)
    worst = np.fmax(np.max(np.abs(cosine), axis=-1), np.nanmax(np.abs(between), axis=-1))
    return np.where(worst <= 1, np.sqrt(np.abs(1 - worst**2)), -1.0)


def phi_of(found: Repair) -> Array:
    assert found.repaired is not None
    return np.array([found.repaired.links[link].angle for link in ("AC", "CB", "BD")], dtype=float)


def said_impossible(found: Repair) -> str:
    """The inequality that excludes a repair, as a terminal prints it."""
    assert found.impossible is not None
    return plain_text(impossibility_text(found.impossible), found.mechanism.display)


def variant(number: int) -> ct.Mechanism:
    """A row of the source on the worked topology."""
    with VARIANTS.open(encoding="utf-8", newline="") as stream:
        row = next(row for row in csv.DictReader(stream) if int(row["variant"]) == number)
    parts: dict[str, Any] = tomllib.loads(example_text("slider-between-cranks"))
    for k, link in enumerate(("AC", "CB", "BD"), start=2):
        parts["links"][link] |= {"length": float(row[f"l{k}_m"]), "angle": float(row[f"phi{k}_0_rad"])}
    return ct.Mechanism(**parts)


@pytest.fixture(scope="module")
def worked() -> Repair:
    return ct.repair(LOCKED, ANGLES, least_transmission_angle=DEGREE)


def test_the_locked_mechanism_of_the_source_is_made_to_turn(worked: Repair) -> None:
    assert worked.found
    assert worked.before.turns_fully is False
    assert worked.after is not None and worked.after.turns_fully is True
    assert worked.reached is not None and worked.reached >= DEGREE - ENOUGH
    # the grid of `sines` misses its least value by less than the square of half a step
    assert sines(phi_of(worked)) == pytest.approx(math.sin(worked.reached), abs=1e-4)
    assert math.hypot(*(change.size for change in worked.changes)) == pytest.approx(worked.size, rel=1e-15)
    assert {change.path for change in worked.changes} == set(ANGLES)
    status = ct.motion(worked.repaired, samples=721).status  # type: ignore[arg-type]
    assert (status == 0).all()


def test_no_smaller_change_of_the_two_angles_turns(worked: Repair) -> None:
    """A grid in polar coordinates about the present angles, up to a little less than the change that was found."""
    radius, direction = np.meshgrid(np.linspace(0.02, 0.999, 40) * worked.size, np.linspace(0, math.tau, 181))
    phi = np.stack(
        [np.full(radius.shape, 0.5), 4.7 + radius * np.cos(direction), 5.7 + radius * np.sin(direction)],
        axis=-1,
    )
    least = np.concatenate([sines(part) for part in np.array_split(phi, 20)])
    assert least.max() < math.sin(DEGREE)
    assert sines(np.array([0.5, 1.9, 3.5])) > math.sin(DEGREE)  # the source's own repair, much further away


def test_the_same_question_has_the_same_answer(worked: Repair) -> None:
    assert ct.repair(LOCKED, ANGLES, least_transmission_angle=DEGREE).changes == worked.changes


@pytest.mark.parametrize(
    ("number", "degrees"), few([(1, 1.0), (23, 20.0)], [(1, 1.0), (15, 20.0), (23, 20.0)])
)
def test_variants_that_lock_are_made_to_turn(number: int, degrees: float) -> None:
    mechanism = variant(number)
    lengths = tuple(float(mechanism.links[link].length or 0.0) for link in ("AC", "CB", "BD"))
    found = ct.repair(mechanism, least_transmission_angle=f"{degrees} deg")
    assert found.before.turns_fully is False
    assert found.found
    assert sines(phi_of(found), lengths) >= math.sin(math.radians(degrees)) - 1e-6  # type: ignore[arg-type]
    assert 0 < found.turning < found.spread <= found.tried


def test_lengths_change_by_as_little_as_the_rule_of_grashof_asks() -> None:
    """Only the crank varies: it turns once shortest and longest are the others together, less the angle's share."""
    mechanism = four_bar(2.0, 2.5, 3.0, 4.0, drives=[{"link": "OA", "start": 0.5, "speed": 1}])
    asked = math.radians(15)
    found = ct.repair(mechanism, ["links.OA.length"], least_transmission_angle=asked)
    (change,) = found.changes
    stretched = math.sqrt(2.5**2 + 3.0**2 + 2 * 2.5 * 3.0 * math.cos(asked))
    assert change.after == pytest.approx(stretched - 4.0, rel=1e-5)
    assert change.size == pytest.approx((change.after - 2.0) / 2.0, rel=1e-12)
    assert found.reached == pytest.approx(asked, abs=1e-4)
    assert found.repaired is not None
    again = ct.parse_mechanism(ct.mechanism_text(found.repaired))
    assert ct.rotatability(again).turns_fully is True


def test_bounds_are_kept_and_a_pivot_may_move() -> None:
    mechanism = four_bar(2.0, 2.5, 3.0, 4.0, drives=[{"link": "OA", "start": 0.5, "speed": 1}])
    bounds = {"frame.points.D.x": ("3 m", "4 m"), "frame.points.D.y": (-0.2, 0.2)}
    found = ct.repair(mechanism, bounds=bounds, least_transmission_angle=DEGREE)
    x, y = (change.after for change in found.changes)
    assert 3.0 <= x <= 4.0 and -0.2 <= y <= 0.2
    assert math.hypot(x, y) + 2.0 <= 2.5 + 3.0
    # a coordinate counts in the greatest length, 4 m; the shortest way is straight towards the crank
    assert found.size == pytest.approx((4.0 - math.hypot(x, y)) / 4.0, abs=1e-6)


def test_what_turns_already_stays() -> None:
    mechanism = four_bar(1.0, 3.5, 3.0, 4.0)
    found = ct.repair(mechanism)
    assert found.found and found.repaired == mechanism
    assert found.size == 0.0 and found.changes == ()


def test_spherical_four_bars_are_repaired() -> None:
    mechanism = ct.Mechanism(
        space="sphere",
        frame={"points": {"A": [0, 0], "D": [1.4, 0]}},
        links={"AB": {"length": 1.0, "reference": ["A", "D"]}, "BC": {"length": 0.9}, "DC": {"length": 1.2}},
        drives=[{"link": "AB", "start": 1.0, "speed": 1}],
        assembly={"sides": {"C": "left"}},
    )
    assert ct.rotatability(mechanism).turns_fully is False
    found = ct.repair(mechanism, least_transmission_angle="10 deg")
    assert found.found and found.after is not None
    (transmission,) = found.after.one.transmissions
    assert transmission.least >= math.radians(10) - ENOUGH
    a, b, c = (change.after for change in found.changes)
    assert 1.4 + a <= b + c and abs(b - c) <= 1.4 - a


@pytest.mark.parametrize(
    ("crank", "vary", "angle", "inequality"),
    [
        (1.3, ["links.AC.angle", *ANGLES], "1 deg", "OA > AC cos 1 deg: 1.3 m > 0.999848 m"),
        (0.5, [*ANGLES], "20 deg", "OA + e > AC cos 20 deg: 0.979426 m > 0.939693 m (e = 0.479426 m"),
        (0.9, ["links.BD.length"], "20 deg", "OA + e > AC cos 20 deg"),
    ],
)
def test_impossible_is_said_with_an_inequality(
    crank: float, vary: list[str], angle: str, inequality: str
) -> None:
    parts: dict[str, Any] = tomllib.loads(example_text("slider-between-cranks-locked"))
    parts["links"]["OA"]["length"] = crank
    mechanism = ct.Mechanism(**parts)
    found = ct.repair(mechanism, vary, least_transmission_angle=angle)
    assert not found.found and found.repaired is None and found.tried == 0
    assert said_impossible(found).startswith(inequality)


def test_the_stroke_of_the_slider_is_too_long_for_short_rods() -> None:
    parts: dict[str, Any] = tomllib.loads(example_text("slider-between-cranks-locked"))
    parts["links"]["CB"]["length"] = parts["links"]["BD"]["length"] = 0.2
    mechanism = ct.Mechanism(**parts)
    found = ct.repair(mechanism, ["links.AC.angle", *ANGLES], least_transmission_angle=DEGREE)
    assert said_impossible(found).startswith("OA > 2 sqrt(CB BD cos 1 deg): 0.5 m > 0.39997 m")
    longer = ct.repair(
        mechanism, ["links.CB.length", *ANGLES], least_transmission_angle=DEGREE
    )  # up to 0.4 m
    assert longer.impossible is None


def test_impossible_is_never_said_of_what_turns() -> None:
    """Random cranks and rods, random angles asked: where a turning mechanism exists, no inequality excludes it."""
    random = np.random.default_rng(2)
    excluded = turned = 0
    for _k in range(few(8, 20)):
        lengths = tuple(float(x) for x in (0.4 + 0.8 * random.random(), *(0.1 + 0.7 * random.random(2))))
        parts: dict[str, Any] = tomllib.loads(example_text("slider-between-cranks-locked"))
        for link, length in zip(("AC", "CB", "BD"), lengths, strict=True):
            parts["links"][link]["length"] = length
        parts["links"]["OA"]["length"] = 0.5
        mechanism = ct.Mechanism(**parts)
        prepared = ready(mechanism)
        varying = varyings(prepared, ["links.AC.angle", *ANGLES], None)
        reason = impossible(Candidates(prepared, varying), DEGREE)
        phi = random.uniform(-math.pi, math.pi, (1500, 3))
        parted = np.array_split(phi, 4)
        turning = any(sines(part, lengths).max() >= math.sin(DEGREE) for part in parted)  # type: ignore[arg-type]
        assert not (turning and reason is not None)
        excluded += reason is not None
        turned += turning
    assert excluded and turned


def test_without_a_wish_twenty_degrees_are_kept() -> None:
    found = ct.repair(LOCKED)
    assert found.found and found.wanted == found.least_transmission_angle == LEAST_ANGLES[0]
    assert found.reached is not None and found.reached >= math.radians(20) - ENOUGH
    assert sines(phi_of(found)) >= math.sin(math.radians(20)) - 1e-6


def test_what_is_out_of_reach_is_said_with_the_greatest_angle() -> None:
    """The angle of AC alone bounds that of its own group: its cosine is crank and offset over AC."""
    bound = math.acos(0.5 + math.sin(0.5))
    found = ct.repair(LOCKED, ANGLES)
    assert found.found and found.impossible is not None and found.wanted == LEAST_ANGLES[0]
    assert found.least_transmission_angle == math.radians(10)
    assert found.reached is not None and math.radians(10) - ENOUGH <= found.reached < bound
    assert found.greatest == pytest.approx(bound, abs=1e-6)
    said = ct.summary(found)
    assert "\nout of reach" in said and "transmission angles of 11.64 deg at most" in said
    strict = ct.repair(LOCKED, ANGLES, least_transmission_angle="20 deg")
    assert not strict.found and strict.greatest == pytest.approx(bound, abs=1e-6)


def test_none_found_claims_nothing(tmp_path: Path) -> None:
    found = ct.repair(LOCKED, bounds={"links.CB.angle": (4.69, 4.71)}, least_transmission_angle=DEGREE)
    assert not found.found and found.impossible is None and found.turning == 0
    said = ct.summary(found).splitlines()[1]
    assert said.split("  ", 1)[0] == "found"
    assert said.endswith("none found within the bounds; this does not prove that none exists")
    data = recorded(found, tmp_path)
    assert data["found"] is False and data["after"] is None and data["impossible"] == ""


@pytest.mark.parametrize(
    ("mechanism", "asked", "message"),
    [
        ("slider-between-cranks-locked", {"vary": ["links.XY.angle"]}, 'there is no "XY"'),
        ("slider-between-cranks-locked", {"vary": ["links.OA.angle"]}, "the drive gives this angle"),
        ("slider-between-cranks-locked", {"vary": ["frame.points.D.x"]}, "placed by the initial angles"),
        ("triple-rocker", {"vary": ["links.AB.angle"]}, "determines no dimension"),
        ("triple-rocker", {"bounds": {"links.AB.length": (3, 4)}}, "must contain its present value"),
        ("triple-rocker", {"bounds": {"links.AB.length": (-1, 4)}}, "a length must be positive"),
        ("triple-rocker", {"bounds": {"links.AB.length": (4, 2)}}, "its lower bound is above its upper one"),
        ("triple-rocker", {"bounds": {"links.AB.length": ("1 kg", 4)}}, "links.AB.length"),
        (
            "triple-rocker",
            {"vary": ["links.OA.length"], "bounds": {"links.AB.length": (1, 4)}},
            "not one of the varied numbers",
        ),
        ("triple-rocker", {"vary": ["drives.OA.speed"]}, "names no dimension"),
        ("triple-rocker", {"vary": ["links.AB.length"] * 2 + ["frame.points.D.x"] * 20}, None),
        ("triple-rocker", {"least_transmission_angle": "95 deg"}, "between 0 and 90 deg"),
        ("triple-rocker", {"least_transmission_angle": -0.1}, "between 0 and 90 deg"),
        ("triple-rocker", {"least_transmission_angle": "1 mm"}, "least_transmission_angle"),
        ("five-bar-two-drives", {}, "2 are given"),
        ("elliptic-trammel", {}, "a displacement cannot turn fully"),
        ("stephenson-driven-at-rocker", {}, "groups of higher class"),
        ("planetary-gear-train", {}, "gears and rolling wheels"),
    ],
)
def test_wrong_questions_are_refused(mechanism: str, asked: dict[str, Any], message: str | None) -> None:
    if message is None:
        assert ct.repair(ct.example(mechanism), **asked).changes[0].path == "links.AB.length"
        return
    with pytest.raises(ct.InputError) as refusal:
        ct.repair(ct.example(mechanism), **asked)
    assert message in str(refusal.value)


def test_progress_runs_to_its_end() -> None:
    seen: list[tuple[int, int]] = []
    ct.repair(ct.example("triple-rocker"), progress=lambda done, of: seen.append((done, of)))
    assert seen[-1][0] == seen[-1][1] > 0
    assert all(0 < done <= of for done, of in seen)
