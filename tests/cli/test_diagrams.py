"""`centrode diagrams`, `centrode plan` and `centrode angles`: what they write and print, and what they refuse."""

from __future__ import annotations

import csv
import math
import re
import shlex
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.analysis.graphic.checks import graphic_check

Centrode = Callable[..., Any]


def rows(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def test_the_worked_check(centrode: Centrode, folder: Path) -> None:
    done = centrode(
        "diagrams", "slider-between-cranks", "--at", "pi/2 rad", "--angle-step", "1 deg", "--out", "d"
    )
    assert done.code == 0, done
    assert "|v_C| : |v_BC| : |v_BD| = sin 114° : sin 64° : sin 2°" in done.out
    assert "AC: at infinity, it translates" in done.out
    assert "directions to 1 deg" in done.out
    names = sorted(file.name for file in (folder / "d").iterdir())
    pages = ("acceleration", "mechanism", "velocity")
    assert names == sorted(["check.csv", *(f"{page}.{kind}" for page in pages for kind in ("png", "svg"))])
    check = graphic_check(ct.example("slider-between-cranks"), math.pi / 2, math.radians(1))
    for written, row in zip(rows(folder / "d" / "check.csv"), check.rows, strict=True):
        assert (written["quantity"], written["name"], written["unit"]) == (row.quantity, row.name, row.unit)
        assert float(written["drawing"]) == row.graphic
        assert float(written["difference"]) == row.difference


def test_scales_that_are_given(centrode: Centrode) -> None:
    scales = ("--scale", "length=0.05", "--scale", "acceleration=0.02")
    done = centrode("diagrams", "crank-rocker", "--at", "1 rad", "--no-figures", *scales)
    assert done.code == 0, done
    assert "μ_l = 0.05 m per mm" in done.out
    assert "μ_a = 0.02 m/s² per mm" in done.out


def test_several_instants(centrode: Centrode, folder: Path) -> None:
    done = centrode("diagrams", "shaper", "--at", "30 deg", "--at", "90 deg", "--no-figures")
    assert done.code == 0, done
    assert sorted(file.name for file in (folder / "shaper-diagrams").iterdir()) == [
        "check-1.csv",
        "check-2.csv",
    ]
    assert done.out.count("instant centres") == 2


def test_times_of_a_mechanism_with_several_drives(centrode: Centrode) -> None:
    done = centrode("diagrams", "excavator-arm", "--at", "1 s", "--length-step", "0.5 mm", "--no-figures")
    assert done.code == 0, done
    assert "lengths on paper to 0.5 mm" in done.out


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["crank-rocker", *("--at", "1 rad") * 101], "at most 100"),
        (["crank-rocker", "--at", "fast"], "--at"),
        (["crank-rocker", "--at", "1 mm"], "--at"),
        (["crank-rocker", "--at", "inf"], "--at"),
        (["crank-rocker", "--at", "1e9 rad"], "range"),
        (["crank-rocker", "--at", "1 rad", "--angle-step", "0 deg"], "at most 30 deg"),
        (["crank-rocker", "--at", "1 rad", "--angle-step", "90 deg"], "at most 30 deg"),
        (["crank-rocker", "--at", "1 rad", "--angle-step", "1 mm"], "crank-rocker"),
        (["crank-rocker", "--at", "1 rad", "--length-step", "-1 mm"], "at most 10 mm"),
        (["crank-rocker", "--at", "1 rad", "--length-step", "1 m"], "at most 10 mm"),
        (["crank-rocker", "--at", "1 rad", "--scale", "length"], "NAME=VALUE"),
        (["crank-rocker", "--at", "1 rad", "--scale", "length=small"], "expected a number"),
        (["crank-rocker", "--at", "1 rad", "--scale", "length=-1"], "has to be positive"),
        (["crank-rocker", "--at", "1 rad", "--scale", "length=nan"], "has to be positive"),
        (["crank-rocker", "--at", "1 rad", "--scale", "length=0.001"], "use at least"),
        (["crank-rocker", "--at", "1 rad", "--scale", "force=1"], "one of: length"),
        (["spherical-four-bar", "--at", "1 rad"], "do not apply on the sphere"),
        (["no-such-mechanism", "--at", "1 rad"], "no-such-mechanism"),
    ],
)
def test_wrong_input_of_diagrams(centrode: Centrode, folder: Path, arguments: list[str], told: str) -> None:
    done = centrode("diagrams", *arguments)
    assert done.code == 2, done
    assert told in done.err
    assert "Traceback" not in done.err
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "at", "told"),
    [
        ("slider-between-cranks-locked", "2.5 rad", "the mechanism is open"),
        ("parallelogram", "pi rad", "dead position"),
    ],
)
def test_where_the_mechanism_cannot_be_drawn(
    centrode: Centrode, folder: Path, name: str, at: str, told: str
) -> None:
    done = centrode("diagrams", name, "--at", at)
    assert done.code == 3, done
    assert told in done.err
    assert "choose another instant" in done.err
    assert list(folder.iterdir()) == []


