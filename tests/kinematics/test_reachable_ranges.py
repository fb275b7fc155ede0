"""The reachable range: between the limits about the initial position, without limits one turn."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.model.schema import mechanism_schema
from mechanisms import EPS

A, B, C, D = 1.0, 3.5, 3.0, 4.0


def rocker_driven(start: float, speed: float = 1.0, side: str = "left", **study: Any) -> ct.Mechanism:
    return ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [D, 0]}},
        links={"OA": {"length": A}, "AB": {"length": B}, "DB": {"length": C}},
        drives=[{"link": "DB", "start": start, "speed": speed}],
        assembly={"sides": {"A": side}},
        study={"range": "reachable", **study},
    )


def ends_of_rocker() -> tuple[float, float]:
    """Crank and coupler in line: triangles with the sides b -+ a, c, d."""
    low, high = (math.pi - math.acos((D**2 + C**2 - way**2) / (2 * C * D)) for way in (B + A, B - A))
    return low, high


def inside(low: float, high: float) -> np.ndarray:
    margin = 0.005 * (high - low)
    return np.array([low + margin, high - margin])


def first_and_last(mechanism: ct.Mechanism) -> np.ndarray:
    data = ct.motion(mechanism, samples=361)
    assert (data.status == ct.Status.OK).all()
    return data.drive_value.values[[0, -1], 0]


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("start", [1.78, 2.0, 2.46, 2.0 + math.tau])
def test_a_rocker_swings_between_its_limits_wherever_it_starts(start: float, side: str) -> None:
    turn = math.tau * (start > math.pi)
    exact = inside(*ends_of_rocker()) + turn
    assert first_and_last(rocker_driven(start, side=side)) == pytest.approx(exact, abs=64 * EPS)
    backwards = rocker_driven(start, -2.0, side)
    assert first_and_last(backwards) == pytest.approx(exact[::-1], abs=64 * EPS)


def test_a_rocker_on_the_sphere() -> None:
    """C runs on a great circle through A; it stops where the arcs of crank and coupler are collinear."""
    sphere = ct.Mechanism(
        space="sphere",
        frame={"points": {"A": [1, 0, 0], "D": [0, 1, 0], "Z": [0, 0, 1]}},
        links={
            "AB": {"length": 0.3},
            "BC": {"length": 0.8},
            "DC": {"length": math.pi / 2, "reference": ["D", "Z"]},
        },
        drives=[{"link": "DC", "start": 0.8, "speed": 1.0}],
        assembly={"sides": {"B": "left"}},
        study={"range": "reachable"},
    )
    # at the arc pi/2 - psi from A: BC - AB to BC + AB
    exact = inside(math.pi / 2 - 1.1, math.pi / 2 - 0.5)
    assert first_and_last(sphere) == pytest.approx(exact, abs=64 * EPS)


def test_a_crank_without_limits_makes_one_turn() -> None:
    for name in ("crank-rocker", "galloway", "spherical-four-bar"):
        mechanism = ct.example(name).with_range("reachable")
        first, last = first_and_last(mechanism)
        assert last - first == pytest.approx(math.tau, abs=4 * EPS * math.tau)


def test_ends_that_are_given_go_before_the_word() -> None:
    _low, high = inside(*ends_of_rocker())
    data = ct.motion(rocker_driven(2.0), samples=3, start=2.1)
    assert data.drive_value.values[[0, -1], 0] == pytest.approx([2.1, high], abs=64 * EPS)
    assert ct.motion(rocker_driven(2.0), samples=3, start=1.9, stop=2.1).drive_value.values[1, 0] == 2.0


def test_the_word_is_read_and_written_back() -> None:
    mechanism = rocker_driven(2.0)
    text = ct.mechanism_text(mechanism)
    assert 'range = "reachable"' in text
    assert ct.parse_mechanism(text) == mechanism
    assert mechanism_schema()["$defs"]["Study"]["properties"]["range"]["enum"] == ["reachable"]
    own = rocker_driven(2.0).model_copy(update={"study": ct.Study(start=1.9, stop=2.0, samples=7)})
    other = own.with_range("reachable")
    assert (other.study.range, other.study.start, other.study.samples) == ("reachable", None, 7)
    assert other.with_range(None) is other


@pytest.mark.parametrize(
    ("study", "told"),
    [
        ({"range": "reachable", "start": 1.0}, "range, start are given together; keep one of them"),
        ({"range": "all"}, 'range: expected one of "reachable", got "all"'),
    ],
)
def test_words_that_do_not_fit_are_refused(study: dict[str, Any], told: str) -> None:
    with pytest.raises(ct.InputError) as refused:
        ct.Mechanism(
            frame={"points": {"O": [0, 0]}},
            links={"OA": {"length": 1}},
            drives=[{"link": "OA", "speed": 1}],
            study=study,
        )
    assert told in str(refused.value)


def test_a_range_of_time_has_no_reachable_values() -> None:
    mechanism = ct.example("five-bar-two-drives").with_range("reachable")
    with pytest.raises(ct.InputError, match=r"\[study\] range: the reachable range is defined for one drive"):
        ct.motion(mechanism)
    assert ct.motion(mechanism, samples=3, start=0.0, stop=0.1).sizes["sample"] == 3
