"""Tables of variants: what headers name, and every way in which a table can be wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import centrode as ct
from centrode.assignments.tables import read_variants

WORKED = ct.example("slider-between-cranks")
TABLE = Path(__file__).parents[1] / "reference" / "planar-variants.csv"


def values(text: str, folder: Path, topology: ct.Mechanism = WORKED) -> list[tuple[str, dict[str, float]]]:
    (folder / "t.csv").write_text(text, encoding="utf-8")
    return [(one.name, dict(one.values)) for one in read_variants(topology, folder / "t.csv")]


def test_the_sources_table() -> None:
    found = read_variants(WORKED, TABLE)
    assert [variant.name for variant in found] == [str(number) for number in range(1, 31)]
    assert dict(found[6].values) == {
        "links.AC.length": 1.0,
        "links.CB.length": 1.2,
        "links.BD.length": 0.8,
        "links.AC.angle": 0.5,
        "links.CB.angle": 1.9,
        "links.BD.angle": 3.5,
    }
    assert found[6].of(WORKED) == WORKED  # row 7 is the worked example


def test_what_is_placed_is_placed_anew() -> None:
    one = read_variants(WORKED, [{"variant": "a", "phi4_0": 3.0}])[0].of(WORKED)
    chain = 0.5 + np.exp(0.5j) + 1.2 * np.exp(1.9j) + 0.8 * np.exp(3.0j)
    assert ct.value_at(one, "frame.points.D.x") == pytest.approx(chain.real, abs=1e-15)
    assert ct.value_at(one, "frame.points.D.y") == pytest.approx(chain.imag, abs=1e-15)
    fixed = read_variants(WORKED, [{"variant": "a", "frame.points.D.x": 0.25}])[0].of(WORKED)
    assert ct.value_at(fixed, "frame.points.D.x") == 0.25


@pytest.mark.parametrize(
    ("header", "cell", "path", "value"),
    [
        ("l2_m", "1.5", "links.AC.length", 1.5),
        ("l2", "150 cm", "links.AC.length", 1.5),
        ("l2 [mm]", "1500", "links.AC.length", 1.5),
        ("l2_mm", "1500", "links.AC.length", 1.5),
        (" l2 ", " 1.5 ", "links.AC.length", 1.5),
        ("phi2_0_rad", "0.25", "links.AC.angle", 0.25),
        ("phi2_deg", "90", "links.AC.angle", np.pi / 2),
        ("phi2_0 [deg]", "90", "links.AC.angle", np.pi / 2),
        ("φ2", "pi/2 rad", "links.AC.angle", np.pi / 2),
        ("omega1_rad_s", "2", "drives.OA.speed", 2.0),
        ("ω1 [rpm]", "30", "drives.OA.speed", np.pi),
        ("links.AC.length [mm]", "1500", "links.AC.length", 1.5),
        ("frame.points.D.x", "20 mm", "frame.points.D.x", 0.02),
        ("guides.C.direction [deg]", "90", "guides.C.direction", np.pi / 2),
        ("drives.OA.start", "0.5", "drives.OA.start", 0.5),
    ],
)
def test_headers(header: str, cell: str, path: str, value: float, tmp_path: Path) -> None:
    [(name, found)] = values(f"Variant,{header}\nfirst,{cell}\n", tmp_path)
    assert name == "first"
    assert found == pytest.approx({path: value}, rel=1e-15)


def test_a_driven_links_angle_is_also_the_start_of_its_drive() -> None:
    found = read_variants(WORKED, [{"variant": 1, "phi1_0": "30 deg"}])[0]
    assert dict(found.values) == {"links.OA.angle": np.pi / 6, "drives.OA.start": np.pi / 6}


@pytest.mark.parametrize(
    "text",
    [
        "variant,l2\n1,1.5\n2,2.5\n",
        "variant;l2\n1;1,5\n2;2,5\n",
        "variant;l2\r\n1;1.5\r\n2;2.5\r\n",
        "variant\tl2\n1\t1,5\n2\t2.5\n",
        "\ufeffvariant,l2\n1,1.5\n\n  ,\n2,2.5\n",
        'variant,"l2"\n"1","1.5"\n2,2.5',
        "l2,variant\n1.5,1\n2.5,2\n",
    ],
)
def test_spellings_of_one_table(text: str, tmp_path: Path) -> None:
    found = values(text, tmp_path)
    assert found == [("1", {"links.AC.length": 1.5}), ("2", {"links.AC.length": 2.5})]


def test_a_thousand_rows(tmp_path: Path) -> None:
    text = "variant,l2_m\n" + "".join(f"{number},{1 + number / 1000}\n" for number in range(1000))
    found = values(text, tmp_path)
    assert len(found) == 1000
    assert found[999] == ("999", {"links.AC.length": 1.999})


WRONG = [
    ("", "the file is empty"),
    ("\n\n", "the file is empty"),
    ("variant,l2\n", "it has no variants"),
    ("variant\n1\n", "no column has a number"),
    ("l2,l3\n1,1\n", 'the column "variant" is missing'),
    ("variant,l2,l2_m\n1,1,1\n", 'columns "l2" and "l2_m" refer to the same number'),
    ("variant,variant\n1,1\n", "refer to the same number"),
    ("variant,l9\n1,1\n", 'column "l9": there is no link 9: the mechanism has 4 links'),
    ("variant,l0\n1,1\n", "there is no link 0"),
    ("variant,omega2\n1,1\n", "link AC has no drive"),
    ("variant,length\n1,1\n", 'column "length": it names no number of the mechanism; write a path'),
    ("variant,links.AX.length\n1,1\n", 'there is no "AX" in the path'),
    ("variant,links.AC.lenght\n1,1\n", 'did you mean "length"?'),
    ("variant,l2_kg\n1,1\n", 'column "l2_kg": expected a length'),
    ("variant,l2_m [mm]\n1,1\n", "it names two units"),
    ("variant,l2 []\n1,1\n", "is not a unit"),
    ("variant,l2\n1,long\n", 't.csv, row 2, column "l2": expected a length (m), got "long"'),
    ("variant,l2_m\n1,1 mm\n", 'row 2, column "l2_m": expected a number, got "1 mm"'),
    ("variant,l2\n1,nan\n", 'row 2, column "l2": expected'),
    ("variant,l2\n1,1e999\n", 'row 2, column "l2": expected a finite number'),
    ("variant,l2\n1,\n", 'row 2, column "l2": the cell is empty'),
    ("variant,l2\n,1\n", "row 2: the variant has no name"),
    ("variant,l2\n../x,1\n", "row 2: "),
    ("variant,l2\n=1+1,1\n", 'row 2: "=1+1" begins like a formula of a spreadsheet'),
    ("variant,l2\n@a,1\n", "begins like a formula"),
    ('variant,l2\n"a\nb",1\n', "characters a name may not have"),
    ("variant,l2\n1,1\n1,2\n", 'variant "1" occurs twice'),
    ("variant,l2\na,1\nA,2\n", 'variant "A" occurs twice'),
    ("variant,l2\n1,1,5\n", "row 2: it has 3 cells, the headers are 2; where decimals have commas"),
    ("variant;l2;l3\n1;1\n", "row 2: it has 2 cells, the headers are 3; give every column a value"),
    ('variant,l2\n1,"1\n', 't.csv, row 2: "t.csv" is not a CSV file'),
    ("variant,l2\n" + "\n".join(f"{n},1" for n in range(10_001)), "at most 10000 rows"),
]


@pytest.mark.parametrize(("text", "message"), WRONG, ids=[message for _text, message in WRONG])
def test_tables_that_are_refused(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(ct.InputError) as refused:
        values(text, tmp_path)
    assert message in str(refused.value)
    assert str(refused.value).startswith("t.csv")


def test_files_that_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ct.InputError, match="there is no such file"):
        read_variants(WORKED, tmp_path / "nothing.csv")
    (tmp_path / "w.csv").write_bytes("variant,l2\nпервый,1\n".encode("cp1251"))
    with pytest.raises(ct.InputError, match="not text in UTF-8"):
        read_variants(WORKED, tmp_path / "w.csv")
    (tmp_path / "long.csv").write_bytes(b"variant,l2\n" + b" " * 1_000_001)
    with pytest.raises(ct.InputError, match="at most 1000000 are allowed"):
        read_variants(WORKED, tmp_path / "long.csv")
    with pytest.raises(ct.InputError, match="not a file"):
        read_variants(WORKED, tmp_path)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([], "table: "),
        ([{"variant": "1"}], "no column has a number"),
        ([{"variant": "1", "l2": 1}, {"variant": "2", "l3": 1}], "table, row 2: its keys are not those"),
        ([{"variant": "1", "l2": None}], 'table, row 1, column "l2": the cell is empty'),
        ([{"variant": "1", "l2": [1]}], 'table, row 1, column "l2": expected a length'),
        ([{"variant": "1", "l2": True}], 'table, row 1, column "l2": expected a length'),
    ],
)
def test_rows_that_are_refused(rows: list[dict[str, object]], message: str) -> None:
    with pytest.raises(ct.InputError) as refused:
        read_variants(WORKED, rows)
    assert message in str(refused.value)


@pytest.mark.parametrize("header", ["variant", "вариант", "Варіант"])
def test_names_stand_in_a_column_with_a_header_in_any_language(header: str) -> None:
    assert [one.name for one in read_variants(WORKED, [{header: "7а", "l2": 1.0}])] == ["7а"]


def test_links_with_coordinates_have_no_length() -> None:
    complaint = "link AB has no length, its points have coordinates; name one of them: links.AB.points.S2.x"
    with pytest.raises(ct.InputError, match=complaint):
        read_variants(ct.example("six-bar-press"), [{"variant": 1, "l2": 1.0}])
