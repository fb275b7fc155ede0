"""Poses of links, and bounds of a place that is free: against a six-bar linkage by equations of its own.

O-A-B-D is a four-bar linkage with a coupler point P; the link PE hangs on P and on the rocker FE. Everything follows
from two intersections of circles, whose sides say the branch.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.synthesis import mechanism_synthesis
from centrode.synthesis.requests import SYNTHESES

KNOWN = {
    "links.PE.points.E.x": 2.6,
    "links.PE.points.Q.x": 1.1,
    "links.PE.points.Q.y": 0.8,
    "links.FE.length": 2.2,
    "frame.points.F.x": 3.2,
}
RANGES = {
    "links.PE.points.E.x": [1.9, 3.3], "links.PE.points.Q.x": [0.5, 2.0], "links.PE.points.Q.y": [0.2, 1.5],
    "links.FE.length": [1.6, 2.9], "frame.points.F.x": [2.6, 3.6],
}  # fmt: skip
DRIVE = np.array([0.31, 0.77, 1.29, 1.83, 2.36, 2.94])
"""Between the samples of the search, which are 2 deg apart."""
FACTOR, SHIFT = 0.7 * np.exp(2.1j), 3 - 5j


@pytest.fixture(autouse=True)
def few_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mechanism_synthesis, "STARTS", 60)
    monkeypatch.setattr(mechanism_synthesis, "REFINED", 4)


def tables() -> dict[str, Any]:
    """The linkage with other numbers than the known ones."""
    return {
        "frame": {"points": {"O": [0, 0], "D": [4, 0], "F": [3.0, 3.0]}},
        "links": {
            "OA": {"length": 1.0},
            "AB": {"points": {"A": [0, 0], "B": [3.5, 0], "P": [1.8, 1.4]}},
            "DB": {"length": 3.0},
            "PE": {"points": {"P": [0, 0], "E": [2.3, 0], "Q": [0.9, 0.5]}},
            "FE": {"length": 2.0},
        },
        "drives": [{"link": "OA", "start": 0.0, "speed": 1.0}],
        "assembly": {"sides": {"B": "left", "E": "left"}},
    }


def meet(one: Any, other: Any, r: float, s: float) -> Any:
    """Where circles about two points meet, to the left of the line between them; NaN where they do not."""
    line = other - one
    d = np.abs(line)
    along = (d**2 + r**2 - s**2) / (2 * d)
    with np.errstate(invalid="ignore"):
        return one + line / d * (along + 1j * np.sqrt(r**2 - along**2))


def poses(drive: Any, mechanism: Any = None) -> tuple[Any, Any]:
    """Places of Q and directions of PE, by own equations: of the known linkage, or of an answer."""
    number = KNOWN.__getitem__ if mechanism is None else lambda path: ct.value_at(mechanism, path)
    A = np.exp(1j * drive)
    B = meet(A, 4.0, 3.5, 3.0)
    P = A + (B - A) / 3.5 * (1.8 + 1.4j)
    F = number("frame.points.F.x") + 3.0j
    length = number("links.PE.points.E.x")
    E = meet(P, F, length, number("links.FE.length"))
    direction = (E - P) / length
    return P + direction * complex(number("links.PE.points.Q.x"), number("links.PE.points.Q.y")), np.angle(
        direction
    )


def rows(places: Any, *columns: Any) -> list[list[float]]:
    return np.column_stack([places.real, places.imag, *columns]).tolist()


def request(**wanted: Any) -> dict[str, Any]:
    own = {"kind": "motion", "link": "PE", "point": "Q", "free": RANGES, "answers": 2}
    return {**tables(), "synthesis": {**own, **wanted}}


@pytest.mark.parametrize("timing", ["free", "given", "phase"])
def test_poses_of_a_six_bar(timing: str) -> None:
    """The poses of a known linkage return it; the drive's angles are those up to a start where only that is unknown."""
    places, turns = poses(DRIVE)
    given = {"free": (), "given": (DRIVE,), "phase": (DRIVE + 0.9,)}[timing]
    found = ct.synthesise(request(targets=rows(places, turns, *given), timing=timing))
    best = found.answers[0]
    for path, value in KNOWN.items():
        assert ct.value_at(best.mechanism, path) == pytest.approx(value, rel=1e-9)
    assert best.drive == pytest.approx(DRIVE, abs=1e-9)
    assert best.error < 1e-9 and best.numbers["turn_error"][0] < 1e-9
    assert best.defects.none and len(best.links) == 5
    for answer in found.answers:
        # followed by equations of one's own on one side of both dyads: no limit lies between the first and the last
        way = np.linspace(answer.drive[0], answer.drive[-1], 2001)
        own, _angles = poses(way, answer.mechanism)
        assert np.isfinite(own).all() and np.abs(np.diff(own)).max() < 0.05
        assert (np.diff(answer.drive) > 0).all() or (np.diff(answer.drive) < 0).all()
        met, turned = poses(answer.drive, answer.mechanism)
        assert float(np.sqrt(np.mean(np.abs(met - places) ** 2))) == pytest.approx(answer.error, abs=1e-9)
        missed = np.abs(np.angle(np.exp(1j * (turned - turns)))).max()
        assert missed == pytest.approx(answer.numbers["turn_error"][0], abs=1e-9)


