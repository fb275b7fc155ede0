"""Descriptions in files: everything of the grammar comes back exactly."""

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from centrode.errors import InputError
from centrode.model.examples import example_names
from centrode.model.examples.catalogue import example
from centrode.model.files import mechanism_from, mechanism_text, parse_mechanism, read_mechanism
from centrode.model.mechanism import Mechanism, Placed

from .conftest import FOUR_BAR, FULL, SPHERE

Complaint = Callable[[str], str]
NUMBER = st.floats(-1e6, 1e6, allow_nan=False)
LENGTH = st.floats(1e-6, 1e6)
"""Lengths of six decades either way."""


@pytest.mark.parametrize("text", [FULL, SPHERE, FOUR_BAR])
def test_round_trip_of_the_whole_grammar(text: str) -> None:
    mechanism = parse_mechanism(text)
    again = mechanism_text(mechanism)
    assert parse_mechanism(again) == mechanism
    assert mechanism_text(parse_mechanism(again)) == again
    assert list(parse_mechanism(again).links) == list(mechanism.links)


@pytest.mark.parametrize("name", example_names())
def test_every_example_comes_back(name: str) -> None:
    mechanism = example(name)
    again = mechanism_text(mechanism)
    assert parse_mechanism(again) == mechanism
    assert mechanism_text(parse_mechanism(again)) == again


def test_values_of_the_grammar() -> None:
    m = parse_mechanism(FULL)
    assert m.links["OA"].points == ("O", "A")
    assert m.links["CH"].length == 0.85
    assert m.links["rocker"].coordinates == {"C": (0, 0), "B": (0.85, 0), "D": (1.7, 0)}
    assert m.guide("way").unit == pytest.approx((math.sqrt(3) / 2, 0.5))
    assert m.gears[0].ratio == -2.0
    assert m.drives[0].start == pytest.approx(math.pi / 2)
    assert m.drives[2].table == ((0, 0), (0.5, 0.1), (1.5, 0.2))
    assert [drive.id for drive in m.drives] == ["OA", "A-H", "C"]
    assert [drive.kind for drive in m.drives] == ["angle", "distance", "displacement"]
    assert m.loads[0].vector == (-9000.0, 1000.0)
    assert m.loads[1].value == "-0.1*v*abs(v)"
    assert m.loads[2].stiffness == 2000.0
    assert m.study.instants == (0.099, 2.0)
    assert m.study.stop == 6.0
    assert m.points == ("O", "D", "A", "C", "B", "H", "A’")
    assert m.moving_points == ("A", "C", "B", "H", "A’")


def test_sphere_measures_in_arcs() -> None:
    m = parse_mechanism(SPHERE)
    assert m.links["AB"].length == math.radians(15)
    assert m.frame.coordinates == {"A": (0, 0), "D": (math.pi / 2, 0), "E": (0, math.pi / 2)}
    assert m.guides[0].pole == "D"


def test_sphere_and_plane_do_not_mix(complaint: Complaint) -> None:
    assert "expected an arc (rad)" in complaint(SPHERE.replace("15 deg", "15 mm"))
    assert '"pole" is missing' in complaint(SPHERE.replace('pole = "D"', ""))
    assert "unit vector" in complaint(SPHERE.replace("[1, 0, 0]", "[1, 1, 0]"))
    assert "through is used in the plane only" in complaint(
        SPHERE.replace('pole = "D"', 'pole = "D"\nthrough = [0, 0]')
    )
    assert "expected a length" in complaint(FOUR_BAR.replace("3.5", '"30 deg"'))


@st.composite
def mechanisms(draw: st.DrawFn) -> Mechanism:
    """Chains of random links with random extras."""
    count = draw(st.integers(1, 5))
    names = ["P0", *(f"P{i}" for i in range(1, count + 1))]
    links: dict[str, dict[str, object]] = {}
    for i in range(count):
        link: dict[str, object] = {"length": draw(LENGTH)}
        if draw(st.booleans()):
            link = {"points": {names[i]: (0, 0), names[i + 1]: (draw(NUMBER), draw(NUMBER))}}
        link["angle"] = draw(NUMBER)
        if draw(st.booleans()):
            link |= {"mass": draw(LENGTH), "centre": (draw(NUMBER), draw(NUMBER))}
        links[f"{names[i]}{names[i + 1]}"] = link
    guides = [
        {"point": names[-1], "through": draw(st.sampled_from(["placed", (1, 2)])), "direction": draw(NUMBER)}
    ]
    drives = [{"link": next(iter(links)), "start": draw(NUMBER), "speed": draw(NUMBER)}]
    return Mechanism(
        title=draw(st.text(st.characters(categories=["L", "P", "Zs"]), max_size=20)),
        frame={"points": {"P0": (draw(NUMBER), draw(NUMBER)), "F": draw(st.sampled_from(["placed", (0, 0)]))}}
        if draw(st.booleans())
        else {"points": {"P0": (0, 0)}},
        links=links if draw(st.booleans()) else dict(reversed(links.items())),
        guides=guides,
        drives=drives,
    )