def test_a_plan(centrode: Centrode, folder: Path) -> None:
    done = centrode("plan", "six-bar-press", "--positions", "24", "--dark")
    assert done.code == 0, done
    assert done.rows["positions"] == "24, all reached"
    assert done.rows["position 0"].startswith("extreme position of H at ")
    names = sorted(file.name for file in (folder / "six-bar-press-plan").iterdir())
    assert names == ["plan.png", "plan.svg", "positions.csv"]
    assert len(rows(folder / "six-bar-press-plan" / "positions.csv")) == 24


def test_a_plan_from_a_chosen_link(centrode: Centrode) -> None:
    done = centrode("plan", "crank-rocker", "--link", "DB", "--no-figures", "--out", "p")
    assert done.code == 0, done
    assert done.rows["position 0"].startswith("extreme position of DB at ")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["crank-rocker", "--positions", "1"], "2 to 36"),
        (["crank-rocker", "--positions", "many"], "many"),
        (["crank-rocker", "--link", "OA"], "no extreme position"),
        (["crank-rocker", "--link", "piston"], "neither a link nor a guide"),
        (["spherical-four-bar"], "in the plane only"),
    ],
)
def test_wrong_input_of_a_plan(centrode: Centrode, folder: Path, arguments: list[str], told: str) -> None:
    done = centrode("plan", *arguments)
    assert done.code == 2, done
    assert told in done.err
    assert "Traceback" not in done.err
    assert list(folder.iterdir()) == []


@pytest.mark.drawn
def test_transmission_angles(centrode: Centrode, folder: Path) -> None:
    done = centrode("angles", "crank-rocker", "--samples", "37", "--out", "t")
    assert done.code == 0, done
    assert sorted(file.name for file in (folder / "t").iterdir()) == [
        "transmission.csv",
        "transmission.nc",
        "transmission.png",
        "transmission.svg",
    ]
    found = ct.transmission_angles(ct.example("crank-rocker"), samples=37)
    table = rows(folder / "t" / "transmission.csv")
    column = [float(row["transmission_angle_AB-DB [rad]"]) for row in table]
    assert column == found.transmission_angle.values[:, 0].tolist()
    with xr.open_dataset(folder / "t" / "transmission.nc", engine="scipy") as stored:
        assert np.array_equal(stored["pressure_angle"].values, found.pressure_angle.values)


def test_transmission_where_it_locks(centrode: Centrode, folder: Path) -> None:
    done = centrode("angles", "slider-between-cranks-locked", "--samples", "7", "--no-figures", "--out", "t")
    assert done.code == 0, done
    assert [row["status"] for row in rows(folder / "t" / "transmission.csv")][2] == "open"
    assert "nan" not in done.out


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["two-link-arm"], "no group"),
        (["crank-rocker", "--samples", "0"], "samples"),
    ],
)
def test_wrong_input_of_transmission(
    centrode: Centrode, folder: Path, arguments: list[str], told: str
) -> None:
    done = centrode("angles", *arguments)
    assert done.code == 2, done
    assert told in done.err
    assert list(folder.iterdir()) == []


def test_the_command_that_the_page_of_validation_quotes_is_accepted(centrode: Centrode, folder: Path) -> None:
    page = (Path(__file__).parents[2] / "docs" / "validation.md").read_text(encoding="utf-8")
    quoted = re.findall(r"`centrode (diagrams [^`]*)`", " ".join(page.split()))
    assert len(quoted) == 1
    done = centrode(*shlex.split(quoted[0]), "--no-figures", "--out", "d")
    assert done.code == 0, done.err