@pytest.mark.parametrize("timing", ["free", "phase"])
def test_moved_poses(timing: str) -> None:
    """Poses that were turned, scaled and shifted return the linkage but for that similarity."""
    places, turns = poses(DRIVE)
    given = (DRIVE + 0.9,) if timing == "phase" else ()
    targets = rows(FACTOR * places + SHIFT, turns + np.angle(FACTOR), *given)
    best = ct.synthesise(request(targets=targets, timing=timing, place="free")).answers[0]
    written = ct.parse_mechanism(ct.mechanism_text(best.mechanism))
    at = ct.motion(written, at=list(best.drive))
    met = at.position.sel(point="Q").to_numpy() @ [1, 1j]
    assert np.abs(met - FACTOR * places - SHIFT).max() < 1e-9
    turned = at.angle.sel(link="PE").to_numpy() - turns - np.angle(FACTOR)
    assert np.abs(np.angle(np.exp(1j * turned))).max() < 1e-9
    for path in ("links.PE.points.E.x", "links.PE.points.Q.y", "links.FE.length"):
        assert ct.value_at(written, path) == pytest.approx(0.7 * KNOWN[path], rel=1e-9)
    assert complex(*written.frame.points["O"]) == pytest.approx(SHIFT, abs=1e-9)


@pytest.mark.parametrize("place", ["given", "free"])
def test_path_with_a_common_start(place: str) -> None:
    """Angles of the drive that are known up to their zero."""
    places, _turns = poses(DRIVE)
    targets = places if place == "given" else FACTOR * places + SHIFT
    wanted = {"kind": "path", "point": "Q", "timing": "phase", "place": place, "answers": 1}
    free = {path: ends for path, ends in RANGES.items() if path != "links.PE.points.Q.y"}
    base = tables()
    base["links"]["PE"]["points"]["Q"][1] = KNOWN["links.PE.points.Q.y"]
    best = ct.synthesise(
        {**base, "synthesis": {**wanted, "free": free, "targets": rows(targets, DRIVE - 0.7)}}
    )
    best = best.answers[0]
    assert np.abs(best.met - targets).max() < 1e-9 and best.defects.none
    # the drive turns with the place, and its steps are those that were given
    assert np.diff(best.drive) == pytest.approx(np.diff(DRIVE), abs=1e-12)


def test_start_of_a_motion_that_is_no_turn() -> None:
    """Angles that reach farther than the drive are refused; others are put where they fit."""
    base = tables()
    base["study"] = {"start": "10 deg", "stop": "190 deg"}
    wanted = {"kind": "path", "point": "Q", "timing": "phase", "free": RANGES, "answers": 1}
    places, _turns = poses(DRIVE)
    best = ct.synthesise({**base, "synthesis": {**wanted, "targets": rows(places, DRIVE + 2.0)}}).answers[0]
    assert best.error < 1e-9 and best.drive == pytest.approx(DRIVE, abs=1e-8)
    with pytest.raises(ct.InputError, match="the values of the drive extend over"):
        ct.synthesise({**base, "synthesis": {**wanted, "targets": rows(places, 1.5 * DRIVE)}})


CASES = {
    "poses": {"timing": "free"},
    "poses in phase": {"timing": "phase"},
    "placed poses": {"timing": "free", "place": "free"},
    "placed path": {"kind": "path", "place": "free"},
}


@pytest.mark.parametrize("case", CASES)
def test_slopes(case: str) -> None:
    """Derivatives of all that steers a search, bounds of a free place included, against central differences."""
    wanted = CASES[case]
    places, turns = poses(DRIVE)
    columns = {"path": (), "motion": (turns,)}[wanted.get("kind", "motion")]
    columns += (DRIVE + 0.9,) if wanted.get("timing") == "phase" else ()
    noise = np.random.default_rng(2).normal(0, 0.05, len(places))
    limits = {"size": [3.0, 3.0], "transmission": "60 deg", "length_ratio": 1.5}
    if wanted.get("place") == "free":
        limits["pivots"] = {"x": [0.5, 1.5], "y": [0.1, 0.6]}
    given = {"targets": rows(places + noise, *columns), "constraints": limits, **wanted}
    given = request(**given)
    if wanted.get("kind") == "path":
        del given["synthesis"]["link"]
    search = mechanism_synthesis._MechanismSearch(SYNTHESES.from_tables(given))
    start = search.begin(np.array(search.moved.own)) + 0.01
    missed, slopes = search.steered_misses(start)
    count = len(search.misses(start)[0])
    assert np.count_nonzero(missed[count:]) > 20
    for k in range(len(start)):
        step = np.zeros(len(start))
        step[k] = 1e-6
        ahead, behind = (search.steered_misses(start + sign * step)[0] for sign in (1, -1))
        there = (ahead > 0) == (behind > 0)
        difference = ((ahead - behind) / 2e-6)[count:][there[count:]]
        scale = max(1.0, np.abs(slopes).max())
        assert np.abs(difference - slopes[count:, k][there[count:]]).max() < 1e-6 * scale
        # of the targets the sum of squares: places along the motion move, and what they cannot undo is left
        squares = ((ahead[:count] ** 2).sum() - (behind[:count] ** 2).sum()) / 2e-6
        assert squares == pytest.approx(2 * missed[:count] @ slopes[:count, k], rel=1e-5, abs=1e-6)