@given(st.data())
def test_round_trip_of_random_mechanisms(data: st.DataObject) -> None:
    try:
        mechanism = data.draw(mechanisms())
    except InputError as error:
        assert "cannot be placed" in str(error)
        return
    again = parse_mechanism(mechanism_text(mechanism))
    assert again == mechanism
    assert list(again.links) == list(mechanism.links)
    assert hash(again) == hash(mechanism)


def test_tables_of_drives_lie_beside_the_file(tmp_path: Path) -> None:
    (tmp_path / "press.toml").write_text(
        FOUR_BAR.replace("speed = 1", 'table = "crank.csv"'), encoding="utf-8-sig"
    )
    (tmp_path / "crank.csv").write_text("time [ms],angle [deg]\n0,0\n\n500,90\n1000,360\n", encoding="utf-8")
    mechanism = read_mechanism(tmp_path / "press.toml")
    rows = mechanism.drives[0].table or ()
    assert [time for time, _ in rows] == [0, 0.5, 1]
    assert [value for _, value in rows] == pytest.approx([0, math.pi / 2, 2 * math.pi], rel=4e-16)
    assert parse_mechanism(mechanism_text(mechanism)) == mechanism
    (tmp_path / "crank.csv").write_text("0,0\n1,x\n", encoding="utf-8")
    with pytest.raises(
        InputError, match=r'press.toml, \[\[drives\]\] 1, table: row 2 of "crank.csv": expected an angle'
    ):
        read_mechanism(tmp_path / "press.toml")
    (tmp_path / "crank.csv").write_text("0,0\n1,2,3\n", encoding="utf-8")
    with pytest.raises(InputError, match="has 3 values"):
        read_mechanism(tmp_path / "press.toml")
    (tmp_path / "crank.csv").write_text("t [kg],angle\n0,0\n1,2\n", encoding="utf-8")
    with pytest.raises(InputError, match="expected a time"):
        read_mechanism(tmp_path / "press.toml")


def test_tables_of_spreadsheets_with_decimal_commas_are_read(tmp_path: Path) -> None:
    """What spreadsheets of countries with decimal commas save as CSV: semicolons, and a byte-order mark."""
    (tmp_path / "press.toml").write_text(
        FOUR_BAR.replace("speed = 1", 'table = "crank.csv"'), encoding="utf-8"
    )
    table = tmp_path / "crank.csv"
    table.write_text(
        "час [ms];кут [deg]\r\n0;0\r\n500;90,5\r\n1000;360\r\n", encoding="utf-8-sig", newline=""
    )
    rows = read_mechanism(tmp_path / "press.toml").drives[0].table or ()
    assert [time for time, _ in rows] == [0, 0.5, 1]
    assert [value for _, value in rows] == pytest.approx([0, math.radians(90.5), 2 * math.pi], rel=4e-16)
    table.write_text("0;0\n1;2;3\n", encoding="utf-8")
    with pytest.raises(InputError, match="has 3 values"):
        read_mechanism(tmp_path / "press.toml")


def test_placed_is_written_with_its_place() -> None:
    mechanism = parse_mechanism(FULL)
    assert isinstance(mechanism.frame.points["D"], Placed)
    assert "placed = [" in mechanism_text(mechanism)


def test_names_are_composed(complaint: Complaint) -> None:
    text = '[frame.points]\nO = [0, 0]\n[links."И\u0306"]\npoints = ["O", "E\u0301"]\nlength = 1\n'
    mechanism = parse_mechanism(text)
    assert mechanism.link_names == ("Й",)
    assert mechanism.moving_points == ("É",)
    assert "is named twice" in complaint(text + '[links."Й"]\npoints = ["O"]\n')


def test_mechanism_from_plain_data() -> None:
    with pytest.raises(InputError, match=r"^sent, \[links.OA\]: length must be positive, got -1$"):
        mechanism_from({"links": {"OA": {"length": -1}}}, "sent")


@pytest.mark.parametrize(
    "name", ["six-bar-press", "planetary-hypocycloid", "cam-driven-linkage", "scissor-lift-cylinder"]
)
def test_each_entry_of_a_list_of_tables_has_a_heading_of_its_own(name: str) -> None:
    mechanism = example(name)
    text = mechanism_text(mechanism)
    for key in ("guides", "gears", "rolling", "drives", "loads"):
        assert text.count(f"\n[[{key}]]\n") == len(getattr(mechanism, key))
        assert f"{key} = [" not in text
    assert parse_mechanism(text) == mechanism


def test_segments_and_tables_inside_an_entry_read_back() -> None:
    """Entries too long for one line, and tables inside them, belong to their own drive."""
    rise = {"to": 0.123456789012345, "time": 1.23456789012345, "curve": "polynomial", "speed_at_start": 0.0}
    mechanism = Mechanism(
        title="[[drives]] in a title",
        frame={"points": {"O": [0, 0], "E": [1, 0]}},
        links={"OA": {"length": 0.5}, "EB": {"length": 0.5}},
        drives=[
            {"link": "OA", "segments": [rise, {"time": 1.0, "curve": "dwell"}, {**rise, "to": 0.0}]},
            {"link": "EB", "table": [[0.0, 0.0], [1.0, 0.5], [2.0, 0.25]]},
        ],
    )
    text = mechanism_text(mechanism)
    assert parse_mechanism(text) == mechanism
    assert mechanism_text(parse_mechanism(text)) == text
