"""Mechanisms as data in Python: the same words as in files, nothing changes, look-ups."""

import copy
import math
import pickle
from typing import Any

import pytest

from centrode.errors import CentrodeError, InputError
from centrode.model.checks import disconnected_parts
from centrode.model.description import Description
from centrode.model.files import parse_mechanism
from centrode.model.mechanism import Drive, Frame, Guide, Link, Mechanism, Placed, Study
from centrode.model.reading import FrozenMap, two_points

from .conftest import FULL


def test_python_spells_the_same_as_a_file() -> None:
    mechanism = Mechanism(frame={"points": {"O": [0, 0]}}, links={"OA": {"length": "0.5 m"}})
    assert mechanism == parse_mechanism("[frame.points]\nO = [0, 0]\n[links.OA]\nlength = 0.5\n")
    parts = Mechanism(frame=Frame(points={"O": (0, 0)}), links={"OA": Link(length=0.5)})
    assert parts == mechanism


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: Mechanism(links={"OA": {"length": "0.5 kg"}}), "[links.OA] length: expected a length (m)"),
        (lambda: Mechanism(), '"links" is missing'),
        (lambda: Link(lenght=1), 'unknown key "lenght"; did you mean "length"?'),
        (lambda: Link(length=-1), "length must be positive, got -1"),
        (lambda: Drive(speed=1), "one of link, guide, distance is missing"),
        (lambda: Guide(point="A"), '"through" is missing'),
    ],
)
def test_wrong_values_in_python_are_input_errors(build: Any, message: str) -> None:
    with pytest.raises(CentrodeError) as caught:
        build()
    assert isinstance(caught.value, InputError)
    assert message in str(caught.value)


def test_nothing_can_be_changed() -> None:
    mechanism = parse_mechanism(FULL)
    for change in (
        lambda: setattr(mechanism, "title", "x"),
        lambda: setattr(mechanism.links["OA"], "length", 2.0),
        lambda: mechanism.links.__setitem__("OA", None),  # type: ignore[attr-defined]
        lambda: mechanism.frame.points.__delitem__("O"),  # type: ignore[attr-defined]
        lambda: mechanism.links["rocker"].coordinates.__setitem__("C", (1, 1)),  # type: ignore[attr-defined]
        lambda: setattr(mechanism.frame.points["D"], "at", (0, 0)),
    ):
        with pytest.raises((InputError, AttributeError, ValueError)):
            change()
    assert mechanism == parse_mechanism(FULL)


def test_mechanisms_are_compared_hashed_copied_and_sent() -> None:
    one, two = parse_mechanism(FULL), parse_mechanism(FULL)
    assert one == two
    assert hash(one) == hash(two)
    assert copy.deepcopy(one) == one == pickle.loads(pickle.dumps(one))
    assert one != one.model_copy(update={"title": "other"})


def test_frozen_map() -> None:
    source = {"b": 1, "a": 2}
    frozen = FrozenMap(source)
    source["b"] = 5
    assert frozen == {"b": 1, "a": 2}
    assert list(frozen) == ["b", "a"]
    assert repr(frozen) == "{'b': 1, 'a': 2}"
    assert {frozen: 1}[FrozenMap({"a": 2, "b": 1})] == 1


@pytest.mark.parametrize(
    ("name", "points"),
    [
        ("OA", ("O", "A")),
        ("O1A", ("O1", "A")),
        ("AB'", ("A", "B'")),
        ("A'B’", ("A'", "B’")),
        ("O12A3'", ("O12", "A3'")),
        ("ЖЯ", ("Ж", "Я")),
        ("αβ1", ("α", "β1")),
        ("AA", None),
        ("crank", None),
        ("A", None),
        ("A1", None),
        ("1A", None),
        ("A B", None),
        ("A_B", None),
    ],
)
def test_names_made_of_two_points(name: str, points: tuple[str, str] | None) -> None:
    assert two_points(name) == points


def test_initial_angles() -> None:
    text = """
    [frame.points]
    O = [0, 0]
    [links.OA]
    length = 1
    [links.AB]
    length = 1
    angle = 0.5
    [links.BC]
    length = 1
    [links.CD]
    length = 1
    [[drives]]
    link = "OA"
    start = 1
    law = "0.25 + t"
    [[drives]]
    link = "BC"
    relative_to = "OA"
    start = 2
    speed = 1
    [[drives]]
    link = "CD"
    start = 2
    law = "1/t"
    """
    m = parse_mechanism(text)
    assert [m.initial_angle(name) for name in ("frame", *m.links)] == [0.0, 1.25, 0.5, 3.25, None]
    assert m.drive("BC").relative_to == "OA"
    with pytest.raises(InputError, match='there is no drive "CB"'):
        m.drive("CB")


