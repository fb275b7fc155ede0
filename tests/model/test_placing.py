"""Placed points and guides: by hand, by complex numbers, and the angle that is missing."""

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from centrode.errors import InputError
from centrode.model.description import Description
from centrode.model.files import parse_mechanism, with_value
from centrode.model.mechanism import Mechanism, Placed
from centrode.model.placement import place, replace_placed

ANGLE = st.floats(-7, 7)
LENGTH = st.floats(0.1, 9)


def assignment(lengths: list[float], angles: list[float]) -> Mechanism:
    names = ("OA", "AC", "CB", "BD")
    pairs = zip(names, lengths, angles, strict=True)
    return Mechanism(
        frame={"points": {"O": (0.5, -1), "D": "placed"}},
        links={name: {"length": length, "angle": angle} for name, length, angle in pairs},
        guides=[{"point": "C", "through": "placed", "direction": (1, 0)}],
        drives=[{"link": "OA", "speed": 1}],
    )


@given(st.lists(LENGTH, min_size=4, max_size=4), st.lists(ANGLE, min_size=4, max_size=4))
def test_four_vectors_head_to_tail(lengths: list[float], angles: list[float]) -> None:
    m = assignment(lengths, angles)
    arms = [cmath.rect(*pair) for pair in zip(lengths, angles, strict=True)]
    start, bound = complex(0.5, -1), 8 * 2.3e-16 * (sum(lengths) + 2)
    assert complex(*m.frame.coordinates["D"]) == pytest.approx(start + sum(arms), abs=bound)
    assert complex(*m.through(m.guides[0])) == pytest.approx(start + arms[0] + arms[1], abs=bound)


def test_rigid_links_and_lines_on_moving_links() -> None:
    m = Mechanism(
        frame={"points": {"O": (1, 2), "E": "placed"}},
        links={
            "plate": {"points": {"A": (1, 1), "O": (1, 0), "E": (0, 0)}, "angle": "90 deg"},
            "AB": {"length": 2, "angle": 0},
        },
        guides=[{"point": "B", "on": "plate", "through": "placed", "direction": 0.0}],
    )
    assert m.frame.coordinates["E"] == pytest.approx((1, 1), abs=1e-15)
    # A is at (0, 2), B at (2, 2): one along the plate's x axis, one against its y axis from its origin E.
    assert m.through(m.guides[0]) == pytest.approx((1, -1), abs=1e-15)


def test_driven_links_are_placed_by_their_drives() -> None:
    m = Mechanism(
        frame={"points": {"O": (0, 0), "A": "placed"}},
        links={"OA": {"length": 2}},
        drives=[{"link": "OA", "start": "60 deg", "law": "30*pi/180 + t"}],
    )
    assert m.frame.coordinates["A"] == pytest.approx((0, 2), abs=1e-15)


@pytest.mark.parametrize(
    ("missing", "message"),
    [
        ("AC", 'frame.points] D: "D" cannot be placed'),
        ("BD", "give the initial angle of BD"),
        ("AC", "give the initial angle of AC"),
        ("OA", "give the initial angle of OA"),
    ],
)
def test_missing_angles_are_named(missing: str, message: str) -> None:
    links = {name: {"length": 1, "angle": 1} for name in ("OA", "AC", "CB", "BD")}
    del links[missing]["angle"]
    with pytest.raises(InputError) as caught:
        Mechanism(frame={"points": {"O": (0, 0), "D": "placed"}}, links=links)
    assert message in str(caught.value)


def test_a_point_that_no_chain_reaches_needs_coordinates() -> None:
    with pytest.raises(InputError, match=r'"E" cannot be placed.*give its coordinates'):
        Mechanism(frame={"points": {"O": (0, 0), "E": "placed"}}, links={"OA": {"length": 1, "angle": 0}})


def test_places_stay_when_a_length_changes_until_asked_for() -> None:
    m = assignment([1, 1, 1, 1], [0, 1, 2, 3])
    longer = with_value(m, "links.BD.length", 2)
    assert longer.frame == m.frame
    anew = replace_placed(longer)
    assert complex(*anew.frame.coordinates["D"]) == pytest.approx(
        complex(*m.frame.coordinates["D"]) + cmath.rect(1, 3), abs=1e-15
    )
    assert anew == assignment([1, 1, 1, 2], [0, 1, 2, 3])
    assert replace_placed(m) == m


def test_place_leaves_a_placed_mechanism_alone() -> None:
    m = assignment([1, 1, 1, 1], [0, 1, 2, 3])
    assert place(m) is m
    raw = Description(frame={"points": {"O": (0, 0), "A": "placed"}}, links={"OA": {"length": 1}})
    assert raw.frame.points["A"] == Placed()
    with pytest.raises(InputError, match=r"^\[frame.points\] A: \"A\" cannot be placed"):
        place(raw)
    with pytest.raises(InputError, match="not placed yet"):
        _ = raw.frame.coordinates


def test_written_places_are_not_moved_on_reading() -> None:
    text = "[frame.points]\nO = [0, 0]\nA = { placed = [3, 4] }\n[links.OA]\nlength = 1\nangle = 0\n"
    m = parse_mechanism(text)
    assert m.frame.coordinates["A"] == (3.0, 4.0)
    assert replace_placed(m).frame.coordinates["A"] == (1.0, 0.0)
    assert math.hypot(*m.frame.coordinates["A"]) == 5.0
