"""Variants of gear pairs and trains from a table: each as its own description, and what a row cannot be."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import pytest

import centrode as ct
from centrode.assignments.gear_variants import gear_variants
from centrode.cli.main import main
from centrode.errors import InputError
from centrode.model.gear_pairs import GEAR_PAIRS
from centrode.model.gear_trains import GEAR_TRAINS

PAIRS = """variant;m [mm];z1;z2;x1;x2;n1_rpm
1;3;12;24;0,6;0,36;300
2;4;14;30;0,3;-0,3;250
3;5;8;20;0;0;200
4;2,5;x;30;0;0;100
"""


def test_each_row_is_a_pair_of_its_own(tmp_path: Path) -> None:
    table = tmp_path / "rows.csv"
    table.write_text(PAIRS, encoding="utf-8")
    found = gear_variants("shifted-gear-pair", table)
    assert [one.status for one in found.results] == ["ok", "ok", "refused", "refused"]
    assert "row 5" in found.results[3].refusal
    own = ct.gear_pair(
        ct.GearPair(
            kind="gear pair", module="4 mm", teeth=[14, 30], shifts=[0.3, -0.3], width="30 mm", moment="25 N m",
            speed="250 rpm",
        )
    )  # fmt: skip
    second = found.results[1].result
    assert second is not None
    assert second.geometry == own.geometry
    assert second.output_speed == pytest.approx(-250 * math.tau / 60 * 14 / 30, rel=1e-15)
    assert ct.summary(found).splitlines()[-1] == "4 variants: ok 2, refused 2"


def test_keys_of_descriptions_are_headers_too() -> None:
    rows = [
        {"variant": "a", "shifts": "least sliding", "rack.pressure_angle": "25 deg", "helix_angle": "10 deg"},
        {"variant": "b", "shifts": "", "rack.pressure_angle": "", "helix_angle": ""},
    ]
    first, second = gear_variants("shifted-gear-pair", rows).results
    assert first.variant.described.helix_angle == pytest.approx(math.radians(10))
    assert first.variant.described.rack.pressure_angle == pytest.approx(math.radians(25))
    assert first.variant.described.purpose == "least sliding"
    assert second.variant.described == ct.example("shifted-gear-pair")


def test_a_centre_distance_takes_the_place_of_shifts_and_back() -> None:
    rows = [{"variant": "a", "aw [mm]": 57}]
    (one,) = gear_variants("shifted-gear-pair", rows).results
    assert one.variant.described.centre_distance == pytest.approx(0.057)
    assert one.variant.described.shifts is None
    (back,) = gear_variants(one.variant.described, [{"variant": "a", "x1": 0.5, "x2": 0.1}]).results
    assert back.variant.described.shifts == (0.5, 0.1)
    assert back.variant.described.centre_distance is None


def test_trains_of_a_table() -> None:
    rows = [
        {"variant": 1, "n1 [rpm]": 1440, "n2 [rpm]": 90, "m_mm": 4, "k": 3},
        {"variant": 2, "n1 [rpm]": 1000, "n2 [rpm]": 60, "m_mm": 3, "k": 4},
        {"variant": 3, "n1 [rpm]": 1440, "n2 [rpm]": 1, "m_mm": 3, "k": 3},
    ]
    found = gear_variants("single-planet-train", rows)
    assert [one.status for one in found.results] == ["ok", "ok", "refused"]
    described = GEAR_TRAINS.parse(
        'kind = "gear train"\nscheme = "single planets"\ninput_speed = "1000 rpm"\noutput_speed = "60 rpm"\n'
        'pair_behind = [15, 50]\nplanets = 4\nmodule = "3 mm"\n'
    )
    assert found.results[1].result.found == ct.gear_train(described).found
    assert "the nearest is" in found.results[2].refusal
    ratios = gear_variants("stepped-planet-train", [{"variant": "1", "u": 14}])
    assert ratios.results[0].result.gear_train.ratio == 14


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("m [mm],z1\n3,12\n", "variant"),
        ("variant,m [mm],z_9\n1,3,12\n", "names no number of the description"),
        ("variant,title\n1,a\n", "names no number of the description"),
        ("variant,m [mm]\n1,3\n1,4\n", "occurs twice"),
        ("variant,m [mm]\n", "no variants"),
        ("variant,m [mm]\n1\n", "it has 1 cell, the headers are 2"),
    ],
)
def test_bad_tables_are_refused_as_a_whole(tmp_path: Path, text: str, said: str) -> None:
    table = tmp_path / "rows.csv"
    table.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as refusal:
        gear_variants("shifted-gear-pair", table)
    assert said in str(refusal.value)
    assert "rows.csv" in str(refusal.value)


def test_only_gears_are_varied_by_such_a_table() -> None:
    with pytest.raises(InputError, match="gear pair or a train"):
        gear_variants("valve-cam", [{"variant": "1", "m": 3}])


def test_the_command_writes_a_folder_and_a_document_each(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = tmp_path / "rows.csv"
    table.write_text(PAIRS, encoding="utf-8")
    out = tmp_path / "out"
    line = ["variants", str(table), "--topology", "shifted-gear-pair", "--out", str(out)]
    assert main([*line, "--report", "--format", "html"]) == 3
    assert "undercut leaves" in capsys.readouterr().err
    assert sorted(path.name for path in out.iterdir()) == [
        "summary.csv",
        "variant-1",
        "variant-2",
        "variant-3",
    ]
    described = GEAR_PAIRS.read(out / "variant-2" / "pair.toml")
    assert described.teeth == (14, 30)
    assert (out / "variant-2" / "report.html").stat().st_size > 100_000
    with open(out / "summary.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert float(rows[0]["centre_distance [m]"]) == ct.gear_pair("shifted-gear-pair").geometry.centre_distance
    assert [row["status"] for row in rows] == ["ok", "ok", "refused", "refused"]
    assert main([*line, "--compute", "reactions"]) == 2
    assert "--compute" in capsys.readouterr().err