def test_angle_of_a_prismatic_pair() -> None:
    def turn(guide: str, block: str = "") -> float:
        m = parse_mechanism(f"""
        [frame.points]
        O = [0, 0]
        [links.OB]
        length = 1
        angle = 0.25
        [links.block]
        points = ["A"]
        {block}
        [[guides]]
        point = "A"
        on = "OB"
        through = "O"
        direction = 0
        {guide}
        """)
        return m.guide_turn(m.guides[0])

    assert turn('link = "block"') == 0.0
    assert turn('link = "block"', "angle = 1") == 0.75
    assert turn('link = "block"\nangle = 3', "angle = 1") == 3.0
    assert turn("") == 0.0


def test_line_of_a_guide() -> None:
    m = parse_mechanism(FULL)
    assert m.through(m.guide("way")) == (0.0, 0.0)
    placed = (0.5 + math.cos(0.5), math.sin(0.5))
    assert m.through(m.guide("C")) == pytest.approx(placed, abs=4e-16)
    for given in ((3, 4), "53.13010235415598 deg"):
        guide = Guide(point="A", through=(0, 0), direction=given)
        assert guide.unit == pytest.approx((0.6, 0.8), abs=1e-15)
        assert guide.direction_angle == pytest.approx(math.atan2(4, 3), abs=1e-15)
    with pytest.raises(InputError, match='there is no guide "B"'):
        m.guide("B")


def test_loose_parts_are_found() -> None:
    links = {name: {"length": 1} for name in ("OA", "AB", "EF", "FG", "PQ")}
    loose = Description(frame={"points": {"O": (0, 0)}}, links=links)
    assert [(part.links, part.points) for part in disconnected_parts(loose)] == [
        (("EF", "FG"), ("E", "F", "G")),
        (("PQ",), ("P", "Q")),
    ]
    with pytest.raises(InputError, match=r"(?s)nothing connects EF, FG to the frame.*nothing connects PQ"):
        Mechanism(frame={"points": {"O": (0, 0)}}, links=links)


@pytest.mark.parametrize(
    "join",
    [
        {"guides": [{"point": "E", "on": "OA", "through": (0, 0), "direction": 0}]},
        {"guides": [{"point": "A", "on": "EF", "through": (0, 0), "direction": 0}]},
        {"gears": [{"links": ["OA", "EF"], "ratio": 2}]},
        {
            "rolling": [
                {"link": "EF", "centre": "E", "radius": 1, "along": {"through": (0, 0), "direction": (1, 0)}}
            ]
        },
        {"drives": [{"distance": ["A", "E"], "speed": 1}]},
    ],
)
def test_what_joins_parts(join: dict[str, Any]) -> None:
    links = {name: {"length": 1} for name in ("OA", "EF")}
    mechanism = Mechanism(frame={"points": {"O": (0, 0)}}, links=links, **join)
    assert disconnected_parts(mechanism) == ()


def test_free_ends_and_shared_pairs_of_points_are_allowed() -> None:
    Mechanism(
        frame={"points": {"O": (0, 0)}},
        links={"OA": {"length": 1}, "AB": {"length": 1}, "plate": {"points": {"A": (0, 0), "B": (1, 0)}}},
    )


def test_study_range_has_two_spellings() -> None:
    assert Study(start=1, stop=2) == Study(**{"from": 1, "to": 2})


def test_instants_are_values_of_the_first_drive() -> None:
    m = Mechanism(
        links={"AB": {"length": 1}},
        guides=[
            {"point": "A", "through": (0, 0), "direction": 0},
            {"point": "B", "through": (0, 0), "direction": 1},
        ],
        drives=[{"guide": "A", "start": "3 mm", "speed": "2 mm/s"}],
        study={"instants": ["5 mm"], "to": "1 cm"},
    )
    assert m.study.instants == (0.005,)
    assert m.study.stop == 0.01
    assert m.drives[0].speed == 0.002


def test_places_are_resolved_in_python_too() -> None:
    m = Mechanism(
        frame={"points": {"O": (0, 0), "D": "placed"}},
        links={"OA": {"length": 1, "angle": 0}, "AD": {"length": 2, "angle": "90 deg"}},
    )
    assert isinstance(m.frame.points["D"], Placed)
    assert m.frame.coordinates["D"] == pytest.approx((1, 2), abs=4e-16)
