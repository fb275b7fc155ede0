"""Mechanisms of files: Hoeken's linkage with a slotted lever, by path, function, and stroke with a dwell.

K. Hoeken's straight-line linkage has the lengths 1 : 2 : 2.5 and the point at 5 (Hoeken, Steigerung der
Wirtschaftlichkeit durch zweckmaessige Anwendung der Getriebelehre, Werkstattstechnik 1930); a lever that slides over
the point, hinged on the straight line, dwells while the crank turns by half a turn.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.synthesis import mechanism_synthesis
from centrode.synthesis.requests import SYNTHESES

PUBLISHED = {
    "links.AB.points.B.x": 2.5,
    "links.AB.points.P.x": 5.0,
    "links.DB.length": 2.5,
    "frame.points.D.x": 2.0,
}
RANGES = {
    "links.AB.points.B.x": [1.8, 3.4], "links.AB.points.P.x": [3.5, 7], "links.DB.length": [1.8, 3.4],
    "frame.points.D.x": [1.5, 2.8],
}  # fmt: skip


def tables(**numbers: float) -> dict[str, Any]:
    """The linkage; by default with lengths that draw no straight line."""
    given = {"b": 2.8, "p": 4.6, "c": 2.9, "d": 2.3, "f": 4.2, "lever": -0.0473, **numbers}
    return {
        "frame": {"points": {"O": [0, 0], "D": [given["d"], 0], "F": [9, given["f"]]}},
        "links": {
            "OA": {"length": 1.0},
            "AB": {"points": {"A": [0, 0], "B": [given["b"], 0], "P": [given["p"], 0]}},
            "DB": {"length": given["c"]},
            "lever": {"points": {"F": [0, 0], "G": [3, 0]}, "angle": given["lever"]},
        },
        "guides": [{"point": "P", "on": "lever", "through": "F", "direction": [1, 0]}],
        "drives": [{"link": "OA", "start": 0.0, "speed": 1.0}],
        "assembly": {"sides": {"B": "left"}},
    }


@pytest.fixture(scope="module")
def published() -> Any:
    """The motion of the published linkage."""
    there = tables(b=2.5, p=5.0, c=2.5, d=2.0, f=4.0, lever=-0.1277)
    return ct.motion(ct.Mechanism(**there), 73)


@pytest.fixture(autouse=True)
def few_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mechanism_synthesis, "STARTS", 120)
    monkeypatch.setattr(mechanism_synthesis, "REFINED", 6)


def synthesise(**wanted: Any) -> Any:
    return ct.synthesise({**tables(), "synthesis": {"free": RANGES, **wanted}})


@pytest.mark.parametrize("timing", ["free", "given"])
def test_path_of_a_six_bar(published, timing: str) -> None:
    places = published.position.sel(point="P").to_numpy()[2:70:5]
    rows = [[float(x), float(y)] for x, y in places]
    if timing == "given":
        rows = [
            [*row, float(z)] for row, z in zip(rows, published.drive_value.to_numpy()[2:70:5, 0], strict=True)
        ]
    best = synthesise(kind="path", point="P", targets=rows, timing=timing).answers[0]
    for path, value in PUBLISHED.items():
        assert ct.value_at(best.mechanism, path) == pytest.approx(value, rel=1e-7)
    met = ct.motion(best.mechanism, at=list(best.drive)).position.sel(point="P").to_numpy()
    # between samples the curve is a cubic: h^4/384 of a fourth derivative of some 50, with h = 2 deg
    assert np.abs(met - places).max() < 1e-6
    assert best.defects.none


def test_function_of_a_six_bar(published) -> None:
    """The lever follows the crank: every fifth place of the published motion is met."""
    angles = np.unwrap(published.angle.sel(link="lever").to_numpy())[2:70:5]
    rows = np.column_stack([published.drive_value.to_numpy()[2:70:5, 0], angles]).tolist()
    free = {**RANGES, "frame.points.F.y": [3.5, 4.6]}
    best = synthesise(kind="function", of="angle.lever", targets=rows, free=free).answers[0]
    at = ct.motion(best.mechanism, at=[row[0] for row in rows]).angle.sel(link="lever").to_numpy()
    assert np.ptp(np.unwrap(at) - angles) < 1e-8


def test_a_dwell_as_long_as_that_of_the_published_linkage(published) -> None:
    angle = np.unwrap(published.angle.sel(link="lever").to_numpy())
    drive = published.drive_value.to_numpy()[:, 0]
    half = (drive >= math.radians(110)) & (drive <= math.radians(250))
    wanted = {"of": "angle.lever", "swing": float(np.ptp(angle)), "dwell": {"range": ["110 deg", "250 deg"]}}
    free = {**RANGES, "frame.points.F.y": [3.5, 4.6]}
    best = synthesise(kind="strokes", free=free, answers=2, **wanted).answers[0]
    own = np.unwrap(ct.motion(best.mechanism, 721).angle.sel(link="lever").to_numpy())
    own_drive = np.linspace(0, 2 * math.pi, 721)
    dwell = own[(own_drive >= math.radians(110)) & (own_drive <= math.radians(250))]
    assert np.ptp(dwell) <= 1.01 * np.ptp(angle[half])
    assert np.ptp(own) == pytest.approx(np.ptp(angle), rel=2e-2)
    assert best.numbers["dwell_spread"][0] == pytest.approx(np.ptp(dwell), rel=1e-2)


@pytest.mark.parametrize(
    ("wanted", "said"),
    [
        (
            {"kind": "path", "targets": [[0, 0], [1, 0], [2, 1]], "free": {}},
            "no number of the mechanism is free",
        ),
        ({"kind": "path", "targets": [[0, 0], [1, 0], [2, 1]], "point": "X"}, 'no link has the point "X"'),
        (
            {"kind": "path", "targets": [[0, 0], [1, 0], [2, 1]], "free": {"links.X.length": [1, 2]}},
            "links.X.length",
        ),
        ({"kind": "strokes"}, "neither a stroke nor a dwell is given"),
        ({"kind": "strokes", "dwell": {"range": ["10 deg", "380 deg"]}}, "less than a turn apart"),
    ],
)
def test_refusals(wanted, said: str) -> None:
    with pytest.raises(ct.InputError) as refusal:
        synthesise(**wanted)
    assert said in str(refusal.value)


def test_what_no_mechanism_keeps_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mechanism_synthesis, "STARTS", 10)
    monkeypatch.setattr(mechanism_synthesis, "REFINED", 1)
    targets = [[4.0, 4.0], [3.0, 4.0], [1.0, 4.0]]
    with pytest.raises(ct.MotionError, match="the nearest breaks size"):
        synthesise(kind="path", targets=targets, constraints={"size": [3, 3]})


LIMITS = {"size": [12.9, 5.0], "transmission": "60 deg", "length_ratio": 1.5}


def test_slopes_of_constraints() -> None:
    """Derivatives of all that steers a search, against central differences."""
    task = SYNTHESES.from_tables(
        {
            **tables(),
            "synthesis": {
                "kind": "path", "targets": [[4.0, 4.0], [3.0, 4.1], [1.0, 4.0]], "constraints": LIMITS,
                "free": {**RANGES, "frame.points.F.y": [3.5, 4.6]},
            },
        }
    )  # fmt: skip
    search = mechanism_synthesis._MechanismSearch(task)
    own = np.array(search.moved.own)
    rows, slopes = search.steered_misses(own)
    # beside the targets: width, height, two dyads at all samples, the ratio
    assert len(rows) == 2 * 3 + 2 + 2 * mechanism_synthesis.SAMPLES + 1
    assert (rows[6:8] > 0).all() and rows[-1] > 0 and np.count_nonzero(rows[8:-1]) > 20
    for k in range(len(own)):
        step = np.zeros(len(own))
        step[k] = 1e-6
        ahead, behind = (search.steered_misses(own + sign * step)[0] for sign in (1, -1))
        there = (ahead > 0) == (behind > 0)
        difference = (ahead - behind) / 2e-6
        # a place of the curve that is nearest to a target is one of other cells there
        assert np.abs(difference - slopes[:, k])[6:][there[6:]].max() < 1e-6 * max(1.0, np.abs(slopes).max())


@pytest.mark.parametrize("name", ["size", "transmission"])
def test_constraints_steer(published, name: str) -> None:
    """What the published linkage breaks (5.90 m high, 23.1 deg) is kept, by motions and angles of one's own."""
    places = published.position.sel(point="P").to_numpy()[2:70:9]
    rows = [[float(x), float(y)] for x, y in places]
    limit = {"size": [14.0, 5.7], "transmission": "25 deg"}[name]
    found = synthesise(kind="path", point="P", targets=rows, constraints={name: limit}, answers=2)
    for answer in found.answers:
        moved = ct.motion(answer.mechanism, 1441).position
        at = {p: moved.sel(point=p).to_numpy() @ [1, 1j] for p in moved.point.to_numpy()}
        if name == "size":
            everything = np.concatenate(list(at.values()))
            # between its own 181 samples the search sees the box to some hundred thousandths
            assert np.ptp(everything.real) <= 14.0
            assert np.ptp(everything.imag) <= 5.7 * (1 + 1e-4)
        else:
            least = float(np.abs(np.angle((at["A"] - at["B"]) / (at["D"] - at["B"]))).min())
            assert least >= math.radians(25) - 1e-5
            assert answer.transmission == pytest.approx(least, abs=1e-4)
        assert answer.defects.none


