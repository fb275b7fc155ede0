"""`centrode limits` and `centrode region`, and what `run` adds with several drives."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct

Centrode = Callable[..., Any]

FIVE_BAR = """\
title = "Five-bar"
display = { angle = "deg", length = "mm" }
[frame.points]
O = [0, 0]
E = [1, 0]
[links.OA]
length = 0.5
[links.AB]
length = 0.7
[links.CB]
length = 0.6
[links.EC]
length = 0.5
[[drives]]
link = "OA"
start = "1 rad"
speed = 1
[[drives]]
link = "EC"
start = "1.8 rad"
speed = -2
[assembly]
sides = { B = "left" }
"""


@pytest.fixture
def arm(folder: Path) -> Path:
    (folder / "arm.toml").write_text(FIVE_BAR)
    return folder


def rows(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def exact(held: float) -> list[float]:
    """Limits of OA: the triangle O-A-C with |AC| = 1.3."""
    c = 1.0 + 0.5 * np.exp(1j * held)
    half = np.arccos((0.25 + abs(c) ** 2 - 1.69) / abs(c))
    return [float(np.angle(c) - half), float(np.angle(c) + half)]


def test_limits_are_printed_and_written(centrode: Centrode, arm: Path) -> None:
    done = centrode("limits", "arm.toml", "--drive", "OA", "--hold", "EC=60 deg", "--out", "limits.json")
    assert done.code == 0
    assert done.err == ""
    low, high = exact(math.pi / 3)
    group = "group AB-CB (point B)"
    assert done.rows == {
        "drive": "OA",
        "held drives": "EC = 60 deg",
        "initial value": "57.2957795 deg",
        "from": f"{math.degrees(low):.9g} deg, limit of {group}",
        "to": f"{math.degrees(high):.9g} deg, limit of {group}",
        "change points": "none",
    }
    assert done.out.endswith("wrote limits.json\n")
    found = json.loads((arm / "limits.json").read_text(encoding="utf-8"))
    assert found["low"] == {"value": pytest.approx(low, abs=1e-14), "group": group}
    assert found["high"] == {"value": pytest.approx(high, abs=1e-14), "group": group}
    assert (found["drive"], found["unit"], found["about"]) == ("OA", "rad", 1.0)
    assert found["held"] == {"EC": math.pi / 3}


def test_limits_as_a_table_and_about_another_value(centrode: Centrode, arm: Path) -> None:
    again = ("limits", "arm.toml", "--drive", "EC", "--about", "2 rad", "--out", "limits.csv")
    assert centrode(*again).code == 0
    table = rows(arm / "limits.csv")
    assert [row["event"] for row in table] == ["low", "high"]
    mirrored = [math.pi - x for x in reversed(exact(math.pi - 1.0))]
    assert [float(row["drive_EC [rad]"]) for row in table] == pytest.approx(mirrored, abs=1e-14)
    assert centrode(*again).code == 2
    assert "--force" in centrode(*again).err
    assert centrode(*again, "--force").code == 0


def test_no_limits(centrode: Centrode) -> None:
    done = centrode("limits", "five-bar-two-drives", "--drive", "OA")
    assert done.rows["from"] == done.rows["to"] == "unlimited"
    done = centrode("limits", "parallelogram")
    assert "180 deg" in done.rows["change points"]
    assert done.rows["held drives"] == "none"


REFUSED = {
    ("limits", "arm.toml"): "drive: the mechanism has 2 drives; name the drive that moves: OA, EC",
    ("limits", "arm.toml", "--drive", "OB"): "drive: there is no drive OB",
    ("limits", "arm.toml", "--drive", "OA", "--hold", "OA=1"): "hold: drive OA is the one that moves",
    ("limits", "arm.toml", "--drive", "OA", "--hold", "EC"): 'expected NAME=VALUE, got "EC"',
    ("limits", "arm.toml", "--drive", "OA", "--hold", "EC=1", "--hold", "EC=2"): "EC is given twice",
    ("limits", "arm.toml", "--drive", "OA", "--hold", "EC=1 m"): "hold EC: expected an angle",
    ("limits", "arm.toml", "--drive", "OA", "--hold", "EC=0", "--about", "180 deg"): "does not close there",
    ("limits", "arm.toml", "--drive", "OA", "--out", "limits.pdf"): 'cannot be written as ".pdf"',
    ("region", "arm.toml", "--range", "OA=1"): "expected NAME=FIRST:LAST",
    ("region", "arm.toml", "--range", "XY=0:1"): "XY is not one of the two drives",
    ("region", "arm.toml", "--drive", "OA"): "a region needs two different drives; 1 is given",
    ("region", "arm.toml", "--samples", "1"): "1 sample is given",
    ("region", "crank-rocker"): "a region needs two drives, the mechanism has one",
    ("region", "excavator-arm"): "3 are given; name two of: K-A, C-E, S-N",
}


@pytest.mark.parametrize("arguments", REFUSED, ids=" ".join)
def test_wrong_questions(centrode: Centrode, arm: Path, arguments: tuple[str, ...]) -> None:
    done = centrode(*arguments)
    assert done.code == 2
    assert done.out == ""
    assert REFUSED[arguments] in done.err
    assert "Traceback" not in done.err
    assert [path.name for path in arm.iterdir()] == ["arm.toml"]


@pytest.mark.drawn
def test_a_region_is_written_and_summed_up(centrode: Centrode, arm: Path) -> None:
    done = centrode("region", "arm.toml", "--out", "result", "--samples", "31")
    assert done.code == 0
    assert done.err == ""
    names = ["border.csv", "region.csv", "region.nc", "region.png", "region.svg"]
    assert sorted(path.name for path in (arm / "result").iterdir()) == names
    assert done.out.startswith("Five-bar\n\n")
    first, last = math.degrees(1.0 - math.pi), math.degrees(1.0 + math.pi)
    assert done.rows["drive OA"] == f"{first:.9g} deg to {last:.9g} deg"
    region = ct.reachable_region(ct.read_mechanism("arm.toml"), samples=31)
    with xr.open_dataset(arm / "result" / "region.nc", engine="scipy") as written:
        np.testing.assert_array_equal(written["status"], region["status"])
        np.testing.assert_array_equal(written["border_value"], region["border_value"])
    table = rows(arm / "result" / "region.csv")
    assert len(table) == 31 * 31
    assert list(table[0]) == ["drive_OA [deg]", "drive_EC [deg]", "status", "margin"]
    words = [ct.Status(code).word for code in region["status"].values.reshape(-1).tolist()]
    assert [row["status"] for row in table] == words
    border = rows(arm / "result" / "border.csv")
    assert len(border) == region.sizes["border"] > 0
    for row in border:
        a, c = (np.exp(1j * math.radians(float(row[f"drive_{name} [deg]"]))) for name in ("OA", "EC"))
        # degrees are rounded once more
        assert min(abs(abs(0.5 * a - 1 - 0.5 * c) - reach) for reach in (0.1, 1.3)) <= 1e-14
    assert {row["group"] for row in border} == {"group AB-CB (point B)"}


def test_a_region_without_a_time_to_draw_a_path_for(centrode: Centrode, arm: Path) -> None:
    (arm / "arm.toml").write_text(
        FIVE_BAR.replace("speed = 1\n", 'law = "t"\n').replace("speed = -2", 'law = "-t"')
    )
    arguments = ("--samples", "9", "--range", "OA=0 deg:90 deg", "--range", "EC=1 rad:2 rad")
    done = centrode("region", "arm.toml", *arguments)
    assert done.code == 0
    assert done.rows["drive OA"] == "0 deg to 90 deg"
    assert (arm / "arm-region" / "region.png").read_bytes().startswith(b"\x89PNG")
    done = centrode("region", "arm.toml", *arguments, "--out", "tables", "--no-figures")
    assert [path.name for path in (arm / "tables").glob("*.png")] == []


def test_a_run_with_several_drives_writes_coefficients(centrode: Centrode, arm: Path) -> None:
    done = centrode("run", "arm.toml", "--out", "r", "--samples", "5", "--to", "0.2 s", "--no-figures")
    assert done.code == 0
    expected = ["coefficients.csv", "coefficients.nc", "motion.csv", "motion.nc", "summary.json"]
    assert sorted(path.name for path in (arm / "r").iterdir()) == expected
    table = rows(arm / "r" / "coefficients.csv")
    data = ct.kinematic_coefficients(ct.read_mechanism("arm.toml"), 5, stop=0.2)
    header = list(table[0])
    assert header[:3] == ["time [s]", "drive_OA [deg]", "drive_EC [deg]"]
    assert "velocity_coefficient_B_x_by_EC [mm/rad]" in header
    assert "acceleration_coefficient_B_y_by_OA_EC [mm/rad^2]" in header
    assert "acceleration_coefficient_B_y_by_EC_OA [mm/rad^2]" not in header
    for k, row in enumerate(table):
        mixed = data["acceleration_coefficient"].sel(point="B", axis="y", drive="OA", drive_2="EC")
        assert float(row["acceleration_coefficient_B_y_by_OA_EC [mm/rad^2]"]) == 1000 * float(mixed[k])
        first = data["angular_velocity_coefficient"].sel(link="CB", drive="EC")
        assert float(row["angular_velocity_coefficient_CB_by_EC"]) == float(first[k])
        assert row["status"] == "ok"
    with xr.open_dataset(arm / "r" / "coefficients.nc", engine="scipy") as written:
        np.testing.assert_array_equal(written["acceleration_coefficient"], data["acceleration_coefficient"])
