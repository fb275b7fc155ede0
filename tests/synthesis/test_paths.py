"""Paths of the literature against their published errors; answers followed by a continuation of their own."""

from __future__ import annotations

import functools
import math
from pathlib import Path

import numpy as np
import pytest
from tools.campaigns.synthesis.coupler_continuation import walk

import centrode as ct
from centrode.synthesis import four_bars, path_synthesis, start_candidates
from centrode.synthesis.cognates import cognates
from centrode.synthesis.requests import SYNTHESES

PATHS = Path(__file__).parent.parent / "reference" / "paths"


def request(lines: str, constraints: str = "") -> ct.SynthesisTask:
    text = f'[synthesis]\ntopology = "crank-rocker"\nkind = "path"\n{lines}\n[synthesis.constraints]\n{constraints}'
    return SYNTHESES.parse(text, "path.toml", PATHS)


def rows(name: str) -> np.ndarray:
    table = np.loadtxt(PATHS / f"{name}.csv", delimiter=",", skiprows=1)
    return table[:, 0] + 1j * table[:, 1]


def check_ordered(answer, targets) -> None:
    """What an ordered answer promises, by a continuation that shares no code with the package."""
    walked = walk(answer.mechanism, answer.drive)
    assert walked.ordered and walked.one_branch and walked.closes
    distance = np.abs(np.array(walked.places["P"]) - targets)
    assert distance.max() == pytest.approx(answer.greatest, rel=1e-6, abs=1e-12)
    assert (distance**2).sum() == pytest.approx(answer.sum_of_squares, rel=1e-6, abs=1e-20)


@pytest.mark.parametrize(
    ("name", "published", "reached"),
    # sums of squares: of the published linkage, and of the best that is known with a full crank and the order kept
    [("mcgarva", 103.5, 2.839), ("yu1", 3.430, 0.8543), ("mkh2", 1.494e-4, 7.609e-5)],
)
def test_published_paths(name: str, published: float, reached: float) -> None:
    found = ct.synthesise(request(f'targets = "{name}.csv"', 'crank = "OA"'))
    best = found.answers[0]
    assert best.sum_of_squares <= 1.01 * reached < published
    targets = rows(name)
    for answer in found.answers:
        check_ordered(answer, targets)
        assert answer.defects.none
        assert (ct.motion(answer.mechanism, 721).status == int(ct.Status.OK)).all()
        assert answer.error >= best.error * (1 - 1e-9)


def test_timed_path() -> None:
    """The 18-point case with 20 deg of the crank from point to point, phase and place free."""
    targets = rows("mkh1")
    table = [[z.real, z.imag, f"{20 * k} deg"] for k, z in enumerate(targets)]
    wanted = {"topology": "crank-rocker", "kind": "path", "targets": table, "timing": "phase"}
    found = ct.synthesise({"synthesis": {**wanted, "constraints": {"crank": "OA"}}})
    best = found.answers[0]
    assert best.sum_of_squares <= 1.01 * 9.0289e-3
    assert np.degrees(np.diff(best.drive)) == pytest.approx(20, abs=1e-9)
    check_ordered(best, targets)


FIVE = [[3, 3], [2.759, 3.363], [2.372, 3.663], [1.890, 3.862], [1.355, 3.943]]


@pytest.mark.parametrize(("timing", "reached"), [("given", 7.416e-7), ("phase", 4.085e-7)])
def test_five_points_with_a_given_pivot(timing: str, reached: float) -> None:
    """Crank angles 30 to 90 deg, the pivot in the origin, the frame along x."""
    table = [[*place, f"{30 + 15 * k} deg"] for k, place in enumerate(FIVE)]
    free = {
        "frame.points.D.x": [-10, 10],
        "links.OA.length": [0.05, 10],
        "links.AB.length": [0.05, 10],
        "links.DB.length": [0.05, 10],
        "links.AB.points.P.x": [-10, 10],
        "links.AB.points.P.y": [-10, 10],
    }
    wanted = {
        "topology": "crank-rocker", "kind": "path", "targets": table, "timing": timing, "place": "given", "free": free,
    }  # fmt: skip
    best = ct.synthesise({"synthesis": wanted}).answers[0]
    assert best.sum_of_squares <= 1.01 * reached
    assert tuple(best.mechanism.frame.points["O"])[:2] == pytest.approx((0, 0), abs=1e-12)
    assert best.mechanism.frame.points["D"][1] == pytest.approx(0, abs=1e-12)
    check_ordered(best, np.array([complex(*place) for place in FIVE]))


