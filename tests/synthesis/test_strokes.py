"""Strokes: limit positions found by own geometry, without the closed forms of the package."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

import centrode as ct


def one(**wanted):
    return ct.synthesise({"synthesis": {"kind": "strokes", **wanted}}).answers


def limits_of(place, start: float = 0.0123):
    """Ends of a periodic motion and the angle of the crank between them, by sampling and golden sections."""
    angles = start + np.linspace(0, 2 * math.pi, 3601)
    values = np.array([place(angle) for angle in angles])
    ends = []
    for sign in (1, -1):
        k = int(np.argmax(sign * values))
        low, high = angles[k] - 2e-3, angles[k] + 2e-3
        for _round in range(80):
            first, second = low + 0.382 * (high - low), low + 0.618 * (high - low)
            if sign * place(first) > sign * place(second):
                high = second
            else:
                low = first
        ends.append((low + high) / 2)
    between = (ends[1] - ends[0]) % (2 * math.pi)
    slow = max(between, 2 * math.pi - between)
    return abs(place(ends[0]) - place(ends[1])), slow / (2 * math.pi - slow)


@pytest.mark.parametrize(("ratio", "transmission"), [(1.2, None), (1.2, 40.0), (1.0, 70.0), (1.35, None)])
def test_slider_crank(ratio: float, transmission: float | None) -> None:
    wanted = {} if transmission is None else {"transmission": f"{transmission} deg"}
    (answer,) = one(topology="slider-crank-offset", stroke="0.2 m", time_ratio=ratio, **wanted)
    a, b = (math.dist(*answer.mechanism.links[name].coordinates.values()) for name in ("OA", "AB"))
    e = answer.mechanism.guides[0].through[1]

    def place(angle: float) -> float:
        return a * math.cos(angle) + math.sqrt(b * b - (e - a * math.sin(angle)) ** 2)

    stroke, found = limits_of(place)
    assert stroke == pytest.approx(0.2, abs=1e-12)
    assert found == pytest.approx(ratio, abs=1e-6)
    angles = np.linspace(0, 2 * math.pi, 7201)
    least = np.arccos(np.abs((e - a * np.sin(angles)) / b)).min()
    assert answer.transmission == pytest.approx(least, abs=1e-6)
    if transmission is not None:
        assert math.degrees(least) == pytest.approx(transmission, abs=1e-6)


@pytest.mark.parametrize(("swing", "ratio"), [(40.0, 1.25), (60.0, 1.1), (40.0, 1.0), (75.0, 1.3)])
def test_crank_rocker(swing: float, ratio: float) -> None:
    for answer in one(topology="crank-rocker", swing=f"{swing} deg", time_ratio=ratio):
        mechanism = answer.mechanism
        a, b, c = (math.dist(*mechanism.links[name].coordinates.values()) for name in ("OA", "AB", "DB"))
        fixed = complex(*mechanism.frame.points["O"][:2])
        sign = 1 if mechanism.assembly.sides["B"] == "left" else -1

        def place(angle: float, a=a, b=b, c=c, fixed=fixed, sign=sign) -> float:
            joint = fixed + a * cmath.exp(1j * angle)
            corner = math.acos((abs(joint) ** 2 + b * b - c * c) / (2 * b * abs(joint)))
            end = joint + b * cmath.exp(1j * (cmath.phase(-joint) + sign * corner))
            return cmath.phase(end / 1j)

        turned, found = limits_of(place)
        assert math.degrees(turned) == pytest.approx(swing, abs=1e-9)
        assert found == pytest.approx(ratio, abs=1e-6)
        least = min(
            math.acos(abs(b * b + c * c - abs(fixed + a * cmath.exp(1j * t)) ** 2) / (2 * b * c))
            for t in np.linspace(0, 2 * math.pi, 7201)
        )
        assert answer.transmission == pytest.approx(least, abs=1e-6)


@pytest.mark.parametrize(
    ("topology", "wanted"),
    [
        ("shaper", {"time_ratio": 1.6}),
        ("whitworth-quick-return", {"time_ratio": 1.8, "transmission": "65 deg"}),
        ("six-bar-press", {"time_ratio": 1.1, "guide": "K"}),
    ],
)
def test_six_bars_move_their_slider_as_wanted(topology: str, wanted: dict) -> None:
    answers = one(topology=topology, stroke="0.5 m", answers=2, **wanted)
    for answer in answers:
        data = ct.motion(answer.mechanism, 3601)
        assert (data.status == int(ct.Status.OK)).all()
        slide = data.slide.to_numpy()[:, data.guide.to_numpy().tolist().index(wanted.get("guide", "E"))]
        assert np.ptp(slide) == pytest.approx(0.5, abs=1e-4)
        away = (int(np.argmax(slide)) - int(np.argmin(slide))) % 3600
        slow = max(away, 3600 - away)
        # limit positions are flat: the place of the greatest sample is good to a sample on either side
        assert slow / (3600 - slow) == pytest.approx(wanted["time_ratio"], abs=4e-3)
        assert answer.numbers["time_ratio"][0] == pytest.approx(wanted["time_ratio"], abs=1e-9)
        assert answer.numbers["stroke"][0] == pytest.approx(0.5, abs=1e-12)


def test_too_good_a_transmission_names_the_greatest_possible_one() -> None:
    with pytest.raises(ct.MotionError, match=r"at most 47\.2 deg is possible"):
        one(topology="slider-crank-offset", stroke="0.2 m", time_ratio=1.2, transmission="70 deg")
    with pytest.raises(ct.InputError, match="above 1"):
        one(topology="shaper", stroke="0.2 m", time_ratio=1)


@pytest.mark.parametrize(
    "wanted",
    [
        {"topology": "crank-rocker", "swing": "40 deg"},
        {"topology": "slider-crank-offset", "stroke": 0.4},
        {"topology": "six-bar-press", "stroke": 0.3},
    ],
)
def test_construction_sees_the_stroke_at_theta(wanted) -> None:
    """From everywhere on one side of the circle both ends are seen at the same angle, O among these places."""
    drawn = ct.synthesise(
        {"synthesis": {"kind": "strokes", **wanted, "time_ratio": 1.3, "answers": 1}}
    ).construction
    theta = math.pi * 0.3 / 2.3
    first, second = drawn.ends
    assert abs(cmath.phase((second - drawn.fixed[0]) / (first - drawn.fixed[0]))) == pytest.approx(
        theta, abs=1e-9
    )
    for place in drawn.sight[::20]:
        seen = abs(cmath.phase((second - place) / (first - place)))
        assert min(abs(seen - theta), abs(math.pi - seen - theta)) < 1e-9
    # in both limit positions O, A and B lie in one line
    for end in drawn.ends:
        arms = [line for line in drawn.links if np.abs(line - end).min() < 1e-9 and len(line) == 2]
        assert arms
