"""What a table of variants may change: every number with a path, by values and by changes, on several topologies."""

from __future__ import annotations

from pathlib import Path

import pytest

import centrode as ct
from centrode.assignments.tables import read_variants

PRESS = """
gravity = [0, -10]
[frame.points]
O = [0, 0]
[links.OA]
length = 0.1
mass = 7
[links.AB]
length = 0.4
[[guides]]
point = "B"
on = "frame"
through = [0, 0.05]
direction = [1, 0]
[[drives]]
link = "OA"
start = 0.5
speed = 6
[[loads]]
kind = "force"
point = "B"
vector = [-900, 30]
[[loads]]
kind = "force"
name = "gas"
guide = "B"
value = 120
[[loads]]
kind = "damper"
points = ["O", "B"]
damping = 3
[[loads]]
kind = "friction"
link = "AB"
relative_to = "OA"
viscous = 0.7
[[loads]]
kind = "friction"
guide = "B"
coefficient = 0.1
length = 0.06
[machine]
mean_speed = 6
fluctuation = 0.05
[[machine.shafts]]
inertia = 2.5
[[machine.shafts]]
name = "motor"
inertia = 0.02
ratio = 12
[machine.flywheel]
density = 7200
[simulation]
duration = 0.7
samples = 101
[simulation.motor]
kind = "linear"
idle_speed = 8
starting_moment = 160
"""
"""A slider-crank with a load of many kinds, a machine and a simulation."""