def test_constraints_are_kept(monkeypatch) -> None:
    """Transmission, lengths, places of hinges and the box, each read off the description by itself."""
    limits = (
        'crank = "OA"\ntransmission = "40 deg"\nlength_ratio = 6\npivots = { x = [-60, 60], y = [-60, 60] }\n'
        "size = [125, 100]"
    )
    few = functools.partial(start_candidates.closed_candidates, count=100)
    monkeypatch.setattr(path_synthesis, "closed_candidates", few)
    found = ct.synthesise(request('targets = "yu1.csv"', limits))
    for answer in found.answers:
        mechanism = answer.mechanism
        assert answer.transmission >= math.radians(40) - 1e-9
        places = ct.motion(mechanism, 1441).position
        coupler, rocker = (
            (places.sel(point="B") - other).to_numpy() @ (1, 1j)
            for other in (places.sel(point="A"), np.array(mechanism.frame.points["D"][:2]))
        )
        between = np.abs(np.angle(coupler / rocker))
        least = float(np.minimum(between, math.pi - between).min())
        assert least == pytest.approx(answer.transmission, abs=1e-4)
        o, d = (np.array(mechanism.frame.points[name][:2]) for name in ("O", "D"))
        links = [
            math.dist(*list(mechanism.links[name].coordinates.values())[:2]) for name in ("OA", "AB", "DB")
        ]
        lengths = [math.dist(o, d), *links]
        assert max(lengths) <= 6 * min(lengths) * (1 + 1e-6)
        assert np.abs([o, d]).max() <= 60 + 1e-9
        size = np.ptp(np.concatenate([places.to_numpy().reshape(-1, 2), [o, d]]), axis=0)
        assert (size <= np.array([125, 100]) * (1 + 5e-3)).all()
        check_ordered(answer, rows("yu1"))


def test_open_path_of_a_known_linkage_is_met() -> None:
    linkage = np.array([[0.3, 0.2, 2.8, 0.5, 1.0, 2.4, 2.1, 1.1, 0.8]])
    crank = np.linspace(0.4, 2.6, 12)
    path = four_bars.coupler_motion(linkage, crank, np.ones(1)).point[0]
    table = [[float(z.real), float(z.imag)] for z in path]
    wanted = {"topology": "crank-rocker", "kind": "path", "targets": table, "closed": False}
    found = ct.synthesise({"synthesis": {**wanted, "constraints": {"crank": "OA"}}})
    best = found.answers[0]
    assert not found.closed
    # an arc leaves little to tell curves apart by: near is as much as a hundred thousandth of its size
    assert best.error < 1e-5 * np.abs(path - path.mean()).max()
    check_ordered(best, path)


def random_crank_rockers(seed: int, count: int):
    """Crank-rockers with a closed path of some 40 points: (description row, points)."""
    random = np.random.default_rng(seed)
    while count:
        excess = random.uniform(0.15, 1.5, 3)
        ground, coupler, rocker = 1 + excess.sum() - excess
        row = np.array([0, 0, ground, 0, 1, coupler, rocker, *random.uniform(-2.5, 2.5, 2)])
        crank = np.linspace(0, 2 * np.pi, 40, endpoint=False)
        path = four_bars.coupler_motion(row[None], crank, np.ones(1)).point[0]
        count -= 1
        yield (
            row,
            path * np.exp(1j * random.uniform(0, 6)) * random.uniform(0.2, 5)
            + complex(*random.uniform(-9, 9, 2)),
        )


def test_paths_of_random_crank_rockers_are_recovered() -> None:
    """To rounding: what is sought is there."""
    for _row, path in random_crank_rockers(7, 1):
        table = [[float(z.real), float(z.imag)] for z in path]
        wanted = {
            "topology": "crank-rocker",
            "kind": "path",
            "targets": table,
            "constraints": {"crank": "OA"},
        }
        best = ct.synthesise({"synthesis": wanted}).answers[0]
        assert best.error < 1e-9 * np.abs(path - path.mean()).max()


