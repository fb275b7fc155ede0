"""Groups of higher class over many turns: what a closed curve repeats is what following it on would find."""

from __future__ import annotations

from math import acos, atan2, hypot, inf, tau
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.kinematics import change_points
from centrode.kinematics.higher_class import curve_continuation
from centrode.kinematics.higher_class.curve_continuation import CurveTracks
from centrode.kinematics.higher_class.newton import SMALL
from centrode.kinematics.path import Path
from mechanisms import EPS, OPERATIONS, Parts, events, parts_of, statuses
from redriven import answer
from samples import few

NUMBERS = ("position", "velocity", "acceleration", "angle", "status")


def triad() -> Parts:
    parts = parts_of(ct.example("third-class-triad"))
    parts.pop("study", None)
    return parts


def geared(ratio: float) -> Parts:
    """The triad, its crank turned by a gear."""
    parts = triad()
    parts["frame"]["points"]["M"] = [8.0, 3.0]
    parts["links"]["motor"] = {"points": {"M": [0.0, 0.0]}}
    parts["links"]["OA"]["angle"] = 0.0
    return {
        **parts,
        "gears": [{"links": ["motor", "OA"], "ratio": ratio}],
        "drives": [{"link": "motor", "start": 0.0, "speed": 1.0}],
    }


def crank_angle(parallel: float) -> float:
    """Angle of FR where the cranks of the parallelogram stand at an angle, R to the left of F -> P, by cosines."""
    x, y = 2.0 + np.cos(parallel) - 2.2, 1.5 + np.sin(parallel) - 1.6
    away = hypot(x, y)
    return atan2(y, x) + acos((1.3**2 + away**2 - 0.9**2) / (2.0 * 1.3 * away))


def parallelogram(longer: float = 0.0, continuation: str = "smooth") -> Parts:
    """A parallelogram whose coupler point P runs round with the crank FR, which drives all of it."""
    at = crank_angle(0.7)
    there, point = (2.2 + 1.3 * np.cos(at), 1.6 + 1.3 * np.sin(at)), (2.0 + np.cos(0.7), 1.5 + np.sin(0.7))
    return {
        "frame": {"points": {"O": [0.0, 0.0], "D": [4.0, 0.0], "F": [2.2, 1.6]}},
        "links": {
            "FR": {"length": 1.3},
            "OA": {"length": 1.0, "angle": 0.7},
            "coupler": {"points": {"A": [0.0, 0.0], "B": [4.0 + longer, 0.0], "P": [2.0, 1.5]}, "angle": 0.0},
            "DB": {"length": 1.0, "angle": 0.7},
            "PR": {"length": 0.9, "angle": atan2(there[1] - point[1], there[0] - point[0])},
        },
        "drives": [{"link": "FR", "start": at, "speed": 1.0}],
        "assembly": {"continuation": continuation},
    }


def geared_behind() -> Parts:
    """A wheel turned one and a half times as fast by a link of the group, which turns fully."""
    parts = parallelogram()
    parts["frame"]["points"]["W"] = [-1.0, 0.0]
    parts["links"]["wheel"] = {"points": {"W": [0.0, 0.0]}, "angle": 0.0}
    return {**parts, "gears": [{"links": ["OA", "wheel"], "ratio": -1.5}]}


def on_sphere() -> Parts:
    """A spherical six-bar driven at its second crank, which runs round with the first; initial angles by dyads."""
    arcs: Parts = {
        "AB": {"length": 0.4, "reference": ["A", "D"]},
        "BCE": {"points": {"B": [0.0, 0.0], "C": [1.0, 0.0], "E": [0.05, 0.05]}, "reference": ["B", "A"]},
        "DC": {"length": 0.8, "reference": ["D", "A"]},
        "EF": {"length": 0.45, "reference": ["E", "B"]},
        "GF": {"length": 0.5, "reference": ["G", "A"]},
    }
    parts: Parts = {
        "space": "sphere",
        "frame": {"points": {"A": [0.0, 0.0], "D": [1.1, 0.0], "G": [0.05, 0.05]}},
    }
    drives = [{"link": "AB", "start": 0.5, "speed": 1.0}]
    dyads = ct.Mechanism(**parts, links=arcs, drives=drives, assembly={"sides": {"C": "left", "F": "right"}})
    angles = ct.motion(dyads, samples=1).joint_angle[0]
    links = {name: {**arc, "angle": float(angles.sel(joint=name))} for name, arc in arcs.items()}
    start = links["GF"].pop("angle")
    return {**parts, "links": links, "drives": [{"link": "GF", "start": start, "speed": 1.0}]}