def free_path(**constraints: Any) -> Any:
    places, _turns = poses(DRIVE)
    wanted = {"kind": "path", "point": "Q", "place": "free", "answers": 1, "constraints": constraints}
    free = {path: RANGES[path] for path in ("links.FE.length", "frame.points.F.x")}
    return ct.synthesise({**tables(), "synthesis": {**wanted, "free": free, "targets": rows(places)}})


def box_of(mechanism: Any) -> tuple[Any, Any]:
    """Width and height of the box around all positions, and the fixed points."""
    moved = ct.motion(mechanism, 721).position.to_numpy().reshape(-1, 2)
    return np.ptp(moved, axis=0), np.array(list(mechanism.frame.points.values()))


def test_size_and_pivots_of_a_free_place(monkeypatch: pytest.MonkeyPatch) -> None:
    """The whole mechanism is turned, scaled and shifted into its bounds, which the mechanism as described breaks."""
    monkeypatch.setattr(mechanism_synthesis, "REFINED", 1)
    described, fixed = box_of(ct.Mechanism(**tables()))
    limit = (0.85 * described).tolist()
    box = [0.2, 3.6]
    answer = free_path(size=limit, pivots={"x": box}).answers[0]
    size, fixed = box_of(answer.mechanism)
    assert (size <= np.array(limit) * (1 + 1e-4)).all()
    assert (fixed[:, 0] >= box[0] - 1e-6).all() and (fixed[:, 0] <= box[1] + 1e-6).all()
    assert answer.defects.none
    places, _turns = poses(DRIVE)
    # turned and smaller it misses the targets, but by less than a tenth of their size
    assert 1e-6 < answer.error < 0.1 * np.abs(places - places.mean()).max()


@pytest.mark.parametrize(
    ("constraints", "said"),
    [
        (
            {"length_ratio": 1.2},
            r"breaks length_ratio: [\d.]+, where 1\.2 is the limit; it misses the targets by",
        ),
        ({"transmission": "85 deg"}, r"breaks transmission: [\d.]+ deg, where 85 deg is the limit"),
    ],
)
def test_how_near_the_nearest_is(
    constraints: dict[str, Any], said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mechanism_synthesis, "REFINED", 1)
    with pytest.raises(ct.MotionError, match=said):
        free_path(**constraints)


def test_names_with_spaces_and_letters_of_other_alphabets() -> None:
    base = tables()
    # the side of E is that of its links in their order
    base["links"] = {"звено 1" if name == "PE" else name: link for name, link in base["links"].items()}
    link = base["links"]["звено 1"]["points"]
    link["точка 1"] = [KNOWN["links.PE.points.Q.x"], KNOWN["links.PE.points.Q.y"]]
    del link["Q"]
    base["frame"]["points"]["F"][0] = KNOWN["frame.points.F.x"]
    places, turns = poses(DRIVE)
    free = {"links": {"FE": {"length": [1.6, 2.9]}, "звено 1": {"points": {"E": {"x": [1.9, 3.3]}}}}}
    wanted = {"kind": "motion", "link": "звено 1", "point": "точка 1", "free": free, "answers": 1}
    wanted["constraints"] = {"size": [30, 30], "transmission": "5 deg", "length_ratio": 9}
    found = ct.synthesise({**base, "synthesis": {**wanted, "targets": rows(places, turns)}})
    assert found.answers[0].error < 1e-9


@pytest.mark.parametrize(
    ("wanted", "said"),
    [
        ({"link": "PX"}, 'there is no link "PX"; did you mean'),
        ({"point": "B"}, 'the link "PE" has no point "B"'),
        ({"hinges": [[0, 0], [1, 0]]}, '"hinges" belongs to built-in topologies'),
        ({"place": "free", "timing": "given", "targets": [[0, 0, 0, 0], [1, 1, 1, 1]]}, 'timing = "phase"'),
        ({"timing": "phase"}, "timing needs an angle of the drive in every row"),
        (
            {"timing": "phase", "targets": [[0, 0, 0, 0], [1, 1, 1, 2], [2, 2, 2, 1], [3, 3, 3, 1.5]]},
            "neither rise nor fall",
        ),
        ({"constraints": {"crank": "DB"}}, 'no drive turns the link "DB"'),
        ({"targets": [[0, 0, 0], [0, 0, 0]]}, "all targets are the same"),
        ({"free": {"links.FE.length": [2, 2]}}, "give two different numbers"),
    ],
)
def test_refusals(wanted: dict[str, Any], said: str) -> None:
    with pytest.raises(ct.InputError) as refusal:
        ct.synthesise(request(**{"targets": [[0, 0, 0], [1, 1, 1]], **wanted}))
    assert said in str(refusal.value)