def test_cognates_draw_the_same_curve() -> None:
    linkage = np.array([0.1, 0.2, 4.0, 0.5, 1.0, 3.5, 3.0, 1.2, 0.9])
    for side in (1.0, -1.0):
        for crank in np.linspace(0, 2 * np.pi, 13):
            place = four_bars.coupler_motion(linkage[None], np.array([crank]), np.array([side])).point[0, 0]
            first = cognates(linkage, side, 0.0)
            for (row, its_side, start), (same, _side, _start) in zip(
                cognates(linkage, side, crank), first, strict=True
            ):
                drawn = four_bars.coupler_motion(row[None], np.array([start]), np.array([its_side])).point[
                    0, 0
                ]
                assert drawn == pytest.approx(place, abs=1e-12)
                assert row == pytest.approx(same, abs=1e-12)


def test_derivatives_against_differences() -> None:
    random = np.random.default_rng(3)
    linkages = np.array([0, 0, 3.2, 0.1, 1, 2.9, 2.3, 0.8, 0.7]) + random.normal(0, 0.1, (4, 9))
    side = np.array([1.0, -1.0, 1.0, -1.0])
    crank = random.uniform(0, 6, (4, 3))
    slopes = four_bars.coupler_slopes(linkages, crank, four_bars.coupler_motion(linkages, crank, side))
    step = 1e-6
    for k in range(9):
        ahead, behind = (
            four_bars.coupler_motion(linkages + sign * step * np.eye(9)[k], crank, side) for sign in (1, -1)
        )
        assert slopes.point[..., k] == pytest.approx((ahead.point - behind.point) / (2 * step), abs=1e-7)
        turn = np.angle(ahead.direction / behind.direction) / (2 * step)
        assert slopes.angle[..., k] == pytest.approx(turn, abs=1e-7)


def test_same_request_gives_the_same_answers_and_stops_when_it_is_stopped() -> None:
    task = request('targets = "yu1.csv"\nanswers = 2', 'crank = "OA"')
    first, second = (ct.synthesise(task, stop=Stop(90)) for _time in range(2))
    assert not first.complete
    assert [one.sum_of_squares for one in first.answers] == [one.sum_of_squares for one in second.answers]
    assert ct.mechanism_text(first.mechanism) == ct.mechanism_text(second.mechanism)


class Stop:
    """True once it has been called so often."""

    def __init__(self, most: int) -> None:
        self.left = most

    def __call__(self) -> bool:
        self.left -= 1
        return self.left < 0


def test_trade_off_is_a_front(monkeypatch) -> None:
    """No answer is better than another in both its error and its transmission angle; the best error stays."""
    few = functools.partial(start_candidates.closed_candidates, count=60)
    monkeypatch.setattr(path_synthesis, "closed_candidates", few)
    monkeypatch.setattr(path_synthesis, "TRADES", 2)
    found = ct.synthesise(request('targets = "yu1.csv"\ntrade_off = "transmission"', 'crank = "OA"'))
    errors = [one.error for one in found.answers]
    angles = [one.transmission for one in found.answers]
    assert len(errors) > 1
    assert errors == sorted(errors) and angles == sorted(angles)
    check_ordered(found.answers[-1], rows("yu1"))


def test_what_excludes_everything_is_named(monkeypatch) -> None:
    few = functools.partial(start_candidates.closed_candidates, count=6)
    monkeypatch.setattr(path_synthesis, "closed_candidates", few)
    limits = 'crank = "OA"\ntransmission = "80 deg"\nlength_ratio = 1.1'
    with pytest.raises(ct.MotionError, match="without it the nearest misses the targets by") as failure:
        ct.synthesise(request('targets = "yu1.csv"', limits))
    named = failure.value.where.split()[-1]
    assert named in ("transmission", "length_ratio", "crank")


def test_a_box_is_certain() -> None:
    """What the search takes the box for is near, and what is said of an answer is certain to a millionth."""
    random = np.random.default_rng(2)
    excess = random.uniform(0.15, 1.5, (40, 3))
    ground, coupler, rocker = (1 + excess.sum(axis=1) - excess[:, k] for k in range(3))
    zero = np.zeros(40)
    linkages = np.column_stack(
        [zero, zero, ground, zero, zero + 1, coupler, rocker, *random.uniform(-2.5, 2.5, (2, 40))]
    )
    side = np.ones(40)
    fine = path_synthesis.box_of(linkages, side, 7200)
    assert (np.abs(path_synthesis.box_of(linkages, side) / fine - 1) < 1e-2).all()
    for row, box in zip(linkages, fine, strict=True):
        assert path_synthesis.is_within(row, 1.0, tuple(box * (1 + 1e-6)))
        assert not path_synthesis.is_within(row, 1.0, (box[0] * (1 - 1e-6), box[1]))