EDITS = [
    # header, cell, the line of the file, the same line edited by hand
    ("gravity.y", "-9.81", "gravity = [0, -10]", "gravity = [0, -9.81]"),
    ("links.OA.length", "x1.2", "length = 0.1", "length = 0.12"),
    ("links.OA.length", "*1.2", "length = 0.1", "length = 0.12"),
    ("links.OA.mass [kg]", "+10 %", "mass = 7", "mass = 7.7"),
    ("frame.points.O.y [mm]", "-=20", "O = [0, 0]", "O = [0, -0.02]"),
    ("guides.B.through.y", "+=5 mm", "through = [0, 0.05]", "through = [0, 0.055]"),
    ("drives.OA.speed", "-10 %", "speed = 6\n[[loads]]", "speed = 5.4\n[[loads]]"),
    ("loads.force B.vector.x", "-1 kN", "[-900, 30]", "[-1000, 30]"),
    ("loads.force B.vector.y", "x3", "[-900, 30]", "[-900, 90]"),
    ("loads.gas.value [kN]", "0.35", "value = 120", "value = 350"),
    ("loads.damper O-B.damping", "+7 %", "damping = 3", "damping = 3.21"),
    ("loads.friction AB.viscous", "x1.1", "viscous = 0.7", "viscous = 0.77"),
    ("loads.friction B.coefficient", "x1.5", "coefficient = 0.1", "coefficient = 0.15"),
    ("loads.friction B.length", "850 mm", "length = 0.06", 'length = "850 mm"'),
    ("machine.mean_speed [rpm]", "65", "mean_speed = 6", 'mean_speed = "65 rpm"'),
    ("machine.fluctuation", "0.11", "fluctuation = 0.05", "fluctuation = 0.11"),
    ("machine.shafts.1.inertia", "+=0.7", "inertia = 2.5", "inertia = 3.2"),
    ("machine.shafts.motor.ratio", "x2", "ratio = 12", "ratio = 24"),
    ("machine.flywheel.density", "7.8 g/cm^3", "density = 7200", 'density = "7.8 g/cm^3"'),
    ("simulation.duration", "+50 %", "duration = 0.7", "duration = 1.05"),
    ("simulation.samples", "x2", "samples = 101", "samples = 202"),
    ("simulation.motor.idle_speed", "-5 %", "idle_speed = 8", "idle_speed = 7.6"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("header", "cell", "line", "edited"), EDITS, ids=[f"{edit[0]} {edit[1]}" for edit in EDITS]
)
def test_a_variant_is_the_file_edited_by_hand(header: str, cell: str, line: str, edited: str) -> None:
    """Bit for bit: changes are those of the decimals that are written."""
    assert PRESS.count(line) == 1
    topology = ct.parse_mechanism(PRESS)
    [variant] = read_variants(topology, [{"variant": "one", header: cell}])
    assert variant.of(topology) == ct.parse_mechanism(PRESS.replace(line, edited))
    assert variant.of(topology) != topology


def test_a_wheel_and_a_law_of_driving_vary() -> None:
    wheels = ct.example("planetary-gear-train")
    name = wheels.gears[0].id
    [variant] = read_variants(wheels, [{"variant": 1, f"gears.{name}.ratio": "x1.1"}])
    ratio = wheels.gears[0].ratio
    assert variant.of(wheels).gears[0].ratio == pytest.approx(1.1 * ratio, rel=1e-15)
    thesis = ct.example("spherical-crank-rocker")
    [variant] = read_variants(thesis, [{"variant": 1, "simulation.driving": 2}])
    assert variant.of(thesis).simulation == thesis.simulation.model_copy(update={"driving": "2.0"})  # type: ignore[union-attr]


WRONG = [
    ("links.OA.length", "+5 mm", 'may be a value or a change of it; write "5 mm" for the value, "+=5 mm"'),
    ("links.OA.length", "10 %", 'is a share without a sign; write "+10 %" or "-10 %"'),
    ("machine.fluctuation", "+10 %", "may be a share or a change of it"),
    ("links.OA.length", "x0", "[links.OA]: length must be positive"),
    ("links.OA.length", "x", "expected a length (m)"),
    ("links.OA.length", "x1e400", "expected a finite number"),
    ("links.OA.length", "x1e9999999", "expected a length (m)"),
    ("links.OA.length", "+1e999999999999999999999 %", "may be a value or a change of it"),
    ("links.OA.length", "+=3 kg", "expected a length (m)"),
    ("frame.points.O.x", "+10 %", "the description has 0 there, and a share of it is 0"),
    ("machine.flywheel.inner", "+10 %", "may be a share"),
    ("machine.flywheel.inner", "x1.1", "is not a number here; give it a value first"),
    ("loads.force B.value", "1", 'there is no "value" in the path "loads.force B.value"'),
    ("loads.force C.vector.x", "1", 'there is no "force C" in the path'),
    ("loads.force B", "1", 'there is no "" in the path "loads.force B"; known are: vector.x, vector.y'),
    ("machine.shafts.3.inertia", "1", 'there is no "3" in the path'),
    ("machine.shafts.1", "1", 'there is no "" in the path "machine.shafts.1"; known are: inertia, ratio'),
    ("machine.flywheel", "1", "known are: flywheel.ratio, flywheel.inertia"),
    ("machine.wheel", "1", 'did you mean "flywheel"?'),
    ("machine.mean_spead", "1", 'did you mean "mean_speed"?'),
    ("simulation.motor.slip", "1", 'there is no "slip" in the path'),
]


@pytest.mark.parametrize(("header", "cell", "message"), WRONG, ids=[f"{one[0]} {one[1]}" for one in WRONG])
def test_what_is_unclear_or_wrong_is_refused(header: str, cell: str, message: str) -> None:
    topology = ct.parse_mechanism(PRESS)
    with pytest.raises(ct.InputError) as refused:
        [variant] = read_variants(topology, [{"variant": "one", header: cell}])
        variant.of(topology)
    assert message in str(refused.value)


def test_unclear_cells_name_row_and_column(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text("variant,l1\na,0.1\nb,+5 mm\n", encoding="utf-8")
    with pytest.raises(ct.InputError, match=r't\.csv, row 3, column "l1": "\+5 mm" may be'):
        read_variants(ct.parse_mechanism(PRESS), tmp_path / "t.csv")


def test_a_mechanism_without_a_machine_says_so() -> None:
    with pytest.raises(ct.InputError, match="the description has no machine"):
        read_variants(ct.example("crank-rocker"), [{"variant": 1, "machine.mean_speed": 1}])


# A topology for each row


def test_each_row_may_have_its_own_topology(tmp_path: Path) -> None:
    """A file beside the table, an example, and the topology of all; what a row has not is left empty."""
    (tmp_path / "press.toml").write_text(PRESS, encoding="utf-8")
    (tmp_path / "t.csv").write_text(
        "variant,topology,l2,machine.fluctuation\na,press.toml,x1.5,0.1\nb,four-bar-and-slider,,\nc,,1.3,\n",
        encoding="utf-8",
    )
    worked = ct.example("slider-between-cranks")
    a, b, c = (one.of(worked) for one in read_variants(worked, tmp_path / "t.csv"))
    edited = PRESS.replace("length = 0.4", "length = 0.6").replace("fluctuation = 0.05", "fluctuation = 0.1")
    assert a == ct.parse_mechanism(edited)
    assert b == ct.example("four-bar-and-slider")
    assert ct.value_at(c, "links.AC.length") == 1.3


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("a,nothing.toml,,", "row 2: nothing.toml: there is no such file"),
        ("a,slider-betwen-cranks,,", "row 2"),
        ("a,,,0.1", 'row 2, column "machine.fluctuation": the description has no machine'),
        ("a,spherical-crank-rocker,,", "row 2: "),
    ],
)
def test_wrong_topologies_are_refused(row: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text(f"variant,topology,l2,machine.fluctuation\n{row}\n", encoding="utf-8")
    with pytest.raises(ct.InputError) as refused:
        read_variants(ct.example("slider-between-cranks"), tmp_path / "t.csv")
    assert message in str(refused.value)


def test_folders_and_the_sheet_hold_variants_of_several_topologies(tmp_path: Path) -> None:
    rows = [
        {"variant": "own", "topology": "crank-rocker", "links.AB.length": "+=0.1"},
        {"variant": "all", "topology": "", "links.AB.length": ""},
    ]
    found = ct.write_variants(ct.example("four-bar-and-slider"), rows, tmp_path)
    assert [row.status for row in found.rows] == ["ok", "ok"]
    written = ct.read_mechanism(tmp_path / "variant-own" / "mechanism.toml")
    assert ct.value_at(written, "links.AB.length") == 3.6
    assert found.given[0].source == "crank-rocker"