def locking() -> Parts:
    """A crank too long for a full turn."""
    parts = triad()
    parts["links"]["OA"]["length"] = 0.7
    return parts


CASES: dict[str, tuple[Parts, float]] = {
    "triad": (triad(), 1.0),
    "fourth class": (parts_of(ct.example("fourth-class-group")), 1.0),
    "gear, two turns": (geared(0.5), 2.0),
    "gear, three turns": (geared(-2.0 / 3.0), 3.0),
    "gear, never": (geared(2.0**-0.5), inf),
    "gear, nearly": (geared(1.0 + 100.0 * SMALL), inf),
    "change points": (parallelogram(), 1.0),
    "wheel behind": (geared_behind(), 1.0),
    "sphere": (on_sphere(), 1.0),
    "change points kept": (parallelogram(continuation="keep"), inf),
    "near miss": (parallelogram(longer=-1e-4), inf),
    "locking": (locking(), inf),
}


@pytest.fixture(
    params=few(
        ("triad", "gear, two turns", "gear, nearly", "wheel behind", "sphere", "near miss", "locking"),
        tuple(CASES),
    )
)
def case(request: pytest.FixtureRequest) -> tuple[ct.Mechanism, float]:
    parts, period = CASES[request.param]
    return ct.Mechanism(**{key: value for key, value in parts.items() if key != "study"}), period


@pytest.fixture
def traced(monkeypatch: pytest.MonkeyPatch) -> list[CurveTracks]:
    """The tracks of all groups that are followed."""
    found: list[CurveTracks] = []

    def noted(*asked: Any) -> Any:
        tracks, events = curve_continuation.trace(*asked)
        found.append(tracks)
        return tracks, events

    monkeypatch.setattr(change_points, "trace", noted)
    return found


def start_of(mechanism: ct.Mechanism) -> float:
    return float(mechanism.drives[0].start or 0.0)


def test_after_how_many_turns_it_closes(case: tuple[ct.Mechanism, float], traced: list[CurveTracks]) -> None:
    mechanism, period = case
    start, beyond = start_of(mechanism), ((period if period < inf else 2.0) + 0.1) * tau
    ct.motion(mechanism, at=[start - beyond, start + beyond])
    assert np.array_equal(traced[0].period, [[period * tau, period * tau]])


