"""Factories of classic mechanisms: their starts assemble, and their names are the documented ones."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from centrode.errors import InputError
from centrode.model.classics import four_bar, inverted_slider_crank, parallelogram, scotch_yoke, slider_crank
from centrode.model.files import mechanism_text, parse_mechanism
from centrode.model.mechanism import Mechanism

LENGTH = st.floats(0.01, 100)


def start(mechanism: Mechanism) -> float:
    angle = mechanism.initial_angle("crank")
    assert angle is not None
    return angle


def test_names_points_and_lengths() -> None:
    m = four_bar(crank="1 m", coupler=3.5, rocker=3, ground="4000 mm", side="right", start="30 deg")
    assert m.link_names == ("crank", "coupler", "rocker")
    assert m.points == ("O", "D", "A", "B")
    assert m.frame.coordinates["D"] == (4.0, 0.0)
    assert m.assembly.sides == {"B": "right"}
    assert start(m) == math.radians(30)
    assert parse_mechanism(mechanism_text(m)) == m


@given(LENGTH, LENGTH, LENGTH, LENGTH)
def test_four_bars_start_where_they_assemble(a: float, b: float, c: float, d: float) -> None:
    closes = 2 * max(a, b, c, d) < a + b + c + d
    try:
        phi = start(four_bar(a, b, c, d))
    except InputError:
        assert not closes
        return
    reach = math.hypot(d - a * math.cos(phi), a * math.sin(phi))
    slack = 1e-12 * (a + b + c + d)
    assert closes
    assert abs(b - c) <= reach + slack
    assert reach <= b + c + slack


@given(LENGTH, LENGTH, st.floats(-150, 150))
def test_slider_cranks_start_where_they_assemble(a: float, b: float, e: float) -> None:
    try:
        phi = start(slider_crank(a, b, e))
    except InputError:
        assert abs(e) >= a + b
        return
    assert abs(e - a * math.sin(phi)) < b * (1 + 1e-9)


@given(LENGTH, LENGTH, st.floats(-150, 150))
def test_inverted_slider_cranks_start_where_they_assemble(a: float, d: float, e: float) -> None:
    try:
        phi = start(inverted_slider_crank(a, d, e))
    except InputError:
        assert abs(e) >= a + d
        return
    assert math.hypot(d - a * math.cos(phi), a * math.sin(phi)) > abs(e) * (1 - 1e-9)


def test_scotch_yoke_and_parallelogram() -> None:
    yoke = scotch_yoke(0.5)
    assert yoke.through(yoke.guide("A")) == (0.0, 0.0)
    assert yoke.guide("H").link == "yoke"
    m = parallelogram(1, 2, start=0.5)
    assert [m.initial_angle(name) for name in m.links] == [0.5, 0.0, 0.5]
    assert parse_mechanism(mechanism_text(yoke)) == yoke


@pytest.mark.parametrize(
    ("lengths", "message"),
    [
        ((-1, 1, 1, 1), "crank must be positive, got -1"),
        ((1, "1 kg", 1, 1), "coupler: expected a length"),
        (
            (1, 1, 1, 10),
            "the lengths close at no angle of the crank; no length may exceed the sum of the others",
        ),
    ],
)
def test_wrong_lengths_are_told(lengths: tuple[float, float, float, float], message: str) -> None:
    with pytest.raises(InputError) as caught:
        four_bar(*lengths)
    assert message in str(caught.value)
