"""Values by path: what is set is what is read, and nothing else moves."""

import math

import pytest

from centrode.errors import InputError
from centrode.model.files import parse_mechanism, value_at, with_value
from centrode.model.mechanism import Mechanism, Placed

from .conftest import FULL


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("links.AC.length", 1.0),
        ("links.CH.length", 0.85),
        ("links.AC.angle", 0.5),
        ("links.AC.mass", 9.0),
        ("links.AC.centre.x", 0.7225),
        ("links.rocker.points.B.x", 0.85),
        ("links.палец A.length", 0.1),
        ("frame.points.O.y", 0.0),
        ("frame.points.D.x", 0.5 + math.cos(0.5) + 1.7 * math.cos(1.9)),
        ("guides.C.through.y", math.sin(0.5)),
        ("guides.C.direction", 0.0),
        ("guides.way.direction", math.radians(30)),
        ("drives.OA.start", math.radians(90)),
        ("drives.OA.speed", 2 * math.pi),
        ("gears.OA-wheel.ratio", -2.0),
        ("gears.ring gear.ratio", 3.0),
        ("rolling.wheel.radius", 0.3),
        ("rolling.ring.along.radius", 2.0),
        ("rolling.wheel.along.through.y", 0.0),
        ("rolling.wheel.along.direction", 0.0),
    ],
)
def test_values_are_read_and_set(path: str, value: float) -> None:
    m = parse_mechanism(FULL)
    assert value_at(m, path) == pytest.approx(value, abs=1e-15)
    changed = with_value(m, path, 0.125)
    assert value_at(changed, path) == 0.125
    assert changed != m
    back = with_value(changed, path, value_at(m, path))
    assert value_at(back, path) == value_at(m, path)
    if (
        ".D." not in path and ".C." not in path and not path.endswith("direction")
    ):  # placed, or spelt otherwise
        assert back == m


def test_only_the_named_value_changes() -> None:
    m = parse_mechanism(FULL)
    changed = with_value(m, "links.AC.length", 2)
    rest = {name: link for name, link in changed.links.items() if name != "AC"}
    assert rest == {name: link for name, link in m.links.items() if name != "AC"}
    assert changed.links["AC"] == m.links["AC"].model_copy(update={"length": 2.0})
    assert changed.model_copy(update={"links": m.links}) == m
    assert list(changed.links) == list(m.links)


def test_texts_with_units_fit_too() -> None:
    m = with_value(parse_mechanism(FULL), "links.AC.length", "5 mm")
    assert value_at(m, "links.AC.length") == 0.005


def test_a_place_that_is_set_counts_as_given() -> None:
    m = with_value(parse_mechanism(FULL), "frame.points.D.x", 3)
    assert not isinstance(m.frame.points["D"], Placed)
    assert m.frame.coordinates["D"][0] == 3.0


def test_names_may_hold_dots() -> None:
    m = Mechanism(
        frame={"points": {"O.1": (1, 2)}},
        links={"a": {"points": ["O.1", "A"], "length": 1}, "a.b": {"points": ["A", "B"], "length": 2}},
    )
    assert value_at(m, "links.a.length") == 1.0
    assert value_at(m, "links.a.b.length") == 2.0
    assert value_at(m, "frame.points.O.1.y") == 2.0


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("", "there is no"),
        ("link.AC.length", 'there is no "link" in the path "link.AC.length"; did you mean "links"?'),
        ("links.CA.length", 'there is no "CA"'),
        ("links.AC.lenght", 'there is no "lenght"'),
        ("links.AC", "there is no"),
        ("links.AC.length.x", "there is no"),
        ("links.AC.shape", "there is no"),
        ("links.AC.points.C.x", "the points of link AC have no coordinates of their own; links.AC.length"),
        ("links.rocker.length", "is not a number here"),
        ("links.rocker.points.Z.x", 'there is no "Z"'),
        ("links.rocker.points.B", "there is no"),
        ("links.rocker.centre.x", "is not a number here; give coordinates"),
        ("frame.points.O.z", 'there is no "z"'),
        ("frame.O.x", 'there is no "O"'),
        ("guides.way.through.x", "is not a number here"),
        ("guides.C.point", "there is no"),
        ("gears.wheel.ratio", 'there is no "wheel"'),
        ("gears.OA-wheel.links", "there is no"),
        ("rolling.ring.along.direction", "the wheel rolls on a circle"),
        ("rolling.ring.along.centre.x", "is not a number here; give coordinates"),
        ("rolling.wheel.along.radius", "is not a number here"),
        ("rolling.wheel.along", "there is no"),
        ("drives.C.speed", "is not a number here"),
        ("drives.AC.speed", 'there is no "AC"'),
    ],
)
def test_wrong_paths_are_told(path: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        value_at(parse_mechanism(FULL), path)
    assert message in str(caught.value)


def test_wrong_values_are_told() -> None:
    with pytest.raises(InputError, match=r"\[links.AC\]: length must be positive, got -1"):
        with_value(parse_mechanism(FULL), "links.AC.length", -1)