def test_pivots_of_fixed_points() -> None:
    targets = [[4.0, 4.0], [3.0, 4.0], [1.0, 4.0]]
    with pytest.raises(ct.InputError, match=r"frame\.points\.F\.x"):
        synthesise(kind="path", targets=targets, constraints={"pivots": {"x": [-1, 5]}})
    with pytest.raises(ct.InputError, match="no fixed hinge lies both"):
        synthesise(kind="path", targets=targets, constraints={"pivots": {"x": [-1, 1.2]}})
    kept = synthesise(kind="path", targets=targets, answers=1, constraints={"pivots": {"x": [-1, 9.5]}})
    assert 1.5 <= kept.mechanism.frame.points["D"][0] <= 2.8


MOVED_BY = 0.7 * np.exp(2.1j), 3 - 5j


@pytest.mark.parametrize("sense", [1, -1])
def test_moved_copy_of_a_path(published, sense: int) -> None:
    """The path of the published linkage, made smaller, turned and moved, returns it but for that similarity."""
    factor, shift = MOVED_BY
    places = published.position.sel(point="P").to_numpy()[2:70:5] @ np.array([1, 1j])
    targets = (factor * places + shift)[::sense]
    rows = np.column_stack([targets.real, targets.imag]).tolist()
    best = synthesise(kind="path", point="P", targets=rows, place="free", answers=1).answers[0]
    size = float(np.abs(targets - targets.mean()).max())
    # the written answer, read again and moved: nothing of the search is left in it
    written = ct.parse_mechanism(ct.mechanism_text(best.mechanism))
    met = ct.motion(written, at=list(best.drive)).position.sel(point="P").to_numpy() @ np.array([1, 1j])
    assert float(np.sqrt(np.mean(np.abs(met - targets) ** 2))) < 1e-8 * size
    assert best.error == pytest.approx(float(np.sqrt(np.mean(np.abs(met - targets) ** 2))), abs=1e-12)
    assert best.defects.none
    for path in ("links.AB.points.B.x", "links.AB.points.P.x", "links.DB.length"):
        assert ct.value_at(written, path) == pytest.approx(0.7 * PUBLISHED[path], rel=1e-7)
    D, O = (complex(*written.frame.points[name]) for name in "DO")
    assert abs(D - O - factor * 2.0) < 1e-6 and abs(O - shift) < 1e-6
    assert ct.value_at(written, "links.OA.length") == pytest.approx(0.7, rel=1e-7)