@pytest.mark.parametrize(
    ("name", "low", "high"),
    few(
        [("gear, two turns", 0.0, 2.2), ("change points", -0.4, 1.7)],
        [
            ("triad", -1.5, 4.0),
            ("gear, two turns", 0.0, 2.8),
            ("change points", -0.4, 1.7),
            ("wheel behind", -1.3, 0.0),
        ],
    ),
)
def test_it_is_as_if_followed_on(name: str, low: float, high: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same statuses; numbers as two ways to start Newton's method agree, events as well as they are found."""
    mechanism = ct.Mechanism(**CASES[name][0])
    values = start_of(mechanism) + tau * np.linspace(low, high, 9)
    found = ct.motion(mechanism, at=values)
    monkeypatch.setattr(Path, "turns", False)  # now groups are followed over their whole range
    other = ct.motion(mechanism, at=values)
    assert statuses(found) == statuses(other) == ["ok"] * len(values)
    angle = "angle" if "angle" in found else "joint_angle"
    scale = float(max(np.abs(other[name]).max() for name in ("position", angle)))
    if events(found, "change point"):
        # interpolated next to them, to the errors that conventions promise there
        allowed = np.outer([1e-11, 1e-9, 1e-8], np.full(len(values), scale))
    else:
        allowed = 2.0 * OPERATIONS * EPS * answer(mechanism, values) * scale
    for number, order in (("position", 0), (angle, 0), ("velocity", 1), ("acceleration", 2)):
        gap = np.abs((found[number] - other[number]).to_numpy()).reshape(len(values), -1).max(axis=1)
        assert np.all(gap <= allowed[order]), number
    assert float(found.residual.max()) <= 1e-12
    for kind in ("limit", "change point"):
        one, two = sorted(events(found, kind)), sorted(events(other, kind))
        assert one == pytest.approx(two, abs=1e-10)


@pytest.mark.parametrize("name", few(["gear, two turns"], ["triad", "gear, two turns"]))
def test_started_turns_later_it_moves_alike(name: str) -> None:
    """The same links with a drive that starts ten turns further on: there nothing has been repeated."""
    mechanism = ct.Mechanism(**CASES[name][0])
    drive = mechanism.drives[0].model_dump(exclude_unset=True)
    later = ct.Mechanism(**{**CASES[name][0], "drives": [{**drive, "start": start_of(mechanism) + 10 * tau}]})
    values = start_of(mechanism) + 10 * tau + np.array([0.3, 2.2, 5.9])
    found, other = ct.motion(mechanism, at=values), ct.motion(later, at=values)
    first = answer(later, values)[0]
    # the start itself is rounded to a unit of the greater turn
    allowed = (2.0 * OPERATIONS * EPS + 2.0 * np.spacing(12 * tau)) * first * 10.0
    assert np.all(np.abs(found.position - other.position).max(dim=("point", "axis")).to_numpy() <= allowed)
    grown = (found.angle - other.angle).to_numpy() / tau
    assert np.all(np.abs(grown - np.round(grown)).max(axis=1) <= allowed)


def test_angles_run_on_and_so_does_what_they_turn() -> None:
    mechanism = ct.Mechanism(**geared_behind())
    start = start_of(mechanism)
    first, last = ct.motion(mechanism, at=[start + 1.0]), ct.motion(mechanism, at=[start + 1.0 + 7 * tau])
    grown = (last.angle - first.angle)[0]
    for link, turns in (("OA", 7.0), ("DB", 7.0), ("coupler", 0.0), ("wheel", -10.5)):
        assert float(grown.sel(link=link)) == pytest.approx(turns * tau, abs=1024 * EPS * 11 * tau), link


def test_change_points_are_told_for_every_turn() -> None:
    """Two a turn, where the parallelogram lies flat, by cosines."""
    mechanism = ct.Mechanism(**parallelogram())
    start = start_of(mechanism)
    found = np.array(
        sorted(events(ct.motion(mechanism, at=[start - 2 * tau, start + 2 * tau]), "change point"))
    )
    flat = [crank_angle(0.0), crank_angle(np.pi)]
    each = [start + (value - start) % tau + turn * tau for value in flat for turn in range(-2, 2)]
    # the saddle of the worst equation is found to the root of what its value is flat to
    assert found == pytest.approx(sorted(each), abs=1e-10)


@pytest.mark.parametrize("name", ["triad", "change points"])
def test_a_result_belongs_to_its_value_alone(name: str) -> None:
    """At the end of a round, just behind it, and turns later: whatever else is asked for."""
    mechanism, period = ct.Mechanism(**CASES[name][0]), CASES[name][1]
    end = start_of(mechanism) + period * tau
    values = [end - 0.3, end, np.nextafter(end, inf), end + 0.05, end + 0.2, end + 1.3 * tau]
    together = ct.motion(mechanism, at=[*values, start_of(mechanism) - 1.2 * tau])
    for k in few((2, 5), range(6)):
        value = values[k]
        alone = ct.motion(mechanism, at=[value])
        for number in NUMBERS:
            assert np.array_equal(alone[number][0], together[number][k], equal_nan=True), (number, value)


def test_each_mechanism_of_a_batch_closes_for_itself(traced: list[CurveTracks]) -> None:
    mechanism = ct.Mechanism(**triad())
    lengths = np.array([0.9, 0.3, 0.5])
    values = np.array([1.0, tau + 1.0, 3.5 * tau])
    batch = ct.motion(mechanism, at=values, vary={"links.OA.length": lengths})
    assert np.array_equal(np.isfinite(traced[0].period[:, 1]), [False, True, True])
    for lane, length in enumerate(lengths):
        alone = ct.motion(mechanism, at=values, vary={"links.OA.length": [length]})
        for number in NUMBERS:
            assert np.array_equal(alone[number][0], batch[number][lane], equal_nan=True), (number, length)


def test_many_turns_are_followed_no_further_than_one(traced: list[CurveTracks]) -> None:
    mechanism = ct.Mechanism(**triad())
    ct.motion(mechanism, at=[1.5 * tau])
    ct.motion(mechanism, at=[160 * tau])
    assert np.array_equal(traced[0].powers, traced[1].powers)