def placed_search(**wanted: Any) -> Any:
    targets = [[4.0, 4.0], [3.0, 4.1], [1.0, 3.6], [0.2, 2.0], [1.5, 0.5], [3.5, 1.5]]
    request = {"kind": "path", "targets": targets, "free": RANGES, "place": "free", **wanted}
    return mechanism_synthesis._MechanismSearch(SYNTHESES.from_tables({**tables(), "synthesis": request}))


@pytest.mark.parametrize("closed", [True, False])
def test_slopes_with_the_place_eliminated(closed: bool) -> None:
    """Derivatives of the sum of squares, the best place included, against central differences."""
    search = placed_search(closed=closed)
    own = np.array(search.moved.own)
    rows, slopes, _drive = search.misses(own)
    assert (rows**2).sum() > 1e-4
    for k in range(len(own)):
        step = np.zeros(len(own))
        step[k] = 1e-5
        ahead, behind = ((search.misses(own + sign * step)[0] ** 2).sum() for sign in (1, -1))
        wanted = 2 * slopes[:, k] @ rows
        assert (ahead - behind) / 2e-5 == pytest.approx(wanted, rel=1e-5, abs=1e-7)


def test_place_is_the_best_one() -> None:
    """No similarity near the one that was found brings the curve closer, place by place along it."""
    fine = np.linspace(0, 2 * np.pi, 20001)
    curve = ct.motion(ct.Mechanism(**tables()), at=list(fine)).position.sel(point="P").to_numpy() @ [1, 1j]
    factor, shift = MOVED_BY
    noise = np.random.default_rng(3).normal(0, 0.02, (12, 2)) @ [1, 1j]
    targets = factor * (curve[1000:19000:1500] + noise) + shift
    search = placed_search(targets=np.column_stack([targets.real, targets.imag]).tolist(), closed=True)
    values = search.moved.split(np.asarray(search.moved.outputs(search.moved.own)))
    placed = search.goal.place(search.moved, values)

    def cost(factor: complex, shift: complex) -> float:
        distance = np.abs(factor * curve[None] + shift - targets[:, None])
        return float((distance.min(axis=1) ** 2).sum())

    at = placed.similarity
    assert abs(at.factor - factor) < 0.05
    best = cost(at.factor, at.shift)
    # 20001 places lie up to 4e-4 m from the nearest one
    assert best == pytest.approx(float((np.abs(placed.misses) ** 2).sum()), rel=2e-4)
    for change in (1e-3, -1e-3, 1e-3j, -1e-3j):
        assert cost(at.factor * (1 + change), at.shift - at.factor * change * curve.mean()) > best
        assert cost(at.factor, at.shift + change) > best


def test_place_stands_as_it_is_unless_it_is_free() -> None:
    assert not SYNTHESES.from_tables(
        {**tables(), "synthesis": {"kind": "path", "targets": [[0, 0], [1, 0], [2, 1]]}}
    ).synthesis.has_free_place
    with pytest.raises(ct.InputError, match="the zero of the drive turns"):
        placed_search(timing="given", targets=[[0, 0, 0], [1, 0, 1], [2, 1, 2]])
    loaded = {**tables(), "loads": [{"kind": "force", "point": "P", "vector": [1, 0]}]}
    request = {"kind": "path", "targets": [[0, 0], [1, 0], [2, 1]], "free": RANGES, "place": "free"}
    with pytest.raises(ct.InputError, match="loads cannot be moved"):
        ct.synthesise({**loaded, "synthesis": request})
